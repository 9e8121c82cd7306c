//! The view axis of what is seen from inside a dielectric: two halves that meet where total reflection sets in, so that no polynomial
//! crosses that kink, wherever the index puts it.

use crate::albedo_axes::{STENCIL, stencil};
use crate::axis::{Axis, Mapping};
use crate::math::sqrt64;

/// The coordinate for one material and index; see [`Mapping::CriticalBlend`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct CriticalCoordinate {
    share: f64,
    root: f64,
    /// κσ.
    knee: f64,
    /// δ and asinh(1/δ).
    kink: f64,
    range: f64,
    /// μ₀ and y(μ₀).
    floor: f64,
    start: f64,
    /// μ_c, y(μ_c) and p(μ_c).
    critical: f64,
    middle: f64,
    second: f64,
}

impl CriticalCoordinate {
    /// For σ > 0 and an index η ≥ 1 of the dense side, whose reciprocal is given.
    pub(crate) fn new(axis: &Axis, sigma: f64, gamma: f64, inverse_eta: f64) -> Self {
        let Mapping::CriticalBlend { share, scale, heavy, floor, slope, root, kink } = axis.mapping else {
            unreachable!("validated on load")
        };
        let critical = sqrt64((1.0 - inverse_eta) * (1.0 + inverse_eta));
        // Smooth minima of what does not go below zero, η = 1 being a case of it.
        let least = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a * b / (a + b) } else { 0.0 };
        let floor = least(least(floor, slope * sigma), critical);
        let kink = sqrt64(kink * sigma);
        let range = libm::asinh(1.0 / kink);
        let knee = (scale + heavy / (2.0 * gamma - 3.0)) * sigma;
        let mut view =
            Self { share, root, knee, kink, range, floor, start: 0.0, critical, middle: 0.0, second: 0.0 };
        [view.start, view.middle] = [floor, critical].map(|cos| view.blend(cos, true));
        view.second = view.blend(critical, false);
        view
    }

    /// y(μ), of fourth roots, or p(μ), without.
    fn blend(&self, cos: f64, roots: bool) -> f64 {
        let sin = sqrt64((1.0 - cos) * (1.0 + cos));
        let of = |x: f64| if roots { sqrt64(sqrt64(x)) } else { x };
        self.share * of(cos / (cos + self.knee * sin)) + (1.0 - self.share) * of(cos / (1.0 + sin))
    }

    /// S of the root of a share in [0, 1].
    fn near(&self, share: f64) -> f64 {
        libm::asinh(sqrt64(share.max(0.0)) / self.kink) / self.range
    }

    /// The coordinate of cos θ in its half, [0, 1] below μ_c as above.
    fn half(&self, cos: f64) -> f64 {
        // A half without width is one point.
        let part = |a: f64, b: f64, whole: f64| if whole > 0.0 { (a - b) / whole } else { 0.0 };
        let (smooth, near) = if cos < self.critical {
            let rest = part(self.critical, cos, self.critical - self.floor);
            (part(self.blend(cos, true), self.start, self.middle - self.start), 1.0 - self.near(rest))
        } else {
            let rest = part(cos, self.critical, 1.0 - self.critical);
            (part(self.blend(cos, false), self.second, 1.0 - self.second), self.near(rest))
        };
        (1.0 - self.root) * smooth + self.root * near
    }

    /// The first of six nodes about cos θ ∈ [0, 1], of `n` spread evenly, an odd number, and their weights: all in one half.
    pub(crate) fn stencil(&self, cos: f64, n: usize) -> (usize, [f32; STENCIL]) {
        let half = n / 2 + 1;
        let cos = cos.max(self.floor);
        let (start, weights) = stencil(self.half(cos) as f32, half);
        (if cos < self.critical { start } else { start + half - 1 }, weights)
    }

    /// cos θ at a coordinate of the whole axis, by bisection to the last bit.
    pub(crate) fn cos(&self, t: f64) -> f64 {
        let (mut low, mut high, t) =
            if t < 0.5 { (self.floor, self.critical, 2.0 * t) } else { (self.critical, 1.0, 2.0 * t - 1.0) };
        let end = high;
        for _ in 0..80 {
            let cos = 0.5 * (low + high);
            // The upper end of the lower half is its own; at μ_c itself the other half begins.
            if cos < end && self.half(cos) < t { low = cos } else { high = cos }
        }
        0.5 * (low + high)
    }
}
