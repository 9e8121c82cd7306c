//! The live sphere: data, shaders and pictures of it.

use maud::{Markup, html};
use microfacet_sampler::Tables;

use super::subjects::Subjects;
use super::{ReportError, Source};
use crate::progress::Meter;

/// What the section of the sphere is made of.
pub(super) struct Parts {
    /// The stage: canvas, controls, and the pictures beside it.
    pub(super) body: Markup,
    /// Data and script, at the end of the page.
    pub(super) scripts: Markup,
}

/// The estimated seconds of [`parts`] on the current threads.
pub(super) fn seconds(_set: &Tables) -> f64 {
    0.0
}

/// `None` for a set without a lobe of the family.
pub(super) fn parts(
    _source: &Source,
    _subjects: &Subjects,
    _meter: &Meter,
) -> Result<Option<Parts>, ReportError> {
    Ok(Some(Parts { body: html! {}, scripts: html! {} }))
}
