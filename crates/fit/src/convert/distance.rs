//! Distances of two distributions besides the error of D: between their slopes, and between the
//! reflections of one light.

use std::f64::consts::PI;

use microfacet_core::Masking;
use microfacet_model::MicrofacetDistribution;
use microfacet_model::classic::{Isotropic, Radial};
use microfacet_model::glam::DVec3;

/// The slopes, in median slopes, of the grid on which distances are taken: below and above lie 1e-8
/// and 1e-8 of GGX, and at most 1e-4 of the tail of any γ.
const REACH: f64 = 1e4;
/// Steps of the grid, equal ones of the logarithm of the slope.
const STEPS: i32 = 480;
/// Every so many of its angles are those of halfway vectors whose reflection is compared.
const STRIDE: usize = 4;

/// Angle of the light, from the normal in degrees, under which reflections are compared.
pub const LIGHT_DEGREES: f64 = 45.0;
/// The largest angle of the views, likewise.
pub const VIEW_DEGREES: f64 = 80.0;

/// A distribution on a grid of slopes about its median.
pub(super) struct Slopes {
    /// Polar angle of each slope, and the factor of D that gives its share of the projected area.
    nodes: Vec<(f64, f64)>,
    shares: Vec<f64>,
    /// D G2/(4 v·n l·n) at each of the views.
    reflected: Vec<f64>,
}

impl Slopes {
    /// How often D is evaluated for a variation.
    pub(super) const NODES: usize = STEPS as usize + 1;

    pub(super) fn new(from: &dyn Isotropic) -> Self {
        let median = from.sample_theta(0.5).tan();
        let step = 2.0 * REACH.ln() / f64::from(STEPS);
        let node = |i: i32| {
            let slope = median * (f64::from(i) * step).exp() / REACH;
            // cos θ sin θ, which is also dθ/d ln tan θ.
            let sin_cos = 1.0 / (slope + 1.0 / slope);
            (slope.atan(), 2.0 * PI * sin_cos * sin_cos * step)
        };
        let mut this = Self {
            nodes: (0..=STEPS).map(node).collect(),
            shares: Vec::new(),
            reflected: Vec::new(),
        };
        this.shares = this.shares(from).collect();
        this.reflected = this.reflected(from);
        this
    }

    /// Shares of the projected area at the slopes of the grid.
    fn shares<'a>(&'a self, of: &'a dyn Isotropic) -> impl Iterator<Item = f64> + 'a {
        self.nodes.iter().map(|&(theta, weight)| weight * of.d(theta))
    }

    /// Half of ∫ |difference| of the densities of slopes, in [0, 1]: the share of the projected
    /// area whose normals must move to make one of the other. To about 1e-3 of it; what lies beyond
    /// the grid counts as if it were in one place.
    pub(super) fn variation(&self, to: &dyn Isotropic) -> f64 {
        let (mut apart, mut beyond) = (0.0, 0.0);
        for (own, other) in self.shares.iter().zip(self.shares(to)) {
            apart += (own - other).abs();
            beyond += own - other;
        }
        0.5 * (apart + f64::abs(beyond))
    }

    /// The largest difference of D G2/(4 v·n l·n), over the largest value of the distribution to be
    /// replaced. The light is [`LIGHT_DEGREES`] from the normal, views are in the plane of
    /// incidence, at most [`VIEW_DEGREES`] from it and closer where D is narrow, and masking and
    /// shadowing are height-correlated.
    pub(super) fn reflection(&self, to: &dyn Isotropic) -> f64 {
        let other = self.reflected(to);
        let pairs = self.reflected.iter().zip(other);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart / self.reflected.iter().copied().fold(0.0, f64::max)
    }

    fn reflected(&self, of: &dyn Isotropic) -> Vec<f64> {
        let lobe = Radial::new(of);
        let light = LIGHT_DEGREES.to_radians();
        let g1 = |angle: f64| lobe.g1(DVec3::new(angle.sin(), 0.0, angle.cos()));
        let of_light = g1(light);
        let tilts = self.nodes.iter().step_by(STRIDE).flat_map(|&(theta, _)| [-theta, theta]);
        // The halfway vector of a light at -45° and a view stands at the mean of their angles.
        let views = [0.0].into_iter().chain(tilts).map(|tilt| (tilt, 2.0 * tilt + light));
        views
            .filter(|(_, view)| view.abs() <= VIEW_DEGREES.to_radians())
            .map(|(tilt, view)| {
                let g2 = Masking::HeightCorrelated.g2(g1(view), of_light);
                of.d(tilt.abs()) * g2 / (4.0 * view.cos() * light.cos())
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use microfacet_baker::distribution::Named;

    use super::*;

    fn built(text: &str) -> Box<dyn Isotropic> {
        text.parse::<Named>().unwrap().build().unwrap()
    }

    #[test]
    fn the_total_variation_of_two_ggx_is_that_of_their_closed_forms() {
        // The densities of two GGX are equal where tan²θ = a b; the variation is the difference of
        // the shares within: b/(a+b) − a/(a+b).
        for (a, b) in [(0.1, 0.1001), (0.1, 0.2), (1e-3, 1.0), (1e-9, 2e-9), (30.0, 10.0)] {
            let [from, to] = [a, b].map(|c| built(&format!("ggx:{c}")));
            let want = f64::abs(a - b) / (a + b);
            let found = Slopes::new(&*from).variation(&*to);
            assert!((found - want).abs() < 2e-3 * want + 1e-8, "{a} {b}: {found}, not {want}");
        }
    }

    #[test]
    fn what_is_beyond_the_grid_counts() {
        let found = Slopes::new(&*built("ggx:1e-9")).variation(&*built("beckmann:10"));
        assert!((found - 1.0).abs() < 1e-6, "{found}");
    }

    #[test]
    fn reflections_are_those_of_the_vectors() {
        let (from, to) = (built("ggx:0.2"), built("ggx:0.3"));
        let found = Slopes::new(&*from).reflection(&*to);
        let lobes = [0.2, 0.3].map(|c| microfacet_model::StudentT::ggx(c).unwrap());
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            DVec3::new(sin, 0.0, cos)
        };
        let l = at(-LIGHT_DEGREES);
        let values: Vec<[f64; 2]> = (-800..=800)
            .map(|i| at(f64::from(i) * 0.1))
            .map(|v| {
                lobes.map(|lobe| {
                    let g2 = Masking::HeightCorrelated.g2(lobe.g1(v), lobe.g1(l));
                    lobe.d((v + l).normalize()) * g2 / (4.0 * v.z * l.z)
                })
            })
            .collect();
        let largest = values.iter().map(|pair| pair[0]).fold(0.0, f64::max);
        let apart = values.iter().map(|[a, b]| (a - b).abs()).fold(0.0, f64::max);
        assert!((found / (apart / largest) - 1.0).abs() < 1e-3, "{found}");
        assert!(Slopes::new(&*from).reflection(&*from) < 1e-12);
    }
}
