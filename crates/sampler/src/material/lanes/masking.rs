//! G1 of a lobe, of one view, of a view and a light, and of many views. G1 is q times the cubic of
//! the cell of its coordinate: a root, a division and a lookup.

use glam::Vec3;
use microfacet_lanes::{Lanes, Work, f32x4, widest};

use microfacet_tables::axis::above_zero;
use microfacet_tables::axis::hermite::split;

use super::many::components;
use super::{swap_halves, swap_pairs};
use crate::material::surface::{Shape, Shapes, Surface};
use crate::vector::vec3;

/// Returns 0, the G1 of NaN; cold, so that the common path stays short.
#[cold]
fn g1_of_nan<T: Default>() -> T {
    T::default()
}

impl<S: Shape> Surface<S> {
    #[inline(always)]
    pub(crate) fn g1_of_one(self, v: Vec3) -> f32 {
        // As `inverse_area`, without the azimuth, and with κ folded into the roughness. The chain
        // of a root, a division and a lookup is so long that the instructions of a few calls fill
        // the processor's window, so every instruction counts. Of 4.3 ns, Horner's scheme, which no
        // compiler turns into shuffles, saved about 0.5, an area without a lower limit 0.2, and a
        // root of all lanes, none of which is set to zero, with NaN handled out of line, 0.3; 3.1
        // are left.
        let (view, cells) = self.shape.masking_view();
        let [kx, ky] = self.scales.kappa;
        let xy = f32x4::new([v.x, v.y, 0.0, 0.0]) * f32x4::new([kx, ky, 0.0, 0.0]);
        let squares = xy * xy;
        // G1 = −0 would make Λ −∞.
        let z = above_zero(f32x4::new([v.z, 0.0, 0.0, 0.0]));
        let across = (squares + swap_pairs(squares)).sqrt();
        let [q, at] = view.of_views(across, z, cells);
        let (cell, w) = split(at);
        let cell = cell.to_array()[0] as u32 as usize;
        let Some(cell) = self.shape.masking_cell(cell) else {
            return g1_of_nan();
        };
        let g1 = q.to_array()[0] * S::masking(cell, w.to_array()[0]);
        // The null vector gives 0/0: an index out of the table where the cast does not saturate,
        // and cell 0 where it does.
        if cfg!(not(target_feature = "sse2")) && g1.is_nan() {
            return 0.0;
        }
        // Interpolation may overshoot 1 by the table's error near normal incidence.
        g1.min(1.0)
    }

    /// G1 of a view and a light: the root, the division and the lookup's arithmetic of
    /// [`g1_of_one`](Self::g1_of_one) in two lanes.
    #[inline(always)]
    pub(crate) fn g1_of_both(self, v: Vec3, l: Vec3) -> [f32; 2] {
        let (view, cells) = self.shape.masking_view();
        // Lanes [v, l, v, l], so that none has to be set to zero.
        let [kx, ky] = self.scales.kappa;
        let xy = f32x4::new([v.x, l.x, v.y, l.y]) * f32x4::new([kx, kx, ky, ky]);
        let squares = xy * xy;
        let z = above_zero(f32x4::new([v.z, l.z, v.z, l.z]));
        let across = (squares + swap_halves(squares)).sqrt();
        let [q, at] = view.of_views(across, z, cells);
        let (cell, w) = split(at);
        let [i, j, ..] = cell.to_array().map(|cell| cell as u32 as usize);
        let Some(values) = self.shape.masking_of_two([i, j], w) else {
            return g1_of_nan();
        };
        let g1 = q * values;
        // Where the cast saturates NaN reads cell 0, and the minimum may be 1.
        if cfg!(not(target_feature = "sse2")) && g1.is_nan().any() {
            return g1_of_nan();
        }
        let [g1_v, g1_l, ..] = g1.fast_min(f32x4::ONE).to_array();
        [g1_v, g1_l]
    }

    /// G1 of each view; the slices are of the same length.
    pub(crate) fn g1_all<V: Copy + Into<[f32; 3]>>(self, v: &[V], g1: &mut [f32]) {
        let (mut v, mut g1) = (v, g1);
        let done = widest(Masked { surface: self, v, g1: &mut *g1 });
        (v, g1) = (&v[done..], &mut g1[done..]);
        let done = self.g1_groups::<f32x4, V>(v, g1);
        for (v, g1) in v[done..].iter().zip(&mut g1[done..]) {
            *g1 = self.g1_of_one(vec3(*v));
        }
    }

    /// G1 of all views but those too few to fill lanes; how many they are.
    #[inline(always)]
    fn g1_groups<L: Lanes, V: Copy + Into<[f32; 3]>>(self, v: &[V], g1: &mut [f32]) -> usize {
        let [kx, ky] = self.scales.kappa;
        let kappa = [L::splat(kx), L::splat(ky)];
        for (v, g1) in v.chunks_exact(L::WIDTH).zip(g1.chunks_exact_mut(L::WIDTH)) {
            let lanes = g1_lanes::<L, S, V>(self.shape, kappa, v);
            g1.copy_from_slice(lanes.to_array().as_ref());
        }
        v.len() - v.len() % L::WIDTH
    }
}

/// G1 of each lane's view and shape, whose κσx and κσy are given.
#[inline(always)]
fn g1_lanes<L: Lanes, S: Shapes, V: Copy + Into<[f32; 3]>>(
    shapes: S,
    [kx, ky]: [L; 2],
    w: &[V],
) -> L {
    let (view, cells) = shapes.masking_view();
    let [wx, wy, wz] = components::<L, V>(w);
    let (x, y) = (wx * kx, wy * ky);
    let z = above_zero(wz);
    let across = (x * x + y * y).sqrt();
    let [q, at] = view.of_views(across, z, cells);
    let (cell, w) = split(at);
    let g1 = q * shapes.masking_lanes(cell, w);
    // NaN gives 0 here, too.
    g1.fast_min(L::splat(1.0)) & g1.simd_ge(L::splat(0.0))
}

/// [`Surface::g1_groups`].
struct Masked<'a, S, V> {
    surface: Surface<S>,
    v: &'a [V],
    g1: &'a mut [f32],
}

impl<S: Shape, V: Copy + Into<[f32; 3]>> Work for Masked<'_, S, V> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        self.surface.g1_groups::<L, V>(self.v, self.g1)
    }
}
