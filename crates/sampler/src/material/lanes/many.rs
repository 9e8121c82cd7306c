//! The functions over slices, in as many [`Lanes`] as the processor has, and the general path,
//! which serves every lobe, view and number.
//!
//! Every lane does what the [fast path](super::one) for one direction does, in the same order, so
//! the results are the same, to the last bits of the normalisation, and to the bit whatever the
//! number of lanes. In a batch one root, division or polynomial serves all lanes, and several
//! groups of lanes go through each stage together, so that the processor has independent work
//! during each wait. Only the table reads are made one by one. Rare cases, a view straight from
//! above or a normal that rounding has put behind the silhouette, are handled in lanes too, so that
//! they do not slow down the others.

use glam::Vec3;
use microfacet_lanes::{Ints, Lanes, Work, f32x4, widest};
use microfacet_tables::axis::half_tangent::half_slope_at;
use microfacet_tables::axis::hermite::{hermite_lanes, split};
use microfacet_tables::axis::roots;

use super::one::least_clear;
use super::views::Views;
use crate::material::heavy::half_slopes;
use crate::material::horizon::HORIZON;
use crate::material::surface::{Shape, Shapes, Surface};
use crate::vector::vec3;

/// How many groups go through each stage together.
const GROUPS: usize = 8;

impl<S: Shape> Surface<S> {
    /// As many normals as there are views; the slices are of the same length.
    pub(crate) fn sample_all<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) {
        let done = widest(Normals { surface: self, v, u, m });
        let (v, u, m) = (&v[done..], &u[done..], &mut m[done..]);
        // What does not fill more lanes may fill four.
        let done = self.sample_groups::<f32x4, V, M>(v, u, m);
        for ((v, u), m) in v[done..].iter().zip(&u[done..]).zip(&mut m[done..]) {
            *m = self.sample(vec3(*v), *u).to_array().into();
        }
    }

    /// Normals of all views but those too few to fill lanes; how many they are.
    #[inline(always)]
    fn sample_groups<L: Lanes, V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> usize {
        let whole = v.len() - v.len() % L::WIDTH;
        let block = GROUPS * L::WIDTH;
        let blocks = v[..whole].chunks(block).zip(u[..whole].chunks(block));
        // Set to zero once, not for each block.
        let mut stages = Default::default();
        for ((v, u), m) in blocks.zip(m[..whole].chunks_mut(block)) {
            if self.shape.peeled() {
                self.sample_block::<true, L, V, M>(&mut stages, v, u, m);
            } else {
                self.sample_block::<false, L, V, M>(&mut stages, v, u, m);
            }
        }
        whole
    }

    /// At most [`GROUPS`] groups, stage by stage.
    #[inline(always)]
    fn sample_block<const HEAVY: bool, L: Lanes, V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        self,
        (located, slopes): &mut ([Located<L>; GROUPS], [Slopes<L>; GROUPS]),
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) {
        let (shape, [sx, sy]) = (self.shape, self.scales.sigma);
        let sigma = [L::splat(sx), L::splat(sy)];
        let views = v.chunks_exact(L::WIDTH);
        for ((at, v), u) in located.iter_mut().zip(views.clone()).zip(u.chunks_exact(L::WIDTH)) {
            let [x, y, z] = components(v);
            let u = [L::from_fn(|i| u[i][0]), L::from_fn(|i| u[i][1])];
            *at = Located::new::<HEAVY, S>(shape, Views::new(x * sigma[0], y * sigma[1], z), u);
        }
        for (slopes, at) in slopes.iter_mut().zip(&located[..views.len()]) {
            *slopes = at.look_up::<HEAVY, S>(shape);
        }
        for (i, (m, v)) in m.chunks_exact_mut(L::WIDTH).zip(views).enumerate() {
            let shrink = if HEAVY { slopes[i].shrink } else { L::splat(1.0) };
            let views = &located[i].views;
            let normals = slopes[i].normals(shape.s_lanes(), views, sigma, shrink, v);
            let [x, y, z] = normals;
            let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
            m.iter_mut().enumerate().for_each(|(i, m)| *m = M::from([x[i], y[i], z[i]]));
        }
    }

    /// The normals visible along stretched views, not normalised.
    #[inline(always)]
    pub(crate) fn unnormalised(self, views: Views<f32x4>, u: [f32; 2]) -> [f32x4; 3] {
        let at = Located::new::<true, S>(self.shape, views, u.map(f32x4::splat));
        let slopes = at.look_up::<true, S>(self.shape);
        let sigma = self.scales.sigma.map(f32x4::splat);
        let [x, y, z] = slopes.assemble(self.shape.s_lanes(), &at.views, sigma);
        [x, y, z * slopes.shrink]
    }
}

/// [`Surface::sample_groups`].
struct Normals<'a, S, V, M> {
    surface: Surface<S>,
    v: &'a [V],
    u: &'a [[f32; 2]],
    m: &'a mut [M],
}

impl<S: Shape, V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>> Work for Normals<'_, S, V, M> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        self.surface.sample_groups::<L, V, M>(self.v, self.u, self.m)
    }
}

/// A visible normal of each lane's shape and σ.
#[inline(always)]
pub(crate) fn sample_lanes<L: Lanes, S: Shapes, V: Copy + Into<[f32; 3]>>(
    shapes: S,
    sigma: [L; 2],
    v: &[V],
    u: &[[f32; 2]],
) -> [L; 3] {
    let [x, y, z] = components::<L, V>(v);
    let u = [L::from_fn(|i| u[i][0]), L::from_fn(|i| u[i][1])];
    let at = Located::new::<true, S>(shapes, Views::new(x * sigma[0], y * sigma[1], z), u);
    let slopes = at.look_up::<true, S>(shapes);
    slopes.normals(shapes.s_lanes(), &at.views, sigma, slopes.shrink, v)
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
    facing(above_horizon(normals, f32x4::ONE), v, f32x4::ZERO).map(|x| x.to_array()[0]).into()
}

/// Views and pairs of random numbers, located in the tables.
#[derive(Clone, Copy, Default)]
struct Located<L: Lanes> {
    views: Views<L>,
    /// 1 − τ.
    silhouette: L,
    /// The first node of a row.
    row: L::Ints,
    between: L,
    /// The number along the plane within its part, and all ones where that part is the heavy one.
    number: L,
    heavy: L,
    along: Number<L>,
    across: Number<L>,
}

/// Slopes in the plane of incidence, 2x : z, and across, 2t : t_z.
#[derive(Clone, Copy, Default)]
struct Slopes<L> {
    x: L,
    z: L,
    t: L,
    t_z: L,
    /// All ones where no rounding can hide the normal from the view.
    clear: L,
    /// A factor on the normal's z.
    shrink: L,
}

/// Random numbers along one axis.
#[derive(Clone, Copy, Default)]
struct Number<L: Lanes> {
    cell: L::Ints,
    w: L,
    /// All ones where the number is above ½.
    towards: L,
}

impl<L: Lanes> Located<L> {
    #[inline(always)]
    fn new<const HEAVY: bool, S: Shapes>(shape: S, views: Views<L>, u: [L; 2]) -> Self {
        let Views { rho, z, length, .. } = views;
        let [at, silhouette] = shape.place::<HEAVY, L>(rho, z, length);
        let (row, between) = split(at);
        let [number, heavy] =
            if HEAVY && shape.peeled() { shape.parts(u[0], at) } else { [u[0], L::splat(0.0)] };
        let scales = shape.scales();
        let along = Number::new(number, scales[0]);
        let across = Number::new(u[1], scales[1]);
        Self { views, silhouette, row, between, number, heavy, along, across }
    }

    #[inline(always)]
    fn look_up<const HEAVY: bool, S: Shapes>(&self, shape: S) -> Slopes<L> {
        let half = shape.half() as i32;
        let second = self.along.towards.to_bits() & L::Ints::splat(half);
        let low = self.row * L::Ints::splat(2 * half) + self.along.cell + second;
        let g = hermite_lanes(shape.between_lanes(low, self.between), self.along.w);
        let across = shape.across_lanes(self.across.cell, self.across.w);
        let [t, t_z] = half_slope_at(across);
        let [x, mut z] = half_slope_at(g);
        let mut x = x ^ self.along.sign();
        let mut shrink = L::splat(1.0);
        let (mut ahead, mut silhouette) = (g, !self.along.towards & self.silhouette);
        if HEAVY && shape.peeled() {
            let [heavy_x, heavy_z, factor] = half_slopes(self.number, shape.tails());
            [x, z] = [self.heavy.select(heavy_x, x), self.heavy.select(heavy_z, z)];
            shrink = self.heavy.select(factor, shrink);
            ahead = self.heavy.select(x + z, ahead);
            silhouette = !self.heavy & silhouette;
        }
        let clear = (ahead * t_z).simd_ge(least_clear(silhouette, t, t_z));
        Slopes { x, z, t: t ^ self.across.sign(), t_z, clear, shrink }
    }
}

impl<L: Lanes> Slopes<L> {
    /// The visible normals of views `v`.
    #[inline(always)]
    fn normals<V: Copy + Into<[f32; 3]>>(
        &self,
        s: L,
        views: &Views<L>,
        sigma: [L; 2],
        shrink: L,
        v: &[V],
    ) -> [L; 3] {
        let normals = above_horizon(self.assemble(s, views, sigma), shrink);
        if self.clear.all() { normals } else { facing(normals, components(v), self.clear) }
    }

    #[inline(always)]
    fn assemble(&self, s: L, views: &Views<L>, [sx, sy]: [L; 2]) -> [L; 3] {
        let &Self { x, z, t, t_z, .. } = self;
        let norm = (z * z + s * 4.0 * (x * x)).sqrt();
        // In the order of the code for one direction: strong anisotropy magnifies every rounding.
        let (sx, sy) = (sx * 2.0, sy * 2.0);
        [
            x * (views.x * sx * t_z) + norm * (views.y * (L::splat(0.0) - sx) * t),
            x * (views.y * sy * t_z) + norm * (views.x * sy * t),
            z * (views.frame * t_z),
        ]
    }
}

impl<L: Lanes> Number<L> {
    #[inline(always)]
    fn new(u: L, scale: f32) -> Self {
        // NaN is taken as 0.
        let u = u & u.simd_gt(L::splat(0.0));
        let (cell, w) = split(roots(u) * scale);
        Self { cell, w, towards: u.simd_gt(L::splat(0.5)) }
    }

    #[inline(always)]
    fn sign(&self) -> L {
        self.towards & L::splat(-0.0)
    }
}

/// [`face`](crate::material::horizon::face) for normals in lanes, but those that are `clear`: what
/// becomes of them must not depend on their neighbours.
#[inline(always)]
pub(crate) fn facing<L: Lanes>(m: [L; 3], [vx, vy, vz]: [L; 3], clear: L) -> [L; 3] {
    let zero = L::splat(0.0);
    let vz = vz & vz.simd_gt(zero);
    let facing = vx * m[0] + vy * m[1] + vz * m[2];
    let hidden = !clear & facing.simd_lt(zero);
    if !hidden.any() {
        return m;
    }
    // A view moved to the horizon is shorter than 1, and may be almost 0.
    let length2 = vx * vx + vy * vy + vz * vz;
    // A normal counts as visible if the length of the view is out of range.
    let hidden = hidden & length2.simd_le(L::splat(f32::MAX));
    let back = facing / length2.fast_max(L::splat(f32::MIN_POSITIVE));
    let turned = [m[0] - back * vx, m[1] - back * vy, m[2] - back * vz];
    let [x, y, z] = above_horizon(turned, L::splat(1.0));
    [hidden.select(x, m[0]), hidden.select(y, m[1]), hidden.select(z, m[2])]
}

/// Normalises normals, multiplies z by `shrink`, and raises z to [`HORIZON`] where it is lower.
#[inline(always)]
pub(crate) fn above_horizon<L: Lanes>([x, y, z]: [L; 3], shrink: L) -> [L; 3] {
    // By the reciprocal: two divisions fewer, at the cost of a last bit.
    let r = L::splat(1.0) / (x * x + z * z + y * y).sqrt();
    [x * r, y * r, (z * r * shrink).fast_max(L::splat(HORIZON))]
}

/// The x, y and z of vectors, one in each lane.
#[inline(always)]
pub(crate) fn components<L: Lanes, V: Copy + Into<[f32; 3]>>(v: &[V]) -> [L; 3] {
    let component = |i: usize, axis: usize| Into::<[f32; 3]>::into(v[i])[axis];
    [
        L::from_fn(|i| component(i, 0)),
        L::from_fn(|i| component(i, 1)),
        L::from_fn(|i| component(i, 2)),
    ]
}
