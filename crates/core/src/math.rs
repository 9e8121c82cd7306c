//! Elementary functions of scalars. Square roots are correctly rounded with `std` and without it;
//! transcendental functions are always `libm`'s or the sampler's own, so that a sampled normal has
//! the same bits on every system.

use crate::Real;

/// √x in single precision.
#[inline(always)]
pub fn sqrt(x: f32) -> f32 {
    Real::sqrt(x)
}

/// √x in double precision.
#[inline(always)]
pub fn sqrt64(x: f64) -> f64 {
    Real::sqrt(x)
}

/// x clamped to [0, 1], and 0 for NaN. Every lookup takes random numbers and cosines in this way.
#[inline(always)]
pub fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}

/// `x` clamped to a range, NaN to its lower end, in two instructions: `f32::max` and `min` take six
/// each, since of NaN they return the other number.
#[inline(always)]
#[must_use]
#[allow(clippy::manual_clamp, reason = "`clamp` keeps NaN")]
pub fn within(x: f32, [low, high]: [f32; 2]) -> f32 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}
