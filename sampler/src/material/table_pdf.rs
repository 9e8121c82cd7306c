//! The density of the normals that the table sampler draws.
//!
//! An estimator that divides by it is unbiased at any resolution: it is the Jacobian of the
//! sampler's own map, found by inverting the interpolated CDFs, and not the analytic density that
//! they approximate. It is computed in f64 from the same nodes that the sampler reads.

use alloc::vec::Vec;

use glam::Vec3;

use super::student_t::{Stretched, StudentT};
use crate::axis::half_tangent::{ends, rate, slope_at};
use crate::math::sqrt64;

/// A normal's slopes in unit space: in-plane x : z, and across y : z, with t = y/√(z² + s x²).
struct UnitSlopes {
    x: f64,
    z: f64,
    y: f64,
}

impl StudentT {
    /// Costs two searches and a few square roots; see
    /// [`MicrofacetDistribution::table_pdf`](crate::MicrofacetDistribution::table_pdf).
    pub(crate) fn density_of_samples(&self, v: Vec3, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let view = self.stretch(v);
        let slopes = self.unit_slopes(&view, m);
        let along = if self.slices.peeled {
            let heavy = f64::from(self.heavy_share(&view));
            (1.0 - heavy) * self.slope_density(&view, &slopes) + heavy * self.heavy_density(&slopes)
        } else {
            self.slope_density(&view, &slopes)
        };
        let UnitSlopes { x, z, y } = slopes;
        let s = f64::from(self.s);
        let norm = sqrt64(z * z + s * x * x);
        let across = self.across_density(y / norm);
        // p(x, y) = p(x) p(t)/√(1 + s x²); `along` is per unit of x/z. Slopes in the tangent frame
        // scale by σ, and dm = cos³θ per slope area.
        let per_slope = along * across * z / norm / f64::from(self.sigma_x * self.sigma_y);
        let density = per_slope / (z * z * z);
        if density.is_finite() { (density as f32).min(f32::MAX) } else { 0.0 }
    }

    /// See [`internals::table_joints`](crate::internals::table_joints).
    pub(crate) fn table_joints(&self, v: Vec3) -> [Vec<f64>; 2] {
        let view = self.stretch(v);
        let rows = self.rows_at(&view);
        let half = self.slices.half_cells + 1;
        let slope = |g: f64, sign: f64| {
            let [x, z] = slope_at(g);
            sign * x / z
        };
        let away = (0..half).map(|i| slope(f64::from(rows.node(i)[0]), -1.0));
        let towards = (0..half).rev().map(|i| slope(f64::from(rows.node(half + i)[0]), 1.0));
        let across = self.slices.across.iter().rev().map(|node| slope(f64::from(node[0]), 1.0));
        [away.chain(towards).collect(), across.collect()]
    }

    fn unit_slopes(&self, view: &Stretched, m: Vec3) -> UnitSlopes {
        let (a, b) =
            (f64::from(m.x) / f64::from(self.sigma_x), f64::from(m.y) / f64::from(self.sigma_y));
        let r = 1.0
            / sqrt64(f64::from(view.x) * f64::from(view.x) + f64::from(view.y) * f64::from(view.y));
        let (cos, sin) = (f64::from(view.x) * r, f64::from(view.y) * r);
        UnitSlopes { x: a * cos + b * sin, z: f64::from(m.z), y: b * cos - a * sin }
    }

    /// Density of the tabulated in-plane slope at x/z.
    fn slope_density(&self, view: &Stretched, at: &UnitSlopes) -> f64 {
        let cell = self.cell_along(&self.rows_at(view), at.x, at.z).1;
        cell.map_or(0.0, |cell| cell.place().density()) * rate(at.x, at.z)
    }

    /// Density of the heavy part at x/z: 2k s x (1 + s x²)^(−k−1) for x > 0.
    fn heavy_density(&self, at: &UnitSlopes) -> f64 {
        if at.x <= 0.0 {
            return 0.0;
        }
        let (s, two_gamma_minus_3) = (f64::from(self.s), 2.0 * self.gamma - 3.0);
        let x = at.x / at.z;
        let base = 1.0 + s * x * x;
        two_gamma_minus_3 * s * x / base * libm::exp(-0.5 * two_gamma_minus_3 * libm::log(base))
    }

    /// Density of the tabulated slope across at t.
    fn across_density(&self, t: f64) -> f64 {
        let [_, g] = ends(t.abs(), 1.0);
        self.cell_across(g).map_or(0.0, |cell| cell.place().density()) * rate(t, 1.0)
    }
}
