//! Visible normals that can reflect a view upwards, so that fewer samples are lost below the
//! horizon.
//!
//! In slopes about the macro normal, the light l = reflect(v, m) is above the horizon just where
//! the slope lies in the disc of radius 1/cos θ about tan θ towards the viewer. The in-plane slopes
//! of the disc are an interval of u₁, since the inverse CDF ascends; sampling that interval changes
//! the density by a factor only. Eto & Tokuyoshi 2023 do so for GGX by shrinking its cap; the
//! interval does it for every γ. The variance of a white furnace falls to between a third and nine
//! tenths (`cargo run -p microfacet-sampler --example bounded`).

use glam::Vec3;

use super::distribution::MicrofacetDistribution;
use super::student_t::{NORMAL_INCIDENCE, StudentT};
use crate::math::{sqrt, unit};

/// The visible normals of a lobe and a view, without most of those that reflect the view below the
/// horizon.
///
/// Every normal that reflects upwards keeps its place; some of the others remain, as the slope
/// across the plane of incidence is not restricted. Estimators of reflection that weight with G2/G1
/// times [`share`](Self::share), or divide by a density of this type, are unbiased, and of lower
/// variance than those of [`MicrofacetDistribution::sample_visible_normal`]. After Eto & Tokuyoshi
/// 2023, *Bounded VNDF Sampling for Smith-GGX Reflections*,
/// <https://doi.org/10.1145/3610543.3626163>.
#[derive(Clone, Copy, Debug)]
pub struct Bounded<'a> {
    material: &'a StudentT,
    v: Vec3,
    from: f32,
    share: f32,
}

impl StudentT {
    /// Prepares the visible normals of `v` for reflection.
    ///
    /// The interval of u₁ that it draws from holds every normal that reflects upwards, but is not
    /// the shortest to do so: a limit on either side takes a fraction of the time of the exact
    /// number. For γ < 1.8 (in the default set) only the end away from the viewer is restricted.
    pub fn bounded(&self, v: Vec3) -> Bounded<'_> {
        let [from, to] = self.upward(v);
        Bounded { material: self, v, from, share: to - from }
    }

    /// An interval of u₁ that holds all at which a light can be above the horizon.
    fn upward(&self, v: Vec3) -> [f32; 2] {
        let view = self.stretch(v);
        let rows = self.rows_at(&view);
        let (sin, cos) = (sqrt(v.x * v.x + v.y * v.y), view.z);
        // A unit of slope along the view's azimuth, in unit slopes along the stretched azimuth.
        let unit = if view.rho >= NORMAL_INCIDENCE { sin / view.rho } else { 1.0 / self.sigma_x };
        let number = |x: f32, z: f32, above| {
            self.limit_along(&rows, f64::from(unit * x), f64::from(z), above) as f32
        };
        // tan θ ∓ 1/cos θ, the nearer end without its cancellation. The interval is widened so that
        // rounding loses no direction.
        let low = (number(-cos, 1.0 + sin, false) * (1.0 - SLACK) - SLACK * SLACK).max(0.0);
        if self.slices.peeled {
            // Only the tabulated part has slopes away from the viewer, and it comes first.
            return [low * self.tabulated_share(v), 1.0];
        }
        let high = number(1.0 + sin, cos, true);
        [low, (high + (1.0 - high) * SLACK + SLACK * SLACK).min(1.0)]
    }
}

/// Relative widening of either end of the interval.
const SLACK: f32 = 1e-5;

impl Bounded<'_> {
    /// A normal from two random numbers, which are clamped to [0, 1].
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        let along = (self.from + unit(u[0]) * self.share).min(1.0);
        self.material.sample_visible_normal(self.v, [along, u[1]])
    }

    /// Probability that an unbounded sample would be one of these, in (0, 1]: the factor on a
    /// sample's weight.
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Density per steradian with which [`sample`](Self::sample) draws `m`, for an `m` that
    /// reflects the view above the horizon: the analytic one, with G1 from the table.
    ///
    /// The density of reflected directions is this over 4 v·m.
    #[inline]
    pub fn visible_normal_pdf(&self, m: Vec3) -> f32 {
        self.material.visible_normal_pdf(self.v, m) / self.share
    }

    /// The density of the table's samples for such an `m`, see
    /// [`MicrofacetDistribution::table_pdf`].
    pub fn table_pdf(&self, m: Vec3) -> f32 {
        self.material.table_pdf(self.v, m) / self.share
    }
}
