//! What a constructor refuses, with the value, the allowed range and the remedy.

use core::fmt;

/// A parameter outside the domain of a distribution.
#[derive(Clone, Copy, PartialEq)]
pub enum ParameterError {
    /// `!(sigma > 0)` or `sigma` infinite: the roughness must be a positive finite number.
    Sigma(f64),
    /// `!(gamma > 3/2)`: at 3/2 the projected area diverges and the distribution has no Smith
    /// masking.
    Gamma(f64),
    /// `!(exponent >= 0)` or infinite, for Blinn–Phong.
    Exponent(f64),
    /// `!(cos >= 0 && cos <= 1)`: the cosine of a direction above the surface to the macro normal.
    CosTheta(f64),
    /// The azimuth of a direction is infinite or NaN.
    Phi(f64),
    /// `!(eta > 0)` or infinite: a relative refractive index.
    Eta(f64),
    /// `!(k >= 0)` or infinite: the extinction of a conductor.
    Extinction(f64),
    /// `!(x >= 0 && x <= 1)`: a reflectance or a tint.
    Reflectance(f64),
    /// `given != prepared`: a lobe was given to an integrator that was prepared for another shape.
    OtherGamma {
        /// Shape of the lobe.
        given: f64,
        /// Shape of the integrator.
        prepared: f64,
    },
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sigma(x) => {
                write!(
                    f,
                    "sigma = {x}: a roughness must be positive and finite; model a smooth surface without a distribution"
                )
            }
            Self::Gamma(x) => {
                write!(
                    f,
                    "gamma = {x}: the shape must lie in (1.5, inf]; use 2 for GGX and inf for Beckmann"
                )
            }
            Self::Exponent(x) => {
                write!(f, "exponent = {x}: a Blinn-Phong exponent must lie in [0, inf)")
            }
            Self::CosTheta(x) => {
                write!(
                    f,
                    "cos_theta = {x}: must lie in [0, 1]; flip the frame for directions below the surface"
                )
            }
            Self::Phi(x) => write!(f, "phi = {x}: an azimuth must be finite, in radians"),
            Self::Eta(x) => {
                write!(
                    f,
                    "eta = {x}: a relative refractive index must lie in (0, inf); use 1/eta from inside"
                )
            }
            Self::Extinction(x) => {
                write!(
                    f,
                    "k = {x}: an extinction coefficient must lie in [0, inf); give its magnitude, whatever the sign convention"
                )
            }
            Self::Reflectance(x) => {
                write!(f, "reflectance = {x}: a reflectance or tint must lie in [0, 1]")
            }
            Self::OtherGamma { given, prepared } => {
                write!(
                    f,
                    "gamma = {given}: the integrator was prepared for {prepared}; prepare one for each shape"
                )
            }
        }
    }
}

microfacet_core::debug_in_words!(ParameterError);

impl core::error::Error for ParameterError {}
