//! Plots and tables of a page, and the typography of its texts.

use maud::{Markup, PreEscaped, html};

use crate::plot::{Figure, Panel};
use crate::words;

/// Size of a plot in pixels: about the width that a phone has for it, so that letters keep their
/// size there; two fit side by side on paper.
pub(super) const SIZE: [f64; 2] = [340.0, 290.0];

/// A panel as an element of the page; `label` describes it for screen readers.
pub(super) fn plot(panel: Panel, label: &str) -> Markup {
    let figure = Figure { panels: vec![panel], columns: 1, panel: SIZE };
    PreEscaped(figure.drawing().inline_svg(label))
}

/// A table that scrolls by itself, with headings of columns of words, then of columns of numbers.
pub(super) fn table(
    label: &str,
    caption: &Markup,
    [words, numbers]: [&[&str]; 2],
    rows: &Markup,
) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label=(label) {
            table {
                caption { (caption) }
                thead {
                    tr {
                        @for name in words { th scope="col" { (name) } }
                        @for name in numbers { th.number scope="col" { (name) } }
                    }
                }
                tbody { (rows) }
            }
        }
    }
}

/// An error to three digits, with a minus sign, at which no line breaks.
pub(super) fn error(x: f64) -> String {
    words::error(x).replace('-', "−")
}

/// The text with no-break spaces about its equals signs.
pub(super) fn unbroken(text: &str) -> String {
    text.replace(" = ", "\u{a0}=\u{a0}")
}

/// A text for terminals, with the names of Greek letters and of infinity replaced by symbols.
pub(super) fn symbols(text: &str) -> String {
    let is_part = |c: char| c.is_alphanumeric();
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let same = |c: char| is_part(c) == is_part(first);
        let end = rest.find(|c| !same(c)).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        out += match word {
            "gamma" => "γ",
            "sigma" => "σ",
            "theta" => "θ",
            "phi" => "φ",
            "eta" => "η",
            "inf" => "∞",
            _ => word,
        };
        rest = after;
    }
    out
}

/// A text as HTML, in which what backticks enclose is code.
pub(super) fn code(text: &str) -> Markup {
    let parts: Vec<&str> = text.split('`').collect();
    // With an odd number of backticks one belongs to a name, and none is taken for a mark.
    if parts.len().is_multiple_of(2) {
        return html! { (text) };
    }
    html! {
        @for (i, part) in parts.iter().enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neither_errors_nor_equations_are_broken() {
        assert_eq!(error(7.25e-5), "7.25e−5");
        assert_eq!(unbroken("γ = 3, σ = 0.2"), "γ\u{a0}=\u{a0}3, σ\u{a0}=\u{a0}0.2");
    }

    #[test]
    fn whole_words_become_letters_and_nothing_else_does() {
        let words = [
            ("gamma 1.501 to inf, sigma any", "γ 1.501 to ∞, σ any"),
            ("the view by z = cot(theta)/sigma", "the view by z = cot(θ)/σ"),
            ("information of a beta, theta_x", "information of a beta, θ_x"),
            ("σ·gamma", "σ·γ"),
            ("", ""),
        ];
        for (terminal, page) in words {
            assert_eq!(symbols(terminal), page);
        }
    }

    #[test]
    fn what_is_typed_is_code() {
        for (text, page) in [
            (
                "give `--albedo`, or `a < b`.",
                "give <code>--albedo</code>, or <code>a &lt; b</code>.",
            ),
            ("a lone ` and <b>", "a lone ` and &lt;b&gt;"),
            ("", ""),
        ] {
            assert_eq!(code(text).0, page);
        }
    }
}
