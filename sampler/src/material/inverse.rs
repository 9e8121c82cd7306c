//! The inverse of the lookups: the random numbers at which the tables have a slope.
//!
//! A row of nodes ascends, so the cell that holds a value is found by a *guide*: for every part of
//! the range of values the last node before it, from which few steps are left (Chen & Asau 1974, *On
//! generating random variates from an empirical distribution*). In the cell, the density wants the
//! position to rounding, while the ends of a bounded interval want only a limit on the right side
//! of it, which takes one division.

use alloc::vec::Vec;

use super::student_t::{Stretched, StudentT};
use crate::axis::MirroredRoot;
use crate::axis::half_tangent::ends;
use crate::axis::hermite::{Cubic, Node};

/// Parts of the range [0, 2] of values.
const BINS: usize = 32;
/// Rows that share a part of the guide; neighbours differ little.
const SHARED: usize = 4;

/// For each group of rows, each half of them and each bin, the last node that is not above the bin
/// in any of the rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guide(Vec<[u16; BINS]>);

impl Guide {
    /// For rows of `halves` runs of `nodes` nodes each.
    pub(crate) fn new(rows: &[Node], halves: usize, nodes: usize) -> Self {
        let row = halves * nodes;
        let count = rows.len() / row;
        let group = |first: usize, half: usize| {
            let mut least = [u16::MAX; BINS];
            // Lookups between rows reach the first of the next group.
            for r in first..(first + SHARED + 1).min(count) {
                let run = &rows[r * row + half * nodes..][..nodes];
                let mut node = 0;
                for (bin, least) in least.iter_mut().enumerate() {
                    let edge = bin as f32 * (2.0 / BINS as f32);
                    while node + 1 < nodes && run[node + 1][0] <= edge {
                        node += 1;
                    }
                    *least = (*least).min(node as u16);
                }
            }
            least
        };
        let firsts = (0..count.max(2) - 1).step_by(SHARED);
        Self(firsts.flat_map(|first| (0..halves).map(move |half| group(first, half))).collect())
    }

    /// A node not above g ∈ [0, 2] in the run of a row and the next.
    #[inline(always)]
    fn start(&self, row: usize, halves: usize, half: usize, g: f64) -> usize {
        let bin = ((g * (0.5 * BINS as f64)) as usize).min(BINS - 1);
        usize::from(self.0[row / SHARED * halves + half][bin])
    }
}

/// Two neighbouring rows of a table and the position between them.
pub(super) struct Rows<'a> {
    row: usize,
    low: &'a [Node],
    high: &'a [Node],
    between: f32,
}

impl Rows<'_> {
    #[inline(always)]
    pub(super) fn node(&self, i: usize) -> Node {
        let (a, b) = (self.low[i], self.high[i]);
        [a[0] + self.between * (b[0] - a[0]), a[1] + self.between * (b[1] - a[1])]
    }
}

/// Where the interpolated inverse CDF of one half of a mirrored axis takes a value: a cell, and the
/// value.
pub(super) struct Cell {
    cell: usize,
    /// Reciprocal of the number of cells.
    width: f64,
    g: f64,
    nodes: [Node; 2],
}

/// Coordinate in [0, 1] of a place, and the derivative of the value there.
pub(super) struct Place {
    t: f64,
    dg_dt: f64,
}

impl Cell {
    /// Among the half's `cells + 1` ascending nodes, searching from `start`; `None` before the
    /// first.
    #[inline(always)]
    fn find(node: impl Fn(usize) -> Node, cells: usize, start: usize, g: f64) -> Option<Self> {
        let (mut cell, mut next) = (start.min(cells - 1), node(start.min(cells - 1) + 1));
        while cell + 1 < cells && f64::from(next[0]) <= g {
            cell += 1;
            next = node(cell + 1);
        }
        let nodes = [node(cell), next];
        // The halves meet at u = ½ up to the rounding of their nodes; a normal in a gap between
        // them is a rounded sample of its edge.
        let g = g.min(f64::from(next[0]));
        let width = 1.0 / cells as f64;
        (g >= f64::from(nodes[0][0])).then_some(Self { cell, width, g, nodes })
    }

    /// The place of the value, to rounding.
    #[inline(always)]
    pub(super) fn place(&self) -> Place {
        let cubic = Cubic::new(self.nodes[0], self.nodes[1]);
        let w = cubic.solve(self.g);
        Place { t: (self.cell as f64 + w) * self.width, dg_dt: cubic.derivative(w) / self.width }
    }

    /// The coordinate of a place where the value is not above this one or, for `above`, not below.
    #[inline(always)]
    fn limit(&self, above: bool) -> f64 {
        // The cubic differs from its chord by w(1−w)((s₀−Δ)(1−w) − (s₁−Δ)w), where Δ is the rise,
        // so from either end it rises by at most Δ and the larger of s₀−Δ and Δ−s₁ per cell.
        let [[a, s0], [b, s1]] = self.nodes.map(|node| node.map(f64::from));
        let rise = b - a;
        let steepest = (s0 - rise).max(rise - s1).max(0.0);
        let shallowest = (rise - s0).max(s1 - rise).max(0.0);
        let w = if above {
            1.0 - (b - self.g) / (rise + shallowest)
        } else {
            (self.g - a) / (rise + steepest)
        };
        // A cell without rise.
        let w = if w.is_nan() { if above { 1.0 } else { 0.0 } } else { w.clamp(0.0, 1.0) };
        (self.cell as f64 + w) * self.width
    }
}

impl Place {
    /// du/dg.
    pub(super) fn density(&self) -> f64 {
        if self.dg_dt > 0.0 { MirroredRoot::rate(self.t) / self.dg_dt } else { 0.0 }
    }
}

impl StudentT {
    /// The two rows of the view, interpolated as the sampler does.
    #[inline(always)]
    pub(super) fn rows_at(&self, view: &Stretched) -> Rows<'_> {
        let slices = &self.slices;
        let (row, between) = self.locate_row(view);
        let stride = 2 * (slices.half_cells + 1);
        let [low, high] =
            [row * stride, (row + 1) * stride].map(|start| &slices.slope[start..start + stride]);
        Rows { row, low, high, between }
    }

    /// The half of the row that holds the in-plane slope x : z, and the cell in it.
    #[inline(always)]
    pub(super) fn cell_along(&self, rows: &Rows<'_>, x: f64, z: f64) -> (usize, Option<Cell>) {
        let cells = self.slices.half_cells;
        let [low, high] = ends(x, z);
        // The half for u ≤ ½ ends where 1 + h reaches its last node; larger slopes are looked up by
        // 1 − h in the other half.
        let away = low <= f64::from(rows.node(cells)[0]);
        let (half, g) = if away { (0, low) } else { (1, high) };
        let start = self.slices.guide.start(rows.row, 2, half, g);
        (half, Cell::find(|i| rows.node(half * (cells + 1) + i), cells, start, g))
    }

    /// The cell of the slopes across that holds the distance g from their end.
    #[inline(always)]
    pub(super) fn cell_across(&self, g: f64) -> Option<Cell> {
        let nodes = &self.slices.across;
        let start = self.slices.guide_across.start(0, 1, 0, g);
        Cell::find(|i| nodes[i], nodes.len() - 1, start, g)
    }

    /// A limit, not above or not below, of the random number at which the table has the in-plane
    /// slope x : z.
    #[inline(always)]
    pub(super) fn limit_along(&self, rows: &Rows<'_>, x: f64, z: f64, above: bool) -> f64 {
        let (half, cell) = self.cell_along(rows, x, z);
        // The other half ascends from u = 1.
        let t = cell.map_or(0.0, |cell| cell.limit(above == (half == 0)));
        let u = MirroredRoot::number(t);
        if half == 0 { u } else { 1.0 - u }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Tables;
    use glam::Vec3;

    /// The random number at which the table has a slope, to rounding.
    fn number_along(lobe: &StudentT, rows: &Rows<'_>, x: f64, z: f64) -> f64 {
        let (half, cell) = lobe.cell_along(rows, x, z);
        let u = cell.map_or(0.0, |cell| MirroredRoot::number(cell.place().t));
        if half == 0 { u } else { 1.0 - u }
    }

    #[test]
    fn numbers_are_those_of_the_lookup_and_limits_enclose_them() {
        let tables = Tables::embedded();
        let (mut widest, mut count) = (0.0_f64, 0);
        for gamma in [1.501, 1.7, 1.8, 2.0, 3.0, f64::INFINITY] {
            let lobe = tables.student_t(1.0, gamma).unwrap();
            for z in [0.0, 1e-3, 0.1, 0.4, 0.7, 0.95, 0.9999] {
                let view = lobe.stretch(Vec3::new(libm::sqrtf(1.0 - z * z), 0.0, z));
                let rows = lobe.rows_at(&view);
                for i in 1..400 {
                    let u = i as f32 / 400.0;
                    let slope = lobe.sample_slope(&view, u);
                    let (x, z) = (f64::from(slope.x), f64::from(slope.z));
                    let got = number_along(&lobe, &rows, x, z);
                    let [low, high] = [false, true].map(|a| lobe.limit_along(&rows, x, z, a));
                    assert!((got - f64::from(u)).abs() < 1e-5, "{gamma} {z} {u}: {got}");
                    assert!(low <= got + 1e-12 && got <= high + 1e-12, "{u}: {low} {got} {high}");
                    (widest, count) = (widest.max(high - low), count + 1);
                }
            }
        }
        assert!(widest < 0.2 && count > 10_000, "{widest} {count}");
    }

    #[test]
    fn a_guide_never_starts_behind_the_cell() {
        let rows: Vec<Node> =
            (0..9 * 10).map(|i| [(i % 10 + i / 10) as f32 * 0.11, 0.1]).collect();
        let guide = Guide::new(&rows, 1, 10);
        for (row, g) in (0..8).flat_map(|row| (0..200).map(move |i| (row, 0.01 * f64::from(i)))) {
            let start = guide.start(row, 1, 0, g);
            for r in [row, row + 1] {
                assert!(start == 0 || f64::from(rows[r * 10 + start][0]) <= g, "{row} {g}");
            }
        }
        // One row, as that of the slopes across.
        assert_eq!(Guide::new(&rows[..10], 1, 10).start(0, 1, 0, 0.5), 4);
    }
}
