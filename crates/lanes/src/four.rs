//! Four lanes, by `wide`, which every processor has or does without.

use crate::sealed::Sealed;
use crate::{Ints, Lanes};
use wide::{bytemuck, f32x4, i32x4};

impl Sealed for f32x4 {}
impl Sealed for i32x4 {}

/// Functions that `wide` has by the same name.
macro_rules! same {
    ($($name:ident($($other:ident),*));*) => {$(
        #[inline(always)]
        fn $name(self $(, $other: Self)*) -> Self {
            f32x4::$name(self $(, $other)*)
        }
    )*};
}

impl Lanes for f32x4 {
    const WIDTH: usize = 4;

    type Ints = i32x4;
    type Array = [f32; 4];

    #[inline(always)]
    fn splat(x: f32) -> Self {
        f32x4::splat(x)
    }

    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f32) -> Self {
        f32x4::new([lane(0), lane(1), lane(2), lane(3)])
    }

    #[inline(always)]
    fn quads(mut quad: impl FnMut(usize) -> f32x4) -> Self {
        quad(0)
    }

    #[inline(always)]
    fn to_array(self) -> [f32; 4] {
        f32x4::to_array(self)
    }

    same! { sqrt(); fast_min(other); fast_max(other) }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self {
        f32x4::simd_gt(self, other)
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self {
        f32x4::simd_ge(self, other)
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self {
        f32x4::simd_lt(self, other)
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> Self {
        f32x4::simd_le(self, other)
    }

    #[inline(always)]
    fn select(self, one: Self, other: Self) -> Self {
        f32x4::select(self, one, other)
    }

    #[inline(always)]
    fn any(self) -> bool {
        f32x4::any(self)
    }

    #[inline(always)]
    fn all(self) -> bool {
        f32x4::all(self)
    }

    #[inline(always)]
    fn fast_trunc_int(self) -> i32x4 {
        f32x4::fast_trunc_int(self)
    }

    #[inline(always)]
    fn from_ints(ints: i32x4) -> Self {
        f32x4::from_i32x4(ints)
    }

    #[inline(always)]
    fn to_bits(self) -> i32x4 {
        bytemuck::cast(self)
    }

    #[inline(always)]
    fn from_bits(bits: i32x4) -> Self {
        bytemuck::cast(bits)
    }

    #[inline(always)]
    fn within_quads<const I: i32>(self) -> Self {
        f32x4::splat(f32x4::to_array(self)[I as usize])
    }

    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        f32x4::transpose(rows)
    }
}

impl Ints for i32x4 {
    type Array = [i32; 4];

    #[inline(always)]
    fn splat(x: i32) -> Self {
        i32x4::splat(x)
    }

    #[inline(always)]
    fn to_array(self) -> [i32; 4] {
        i32x4::to_array(self)
    }

    #[inline(always)]
    fn up<const N: i32>(self) -> Self {
        self << N
    }

    #[inline(always)]
    fn down<const N: i32>(self) -> Self {
        self >> N
    }
}
