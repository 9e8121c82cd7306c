//! The functions over slices, four directions at a time, and the general path, which serves every
//! lobe, view and number.
//!
//! Every lane does what the [fast path](super::one) for one direction does, in the same order, so
//! the results are the same, to the last bits of the normalisation. In a batch one root, division
//! or polynomial serves four normals (18 ns become 8), and several groups of four go through each
//! stage together, so that the processor has independent work during each wait (8 become 6). Only
//! the table reads are made one by one. Rare cases, a view straight from above or a normal that
//! rounding has put behind the silhouette, are handled in lanes too, so that they do not slow down
//! the other three.

use glam::Vec3;
use wide::{bytemuck, f32x4, i32x4};

use microfacet_tables::axis::half_tangent::half_slope_at;
use microfacet_tables::axis::hermite::{Cell, hermite_lanes, split};
use microfacet_tables::axis::roots;

use super::one::{least_clear, start};
use super::views::Views;
use crate::material::horizon::HORIZON;
use crate::material::surface::{LANES, Shape, Surface};
use crate::vector::vec3;

/// How many groups of four go through each stage together.
const GROUPS: usize = 8;

impl<S: Shape> Surface<S> {
    /// As many normals as there are views; the slices are of the same length.
    pub(crate) fn sample_all<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) {
        let ((v, v_rest), (u, u_rest)) = (v.as_chunks(), u.as_chunks());
        let (m, m_rest) = m.as_chunks_mut();
        for ((v, u), m) in v.chunks(GROUPS).zip(u.chunks(GROUPS)).zip(m.chunks_mut(GROUPS)) {
            if self.shape.peeled() {
                self.sample_groups::<true, V, M>(v, u, m);
            } else {
                self.sample_groups::<false, V, M>(v, u, m);
            }
        }
        for ((v, u), m) in v_rest.iter().zip(u_rest).zip(m_rest) {
            *m = self.sample(vec3(*v), *u).to_array().into();
        }
    }

    /// At most [`GROUPS`] groups of four, stage by stage.
    fn sample_groups<const HEAVY: bool, V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        v: &[[V; LANES]],
        u: &[[[f32; 2]; LANES]],
        m: &mut [[M; LANES]],
    ) {
        let sigma = self.scales.sigma;
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
            *m = core::array::from_fn(|i| M::from([x[i], y[i], z[i]]));
        }
    }

    /// The normals visible along stretched views, not normalised.
    pub(crate) fn unnormalised(self, views: Views, u: [f32; 2]) -> [f32x4; 3] {
        let at = self.locate::<true>(views, u.map(f32x4::splat));
        let slopes = self.look_up::<true>(&at);
        let [x, y, z] = self.assemble_lanes(&at.views, &slopes, self.scales.sigma);
        [x, y, z * slopes.shrink]
    }

    #[inline(always)]
    fn locate<const HEAVY: bool>(self, views: Views, u: [f32x4; 2]) -> Located {
        let shape = self.shape;
        let Views { rho, z, length, .. } = views;
        let [at, silhouette] = shape.place::<HEAVY>(rho, z, length);
        let (row, between) = split(at);
        let [number, heavy] =
            if HEAVY && shape.peeled() { shape.parts(u[0], at) } else { [u[0], f32x4::ZERO] };
        let scales = shape.scales();
        let along = Number::new(number, scales[0]);
        let across = Number::new(u[1], scales[1]);
        Located { views, silhouette, row, between, number, heavy, along, across }
    }

    #[inline(always)]
    fn look_up<const HEAVY: bool>(self, at: &Located) -> Slopes {
        let shape = self.shape;
        let stride = 2 * shape.half();
        let half: i32x4 = bytemuck::cast(at.along.towards);
        let cell = at.along.cell + (half & i32x4::splat(shape.half() as i32));
        let (row, cell, between) = (at.row.to_array(), cell.to_array(), at.between.to_array());
        let node = |i: usize| {
            let low = start(row[i] as u32, stride, cell[i]);
            let high = low + stride as usize;
            shape.between(low, high, between[i])
        };
        let g = hermite_lanes(f32x4::transpose(core::array::from_fn(node)), at.along.w);
        let across = shape.across_lanes(at.across.cell.to_array(), at.across.w);
        let [t, t_z] = half_slope_at(across);
        let [x, mut z] = half_slope_at(g);
        let mut x = x ^ at.along.sign();
        let mut shrink = f32x4::ONE;
        let (mut ahead, mut silhouette) = (g, !at.along.towards & at.silhouette);
        if HEAVY && shape.peeled() {
            let heavy = shape.tail().half_slopes(at.number);
            [x, z] = [at.heavy.select(heavy[0], x), at.heavy.select(heavy[1], z)];
            shrink = at.heavy.select(heavy[2], f32x4::ONE);
            ahead = at.heavy.select(x + z, ahead);
            silhouette = !at.heavy & silhouette;
        }
        let clear = (ahead * t_z).simd_ge(least_clear(silhouette, t, t_z));
        Slopes { x, z, t: t ^ at.across.sign(), t_z, clear, shrink }
    }

    #[inline(always)]
    fn assemble_lanes(self, views: &Views, at: &Slopes, [sx, sy]: [f32; 2]) -> [f32x4; 3] {
        let &Slopes { x, z, t, t_z, .. } = at;
        let norm = (z * z + f32x4::splat(4.0 * self.shape.s()) * (x * x)).sqrt();
        // In the order of the code for one direction: strong anisotropy magnifies every rounding.
        let (sx, sy) = (2.0 * sx, 2.0 * sy);
        [
            x * (views.x * sx * t_z) + norm * (views.y * -sx * t),
            x * (views.y * sy * t_z) + norm * (views.x * sy * t),
            z * (views.frame * t_z),
        ]
    }
}

/// The general path for one direction: a visible normal for every material and view.
#[inline(never)]
pub(crate) fn sample_general<S: Shape>(
    seed: S::Seed,
    sigma: [f32; 2],
    x: f32,
    y: f32,
    z: f32,
    u: [f32; 2],
) -> Vec3 {
    let v = [x, y, z].map(f32x4::splat);
    let views = Views::new(v[0] * sigma[0], v[1] * sigma[1], v[2]);
    let normals = Surface::new(S::of_seed(seed), sigma).unnormalised(views, u);
    facing(above_horizon(normals, f32x4::ONE), v).map(|x| x.to_array()[0]).into()
}

/// Four views and pairs of random numbers, located in the tables.
#[derive(Clone, Copy, Default)]
struct Located {
    views: Views,
    /// 1 − τ.
    silhouette: f32x4,
    row: i32x4,
    between: f32x4,
    /// The number along the plane within its part, and all ones where that part is the heavy one.
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

/// [`face`](crate::material::horizon::face) for four normals.
#[inline(always)]
fn facing(m: [f32x4; 3], [vx, vy, vz]: [f32x4; 3]) -> [f32x4; 3] {
    let vz = vz & vz.simd_gt(0.0);
    let facing = vx * m[0] + vy * m[1] + vz * m[2];
    let hidden = facing.simd_lt(0.0);
    if !hidden.any() {
        return m;
    }
    // A view moved to the horizon is shorter than 1, and may be almost 0.
    let length2 = vx * vx + vy * vy + vz * vz;
    // A normal counts as visible if the length of the view is out of range.
    let hidden = hidden & length2.simd_le(f32::MAX);
    let back = facing / length2.fast_max(f32x4::splat(f32::MIN_POSITIVE));
    let turned = [m[0] - back * vx, m[1] - back * vy, m[2] - back * vz];
    let turned = above_horizon(turned, f32x4::ONE);
    core::array::from_fn(|i| hidden.select(turned[i], m[i]))
}

/// Normalises normals, multiplies z by `shrink`, and raises z to [`HORIZON`] where it is lower.
#[inline(always)]
fn above_horizon([x, y, z]: [f32x4; 3], shrink: f32x4) -> [f32x4; 3] {
    // By the reciprocal: two divisions fewer, at the cost of a last bit.
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
pub(crate) fn transpose<V: Copy + Into<[f32; 3]>>(v: &[V; LANES]) -> [f32x4; 3] {
    let v: [[f32; 3]; LANES] = v.map(Into::into);
    [0, 1, 2].map(|i| f32x4::new([v[0][i], v[1][i], v[2][i], v[3][i]]))
}
