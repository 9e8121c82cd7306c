//! The least and the largest random number of a slope, interpolated in a small table.

use alloc::vec::Vec;

use microfacet_lanes::{Ints, Lanes};
use microfacet_tables::axis::hermite::split;

use crate::material::slices::Slices;
use crate::material::upward::SLACK;

/// Cells of the slope x : z by x/(|x| + z), over [−1, 1], and rows of the table between two rows of
/// limits.
const CELLS: usize = 64;
pub(super) const SHARED: usize = 4;
/// Steps between two nodes of the limits at which they are compared with the numbers they enclose.
const BETWEEN: usize = 2;

/// How far a limit is moved beyond the number that it must enclose, so that neither rounding nor
/// the range between the compared points loses a direction: a share of the largest error of
/// interpolation near it, and [`SLACK`].
const MARGIN: f64 = 0.5;

/// Nodes below coordinates, and the weights of the next nodes.
#[derive(Clone, Copy)]
pub(super) struct Nodes<L: Lanes> {
    node: L::Ints,
    weight: L,
}

impl<L: Lanes> Nodes<L> {
    #[inline(always)]
    pub(super) fn new(at: L) -> Self {
        let (node, weight) = split(at);
        Self { node, weight }
    }

    /// Of the slope x : z.
    #[inline(always)]
    pub(super) fn of_slope([x, z]: [L; 2]) -> Self {
        const HALF: f32 = 0.5 * CELLS as f32;
        let length = x & !L::splat(-0.0);
        Self::new(x * HALF / (length + z) + HALF)
    }

    #[inline(always)]
    pub(super) fn first(&self) -> (i32, f32) {
        (self.node.to_array()[0], self.weight.to_array()[0])
    }
}

/// The limits of a shape, by node of the view and of the slope: the least and the largest number.
pub(super) fn limits_of(slices: &Slices) -> Vec<[f32; 2]> {
    let last = slices.rows;
    // The exact numbers at all rows and, between the nodes of the limits, some slopes.
    let fine = BETWEEN * CELLS;
    let numbers = |row: usize| -> Vec<f64> {
        let rows = slices.one_row(row);
        let at = |i: usize| {
            let x = -1.0 + i as f64 * (2.0 / fine as f64);
            slices.number_along(&rows, x, 1.0 - x.abs())
        };
        (0..=fine).map(at).collect()
    };
    let numbers: Vec<_> = (0..=last).map(numbers).collect();
    let groups = last.div_ceil(SHARED);
    let row_of = |group: usize| (group * SHARED).min(last);
    let node = |group: usize, cell: usize| numbers[row_of(group)][BETWEEN * cell];
    // The largest errors of interpolation above and below the numbers of a cell.
    let strays = |group: usize, cell: usize| {
        let (mut above, mut below) = (0.0_f64, 0.0_f64);
        let rows = &numbers[row_of(group)..=row_of(group + 1)];
        for (row, numbers) in rows.iter().enumerate() {
            let w = row as f64 / SHARED as f64;
            for i in 0..=BETWEEN {
                let t = i as f64 / BETWEEN as f64;
                let along = |g: usize| (1.0 - t) * node(g, cell) + t * node(g, cell + 1);
                let strayed =
                    (1.0 - w) * along(group) + w * along(group + 1) - numbers[BETWEEN * cell + i];
                (above, below) = (above.max(strayed), below.max(-strayed));
            }
        }
        [above, below]
    };
    let strays: Vec<Vec<[f64; 2]>> =
        (0..groups).map(|g| (0..CELLS).map(|cell| strays(g, cell)).collect()).collect();
    let limit = |group: usize, cell: usize| {
        let near = strays[group.saturating_sub(1)..(group + 1).min(groups)]
            .iter()
            .flat_map(|row| &row[cell.saturating_sub(1)..(cell + 1).min(CELLS)]);
        let [above, below] =
            near.fold([0.0_f64; 2], |far, near| [0, 1].map(|i| far[i].max(near[i])));
        let u = node(group, cell);
        let beyond = |stray: f64| (1.0 + MARGIN) * stray + f64::from(SLACK);
        [(u - beyond(above)) as f32, (u + beyond(below)) as f32]
    };
    // A guard: interpolation reads a row and a node beyond the last, with weight 0.
    let rows = (0..=groups).chain([groups]);
    let mut limits: Vec<_> = rows
        .flat_map(|group| (0..=CELLS).map(move |cell| (group, cell)))
        .map(|(g, c)| limit(g, c))
        .collect();
    limits.push([0.0, 1.0]);
    limits
}

/// Limits as they are stored, see [`limits_of`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<'a>(pub(super) &'a [[f32; 2]]);

impl Limits<'_> {
    /// The limit at a view and a slope, each given as a node and the weight of the next.
    #[inline(always)]
    pub(super) fn limit(self, (row, w): (i32, f32), (cell, t): (i32, f32), end: usize) -> f32 {
        const STRIDE: usize = CELLS + 1;
        let at = row.wrapping_mul(STRIDE as i32).wrapping_add(cell) as u32 as usize;
        // The index is out of the table only for NaN.
        let Some(near) = self.0.get(at..at + STRIDE + 2) else { return end as f32 };
        let along = |i: usize| near[i][end] + t * (near[i + 1][end] - near[i][end]);
        let (low, high) = (along(0), along(STRIDE));
        // Clamped after interpolation: a node clamped at 0 or 1 would narrow the margin of others.
        (low + w * (high - low)).clamp(0.0, 1.0)
    }

    /// [`limit`](Self::limit) of views in lanes, at the slopes of both ends.
    #[inline(always)]
    pub(super) fn both<L: Lanes>(self, row: Nodes<L>, cells: [Nodes<L>; 2]) -> [L; 2] {
        let (rows, w) = (row.node.to_array(), row.weight.to_array());
        let (low, low_w) = (cells[0].node.to_array(), cells[0].weight.to_array());
        let (high, high_w) = (cells[1].node.to_array(), cells[1].weight.to_array());
        [
            L::from_fn(|i| self.limit((rows[i], w[i]), (low[i], low_w[i]), 0)),
            L::from_fn(|i| self.limit((rows[i], w[i]), (high[i], high_w[i]), 1)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use microfacet_lanes::f32x4;

    use super::*;
    use crate::Tables;

    #[test]
    fn limits_enclose_the_numbers_between_their_nodes() {
        let (mut excess, mut count) = (0.0, 0);
        for gamma in [1.501, 1.6, 1.9, 3.0, f64::INFINITY] {
            let bounded = Tables::embedded().student_t(0.5, gamma).unwrap().bounded();
            let lobe = bounded.lobe();
            let rows = lobe.slices.rows as f32;
            for i in 0..331 {
                let at = rows * i as f32 / 330.0;
                let table = lobe.slices.rows_at(at).unwrap();
                let view = Nodes::new(f32x4::splat(at / SHARED as f32)).first();
                for j in 0..=500 {
                    let x = -1.0 + j as f32 / 250.0;
                    let exact = lobe.slices.number_along(&table, x.into(), (1.0 - x.abs()).into());
                    let half = 0.5 * CELLS as f32;
                    let slope = Nodes::new(f32x4::splat(x * half + half)).first();
                    let [low, high] = [0, 1]
                        .map(|end| f64::from(bounded.by_ref().limits.limit(view, slope, end)));
                    assert!(low <= exact && exact <= high, "{gamma} {at} {x}: {low} {exact}");
                    (excess, count) = (excess + (high - low), count + 1);
                }
            }
        }
        // The intervals are not much longer than needed.
        assert!(excess / f64::from(count) < 1e-3, "{}", excess / f64::from(count));
    }
}
