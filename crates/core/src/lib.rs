//! Definitions that the analytic model (`microfacet-model`, double precision) and the run-time
//! sampler (`microfacet-sampler`, single precision) share.
//!
//! | | |
//! | --- | --- |
//! | [`Masking`] | how masking and shadowing combine |
//! | [`Roughness`], [`Skew`] | the parameters of a lobe: roughness, and the matrix of an ellipsoid |
//! | [`shape`] | the two ways to write the shape, γ and s = 1/(γ−1) |
//! | [`fresnel`] | exact reflectance of dielectrics and conductors |
//! | [`schlick`] | the weights of Schlick's reflectance and of the F82 tint |
//! | [`math`] | square roots with and without the standard library, and clamping |
//! | [`gauss_legendre()`] | quadrature rules, at compile time too |
//!
//! The sampler must not depend on the model, whose code a renderer does not need, nor the model on
//! the sampler, which it checks; hence a crate below both. Formulas are generic over the number
//! type, so that both precisions evaluate the same code.
//!
//! ```
//! use microfacet_core::Masking;
//! // G2 from the G1 of view and light, and the weight of a sampled light.
//! assert_eq!(Masking::Uncorrelated.g2(0.5, 0.5), 0.25);
//! assert!((Masking::HeightCorrelated.g2(0.5, 0.5) - 1.0_f32 / 3.0).abs() < 1e-7);
//! assert_eq!(Masking::Uncorrelated.g2_over_g1(0.5, 0.25), 0.25);
//! ```
//!
//! `no_std` without the feature `std`, without allocation. Features: `std`, hardware square roots,
//! with the same results as without; `serde`, [`Masking`] by its name in files.

#![cfg_attr(not(feature = "std"), no_std)]

pub mod fresnel;
mod gauss_legendre;
mod masking;
pub mod math;
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
    /// The largest finite number.
    const MAX: Self;

    /// The nearest number to a constant given in double precision.
    fn constant(x: f64) -> Self;

    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// √(x² + y²), which overflows only where the result does.
    fn hypot(self, y: Self) -> Self;
}

impl Real for f32 {
    const MAX: Self = Self::MAX;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        x as Self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        #[cfg(feature = "std")]
        return Self::sqrt(self);
        #[cfg(not(feature = "std"))]
        return libm::sqrtf(self);
    }

    #[inline(always)]
    fn hypot(self, y: Self) -> Self {
        let (x, y) = (f64::from(self), f64::from(y));
        Real::sqrt(x * x + y * y) as Self
    }
}

impl Real for f64 {
    const MAX: Self = Self::MAX;

    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        #[cfg(feature = "std")]
        return Self::sqrt(self);
        #[cfg(not(feature = "std"))]
        return libm::sqrt(self);
    }

    fn hypot(self, y: Self) -> Self {
        libm::hypot(self, y)
    }
}

/// Implements `Debug` of an error by its `Display`: a program that returns the error from `main` or
/// unwraps it shows `Debug`, and the text of `Display` has the value, what is allowed, and the
/// remedy.
#[macro_export]
macro_rules! debug_in_words {
    ($error:ty) => {
        impl ::core::fmt::Debug for $error {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                ::core::fmt::Display::fmt(self, f)
            }
        }
    };
}

/// A density, limited to the largest finite number. NaN stays NaN; `min` would replace it.
#[inline(always)]
pub fn saturated<T: Real>(density: T) -> T {
    if density > T::MAX { T::MAX } else { density }
}
