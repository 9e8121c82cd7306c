//! A set as one HTML page: what it holds, where its errors are, and how its materials look. The
//! page is one file, and needs a browser but no network.
//!
//! [`page()`] makes it, one section a file; [`error_map`] measures a table over two of its axes,
//! with the error measures of its certificate; [`picture`] is the sphere of a material by the
//! sampler's BSDFs, as the page draws it in WebGL.
//!
//! [`plot`] has figures of the literature and of the model as data, and writes them as SVG and PNG.
//! [`words`] describes sets, tables, certificates and verdicts, the same in commands and pages.

mod by_lobe;
mod curves;
mod drawing;
mod energy;
pub mod error_map;
mod errors;
mod head;
mod overview;
mod page;
pub mod plot;
mod scripts;
mod served;
mod sphere;
mod subjects;
mod texts;
mod validated;
pub mod words;

use microfacet_baker::progress::Meter;
use microfacet_sampler::{MaterialError, Tables};
use microfacet_tables::LoadError;
use microfacet_validate::record::Record;

pub use sphere::{Film, Look, picture, srgb, tangent_frame};

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The name of the set, for its title.
    pub name: &'a str,
    /// The set.
    pub set: &'a Tables,
    /// The record of a validation of the set.
    pub validation: Option<&'a Record>,
}

/// Why there is no page.
#[derive(thiserror::Error)]
pub enum ReportError {
    /// The set has neither tables nor materials.
    #[error("the set has no tables and no materials; name what `microfacet-bake bake` wrote")]
    Empty,
    /// The set does not hold what it declares to cover.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The validation is of another set.
    #[error(
        "a validation of another set ({of:?}, and this one is {set:?}); give one of the set that \
         is reported"
    )]
    OtherSet {
        /// The identity of the set that was validated.
        of: String,
        /// The identity of the set of the page.
        set: String,
    },
    /// The set could not be written, and so has no identity.
    #[error(transparent)]
    Unsound(LoadError),
}

microfacet_core::debug_in_words!(ReportError);

/// Whether a set has anything to show: a page of a set without tables and materials is refused.
pub fn has_page(set: &Tables) -> bool {
    !set.tables().is_empty() || !set.provenance().materials.is_empty()
}

/// The estimated seconds of [`page`] on the current threads.
pub fn seconds(source: &Source) -> f64 {
    errors::seconds(source.set) + energy::seconds(source.set) + sphere::seconds(source.set)
}

/// The page as HTML. Its sections are stages of the meter, which is to expect [`seconds`].
///
/// # Errors
/// [`ReportError`] for a set with nothing to show, or one that lacks what it declares, and for a
/// validation of another set.
pub fn page(source: &Source, meter: &Meter) -> Result<String, ReportError> {
    if !has_page(source.set) {
        return Err(ReportError::Empty);
    }
    validated::check(source)?;
    page::page(source, meter)
}

#[cfg(test)]
mod tests;
