//! Masking and visible normals of any isotropic distribution, by quadrature over its slopes.
//!
//! Slopes are divided by a scale σ. With r² = x² + y², and the slope across written as y, every
//! function of the in-plane slope x is an integral of the slope density P22(r) over y alone, with a
//! smooth integrand: p = 2∫P22 dy, Q = 2∫P22 atan(y/x) y dy, and so on.

use core::f64::consts::{FRAC_PI_2, PI};

use super::Isotropic;

/// Nodes of one integral on each side of the middle.
const NODES: i32 = 48;
/// Step between them. The rule is double exponential; on smooth distributions it is good to 1e-12.
const STEP: f64 = 4.0 / NODES as f64;

/// The slope marginal of an isotropic distribution in units of a scale σ.
pub struct Marginal<'a> {
    d: &'a dyn Isotropic,
    sigma: f64,
    /// Largest unit slope; ∞ where normals reach the horizon.
    reach: f64,
    nodes: Vec<Node>,
}

/// A node of the double exponential rule: u = π/2 sinh t, t in even steps.
struct Node {
    u: f64,
    /// The step of u.
    du: f64,
    exp_u: f64,
    /// exp(−2|u|).
    decay: f64,
}

/// Integrals of the marginal p beyond a slope x ≥ 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct Beyond {
    /// p(x).
    pub density: f64,
    /// ∫ₓ^∞ p.
    pub tail: f64,
    /// ∫ₓ^∞ ξ p(ξ) dξ.
    pub first_moment: f64,
    /// ∫ₓ^∞ (ξ − x) p(ξ) dξ = x Λ(x).
    pub excess: f64,
}

impl<'a> Marginal<'a> {
    /// The marginal of `d` with the median slope as its scale σ, which for Trowbridge–Reitz is C.
    pub fn new(d: &'a dyn Isotropic) -> Self {
        let sigma = libm::tan(d.sample_theta(0.5));
        let reach = libm::tan(d.support()) / sigma;
        // A support that ends within rounding of the horizon (tan negative or huge) is the whole
        // hemisphere.
        let reach = if (0.0..1e6).contains(&reach) { reach } else { f64::INFINITY };
        let node = |i: i32| {
            let t = f64::from(i) * STEP;
            let (u, du) = (FRAC_PI_2 * libm::sinh(t), FRAC_PI_2 * libm::cosh(t) * STEP);
            Node { u, du, exp_u: libm::exp(u), decay: libm::exp(-2.0 * u.abs()) }
        };
        Self { d, sigma, reach, nodes: (-NODES..=NODES).map(node).collect() }
    }

    /// The scale σ.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Largest unit slope; ∞ where normals reach the horizon.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    pub(crate) fn corners(&self) -> Vec<f64> {
        self.d.corners()
    }

    /// The unit slope at which D has fallen to half of its peak; ∞ if it never does.
    pub(crate) fn half_slope(&self) -> f64 {
        // β_half within rounding of the horizon may have a negative tangent.
        let slope = self.d.half_angle().map(libm::tan).filter(|slope| *slope > 0.0);
        slope.map_or(f64::INFINITY, |slope| slope / self.sigma)
    }

    /// D per steradian at the unit slope r.
    pub fn d(&self, r: f64) -> f64 {
        self.d.d(libm::atan(self.sigma * r))
    }

    /// Density of unit slopes at the distance r from 0.
    pub fn p22(&self, r: f64) -> f64 {
        let slope = self.sigma * r;
        let cos2 = 1.0 / (1.0 + slope * slope);
        self.sigma * self.sigma * self.d.d(libm::atan(slope)) * cos2 * cos2
    }

    /// Calls `add(y, weight)` at the nodes of ∫ over y from `from` to the end of the support, at
    /// in-plane slope x.
    fn across(&self, x: f64, from: f64, mut add: impl FnMut(f64, f64)) {
        let whole = if self.reach.is_finite() {
            let left = self.reach * self.reach - x * x;
            if left <= from * from {
                return;
            }
            left.sqrt() - from
        } else {
            f64::INFINITY
        };
        let scale = (1.0 + x * x + from * from).sqrt();
        for &Node { u, du, exp_u, decay: e } in &self.nodes {
            if whole.is_finite() {
                // tanh on [from, from + whole].
                let near = whole * e / (1.0 + e);
                let y = if u < 0.0 { from + near } else { from + (whole - near) };
                add(y, whole * 2.0 * e / ((1.0 + e) * (1.0 + e)) * du);
            } else {
                let y = scale * exp_u;
                if y < 1e30 {
                    add(from + y, y * du);
                }
            }
        }
    }

    /// The integrals beyond x ≥ 0.
    pub fn beyond(&self, x: f64) -> Beyond {
        let mut sum = Beyond::default();
        self.across(x, 0.0, |y, weight| {
            let w = 2.0 * weight * self.p22(libm::hypot(x, y));
            let angle = if x > 0.0 { libm::atan(y / x) } else { FRAC_PI_2 };
            sum.density += w;
            sum.tail += w * y * angle;
            sum.first_moment += w * y * y;
            sum.excess += w * y * (y - x * angle).max(0.0);
        });
        sum
    }

    /// The distribution of slopes across, given the in-plane slope x.
    pub fn across_at(&self, x: f64) -> Across<'_> {
        Across { marginal: self, x, half: self.p22_beyond(x, 0.0) }
    }

    /// ∫ P22 over the slopes across that exceed y.
    fn p22_beyond(&self, x: f64, y: f64) -> f64 {
        let mut sum = 0.0;
        self.across(x, y, |y, weight| sum += weight * self.p22(libm::hypot(x, y)));
        sum
    }

    /// Smith's G1 of a view at polar angle θ ∈ [0, π/2) (radians).
    pub fn g1(&self, theta: f64) -> f64 {
        let (sin, cos) = (self.sigma * libm::sin(theta), libm::cos(theta));
        if sin == 0.0 { 1.0 } else { cos / (cos + sin * self.beyond(cos / sin).excess) }
    }
}

/// The distribution of slopes across at one in-plane slope; symmetric, and independent of the view.
pub struct Across<'a> {
    marginal: &'a Marginal<'a>,
    x: f64,
    /// ∫ P22 over the slopes across y > 0.
    half: f64,
}

impl Across<'_> {
    /// The share that exceeds y ≥ 0; 0 where the in-plane slope is beyond the support.
    pub fn tail(&self, y: f64) -> f64 {
        if self.half > 0.0 { 0.5 * self.marginal.p22_beyond(self.x, y) / self.half } else { 0.0 }
    }

    /// Density at y; 0 where the in-plane slope is beyond the support.
    pub fn density(&self, y: f64) -> f64 {
        let density = || 0.5 * self.marginal.p22(libm::hypot(self.x, y)) / self.half;
        if self.half > 0.0 { density() } else { 0.0 }
    }
}

/// The in-plane slopes that a view sees: density ∝ (cos θ + x sin θ) p(x) beyond the silhouette, θ
/// being the polar angle in unit space.
pub struct MarginalView<'a> {
    marginal: &'a Marginal<'a>,
    sin: f64,
    cos: f64,
    /// Unit cotangent, and the excess beyond it.
    z: f64,
    excess: f64,
    area: f64,
}

impl<'a> MarginalView<'a> {
    /// A view whose unit cotangent is z = cot θ_v/σ ∈ [0, ∞].
    pub fn new(marginal: &'a Marginal<'a>, z: f64) -> Self {
        let crate::UnitView { sin, cos } = crate::UnitView::from_cotangent(z);
        let excess = if sin == 0.0 { 0.0 } else { marginal.beyond(z).excess };
        Self { marginal, sin, cos, z, excess, area: cos + sin * excess }
    }

    /// Projected area cos θ (1 + Λ) in unit space.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The shares of visible normals with in-plane slopes less and greater than x, each accurate
    /// where it is small, and the density at x.
    pub fn shares(&self, x: f64) -> Shares {
        if x <= -self.z {
            return Shares { below: 0.0, above: 1.0, density: 0.0 };
        }
        let at = self.marginal.beyond(x.abs());
        let density = (self.cos + x * self.sin).max(0.0) * at.density / self.area;
        if x >= 0.0 {
            let above = (self.cos * at.tail + self.sin * at.first_moment) / self.area;
            return Shares { below: 1.0 - above, above, density };
        }
        let below = if self.sin == 0.0 {
            self.cos * at.tail
        } else {
            // ∫ (z − ξ) p from |x| to z.
            self.sin * ((self.z + x) * at.tail - at.excess + self.excess)
        };
        let below = (below / self.area).max(0.0);
        Shares { below, above: 1.0 - below, density }
    }
}

/// How visible normals split at an in-plane slope.
#[derive(Clone, Copy, Debug)]
pub struct Shares {
    /// Share of smaller slopes.
    pub below: f64,
    /// Share of larger slopes.
    pub above: f64,
    /// Density at the slope.
    pub density: f64,
}

/// ∫ D (m·n) dm by the marginal's quadrature over slopes: 1 when that resolves the distribution.
pub fn resolved(marginal: &Marginal) -> f64 {
    let mut sum = 0.0;
    marginal.across(0.0, 0.0, |r, weight| sum += 2.0 * PI * r * weight * marginal.p22(r));
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classic::{Gauss, Gtr, Member, Sawicki, Schlick};
    use crate::{SignedSlope, UnitView, VisibleSlope};

    #[test]
    fn members_have_the_family_s_closed_forms() {
        for (member, scale) in [
            (Member::beckmann(0.3).unwrap(), None),
            (Member::trowbridge_reitz(0.2).unwrap(), Some(0.2)),
            (Member::blinn_phong(12.0).unwrap(), None),
            (Member::student_t(0.5, 2.6).unwrap(), None),
        ] {
            let (marginal, t) = (Marginal::new(&member), member.student_t().unwrap());
            if let Some(scale) = scale {
                assert!((marginal.sigma() - scale).abs() < 1e-12);
            }
            let shape = t.shape();
            // The family's unit slopes are divided by its own σ.
            let ratio = marginal.sigma() / t.sigma_x();
            for z in [0.0, 0.2, 1.0, 4.0] {
                let w = shape.asinh_slope(z * ratio);
                let at = marginal.beyond(z);
                assert!((at.tail - shape.tail(w)).abs() < 1e-9, "tail at {z}");
                assert!((at.excess * ratio - shape.excess(w)).abs() < 1e-9, "excess at {z}");
                let visible = MarginalView::new(&marginal, z);
                let exact = VisibleSlope::new(shape, UnitView::from_cotangent(z * ratio));
                for x in [-1.0, -0.1, 0.3, 2.0_f64] {
                    let w = shape.asinh_slope((x * ratio).abs());
                    let want = exact.cdf(SignedSlope { w, sign: x.signum() });
                    assert!((visible.shares(x).below - want).abs() < 1e-8, "z {z}, x {x}");
                }
            }
        }
    }

    #[test]
    fn the_quadrature_resolves_the_others() {
        let all: [&dyn Isotropic; 5] = [
            &Gauss::new(0.2).unwrap(),
            &Gtr::new(0.1, 1.2).unwrap(),
            &Schlick::new(0.2).unwrap(),
            &Sawicki::new(0.0).unwrap(),
            &Sawicki::new(1e4).unwrap(),
        ];
        for d in all {
            let marginal = Marginal::new(d);
            assert!((resolved(&marginal) - 1.0).abs() < 1e-9, "{}", resolved(&marginal));
            assert!((marginal.beyond(0.0).tail - 0.5).abs() < 1e-9);
            // p is minus the derivative of the tail, and the tail that of the excess.
            for x in [0.3, 0.9, 1.7] {
                let [a, at, b] = [x - 1e-4, x, x + 1e-4].map(|x| marginal.beyond(x));
                assert!(((a.tail - b.tail) / 2e-4 - at.density).abs() < 1e-6, "density at {x}");
                assert!(((a.excess - b.excess) / 2e-4 - at.tail).abs() < 1e-6, "tail at {x}");
                let across = marginal.across_at(x);
                let [a, tail, b] = [0.4 - 1e-4, 0.4, 0.4 + 1e-4].map(|y| across.tail(y));
                assert!((0.0..0.5).contains(&tail));
                assert!(((a - b) / 2e-4 - across.density(0.4)).abs() < 1e-5);
            }
        }
    }
}
