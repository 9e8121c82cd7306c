//! The functions over slices, four directions at a time.
//!
//! Every lane does what the function for one direction does, in the same order, so the results are
//! the same, to the last bits of the normalisation. A batch saves by sharing: one root, division or
//! polynomial serves four normals (18 ns become 8), and several groups of four go through each
//! stage together, so that the processor has independent work during each wait (8 become 6). Only
//! the table reads are made one by one.

use glam::Vec3;
use wide::{bytemuck, f32x4, i32x4};

use super::distribution::MicrofacetDistribution;
use super::fast_path::{SILHOUETTE_MARGIN, SILHOUETTE_MARGIN_ACROSS, pair, start};
use super::slices::FastPath;
use super::student_t::{SHORT, StudentT};
use crate::axis::half_tangent::{half_slope_at, of_views};
use crate::axis::hermite::{Cell, cubic_lanes, hermite_lanes, horner_lanes, split};
use crate::axis::roots;
use crate::error::BatchError;

const LANES: usize = 4;
/// How many groups of four go through each stage together.
const GROUPS: usize = 8;

impl StudentT {
    /// As many normals as there are views; the slices are of the same length.
    pub(crate) fn sample_all(&self, v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]) {
        let Some(fast) = &self.slices.fast else {
            return self.sample_each(v, u, m);
        };
        let ((v, v_rest), (u, u_rest)) = (v.as_chunks(), u.as_chunks());
        let (m, m_rest) = m.as_chunks_mut();
        for ((v, u), m) in v.chunks(GROUPS).zip(u.chunks(GROUPS)).zip(m.chunks_mut(GROUPS)) {
            self.sample_groups(fast, v, u, m);
        }
        self.sample_each(v_rest, u_rest, m_rest);
    }

    fn sample_each(&self, v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]) {
        for ((v, u), m) in v.iter().zip(u).zip(m) {
            *m = self.sample(*v, *u);
        }
    }

    /// G1 of each view; the slices are of the same length.
    pub(crate) fn g1_all(&self, v: &[Vec3], g1: &mut [f32]) {
        let (v, v_rest) = v.as_chunks::<LANES>();
        let (g1, g1_rest) = g1.as_chunks_mut::<LANES>();
        for (v, g1) in v.iter().zip(g1) {
            *g1 = self.g1_lanes(v);
        }
        for (v, g1) in v_rest.iter().zip(g1_rest) {
            *g1 = self.g1(*v);
        }
    }

    /// At most [`GROUPS`] groups of four, stage by stage.
    fn sample_groups(
        &self,
        fast: &FastPath,
        v: &[[Vec3; LANES]],
        u: &[[[f32; 2]; LANES]],
        m: &mut [[Vec3; LANES]],
    ) {
        let mut located = [Located::default(); GROUPS];
        for ((at, v), u) in located.iter_mut().zip(v).zip(u) {
            *at = self.locate(fast, v, u);
        }
        let mut slopes = [[f32x4::ZERO; 2]; GROUPS];
        for (slope, at) in slopes.iter_mut().zip(&located[..v.len()]) {
            *slope = self.look_up(fast, at);
        }
        for (i, m) in m.iter_mut().enumerate() {
            let common = self.assemble_lanes(&located[i], slopes[i], m);
            if !common {
                self.sample_each(&v[i], &u[i], m);
            }
        }
    }

    #[inline(always)]
    fn locate(&self, fast: &FastPath, v: &[Vec3; LANES], u: &[[f32; 2]; LANES]) -> Located {
        let [vx, vy, vz] = transpose(v);
        let (x, y) = (vx * self.sigma_x, vy * self.sigma_y);
        let z = vz & vz.simd_gt(0.0);
        let rho2 = x * x + y * y;
        let (rho, length) = (rho2.sqrt(), (rho2 + z * z).sqrt());
        let at = of_views(rho, z, length, fast.rows);
        let (row, between) = split(at);
        let silhouette = 1.0 - at * fast.inverse_rows;
        let along = Number::new([u[0][0], u[1][0], u[2][0], u[3][0]], fast.scales[0]);
        let across = Number::new([u[0][1], u[1][1], u[2][1], u[3][1]], fast.scales[1]);
        Located { x, y, rho, silhouette, row, between, along, across }
    }

    /// The distances of the half tangents from their ends, for the in-plane slope and the slope
    /// across.
    #[inline(always)]
    fn look_up(&self, fast: &FastPath, at: &Located) -> [f32x4; 2] {
        let stride = 2 * fast.half;
        let half: i32x4 = bytemuck::cast(at.along.towards);
        let cell = at.along.cell + (half & i32x4::splat(fast.half as i32));
        let (row, cell, between) = (at.row.to_array(), cell.to_array(), at.between.to_array());
        let nodes = &self.slices.slope[..];
        let node = |i: usize| {
            let low = start(row[i] as u32, stride, cell[i]);
            let high = low + stride as usize;
            if high + 2 > nodes.len() {
                return f32x4::splat(f32::NAN);
            }
            let (low, high) = (pair(nodes, low), pair(nodes, high));
            low + f32x4::splat(between[i]) * (high - low)
        };
        let g = hermite_lanes(f32x4::transpose(core::array::from_fn(node)), at.along.w);
        let cells = coefficients(&fast.across, at.across.cell.to_array());
        [g, cubic_lanes(cells, at.across.w)]
    }

    /// Writes the normals; false where one of them is outside the common case.
    #[inline(always)]
    fn assemble_lanes(&self, at: &Located, [g, h]: [f32x4; 2], m: &mut [Vec3; LANES]) -> bool {
        let t = (h - 1.0) / (h * (2.0 - h));
        let min_g = (!at.along.towards & at.silhouette)
            + (SILHOUETTE_MARGIN - t * SILHOUETTE_MARGIN_ACROSS);
        let t = t ^ at.across.sign();
        let [x, z] = half_slope_at(g);
        let norm = (z * z + f32x4::splat(4.0 * self.s) * (x * x)).sqrt();
        let x = x ^ at.along.sign();
        // In the order of the function for one direction: strong anisotropy magnifies every
        // rounding.
        let (sx, sy) = (2.0 * self.sigma_x, 2.0 * self.sigma_y);
        let (x, y) =
            (x * (at.x * sx) + norm * (at.y * -sx * t), x * (at.y * sy) + norm * (at.x * sy * t));
        let z = z * at.rho;
        // Two divisions fewer, at the cost of a last bit.
        let r = 1.0 / (x * x + z * z + y * y).sqrt();
        let (x, y, z) = ((x * r).to_array(), (y * r).to_array(), (z * r).to_array());
        *m = core::array::from_fn(|i| Vec3::new(x[i], y[i], z[i]));
        (g.simd_ge(min_g) & at.rho.simd_ge(SHORT)).all()
    }

    #[inline(always)]
    fn g1_lanes(&self, w: &[Vec3; LANES]) -> [f32; LANES] {
        let slices = &self.slices;
        let [wx, wy, wz] = transpose(w);
        let (x, y) = (wx * (slices.kappa * self.sigma_x), wy * (slices.kappa * self.sigma_y));
        let z = wz.fast_max(f32x4::ZERO);
        let across = (x * x + y * y).sqrt();
        let [q, at] = slices.shadowing_view.of_views(across, z, slices.shadowing_cells);
        let (cell, w) = split(at);
        let g1 = q * horner_lanes(coefficients(&slices.shadowing, cell.to_array()), w);
        // NaN gives 0 here, too.
        (g1.fast_min(f32x4::ONE) & g1.simd_ge(0.0)).to_array()
    }
}

/// Four views and pairs of random numbers, located in the tables.
#[derive(Clone, Copy, Default)]
struct Located {
    x: f32x4,
    y: f32x4,
    rho: f32x4,
    /// 1 − τ.
    silhouette: f32x4,
    row: i32x4,
    between: f32x4,
    along: Number,
    across: Number,
}

/// Four of the random numbers along one axis.
#[derive(Clone, Copy, Default)]
struct Number {
    cell: i32x4,
    w: f32x4,
    /// All ones where the number is above ½.
    towards: f32x4,
}

impl Number {
    #[inline(always)]
    fn new(u: [f32; LANES], scale: f32) -> Self {
        let u = f32x4::new(u);
        let (cell, w) = split(roots(u) * scale);
        Self { cell, w, towards: u.simd_gt(0.5) }
    }

    #[inline(always)]
    fn sign(&self) -> f32x4 {
        self.towards & f32x4::splat(-0.0)
    }
}

/// The coefficients of four cells' cubics; 0 where there is no such cell.
#[inline(always)]
fn coefficients(cells: &[Cell], at: [i32; LANES]) -> [f32x4; 4] {
    let cell = |i: usize| f32x4::new(cells.get(at[i] as u32 as usize).copied().unwrap_or([0.0; 4]));
    f32x4::transpose(core::array::from_fn(cell))
}

#[inline(always)]
fn transpose(v: &[Vec3; LANES]) -> [f32x4; 3] {
    [
        f32x4::new([v[0].x, v[1].x, v[2].x, v[3].x]),
        f32x4::new([v[0].y, v[1].y, v[2].y, v[3].y]),
        f32x4::new([v[0].z, v[1].z, v[2].z, v[3].z]),
    ]
}

/// Checks that all slices of a batch have the length of the first; the error names one that has
/// not.
pub(crate) fn same_lengths(slices: &[(&'static str, usize)]) -> Result<(), BatchError> {
    let (first, expected) = slices[0];
    match slices.iter().find(|(_, length)| *length != expected) {
        None => Ok(()),
        Some(&(other, length)) => {
            Err(BatchError { slices: [first, other], lengths: [expected, length] })
        }
    }
}
