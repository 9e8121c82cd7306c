//! Parameters that constructors refuse; each message states the value, the range and the remedy.

/// A parameter outside the domain of a distribution.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// `!(sigma > 0)` or `sigma` infinite: the roughness must be a positive finite number.
    #[error(
        "sigma = {0}: a roughness must be positive and finite; model a smooth surface without a \
         distribution"
    )]
    Sigma(f64),
    /// `!(gamma > 3/2)`: at 3/2 the projected area diverges and the distribution has no Smith
    /// masking.
    #[error("gamma = {0}: the shape must lie in (1.5, inf]; use 2 for GGX and inf for Beckmann")]
    Gamma(f64),
    /// `!(exponent >= 0)` or infinite, for Blinn–Phong.
    #[error("exponent = {0}: a Blinn-Phong exponent must lie in [0, inf)")]
    Exponent(f64),
    /// `!(cos >= 0 && cos <= 1)`: the cosine of a direction above the surface to the macro normal.
    #[error("cos_theta = {0}: must lie in [0, 1]; flip the frame for directions below the surface")]
    CosTheta(f64),
    /// The azimuth of a direction is infinite or NaN.
    #[error("phi = {0}: an azimuth must be finite, in radians")]
    Phi(f64),
    /// `!(eta > 0)` or infinite: a relative refractive index.
    #[error("eta = {0}: a relative refractive index must lie in (0, inf); use 1/eta from inside")]
    Eta(f64),
    /// `!(k >= 0)` or infinite: the extinction of a conductor.
    #[error(
        "k = {0}: an extinction coefficient must lie in [0, inf); give its magnitude, whatever the \
         sign convention"
    )]
    Extinction(f64),
    /// `!(x >= 0 && x <= 1)`: a reflectance or a tint.
    #[error("reflectance = {0}: a reflectance or tint must lie in [0, 1]")]
    Reflectance(f64),
    /// `given != prepared`: a lobe was given to an integrator that was prepared for another shape.
    #[error(
        "gamma = {given}: the integrator was prepared for {prepared}; prepare one for each shape"
    )]
    OtherGamma {
        /// Shape of the lobe.
        given: f64,
        /// Shape of the integrator.
        prepared: f64,
    },
}

microfacet_core::debug_in_words!(ParameterError);

pub(crate) fn check_cosine(cos: f64) -> Result<(), ParameterError> {
    if (0.0..=1.0).contains(&cos) { Ok(()) } else { Err(ParameterError::CosTheta(cos)) }
}
