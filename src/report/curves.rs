//! G1 and E of the lobes shown, beside GGX and Beckmann of the same σ.

use maud::{Markup, html};

use super::Source;
use super::subjects::Subjects;

pub(super) fn section(_source: &Source, _subjects: &Subjects) -> Markup {
    html! {}
}
