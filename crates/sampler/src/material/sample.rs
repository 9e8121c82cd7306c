//! Sampling visible normals by two table lookups.
//!
//! The in-plane slope x and the slope across t are independent (see the model crate), so one lookup
//! inverts each CDF. A table holds the distance of the slope's half tangent from an end,
//! see [`half_tangent`](microfacet_tables::axis::half_tangent); there the silhouette is linear in the view
//! coordinate, so no sampled normal faces away, however coarse the table.

use glam::Vec3;
use wide::f32x4;

use microfacet_core::math::{sqrt, unit};
use microfacet_tables::axis::MirroredRoot;
use microfacet_tables::axis::half_tangent::Slope;
use microfacet_tables::axis::hermite::{between_rows, hermite, locate};

use super::student_t::{Stretched, StudentT};

/// Smallest cosine of a sampled normal: keeps D finite, which for γ < 2 it is not on the horizon.
pub(crate) const HORIZON: f32 = 1e-18;

impl StudentT {
    /// A visible normal, by the fast path where it serves and by the general path elsewhere.
    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        // Scalar arguments keep the common case in registers next to the calls of the others.
        if !self.slices.fast.plain {
            return self.sample_heavy(v.x, v.y, v.z, u);
        }
        let m = self.sample_fast::<false>(v, u);
        m.map_or_else(|| self.sample_general(v.x, v.y, v.z, u), first_three)
    }

    /// The same, of any length where that is faster; squares of it are in range.
    #[inline(always)]
    pub(crate) fn sample_along(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        if !self.slices.fast.plain {
            return self.sample_heavy(v.x, v.y, v.z, u);
        }
        let m = self.draw_along::<false>(&self.view::<false>(v), u, [self.sigma_x, self.sigma_y]);
        m.map_or_else(|| self.sample_general(v.x, v.y, v.z, u), |(m, _)| first_three(m))
    }

    /// The same for a lobe with a heavy part, out of line so that calls of the others stay short.
    #[inline(never)]
    fn sample_heavy(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> Vec3 {
        let m = self.sample_fast::<true>(Vec3::new(x, y, z), u);
        m.map_or_else(|| self.sample_general(x, y, z, u), first_three)
    }

    /// Share of `u[0]`, from 0 up, that
    /// [`sample_visible_normal`](crate::MicrofacetDistribution::sample_visible_normal) reads from
    /// the table; the rest draws from the closed-form heavy part.
    ///
    /// 1 where the whole distribution is tabulated.
    pub fn tabulated_share(&self, v: Vec3) -> f32 {
        if !self.slices.peeled {
            return 1.0;
        }
        // To the bit as the sampler has it: the next number belongs to the other part.
        let at = self.view::<true>(v).at.to_array()[0];
        unit(1.0 - self.slices.heavy.share(at))
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
        locate(slices.row(view.rho, view.z), slices.rows)
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

/// The vector of the first three lanes.
#[inline(always)]
pub(crate) fn first_three(m: f32x4) -> Vec3 {
    let [x, y, z, _] = m.to_array();
    Vec3::new(x, y, z)
}

/// Turns a normal that rounding has put behind the silhouette back onto it.
///
/// The silhouette's slope has the rounding of the view coordinate, which is coarse where σ is far
/// below the view's tilt, and strong anisotropy lets the tilt across spoil the tilt along.
#[inline(always)]
pub(crate) fn face(m: Vec3, v: Vec3) -> Vec3 {
    let facing = v.dot(m);
    if facing < 0.0 && facing.is_finite() {
        let (a, b) = turned_back(m, v, facing);
        raised(a * m + b * v)
    } else {
        m
    }
}

/// Parts of a normal and of a view whose sum is the normal on the silhouette.
///
/// Out of line: in a caller's loop the compiler would else work it out for every normal. Two
/// numbers, since a vector of three is returned in integer registers, and both ways would meet
/// there.
#[cold]
#[inline(never)]
fn turned_back(m: Vec3, v: Vec3, facing: f32) -> (f32, f32) {
    // A view taken at the horizon is shorter than 1, and may be almost nothing; of one whose length
    // is out of range nothing is taken.
    let length2 = v.dot(v).max(f32::MIN_POSITIVE);
    let part = if length2 <= f32::MAX { facing / length2 } else { return (1.0, 0.0) };
    let turned = m - part * v;
    let inverse = 1.0 / sqrt(turned.dot(turned));
    (inverse, -part * inverse)
}

/// Normalises a normal and raises it to the smallest cosine where it is lower.
#[inline(always)]
pub(crate) fn above_horizon(m: Vec3) -> Vec3 {
    raised(m * (1.0 / sqrt(m.dot(m))))
}

/// With the smallest cosine where it is lower.
#[inline(always)]
fn raised(m: Vec3) -> Vec3 {
    Vec3::new(m.x, m.y, m.z.max(HORIZON))
}
