//! The chi-square tests of a validation that ran.

use maud::{Markup, html};

use super::Source;

/// What `microfacet-bake validate --json` printed.
#[derive(Clone, Debug)]
pub struct Validation;

pub(super) fn section(_source: &Source) -> Markup {
    html! {}
}
