//! The density of the normals that the table sampler draws.
//!
//! An estimator that divides by it is unbiased at any resolution: it is the Jacobian of the
//! sampler's own map, found by inverting the interpolated CDFs, and not the analytic density that
//! they approximate. It is computed in f64 from the same nodes that the sampler reads.

use alloc::vec::Vec;

use glam::Vec3;
use wide::f32x4;

use microfacet_core::math::{sqrt64, unit};
use microfacet_tables::axis::half_tangent::{ends_and_rate, slope_at};

use super::distribution::MicrofacetDistribution;
use super::student_t::{Stretched, StudentT};
use crate::elementary::{exp2, log2};

/// A normal's slopes in unit space: in-plane x : z, and across y : z, with t = y/√(z² + s x²).
struct UnitSlopes {
    x: f64,
    z: f64,
    y: f64,
}

impl StudentT {
    /// Costs two searches and a few square roots; see
    /// [`MicrofacetDistribution::table_pdf`](crate::MicrofacetDistribution::table_pdf). For a normal
    /// that is not [hidden](super::distribution::is_hidden): this does not ask, since rounding may
    /// put the slope of a drawn one behind the silhouette.
    pub(crate) fn density_of_samples(&self, v: Vec3, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let view = self.stretch(v);
        let at = self.coordinate(&view);
        let Some(rows) = self.rows_at(at) else { return 0.0 };
        let slopes = self.unit_slopes(&view, m);
        let UnitSlopes { x, z, y } = slopes;
        let ([low, high], rate) = ends_and_rate(x, z);
        let (half, cell) = self.cell_along(&rows, [low, high]);
        let place = cell.place();
        let mut along = place.density() * rate;
        let mut heavy = 0.0;
        if self.slices.peeled {
            heavy = f64::from(unit(self.slices.heavy.share(at)));
            along = (1.0 - heavy) * along + heavy * self.heavy_density(&slopes);
        }
        let s = f64::from(self.s);
        let norm = sqrt64(z * z + s * x * x);
        let ([_, g], rate) = ends_and_rate(y.abs(), norm);
        let place_across = self.cell_across(g).place();
        let across = place_across.density() * rate;
        // p(x, y) = p(x) p(t)/√(1 + s x²); `along` is per unit of x/z. Slopes in the tangent frame
        // scale by σ, and dm = cos³θ per slope area.
        let cos = f64::from(m.z);
        let area = norm * f64::from(self.sigma_x) * f64::from(self.sigma_y) * (cos * cos * cos);
        let density = along * across * z / area;
        let density = if density > 0.0 { density.min(f64::from(f32::MAX)) as f32 } else { 0.0 };
        // Beyond the end of a peeled table the heavy part goes on.
        let is_end = place.is_end && (half == 0 || heavy == 0.0);
        if is_end || place_across.is_end || density == 0.0 {
            // Towards the horizon the analytic density may grow without limit, and a quotient of
            // both would; and rounding of a normal that is tilted mostly across may lose its slope
            // along the view.
            return density.max(self.visible_normal_pdf(v, m));
        }
        density
    }

    /// Where the tabulated density ([`table_pdf`](MicrofacetDistribution::table_pdf)) has its joints
    /// for a view: unit slopes x in the plane of incidence, ascending, and t ≥ 0 across it.
    ///
    /// Between them the density of the samples is smooth, so a quadrature that respects them
    /// converges fast. x may end at ±∞.
    pub fn table_joints(&self, v: Vec3) -> [Vec<f64>; 2] {
        let view = self.stretch(v);
        let Some(rows) = self.rows_at(self.coordinate(&view)) else { return Default::default() };
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

    /// Up to a common factor, without a division.
    fn unit_slopes(&self, view: &Stretched, m: Vec3) -> UnitSlopes {
        let [vx, vy, mx, my] = [view.x, view.y, m.x, m.y].map(f64::from);
        let (sx, sy) = (f64::from(self.sigma_x), f64::from(self.sigma_y));
        let (a, b) = (mx * sy, my * sx);
        let frame = sqrt64(vx * vx + vy * vy);
        UnitSlopes { x: a * vx + b * vy, z: f64::from(m.z) * sx * sy * frame, y: b * vx - a * vy }
    }

    /// Density of the heavy part at x/z: 2k s x (1 + s x²)^(−k−1) for x > 0.
    fn heavy_density(&self, at: &UnitSlopes) -> f64 {
        let (s, two_gamma_minus_3) = (f64::from(self.s), 2.0 * self.gamma - 3.0);
        let x = (at.x / at.z).max(0.0);
        let base = 1.0 + s * x * x;
        // The root stays in the range of f32 where the base does not.
        let log = log2(f32x4::splat(sqrt64(base) as f32));
        let power = exp2(log * (-two_gamma_minus_3 as f32)).to_array()[0];
        two_gamma_minus_3 * s * x / base * f64::from(power)
    }
}
