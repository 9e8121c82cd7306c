//! Eight lanes by AVX2.
//!
//! Whatever holds a [`F32x8`], or calls its functions, was called by [`run`]: the type is nameable
//! in this module alone, and its parameter `L` stands for it only there.

#[cfg(target_arch = "x86")]
use core::arch::x86::*;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::mem::transmute;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Not, Sub};

use wide::f32x4;

use crate::sealed::Sealed;
use crate::{Ints, Lanes, MOST, Work};

/// Whether the processor has AVX2.
#[inline(always)]
pub(crate) fn are_there() -> bool {
    #[cfg(feature = "std")]
    return std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(feature = "std"))]
    return cfg!(target_feature = "avx2");
}

/// Does the work in eight lanes.
///
/// Not inlined, for callers compile without AVX2.
#[target_feature(enable = "avx2")]
pub(crate) fn run<W: Work>(work: W) -> W::Output {
    work.run::<F32x8>()
}

/// An instruction of AVX2.
macro_rules! avx2 {
    ($call:expr) => {
        // SAFETY: lanes exist only within `run`, whose caller has asked the processor.
        unsafe { $call }
    };
}

#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x8(__m256);

#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct I32x8(__m256i);

impl Sealed for F32x8 {}
impl Sealed for I32x8 {}

macro_rules! operators {
    ($type:ident: $($trait:ident $name:ident $instruction:ident),*) => {$(
        impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(avx2!($instruction(self.0, other.0)))
            }
        }
    )*};
}

operators!(F32x8: Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps,
    Div div _mm256_div_ps, BitAnd bitand _mm256_and_ps, BitXor bitxor _mm256_xor_ps);
operators!(I32x8: Add add _mm256_add_epi32, Sub sub _mm256_sub_epi32,
    Mul mul _mm256_mullo_epi32,
    BitAnd bitand _mm256_and_si256, BitOr bitor _mm256_or_si256);

macro_rules! operators_with_one {
    ($($trait:ident $name:ident),*) => {$(
        impl $trait<f32> for F32x8 {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: f32) -> Self {
                $trait::$name(self, Self::splat(other))
            }
        }
    )*};
}

operators_with_one!(Add add, Sub sub, Mul mul);

impl Not for F32x8 {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        self ^ Self::from_bits(I32x8::splat(-1))
    }
}

impl Default for F32x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl Default for I32x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0)
    }
}

impl F32x8 {
    #[inline(always)]
    fn compare<const HOW: i32>(self, other: Self) -> Self {
        Self(avx2!(_mm256_cmp_ps::<HOW>(self.0, other.0)))
    }

    /// The first two lanes of each quad in turn with another's, and the last two.
    #[inline(always)]
    fn interleaved(self, other: Self) -> (Self, Self) {
        let low = Self(avx2!(_mm256_unpacklo_ps(self.0, other.0)));
        (low, Self(avx2!(_mm256_unpackhi_ps(self.0, other.0))))
    }

    /// The first two lanes of each quad and of another's, and the last two.
    #[inline(always)]
    fn joined(self, other: Self) -> (Self, Self) {
        let low = Self(avx2!(_mm256_shuffle_ps::<0x44>(self.0, other.0)));
        (low, Self(avx2!(_mm256_shuffle_ps::<0xee>(self.0, other.0))))
    }

    /// The first bit of each lane.
    #[inline(always)]
    fn signs(self) -> i32 {
        avx2!(_mm256_movemask_ps(self.0))
    }
}

impl Lanes for F32x8 {
    const WIDTH: usize = MOST;

    type Ints = I32x8;
    type Array = [f32; 8];

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self::from_fn(|_| x)
    }

    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f32) -> Self {
        let lanes = [lane(0), lane(1), lane(2), lane(3), lane(4), lane(5), lane(6), lane(7)];
        // SAFETY: both are eight `f32`.
        unsafe { transmute(lanes) }
    }

    #[inline(always)]
    fn quads(mut quad: impl FnMut(usize) -> f32x4) -> Self {
        // SAFETY: both are eight `f32`.
        unsafe { transmute([quad(0), quad(1)]) }
    }

    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        // SAFETY: both are eight `f32`.
        unsafe { transmute(self) }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(avx2!(_mm256_sqrt_ps(self.0)))
    }

    #[inline(always)]
    fn fast_min(self, other: Self) -> Self {
        Self(avx2!(_mm256_min_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn fast_max(self, other: Self) -> Self {
        Self(avx2!(_mm256_max_ps(self.0, other.0)))
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self {
        self.compare::<_CMP_GT_OQ>(other)
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self {
        self.compare::<_CMP_GE_OQ>(other)
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self {
        self.compare::<_CMP_LT_OQ>(other)
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> Self {
        self.compare::<_CMP_LE_OQ>(other)
    }

    #[inline(always)]
    fn select(self, one: Self, other: Self) -> Self {
        Self(avx2!(_mm256_blendv_ps(other.0, one.0, self.0)))
    }

    #[inline(always)]
    fn any(self) -> bool {
        self.signs() != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.signs() == 0xff
    }

    #[inline(always)]
    fn fast_trunc_int(self) -> I32x8 {
        I32x8(avx2!(_mm256_cvttps_epi32(self.0)))
    }

    #[inline(always)]
    fn from_ints(ints: I32x8) -> Self {
        Self(avx2!(_mm256_cvtepi32_ps(ints.0)))
    }

    #[inline(always)]
    fn to_bits(self) -> I32x8 {
        I32x8(avx2!(_mm256_castps_si256(self.0)))
    }

    #[inline(always)]
    fn from_bits(bits: I32x8) -> Self {
        Self(avx2!(_mm256_castsi256_ps(bits.0)))
    }

    #[inline(always)]
    fn within_quads<const I: i32>(self) -> Self {
        Self(match I {
            0 => avx2!(_mm256_permute_ps::<0x00>(self.0)),
            1 => avx2!(_mm256_permute_ps::<0x55>(self.0)),
            2 => avx2!(_mm256_permute_ps::<0xaa>(self.0)),
            _ => avx2!(_mm256_permute_ps::<0xff>(self.0)),
        })
    }

    #[inline(always)]
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let (ab, ab_high) = a.interleaved(b);
        let (cd, cd_high) = c.interleaved(d);
        let ((a, b), (c, d)) = (ab.joined(cd), ab_high.joined(cd_high));
        [a, b, c, d]
    }
}

impl Ints for I32x8 {
    type Array = [i32; 8];

    #[inline(always)]
    fn splat(x: i32) -> Self {
        // SAFETY: both are eight `i32`.
        unsafe { transmute([x; 8]) }
    }

    #[inline(always)]
    fn to_array(self) -> [i32; 8] {
        // SAFETY: both are eight `i32`.
        unsafe { transmute(self) }
    }

    #[inline(always)]
    fn up<const N: i32>(self) -> Self {
        Self(avx2!(_mm256_slli_epi32::<N>(self.0)))
    }

    #[inline(always)]
    fn down<const N: i32>(self) -> Self {
        Self(avx2!(_mm256_srai_epi32::<N>(self.0)))
    }
}
