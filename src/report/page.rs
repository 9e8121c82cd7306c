//! The page as a whole: its head, its sections in order, its style.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::subjects::Subjects;
use super::{ReportError, Source, chi_square, curves, energy, errors, overview, sphere};
use crate::progress::Meter;

/// Nothing is loaded: neither scripts nor pictures from elsewhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline'; img-src data: blob:";

pub(super) fn page(source: &Source, meter: &Meter) -> Result<String, ReportError> {
    let subjects = Subjects::of(source.set);
    let sphere = sphere::parts(source, &subjects, meter)?;
    let sections = [
        ("materials", "What was baked", overview::section(source, &subjects)),
        ("curves", "Masking and albedo", curves::section(source, &subjects)),
        ("energy", "Energy", energy::section(source, &subjects, meter)?),
        ("errors", "Where the error is", errors::section(source, &subjects, meter)?),
        ("chi-square", "Chi-square", chi_square::section(source)),
    ];
    let (body, scripts) = match sphere {
        Some(parts) => (parts.body, parts.scripts),
        None => (html! {}, html! {}),
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { (source.name) " · microfacet-bake" }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                header { h1 { (source.name) } }
                main {
                    (body)
                    @for (id, title, content) in &sections {
                        (section(id, title, content))
                    }
                }
                (scripts)
            }
        }
    };
    Ok(page.into_string())
}

/// A section with its heading; nothing without content.
fn section(id: &str, title: &str, content: &Markup) -> Markup {
    html! {
        @if !content.0.is_empty() {
            section id=(id) aria-labelledby=(format!("{id}-title")) {
                h2 id=(format!("{id}-title")) { (title) }
                (content)
            }
        }
    }
}
