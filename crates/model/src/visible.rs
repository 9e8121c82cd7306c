//! Visible normals in unit space: two independent one-dimensional distributions, their CDFs and
//! inverses.
//!
//! In unit space a view at polar angle θ sees the in-plane slope x (positive towards the viewer)
//! with density ∝ (cos θ + x sin θ) p(x) on x > −cot θ, and the slope across y = √(1 + s x²)·t with
//! t of density ∝ (1 + s t²)^(−γ), independent of the view and of x. The angles α and β of the
//! canonical lobe are tan α = √s x and tan β = √s t; x and t have a limit for s → 0.

use glam::DVec3;

use crate::quadrature;
use crate::shape::{AsinhSlope, Shape};

/// The elevation of a view in unit space, as a unit vector (sin θ, cos θ) in the plane of
/// incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitView {
    /// sin θ ∈ [0, 1].
    pub sin: f64,
    /// cos θ ∈ [0, 1].
    pub cos: f64,
}

impl UnitView {
    /// The view whose unit cotangent is z = cot θ_v / σ_v ∈ [0, ∞].
    pub fn from_cotangent(z: f64) -> Self {
        if z.is_infinite() {
            return Self { sin: 0.0, cos: 1.0 };
        }
        // z² would overflow above 1e154; dividing by the larger of z and 1 avoids that.
        if z > 1.0 {
            let r = 1.0 / z;
            let cos = 1.0 / (1.0 + r * r).sqrt();
            Self { sin: r * cos, cos }
        } else {
            let sin = 1.0 / (1.0 + z * z).sqrt();
            Self { sin, cos: z * sin }
        }
    }

    /// The unit cotangent z = cot θ ∈ [0, ∞].
    pub fn cotangent(&self) -> f64 {
        if self.sin == 0.0 { f64::INFINITY } else { self.cos / self.sin }
    }
}

/// A unit slope with its sign: x = ±slope(w).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedSlope {
    /// Magnitude, see [`AsinhSlope`].
    pub w: AsinhSlope,
    /// −1.0 (away from the viewer) or 1.0 (towards).
    pub sign: f64,
}

/// The distribution of the in-plane slope of visible normals for one shape and one view.
#[derive(Clone, Copy, Debug)]
pub struct VisibleSlope<'a> {
    shape: &'a Shape,
    view: UnitView,
    /// Weights of p(x) and x p(x) for slopes towards the viewer; (cos θ, sin θ) unless peeled.
    towards: (f64, f64),
    /// w of the silhouette x = −cot θ (∞ at normal incidence).
    w_silhouette: AsinhSlope,
    /// E[(X − z)⁺] at the silhouette.
    excess: f64,
    /// Projected area cos θ (1 + Λ) = ∫ (cos θ + x sin θ)⁺ p(x) dx in unit space.
    area: f64,
}

impl<'a> VisibleSlope<'a> {
    /// Prepares the distribution; costs one evaluation of Λ.
    pub fn new(shape: &'a Shape, view: UnitView) -> Self {
        let w_silhouette = shape.asinh_slope(view.cotangent());
        let excess = shape.excess(w_silhouette);
        let area = view.cos + view.sin * excess;
        Self { shape, view, towards: (view.cos, view.sin), w_silhouette, excess, area }
    }

    /// The same distribution *peeled*: without its *heavy part*, the term x sin θ p(x) on x > 0,
    /// whose mass is sin θ·M₀ and whose inverse is closed-form.
    ///
    /// Near γ = 3/2 the heavy part holds almost all of the probability, at slopes beyond any table,
    /// except very close to normal incidence, where it fades: a table of the whole distribution
    /// would have a jump there. What is left is smooth. At grazing its mass is 0; its limiting
    /// shape is returned, the NDF's own slopes towards the viewer, with area ½.
    pub fn peeled(shape: &'a Shape, view: UnitView) -> Self {
        let mut rest = Self::new(shape, view);
        rest.towards = (if view.cos > 0.0 { view.cos } else { 1.0 }, 0.0);
        rest.area = rest.upper(0.0) + rest.lower(0.0);
        rest
    }

    /// Projected area of the microsurface in unit space, cos θ (1 + Λ); if peeled, without the
    /// heavy part, and ½ at grazing.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Mass of slopes above x ≥ 0, not normalised, and its density.
    fn upper_and_density(&self, w: AsinhSlope) -> (f64, f64) {
        let [tail, moment, density, rate] = self.shape.tail_moment_densities(w);
        let (cos, sin) = self.towards;
        (cos * tail + sin * moment, cos * density + sin * rate)
    }

    fn upper(&self, w: AsinhSlope) -> f64 {
        self.upper_and_density(w).0
    }

    /// Mass of slopes between the silhouette and −q ≤ 0, not normalised, and its density.
    fn lower_and_density(&self, w: AsinhSlope) -> (f64, f64) {
        if w >= self.w_silhouette {
            return (0.0, 0.0);
        }
        if self.view.sin == 0.0 {
            let cos = self.view.cos;
            return (cos * self.shape.tail(w), cos * self.shape.density(w));
        }
        let gap = self.w_silhouette - w;
        if gap * (2.0 + 2.0 * w) < 1.0 {
            return (self.lower_by_quadrature(w, gap), self.facing_density(w));
        }
        let q = self.shape.slope(w);
        let [tail, excess, density] = self.shape.tail_excess_density(w);
        let closed =
            (self.view.cos - q * self.view.sin) * tail - self.view.sin * (excess - self.excess);
        (closed.max(0.0), self.facing(w) * density)
    }

    fn lower(&self, w: AsinhSlope) -> f64 {
        self.lower_and_density(w).0
    }

    /// `lower` by quadrature near the silhouette, where the closed form subtracts nearly equal
    /// areas. The integrand is positive and, over a gap of a fraction of its own scale, a
    /// polynomial to all digits.
    fn lower_by_quadrature(&self, w: AsinhSlope, gap: f64) -> f64 {
        quadrature::panel(w, w + gap, |w| self.facing(w) * self.shape.density(w))
    }

    /// cos θ − q sin θ for a slope −q between the silhouette and 0, without cancellation near the
    /// silhouette.
    fn facing(&self, w: AsinhSlope) -> f64 {
        if self.shape.is_beckmann() {
            return self.view.sin * (self.w_silhouette - w);
        }
        // sinh a − sinh b = 2 cosh((a+b)/2) sinh((a−b)/2).
        let root = self.shape.s().sqrt();
        let (a, b) = (root * self.w_silhouette, root * w);
        self.view.sin / root * 2.0 * libm::cosh(0.5 * (a + b)) * libm::sinh(0.5 * (a - b))
    }

    /// CDF of the in-plane slope: the probability of slopes less than `x`, further from the viewer.
    pub fn cdf(&self, x: SignedSlope) -> f64 {
        let share = if x.sign < 0.0 { self.lower(x.w) } else { self.area - self.upper(x.w) };
        (share / self.area).clamp(0.0, 1.0)
    }

    /// 1 − CDF, accurate where the CDF is close to 1.
    pub fn complement(&self, x: SignedSlope) -> f64 {
        let share = if x.sign < 0.0 { self.area - self.lower(x.w) } else { self.upper(x.w) };
        (share / self.area).clamp(0.0, 1.0)
    }

    /// Density of the in-plane slope with respect to w, at a slope of either sign.
    pub fn density(&self, x: SignedSlope) -> f64 {
        let facing = if x.sign < 0.0 {
            if x.w >= self.w_silhouette { 0.0 } else { self.facing_density(x.w) }
        } else {
            self.towards.0 * self.shape.density(x.w)
                + self.towards.1 * self.shape.first_moment_density(x.w)
        };
        facing / self.area
    }

    /// Inverse CDF: the slope below which the share u ∈ [0, 1] of the visible normals lies.
    ///
    /// u = 0 gives the silhouette, u = 1 an infinite slope (the horizon on the viewer's side).
    /// Solved by safeguarded Newton steps on the logarithm of the tail on the slope's side of 0;
    /// the angle is right to about 1e-15.
    pub fn quantile(&self, u: f64) -> SignedSlope {
        let above_zero = self.upper(0.0);
        let below_zero = self.area - above_zero;
        if u * self.area < below_zero {
            let target = u * self.area;
            let w = if target <= 0.0 {
                self.w_silhouette
            } else {
                solve_decreasing(target, 0.0, self.w_silhouette, |w| self.lower_and_density(w))
            };
            return SignedSlope { w, sign: -1.0 };
        }
        let target = (1.0 - u) * self.area;
        let w = if target <= 0.0 {
            f64::INFINITY
        } else {
            solve_decreasing(target, 0.0, f64::INFINITY, |w| self.upper_and_density(w))
        };
        SignedSlope { w, sign: 1.0 }
    }

    fn facing_density(&self, w: AsinhSlope) -> f64 {
        if self.view.sin == 0.0 {
            return self.view.cos * self.shape.density(w);
        }
        self.facing(w) * self.shape.density(w)
    }
}

/// The unnormalised normal in unit space from the in-plane slope x and the slope across
/// t = y/√(1 + s x²); it forms no slope, which might overflow.
pub(crate) fn unit_normal(shape: &Shape, x: SignedSlope, t: SignedSlope) -> DVec3 {
    let (sin_x, cos_x) = shape.unit_sin_cos(x.w);
    let (sin_t, cos_t) = shape.unit_sin_cos(t.w);
    let side = x.sign;
    let (x, z) = (side * sin_x, cos_x);
    // (x : y : z) in homogeneous form, y = √(z² + s x²)·t, everything times cos_t.
    let y = (z * z + shape.s() * x * x).sqrt() * t.sign * sin_t;
    let m = DVec3::new(x * cos_t, y, z * cos_t);
    // Beckmann's slopes are independent, so that two infinite ones have no definite ratio.
    if m == DVec3::ZERO { DVec3::new(side, t.sign, 0.0) } else { m }
}

/// Smallest cosine of a sampled normal: for γ < 2 D has no limit at the horizon, and near γ = 3/2
/// every fourth slope overflows.
pub(crate) const HORIZON: f64 = 1e-300;

/// Normalises a normal and raises its cosine to [`HORIZON`] where it is lower.
pub(crate) fn above_horizon(m: DVec3) -> DVec3 {
    let largest = m.abs().max_element();
    // Squares of smaller components would underflow, and with them the length.
    let m = if largest < 1e-150 { m / largest } else { m }.normalize();
    DVec3::new(m.x, m.y, m.z.max(HORIZON))
}

/// Inverse CDF of the slope across, in units of √(1 + s x²), for u ∈ [0, 1]: odd about u = ½, ±∞ at
/// u = 1 and 0.
pub fn across_quantile(shape: &Shape, u: f64) -> SignedSlope {
    let (target, sign) = if u < 0.5 { (u, -1.0) } else { (1.0 - u, 1.0) };
    let w = if target <= 0.0 {
        f64::INFINITY
    } else {
        solve_decreasing(target, 0.0, f64::INFINITY, |w| {
            (shape.across_tail(w), shape.across_density(w))
        })
    };
    SignedSlope { w, sign }
}

/// The inverse of [`unit_normal`]: the CDF `along` the plane of incidence, and that across it, at a
/// normal of unit space, of any length.
pub(crate) fn numbers(shape: &Shape, m: DVec3, along: impl Fn(SignedSlope) -> f64) -> [f64; 2] {
    let at = |slope: f64| SignedSlope {
        w: shape.asinh_slope(slope.abs()),
        sign: 1.0_f64.copysign(slope),
    };
    let across = m.y / libm::hypot(m.z, shape.s().sqrt() * m.x);
    [along(at(m.x / m.z)), across_cdf(shape, at(across))]
}

/// CDF of the slope across, in units of √(1 + s x²).
pub fn across_cdf(shape: &Shape, t: SignedSlope) -> f64 {
    let tail = shape.across_tail(t.w);
    if t.sign < 0.0 { tail } else { 1.0 - tail }
}

/// Solves f(w) = target for a decreasing f on [lo, hi], where `f` gives the value and minus the
/// derivative.
///
/// Newton on ln f, which is nearly linear in the tails, inside a bracket that is bisected whenever
/// a step leaves it; an infinite upper end is first replaced by doubling.
pub(crate) fn solve_decreasing(
    target: f64,
    mut lo: f64,
    mut hi: f64,
    f: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let mut w = if hi.is_infinite() { lo + 1.0 } else { 0.5 * (lo + hi) };
    for _ in 0..200 {
        let (value, rate) = f(w);
        if value > target {
            lo = w;
        } else {
            hi = w;
        }
        let step = value / rate * libm::log(value / target);
        let newton = w + step;
        let inside = newton > lo && newton < hi;
        let next = if step.is_finite() && inside {
            newton
        } else if hi.is_infinite() {
            2.0 * w
        } else {
            0.5 * (lo + hi)
        };
        // Newton's steps square the error; where the step was a bisection, it must vanish.
        let close = if next == newton { 1e-9 } else { 4e-16 };
        if (next - w).abs() <= close * w.abs() + 1e-18 || hi - lo <= 4e-16 * lo {
            return next;
        }
        w = next;
    }
    w
}
