//! Where the errors of tables are: heat maps over their axes.

use maud::{Markup, html};
use microfacet_sampler::Tables;

use super::subjects::Subjects;
use super::{ReportError, Source};
use crate::progress::Meter;

/// The estimated seconds of [`section`] on the current threads.
pub(super) fn seconds(_set: &Tables) -> f64 {
    0.0
}

pub(super) fn section(
    _source: &Source,
    _subjects: &Subjects,
    _meter: &Meter,
) -> Result<Markup, ReportError> {
    Ok(html! {})
}
