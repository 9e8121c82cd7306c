//! Elementary functions: the hardware's square root where `std` is there, `libm` otherwise, and `libm` always for the
//! transcendental ones, so that a sampled normal is the same bits on every system.

/// Square root, exactly rounded either way.
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
