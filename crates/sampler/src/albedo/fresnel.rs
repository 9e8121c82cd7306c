//! Albedos under an exact reflectance: of conductors by channel, of dielectrics reflected and
//! transmitted from either side.

use microfacet_core::Masking;

use super::curve::ViewCurve;

/// Directional albedo of one bounce off a rough dielectric under its exact reflectance: the shares
/// of light reflected and transmitted.
///
/// What is missing to one is shadowed, and left to further bounces.
#[derive(Clone, Debug)]
pub struct DielectricAlbedo {
    /// The form of masking that it is for.
    pub masking: Masking,
    /// Seen from outside: [reflection, transmission] by the view outside.
    pub outside: ViewCurve<2>,
    /// Seen from inside: [reflection, transmission] by the view inside; z points to the side of the
    /// view.
    pub inside: ViewCurve<2>,
}

/// Directional albedo of one bounce under an exact reflectance, other than F = 1.
#[derive(Clone, Debug)]
pub enum FresnelAlbedo {
    /// Off a conductor: red, green and blue.
    Conductor(ViewCurve<3>),
    /// Off and through a dielectric.
    Dielectric(DielectricAlbedo),
}
