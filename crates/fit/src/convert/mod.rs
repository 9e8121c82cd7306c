//! Replaces one distribution by another: by equal half angles, by least squares, or by published
//! formulas.
//!
//! After Sawicki 2021, *Microfacet Distribution Function: To Change or Not to Change, That Is the
//! Question* (<https://doi.org/10.5220/0010252702090220>): the error of a replacement is the root
//! mean square of the difference over a uniform grid of θ in [0, π/2). [`table`] recomputes his
//! table 2, whose grids end earlier. Two further distances do not hang on the peak of D: the total
//! variation of the densities of slopes, and the largest difference of the reflections of a light.

use microfacet_baker::distribution::Named;

mod distance;
mod error;
mod formula;
pub mod table;
mod target;

pub use distance::{LIGHT_DEGREES, VIEW_DEGREES};
pub use error::ConvertError;
pub use formula::{Formula, by_formula, formulas, half_angle_parameter};
pub use target::Target;

/// The quantity that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// D(θ)/D(0): the shape of the highlight.
    Relative,
    /// D(θ) itself, normalised.
    Density,
}

/// A replacement and its errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Replacement {
    /// The distribution found.
    pub to: Named,
    /// RMSE of D/D(0), and of D in 1/sr.
    pub rmse: [f64; 2],
    /// Total variation of the densities of slopes, in [0, 1]: half of ∫ |difference|.
    pub variation: f64,
    /// The largest difference of D G2/(4 v·n l·n) over the largest value of the distribution that
    /// is replaced, with a light at [`LIGHT_DEGREES`] from the normal, views in the plane of
    /// incidence at most [`VIEW_DEGREES`] from it, and height-correlated masking.
    pub reflection: f64,
    /// Parameters found at the end of the range that was searched, beyond which a better value may
    /// lie; empty if none.
    pub ends_at: Vec<&'static str>,
}

#[cfg(test)]
mod tests;
