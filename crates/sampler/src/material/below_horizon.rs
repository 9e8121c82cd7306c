//! In-plane slopes seen from below the lobe's horizon, as only a skewed lobe can be: x > a with
//! density ∝ (x − a) p(x).
//!
//! No table holds them; they are drawn by rejection. With (1 + s x²)^(−k) = (1 + s a²)^(−k) e^(−y)
//! the density is e^(−y) (1 − a/x(y)), whose second factor is concave, so that either an
//! exponential or a gamma variate bounds it tightly.

use alloc::vec::Vec;
use core::f32::consts::LN_2;

use wide::f32x4;

use microfacet_core::math::{sqrt, unit};
use microfacet_tables::axis::half_tangent::Slope;
use microfacet_tables::axis::hermite::{Cell, cubic_cells, horner, locate};

use super::slices::Slices;
use super::surface::{Shape, Stretched};
use crate::elementary::{exp2, log2, scaled_expm1_over};

/// Up to this a the excess is a difference of values from the shadowing table, which loses digits
/// beyond it.
const NEAR: f32 = 0.8;
const CELLS: usize = 32;
/// Larger a are clamped to this one, whose square is within the range of f32.
const DEEPEST: f32 = 1e15;

/// E[(X−a)⁺]/E[X; X>a] = (1 + s a²)/(2a²)·₂F₁(1, 3/2; 1+1/s; −1/(s a²)) of one shape, for a ≥
/// [`NEAR`]: cubics over 1/a², prepared once for a lobe, since the series takes a hundred terms.
#[derive(Clone, Debug)]
pub(crate) struct ExcessShare(Vec<Cell>);

impl ExcessShare {
    pub(crate) fn new(s: f64) -> Self {
        let reach = 1.0 / (f64::from(NEAR) * f64::from(NEAR));
        // Over w = 1/a², in which the share is regular at w = 0; slopes by differences over halves
        // of a cell.
        let at = |halves: i32| {
            let w = reach * f64::from(halves) / (2 * CELLS) as f64;
            0.5 * (s + w) / continued_fraction(s, w)
        };
        let values: Vec<f64> = (-2..=2 * CELLS as i32 + 2).map(|i| at(i.max(0))).collect();
        let node = |i: usize| {
            let f = &values[2 * i..2 * i + 5];
            let slope = match i {
                // The function is not continued to negative w.
                0 => 4.0 * f[3] - 3.0 * f[2] - f[4],
                _ => (8.0 * (f[3] - f[1]) - (f[4] - f[0])) / 6.0,
            };
            [f[2] as f32, slope as f32]
        };
        let nodes: Vec<_> = (0..=CELLS).map(node).collect();
        Self(cubic_cells(&nodes, 1.0))
    }

    /// For a ≥ [`NEAR`], given 1/a².
    fn at(&self, w: f32) -> f32 {
        let (cell, w) = locate(w * (NEAR * NEAR * CELLS as f32), CELLS);
        horner(&self.0[cell], w)
    }
}

/// The slopes greater than a, of a shape.
pub(crate) struct SlopeBelowHorizon<'a> {
    slices: &'a Slices,
    a: f32,
}

impl<'a> SlopeBelowHorizon<'a> {
    /// For a view `rho` across and `depth` ≥ 0 below the horizon of the lobe.
    pub(crate) fn new(slices: &'a Slices, rho: f32, depth: f32) -> Self {
        Self { slices, a: (depth / rho).min(DEEPEST) }
    }

    /// ∫ (x − a)⁺ p(x) dx.
    pub(crate) fn excess(&self, share: &ExcessShare) -> f32 {
        let Self { slices, a } = *self;
        if a > NEAR {
            // ∫ₐ^∞ x p(x) dx = M₀ (1 + s a²)^(−k), and k = 1/s − ½.
            let exponent = (0.5 * slices.s - 1.0) * slices.normals.law.log2_growth(a * a);
            // Products with a smaller number would be subnormal, and slow.
            let decay = exp2(f32x4::splat(exponent.max(-100.0))).to_array()[0];
            return slices.first_moment() * decay * share.at(1.0 / (a * a));
        }
        // E[(X−a)⁺] = E[(X+a)⁺] − a.
        let above = Stretched { x: 1.0, y: 0.0, frame: 1.0, rho: 1.0, z: a };
        1.0 / slices.inverse_area(&above) - a
    }

    /// A slope, from a first random number in [0, 1) and as many more as needed.
    pub(crate) fn sample(&self, u: f32, more: &mut Numbers) -> Slope {
        let (a, s) = (self.a, self.slices.s);
        let base = 1.0 + s * a * a;
        // (1/s + a²)(e^(y/k) − 1) with 1/k = 2s/(2−s); y·2/(2−s) in the limit s = 0.
        let rate = 2.0 / (2.0 - s);
        let grow = |y: f32| scaled_expm1_over(s, rate * y, base);
        // 1 − a/x ≤ min(1, b y).
        let b = 0.5 * rate * base / (a * a);
        let mut first = unit(u);
        loop {
            let second = if b < 1.0 { more.next() } else { 0.0 };
            let [one, two, ..] = log2(f32x4::new([1.0 - first, 1.0 - second, 1.0, 1.0])).to_array();
            let y = -LN_2 * (one + two);
            let bound = if b < 1.0 { b * y } else { 1.0 };
            // u = 1 is an infinite slope.
            let added = grow(y);
            if !(added < 1e37) {
                return Slope { x: 1.0, z: 0.0 };
            }
            let x = sqrt(a * a + added);
            // x − a without cancellation.
            if more.next() * bound * x <= added / (x + a) {
                let r = 1.0 / (1.0 + x);
                return Slope { x: x * r, z: r };
            }
            first = more.next();
        }
    }
}

/// Gauss's continued fraction of 1/₂F₁(1, 3/2; 1+1/s; −w/s), written so that s = 0 is regular.
///
/// All terms are positive; it takes about 100 of them at w = 1.6, and few for small w.
fn continued_fraction(s: f64, w: f64) -> f64 {
    let (mut f, mut c, mut d, mut n) = (1.0, 1.0, 0.0, 0.0);
    for _ in 0..500 {
        let odd = (1.5 + n) * (1.0 + n * s) / ((1.0 + 2.0 * n * s) * (1.0 + s + 2.0 * n * s)) * w;
        n += 1.0;
        let even =
            n * (1.0 + s * (n - 1.5)) / ((1.0 + s * (2.0 * n - 1.0)) * (1.0 + 2.0 * n * s)) * w;
        let mut change = 1.0;
        for term in [odd, even] {
            d = 1.0 / (1.0 + term * d);
            c = 1.0 + term / c;
            f *= c * d;
            change *= c * d;
        }
        if change > 1.0 - 1e-12 && change < 1.0 + 1e-12 {
            break;
        }
    }
    f
}

/// Further random numbers in [0, 1), a function of the two that the caller gave (splitmix64).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(u: [f32; 2]) -> Self {
        // Clamped first, so that numbers outside [0, 1] and NaN give the sequence of the end.
        let [a, b] = u.map(|u| u64::from(unit(u).to_bits()));
        Self(a << 32 | b)
    }

    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 40) as f32 / (1_u32 << 24) as f32
    }
}
