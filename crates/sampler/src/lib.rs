//! Microfacet materials of the Student-t family at run time: evaluation and sampling from baked
//! tables.
//!
//! The Student-t distribution of slopes (roughness σ, shape γ; Ribardière, Bringier, Meneveaux,
//! Simonot 2017, <https://doi.org/10.1111/cgf.13137>) contains GGX (γ = 2) and Beckmann (γ = ∞) and
//! fits measured glass and metal better than either. Its Smith masking needs a hypergeometric
//! function, and its visible normals have no closed-form inverse; this crate reads both from
//! tables. It is `no_std` with `alloc` when its default features are off.
//!
//! Directions are unit vectors in the tangent frame, n = +z: `v` the view, `l` the light, `m` a
//! microfacet normal. Angles are in radians, densities per steradian.
//!
//! | to | use |
//! | --- | --- |
//! | load a set of tables | [`Tables::embedded`], [`Tables::from_bytes`] |
//! | get a lobe | [`Tables::student_t`], [`Tables::ellipsoid`], [`Tables::material`] by name, [`Ggx`] without tables |
//! | evaluate and sample a material | [`Conductor`], [`Dielectric`], [`Plastic`]: [`Bsdf`]; [`Tables::bsdf`] by name, [`Metal`] |
//! | evaluate and sample a lobe for a BSDF of your own | [`MicrofacetDistribution`]: D, G1, Λ, G2, weights, visible normals and their densities, batches |
//! | lose fewer samples below the horizon | [`StudentT::bounded`], prepared once for a material |
//! | compensate multiple scattering | [`Conductor::compensated`]; [`Tables::albedo`], [`albedo::Albedo`] |
//! | write a set, or read one table | the crate [`microfacet_tables`] |
//! | write the lookups in another language | [`port`] |
//!
//! # A material
//!
//! Load a set once, and for each material make a lobe and from it a BSDF, which gives `f`, a
//! density and samples. [`Bsdf`] has the conventions. Compensation of multiple scattering reads
//! tables of albedos too. A rough [`Plastic`] reads those of its coat in any case, and the default
//! set has none of dielectrics: bake a recipe that names the plastic, and load the set by
//! [`Tables::from_bytes`].
//!
//! ```
//! # #[cfg(feature = "embedded")] {
//! use microfacet_sampler::glam::Vec3;
//! use microfacet_sampler::{Bsdf, Compensation, Conductor, Metal, StandIn, Tables, Transport};
//!
//! let tables = Tables::embedded(); // or Tables::from_bytes(&file)
//! let lobe = tables.student_t([0.3, 0.3], 2.5)?; // sigma, or [sigma_x, sigma_y]; gamma
//! let gold = Conductor::new(lobe, Metal::Gold)
//!     .compensated(&tables, Compensation::KullaConty, StandIn::Refused)?;
//!
//! let v = Vec3::new(0.6, 0.0, 0.8);
//! let (f, pdf) = gold.eval_pdf(v, Vec3::Z, Transport::Radiance);
//! let path = gold.sample(v, 0.2, [0.3, 0.7], Transport::Radiance).unwrap();
//! # assert!(f[0] > f[2] && pdf > 0.0 && path.weight[0] > 0.0 && path.pdf > 0.0);
//! # }
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # A BSDF of your own
//!
//! The weight f·cos/pdf of a reflection off a visible normal is G2/G1 in closed form:
//!
//! ```
//! use microfacet_sampler::glam::Vec3;
//! use microfacet_sampler::{Masking, MicrofacetDistribution};
//!
//! /// A light, its weight without Fresnel, and its density.
//! fn reflect(lobe: &impl MicrofacetDistribution, v: Vec3, u: [f32; 2]) -> (Vec3, f32, f32) {
//!     let (m, pdf) = lobe.sample_with_pdf(v, u);
//!     let l = 2.0 * v.dot(m) * m - v;
//!     // Rounding may make v.m 0 or less: such a light has the weight 0.
//!     let pdf = if v.dot(m) > 0.0 { pdf / (4.0 * v.dot(m)) } else { 0.0 };
//!     (l, lobe.reflection_weight(v, l, Masking::HeightCorrelated), pdf)
//! }
//! # let ggx = microfacet_sampler::Ggx::new(0.3).unwrap();
//! # let (l, weight, pdf) = reflect(&ggx, Vec3::new(0.6, 0.0, 0.8), [0.3, 0.7]);
//! # assert!(l.z > 0.0 && weight > 0.9 && weight <= 1.0 && pdf > 0.0);
//! ```
//!
//! For next-event estimation, the single-scattering lobe is D·G2/(4 (v·n)), cosine included.
//!
//! # Materials by name
//!
//! A set baked from a recipe lists its materials, whatever their distribution, with their forms of
//! masking in its [`Provenance`](Tables::provenance); [`Lobe`] is any of them. GTR, Gauss, Schlick
//! and measured distributions are a [`Radial`](lobe::Radial), with tables of their own.
//!
//! ```no_run
//! # use microfacet_sampler::{Lobe, MicrofacetDistribution, Tables};
//! let set = Tables::from_bytes(&std::fs::read("out/tables.safetensors")?)?;
//! let gold: Lobe = set.material("brushed gold")?;
//! if gold.is_effectively_smooth() {
//!     // a mirror: no microfacets needed
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ellipsoids
//!
//! A lobe of any γ may be tilted and turned, or have its slopes transformed by any 2×2 matrix: the
//! Ellipsoid NDF, generalised. It reads the same tables.
//!
//! ```
//! # #[cfg(feature = "embedded")] {
//! # use microfacet_sampler::glam::Vec3;
//! # use microfacet_sampler::{MicrofacetDistribution, Skew, Tables};
//! let skew = Skew::new([0.3, 0.1], [0.2, -0.1, 0.5])?; // sigma; turns about x, y, z
//! let brushed = Tables::embedded().ellipsoid(skew, 2.7)?;
//! assert!(brushed.g1(Vec3::new(0.6, 0.0, 0.8)) <= 1.0);
//! # }
//! # Ok::<(), microfacet_sampler::MaterialError>(())
//! ```
//!
//! # Batches
//!
//! Functions over whole slices of views. Student-t lobes compute four at once: the same normals, to
//! 2 ulp, in 40 % of the time, and G1 in 60 % (`cargo run --profile dist -p microfacet-bench`).
//! Other lobes compute them one by one.
//!
//! ```
//! # #[cfg(feature = "embedded")] {
//! # use microfacet_sampler::glam::Vec3;
//! # use microfacet_sampler::{MicrofacetDistribution, Tables};
//! let lobe = Tables::embedded().student_t(0.3, 4.0)?;
//! let (v, u) = ([Vec3::new(0.6, 0.0, 0.8); 64], [[0.3, 0.7]; 64]);
//! let mut m = [Vec3::ZERO; 64];
//! lobe.sample_batch(&v, &u, &mut m)?;
//! # assert_eq!(m[63], m[0]);
//! # }
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # Albedo and multiple scattering
//!
//! [`Bsdf`]s compensate multiple scattering themselves; [`Albedo`](albedo::Albedo) is for a BSDF of
//! your own. It gives the share of light that one bounce returns, E(v), its average, and two
//! moments from which the albedo of every Schlick reflectance follows. Two compensations of the
//! missing light are made from it: a factor on the lobe ([`turquin`](albedo::Albedo::turquin)) and
//! a lobe of its own ([`compensation`](albedo::Albedo::compensation)).
//!
//! ```
//! # #[cfg(feature = "embedded")] {
//! # use microfacet_sampler::glam::Vec3;
//! # use microfacet_sampler::{Masking, Tables};
//! let albedo = Tables::embedded().albedo(0.8, 3.0, Masking::HeightCorrelated)?;
//! let v = Vec3::new(0.6, 0.0, 0.8);
//! let gold = albedo.moments(v).schlick(0.77, 1.0); // green: F0, F90
//! let factor = albedo.turquin(v, 0.77);
//! assert!(albedo.albedo(v) < 1.0 && gold < albedo.albedo(v) && factor > 1.0);
//! # }
//! # Ok::<(), microfacet_sampler::MaterialError>(())
//! ```
//!
//! # Features
//!
//! - `std` (default): hardware square roots. Without it the crate is `no_std`, by `libm`, with the
//!   same results.
//! - `embedded` (default): the default set, [`Tables::embedded`], 1.7 MB of γ ∈ [1.501, ∞].

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

pub mod albedo;
pub mod bsdf;
pub mod port;

mod elementary;
mod error;
mod material;
mod tables;
mod vector;

// Callers need these in the version that this crate is built with.
pub use glam;
pub use microfacet_tables;

pub use bsdf::{
    AnyBsdf, BindError, Bsdf, BsdfSample, Compensation, Conductor, ConductorFresnel, Dielectric,
    Metal, Plastic, StandIn, Transport,
};
pub use error::MaterialError;
pub use material::{Ellipsoid, Ggx, Lobe, MicrofacetDistribution, StudentT};
pub use microfacet_core::{Masking, Skew};
pub use microfacet_tables::LoadError;
#[cfg(feature = "embedded")]
pub use tables::DEFAULT_SET;
pub use tables::Tables;

/// Arguments and results of [`MicrofacetDistribution`]s, and the lobes of special materials.
pub mod lobe {
    pub use crate::error::BatchError;
    pub use crate::material::{Bounded, BoundedView, Facet, LobeKey, Radial, Smooth};
    pub use microfacet_core::{Roughness, SkewError};
}

/// The examples of this crate's README, so that they keep compiling.
#[cfg(all(doctest, feature = "embedded"))]
#[doc = include_str!("../README.md")]
struct Readme;
