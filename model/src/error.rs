//! What a constructor refuses, with the value, the allowed range and the remedy.

use core::fmt;

/// A parameter outside the domain of a distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterError {
    /// `!(sigma > 0)` or `sigma` infinite: the roughness must be a positive finite number.
    Sigma(f64),
    /// `!(gamma > 3/2)`: at 3/2 the projected area diverges and the distribution has no Smith masking.
    Gamma(f64),
    /// `!(exponent >= 0)` or infinite, for Blinn–Phong.
    Exponent(f64),
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
                write!(f, "gamma = {x}: the shape must lie in (1.5, inf]; use 2 for GGX and inf for Beckmann")
            }
            Self::Exponent(x) => write!(f, "exponent = {x}: a Blinn-Phong exponent must lie in [0, inf)"),
        }
    }
}

impl core::error::Error for ParameterError {}
