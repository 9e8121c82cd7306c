//! The head of the page, with the size and the shapes of the set, and its foot.

use maud::{Markup, html};

use microfacet_tables::Table;

use super::Source;
use super::drawing::symbols;
use super::subjects::Subjects;
use super::texts;
use crate::words;

/// The name of the set, its tables, bytes and shapes in numbers, and the switch of colours.
pub(super) fn head(source: &Source, subjects: &Subjects) -> Markup {
    html! {
        header.head.wrap {
            div.kicker {
                span { "microfacet-bake" }
                (themes())
            }
            h1 { (texts::name(source.name)) }
            dl.facts {
                @for (name, value) in facts(source, subjects) {
                    div { dt { (name) } dd { (symbols(&value)) } }
                }
            }
        }
    }
}

/// The switch of colours, hidden until the page's script runs.
fn themes() -> Markup {
    html! {
        fieldset.theme hidden {
            legend.visually-hidden { "Colours of the page" }
            @for (value, name) in [("system", "Auto"), ("light", "Light"), ("dark", "Dark")] {
                label {
                    input type="radio" name="theme" value=(value) checked[value == "system"];
                    span { (name) }
                }
            }
        }
    }
}

fn facts(source: &Source, subjects: &Subjects) -> Vec<(&'static str, String)> {
    let tables = source.set.tables();
    let bytes: usize = tables.iter().map(Table::stored_bytes).sum();
    let mut facts = vec![("tables", format!("{}, {}", tables.len(), words::bytes(bytes)))];
    if let [first, .., last] = subjects.stops[..] {
        facts.push(("shapes γ", format!("{} to {}", words::number(first), words::number(last))));
    } else if let [only] = subjects.stops[..] {
        facts.push(("shape γ", words::number(only)));
    }
    facts
}

pub(super) fn foot(source: &Source) -> Markup {
    let origin = source.set.provenance();
    html! {
        footer.wrap {
            "Baked by " (texts::words(&origin.generator)) ", numerics " (origin.numerics)
            @if !origin.license.is_empty() { ", licence " (texts::words(&origin.license)) }
            ". Drawn by microfacet-bake " (env!("CARGO_PKG_VERSION")) "."
        }
    }
}
