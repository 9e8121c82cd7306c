//! GGX in the lanes of SIMD vectors, over whole slices: normals by spherical caps, and G1. The
//! formulas are those of [`ggx`](mod@ggx).
//!
//! Written as for a renderer that has its choice of instructions: a few shuffles turn an array of
//! vectors into components and back, the sine is a polynomial, nothing branches, and a product is
//! fused with a sum where the processor can. A normal takes 12 instructions with AVX2 and 30 with
//! SSE4.2. No closure computes in lanes: one that is not inlined is compiled for any processor.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x4, f32x8};
use glam::Vec3;

use super::elementary::SINE;
use super::ggx;
use crate::rival::{Draw, Evaluate};

/// How many lanes a vector has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    /// SSE4.2, or NEON.
    Four,
    /// AVX2.
    Eight,
}

impl Width {
    /// The instructions for it; `None` where the processor has none.
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    fn level(self) -> Option<Level> {
        let best = Level::new();
        match self {
            Self::Four => best.as_sse4_2().map(Level::Sse4_2),
            Self::Eight => best.as_avx2().map(Level::Avx2),
        }
    }

    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    fn level(self) -> Option<Level> {
        let best = Level::new();
        (self == Self::Four && !best.is_fallback()).then_some(best)
    }
}

/// Visible normals by spherical caps.
pub(crate) fn caps<'a>(width: Width, sigma: f32) -> Option<Draw<'a>> {
    let level = width.level()?;
    Some(Box::new(move |v, u, m| match width {
        Width::Four => dispatch!(level, simd => caps_of::<_, f32x4<_>>(simd, sigma, v, u, m)),
        Width::Eight => dispatch!(level, simd => caps_of::<_, f32x8<_>>(simd, sigma, v, u, m)),
    }))
}

/// Masking.
pub(crate) fn g1<'a>(width: Width, sigma: f32) -> Option<Evaluate<'a>> {
    let level = width.level()?;
    Some(Box::new(move |w, g1| match width {
        Width::Four => dispatch!(level, simd => g1_of::<_, f32x4<_>>(simd, sigma, w, g1)),
        Width::Eight => dispatch!(level, simd => g1_of::<_, f32x8<_>>(simd, sigma, w, g1)),
    }))
}

#[inline(always)]
fn caps_of<S: Simd, F: Lanes<S>>(simd: S, sigma: f32, v: &[Vec3], u: &[[f32; 2]], m: &mut [Vec3]) {
    let (mut v, mut u, mut m) =
        (v.chunks_exact(F::LEN), u.chunks_exact(F::LEN), m.chunks_exact_mut(F::LEN));
    for ((v, u), m) in (&mut v).zip(&mut u).zip(&mut m) {
        let v: [F; 3] = components(simd, v);
        join(simd, normal(simd, sigma, v, pairs(simd, u)), m);
    }
    for ((v, u), m) in v.remainder().iter().zip(u.remainder()).zip(m.into_remainder()) {
        *m = ggx::single::caps(sigma, *v, *u);
    }
}

#[inline(always)]
fn g1_of<S: Simd, F: Lanes<S>>(simd: S, sigma: f32, w: &[Vec3], g1: &mut [f32]) {
    let (mut w, mut g1) = (w.chunks_exact(F::LEN), g1.chunks_exact_mut(F::LEN));
    for (w, g1) in (&mut w).zip(&mut g1) {
        let [x, y, z] = components::<S, F>(simd, w);
        let (x, y) = (x * sigma, y * sigma);
        let root = x.mul_add(x, y.mul_add(y, z * z)).sqrt();
        ((z + z) / (z + root)).store_slice(g1);
    }
    for (w, g1) in w.remainder().iter().zip(g1.into_remainder()) {
        *g1 = ggx::g1(sigma, *w);
    }
}

#[inline(always)]
fn normal<S: Simd, F: Lanes<S>>(simd: S, sigma: f32, [x, y, z]: [F; 3], u: [F; 2]) -> [F; 3] {
    let (x, y) = (x * sigma, y * sigma);
    let square = x.mul_add(x, y.mul_add(y, z * z));
    let height = (F::splat(simd, 1.0) - u[1]) * (square.sqrt() + z);
    let above = height - z;
    let radius = (square - above * above).max(F::splat(simd, 0.0)).sqrt();
    let turn = F::splat(simd, 0.5) - u[0];
    let quarter = turn.abs() - 0.25;
    let sin = sine(simd, (F::splat(simd, 0.25) - quarter.abs()).copysign(turn));
    let (x, y) = (radius.mul_add(sine(simd, quarter), x) * sigma, radius.mul_add(sin, y) * sigma);
    let r = F::splat(simd, 1.0) / x.mul_add(x, y.mul_add(y, height * height)).sqrt();
    [x * r, y * r, height * r]
}

/// The sine of up to a quarter of a turn.
#[inline(always)]
fn sine<S: Simd, F: Lanes<S>>(simd: S, x: F) -> F {
    let (a, b) = (F::splat(simd, SINE[0]), F::splat(simd, SINE[1]));
    let (c, d, e) = (F::splat(simd, SINE[2]), F::splat(simd, SINE[3]), F::splat(simd, SINE[4]));
    let square = x * x;
    x * e.mul_add(square, d).mul_add(square, c).mul_add(square, b).mul_add(square, a)
}

/// Vectors of blocks of four lanes.
trait Lanes<S: Simd>: SimdFloat<S, Element = f32> {
    /// Of each block its numbers.
    fn from_blocks(simd: S, block: impl Fn(usize) -> [f32; 4]) -> Self;
    fn to_blocks(self, block: impl FnMut(usize, [f32; 4]));
}

impl<S: Simd> Lanes<S> for f32x4<S> {
    #[inline(always)]
    fn from_blocks(simd: S, block: impl Fn(usize) -> [f32; 4]) -> Self {
        block(0).simd_into(simd)
    }

    #[inline(always)]
    fn to_blocks(self, mut block: impl FnMut(usize, [f32; 4])) {
        block(0, self.to_array());
    }
}

impl<S: Simd> Lanes<S> for f32x8<S> {
    #[inline(always)]
    fn from_blocks(simd: S, block: impl Fn(usize) -> [f32; 4]) -> Self {
        f32x4::simd_from(simd, block(0)).combine(f32x4::simd_from(simd, block(1)))
    }

    #[inline(always)]
    fn to_blocks(self, mut block: impl FnMut(usize, [f32; 4])) {
        let (low, high) = self.split();
        block(0, low.to_array());
        block(1, high.to_array());
    }
}

/// The components of four or eight vectors. Four are three blocks, x₀y₀z₀x₁ y₁z₁x₂y₂ z₂x₃y₃z₃, and
/// each component has lanes of its own in each: they are put together and permuted. The compiler
/// reads a block at once.
#[inline(always)]
fn components<S: Simd, F: Lanes<S>>(simd: S, v: &[Vec3]) -> [F; 3] {
    let four = |i: usize| &v[4 * i..4 * i + 4];
    let a = F::from_blocks(simd, |i| {
        let v = four(i);
        [v[0].x, v[0].y, v[0].z, v[1].x]
    });
    let b = F::from_blocks(simd, |i| {
        let v = four(i);
        [v[1].y, v[1].z, v[2].x, v[2].y]
    });
    let c = F::from_blocks(simd, |i| {
        let v = four(i);
        [v[2].z, v[3].x, v[3].y, v[3].z]
    });
    ordered(simd, [mix(simd, [a, c, b]), mix(simd, [b, a, c]), mix(simd, [c, b, a])])
}

/// The inverse of [`components`].
#[inline(always)]
fn join<S: Simd, F: Lanes<S>>(simd: S, components: [F; 3], v: &mut [Vec3]) {
    let [x, y, z] = ordered(simd, components);
    mix(simd, [x, y, z]).to_blocks(|i, block| {
        let v = &mut v[4 * i..4 * i + 4];
        [v[0].x, v[0].y, v[0].z, v[1].x] = block;
    });
    mix(simd, [y, z, x]).to_blocks(|i, block| {
        let v = &mut v[4 * i..4 * i + 4];
        [v[1].y, v[1].z, v[2].x, v[2].y] = block;
    });
    mix(simd, [z, x, y]).to_blocks(|i, block| {
        let v = &mut v[4 * i..4 * i + 4];
        [v[2].z, v[3].x, v[3].y, v[3].z] = block;
    });
}

/// The first and second numbers of four or eight pairs.
#[inline(always)]
fn pairs<S: Simd, F: Lanes<S>>(simd: S, u: &[[f32; 2]]) -> [F; 2] {
    let two = |i: usize| [u[i][0], u[i][1], u[i + 1][0], u[i + 1][1]];
    let a = F::from_blocks(simd, |i| two(4 * i));
    let b = F::from_blocks(simd, |i| two(4 * i + 2));
    let (a, b) = (permuted(simd, a, [0, 2, 1, 3]), permuted(simd, b, [1, 3, 0, 2]));
    const LOW: [bool; 4] = [true, true, false, false];
    [pick(simd, LOW, a, b), permuted(simd, pick(simd, LOW, b, a), [2, 3, 0, 1])]
}

/// Per block, the first and the last lane of a, the second of b and the third of c.
#[inline(always)]
fn mix<S: Simd, F: Lanes<S>>(simd: S, [a, b, c]: [F; 3]) -> F {
    pick(simd, [true, false, false, true], a, pick(simd, [false, true, false, false], b, c))
}

/// Permutations that are their own inverses.
#[inline(always)]
fn ordered<S: Simd, F: Lanes<S>>(simd: S, [x, y, z]: [F; 3]) -> [F; 3] {
    let (x, y) = (permuted(simd, x, [0, 3, 2, 1]), permuted(simd, y, [1, 0, 3, 2]));
    [x, y, permuted(simd, z, [2, 1, 0, 3])]
}

/// Per block, the lanes of a where `first`, else of b.
#[inline(always)]
fn pick<S: Simd, F: Lanes<S>>(simd: S, first: [bool; 4], a: F, b: F) -> F {
    let mut bits = 0;
    for i in 0..F::LEN {
        bits |= u64::from(first[i % 4]) << i;
    }
    F::Mask::from_bitmask(simd, bits).select(a, b)
}

/// Per block, the lanes of these numbers.
#[inline(always)]
fn permuted<S: Simd, F: Lanes<S>>(simd: S, a: F, order: [u8; 4]) -> F {
    let mut bytes = [0; 32];
    for (i, byte) in bytes.iter_mut().enumerate() {
        *byte = 4 * order[i % 16 / 4] + (i % 4) as u8;
    }
    a.swizzle_dyn_within_blocks(F::ByteVector::from_slice(simd, &bytes[..4 * F::LEN]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::Inputs;

    /// Slices that fill vectors, and that leave a rest.
    const COUNTS: [usize; 4] = [4096, 7, 3, 0];

    #[test]
    fn lanes_agree_with_one_at_a_time() {
        let mut tried = 0;
        for (width, sigma) in [Width::Four, Width::Eight].into_iter().zip([0.3, 0.5]) {
            let (Some(normals), Some(masking)) = (caps(width, sigma), g1(width, sigma)) else {
                continue;
            };
            for count in COUNTS {
                let Inputs { views, numbers } = Inputs::new(3, count);
                let mut m = vec![Vec3::ZERO; count];
                normals(&views, &numbers, &mut m);
                let mut values = vec![0.0; count];
                masking(&views, &mut values);
                for (((v, u), m), masked) in views.iter().zip(&numbers).zip(&m).zip(&values) {
                    let want = ggx::single::caps(sigma, *v, *u);
                    // A root next to 0, at the ends of a cap, magnifies roundings of its argument.
                    assert!(want.abs_diff_eq(*m, 5e-6), "{width:?} {v} {u:?}: {m} for {want}");
                    let want = ggx::g1(sigma, *v);
                    assert!((masked - want).abs() < 3e-7, "{width:?} {v}: {masked} for {want}");
                }
                tried += count;
            }
        }
        assert!(tried > 0 || !cfg!(any(target_arch = "x86_64", target_arch = "aarch64")));
    }
}
