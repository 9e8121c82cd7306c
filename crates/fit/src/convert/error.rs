//! Why there is no replacement.

use std::fmt;

use microfacet_baker::distribution::{DistributionError, DistributionKind};

/// Why there is no replacement.
#[derive(Clone, PartialEq)]
pub enum ConvertError {
    /// A distribution could not be made.
    Distribution(DistributionError),
    /// D does not fall to half of D(0) at any angle.
    NoHalfAngle,
    /// No parameter of this kind of distribution gives that half angle, in radians.
    OutOfReach(DistributionKind, f64),
    /// A half angle fixes one parameter; this kind of distribution has two, and the second must be
    /// given.
    ShapeNeeded(DistributionKind),
    /// No published formula is known for this pair.
    NoFormula(DistributionKind, DistributionKind),
    /// What a published formula gives cannot be used; where it is printed.
    OfFormula(&'static str, DistributionError),
    /// D is so large or so small that errors are no numbers.
    Overflow,
    /// The minimiser's message.
    Minimiser(String),
}

impl fmt::Display for ConvertError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Distribution(e) => e.fmt(f),
            Self::NoHalfAngle => f.write_str(
                "the distribution is so wide that D nowhere falls to half of D(0); use rmse",
            ),
            Self::OutOfReach(to, angle) => {
                write!(f, "no {} has its half angle at {angle} radians; use rmse", to.name())
            }
            Self::ShapeNeeded(to) => write!(
                f,
                "a half angle fixes one parameter and {} has two: use rmse, or give the second",
                to.name()
            ),
            Self::NoFormula(from, to) => write!(
                f,
                "no formula is published from {} to {}; there are some between any two of beckmann, blinn-phong, gauss, \
                 trowbridge-reitz and sawicki, and between beckmann and schlick; half-angle and rmse work between any two",
                from.name(),
                to.name()
            ),
            Self::OfFormula(source, e) => write!(f, "{source} gives {e}; use half-angle or rmse"),
            Self::Overflow => f.write_str(
                "D is too large or too small for double precision; use a roughness in [1e-8, 1e6], and measured angles further apart",
            ),
            Self::Minimiser(e) => write!(f, "the minimiser failed: {e}"),
        }
    }
}

microfacet_core::debug_in_words!(ConvertError);

impl std::error::Error for ConvertError {}

impl From<DistributionError> for ConvertError {
    fn from(e: DistributionError) -> Self {
        Self::Distribution(e)
    }
}
