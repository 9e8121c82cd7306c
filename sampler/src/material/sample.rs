//! Sampling visible normals by two table lookups.
//!
//! The in-plane slope x and the slope across t are independent (see the model crate), so one lookup
//! inverts each CDF. A table holds the distance of the slope's half tangent from an end,
//! see [`half_tangent`](crate::axis::half_tangent); there the silhouette is linear in the view
//! coordinate, so no sampled normal faces away, however coarse the table.

use glam::Vec3;

use super::student_t::{Stretched, StudentT};
use crate::axis::MirroredRoot;
use crate::axis::half_tangent::Slope;
use crate::axis::hermite::{between_rows, hermite, locate};
use crate::math::{sqrt, unit};

/// Smallest cosine of a sampled normal: keeps D finite, which for γ < 2 it is not on the horizon.
pub(crate) const HORIZON: f32 = 1e-18;

impl StudentT {
    /// A visible normal, by the fast path where it serves and by the general path elsewhere.
    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        // Scalar arguments and results keep the common case in registers next to the call of the
        // general path.
        let [x, y, z] = self
            .sample_fast([v.x, v.y, v.z], u)
            .unwrap_or_else(|| self.sample_general(v.x, v.y, v.z, u));
        Vec3::new(x, y, z)
    }

    /// The general path: a visible normal for every material and view.
    #[inline(never)]
    pub(crate) fn sample_general(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> [f32; 3] {
        let v = Vec3::new(x, y, z);
        let view = self.stretch(v);
        let x = self.sample_along(&view, u[0]);
        let t = self.sample_across(u[1]);
        face(self.assemble(&view, x, t), Vec3::new(v.x, v.y, view.z)).to_array()
    }

    /// The in-plane slope: from the table, or of a peeled table from it or the heavy part.
    #[inline(always)]
    pub(crate) fn sample_along(&self, view: &Stretched, u: f32) -> Slope {
        if self.slices.peeled { self.sample_peeled(view, u) } else { self.sample_slope(view, u) }
    }

    /// The in-plane slope from the table at u ∈ [0, 1].
    #[inline(always)]
    pub(crate) fn sample_slope(&self, view: &Stretched, u: f32) -> Slope {
        let slices = &self.slices;
        let (row, between) = self.locate_row(view);
        let towards = u > 0.5;
        let t = MirroredRoot::coordinate(u);
        let (cell, w) = locate(t * slices.half_cells as f32, slices.half_cells);
        // A row holds both halves, cells + 1 nodes each.
        let stride = 2 * (slices.half_cells + 1);
        let start = row * stride + if towards { slices.half_cells + 1 } else { 0 } + cell;
        let nodes = &slices.slope[..];
        let (a, b) = between_rows(
            &nodes[start..start + 2],
            &nodes[start + stride..start + stride + 2],
            0,
            between,
        );
        Slope::from_end(hermite(a, b, w), if towards { 1.0 } else { -1.0 })
    }

    /// The row of the slope table at a view: a cell of the view axis, and the position inside it.
    #[inline(always)]
    pub(super) fn locate_row(&self, view: &Stretched) -> (usize, f32) {
        let slices = &self.slices;
        locate(slices.view.of_view(view.rho, view.z) * slices.rows as f32, slices.rows)
    }

    /// As [`sample_slope`](Self::sample_slope) with a peeled table, which lacks the heavy part of
    /// share ρ·M₀/area of the visible area.
    #[inline(always)]
    fn sample_peeled(&self, view: &Stretched, u: f32) -> Slope {
        let heavy = self.heavy_share(view);
        let u = unit(u);
        let rest = 1.0 - heavy;
        // Straight from above the heavy part has no share, and u = 1 still belongs to the table.
        if u <= rest {
            return self.sample_slope(view, u / rest);
        }
        // (1 + s x²)^(−k) = ξ, so 1/√(1 + s x²) = ξ^(1/2k) = ζ and (x : 1) = (√(1−ζ²) : √s ζ).
        let xi = ((1.0 - u) / heavy).clamp(0.0, 1.0);
        let log = libm::logf(xi) / self.two_gamma_minus_3;
        Slope { x: sqrt(-libm::expm1f(2.0 * log)), z: sqrt(self.s) * libm::expf(log) }
    }

    /// Share of `u[0]`, from 0 up, that
    /// [`sample_visible_normal`](crate::MicrofacetDistribution::sample_visible_normal) reads from
    /// the table; the rest draws from the closed-form heavy part.
    ///
    /// 1 where the whole distribution is tabulated.
    pub fn tabulated_share(&self, v: Vec3) -> f32 {
        if self.slices.peeled { 1.0 - self.heavy_share(&self.stretch(v)) } else { 1.0 }
    }

    /// Share of the visible area that the heavy part, the term x sin θ p(x) for x > 0, takes:
    /// M₀ρ/area with M₀ = κ/(G1/q at grazing).
    #[inline(always)]
    pub(crate) fn heavy_share(&self, view: &Stretched) -> f32 {
        (self.first_moment() * view.rho * self.inverse_area(view)).clamp(0.0, 1.0)
    }

    /// The slope across in units of √(1 + s x²).
    #[inline(always)]
    pub(crate) fn sample_across(&self, u: f32) -> Slope {
        let slices = &self.slices;
        let cells = slices.across.len() - 1;
        let t = MirroredRoot::coordinate(u);
        let (cell, w) = locate(t * cells as f32, cells);
        let pair = &slices.across[cell..cell + 2];
        Slope::from_end(hermite(pair[0], pair[1], w), if u > 0.5 { 1.0 } else { -1.0 })
    }

    /// The normal in the tangent frame of two slopes in unit space.
    #[inline(always)]
    pub(crate) fn assemble(&self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let m = self.unit_normal(view, x, t);
        above_horizon(Vec3::new(self.sigma_x * m.x, self.sigma_y * m.y, m.z))
    }

    /// The unnormalised normal in unit space: y = √(1 + s x²)·t, turned to the view's azimuth, all
    /// in homogeneous form.
    #[inline(always)]
    pub(crate) fn unit_normal(&self, view: &Stretched, x: Slope, t: Slope) -> Vec3 {
        let y = sqrt(x.z * x.z + self.s * x.x * x.x) * t.x;
        let (x, z) = (x.x * t.z, x.z * t.z);
        Vec3::new(x * view.x - y * view.y, x * view.y + y * view.x, z * view.frame)
    }
}

/// Turns a normal that rounding has put behind the silhouette back onto it.
///
/// The silhouette's slope has the rounding of the view coordinate, which is coarse where σ is far
/// below the view's tilt, and strong anisotropy lets the tilt across spoil the tilt along.
#[inline(always)]
pub(crate) fn face(m: Vec3, v: Vec3) -> Vec3 {
    let facing = v.dot(m);
    if !(facing < 0.0) {
        return m;
    }
    // A view taken at the horizon is shorter than 1.
    above_horizon(m - facing / v.dot(v) * v)
}

/// Normalises a normal and raises it to the smallest cosine where it is lower.
#[inline(always)]
pub(crate) fn above_horizon(m: Vec3) -> Vec3 {
    let m = m * (1.0 / sqrt(m.dot(m)));
    Vec3::new(m.x, m.y, m.z.max(HORIZON))
}
