//! The Student-t microfacet model in double precision: the reference that tables are baked from and
//! measured against.
//!
//! [`StudentT`] is the distribution of normals with roughness σx, σy and shape γ (Ribardière,
//! Bringier, Meneveaux, Simonot 2017, *STD: Student's t-Distribution of Slopes for Microfacet Based
//! BSDFs*, <https://doi.org/10.1111/cgf.13137>); GGX and Beckmann are its members γ = 2 and γ = ∞.
//! Directions are unit vectors in the tangent frame, n = +z, angles in radians. There are no tables
//! and no files; every function is a formula or a root found to rounding, and uses the `libm`
//! crate, so that results are the same bits on every system.
//!
//! | to | use |
//! | --- | --- |
//! | evaluate and sample a lobe | [`MicrofacetDistribution`] of [`StudentT`], [`Ellipsoid`] and [`classic::Radial`] |
//! | draw visible normals without inverting a CDF | [`StudentT::sample_visible_by_rejection`] |
//! | draw pseudo-visible normals, in closed form | [`StudentT::sample_pseudo_visible_normal`] |
//! | integrate an albedo | [`AlbedoIntegrator`], [`classic::RadialAlbedo`] |
//! | scatter more than once | [`StudentT::walk`] |
//! | reflect at conductors and dielectrics | [`fresnel`] |
//! | use GTR, Gauss, Schlick, Sawicki or a measured D | [`classic`] |
//! | get the marginals, CDFs and quantiles of one shape | [`Shape`], [`VisibleSlope`] |
//! | test a sampler of your own | `statistics` |
//!
//! # D, masking, visible normals
//!
//! ```
//! use microfacet_model::glam::DVec3;
//! use microfacet_model::{Masking, MicrofacetDistribution, StudentT};
//!
//! let gold = StudentT::new([0.3, 0.1], 4.0)?; // sigma; gamma
//! let v = DVec3::new(0.6, 0.0, 0.8);
//! let (m, pdf) = gold.sample_with_pdf(v, [0.3, 0.7]);
//! let l = 2.0 * v.dot(m) * m - v;
//! assert!((pdf / (gold.g1(v) * v.dot(m) * gold.d(m) / v.z) - 1.0).abs() < 1e-12);
//! assert!(gold.reflection_weight(v, l, Masking::HeightCorrelated) <= 1.0);
//! # Ok::<(), microfacet_model::ParameterError>(())
//! ```
//!
//! # Albedos
//!
//! By quadrature, to the tolerance that is asked for; the weight is any function of v·m.
//!
//! ```
//! use microfacet_model::{AlbedoIntegrator, Masking, Shape};
//!
//! let integrator = AlbedoIntegrator::new(Shape::new(3.0)?, 1e-9); // tolerance
//! let albedo = integrator.reflection(0.5, 0.8, |_| [1.0])?; // sigma, cos theta, weights
//! let [e] = albedo.of(Masking::HeightCorrelated);
//! assert!(e > 0.8 && e < 1.0);
//! # Ok::<(), microfacet_model::ParameterError>(())
//! ```
//!
//! # Feature
//!
//! `statistics`: chi-square and Kolmogorov–Smirnov tests of samplers against the model.

mod albedo;
mod below_horizon;
pub mod classic;
mod converge;
mod distribution;
mod ellipsoid;
mod error;
pub mod fresnel;
mod interface;
mod lune;
mod ndf;
mod panels;
mod paper;
mod piecewise;
mod pseudo;
mod quadrature;
mod rejection;
mod shape;
mod slope_integrals;
mod slope_table;
mod smith_table;
#[cfg(feature = "statistics")]
pub mod statistics;
mod student_t;
mod transmission;
mod visible;
mod walk;

// Callers need glam in the version that this crate is built with.
pub use glam;

pub use albedo::AlbedoIntegrator;
pub use converge::Albedo;
pub use distribution::MicrofacetDistribution;
pub use ellipsoid::{Ellipsoid, EllipsoidError};
pub use error::ParameterError;
pub use lune::Lune;
pub use microfacet_core::{Masking, Roughness, Skew, SkewError};
pub use shape::{AsinhSlope, Shape};
pub use student_t::StudentT;
pub use visible::{SignedSlope, UnitView, VisibleSlope, across_cdf, across_quantile};

/// The formulas as the paper prints them, for comparison only; the documentation of each says where
/// it fails.
pub mod printed {
    pub use crate::paper::*;
}

/// The example of this crate's README, so that it keeps compiling.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
