//! What was baked, what was skipped and why.

use maud::{Markup, html};

use super::Source;
use super::subjects::Subjects;

pub(super) fn section(_source: &Source, _subjects: &Subjects) -> Markup {
    html! {}
}
