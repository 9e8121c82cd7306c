//! Directional albedo of transmission through a rough dielectric, by deterministic quadrature over
//! slopes.
//!
//! As for reflection, polar coordinates r, φ of the unit slopes about m = n:
//!
//! ```text
//! T = 1/(cos θ + ρ e(z)) ∫dφ ∫ r dr P22(r) (cos θ − r b(φ)) (1 − F(v·m)) S(l)
//! ```
//!
//! with l the refracted direction. Entering the denser side (η > 1), every m that faces the view
//! sends l below the surface, and the domain is the half-plane of visible slopes. Leaving it
//! (η < 1), two sets of slopes are left out: those of total reflection, v·m < √(1−η²), beyond a
//! conic where 1 − F is singular like a square root; and those whose l would come out above the
//! surface, which with p the slope lie outside the circle |p + v_xy/cos θ| = η/cos θ on the side
//! towards the view. Along that circle l grazes. In unit slopes the circle is an ellipse, which a
//! ray still meets in two points at most.

use core::f64::consts::PI;

use crate::albedo::{AlbedoIntegrator, PANEL, ROOT, View};
use crate::converge::Albedo;
use crate::error::{ParameterError, check_cosine};
use crate::fresnel::Dielectric;
use crate::panels::{End, Gauss};

struct Pane<'a> {
    model: &'a AlbedoIntegrator,
    dielectric: Dielectric,
    /// `kink` is the v·m at which total reflection sets in; 0 if it does not.
    view: View,
}

/// A ray of unit slopes: its slope per unit slope, the square a of that, and b, such that r b is
/// the slope towards the view times sin θ.
struct Ray {
    slope: [f64; 2],
    a: f64,
    b: f64,
}

/// The refracted direction: its depth below the surface, and its horizontal length stretched by σ,
/// squared.
struct Refracted {
    mu: f64,
    depth: f64,
    across: f64,
}

impl AlbedoIntegrator {
    /// Albedo of transmission: the share of the light from a direction at cos θ ∈ [0, 1] that one
    /// refraction transmits through the rough interface, for roughness σ ≥ 0 along both axes.
    ///
    /// The density of l is that of Walter et al. 2007
    /// (<https://doi.org/10.2312/EGWR/EGSR07/195-206>), eq. 21, with radiance scaled to energy.
    /// Masking and shadowing are those of |l·n|; the height-correlated form is 1/(1 + Λ(v) + Λ(l)),
    /// as for reflection.
    ///
    /// Reflection and transmission add up to less than one: the rest is shadowed. σ = 0 is a smooth
    /// interface, cos θ = 0 the limit of grazing views.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 ≤ σ < ∞ and cos θ ∈ [0, 1].
    pub fn transmission(
        &self,
        sigma: f64,
        cos_theta: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<1>, ParameterError> {
        self.transmission_to(self.tolerance, sigma, cos_theta, dielectric)
    }

    /// [`transmission`](Self::transmission) to a tolerance no smaller than that of the integrator.
    pub(crate) fn transmission_to(
        &self,
        tolerance: f64,
        sigma: f64,
        cos_theta: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<1>, ParameterError> {
        check_cosine(cos_theta)?;
        if sigma == 0.0 {
            return Ok(Albedo::new([[1.0 - dielectric.reflectance(cos_theta)]; 2], 0.0));
        }
        self.transmitted(tolerance, self.view([sigma, sigma], cos_theta, 0.0)?, dielectric)
    }

    /// Albedo of transmission for roughness σx, σy > 0 and a view at cos θ ∈ [0, 1] and azimuth φ
    /// (radians from the x axis); otherwise as [`transmission`](Self::transmission).
    ///
    /// # Errors
    /// [`ParameterError`] unless both σ are positive and finite and cos θ ∈ [0, 1].
    pub fn transmission_anisotropic(
        &self,
        sigma: [f64; 2],
        cos_theta: f64,
        phi: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<1>, ParameterError> {
        self.transmitted(self.tolerance, self.view(sigma, cos_theta, phi)?, dielectric)
    }

    fn transmitted(
        &self,
        tolerance: f64,
        mut view: View,
        dielectric: Dielectric,
    ) -> Result<Albedo<1>, ParameterError> {
        view.kink = dielectric.kink();
        let pane = Pane { model: self, dielectric, view };
        let sectors = view.sectors(&pane.ends());
        Ok(self.refined(tolerance, view.kink > 0.0, |rule| {
            view.over_sectors(rule, &sectors, |phi| pane.ray(rule, phi).map(|x| [x]))
        }))
    }
}

impl Pane<'_> {
    /// The azimuths of slope at which rays change, as of [`View::sectors`].
    fn ends(&self) -> Vec<End> {
        let View { cos, sin, kink, aspect, .. } = self.view;
        let right = self.view.right();
        // Λ(l) has a branch point at l = −n, whose m leans straight away from the view or towards
        // it.
        let axis = |at: f64, sign: f64| {
            let here = self.branch().is_some_and(|r| r * sign > 0.0);
            End { at, scale: if here { 0.05 * aspect } else { f64::INFINITY } }
        };
        let (away, towards) = (axis(0.0, 1.0), axis(PI, -1.0));
        if kink == 0.0 {
            return vec![away, right, towards];
        }
        let conic = self.model.conic_ends(cos, sin, kink, right);
        // On one side of their common tangent rays cut the conic and the circle; on the other they
        // cut neither, and all light is reflected.
        let before = (cos >= kink).then_some(away);
        before.into_iter().chain(conic).chain([towards]).collect()
    }

    /// The unit slope of the m that refracts v to −n, positive where it leans away from the view;
    /// `None` without such an m, or if the branch point of Λ(l) is too weak to need panels of its
    /// own.
    fn branch(&self) -> Option<f64> {
        let (View { cos, sin, cos_phi, sin_phi, sigma: [x, y], .. }, eta) =
            (self.view, self.dielectric.eta());
        let strong = self.model.shape().gamma() < 3.5 || x.max(y) > 0.7;
        // m = ±(v − ηn), below the surface or turned away for the views in between.
        let there = eta * cos > 1.0 || eta < cos;
        let per_slope = libm::hypot(cos_phi / x, sin_phi / y);
        (strong && there && eta != 1.0).then(|| sin / (eta - cos) * per_slope)
    }

    /// The sine of the angle, in unit slopes, between a ray and the azimuth of the branch point.
    fn aside(&self, phi: f64) -> f64 {
        let View { cos_phi, sin_phi, sigma: [x, y], .. } = self.view;
        let (sin, cos) = libm::sincos(phi);
        let (c, s) = (cos_phi * y, sin_phi * x);
        libm::fabs(sin * c - cos * s) / libm::hypot(c, s)
    }

    fn ray(&self, rule: &Gauss, phi: f64) -> [f64; 2] {
        let (View { cos, sin, cos_phi, sin_phi, aspect, .. }, eta) =
            (self.view, self.dielectric.eta());
        let (s_phi, c_phi) = libm::sincos(phi);
        let slope = [self.view.sigma[0] * c_phi, self.view.sigma[1] * s_phi];
        let a = slope[0] * slope[0] + slope[1] * slope[1];
        let b = sin * (slope[0] * cos_phi + slope[1] * sin_phi);
        let ray = Ray { slope, a, b };
        let s = self.model.shape().s();
        // The slope from which on m faces away from the view; ∞ if there is none.
        let rim = if b > 0.0 { self.model.shape().asinh_slope(cos / b) } else { f64::INFINITY };
        let scale = if rim < self.model.cut && eta > 1.0 {
            // cos θ_t bends where v·m is of the order of √(η²−1).
            let across = ((eta - 1.0) * (eta + 1.0)).sqrt();
            let r = cos / b;
            0.5 * across * (1.0 + a * r * r).sqrt() / (b * (1.0 + s * r * r).sqrt())
        } else {
            f64::INFINITY
        };
        let end = End { at: rim.min(self.model.cut), scale };
        let mut stops = self.stops(&ray, s, end.at);
        let mut from = End::plain(0.0);
        if let Some(normal) = self.branch() {
            let r = libm::fabs(normal);
            let aside = aspect * r * self.aside(phi) / (1.0 + s * r * r).sqrt();
            let at = self.model.shape().asinh_slope(r);
            if b * normal > 0.0 && aside < 0.5 && at < end.at {
                stops.push(End { at, scale: aside.max(0.01 * aspect) });
                stops.sort_by(|x, y| x.at.total_cmp(&y.at));
            } else if b * normal <= 0.0 && aspect * at < 0.5 {
                from.scale = (aspect * at).max(0.01 * aspect);
            }
        }
        let mut sum = [0.0; 2];
        for stop in stops.into_iter().chain([end]) {
            // Whether light passes changes only at the stops: one point decides for the interval.
            let middle = self.model.slopes.at(0.5 * (from.at + stop.at)).0;
            if self.shares(&ray, middle).is_some() {
                rule.graded(from, stop, PANEL, |w, jacobian| {
                    let (r, measure) = self.model.slopes.at(w);
                    if let Some([uncorrelated, correlated]) = self.shares(&ray, r) {
                        sum[0] += jacobian * measure * uncorrelated;
                        sum[1] += jacobian * measure * correlated;
                    }
                });
            }
            from = stop;
        }
        if b < 0.0
            && let Some(tail) = self.model.tail()
        {
            // Facets beyond the cut are vertical, and refract alike: light keeps its z but for the
            // factor 1/η.
            let r = self.model.slopes.at(self.model.cut).0;
            for (sum, last) in sum.iter_mut().zip(self.shares(&ray, r).unwrap_or_default()) {
                *sum -= b * tail * last / (cos - r * b);
            }
        }
        sum
    }

    /// (cos θ − r b) (1 − F) S at the unit slope r of a ray; `None` where nothing is refracted
    /// downwards.
    fn shares(&self, ray: &Ray, r: f64) -> Option<[f64; 2]> {
        let Refracted { mu, depth, across } = self.refracted(ray, r)?;
        if depth <= 0.0 {
            return None;
        }
        let shares = self.model.smith.shares(self.view.g1, depth, across);
        let mass = (self.view.cos - r * ray.b) * (1.0 - self.dielectric.reflectance(mu));
        Some(shares.map(|share| mass * share))
    }

    /// `None` where m faces away, or reflects all light.
    fn refracted(&self, ray: &Ray, r: f64) -> Option<Refracted> {
        let (View { cos, sin, cos_phi, sin_phi, sigma, .. }, eta) =
            (self.view, self.dielectric.eta());
        let facing = cos - r * ray.b;
        if facing <= 0.0 {
            return None;
        }
        let length = (1.0 + ray.a * r * r).sqrt();
        let mu = (facing / length).min(1.0);
        let inside = self.dielectric.refracted_cos(mu)?;
        // l = −k m − v/η with k = cos θ_t − μ/η, formed without its cancellation.
        let k = (1.0 - 1.0 / eta) * (1.0 + 1.0 / eta) / (inside + mu / eta);
        let (reach, ahead) = (k * r / length, sin / eta);
        let x = sigma[0] * (reach * ray.slope[0] - ahead * cos_phi);
        let y = sigma[1] * (reach * ray.slope[1] - ahead * sin_phi);
        Some(Refracted { mu, depth: k / length + cos / eta, across: x * x + y * y })
    }

    /// Where a ray enters or leaves the domain, in w, ascending.
    fn stops(&self, ray: &Ray, s: f64, last: f64) -> Vec<End> {
        let (View { cos, sin, kink, .. }, eta) = (self.view, self.dielectric.eta());
        if kink == 0.0 {
            return Vec::new();
        }
        let &Ray { a, b, .. } = ray;
        let mut stops = self.model.conic(cos, kink, a, b, last, ROOT);
        let outside = (sin - eta) * (sin + eta);
        let root = b * b - a * outside;
        if b < 0.0 && outside > 0.0 && root >= 0.0 && cos > 0.0 {
            // The nearer of the ray's intersections with the circle; there l grazes, and masking
            // sets in within the roughness along l of it.
            let r = outside / (cos * (root.sqrt() - b));
            let w = self.model.shape().asinh_slope(r);
            let depth = |r: f64| {
                let length = (1.0 + a * r * r).sqrt();
                let mu = (cos - r * b) / length;
                let square = (mu - kink) * (mu + kink);
                (square.max(0.0).sqrt() - mu) / length + cos
            };
            let h = 1e-4;
            let slope = libm::fabs(depth(r * (1.0 + h)) - depth(r)) / (r * h * eta);
            let [x, y] = self.view.sigma;
            let roughness = self.refracted(ray, r).map_or(x.min(y), |light| light.across.sqrt());
            let layer = roughness / (slope * (1.0 + s * r * r).sqrt());
            if w > 0.0 && w < last {
                stops.push(End { at: w, scale: layer.clamp(1e-4, 1.0) });
                stops.sort_by(|x, y| x.at.total_cmp(&y.at));
            }
        }
        stops
    }
}
