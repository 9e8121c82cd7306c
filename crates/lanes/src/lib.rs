//! Code over `f32` that is written once and runs in as many SIMD lanes as the processor has: 4, or
//! 8 with AVX2.
//!
//! [`wide`] chooses its instructions when it is compiled, so that a program for every processor
//! would keep to 4 lanes. Here code is generic over [`Lanes`], and [`widest`] runs it in the most
//! that there are. The operations are those that every width rounds alike, lane by lane: a result
//! has the same bits whatever the width.
//!
//! The type of 8 lanes has no public name. Code meets it only as the parameter of [`Work::run`],
//! which is called after the processor was asked: that the type is there proves that its
//! instructions are, so that its functions are safe.
//!
//! ```
//! use microfacet_lanes::{Lanes, Work, widest};
//!
//! struct Roots<'a>(&'a mut [f32]);
//!
//! impl Work for Roots<'_> {
//!     type Output = usize;
//!
//!     #[inline(always)]
//!     fn run<L: Lanes>(self) -> usize {
//!         for x in self.0.chunks_exact_mut(L::WIDTH) {
//!             let roots = L::from_fn(|i| x[i]).sqrt().to_array();
//!             x.iter_mut().enumerate().for_each(|(i, x)| *x = roots[i]);
//!         }
//!         L::WIDTH
//!     }
//! }
//!
//! let mut x = [4.0; 16];
//! let width = widest(Roots(&mut x));
//! assert!([4, 8].contains(&width) && x == [2.0; 16]);
//! ```
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod eight;
mod four;

use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Index, Mul, Not, Sub};

pub use wide::{f32x4, i32x4};

/// The most lanes that there are.
pub const MOST: usize = 8;

/// Work on `f32` in lanes.
pub trait Work {
    /// What it returns.
    type Output;

    /// Does the work, in lanes of type `L`.
    ///
    /// It, and all functions in it that use lanes, must be `#[inline(always)]` to be fast: only
    /// what becomes part of the caller is compiled for the processor. Closures are not inlined
    /// always, nor is `map` of arrays: neither should compute in lanes.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does the work in the most lanes that the processor has.
///
/// Without the feature `std` that is what the program is compiled for.
#[inline(always)]
pub fn widest<W: Work>(work: W) -> W::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if eight::are_there() {
        // SAFETY: the processor has AVX2.
        return unsafe { eight::run(work) };
    }
    work.run::<f32x4>()
}

mod sealed {
    /// Lanes elsewhere could come without the proof that the processor has them.
    pub trait Sealed {}
}

/// Some `f32`, on each of which the same is done. The names are those of [`wide`].
///
/// Lanes are in *quads* of four, within which they can change places.
pub trait Lanes:
    sealed::Sealed
    + Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + BitAnd<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// How many there are, a multiple of four.
    const WIDTH: usize;

    /// As many `i32`.
    type Ints: Ints;
    /// As many `f32` in memory.
    type Array: Copy + Index<usize, Output = f32> + AsRef<[f32]>;

    /// One number in all lanes.
    fn splat(x: f32) -> Self;
    /// The numbers by lane.
    fn from_fn(lane: impl FnMut(usize) -> f32) -> Self;
    /// The numbers by quad.
    fn quads(quad: impl FnMut(usize) -> f32x4) -> Self;
    /// The numbers in memory.
    fn to_array(self) -> Self::Array;

    /// The square root, rounded correctly.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The smaller number, of a pair with NaN either.
    #[must_use]
    fn fast_min(self, other: Self) -> Self;
    /// The larger number, of a pair with NaN either.
    #[must_use]
    fn fast_max(self, other: Self) -> Self;

    /// All ones where the number is larger, and all zeros elsewhere.
    #[must_use]
    fn simd_gt(self, other: Self) -> Self;
    /// All ones where the number is larger or equal.
    #[must_use]
    fn simd_ge(self, other: Self) -> Self;
    /// All ones where the number is smaller.
    #[must_use]
    fn simd_lt(self, other: Self) -> Self;
    /// All ones where the number is smaller or equal.
    #[must_use]
    fn simd_le(self, other: Self) -> Self;
    /// `one` where this is all ones, and `other` where it is all zeros.
    #[must_use]
    fn select(self, one: Self, other: Self) -> Self;
    /// Whether any lane of all ones is there.
    fn any(self) -> bool;
    /// Whether all lanes are all ones.
    fn all(self) -> bool;

    /// The whole part as the processor's own conversion gives it, which is arbitrary for NaN and
    /// what is out of range.
    fn fast_trunc_int(self) -> Self::Ints;
    /// The nearest floats.
    fn from_ints(ints: Self::Ints) -> Self;
    /// The same bits.
    fn to_bits(self) -> Self::Ints;
    /// The same bits.
    fn from_bits(bits: Self::Ints) -> Self;

    /// The lane `I` of each quad in all lanes of that quad.
    #[must_use]
    fn within_quads<const I: i32>(self) -> Self;
    /// Rows to columns, in each quad.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// The columns of rows of four, of which each lane has one.
    #[inline(always)]
    fn columns(mut row: impl FnMut(usize) -> f32x4) -> [Self; 4] {
        Self::transpose([
            Self::quads(|quad| row(4 * quad)),
            Self::quads(|quad| row(4 * quad + 1)),
            Self::quads(|quad| row(4 * quad + 2)),
            Self::quads(|quad| row(4 * quad + 3)),
        ])
    }
    /// The columns of rows between two, linear in w, of which each lane has one.
    #[inline(always)]
    fn columns_between(
        low: impl Fn(usize) -> f32x4,
        high: impl Fn(usize) -> f32x4,
        w: Self,
    ) -> [Self; 4] {
        Self::transpose([
            rows_between(&low, &high, 0, w.within_quads::<0>()),
            rows_between(&low, &high, 1, w.within_quads::<1>()),
            rows_between(&low, &high, 2, w.within_quads::<2>()),
            rows_between(&low, &high, 3, w.within_quads::<3>()),
        ])
    }
}

/// The row `i` of each quad, linear in w between two.
#[inline(always)]
fn rows_between<L: Lanes>(
    low: &impl Fn(usize) -> f32x4,
    high: &impl Fn(usize) -> f32x4,
    i: usize,
    w: L,
) -> L {
    let low = L::quads(|quad| low(4 * quad + i));
    let high = L::quads(|quad| high(4 * quad + i));
    low + w * (high - low)
}

/// Some `i32`, on each of which the same is done.
pub trait Ints:
    sealed::Sealed
    + Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
{
    /// As many `i32` in memory.
    type Array: Copy + Index<usize, Output = i32> + AsRef<[i32]>;

    /// One number in all lanes.
    fn splat(x: i32) -> Self;
    /// The numbers in memory.
    fn to_array(self) -> Self::Array;
    /// The bits moved up by N, zeros below.
    #[must_use]
    fn up<const N: i32>(self) -> Self;
    /// The bits moved down by N, the sign's above.
    #[must_use]
    fn down<const N: i32>(self) -> Self;
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::*;

    /// The bits of every operation on pairs of numbers.
    struct Everything<'a>(&'a [[f32; 2]]);

    impl Work for Everything<'_> {
        type Output = (usize, Vec<Vec<u32>>);

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let mut all = Vec::new();
            for pairs in self.0.chunks_exact(8) {
                let mut results = Vec::new();
                for pairs in pairs.chunks_exact(L::WIDTH) {
                    let (a, b) = (L::from_fn(|i| pairs[i][0]), L::from_fn(|i| pairs[i][1]));
                    let quads =
                        L::quads(|quad| f32x4::new([0, 1, 2, 3].map(|i| pairs[4 * quad + i][0])));
                    let (bits, other) = (a.to_bits(), b.to_bits());
                    let [c, d, e, f] = L::transpose([a, b, a + b, a - b]);
                    let [g, h, i, j] = L::columns_between(
                        |i| f32x4::splat(pairs[i][0]),
                        |i| f32x4::new([pairs[i][1], 1.0, 2.0, 3.0]),
                        b,
                    );
                    let floats = [
                        a + b,
                        a - b,
                        a * b,
                        a / b,
                        a + 0.1,
                        a - 0.1,
                        a * 0.1,
                        a & b,
                        a ^ b,
                        !a,
                        a.sqrt(),
                        a.fast_min(b),
                        a.fast_max(b),
                        a.simd_gt(b),
                        a.simd_ge(b),
                        a.simd_lt(b),
                        a.simd_le(b),
                        a.simd_lt(b).select(a, b),
                        quads,
                        L::from_ints(bits),
                        L::from_bits(bits + other),
                        L::from_bits(bits - other),
                        L::from_bits(bits * other),
                        L::from_bits(bits & other),
                        L::from_bits(bits | other),
                        L::from_bits(bits.up::<7>()),
                        L::from_bits(bits.down::<7>()),
                        L::from_bits(a.fast_trunc_int()),
                        a.within_quads::<0>(),
                        a.within_quads::<1>(),
                        a.within_quads::<2>(),
                        a.within_quads::<3>(),
                        c,
                        d,
                        e,
                        f,
                        g,
                        h,
                        i,
                        j,
                        L::splat(0.7),
                        L::default(),
                        L::from_bits(L::Ints::splat(7) + L::Ints::default()),
                    ];
                    results.push(floats.map(|x| x.to_array().as_ref().to_vec()));
                    assert_eq!(a.simd_lt(b).any(), pairs[..L::WIDTH].iter().any(|[a, b]| a < b));
                    assert_eq!(a.simd_lt(b).all(), pairs[..L::WIDTH].iter().all(|[a, b]| a < b));
                }
                for operation in 0..results[0].len() {
                    let lanes = results.iter().flat_map(|part| &part[operation]);
                    // Which NaN it is does not matter.
                    let bits = |x: &f32| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() };
                    all.push(lanes.map(bits).collect());
                }
            }
            (L::WIDTH, all)
        }
    }

    #[test]
    fn every_operation_has_the_same_bits_in_all_widths() {
        const NUMBERS: [f32; 13] = [
            0.0,
            -0.0,
            1.0,
            -1.5,
            0.3,
            1e-40,
            -3e38,
            7e9,
            2.5,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
            f32::MIN_POSITIVE,
        ];
        // Every pair, in different neighbourhoods.
        let pair = |i: usize| [NUMBERS[i % 13], NUMBERS[i / 13 % 13]];
        let mut pairs: Vec<_> = (0..13 * 13 * 8).map(pair).collect();
        // And groups of which all are less.
        pairs.extend([[0.0, 1.0]; 8]);
        let (four, want) = Everything(&pairs).run::<f32x4>();
        let (width, got) = widest(Everything(&pairs));
        assert_eq!(four, 4);
        for (i, (got, want)) in got.iter().zip(&want).enumerate() {
            assert_eq!(got, want, "operation {}", i % 43);
        }
        #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64")))]
        assert_eq!(width == 8, std::arch::is_x86_feature_detected!("avx2"));
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        assert_eq!(width, 4);
    }
}
