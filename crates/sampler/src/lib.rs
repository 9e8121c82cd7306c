//! Microfacet materials of the Student-t family at run time: evaluation and sampling from baked
//! tables.
//!
//! The Student-t distribution of slopes (roughness σ, shape γ; Ribardière, Bringier, Meneveaux,
//! Simonot 2017, <https://doi.org/10.1111/cgf.13137>) contains GGX (γ = 2) and Beckmann (γ = ∞) and
//! fits measured glass and metal better than either. Its Smith masking needs a hypergeometric
//! function, and its visible normals have no closed-form inverse; this crate reads both from
//! tables.
//!
#![doc = include_str!("picture.md")]
//!
//! *The seventy lines of `docs/first-renderer.md`.*
//!
//! Directions are unit vectors in the tangent frame, n = +z: `v` the view, `l` the light, `m` a
//! microfacet normal. They are taken from any type that converts to three `f32` and returned as
//! `[f32; 3]`. Angles are in radians, densities per steradian.
//!
//! A complete material:
//!
//! ```
//! use microfacet_sampler::{Bsdf, BsdfSettings, Compensation, Conductor};
//! use microfacet_sampler::{Metal, Tables, Transport};
//!
//! fn main() -> Result<(), microfacet_sampler::BindError> {
//!     let tables = Tables::embedded(); // 2.0 MB, compiled in; or Tables::from_bytes(&file)
//!     let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
//!     let gold = Conductor::new(tables.student_t(0.3, 2.5)?, Metal::Gold, settings)?;
//!
//!     let (v, l) = ([0.6, 0.0, 0.8], [0.0, 0.0, 1.0]);
//!     let (f, pdf) = gold.eval_pdf(v, l, Transport::Radiance); // f without the cosine
//!     let path = gold.sample(v, 0.2, [0.3, 0.7], Transport::Radiance); // l, weight
//!     assert!(f[0] > f[2] && pdf > 0.0 && path.is_some());
//!     Ok(())
//! }
//! ```
//!
//! A lobe for a BSDF of your own; a Fresnel reflectance would be a factor on weight and f:
//!
//! ```
//! use microfacet_sampler::lobe::Reflecting;
//! use microfacet_sampler::{Masking, MicrofacetDistribution, Tables};
//!
//! fn main() -> Result<(), microfacet_sampler::MaterialError> {
//!     let lobe = Tables::embedded().student_t(0.3, 2.5)?; // sigma, gamma
//!     let (v, masking) = ([0.6, 0.0, 0.8], Masking::HeightCorrelated);
//!     if let Some((l, weight)) = lobe.sample_reflected(v, [0.3, 0.7], masking) {
//!         let (f, pdf) = lobe.eval_pdf(v, l, masking); // only where a path needs it
//!         assert!((f * l[2] / pdf - weight).abs() < 1e-4);
//!     }
//!     assert!(lobe.g1(v) <= 1.0 && lobe.d([0.0, 0.0, 1.0]) > 0.0);
//!     Ok(())
//! }
//! ```
//!
//! Where textures give σ, or σ and γ, a material is made at every hit, and nothing is allocated:
//!
//! ```
//! use microfacet_sampler::{Bsdf, Compensation, Conductor, ConductorFresnel, Masking, Metal};
//! use microfacet_sampler::{Tables, Transport};
//!
//! fn main() -> Result<(), microfacet_sampler::MaterialError> {
//!     let (tables, masking) = (Tables::embedded(), Masking::HeightCorrelated);
//!     let (family, albedo) = (tables.family()?, tables.family_albedo(masking)?); // once
//!     let gold = ConductorFresnel::from(Metal::Gold);
//!
//!     let (sigma, gamma) = (0.3, 2.5); // of textures, at a hit
//!     let hit = Conductor::at_hit(family.at(sigma, gamma), gold, masking)
//!         .compensated_at(albedo.at(sigma, gamma), Compensation::KullaConty);
//!     let path = hit.sample([0.6, 0.0, 0.8], 0.2, [0.3, 0.7], Transport::Radiance);
//!     assert!(path.is_some());
//!     Ok(())
//! }
//! ```
//!
//! The materials of a scene, by their names in the recipe that a set was baked from:
//!
//! ```no_run
//! use microfacet_sampler::{Compensation, StandIn, Tables};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let set = Tables::from_bytes(&std::fs::read("out/tables.safetensors")?)?;
//!     let set = set.with_fallback(&Tables::embedded()); // for shapes that it does not hold
//!     let gold = set.bsdf("brushed gold", Compensation::KullaConty, StandIn::Refused)?;
//!     println!("{gold:?}");
//!     Ok(())
//! }
//! ```
//!
//! | to | use |
//! | --- | --- |
//! | load a set of tables | [`Tables::embedded`], [`Tables::from_bytes`], [`Tables::with_fallback`] |
//! | evaluate and sample a material | [`Conductor`], [`Dielectric`], [`Plastic`]: [`Bsdf`]; [`Tables::bsdf`] by name |
//! | put haze around a material, or send light back | [`Haze`], [`Retroreflective`] |
//! | get a lobe | [`Tables::student_t`], [`Tables::ellipsoid`], [`Tables::material`] by name, [`Ggx`] without tables |
//! | evaluate and sample a lobe | [`MicrofacetDistribution`]: D, G1, visible normals; [`lobe::Reflecting`]: reflection off them; [`lobe::Batch`]: whole slices |
//! | draw normals without tables, whatever γ | [`lobe::PseudoVisible`] |
//! | lose fewer samples below the horizon | [`StudentT::bounded`]; [`Lobe::for_reflection`] where it pays |
//! | compensate multiple scattering yourself | [`Tables::albedo`], [`albedo::Albedo`] |
//! | take σ from a texture | [`StudentT::with_roughness`], also of a bounded lobe; [`Ellipsoid::with_skew`] |
//! | take σ and γ from textures | [`Tables::family`], [`Tables::family_albedo`], [`Tables::family_dielectric`]; `at_hit` of [`Conductor`], [`Dielectric`] and [`Plastic`] |
//! | write a set, or read one table | the crate [`microfacet_tables`] |
//! | write the lookups in another language | [`port`] |
//!
//! # Features, targets and versions
//!
//! - `std` (default): hardware square roots. Without it the crate is `no_std` with `alloc`, by
//!   `libm`, with the same results. It builds for `thumbv7em-none-eabi` and
//!   `wasm32-unknown-unknown`. Nothing depends on the width of pointers or on the order of bytes:
//!   the tests pass on 32 bits too (`.ci/wasm`), and those of the files on big-endian `s390x`
//!   (`cargo +nightly miri test -p microfacet-tables --target s390x-unknown-linux-gnu --lib`).
//! - `embedded` (default): the default set, [`Tables::embedded`], 2.0 MB of γ ∈ [1.501, ∞].
//! - No unsafe code, but for the instructions of 8 lanes, in the small crate `microfacet-lanes`.
//!   Batches run in 8 lanes where the processor has AVX2 (without `std`: where it is compiled in),
//!   and in 4 elsewhere, with the same bits. Every type is `Send` and `Sync`; nothing is cached
//!   behind a lock.
//! - The oldest compiler is Rust 1.89; a later one is required by a new minor version only.
//!   Versions follow semantic versioning: before 1.0 a minor version may break programs, and the
//!   changelog says how. Other numbers than before, beyond the errors that are stated, count as a
//!   break. [`port`] may change in any minor version, after 1.0 too. [What a version
//!   promises][policy] has the rest.
//!
//! [policy]: https://github.com/OWNER/microfacet-bake/blob/HEAD/docs/policy.md

#![cfg_attr(not(feature = "std"), no_std)]
// What a function returns is all that it does.
#![warn(clippy::must_use_candidate, clippy::return_self_not_must_use)]

extern crate alloc;

pub mod albedo;
pub mod port;

mod bind_error;
mod bsdf;
mod elementary;
mod error;
mod material;
mod tables;
mod vector;

pub use bind_error::BindError;
pub use bsdf::{
    AnyBsdf, BoundInterface, Bsdf, BsdfSample, BsdfSettings, Compensation, Conductor,
    ConductorFresnel, Dielectric, DielectricAt, Event, FamilyDielectric, Haze, InterfaceAlbedo,
    Metal, Plastic, Retroreflective, StandIn, Transport, UnknownMetal,
};
pub use error::MaterialError;
pub use material::{Ellipsoid, Family, Ggx, Lobe, MicrofacetDistribution, StudentT};
pub use microfacet_core::{Masking, Skew};
pub use microfacet_tables::LoadError;
#[cfg(feature = "embedded")]
pub use tables::DEFAULT_SET;
pub use tables::Tables;

/// What lobes can do beyond [`MicrofacetDistribution`], arguments and results of their functions,
/// and the lobes of special materials.
pub mod lobe {
    pub use crate::error::BatchError;
    pub use crate::material::{
        Batch, Bounded, BoundedFamilyLobe, BoundedRef, BoundedView, EllipsoidRef, Facet,
        FamilyLobe, LobeKey, PseudoVisible, Radial, Reflecting, Smooth, StudentTRef, Tabulated,
    };
    pub use microfacet_core::{Roughness, SkewError};
}

/// The examples of this crate's README, so that they keep compiling.
#[cfg(all(doctest, feature = "embedded"))]
#[doc = include_str!("../README.md")]
struct Readme;
