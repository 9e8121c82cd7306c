//! Directional albedos from tables: the share of light that one bounce off the microsurface returns.

mod collapse;
mod curve;
mod dielectric;
mod fresnel;
mod isotropic;
mod moments;
mod over_azimuth;

pub use curve::ViewCurve;
pub use dielectric::DielectricAlbedo;
pub use fresnel::FresnelAlbedo;
pub use isotropic::Albedo;
pub use moments::Moments;
pub use over_azimuth::ViewAlbedo;
