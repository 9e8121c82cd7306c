//! Cubic Hermite cells on even nodes, the one interpolation of the fast lookups.
//!
//! The same cubic is evaluated from nodes ([`hermite`], and in SIMD lanes [`basis`] and
//! [`hermite_lanes`]), and from the coefficients that a lobe prepares ([`horner`] with the fewest
//! operations, [`cubic`] with the shortest chain of them). A test compares all of them.

use alloc::vec::Vec;

use microfacet_core::math::sqrt64;
use microfacet_lanes::{Ints, Lanes, f32x4};

/// (value, slope) at a node, the slope per node index.
pub type Node = [f32; 2];

/// Splits a coordinate in [0, cells] into a cell and the position inside it, which is 1 at the last
/// node. NaN gives cell 0.
#[inline(always)]
pub fn locate(x: f32, cells: usize) -> (usize, f32) {
    // The cast saturates and takes NaN to 0; the cell is at most cells − 1 whatever x is.
    let cell = (x as i32).clamp(0, cells as i32 - 1);
    (cell as usize, x - cell as f32)
}

/// The cubic through two nodes at position w ∈ [0, 1] between them.
#[inline(always)]
pub fn hermite(a: Node, b: Node, w: f32) -> f32 {
    let rise = b[0] - a[0];
    let c2 = 3.0 * rise - 2.0 * a[1] - b[1];
    let c3 = a[1] + b[1] - 2.0 * rise;
    a[0] + w * (a[1] + w * (c2 + w * c3))
}

/// The weights of [value, slope, value, slope] of two nodes at w, which is the same in all lanes.
#[inline(always)]
pub fn basis(w: f32x4) -> f32x4 {
    let [c0, c1] = [f32x4::new([1.0, 0.0, 0.0, 0.0]), f32x4::new([0.0, 1.0, 0.0, 0.0])];
    let [c2, c3] = [f32x4::new([-3.0, -2.0, 3.0, -1.0]), f32x4::new([2.0, 1.0, -2.0, 1.0])];
    c0 + w * (c1 + w * (c2 + w * c3))
}

/// [`hermite`] of pairs of nodes in lanes, [value, slope, value, slope], each at its position.
#[inline(always)]
pub fn hermite_lanes<L: Lanes>([v0, s0, v1, s1]: [L; 4], w: L) -> L {
    // `basis` without its zero terms, which changes no bit.
    let b0 = w * (w * (w * 2.0 - 3.0)) + 1.0;
    let b1 = w * (w * (w - 2.0) + 1.0);
    let b2 = w * (w * (L::splat(3.0) - w * 2.0));
    let b3 = w * (w * (w - 1.0));
    (v0 * b0 + v1 * b2) + (s0 * b1 + s1 * b3)
}

/// Coefficients of the cubic c₀ + w(c₁ + w(c₂ + w c₃)) of a cell.
pub type Cell = [f32; 4];

/// The cubics between nodes, multiplied by `scale`, and after them a *guard cell*: a coordinate at
/// the upper end may fall into it, at position 0, so that fast lookups need not clamp the cell.
pub fn cubic_cells(nodes: &[Node], scale: f64) -> Vec<Cell> {
    let guard = nodes.last().map(|node| [f64::from(node[0]), 0.0, 0.0, 0.0]);
    let cubics = nodes.windows(2).map(|pair| Cubic::new(pair[0], pair[1]).c);
    cubics.chain(guard).map(|c| c.map(|c| (c * scale) as f32)).collect()
}

/// The coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
pub fn cubic_through_thirds([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    let (first, second, third) = (b - a, c - 2.0 * b + a, d - 3.0 * c + 3.0 * b - a);
    let linear = 3.0 * (first - 0.5 * second + third / 3.0);
    [a, linear, 4.5 * (second - third), 4.5 * third]
}

/// The cubic of a cell at position w with the fewest operations.
#[inline(always)]
pub fn horner(c: &Cell, w: f32) -> f32 {
    c[0] + w * (c[1] + w * (c[2] + w * c[3]))
}

/// The cubic of a cell at position w, in two halves that do not depend on each other.
#[inline(always)]
pub fn cubic(c: &Cell, w: f32) -> f32 {
    (c[0] + w * c[1]) + (w * w) * (c[2] + w * c[3])
}

/// [`cubic`] of cells in lanes, each at its position.
#[inline(always)]
pub fn cubic_lanes<L: Lanes>([c0, c1, c2, c3]: [L; 4], w: L) -> L {
    (c0 + w * c1) + (w * w) * (c2 + w * c3)
}

/// [`horner`] of cells in lanes, each at its position.
#[inline(always)]
pub fn horner_lanes<L: Lanes>([c0, c1, c2, c3]: [L; 4], w: L) -> L {
    c0 + w * (c1 + w * (c2 + w * c3))
}

/// The coefficients of cells' cubics; 0 where there is no such cell.
#[inline(always)]
pub fn coefficients<L: Lanes>(cells: &[Cell], at: L::Ints) -> [L; 4] {
    let at = at.to_array();
    L::columns(|i| match cells.get(at[i] as u32 as usize) {
        Some(cell) => f32x4::new(*cell),
        None => f32x4::ZERO,
    })
}

/// Splits coordinates in [0, cells] into cells, the guard cell included, and positions inside them.
///
/// The cast saturates only where the hardware's does; NaN gives a cell outside the table, or a NaN
/// position.
#[inline(always)]
pub fn split<L: Lanes>(x: L) -> (L::Ints, L) {
    let cell = x.fast_trunc_int();
    (cell, x - L::from_ints(cell))
}

/// Two neighbouring nodes, each interpolated linearly between the rows `low` and `high` of a table.
#[inline(always)]
pub fn between_rows(low: &[Node], high: &[Node], cell: usize, w: f32) -> (Node, Node) {
    // A window of two nodes is 16 bytes: one load per row.
    let (a, b) = (&low[cell..cell + 2], &high[cell..cell + 2]);
    let mix = |a: Node, b: Node| [a[0] + w * (b[0] - a[0]), a[1] + w * (b[1] - a[1])];
    (mix(a[0], b[0]), mix(a[1], b[1]))
}

/// A cubic on [0, 1] in double precision, for inverting and differentiating [`hermite`].
#[derive(Clone, Copy)]
pub struct Cubic {
    c: [f64; 4],
}

impl Cubic {
    /// Between two nodes.
    #[inline]
    pub fn new(a: Node, b: Node) -> Self {
        let [a0, a1, b0, b1] = [a[0], a[1], b[0], b[1]].map(f64::from);
        let rise = b0 - a0;
        Self { c: [a0, a1, 3.0 * rise - 2.0 * a1 - b1, a1 + b1 - 2.0 * rise] }
    }

    /// Of the coefficients of a cell.
    #[inline]
    pub fn of_cell(cell: &Cell) -> Self {
        Self { c: cell.map(f64::from) }
    }

    /// Its value at w.
    #[inline]
    pub fn value(&self, w: f64) -> f64 {
        self.c[0] + w * (self.c[1] + w * (self.c[2] + w * self.c[3]))
    }

    /// Its derivative at w.
    #[inline]
    pub fn derivative(&self, w: f64) -> f64 {
        self.c[1] + w * (2.0 * self.c[2] + w * 3.0 * self.c[3])
    }

    /// The w ∈ [0, 1] where the cubic is `y`, to 1e-11; the cubic ascends, as nodes are kept
    /// monotone.
    #[inline(always)]
    pub fn solve(&self, y: f64) -> f64 {
        let whole = self.c[1] + self.c[2] + self.c[3];
        // Newton's steps from the chord, without a branch: they double the digits, and three are
        // enough in all but a few cells in a thousand.
        let newton = |w: f64| w - (self.value(w) - y) / self.derivative(w);
        let w = newton(newton(((y - self.c[0]) / whole).clamp(0.0, 1.0)));
        let last = newton(w);
        if (last - w).abs() <= 1e-6 * last && last <= 1.0 { last } else { self.bisect(y) }
    }

    /// `solve` where the cubic is far from its chord, by Newton's steps within a bracket.
    #[cold]
    fn bisect(&self, y: f64) -> f64 {
        let (mut lo, mut hi) = (0.0, 1.0);
        // Starts at the root of the parabola about w = 0: in the tails of distributions cells start
        // almost level.
        let (rise, slope) = (y - self.c[0], self.c[1]);
        let start = 2.0 * rise / (slope + sqrt64(slope * slope + 4.0 * self.c[2] * rise));
        let mut w = if (0.0..1.0).contains(&start) { start } else { 0.5 };
        for _ in 0..60 {
            let error = self.value(w) - y;
            let newton = w - error / self.derivative(w);
            // Tested before the bracket, beyond which a converged step may end.
            if (newton - w).abs() <= 1e-8 * w {
                return newton.clamp(0.0, 1.0);
            }
            if error > 0.0 {
                hi = w;
            } else {
                lo = w;
            }
            w = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
        }
        w
    }
}

/// Makes a row of nodes ascend despite rounding and negative weights along other axes.
pub fn make_monotone(run: &mut [Node]) {
    let mut last = 0.0_f32;
    for node in run.iter_mut() {
        last = last.max(node[0]);
        node[0] = last;
    }
    limit_slopes(run);
}

/// Limits slopes so that the cubic of every cell ascends with its nodes: each slope lies in [0, 3Δ]
/// for both neighbouring rises Δ (Fritsch & Carlson 1980, <https://doi.org/10.1137/0717021>). The
/// condition is linear, so it also holds between rows.
pub fn limit_slopes(nodes: &mut [[f32; 2]]) {
    for i in 0..nodes.len() {
        let mut limit = f32::INFINITY;
        if i > 0 {
            limit = limit.min(3.0 * (nodes[i][0] - nodes[i - 1][0]));
        }
        if i + 1 < nodes.len() {
            limit = limit.min(3.0 * (nodes[i + 1][0] - nodes[i][0]));
        }
        nodes[i][1] = nodes[i][1].min(limit).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [Node; 3] = [[0.1, 0.4], [0.6, 0.3], [0.7, 0.0]];

    #[test]
    fn all_forms_are_one_cubic() {
        let coefficients = cubic_cells(&NODES, 1.0);
        assert_eq!(coefficients.len(), 3);
        for (i, pair) in NODES.windows(2).enumerate() {
            let exact = Cubic::new(pair[0], pair[1]);
            for w in [0.0, 0.25, 0.5, 0.9, 1.0_f32] {
                let want = exact.value(f64::from(w)) as f32;
                let lanes = f32x4::splat(w);
                let nodes = [pair[0][0], pair[0][1], pair[1][0], pair[1][1]];
                let sum: f32 = (basis(lanes) * f32x4::new(nodes)).to_array().iter().sum();
                let four = hermite_lanes(nodes.map(f32x4::splat), lanes).to_array();
                let cell = &coefficients[i];
                let cells = cell.map(f32x4::splat);
                let cubics = [cubic_lanes(cells, lanes), horner_lanes(cells, lanes)]
                    .map(|x| x.to_array()[2]);
                let one = [hermite(pair[0], pair[1], w), horner(cell, w), cubic(cell, w)];
                let all = [one[0], one[1], one[2], sum, four[1], cubics[0], cubics[1]];
                assert!(all.iter().all(|got| (got - want).abs() < 2e-7), "{all:?} for {want}");
            }
        }
        assert_eq!(horner(&coefficients[2], 0.0), 0.7);
    }

    #[test]
    fn a_cubic_is_met_through_its_values_at_thirds() {
        let exact = [0.3, -1.0, 2.0, 0.7];
        let value = |w: f64| exact[0] + w * (exact[1] + w * (exact[2] + w * exact[3]));
        let got = cubic_through_thirds([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(value));
        assert!(got.iter().zip(exact).all(|(got, want)| (got - want).abs() < 1e-14), "{got:?}");
    }

    #[test]
    fn the_inverse_finds_the_position() {
        let cubic = Cubic::new(NODES[0], NODES[1]);
        for w in [0.0, 0.1, 0.5, 0.99, 1.0] {
            assert!((cubic.solve(cubic.value(w)) - w).abs() < 1e-11, "{w}");
        }
    }

    #[test]
    fn nodes_are_made_to_ascend() {
        let mut run = [[0.2, 9.0], [0.1, -1.0], [0.5, 9.0]];
        make_monotone(&mut run);
        assert_eq!(run, [[0.2, 0.0], [0.2, 0.0], [0.5, 3.0 * (0.5 - 0.2_f32)]]);
        assert_eq!(locate(f32::NAN, 4).0, 0);
        let located = [4.0, -0.5, 9.0].map(|x| locate(x, 4));
        assert_eq!(located, [(3, 1.0), (0, -0.5), (3, 6.0)]);
    }
}
