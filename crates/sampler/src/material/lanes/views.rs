//! Views in the lanes of SIMD vectors, stretched and located in the table: one for the
//! [fast path](super::one), many for [batches](super::many).

use glam::Vec3;
use microfacet_lanes::{Lanes, f32x4};

use super::swap_pairs;
use crate::material::surface::{LONG, LONGEST, NORMAL_INCIDENCE, SHORT, Shape, Surface};

/// 2⁴⁰: a short horizontal component times this, or a long one over it, has squares in range.
const LIFT: f32 = 1_099_511_627_776.0;

/// A stretched view: x and y in the first two lanes of `xy`, the others in all lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) xy: f32x4,
    /// As in [`Views`].
    pub(crate) frame: f32x4,
    pub(crate) rho: f32x4,
    pub(crate) z: f32x4,
    /// The coordinate in rows, and 1 − τ.
    pub(crate) at: f32x4,
    pub(crate) silhouette: f32x4,
}

/// The fields of [`Views`], for one view whose horizontal component is short or too long.
#[cold]
#[inline(never)]
fn upright(x: f32, y: f32, z: f32) -> [f32; 6] {
    let [x, y, z] = [x, y, z].map(f32x4::splat);
    let Views { x, y, frame, rho, z, length } = Views::new(x, y, z);
    [x, y, frame, rho, z, length].map(|x| x.to_array()[0])
}

impl<S: Shape> Surface<S> {
    #[inline(always)]
    pub(crate) fn view<const HEAVY: bool>(self, v: Vec3) -> View {
        let [sx, sy] = self.scales.sigma;
        let xy = f32x4::new([v.x, v.y, 0.0, 0.0]) * f32x4::new([sx, sy, 0.0, 0.0]);
        View::new::<S, HEAVY>(self.shape, xy, v.z)
    }
}

impl View {
    /// A stretched view, located in the table. `HEAVY` shapes have a peeled table.
    #[inline(always)]
    pub(crate) fn new<S: Shape, const HEAVY: bool>(shape: S, xy: f32x4, z: f32) -> Self {
        let mut z = f32x4::splat(if z > 0.0 { z } else { 0.0 });
        let squares = xy * xy;
        let rho2 = squares + swap_pairs(squares);
        let length2 = rho2 + z * z;
        let (mut xy, mut rho, mut length) = (xy, rho2.sqrt(), length2.sqrt());
        let mut frame = rho;
        if !(rho.to_array()[0] >= SHORT && length2.to_array()[0] <= LONG * LONG) {
            let [x, y, ..] = xy.to_array();
            let [x, y, others @ ..] = upright(x, y, z.to_array()[0]);
            xy = f32x4::new([x, y, 0.0, 0.0]);
            [frame, rho, z, length] = others.map(f32x4::splat);
        }
        let [at, silhouette] = shape.place::<HEAVY, _>(rho, z, length);
        Self { xy, frame, rho, z, at, silhouette }
    }
}

/// Views as [`Stretched`](crate::material::surface::Stretched) is one, and √(ρ² + z²).
#[derive(Clone, Copy, Default)]
pub(crate) struct Views<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) frame: L,
    pub(crate) rho: L,
    pub(crate) z: L,
    pub(crate) length: L,
}

impl<L: Lanes> Views<L> {
    #[inline(always)]
    pub(crate) fn new(x: L, y: L, z: L) -> Self {
        let z = z & z.simd_gt(L::splat(0.0));
        let rho2 = x * x + y * y;
        let length2 = rho2 + z * z;
        let rho = rho2.sqrt();
        let views = Self { x, y, frame: rho, rho, z, length: length2.sqrt() };
        let common = rho.simd_ge(L::splat(SHORT)) & length2.simd_le(L::splat(LONG * LONG));
        if common.all() { views } else { views.of_any_length() }
    }

    /// With a frame whose squares stay in range where the horizontal component is short or long.
    #[inline(always)]
    fn of_any_length(self) -> Self {
        let Self { x, y, rho, .. } = self;
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let z = self.z.fast_min(L::splat(LONGEST));
        let sunk = rho.simd_gt(L::splat(LONG)).select(L::splat(1.0 / LIFT), one);
        let lift = rho.simd_ge(L::splat(SHORT)).select(sunk, L::splat(LIFT));
        // Normal incidence, straight down, NaN or too long: without z > 0 the view is moved to the
        // horizon, as every view below it, with an arbitrary azimuth.
        let least = L::splat(NORMAL_INCIDENCE);
        let tilted = rho.simd_ge(least) & rho.simd_le(L::splat(LONGEST));
        let above = z.simd_gt(zero);
        let rho = tilted.select(rho, above.select(zero, one));
        let z = tilted.select(z, above & z.fast_max(least));
        // The other views keep every bit.
        let common = tilted & self.length.simd_le(L::splat(f32::MAX));
        let length = common.select(self.length, (rho * rho + z * z).sqrt());
        Self {
            x: tilted.select(x * lift, one),
            y: tilted.select(y * lift, zero),
            frame: tilted.select(rho * lift, one),
            rho,
            z,
            length,
        }
    }
}
