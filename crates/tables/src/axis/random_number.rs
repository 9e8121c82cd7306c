//! The axes of random numbers: fourth roots of the distance from either end.

use microfacet_core::math::sqrt;
use microfacet_lanes::Lanes;

use super::coordinate::Coordinate;

/// The coordinate t = (2 min(u, 1−u))^¼ ∈ [0, 1] of a random number u.
///
/// Quantiles behave like powers of the distance from either end, and the fourth root makes those of
/// every shape smooth. An axis holds first the nodes for u ≤ ½ (t ascending from u = 0), then as
/// many for u > ½ (t ascending from u = 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirroredRoot;

/// The half u > ½ of [`MirroredRoot`] alone: the quantile at u is minus the one at 1−u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OddRoot;

/// ⁴√2: the factor 2 taken out of the roots.
const FOURTH_ROOT_OF_2: f64 = 1.189_207_115_002_721_1;

impl MirroredRoot {
    /// t of u; 0 outside [0, 1] and for NaN.
    #[inline(always)]
    pub fn coordinate(u: f32) -> f32 {
        sqrt(sqrt(2.0 * u.min(1.0 - u).max(0.0)))
    }

    /// The number u ≤ ½ at t ∈ [0, 1]: ½ t⁴.
    pub fn number(t: f64) -> f64 {
        0.5 * ((t * t) * (t * t))
    }

    /// du/dt at t, for u ≤ ½.
    pub fn rate(t: f64) -> f64 {
        2.0 * t * t * t
    }

    /// t of a number u ∈ [0, ½].
    pub fn of_number(u: f64) -> f64 {
        libm::sqrt(libm::sqrt(2.0 * u))
    }

    /// The factor from [`roots`] to cells.
    pub fn scale(cells: usize) -> f32 {
        (cells as f64 * FOURTH_ROOT_OF_2) as f32
    }
}

/// The numbers above 0, and 0 in place of others, of −0 and NaN as well.
#[inline(always)]
pub fn above_zero<L: Lanes>(x: L) -> L {
    // Of such a pair the maximum of SSE is the second number, that of other machines may be the
    // first.
    let zero = L::splat(0.0);
    if cfg!(target_feature = "sse2") { x.fast_max(zero) } else { x & x.simd_gt(zero) }
}

/// min(u, 1−u)^¼ of random numbers in lanes: t/⁴√2; 0 outside [0, 1] and for NaN.
#[inline(always)]
pub fn roots<L: Lanes>(u: L) -> L {
    above_zero(u.fast_min(L::splat(1.0) - u)).sqrt().sqrt()
}

impl Coordinate for MirroredRoot {
    fn formula(&self) -> &'static str {
        "t = (2 min(u, 1−u))^¼"
    }

    fn values(&self, n: usize) -> usize {
        2 * n
    }
}

impl Coordinate for OddRoot {
    fn formula(&self) -> &'static str {
        "t = (2 (1−u))^¼"
    }
}

#[cfg(test)]
mod tests {
    use microfacet_lanes::f32x4;

    use super::*;

    #[test]
    fn there_and_back() {
        for t in [0.0, 1e-3, 0.25, 0.7, 1.0] {
            let u = MirroredRoot::number(t);
            assert!((MirroredRoot::of_number(u) - t).abs() < 1e-15);
            let step = 1e-5;
            let change = MirroredRoot::number(t + step) - MirroredRoot::number(t - step);
            assert!((change / (2.0 * step) - MirroredRoot::rate(t)).abs() < 1e-9);
            let fast = |u: f32| f64::from(MirroredRoot::coordinate(u));
            assert!((fast(u as f32) - t).abs() < 1e-6, "{t}");
            // Single precision resolves 1 − u to 6e-8, the fourth root of which is 0.02.
            assert!((fast(1.0 - u as f32) - t).abs() < if t < 0.1 { 0.02 } else { 1e-4 }, "{t}");
        }
        assert_eq!([-0.1, 0.0, 1.0, 1.5, f32::NAN].map(MirroredRoot::coordinate), [0.0; 5]);
    }

    #[test]
    fn four_at_a_time() {
        let u = [0.0, 1e-6, 0.4999, 0.5];
        for u in [u, u.map(|u| 1.0 - u)] {
            let got = roots(f32x4::new(u)).to_array();
            let scale = MirroredRoot::scale(16);
            let want = u.map(|u| 16.0 * MirroredRoot::coordinate(u));
            let near = (0..4).all(|i| (got[i] * scale - want[i]).abs() < 4e-6);
            assert!(near, "{got:?} for {want:?}");
        }
        assert_eq!(roots(f32x4::new([-0.1, 1.5, 0.0, 1.0])), f32x4::ZERO);
    }
}
