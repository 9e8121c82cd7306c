//! Directional albedo by deterministic quadrature over slopes.
//!
//! Let r, φ be polar coordinates of the unit slopes (slopes divided by σ), about the normal m = n.
//! Reflection off m stays above the surface if and only if its slope lies in a certain disc (an
//! ellipse in unit slopes), which contains the origin, so that
//!
//! ```text
//! E = 1/(cos θ + ρ e(z)) ∫dφ ∫₀^{R(φ)} r dr P22(r) (cos θ − r b(φ)) F(v·m) S(l)
//! ```
//!
//! with ρ the σ-stretched horizontal length of v, ρ e(z) = cos θ Λ(v), r b the slope towards v
//! times sin θ (negative where m faces v), and S = G1(l) or G1(l)/(G1(l) + G1(v)(1 − G1(l))) for
//! the two forms of masking. The factor in front is G1(v)/cos θ as one quotient, finite at grazing.
//! The integrand is smooth inside the disc. It varies quickly in a layer of width σ along the rim,
//! where l grazes, and, for views near grazing, where R(φ) turns, at right angles to v. Both are
//! stretched by a hyperbolic sine whose scale is known.

mod average;
mod round;
mod sectors;
mod skewed;

use core::f64::consts::PI;

use crate::converge::{Albedo, Both, CUT, RULES, add_place, converge};
use crate::error::{ParameterError, check_cosine};
use crate::panels::{End, Gauss};
use crate::shape::Shape;
use crate::slope_integrals::{inverse_ln_cosh, ln_cosh};
use crate::slope_table::SlopeTable;
use crate::smith_table::SmithTable;

/// Largest rapidity of a slope, so that its square, e⁶⁸⁰, does not overflow.
const LARGEST_RAPIDITY: f64 = 340.0;
/// Widest panel along a ray, in the asinh slope w; the lobe's own singularities are at ±iπ/(2√s),
/// 1.1 or more away.
pub(crate) const PANEL: f64 = 1.5;
/// Largest share of the tolerance that a layer along the rim may hold without being resolved, an
/// upper bound of the error: smooth surfaces take fewer points.
const THIN: f64 = 0.05;
/// A square root is resolved by panels that begin this small: their error is 1e-3 (1e-2)^1.5.
pub(crate) const ROOT: f64 = 0.01;

/// Integrates albedos for one shape γ and any roughness, view and Fresnel reflectance.
#[derive(Clone, Debug)]
pub struct AlbedoIntegrator {
    shape: Shape,
    pub(crate) smith: SmithTable,
    pub(crate) slopes: SlopeTable,
    pub(crate) tolerance: f64,
    /// Asinh slope at which integrals over the lobe are cut off.
    pub(crate) cut: f64,
    /// Asinh slope of the cut across the view, where tails are shorter: the share beyond w is less
    /// than cosh^(−2k−1) √s w.
    cut_across: f64,
    /// The slope at that cut.
    slope_across: f64,
    /// Slopes across the view of skewed lobes.
    across: SlopeTable,
}

/// The view and what depends on it alone.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    /// Azimuth in the frame of the principal axes.
    pub(crate) cos_phi: f64,
    pub(crate) sin_phi: f64,
    pub(crate) sigma: [f64; 2],
    /// G1(v)/cos θ.
    pub(crate) scale: f64,
    pub(crate) g1: f64,
    /// Smaller σ over larger.
    pub(crate) aspect: f64,
    /// Width of the turn of R(φ) at right angles to v.
    turn: f64,
    /// Unit slope of the m that reflects v to n, where Λ(l) has a branch point: azimuth and radius.
    phi_normal: f64,
    r_normal: f64,
    /// The asinh slope of that radius.
    w_normal: f64,
    /// Whether the branch point is strong enough to need panels of its own.
    branch: bool,
    /// v·m at which the reflectance has a kink; 0 if it has none.
    pub(crate) kink: f64,
}

/// The w at which integrals over the lobe are cut off, for normals that are visible beyond `from`
/// only: the share of them beyond w is less than (cosh √s w/cosh √s from)^(−2k). `largest` is the
/// largest rapidity √s w.
fn cut(shape: &Shape, tolerance: f64, k: f64, from: f64, largest: f64) -> f64 {
    let log = -libm::log(CUT * tolerance);
    if shape.is_beckmann() {
        return (log + from * from).sqrt();
    }
    let root = shape.s().sqrt();
    inverse_ln_cosh(ln_cosh(root * from) + 0.5 * log / k).min(largest) / root
}

impl AlbedoIntegrator {
    /// Prepares an integrator for `shape`; `tolerance` is the absolute error aimed at, clamped to
    /// [1e-13, 1e-2].
    pub fn new(shape: Shape, tolerance: f64) -> Self {
        let tolerance = tolerance.clamp(1e-13, 1e-2);
        let cut = cut(&shape, tolerance, shape.gamma() - 1.5, 0.0, LARGEST_RAPIDITY);
        let cut_across = self::cut(&shape, tolerance, shape.gamma() - 1.0, 0.0, f64::INFINITY);
        let smith = SmithTable::new(&shape, (CUT * tolerance).max(1e-13));
        Self {
            shape,
            smith,
            slopes: SlopeTable::new(&shape, cut),
            tolerance,
            cut,
            cut_across,
            slope_across: shape.slope(cut_across),
            across: SlopeTable::across(&shape, cut_across),
        }
    }

    /// ∫ π P22(r) r² dr beyond the largest rapidity, where integrals over heavy tails, r^(−2k−1)
    /// with k = γ − 3/2, are cut off before the rest is negligible. `None` where it is negligible.
    pub(crate) fn tail(&self) -> Option<f64> {
        let (s, k) = (self.shape.s(), self.shape.gamma() - 1.5);
        let heavy = s > 0.0 && self.cut * s.sqrt() >= LARGEST_RAPIDITY;
        heavy.then(|| {
            libm::exp(-2.0 * k * LARGEST_RAPIDITY) * libm::exp2(2.0 * k) / (2.0 * k * s * s.sqrt())
        })
    }

    /// The shape it was prepared for.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Albedo of reflection for roughness σ ≥ 0 along both axes and a view at cos θ ∈ [0, 1];
    /// `weight` gives the reflectances at v·m ∈ [0, 1].
    ///
    /// σ = 0 is a mirror. cos θ = 0 is the limit of grazing views.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 ≤ σ < ∞ and cos θ ∈ [0, 1].
    pub fn reflection<const N: usize>(
        &self,
        sigma: f64,
        cos_theta: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        self.reflection_to(self.tolerance, sigma, cos_theta, weight)
    }

    /// [`reflection`](Self::reflection) to a tolerance no smaller than that of the integrator.
    pub(crate) fn reflection_to<const N: usize>(
        &self,
        tolerance: f64,
        sigma: f64,
        cos_theta: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        check_cosine(cos_theta)?;
        // −0 is the horizon as well, not below it.
        let cos_theta = cos_theta.abs();
        if sigma == 0.0 {
            return Ok(Albedo::new([weight(cos_theta); 2], 0.0));
        }
        Ok(self.converged(tolerance, &self.view([sigma, sigma], cos_theta, 0.0)?, weight))
    }

    /// Albedo of reflection for roughness σx, σy > 0 and a view at cos θ ∈ [0, 1] and azimuth φ
    /// (radians from the x axis); otherwise as [`reflection`](Self::reflection).
    ///
    /// # Errors
    /// [`ParameterError`] unless both σ are positive and finite and cos θ ∈ [0, 1].
    pub fn reflection_anisotropic<const N: usize>(
        &self,
        sigma: [f64; 2],
        cos_theta: f64,
        phi: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        Ok(self.converged(self.tolerance, &self.view(sigma, cos_theta, phi)?, weight))
    }

    /// Albedo of reflection for reflectances with a square-root singularity at
    /// v·m = `kink` ∈ (0, 1), where total reflection sets in; otherwise as
    /// [`reflection`](Self::reflection).
    ///
    /// # Errors
    /// As [`reflection`](Self::reflection).
    pub fn reflection_with_kink<const N: usize>(
        &self,
        sigma: f64,
        cos_theta: f64,
        kink: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        self.reflection_with_kink_to(self.tolerance, sigma, cos_theta, kink, weight)
    }

    /// [`reflection_with_kink`](Self::reflection_with_kink) to a tolerance no smaller than that of
    /// the integrator.
    pub(crate) fn reflection_with_kink_to<const N: usize>(
        &self,
        tolerance: f64,
        sigma: f64,
        cos_theta: f64,
        kink: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        if sigma == 0.0 {
            return self.reflection_to(tolerance, sigma, cos_theta, weight);
        }
        let view = View { kink, ..self.view([sigma, sigma], cos_theta, 0.0)? };
        Ok(self.converged(tolerance, &view, weight))
    }

    /// [`reflection_with_kink`](Self::reflection_with_kink) for roughness σx, σy > 0 and a view at
    /// azimuth φ (radians from the x axis).
    ///
    /// # Errors
    /// As [`reflection_anisotropic`](Self::reflection_anisotropic).
    pub fn reflection_anisotropic_with_kink<const N: usize>(
        &self,
        sigma: [f64; 2],
        cos_theta: f64,
        phi: f64,
        kink: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        let view = View { kink, ..self.view(sigma, cos_theta, phi)? };
        Ok(self.converged(self.tolerance, &view, weight))
    }

    /// The albedos of one view at the first order that is accurate enough, or else the last.
    fn converged<const N: usize>(
        &self,
        tolerance: f64,
        view: &View,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Albedo<N> {
        if view.aspect == 1.0 && view.kink == 0.0 {
            return self.round(tolerance, view, weight);
        }
        self.refined(tolerance, view.kink > 0.0, |rule| self.quadrature(rule, view, &weight))
    }

    /// The albedos by `quadrature` at the first order that is accurate enough, or else the last;
    /// `kink` says whether a kink lies inside its domain.
    pub(crate) fn refined<const N: usize>(
        &self,
        tolerance: f64,
        kink: bool,
        quadrature: impl Fn(&Gauss) -> Both<N>,
    ) -> Albedo<N> {
        // At a kink orders converge algebraically, and their last difference says less about the
        // error. Elsewhere twice that difference, because two orders may agree by chance.
        converge(&RULES[..], tolerance, if kink { 10.0 } else { 2.0 }, quadrature)
    }

    pub(crate) fn view(&self, sigma: [f64; 2], cos: f64, phi: f64) -> Result<View, ParameterError> {
        for sigma in sigma {
            if !(sigma > 0.0 && sigma < f64::INFINITY) {
                return Err(ParameterError::Sigma(sigma));
            }
        }
        check_cosine(cos)?;
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        let (sin_phi, cos_phi) = libm::sincos(phi);
        let rho = sin * libm::hypot(sigma[0] * cos_phi, sigma[1] * sin_phi);
        let excess =
            if rho == 0.0 { 0.0 } else { self.shape.excess(self.shape.asinh_slope(cos / rho)) };
        let area = cos + rho * excess;
        let [sx, sy] = sigma;
        let half = sin / (1.0 + cos);
        let (x, y) = (cos_phi / sx, sin_phi / sy);
        let phi_normal = libm::atan2(y, x) + PI;
        let r_normal = half * libm::hypot(x, y);
        Ok(View {
            cos,
            sin,
            cos_phi,
            sin_phi,
            sigma,
            scale: 1.0 / area,
            g1: cos / area,
            aspect: sx.min(sy) / sx.max(sy),
            turn: cos / (sin * sx.max(sy).max(1.0)),
            phi_normal,
            r_normal,
            w_normal: self.shape.asinh_slope(r_normal),
            branch: self.branches(sx.max(sy), r_normal),
            kink: 0.0,
        })
    }

    /// Whether the branch point of Λ(l) at l = n, which the unit slope `r_normal` reflects to, is
    /// strong enough to need panels of its own.
    fn branches(&self, sigma: f64, r_normal: f64) -> bool {
        // Near that slope l turns by 2σ per unit slope. What counts is the share masked there,
        // times the density.
        let reach = r_normal.max(1.0);
        let masked = 1.0 - self.smith.g1(1.0, libm::pow(2.0 * sigma * sigma * reach, 2.0));
        let square = r_normal * r_normal;
        let density = if self.shape.is_beckmann() {
            libm::exp(-square)
        } else {
            libm::exp(-self.shape.gamma() * libm::log1p(self.shape.s() * square))
        };
        masked * density * reach * reach > 0.5 * self.tolerance
    }

    /// The integrals for both forms of masking at one order of quadrature.
    fn quadrature<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        weight: &impl Fn(f64) -> [f64; N],
    ) -> Both<N> {
        let sectors = view.sectors(&self.ends(view));
        view.over_sectors(rule, &sectors, |phi| self.ray(rule, view, phi, weight))
    }

    /// The azimuths of slope at which rays change, as of [`View::sectors`].
    fn ends(&self, view: &View) -> Vec<End> {
        let scale = if view.branch { 0.05 * view.aspect } else { f64::INFINITY };
        let towards = End { at: PI, scale };
        let right = view.right();
        if view.kink == 0.0 {
            return vec![End::plain(0.0), right, towards];
        }
        let conic = self.conic_ends(view.cos, view.sin, view.kink, right);
        // Below the kink R(φ) turns before rays meet the cone.
        let turn = (view.cos < view.kink).then_some(right);
        [End::plain(0.0)].into_iter().chain(turn).chain(conic).chain([towards]).collect()
    }

    /// The integral along one ray of slopes from m = n to the rim.
    fn ray<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        phi: f64,
        weight: &impl Fn(f64) -> [f64; N],
    ) -> Both<N> {
        let (sin_phi, cos_phi) = libm::sincos(phi);
        let (x, y) = (view.sigma[0] * cos_phi, view.sigma[1] * sin_phi);
        let a = x * x + y * y;
        let b = view.sin * (x * view.cos_phi + y * view.sin_phi);
        let aside = libm::fabs(libm::sin(phi - view.phi_normal));
        self.along_ray(rule, view, [a, b, aside], weight, |_, r, k| {
            let reach = k * r;
            let l_x = view.sigma[0] * (reach * x + view.sin * view.cos_phi);
            let l_y = view.sigma[1] * (reach * y + view.sin * view.sin_phi);
            l_x * l_x + l_y * l_y
        })
    }

    /// The integral along a ray whose slope per unit slope has the square a and is b/sin θ away
    /// from the view; `aside` is the sine of the angle to the branch point's ray. `across` gives
    /// the light's squared horizontal length, stretched by σ, from its cosine, r and 2v·m/|m|².
    fn along_ray<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        [a, b, aside]: [f64; 3],
        weight: &impl Fn(f64) -> [f64; N],
        across: impl Fn(f64, f64, f64) -> f64,
    ) -> Both<N> {
        let q = (b * b + a * view.cos * view.cos).sqrt();
        let s = self.shape.s();
        let rim = if b > 0.0 { view.cos / (b + q) } else { (q - b) / (a * view.cos) };
        let w_rim = self.shape.asinh_slope(rim);
        let end = if w_rim <= self.cut {
            // l_z falls by 2q/(1 + a r²) per slope r: to √a, where masking sets in, and then to
            // zero.
            let layer = a.sqrt() * (1.0 + a * rim * rim) / (2.0 * q * (1.0 + s * rim * rim).sqrt());
            // A layer that holds next to nothing of what is seen need not be resolved.
            let held = self.slopes.at(w_rim).1 * (view.cos - rim * b) * view.scale;
            End { at: w_rim, scale: layer.max(THIN * self.tolerance / held) }
        } else {
            End::plain(self.cut)
        };
        // Distances from the branch point at l = n, in w.
        let cone = |distance: f64| {
            let scale = view.aspect * distance / (1.0 + s * view.r_normal * view.r_normal).sqrt();
            if view.branch && scale < 0.5 { scale.max(0.01 * view.aspect) } else { f64::INFINITY }
        };
        let mut stops = self.conic(view.cos, view.kink, a, b, end.at, ROOT);
        let mut from = End::plain(0.0);
        let mut points = Vec::with_capacity(128);
        if b < 0.0 {
            let normal = End { at: view.w_normal, scale: cone(view.r_normal * aside) };
            if normal.scale.is_finite() && normal.at < end.at {
                stops.push(normal);
                stops.sort_by(|x, y| x.at.total_cmp(&y.at));
            }
        } else if stops.is_empty() {
            from.scale = cone(view.r_normal);
        }
        for i in 0..=stops.len() {
            let to = stops.get(i).copied().unwrap_or(end);
            rule.graded(from, to, PANEL, |w, jacobian| points.push([w, jacobian, 0.0, 0.0]));
            from = to;
        }
        // One pass over all points for each step of the formula, so that several points are
        // computed at a time.
        for point in &mut points {
            let (r, measure) = self.slopes.at(point[0]);
            *point = [r, point[1] * measure, 0.0, 0.0];
        }
        for point in &mut points {
            let [r, mass, ..] = *point;
            let shrink = 1.0 / (1.0 + a * r * r);
            let facing = view.cos - r * b;
            let k = 2.0 * facing * shrink;
            let l_z = k - view.cos;
            *point = [l_z, across(l_z, r, k), mass * facing, (facing * shrink.sqrt()).min(1.0)];
        }
        for point in &mut points {
            let [l_z, across, mass, mu] = *point;
            let [uncorrelated, correlated] = self.smith.shares(view.g1, l_z, across);
            *point = [mass * uncorrelated, mass * correlated, mu, 0.0];
        }
        let mut sum = [[0.0; N]; 2];
        for [uncorrelated, correlated, mu, _] in points {
            add_place(&mut sum, [uncorrelated, correlated], weight(mu.max(0.0)));
        }
        if view.cos == 0.0
            && b < 0.0
            && let Some(tail) = self.tail()
        {
            // At grazing height-correlated masking (G2/G1 = 1) keeps all of the tail.
            let fresnel = weight(-b / a.sqrt());
            for i in 0..N {
                sum[1][i] -= b * tail * fresnel[i];
            }
        }
        sum
    }
}
