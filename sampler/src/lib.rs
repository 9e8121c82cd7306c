//! Run-time evaluation and sampling of Student-t microfacet materials from baked tables.
//!
//! A renderer loads a set once ([`Tables::embedded`] or [`Tables::from_bytes`]), binds each material
//! ([`Tables::student_t`]), and then evaluates `d`, `g1`, `g2`, samples visible normals and evaluates their density through [`StudentT`].
//! Directions are unit vectors in the tangent frame, n = +z; angles are in radians.
//!
//! The crate is `no_std` with `alloc` when its default features are off.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

mod albedo;
mod albedo_axes;
mod axis;
mod azimuth;
mod batch;
mod below;
mod bind;
mod bounded;
mod cells;
mod compensation;
mod container;
mod critical;
mod dielectric_albedo;
mod ellipsoid;
mod error;
mod fresnel_albedo;
mod ggx;
mod math;
mod plain;
mod radial;
mod sample;
mod student_t;
mod table;
mod table_pdf;
mod tables;
mod view_albedo;

pub use albedo::{Albedo, Moments};
pub use axis::{Axis, Interpolation, Mapping};
pub use bounded::Bounded;
pub use cells::limit_slopes;
pub use compensation::{f82_tint_average, fresnel_average, schlick_average};
pub use container::{
    FORMAT, FresnelEntry, MaterialEntry, Precision, Provenance, VERSION, describe, encode, reassemble,
};
pub use dielectric_albedo::DielectricAlbedo;
pub use ellipsoid::{Ellipsoid, Skew};
pub use error::{BatchError, BindError, LoadError};
pub use fresnel_albedo::{FresnelAlbedo, ViewCurve};
pub use radial::Radial;
pub use student_t::{Masking, Roughness, StudentT};
pub use table::{Kind, Table};
pub use tables::Tables;
pub use view_albedo::ViewAlbedo;

/// The README's example, so that it keeps compiling.
#[cfg(all(doctest, feature = "embedded"))]
#[doc = include_str!("../../README.md")]
struct Readme;
