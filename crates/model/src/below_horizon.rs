//! Visible slopes for views below the horizon of the lobe, which occur for skewed lobes only.
//!
//! A view whose unit cotangent is −a sees the slopes x > a with density ∝ (x − a) p(x). The
//! formulas of [`VisibleSlope`](crate::VisibleSlope), for views above the horizon, would subtract
//! nearly equal areas here.

use crate::shape::{AsinhSlope, Shape};
use crate::visible::solve_decreasing;

/// The in-plane slopes that a view below the lobe's horizon sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlopeBelowHorizon<'a> {
    shape: &'a Shape,
    /// The silhouette x = a ≥ 0 and its w.
    a: f64,
    w_a: AsinhSlope,
    /// ∫ (x − a)⁺ p(x) dx.
    excess: f64,
}

impl<'a> SlopeBelowHorizon<'a> {
    /// `a` = −cot of the view's polar angle in unit space, a ≥ 0 and finite.
    pub(crate) fn new(shape: &'a Shape, a: f64) -> Self {
        let w_a = shape.asinh_slope(a);
        Self { shape, a, w_a, excess: shape.excess(w_a) }
    }

    /// ∫ (x − a)⁺ p(x) dx: the projected area for a horizontal component 1. 0 where it underflows.
    pub(crate) fn excess(&self) -> f64 {
        self.excess
    }

    /// Mass of slopes above x ≥ a: ∫ₓ^∞ (ξ − a) p(ξ) dξ.
    fn upper(&self, w: AsinhSlope) -> f64 {
        let x = self.shape.slope(w);
        if x < 2.0 * self.a {
            // (ξ − x) + (x − a): the sum of two positive parts, where M(x) − a Q(x) would cancel.
            self.shape.excess(w) + (x - self.a).max(0.0) * self.shape.tail(w)
        } else {
            // At least half of the moment remains, and no overflowing slope is formed.
            self.shape.first_moment(w) - self.a * self.shape.tail(w)
        }
    }

    fn density(&self, w: AsinhSlope) -> f64 {
        let x = self.shape.slope(w);
        if x < 2.0 * self.a {
            (x - self.a).max(0.0) * self.shape.density(w)
        } else {
            self.shape.first_moment_density(w) - self.a * self.shape.density(w)
        }
    }

    pub(crate) fn complement(&self, w: AsinhSlope) -> f64 {
        if w <= self.w_a { 1.0 } else { (self.upper(w) / self.excess).clamp(0.0, 1.0) }
    }

    /// Inverse CDF; u = 0 is the silhouette, u = 1 an infinite slope.
    pub(crate) fn quantile(&self, u: f64) -> AsinhSlope {
        let target = (1.0 - u) * self.excess;
        // Where the excess underflows (a > 27 for Beckmann) all slopes within reach lie at the
        // silhouette.
        if u <= 0.0 || self.excess == 0.0 {
            return self.w_a;
        }
        if target <= 0.0 {
            return f64::INFINITY;
        }
        solve_decreasing(target, self.w_a, f64::INFINITY, |w| (self.upper(w), self.density(w)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_inverts_the_cdf() {
        for gamma in [1.55, 2.0, 4.0, 60.0, f64::INFINITY] {
            let shape = Shape::new(gamma).unwrap();
            for a in [0.0, 1e-6, 0.3, 2.0, 5.0] {
                let below = SlopeBelowHorizon::new(&shape, a);
                for u in [1e-9, 0.01, 0.5, 0.99, 1.0 - 1e-9] {
                    let back = 1.0 - below.complement(below.quantile(u));
                    assert!((back - u).abs() < 1e-13, "gamma {gamma}, a {a}, u {u}: {back}");
                }
            }
        }
    }

    #[test]
    fn ggx_median_is_the_closed_form() {
        // γ = 2, a = 0: density ∝ x (1+x²)^(−3/2), survival (1+x²)^(−1/2).
        let shape = Shape::new(2.0).unwrap();
        let x = shape.slope(SlopeBelowHorizon::new(&shape, 0.0).quantile(0.5));
        assert!((x - 3.0_f64.sqrt()).abs() < 1e-14);
    }
}
