//! The view axis of G1 and the slope axis of bounded distributions: x/(x + κ).

use microfacet_core::shape::S_END;
use microfacet_lanes::Lanes;
use serde::{Deserialize, Serialize};

use super::coordinate::{Coordinate, positive};
use super::crowded;

/// The coordinate q = x/(x + κ) ∈ [0, 1] of x ∈ [0, ∞], a unit cotangent z = cot θ_v/σ_v or a
/// slope.
///
/// κ = scale/(2 − s); for tables without a γ axis s = 1, so that κ is the scale itself. Where
/// `crowded`, t = 1 − √(1−q). In G1, q takes up the zero at grazing, the limit at normal incidence
/// and, through κ, the divergence of the projected area as γ → 3/2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rational {
    /// (2 − s) κ.
    pub scale: f64,
    /// Whether the nodes crowd towards x = ∞.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub crowded: bool,
}

impl Rational {
    /// The parameters of baked G1 tables: κ is within 10 % of the projected area at grazing, the
    /// mean positive slope c√s/(2−s).
    pub const BAKED: Self = Self { scale: 0.5, crowded: false };

    /// κ for the shape s.
    pub fn kappa(&self, s: f64) -> f64 {
        self.scale / (S_END - s)
    }

    /// t of x ∈ [0, ∞], for κ.
    pub fn coordinate(&self, x: f64, kappa: f64) -> f64 {
        if x == f64::INFINITY {
            return 1.0;
        }
        let (q, rest) = (x / (x + kappa), kappa / (x + kappa));
        if self.crowded { crowded::coordinate(q, rest) } else { q }
    }

    /// q and 1 − q at t.
    pub fn parts(&self, t: f64) -> [f64; 2] {
        if self.crowded { crowded::parts(t) } else { [t, 1.0 - t] }
    }

    /// dq/dt at t.
    pub fn rate(&self, t: f64) -> f64 {
        if self.crowded { crowded::rate(t) } else { 1.0 }
    }

    /// x at t, for κ; ∞ for 1.
    pub fn quantity(&self, t: f64, kappa: f64) -> f64 {
        let [q, rest] = self.parts(t);
        kappa * q / rest
    }

    /// t of the slope x : z with x, z ≥ 0, given `kappa_z` = κz.
    #[inline(always)]
    pub fn of_slope(&self, x: f32, kappa_z: f32) -> f32 {
        let whole = x + kappa_z;
        if self.crowded { crowded::fast(kappa_z / whole) } else { x / whole }
    }

    /// t times `cells` of x = z/ρ, given r = cells/(z + κρ).
    #[inline(always)]
    pub fn of_view(&self, rho: f32, z: f32, kappa: f32, r: f32, cells: f32) -> f32 {
        if self.crowded { crowded::fast(kappa * rho * r / cells) * cells } else { z * r }
    }

    /// q and t, both times `cells`, of views in lanes, given `across` = κρ.
    #[inline(always)]
    pub fn of_views<L: Lanes>(&self, across: L, z: L, cells: f32) -> [L; 2] {
        let area = z + across;
        let q = z * cells / area;
        [q, if self.crowded { (L::splat(1.0) - (across / area).sqrt()) * cells } else { q }]
    }
}

impl Coordinate for Rational {
    fn formula(&self) -> &'static str {
        "q = z/(z + κ), κ = scale/(2−s); where crowded, t = 1 − √(1−q)"
    }

    fn fault(&self) -> Option<&'static str> {
        (!positive(&[self.scale])).then_some("scale out of range")
    }
}

#[cfg(test)]
mod tests {
    use microfacet_lanes::f32x4;

    use super::*;

    #[test]
    fn there_and_back() {
        for axis in [Rational::BAKED, Rational { scale: 3.0, crowded: true }] {
            for s in [0.0, 1.0, 1.99] {
                let kappa = axis.kappa(s);
                for t in [0.0, 1e-9, 0.3, 0.999, 1.0] {
                    let back = axis.coordinate(axis.quantity(t, kappa), kappa);
                    assert!((back - t).abs() < 1e-15, "{t}: {back}");
                    let step = 1e-6;
                    let change = axis.parts(t + step)[0] - axis.parts(t - step)[0];
                    assert!((change / (2.0 * step) - axis.rate(t)).abs() < 1e-8);
                    assert!((axis.parts(t)[0] + axis.parts(t)[1] - 1.0).abs() < 1e-15);
                }
                assert_eq!(axis.coordinate(f64::INFINITY, kappa), 1.0);
            }
        }
        assert_eq!(Rational { scale: 7.0, crowded: false }.kappa(1.0), 7.0);
    }

    #[test]
    fn fast_forms_are_the_exact_one() {
        for crowded in [false, true] {
            let axis = Rational { crowded, ..Rational::BAKED };
            let (kappa, cells) = (1.25_f32, 96.0);
            for (rho, z) in [(1.0_f32, 0.0_f32), (0.9, 1e-4), (0.3, 0.7), (0.0, 1.0)] {
                let exact = axis.coordinate(f64::from(z) / f64::from(rho), f64::from(kappa));
                let one = axis.of_view(rho, z, kappa, cells / (z + kappa * rho), cells);
                let [q, t] = axis.of_views(f32x4::splat(kappa * rho), f32x4::splat(z), cells);
                let plain = Rational { crowded: false, ..axis }
                    .coordinate(f64::from(z / rho), f64::from(kappa));
                let slope = axis.of_slope(z, kappa * rho) * cells;
                let [q, t] = [q, t].map(|x| x.to_array()[1]);
                for (got, want) in [(one, exact), (t, exact), (q, plain), (slope, exact)] {
                    let off = (f64::from(got / cells) - want).abs();
                    assert!(off < 2e-7, "{rho}, {z}: {got} for {want}");
                }
            }
        }
    }
}
