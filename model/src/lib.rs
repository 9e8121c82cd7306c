//! The Student-t microfacet model in double precision: the truth that tables are baked from and judged by.
//!
//! [`StudentT`] is the distribution of normals with roughness σx, σy and shape γ (Ribardière et al. 2017, *STD: Student's
//! t-distribution of slopes for microfacet based BSDFs*); GGX and Beckmann are its members γ = 2 and γ = ∞. Directions are unit
//! vectors in the tangent frame, n = +z, angles in radians. No tables and no files; every function is a formula
//! or a root found to rounding, and uses the `libm` crate, so that results are the same bits on every system.

mod albedo;
mod below_horizon;
pub mod classic;
mod converge;
mod distribution;
mod ellipsoid;
mod error;
pub mod fresnel;
mod lune;
mod ndf;
mod panels;
mod paper;
mod quadrature;
mod rejection;
mod shape;
mod slope_integrals;
mod smith_table;
#[cfg(feature = "statistics")]
pub mod statistics;
mod student_t;
mod transmission;
mod visible;
mod walk;

pub use albedo::{Albedo, AlbedoIntegrator};
pub use distribution::MicrofacetDistribution;
pub use ellipsoid::{Ellipsoid, EllipsoidError};
pub use error::ParameterError;
pub use lune::Lune;
pub use microfacet_common::{Masking, Roughness, Skew, SkewError};
pub use shape::{AsinhSlope, Shape};
pub use student_t::StudentT;
pub use visible::{SignedSlope, UnitView, VisibleSlope, across_cdf, across_quantile};

/// The formulas as the paper prints them, for comparison only; see each for where it fails.
pub mod printed {
    pub use crate::paper::*;
}
