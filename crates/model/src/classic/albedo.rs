//! Directional albedo of any isotropic distribution, by quadrature over its slopes.
//!
//! In polar coordinates (r, φ) of the slopes about m = n, φ from the azimuth of v, both
//! v·m ∝ cos θ + r sin θ cos φ and l_z = 2 (cos θ + r sin θ cos φ)/(1 + r²) − cos θ fall with |φ|,
//! so that l stays above the surface on one arc |φ| < φ₁(r):
//!
//! ```text
//! E = 2/area ∫dr r P22(r) ∫₀^φ₁ dφ (cos θ + r sin θ cos φ) F(v·m) S(l).
//! ```
//!
//! The outer integral is that over r, so that the corners of a measured D divide it once for all φ.

use microfacet_core::Masking;

use super::Marginal;
use crate::converge::{Albedo, Both, CUT, RULES, add, add_place, converge};
use crate::error::{ParameterError, check_cosine};
use crate::panels::{End, Gauss};
use crate::smith_table::SmithTable;

/// Widest panel of the asinh of a unit slope; smooth distributions have their singularities at
/// ±iπ/2.
const PANEL: f64 = 1.0;
/// Widest panel of φ.
const SECTOR: f64 = 1.6;
/// G1 is taken as 1 where Λ is less than this.
const UNMASKED: f64 = 1e-11;

/// Integrates albedos of reflection for one isotropic distribution and any view and reflectance.
pub struct RadialAlbedo<'a> {
    marginal: &'a Marginal<'a>,
    smith: SmithTable,
    tolerance: f64,
    /// asinh of the unit slopes at which D has a corner, and where it ends; ascending.
    corners: Vec<f64>,
    /// Width of the peak in unit slopes; it may be far less than the median slope.
    peak: f64,
}

/// A view and what depends on it alone.
struct View {
    cos: f64,
    sin: f64,
    /// 1/area: G1(v)/cos θ.
    scale: f64,
}

impl<'a> RadialAlbedo<'a> {
    /// Tabulates G1 for `marginal`, which takes up to a tenth of a second. `tolerance` is the
    /// absolute error aimed at, clamped to [1e-9, 1e-2].
    ///
    /// The masking is that of [`Marginal`]: where D has corners its quadrature is good to about
    /// 1e-4 (45 rows) or 1e-6 (900 rows), and the albedo is no better. D must be bounded: for a
    /// power law that diverges towards the horizon (Student-t with γ < 2) use
    /// [`AlbedoIntegrator`](crate::AlbedoIntegrator).
    pub fn new(marginal: &'a Marginal<'a>, tolerance: f64) -> Self {
        let tolerance = tolerance.clamp(1e-9, 1e-2);
        let sigma = marginal.sigma();
        // ∫ r² P22 beyond R is 2 D/R where D is of the order of one.
        let end = marginal.reach().min(1.0 / (CUT * tolerance * sigma));
        let mut corners: Vec<f64> = marginal
            .corners()
            .into_iter()
            .map(|theta| libm::tan(theta) / sigma)
            .filter(|r| 0.0 < *r && *r < end)
            .map(libm::asinh)
            .collect();
        corners.push(libm::asinh(end));
        Self {
            smith: SmithTable::from_excess(|z| marginal.beyond(z).excess, UNMASKED),
            marginal,
            tolerance,
            corners,
            peak: marginal.half_slope(),
        }
    }

    /// Albedo of reflection for a view at cos θ ∈ [0, 1]; `weight` gives the reflectances at
    /// v·m ∈ [0, 1], in which they must be smooth.
    ///
    /// cos θ = 0 is the limit of grazing views.
    ///
    /// # Errors
    /// [`ParameterError::CosTheta`] unless cos θ ∈ [0, 1].
    pub fn reflection<const N: usize>(
        &self,
        cos_theta: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        check_cosine(cos_theta)?;
        let (cos, sin) = (cos_theta, ((1.0 - cos_theta) * (1.0 + cos_theta)).sqrt());
        let rho = self.marginal.sigma() * sin;
        let view = View { cos, sin, scale: 1.0 / self.smith.area(cos, rho * rho) };
        let quadrature = |rule: &Gauss| self.quadrature(rule, &view, &weight);
        Ok(converge(&RULES[..], self.tolerance, 2.0, quadrature))
    }

    /// The integrals for both forms of masking at one order of quadrature.
    fn quadrature<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        weight: &impl Fn(f64) -> [f64; N],
    ) -> Both<N> {
        let mut sum = [[0.0; N]; 2];
        rule.between(&self.stops(view), PANEL, |w, jacobian| {
            let r = libm::sinh(w);
            let density = self.marginal.p22(r);
            if density == 0.0 {
                return;
            }
            let mass = 2.0 * view.scale * jacobian * libm::cosh(w) * r * density;
            add(&mut sum, mass, &self.arc(rule, view, self.marginal.sigma() * r, weight));
        });
        sum
    }

    /// Where the integral over slopes is divided, in asinh of the unit slope.
    fn stops(&self, view: &View) -> Vec<End> {
        // Up to the slope `near` every φ reflects above the surface, from `far` on none does.
        let [near, far] = [view.cos / (1.0 + view.sin), (1.0 + view.sin) / view.cos]
            .map(|slope| libm::asinh(slope / self.marginal.sigma()));
        let rim = |at: f64| End { at, scale: near.clamp(1e-5, 0.05) };
        let last = self.corners[self.corners.len() - 1];
        let corners = self.corners.iter().copied().filter(|w| *w < far).map(End::plain);
        let mut stops: Vec<End> =
            [End { at: 0.0, scale: self.peak }].into_iter().chain(corners).collect();
        stops.extend([near, far].into_iter().filter(|w| *w < last).map(rim));
        stops.sort_by(|a, b| a.at.total_cmp(&b.at));
        stops
    }

    /// The integral over half of the arc of slopes of length r.
    fn arc<const N: usize>(
        &self,
        rule: &Gauss,
        view: &View,
        r: f64,
        weight: &impl Fn(f64) -> [f64; N],
    ) -> Both<N> {
        let mut sum = [[0.0; N]; 2];
        let sigma = self.marginal.sigma();
        let square = 1.0 + r * r;
        let g1_v = view.cos * view.scale;
        // For views along n the cosine of `end` is −∞ or ∞ before the clamp.
        let end = libm::acos((view.cos * (r - 1.0 / r) / (2.0 * view.sin)).clamp(-1.0, 1.0));
        let light = |phi: f64| {
            let facing = view.cos + r * view.sin * libm::cos(phi);
            (facing, 2.0 * facing / square - view.cos)
        };
        // Masking sets in where l_z falls to the area that a grazing l sees.
        let height = self.smith.area(0.0, sigma * sigma) + light(end).1.max(0.0);
        let fall = 2.0 * r * view.sin / square;
        let layer = height / (fall * libm::sin(end)).max((fall * height).sqrt());
        let rim = End { at: end, scale: layer.max(1e-6) };
        rule.graded(End::plain(0.0), rim, SECTOR, |phi, jacobian| {
            let (facing, l_z) = light(phi);
            let across = sigma * sigma * (1.0 - l_z) * (1.0 + l_z);
            let g1 = self.smith.g1(l_z, across.max(0.0));
            if g1 == 0.0 {
                return;
            }
            let fresnel = weight((facing / square.sqrt()).min(1.0));
            let mass = jacobian * facing;
            let shares = Masking::ALL.map(|masking| mass * masking.g2_over_g1(g1_v, g1));
            add_place(&mut sum, shares, fresnel);
        });
        sum
    }
}
