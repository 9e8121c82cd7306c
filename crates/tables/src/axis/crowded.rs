//! Nodes crowded towards the upper end of a coordinate x ∈ [0, 1]: even in 1 − √(1−x) instead of x.
//!
//! Near normal incidence and for heavy tails, tabulated quantities approach their limits like a
//! power of 1 − x less than two, too slowly for even nodes. The functions use the rest 1 − x, which
//! callers know without cancellation.

use microfacet_core::math::sqrt;

/// t of x and the rest 1 − x.
pub(super) fn coordinate(x: f64, rest: f64) -> f64 {
    // 1 − √rest without its cancellation near x = 0.
    x / (1.0 + libm::sqrt(rest))
}

/// x and the rest 1 − x at t.
pub(super) fn parts(t: f64) -> [f64; 2] {
    [t * (2.0 - t), (1.0 - t) * (1.0 - t)]
}

/// dx/dt.
pub(super) fn rate(t: f64) -> f64 {
    2.0 * (1.0 - t)
}

/// [`coordinate`] in single precision from the rest alone. The absolute error is the rounding of 1,
/// as for every coordinate.
#[inline(always)]
pub(super) fn fast(rest: f32) -> f32 {
    1.0 - sqrt(rest)
}
