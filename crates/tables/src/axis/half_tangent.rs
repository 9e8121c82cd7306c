//! The half tangent h = x/(1 + √(1+x²)) of a slope or cotangent x: tan(α/2) of the angle α with tan
//! α = x.
//!
//! It is the coordinate of views, for z = cot θ/σ ≥ 0. Tables of slopes hold it for x of either
//! sign, as the distance g from an end of [−1, 1], 1 + h for the half u ≤ ½ of the random numbers
//! and 1 − h for the other, so that both tails keep their digits. The slope follows from g without
//! a division or a root, as the quotient ±2(1−g) : g(2−g), and the silhouette x = −cot θ is
//! g = 1 − τ, linear in the coordinate τ of the view. Slopes are written x : z where z may be 0.

use microfacet_lanes::{Lanes, f32x4};
use serde::{Deserialize, Serialize};

use microfacet_core::math::{sqrt, sqrt64};

use super::coordinate::Coordinate;

/// The half tangent τ = z/(1 + √(1+z²)) ∈ [0, 1] of a view's unit cotangent z = cot θ_v/σ_v ∈
/// [0, ∞].
///
/// τ is the tangent of half the elevation in unit space: 0 is grazing, 1 normal incidence (or
/// σ → 0). With knots, t is piecewise linear in τ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalfTangent {
    /// Points [τ, t] where the nodes become denser: t is linear in τ between (0, 0), the two knots
    /// and (1, 1), and convex, so that it is the largest of the three linear functions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub knots: Option<[[f64; 2]; 2]>,
}

impl HalfTangent {
    /// (0, 0), the knots and (1, 1).
    fn points(&self) -> [[f64; 2]; 4] {
        let [first, second] = self.knots.unwrap_or([[0.0; 2], [1.0; 2]]);
        [[0.0; 2], first, second, [1.0; 2]]
    }

    /// The piece that holds `x`, of τ (`along` = 0) or t (1), as two points.
    fn piece(&self, x: f64, along: usize) -> [[f64; 2]; 2] {
        let points = self.points();
        let i = (1..3).find(|&i| x < points[i][along]).unwrap_or(3);
        // Without knots the last piece is empty.
        if self.knots.is_none() { [points[0], points[3]] } else { [points[i - 1], points[i]] }
    }

    /// t of z ∈ [0, ∞].
    pub fn coordinate(&self, z: f64) -> f64 {
        // z² would overflow.
        if z > 1e150 {
            return 1.0;
        }
        let tau = half_tangent(z, 1.0);
        let [[from, low], [to, high]] = self.piece(tau, 0);
        low + (tau - from) * ((high - low) / (to - from))
    }

    /// τ and 1 − τ at t.
    pub fn parts(&self, t: f64) -> [f64; 2] {
        let [[from, low], [to, high]] = self.piece(t, 1);
        let slope = (to - from) / (high - low);
        // 1 − τ from the upper end of the piece: without cancellation if that end is 1.
        [from + (t - low) * slope, (1.0 - to) + (high - t) * slope]
    }

    /// z = 2τ/(1 − τ²) at t; ∞ for 1.
    pub fn quantity(&self, t: f64) -> f64 {
        let [tau, rest] = self.parts(t);
        2.0 * tau / (rest * (1.0 + tau))
    }

    /// The coordinate times a number of cells.
    pub fn lines(&self, cells: f32) -> Lines {
        let mut lines = Lines { cells, slopes: [cells; 3], second: cells };
        if self.knots.is_some() {
            let points = self.points();
            lines.slopes = [0, 1, 2].map(|i| {
                let [[from, low], [to, high]] = [points[i], points[i + 1]];
                ((high - low) / (to - from)) as f32 * cells
            });
            let [[from, low], [to, high]] = [points[1], points[2]];
            lines.second = (low + (1.0 - from) * ((high - low) / (to - from))) as f32 * cells;
        }
        lines
    }

    /// t of a view from its stretched horizontal length ρ and vertical part z ≥ 0, not both 0.
    #[inline(always)]
    pub fn of_view(&self, rho: f32, z: f32) -> f32 {
        let length = sqrt(rho * rho + z * z);
        match self.knots {
            None => z / (rho + length),
            Some(_) => {
                let [rho, z, length] = [rho, z, length].map(f32x4::splat);
                self.lines(1.0).of_views::<true, _>(rho, z, length)[0].to_array()[0]
            }
        }
    }
}

/// A convex, piecewise linear coordinate in cells, as the largest of three linear functions of the
/// rest r = 1 − τ: slope₁ (1 − r), second − slope₂ r and cells − slope₃ r. At r = 0 and 1 it is
/// `cells` and 0 to the bit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lines {
    /// The number of cells.
    pub cells: f32,
    /// How fast the functions fall with r.
    pub slopes: [f32; 3],
    /// The second function at r = 0.
    pub second: f32,
}

impl Lines {
    /// The coordinate of views in lanes, and r; `length` is √(ρ² + z²). Only with `PRECISE` does r
    /// keep its digits next to normal incidence, where cells of a peeled table are as narrow as
    /// 7e-4 of τ.
    #[inline(always)]
    pub fn of_views<const PRECISE: bool, L: Lanes>(&self, rho: L, z: L, length: L) -> [L; 2] {
        let rest = if PRECISE {
            // (ρ + (length − z))/(ρ + length) with length − z = ρ²/(length + z).
            let steep = length + z;
            rho * (steep + rho) / (steep * (rho + length))
        } else {
            L::splat(1.0) - z / (rho + length)
        };
        let [first, second, third] = self.slopes;
        let first = L::splat(first) - rest * first;
        let second = L::splat(self.second) - rest * second;
        let third = L::splat(self.cells) - rest * third;
        [first.fast_max(second).fast_max(third), rest]
    }
}

impl Coordinate for HalfTangent {
    fn formula(&self) -> &'static str {
        "τ = z/(1 + √(1+z²)); t is linear in τ between (0, 0), knots [τ, t] if any, and (1, 1)"
    }

    fn fault(&self) -> Option<&'static str> {
        let points = self.points();
        let slopes = [0, 1, 2].map(|i| {
            let [[from, low], [to, high]] = [points[i], points[i + 1]];
            if low < high && from < to { (high - low) / (to - from) } else { f64::NAN }
        });
        // False if a slope is NaN.
        let convex = slopes[0] <= slopes[1] && slopes[1] <= slopes[2] && slopes[2] < 1e6;
        (self.knots.is_some() && !convex).then_some("knots that are not convex")
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

/// [`rate`] at [`slope_at`] g, as a quotient.
#[inline]
pub fn rate_at(g: f64) -> [f64; 2] {
    // With z = g(2−g) = 1 − h², √(x² + z²) is 1 + h² = 2 − z.
    let z = g * (2.0 - g);
    [z * z, 4.0 - 2.0 * z]
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

/// [`slope_at`] with −x/2 instead of x: (g − 1) : g(2 − g), one operation less.
#[inline(always)]
pub fn half_slope_at<L: Lanes>(g: L) -> [L; 2] {
    [g - 1.0, g * (L::splat(2.0) - g)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOTS: [Option<[[f64; 2]; 2]>; 2] = [None, Some([[0.72, 0.625], [0.94, 0.875]])];

    const SLOPES: [f64; 9] = [0.0, 1e-12, 1e-3, 0.4, 1.0, 2.5, 1e3, 1e8, f64::INFINITY];

    #[test]
    fn there_and_back() {
        for knots in KNOTS {
            let axis = HalfTangent { knots };
            assert_eq!(axis.fault(), None);
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
            let rise = half_tangent(x + step, 1.0) - half_tangent(x - step, 1.0);
            assert!((rise / (2.0 * step) - rate(x, 1.0)).abs() < 1e-9);
            assert_eq!(rate(x, 1.0), rate(2.0 * x, 2.0));
            let [number, of] = rate_at(low.min(high));
            assert!((number / of / rate(x, 1.0) - 1.0).abs() < 2e-15, "{x}");
        }
        assert_eq!([ends(1.0, 0.0), slope_at(0.0)], [[2.0, 0.0], [2.0, 0.0]]);
    }

    #[test]
    fn fast_forms_are_the_exact_ones() {
        for (rho, z) in [(1.0_f32, 0.0_f32), (0.7, 1e-5), (0.3, 0.9), (1e-4, 1.0), (0.0, 1.0)] {
            let lanes = |x: f32| f32x4::splat(x);
            let length = lanes(sqrt(rho * rho + z * z));
            let z_over_rho = f64::from(z) / f64::from(rho);
            for knots in KNOTS {
                let axis = HalfTangent { knots };
                let exact = axis.coordinate(z_over_rho);
                let got = f64::from(axis.of_view(rho, z));
                assert!((got - exact).abs() < 3e-7, "{rho}, {z}: {got}");
                let (lines, [rho, z]) = (axis.lines(80.0), [rho, z].map(lanes));
                let plain = lines.of_views::<false, _>(rho, z, length);
                for views in [lines.of_views::<true, _>(rho, z, length), plain] {
                    let [at, rest] = views.map(|x| f64::from(x.to_array()[2]));
                    assert!((at / 80.0 - exact).abs() < 3e-7);
                    let tau = HalfTangent::default().coordinate(z_over_rho);
                    assert!((rest - (1.0 - tau)).abs() < 2e-7);
                    assert!(z_over_rho < f64::INFINITY || at == 80.0, "{at}");
                }
            }
        }
        for g in [1e-6_f32, 0.2, 0.8, 1.0] {
            let [x, z] = slope_at(f64::from(g));
            let (slope, [half, same]) = (Slope::from_end(g, -1.0), half_slope_at(f32x4::splat(g)));
            assert!((f64::from(slope.x) + x).abs() < 1e-7 * x + 1e-9);
            assert!((f64::from(slope.z) - z).abs() < 1e-6 * z);
            assert_eq!((2.0 * half.to_array()[0], same.to_array()[0]), (slope.x, slope.z));
        }
    }
}
