//! The functions over slices, four directions at a time, and the one path that serves every lobe,
//! view and number.
//!
//! Every lane does what the [fast path](super::fast_path) for one direction does, in the same
//! order, so the results are the same, to the last bits of the normalisation. A batch saves by
//! sharing: one root, division or polynomial serves four normals (18 ns become 8), and several
//! groups of four go through each stage together, so that the processor has independent work during
//! each wait (8 become 6). Only the table reads are made one by one. What is rare is mended in
//! lanes too: a view straight from above, or a normal that rounding has put behind the silhouette,
//! does not slow its three neighbours down.

use glam::Vec3;
use wide::{bytemuck, f32x4, i32x4};

use microfacet_tables::axis::half_tangent::half_slope_at;
use microfacet_tables::axis::hermite::{Cell, cubic_lanes, hermite_lanes, horner_lanes, split};
use microfacet_tables::axis::roots;

use super::distribution::MicrofacetDistribution;
use super::fast_path::{least_clear, pair, start};
use super::heavy::parts;
use super::sample::HORIZON;
use super::student_t::StudentT;
use super::views::Views;

/// Directions of a group.
pub(crate) const LANES: usize = 4;
/// How many groups of four go through each stage together.
const GROUPS: usize = 8;
impl StudentT {
    /// As many normals as there are views; the slices are of the same length.
    pub(crate) fn sample_all(&self, v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]) {
        let ((v, v_rest), (u, u_rest)) = (v.as_chunks(), u.as_chunks());
        let (m, m_rest) = m.as_chunks_mut();
        for ((v, u), m) in v.chunks(GROUPS).zip(u.chunks(GROUPS)).zip(m.chunks_mut(GROUPS)) {
            if self.slices.fast.plain {
                self.sample_groups::<false>(v, u, m);
            } else {
                self.sample_groups::<true>(v, u, m);
            }
        }
        for ((v, u), m) in v_rest.iter().zip(u_rest).zip(m_rest) {
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
    fn sample_groups<const HEAVY: bool>(
        &self,
        v: &[[Vec3; LANES]],
        u: &[[[f32; 2]; LANES]],
        m: &mut [[Vec3; LANES]],
    ) {
        let sigma = [self.sigma_x, self.sigma_y];
        let mut located = [Located::default(); GROUPS];
        for ((at, v), u) in located.iter_mut().zip(v).zip(u) {
            let [x, y, z] = transpose(v);
            *at = self.locate::<HEAVY>(Views::new(x * sigma[0], y * sigma[1], z), numbers(u));
        }
        let mut slopes = [Slopes::default(); GROUPS];
        for (slopes, at) in slopes.iter_mut().zip(&located[..v.len()]) {
            *slopes = self.look_up::<HEAVY>(at);
        }
        for (i, m) in m.iter_mut().enumerate() {
            let normals = self.assemble_lanes(&located[i].views, &slopes[i], sigma);
            let shrink = if HEAVY { slopes[i].shrink } else { f32x4::ONE };
            let mut normals = above_horizon(normals, shrink);
            if !slopes[i].clear.all() {
                normals = facing(normals, transpose(&v[i]));
            }
            let [x, y, z] = normals.map(f32x4::to_array);
            *m = core::array::from_fn(|i| Vec3::new(x[i], y[i], z[i]));
        }
    }

    /// The general path for one direction: a visible normal for every material and view.
    #[inline(never)]
    pub(crate) fn sample_general(&self, x: f32, y: f32, z: f32, u: [f32; 2]) -> Vec3 {
        let v = [x, y, z].map(f32x4::splat);
        let sigma = [self.sigma_x, self.sigma_y];
        let normals =
            self.unnormalised(Views::new(v[0] * sigma[0], v[1] * sigma[1], v[2]), u, sigma);
        facing(above_horizon(normals, f32x4::ONE), v).map(|x| x.to_array()[0]).into()
    }

    /// The normal visible along a stretched view, stretched by `sigma`, in all lanes.
    pub(crate) fn unnormalised(&self, views: Views, u: [f32; 2], sigma: [f32; 2]) -> [f32x4; 3] {
        let at = self.locate::<true>(views, u.map(f32x4::splat));
        let slopes = self.look_up::<true>(&at);
        let [x, y, z] = self.assemble_lanes(&at.views, &slopes, sigma);
        [x, y, z * slopes.shrink]
    }

    #[inline(always)]
    fn locate<const HEAVY: bool>(&self, views: Views, u: [f32x4; 2]) -> Located {
        let (slices, fast) = (&self.slices, &self.slices.fast);
        let Views { rho, z, length, .. } = views;
        let [at, silhouette] = slices.place::<HEAVY>(rho, z, length);
        let (row, between) = split(at);
        let [number, heavy] = if HEAVY && slices.peeled {
            parts(u[0], slices.heavy.shares(at, coefficients))
        } else {
            [u[0], f32x4::ZERO]
        };
        let along = Number::new(number, fast.scales[0]);
        let across = Number::new(u[1], fast.scales[1]);
        Located { views, silhouette, row, between, number, heavy, along, across }
    }

    /// The in-plane slopes and the slopes across.
    #[inline(always)]
    fn look_up<const HEAVY: bool>(&self, at: &Located) -> Slopes {
        let (slices, fast) = (&self.slices, &self.slices.fast);
        let stride = 2 * fast.half;
        let half: i32x4 = bytemuck::cast(at.along.towards);
        let cell = at.along.cell + (half & i32x4::splat(fast.half as i32));
        let (row, cell, between) = (at.row.to_array(), cell.to_array(), at.between.to_array());
        let nodes = &slices.slope[..];
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
        let [t, t_z] = half_slope_at(cubic_lanes(cells, at.across.w));
        let [x, mut z] = half_slope_at(g);
        let mut x = x ^ at.along.sign();
        let mut shrink = f32x4::ONE;
        let (mut ahead, mut silhouette) = (g, !at.along.towards & at.silhouette);
        if HEAVY && slices.peeled {
            let heavy = slices.heavy.half_slopes(at.number);
            [x, z] = [at.heavy.select(heavy[0], x), at.heavy.select(heavy[1], z)];
            shrink = at.heavy.select(heavy[2], f32x4::ONE);
            ahead = at.heavy.select(x + z, ahead);
            silhouette = !at.heavy & silhouette;
        }
        let clear = (ahead * t_z).simd_ge(least_clear(silhouette, t, t_z));
        Slopes { x, z, t: t ^ at.across.sign(), t_z, clear, shrink }
    }

    /// The normals, not normalised.
    #[inline(always)]
    fn assemble_lanes(&self, views: &Views, at: &Slopes, [sx, sy]: [f32; 2]) -> [f32x4; 3] {
        let &Slopes { x, z, t, t_z, .. } = at;
        let norm = (z * z + f32x4::splat(4.0 * self.s) * (x * x)).sqrt();
        // In the order of the function for one direction: strong anisotropy magnifies every
        // rounding.
        let (sx, sy) = (2.0 * sx, 2.0 * sy);
        [
            x * (views.x * sx * t_z) + norm * (views.y * -sx * t),
            x * (views.y * sy * t_z) + norm * (views.x * sy * t),
            z * (views.frame * t_z),
        ]
    }

    #[inline(always)]
    fn g1_lanes(&self, w: &[Vec3; LANES]) -> [f32; LANES] {
        let slices = &self.slices;
        let [wx, wy, wz] = transpose(w);
        let [kx, ky] = self.kappa_sigma;
        let (x, y) = (wx * kx, wy * ky);
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
    views: Views,
    /// 1 − τ.
    silhouette: f32x4,
    row: i32x4,
    between: f32x4,
    /// The number along the plane within its part, and all ones where that is the heavy one.
    number: f32x4,
    heavy: f32x4,
    along: Number,
    across: Number,
}

/// Four slopes in the plane of incidence, 2x : z, and four across, 2t : t_z.
#[derive(Clone, Copy, Default)]
struct Slopes {
    x: f32x4,
    z: f32x4,
    t: f32x4,
    t_z: f32x4,
    /// All ones where no rounding can hide the normal from the view.
    clear: f32x4,
    /// A factor on the normal's z.
    shrink: f32x4,
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
    fn new(u: f32x4, scale: f32) -> Self {
        // NaN is taken as 0.
        let u = u & u.simd_gt(0.0);
        let (cell, w) = split(roots(u) * scale);
        Self { cell, w, towards: u.simd_gt(0.5) }
    }

    #[inline(always)]
    fn sign(&self) -> f32x4 {
        self.towards & f32x4::splat(-0.0)
    }
}

/// Unit normals that face their views: those that rounding has put behind the
/// silhouette are turned back onto it.
///
/// The silhouette's slope has the rounding of the view coordinate, which is coarse where σ is far
/// below the view's tilt, and strong anisotropy lets the tilt across spoil the tilt along.
#[inline(always)]
fn facing(m: [f32x4; 3], [vx, vy, vz]: [f32x4; 3]) -> [f32x4; 3] {
    let vz = vz & vz.simd_gt(0.0);
    let facing = vx * m[0] + vy * m[1] + vz * m[2];
    let hidden = facing.simd_lt(0.0);
    if !hidden.any() {
        return m;
    }
    // A view taken at the horizon is shorter than 1, and may be almost nothing.
    let length2 = vx * vx + vy * vy + vz * vz;
    // Nothing is behind a view whose length is out of range.
    let hidden = hidden & length2.simd_le(f32::MAX);
    let back = facing / length2.fast_max(f32x4::splat(f32::MIN_POSITIVE));
    let turned = [m[0] - back * vx, m[1] - back * vy, m[2] - back * vz];
    let turned = above_horizon(turned, f32x4::ONE);
    core::array::from_fn(|i| hidden.select(turned[i], m[i]))
}

/// Normalises normals, then takes their z times `shrink`, and raises them to the smallest cosine
/// where they are lower.
#[inline(always)]
fn above_horizon([x, y, z]: [f32x4; 3], shrink: f32x4) -> [f32x4; 3] {
    // Two divisions fewer, at the cost of a last bit.
    let r = 1.0 / (x * x + z * z + y * y).sqrt();
    [x * r, y * r, (z * r * shrink).fast_max(f32x4::splat(HORIZON))]
}

#[inline(always)]
fn numbers(u: &[[f32; 2]; LANES]) -> [f32x4; 2] {
    [0, 1].map(|i| f32x4::new([u[0][i], u[1][i], u[2][i], u[3][i]]))
}

/// The coefficients of four cells' cubics; 0 where there is no such cell.
#[inline(always)]
pub(crate) fn coefficients(cells: &[Cell], at: [i32; LANES]) -> [f32x4; 4] {
    let cell = |i: usize| f32x4::new(cells.get(at[i] as u32 as usize).copied().unwrap_or([0.0; 4]));
    f32x4::transpose(core::array::from_fn(cell))
}

#[inline(always)]
pub(crate) fn transpose(v: &[Vec3; LANES]) -> [f32x4; 3] {
    [
        f32x4::new([v[0].x, v[1].x, v[2].x, v[3].x]),
        f32x4::new([v[0].y, v[1].y, v[2].y, v[3].y]),
        f32x4::new([v[0].z, v[1].z, v[2].z, v[3].z]),
    ]
}
