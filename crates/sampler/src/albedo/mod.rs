//! Directional albedos from tables: the share of light that one bounce off the microsurface
//! returns.
//!
//! Every lobe and reflectance goes the same way: `find` chooses the table by its description,
//! `curve` collapses the axes of the material, which leaves a curve over the view, and
//! `directional` makes moments of its channels. `shape` collapses the axis of γ alone, and `family`
//! none: they are for renderers that take σ, or both, from textures, as `interface` is for
//! dielectrics. `common` is what the three forms of moments have in common.
//!
//! The averages of reflectances over the hemisphere are for a compensation of your own.

mod average;
mod batch;
mod common;
mod curve;
mod directional;
mod elevation;
pub(crate) mod family;
mod find;
mod interface;
mod moments;
mod reflectance_average;
mod shape;

pub use crate::error::Covered;
pub use common::DirectionalAlbedo;
pub use curve::{DielectricAlbedo, FresnelAlbedo, ViewCurve};
pub use directional::Albedo;
#[doc(hidden)]
pub use elevation::View;
pub use family::{AlbedoAt, FamilyAlbedo};
pub(crate) use interface::{InterfaceAlbedos, InterfaceAt};
pub use interface::{InterfaceAxis, InterfaceSide, InterfaceTables};
pub use moments::Moments;
pub use reflectance_average::{f82_tint_average, fresnel_average, schlick_average};
pub use shape::{ShapeAlbedo, ShapeAlbedoAt};
