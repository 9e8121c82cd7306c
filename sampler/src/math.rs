//! Elementary functions: the square root of `std` where it is available, otherwise of `libm`;
//! transcendental ones always of `libm`, so that a sampled normal has the same bits on every
//! system.

/// Square root, correctly rounded either way.
#[inline(always)]
pub(crate) fn sqrt(x: f32) -> f32 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrtf(x);
}

/// √x in double precision.
#[inline(always)]
pub(crate) fn sqrt64(x: f64) -> f64 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::sqrt(x);
}

/// x clamped to [0, 1], and 0 for NaN: random numbers and cosines as every lookup takes them.
#[inline(always)]
pub(crate) fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}
