//! The page as a whole: its head, its sections in order, its style.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use microfacet_baker::escape::lines;
use microfacet_baker::progress::Meter;

use super::by_lobe::by_lobe;
use super::scripts::{policy, verbatim};
use super::subjects::Subjects;
use super::texts;
use super::{ReportError, Source, curves, energy, errors, head, overview, sphere, validated};

/// The script of what is outside the sections.
const SCRIPT: &str = concat!(include_str!("theme.js"), include_str!("contents.js"));

/// A part of the page with a heading of its own.
struct Section {
    id: &'static str,
    title: &'static str,
    /// What it shows, in a sentence or two.
    lead: &'static str,
    content: Markup,
}

pub(super) fn page(source: &Source, meter: &Meter) -> Result<String, ReportError> {
    // Figures are of one lobe each.
    let set = by_lobe(source.set);
    let lobes = &Source { set: &set, ..*source };
    let subjects = Subjects::of(&set);
    let (mut look, mut data, mut scripts) = (html! {}, html! {}, vec![SCRIPT]);
    if let Some(parts) = sphere::parts(lobes, &subjects, meter)? {
        (look, data) = (parts.body, parts.data);
        scripts.push(parts.script);
    }
    let sections = [
        Section {
            id: "look",
            title: "Look",
            lead: "The roughness σ sets how wide a highlight is, the shape γ how far it glows: \
                   γ\u{a0}=\u{a0}2 is GGX, ∞ is Beckmann, and less than 2 has longer tails.",
            content: look,
        },
        Section {
            id: "baked",
            title: "What was baked",
            lead: "What the set holds, what was left out of it, and why.",
            content: overview::section(source),
        },
        Section {
            id: "curves",
            title: "Masking and albedo",
            lead: "Facets mask each other: G1 is the share of them that a view sees. The directional \
                   albedo E is the share of light that one bounce returns if facets reflect all of \
                   it. Each lobe is shown beside GGX and Beckmann of the same roughness σ.",
            content: curves::section(lobes, &subjects),
        },
        Section {
            id: "energy",
            title: "Energy",
            lead: "A white furnace: facets that reflect all light, lit from everywhere. What is \
                   missing from 1 is light that further bounces would return, and what compensation \
                   brings back.",
            content: energy::section(lobes, &subjects, meter)?,
        },
        Section {
            id: "errors",
            title: "Where the error is",
            lead: "The error of each table between its nodes, against the model in double \
                   precision. A ring marks the place of the largest error that was certified when \
                   the table was baked.",
            content: errors::section(lobes, meter)?,
        },
        Section {
            id: "validation",
            title: "Validation",
            lead: "Normals that were drawn from the tables, counted, and compared with the density \
                   of the model by chi-square.",
            content: validated::section(source),
        },
    ];
    let sections = sections.iter().filter(|section| !section.content.0.is_empty());
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(policy(&scripts));
                meta name="generator" content=(concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")));
                title { (texts::short(source.name)) " · microfacet-bake" }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                a.skip href="#main" { "To the content" }
                (head::head(source, &subjects))
                nav.contents aria-label="Sections" {
                    ul.wrap {
                        @for section in sections.clone() {
                            li { a href=(format!("#{}", section.id)) { (section.title) } }
                        }
                    }
                }
                main #main .wrap {
                    @for section in sections { (section.html()) }
                }
                (head::foot(source))
                (data)
                @for script in &scripts { script type="module" { (verbatim(script)) } }
            }
        }
    };
    // The program's own text has no character that is not seen, but names of a file may have some.
    Ok(lines(&page.into_string()).into_owned())
}

impl Section {
    fn html(&self) -> Markup {
        let title = format!("{}-title", self.id);
        html! {
            section id=(self.id) aria-labelledby=(title) {
                h2 id=(title) { (self.title) }
                p { (self.lead) }
                (self.content)
            }
        }
    }
}
