//! Texts of a file as a page shows them: in an isolated direction of writing, and cut where they
//! are long, with the whole as their tooltip.

use std::borrow::Cow;

use maud::{Markup, html};

/// Most letters of a name.
const NAME: usize = 64;
/// Most letters of a text in words.
const WORDS: usize = 400;
/// Most letters of a tooltip.
const WHOLE: usize = 1000;

/// A name.
pub(super) fn name(text: &str) -> Markup {
    shown(text, NAME)
}

/// Words, such as a licence or a reason.
pub(super) fn words(text: &str) -> Markup {
    shown(text, WORDS)
}

/// A name where no element can stand: in an attribute, an option or a drawing.
pub(super) fn short(text: &str) -> Cow<'_, str> {
    cut(text, NAME)
}

/// The text, of at most this many letters; the last of them says that there are more.
pub(super) fn cut(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        None => text.into(),
        Some(_) => text.chars().take(most - 1).chain(['…']).collect(),
    }
}

fn shown(text: &str, most: usize) -> Markup {
    match cut(text, most) {
        Cow::Borrowed(whole) => html! { bdi { (whole) } },
        Cow::Owned(start) => html! { bdi title=(cut(text, WHOLE)) { (start) } },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_is_cut_between_letters_and_told_as_a_tooltip() {
        assert_eq!(name("<a>").0, "<bdi>&lt;a&gt;</bdi>");
        assert_eq!(cut("σσσ", 3), "σσσ");
        assert_eq!(cut("σσσσ", 3), "σσ…");
        let long = "σ".repeat(NAME + 1);
        let start = "σ".repeat(NAME - 1);
        assert_eq!(name(&long).0, format!("<bdi title=\"{long}\">{start}…</bdi>"));
        assert!(words(&"x".repeat(1 << 20)).0.len() < WHOLE + WORDS + 100);
    }
}
