//! What the analytic model (in double precision) and the run-time sampler (in single) have to agree on: how masking and
//! shadowing combine, the two ways to write the shape, the weights of Schlick's and the F82 reflectance, and Gauss–Legendre
//! rules.
//!
//! The sampler must not depend on the model, whose code a renderer does not need, nor the model on the sampler, which it
//! judges. So these definitions stand below both. Formulas are generic over the number, so that both precisions run the same
//! line. `no_std`, without allocation; its one dependency is `serde`, for names in files, where the feature is on.

#![no_std]

mod gauss_legendre;
mod masking;
mod roughness;
pub mod schlick;
pub mod shape;
mod skew;

pub use gauss_legendre::{fill_gauss_legendre, gauss_legendre};
pub use masking::{Masking, UnknownMasking};
pub use roughness::Roughness;
pub use skew::{Skew, SkewError};

use core::ops::{Add, Div, Mul, Sub};

/// A floating-point number: `f32` or `f64`.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// The nearest number to a constant given in double precision.
    fn constant(x: f64) -> Self;
}

impl Real for f32 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x as Self
    }
}

impl Real for f64 {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
}
