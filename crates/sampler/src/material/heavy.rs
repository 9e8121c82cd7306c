//! The part of the visible normals that a peeled table lacks: for γ near 3/2 the slopes towards the
//! viewer have a tail too heavy for a table, but one whose CDF has a closed form.
//!
//! The first random number chooses between the table and the tail by their shares of the visible
//! area. The share of the tail is M₀ρ/area, the term x sin θ p(x) for x > 0, with M₀ = κ/(G1/q at
//! grazing); a lobe tabulates it over the view coordinate of the table, so that it needs neither a
//! division nor a root. A single sample branches between table and tail; lanes compute both and
//! select.

use alloc::vec::Vec;

use microfacet_core::math::unit;
use microfacet_lanes::{Lanes, f32x4};
use microfacet_tables::axis::hermite::{
    Cell, coefficients, cubic, cubic_lanes, cubic_through_thirds, split,
};

use crate::elementary::{exp2, log2};

/// Cells of the share for each row of the table: its transition near normal incidence narrows as
/// γ → 3/2, and two cells a row follow it to 4e-6 at γ = 1.501.
pub(super) const CELLS_PER_ROW: usize = 2;

/// The cells of the share at view coordinates in rows, and the positions in them.
#[inline(always)]
pub(super) fn cell_of_share<L: Lanes>(at: L) -> (L::Ints, L) {
    split(at * CELLS_PER_ROW as f32)
}

/// The cells of a function of t ∈ [0, 1], for a table of `rows` cells.
pub(super) fn cells_of_share(rows: usize, of: impl Fn(f64) -> f64) -> Vec<Cell> {
    let cells = CELLS_PER_ROW * rows;
    // Through four points of each cell: the share has kinks at the knots of the view's axis, which
    // are ends of cells.
    let cell = |i: usize| {
        let [a, b, c, d] = [0.0, 1.0, 2.0, 3.0]
            .map(|thirds| of(((i as f64 + thirds / 3.0) / cells as f64).min(1.0)));
        cubic_through_thirds([a, b, c, d]).map(|x| x as f32)
    };
    let mut all: Vec<Cell> = (0..cells).map(cell).collect();
    all.push([of(1.0) as f32, 0.0, 0.0, 0.0]);
    all
}

/// The heavy part of a lobe, for all views.
#[derive(Clone, Debug, Default)]
pub(crate) struct Heavy {
    /// The share of the visible area, by cell of the view coordinate.
    pub(crate) shares: Vec<Cell>,
    pub(crate) tail: Tail,
}

/// The slopes of the heavy part.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tail {
    /// 1/(2γ−3).
    pub(crate) exponent: f32,
    pub(crate) root_s: f32,
}

impl Heavy {
    /// From its `share` of the visible area at t ∈ [0, 1], for a table of `rows` cells.
    pub(crate) fn new(gamma: f64, s: f64, rows: usize, share: impl Fn(f64) -> f64) -> Self {
        let exponent = (1.0 / (2.0 * gamma - 3.0)) as f32;
        let shares = cells_of_share(rows, share);
        Self { shares, tail: Tail { exponent, root_s: libm::sqrt(s) as f32 } }
    }

    /// The share at a view coordinate in rows, to rounding in [0, 1].
    #[inline(always)]
    pub(crate) fn share(&self, at: f32) -> f32 {
        let (cell, w) = cell_of_share(f32x4::splat(at));
        let cell = self.shares.get(cell.to_array()[0] as u32 as usize);
        cell.map_or(0.0, |cell| cubic(cell, w.to_array()[0]))
    }

    /// The shares at view coordinates in rows.
    #[inline(always)]
    pub(crate) fn shares<L: Lanes>(&self, at: L) -> L {
        let (cell, w) = cell_of_share(at);
        cubic_lanes(coefficients(&self.shares, cell), w)
    }
}

impl Tail {
    /// See [`half_slopes`].
    #[inline(always)]
    pub(crate) fn in_lanes<L: Lanes>(&self) -> [L; 2] {
        [L::splat(self.exponent), L::splat(self.root_s)]
    }
}

/// Half of x, and z, of the heavy part's slopes x : z at numbers descending from 1 to 0, and a
/// factor on z.
///
/// The factor is kept apart until normals are of unit length: slopes of 10³⁰ occur, and
/// products of z would be subnormal, each of which costs as much as a whole sample.
#[inline(always)]
pub(crate) fn half_slopes<L: Lanes>(number: L, [exponent, root_s]: [L; 2]) -> [L; 3] {
    // (1 + s x²)^(−k) = ξ, so 1/√(1 + s x²) = ξ^(1/2k) = ζ and (x : 1) = (√(1−ζ²) : √s ζ).
    const LEAST: f32 = 1e-15;
    // For ζ below 2⁻¹⁰⁰ every normal has the smallest cosine.
    let zeta = exp2((log2(number) * exponent).fast_max(L::splat(-100.0)));
    let x = ((L::splat(1.0) - zeta) * (zeta + 1.0)).fast_max(L::splat(0.0)).sqrt();
    let large = zeta.fast_max(L::splat(LEAST));
    [x * 0.5, large * root_s, zeta / large]
}

/// The number of the slope x : z of the heavy part, x > 0, z ≥ 0: the share of its slopes that are
/// steeper, to 1e-7 absolute.
#[inline(always)]
pub(crate) fn number_above<L: Lanes>([x, z]: [L; 2], [exponent, root_s]: [L; 2]) -> L {
    /// Of steeper slopes the square is out of range; the number counts as 0.
    const STEEPEST: f32 = 1e18;
    let steepest = L::splat(STEEPEST);
    let slope = (x / z).fast_min(steepest);
    let scaled = slope * root_s;
    // (1 + s x²)^(−k), with the exponent 1/2k.
    let number = exp2(log2(scaled * scaled + 1.0) * (L::splat(-0.5) / exponent));
    slope.simd_lt(steepest) & number
}

/// A random number along the plane of incidence, within the part of the distribution that it
/// selects.
pub(crate) enum Part {
    Tabulated(f32),
    Heavy(f32),
}

impl Part {
    /// Splits u between the tabulated part, which comes first, and the heavy one.
    #[inline(always)]
    pub(crate) fn of(u: f32, share: f32) -> Self {
        let (u, rest) = (unit(u), 1.0 - share);
        // Straight from above the heavy part has no share, and u = 1 still belongs to the table.
        if u > rest { Self::Heavy(((1.0 - u) / share).min(1.0)) } else { Self::Tabulated(u / rest) }
    }

    /// The same from an area that is heavy and one that is not.
    #[inline(always)]
    pub(crate) fn of_areas(u: f32, heavy: f32, rest: f32) -> Self {
        let (u, whole) = (unit(u), heavy + rest);
        if u * whole > rest {
            Self::Heavy(((1.0 - u) * whole / heavy).min(1.0))
        } else {
            // Not 0/0 for u = 0 where all of the area is heavy, by rounding.
            let rest = if rest > 0.0 { rest } else { f32::MIN_POSITIVE };
            Self::Tabulated((u * whole / rest).min(1.0))
        }
    }
}

/// Random numbers along the plane of incidence, split between the tabulated part, which comes
/// first, and the heavy one: the number within its part, and all ones where that part is the heavy
/// one.
#[inline(always)]
pub(crate) fn parts<L: Lanes>(u: L, share: L) -> [L; 2] {
    let (u, one) = (units(u), L::splat(1.0));
    let rest = one - share;
    // Straight from above the heavy part has no share, and u = 1 still belongs to the table.
    let heavy = u.simd_gt(rest);
    [units(heavy.select(one - u, u) / heavy.select(share, rest)), heavy]
}

/// [`Part::of_areas`] of numbers in lanes, as [`parts`].
#[inline(always)]
pub(crate) fn parts_of_areas<L: Lanes>(u: L, heavy: L, rest: L) -> [L; 2] {
    let (u, one) = (units(u), L::splat(1.0));
    let whole = heavy + rest;
    let is_heavy = (u * whole).simd_gt(rest);
    let rest = rest.simd_gt(L::splat(0.0)).select(rest, L::splat(f32::MIN_POSITIVE));
    let number = is_heavy.select(one - u, u) * whole / is_heavy.select(heavy, rest);
    [number.fast_min(one), is_heavy]
}

/// Clamped to [0, 1], NaN to 0.
#[inline(always)]
pub(super) fn units<L: Lanes>(x: L) -> L {
    (x & x.simd_gt(L::splat(0.0))).fast_min(L::splat(1.0))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use wide::f32x4;

    use super::{half_slopes, number_above};
    use crate::material::surface::Shape as _;
    use crate::{MicrofacetDistribution, Tables};

    #[test]
    fn shares_are_those_of_the_masking() {
        let mut worst = 0.0_f64;
        for gamma in [1.501, 1.51, 1.6, 1.79] {
            let slices = Tables::embedded().student_t(1.0, gamma).unwrap().slices;
            for i in 0..=4001 {
                let t = f64::from(i) / 4001.0;
                let exact = slices.share_of_moment(f64::from(slices.first_moment()), t);
                let got = f64::from(slices.heavy.share((t * slices.rows as f64) as f32));
                worst = worst.max((got - exact).abs());
            }
        }
        assert!(worst < 4e-6, "{worst:e}");
    }

    #[test]
    fn numbers_above_slopes_are_those_that_draw_them() {
        for gamma in [1.501, 1.55, 1.6, 1.79] {
            let tail = Tables::embedded().student_t(1.0, gamma).unwrap().slices.heavy.tail;
            let number = |x: f32, z: f32| {
                number_above([x, z].map(f32x4::splat), tail.in_lanes()).to_array()[0]
            };
            for i in 0..=1000 {
                let exact = i as f32 / 1000.0;
                let [half, z, factor] =
                    half_slopes(f32x4::splat(exact), tail.in_lanes()).map(|x| x.to_array());
                let slope = [2.0 * half[0], z[0] * factor[0]];
                // Cosines that are as good as 0 are of slopes that no view reflects upwards.
                if slope[1] > 1e-18 {
                    let got = number(slope[0], slope[1]);
                    // Of the smallest slopes the number is 1 to rounding.
                    assert!((got - exact).abs() < 4e-7, "{gamma}: {got} for {exact}");
                }
            }
            assert_eq!([number(1.0, 0.0), number(1e30, 1e-30), number(0.0, 1.0)], [0.0, 0.0, 1.0]);
        }
    }

    #[test]
    fn the_parts_meet_at_the_tabulated_share() {
        for gamma in [1.501, 1.6, 1.79] {
            let lobe = Tables::embedded().student_t([0.3, 0.7], gamma).unwrap();
            for i in 0..400 {
                let (z, t) = ((i as f32 + 0.5) / 400.0, (i % 7) as f32 - 3.0);
                let r = libm::sqrtf((1.0 - z * z) / (1.0 + t * t));
                let v = Vec3::new(r, r * t, z);
                // In unit space, along the stretched azimuth.
                let tilt = |u: f32| {
                    let [x, y, z] = lobe.sample_visible_normal(v, [u, 0.5]);
                    (x * v.x + y * v.y) / z
                };
                let last = lobe.tabulated_share(v);
                // The tabulated part ends with the steepest slope, the heavy part begins with the
                // least.
                let (end, start) = (tilt(last), tilt(last.next_up().next_up()));
                assert!(end > 1.0 && start < 0.1, "{gamma} {v}: {end} {start}");
            }
        }
    }
}
