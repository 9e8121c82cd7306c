//! The lookups of a [`StudentT`](super::StudentT) in the lanes of SIMD vectors: [`masking`], a
//! normal of [`one`] view with its components in lanes, and of [`many`] views, a lane for each.
//! [`views`] stretches views and locates them in the table.
//!
//! They compute the same as the readable code in [`student_t`](super::student_t); the tests of
//! values and distributions run these.

pub(crate) mod many;
mod masking;
pub(crate) mod one;
pub(crate) mod views;

use glam::Vec3;
use wide::f32x4;

#[inline(always)]
pub(crate) fn first_three(m: f32x4) -> Vec3 {
    let [x, y, z, _] = m.to_array();
    Vec3::new(x, y, z)
}

/// The sum of all lanes, in all lanes.
#[inline(always)]
pub(crate) fn sum(a: f32x4) -> f32x4 {
    let a = a + swap_halves(a);
    a + swap_pairs(a)
}

/// The first two lanes of each.
#[inline(always)]
pub(crate) fn pairs(a: f32x4, b: f32x4) -> f32x4 {
    let ([a0, a1, ..], [b0, b1, ..]) = (a.to_array(), b.to_array());
    f32x4::new([a0, a1, b0, b1])
}

/// The first lane of each, twice.
#[inline(always)]
pub(crate) fn pairs_of_firsts(a: f32x4, b: f32x4) -> f32x4 {
    let ([a, ..], [b, ..]) = (a.to_array(), b.to_array());
    f32x4::new([a, a, b, b])
}

/// Swaps the first two lanes and the last two.
#[inline(always)]
pub(crate) fn swap_halves(a: f32x4) -> f32x4 {
    let [a, b, c, d] = a.to_array();
    f32x4::new([c, d, a, b])
}

/// Swaps the lanes of either pair of neighbours.
#[inline(always)]
pub(crate) fn swap_pairs(a: f32x4) -> f32x4 {
    let [a, b, c, d] = a.to_array();
    f32x4::new([b, a, d, c])
}
