//! Directional albedos from tables: the share of light that one bounce off the microsurface
//! returns.
//!
//! One mechanism serves every lobe and reflectance: [`find`] chooses the table by its description,
//! [`curve`] collapses the axes of the material, which leaves a curve over the view, and
//! [`directional`] or [`fresnel`] say what its channels mean.

mod average;
mod curve;
mod directional;
mod domain;
mod elevation;
mod find;
mod fresnel;
mod moments;
pub(crate) mod shape;

pub use curve::ViewCurve;
pub use directional::Albedo;
pub use fresnel::{DielectricAlbedo, FresnelAlbedo};
pub use moments::Moments;
