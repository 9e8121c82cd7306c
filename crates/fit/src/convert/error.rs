//! Errors of conversions.

use microfacet_baker::distribution::{DistributionError, DistributionKind};

/// Why there is no replacement.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum ConvertError {
    /// A distribution could not be made.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// D does not fall to half of D(0) at any angle.
    #[error("the distribution is so wide that D nowhere falls to half of D(0); use rmse")]
    NoHalfAngle,
    /// No parameter of this kind of distribution gives that half angle, in radians.
    #[error("no {kind} has its half angle at {1} radians; use rmse", kind = .0.name())]
    OutOfReach(DistributionKind, f64),
    /// A half angle fixes one parameter; this kind of distribution has two, and the second must be
    /// given.
    #[error(
        "a half angle fixes one parameter and {} has two: use rmse, or give the second", .0.name()
    )]
    ShapeNeeded(DistributionKind),
    /// A half angle fixes one parameter; this kind of distribution has three.
    #[error("a half angle fixes one parameter and {} has three: use rmse or variation", .0.name())]
    OfThree(DistributionKind),
    /// No published formula is known for this pair.
    #[error(
        "no formula is published from {} to {}; there are some between any two of beckmann, \
         blinn-phong, gauss, trowbridge-reitz and sawicki, and between beckmann and schlick; \
         half-angle, rmse and variation work between any two", .0.name(), .1.name()
    )]
    NoFormula(DistributionKind, DistributionKind),
    /// The result of a published formula is out of range; where the formula is printed.
    #[error("{0} gives {1}; use half-angle or rmse")]
    OfFormula(&'static str, DistributionError),
    /// D is so large or so small that errors overflow.
    #[error(
        "D is too large or too small for double precision; use a roughness in [1e-8, 1e6], and \
         measured angles further apart"
    )]
    Overflow,
    /// The minimiser's message.
    #[error("the minimiser failed: {0}")]
    Minimiser(String),
}

microfacet_core::debug_in_words!(ConvertError);
