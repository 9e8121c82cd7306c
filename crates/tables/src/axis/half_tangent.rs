//! The half tangent h = x/(1 + √(1+x²)) of a slope or cotangent x: tan(α/2) of the angle α with tan
//! α = x.
//!
//! It is the coordinate of views, for z = cot θ/σ ≥ 0, and what tables of slopes hold, for x of
//! either sign: there as the distance g from an end of [−1, 1], 1 + h for the half u ≤ ½ of the
//! random numbers and 1 − h for the other, so that both tails keep their digits. The slope follows
//! from g without a division or a root, as the quotient ±2(1−g) : g(2−g), and the silhouette x =
//! −cot θ is g = 1 − τ, linear in the coordinate τ of the view. Slopes are written x : z where z
//! may be 0.

use serde::{Deserialize, Serialize};
use wide::f32x4;

use microfacet_core::math::{sqrt, sqrt64};

use super::coordinate::Coordinate;
use super::crowded;

/// The half tangent τ = z/(1 + √(1+z²)) ∈ [0, 1] of a view's unit cotangent z = cot θ_v/σ_v ∈
/// [0, ∞].
///
/// τ is the tangent of half the elevation in unit space: 0 is grazing, 1 normal incidence (or
/// σ → 0). Where `crowded`, t = 1 − √(1−τ).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalfTangent {
    /// Whether the nodes crowd towards normal incidence.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub crowded: bool,
}

impl HalfTangent {
    /// t of z ∈ [0, ∞].
    pub fn coordinate(&self, z: f64) -> f64 {
        // z² would overflow.
        if z > 1e150 {
            return 1.0;
        }
        let tau = half_tangent(z, 1.0);
        if self.crowded { crowded::coordinate(tau, ends(z, 1.0)[1]) } else { tau }
    }

    /// τ and 1 − τ at t.
    pub fn parts(&self, t: f64) -> [f64; 2] {
        if self.crowded { crowded::parts(t) } else { [t, 1.0 - t] }
    }

    /// z = 2τ/(1 − τ²) at t; ∞ for 1.
    pub fn quantity(&self, t: f64) -> f64 {
        let [tau, rest] = self.parts(t);
        2.0 * tau / (rest * (1.0 + tau))
    }

    /// t times `rows` of four views, and 1 − τ; `length` is √(ρ² + z²).
    #[inline(always)]
    pub fn of_views(
        &self,
        rho: f32x4,
        z: f32x4,
        length: f32x4,
        [rows, inverse_rows]: [f32; 2],
    ) -> [f32x4; 2] {
        if self.crowded {
            // 1 − τ = (ρ + (length − z))/(ρ + length) with length − z = ρ²/(length + z), which does
            // not cancel.
            let steep = length + z;
            let rest = rho * (steep + rho) / (steep * (rho + length));
            [(1.0 - rest.sqrt()) * rows, rest]
        } else {
            let at = z * rows / (rho + length);
            [at, 1.0 - at * inverse_rows]
        }
    }

    /// t of a view from its stretched horizontal length ρ and vertical part z ≥ 0, not both 0.
    #[inline(always)]
    pub fn of_view(&self, rho: f32, z: f32) -> f32 {
        let length = sqrt(rho * rho + z * z);
        let r = 1.0 / (rho + length);
        if self.crowded {
            // 1 − τ = (ρ + (length − z)) r, where length − z = ρ²/(length + z) does not cancel.
            crowded::fast((rho + rho * rho / (length + z)) * r)
        } else {
            z * r
        }
    }
}

impl Coordinate for HalfTangent {
    fn formula(&self) -> &'static str {
        "τ = z/(1 + √(1+z²)); where crowded, t = 1 − √(1−τ)"
    }
}

/// The half tangent h ∈ [−1, 1] of the slope x : z, with z ≥ 0 and both less than 1e150.
pub fn half_tangent(x: f64, z: f64) -> f64 {
    x / (z + sqrt64(x * x + z * z))
}

/// 1 + h and 1 − h of the slope x : z, each without cancellation.
pub fn ends(x: f64, z: f64) -> [f64; 2] {
    let r = sqrt64(x * x + z * z);
    let h = x / (z + r);
    // 1 − |h| = (z + r − |x|)/(z + r), and r − |x| = z²/(r + |x|).
    let near = (z + z * z / (r + x.abs())) / (z + r);
    if h > 0.0 { [1.0 + h, near] } else { [near, 1.0 - h] }
}

/// dh/dα at the slope x : z, for the angle α with tan α = x/z.
pub fn angle_rate(x: f64, z: f64) -> f64 {
    let r = sqrt64(x * x + z * z);
    r / (z + r)
}

/// dh/d(x/z) at the slope x : z.
pub fn rate(x: f64, z: f64) -> f64 {
    // dα/d(x/z) is cos² α.
    angle_rate(x, z) * (z * z / (x * x + z * z))
}

/// [`ends`] and [`rate`] of one slope, with one root and one division for both.
#[inline(always)]
pub fn ends_and_rate(x: f64, z: f64) -> ([f64; 2], f64) {
    let r = sqrt64(x * x + z * z);
    let (whole, steep) = (z + r, r + x.abs());
    let inverse = 1.0 / (r * whole * steep);
    let h = x * (r * steep * inverse);
    let near = z * ((steep + z) * r * inverse);
    let ends = if h > 0.0 { [1.0 + h, near] } else { [near, 1.0 - h] };
    (ends, z * z * (steep * inverse))
}

/// The slope x : z whose half tangent is the distance g ∈ [0, 2] from 1.
#[inline]
pub fn slope_at(g: f64) -> [f64; 2] {
    [2.0 * (1.0 - g), g * (2.0 - g)]
}

/// A slope x : z in single precision, as lookups return it.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// Along the tangent plane.
    pub x: f32,
    /// Along the macro normal, not negative.
    pub z: f32,
}

impl Slope {
    /// [`slope_at`] the distance g from the end h = `sign`, 1 or −1.
    #[inline(always)]
    pub fn from_end(g: f32, sign: f32) -> Self {
        Self { x: sign * (2.0 - 2.0 * g), z: g * (2.0 - g) }
    }
}

/// [`slope_at`] with −x/2 in the place of x: (g − 1) : g(2 − g), one operation less.
#[inline(always)]
pub fn half_slope_at(g: f32x4) -> [f32x4; 2] {
    [g - 1.0, g * (2.0 - g)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLOPES: [f64; 9] = [0.0, 1e-12, 1e-3, 0.4, 1.0, 2.5, 1e3, 1e8, f64::INFINITY];

    #[test]
    fn there_and_back() {
        for crowded in [false, true] {
            let axis = HalfTangent { crowded };
            for t in [0.0, 1e-9, 0.1, 0.5, 0.9, 0.999, 1.0] {
                let back = axis.coordinate(axis.quantity(t));
                assert!((back - t).abs() < 1e-15, "{t}: {back}");
            }
            for z in SLOPES {
                let back = axis.quantity(axis.coordinate(z));
                // Towards infinity an ulp of t is 1/(1−t) ulps of z.
                assert!(back == z || (back / z - 1.0).abs() < 1e-15 * (3.0 + z), "{z}: {back}");
            }
            assert_eq!((axis.coordinate(1e200), axis.quantity(1.0)), (1.0, f64::INFINITY));
        }
    }

    #[test]
    fn slopes_follow_from_either_end() {
        for x in SLOPES[..8].iter().flat_map(|&x| [-x, x]) {
            let [low, high] = ends(x, 1.0);
            let h = half_tangent(x, 1.0);
            assert!((low - 1.0 - h).abs() < 1e-15 && (1.0 - high - h).abs() < 1e-15);
            // The nearer end keeps every digit of the tail.
            let [a, b] = slope_at(low.min(high));
            assert!((a / b - x.abs()).abs() <= 4e-16 * x.abs() + 1e-15, "{x}: {}", a / b);
            let ([a, b], fast) = ends_and_rate(3.0 * x, 3.0);
            assert!((a - low).abs() < 4e-16 && (b - high).abs() < 4e-16, "{x}");
            assert!((a.min(b) / low.min(high) - 1.0).abs() < 1e-15, "{x}");
            assert!((fast / rate(x, 1.0) - 1.0).abs() < 1e-15, "{x}");
            let step = 1e-6 * (1.0 + x.abs());
            let difference =
                (half_tangent(x + step, 1.0) - half_tangent(x - step, 1.0)) / (2.0 * step);
            assert!((difference - rate(x, 1.0)).abs() < 1e-9 && rate(x, 1.0) == rate(2.0 * x, 2.0));
        }
        assert_eq!([ends(1.0, 0.0), slope_at(0.0)], [[2.0, 0.0], [2.0, 0.0]]);
    }

    #[test]
    fn fast_forms_are_the_exact_ones() {
        for (rho, z) in [(1.0_f32, 0.0_f32), (0.7, 1e-5), (0.3, 0.9), (1e-4, 1.0), (0.0, 1.0)] {
            let exact = |crowded| HalfTangent { crowded }.coordinate(f64::from(z) / f64::from(rho));
            for crowded in [false, true] {
                let got = f64::from(HalfTangent { crowded }.of_view(rho, z));
                assert!((got - exact(crowded)).abs() < 2e-7, "{rho}, {z}: {got}");
            }
            let lanes = |x: f32| f32x4::splat(x);
            let length = lanes(sqrt(rho * rho + z * z));
            for crowded in [false, true] {
                let axis = HalfTangent { crowded };
                let [at, rest] = axis.of_views(lanes(rho), lanes(z), length, [80.0, 1.0 / 80.0]);
                let [at, rest] = [at, rest].map(|x| f64::from(x.to_array()[2]));
                assert!((at / 80.0 - exact(crowded)).abs() < 2e-7);
                assert!((rest - (1.0 - exact(false))).abs() < 2e-7);
            }
        }
        for g in [1e-6_f32, 0.2, 0.8, 1.0] {
            let [x, z] = slope_at(f64::from(g));
            let (slope, [half, same]) = (Slope::from_end(g, -1.0), half_slope_at(f32x4::splat(g)));
            assert!(
                (f64::from(slope.x) + x).abs() < 1e-7 * x + 1e-9
                    && (f64::from(slope.z) - z).abs() < 1e-6 * z
            );
            assert_eq!((2.0 * half.to_array()[0], same.to_array()[0]), (slope.x, slope.z));
        }
    }
}
