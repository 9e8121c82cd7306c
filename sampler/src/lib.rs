//! Run-time evaluation and sampling of Student-t microfacet materials from baked tables.
//!
//! A renderer loads a set once ([`Tables::embedded`] or [`Tables::from_bytes`]), binds each material
//! ([`Tables::student_t`]), and then evaluates `d`, `g1`, `g2`, samples visible normals and evaluates their density through [`StudentT`].
//! Directions are unit vectors in the tangent frame, n = +z; angles are in radians.
//!
//! The crate is `no_std` with `alloc` when its default features are off.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

pub mod axis;

mod albedo;
mod bsdf;
mod error;
mod format;
#[doc(hidden)]
pub mod internals;
mod lanes;
mod material;
mod math;
mod tables;

pub use albedo::{Albedo, DielectricAlbedo, FresnelAlbedo, Moments, ViewCurve};
pub use axis::{Axis, Interpolation, Mapping};
pub use bsdf::{f82_tint_average, fresnel_average, schlick_average};
pub use error::{BatchError, LoadError, MaterialError};
pub use format::{
    Channels, Covered, FORMAT, FresnelEntry, Kind, LobeEntry, MaterialEntry, Precision, Provenance,
    Reflectance, Side, Subject, Table, VERSION, encode,
};
pub use material::{Bounded, Ellipsoid, Ggx, Lobe, MicrofacetDistribution, Radial, StudentT};
pub use microfacet_common::{Masking, Roughness, Skew, SkewError};
pub use tables::Tables;

/// The README's example, so that it keeps compiling.
#[cfg(all(doctest, feature = "embedded"))]
#[doc = include_str!("../../README.md")]
struct Readme;
