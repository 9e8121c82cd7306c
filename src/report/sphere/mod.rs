//! The live sphere: data, shaders and pictures of it.

mod random;
mod scene;
mod studio;
mod tone;

use maud::{Markup, html};
use microfacet_sampler::{BindError, Tables};

use super::subjects::Subjects;
use super::{ReportError, Source};
use crate::progress::Meter;
pub use scene::{Film, Look};
use scene::Scene;

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

/// The sphere of a page as RGB, from the upper left, by the crate's own BSDFs.
///
/// # Errors
/// [`BindError`] for a shape that neither the set nor the default set covers.
pub fn picture(set: &Tables, look: &Look, film: Film) -> Result<Vec<[u8; 3]>, BindError> {
    Ok(Scene::new(&set.clone().or_embedded(), look)?.picture(film))
}
