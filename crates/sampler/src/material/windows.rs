//! The γ axis of a table at one hit: four nodes and the weights of the polynomial through them, and
//! tables that have the γ of a node next to each other.
//!
//! The weights are those of [`Axis::weights`](microfacet_tables::Axis::weights), as cubics of the
//! position between two nodes, so that they take neither a division nor a product for each pair of
//! nodes. Distances are measured by r = 2 − s, which keeps its digits towards γ = 3/2, where nodes
//! are close to each other.

use alloc::vec::Vec;

use microfacet_core::shape::S_END;
use microfacet_lanes::f32x4;
use microfacet_tables::axis::hermite::{Cell, Node, cubic_through_thirds};
use microfacet_tables::axis::lagrange;

use super::lanes::{pairs, swap_halves};

/// The nodes of a window.
const FOUR: usize = 4;

/// Four nodes of γ and their weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    start: u32,
    weights: f32x4,
}

/// The windows of N axes of γ, which have one range and nodes of their own.
#[derive(Clone, Debug)]
pub(super) struct Windows<const N: usize> {
    /// r at the least s, and slots in a unit of s.
    pub(super) first: f32,
    pub(super) scale: f32,
    /// The cell at the middle of each slot. A slot that holds the end of a cell reads one of the
    /// two up to half a slot outside; there their polynomials still agree to rounding.
    pub(super) slots: Vec<u16>,
    pub(super) last: u16,
    pub(super) cells: Vec<Between<N>>,
}

/// Between two nodes, of any axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between<const N: usize> {
    /// r at the node of the smaller s, and one over the width in s.
    pub(super) from: f32,
    pub(super) inverse: f32,
    pub(super) starts: [u32; N],
    /// The weights' coefficients by axis, by power of the position.
    pub(super) weights: [[[f32; FOUR]; FOUR]; N],
}

/// Cells of G1 next to γ = 3/2 are seven slots wide, others a hundred.
const SLOTS: usize = 4096;

impl<const N: usize> Windows<N> {
    /// Of axes of s, ascending, over a range of s that all of them hold.
    pub(super) fn new(axes: [&[f64]; N], [low, high]: [f64; 2]) -> Self {
        let slot = (high - low) / SLOTS as f64;
        let mut ends: Vec<f64> = axes.into_iter().flatten().copied().collect();
        ends.retain(|s| low + slot < *s && *s < high - slot);
        ends.extend([low, high]);
        ends.sort_by(f64::total_cmp);
        // Nodes of two axes that are closer than a slot count as one.
        ends.dedup_by(|next, last| *next - *last < slot);
        let cell = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            let windows = axes.map(|nodes| window(nodes, from, to));
            Between {
                from: (S_END - from) as f32,
                inverse: (1.0 / (to - from)) as f32,
                starts: windows.map(|(start, _)| start as u32),
                weights: windows.map(|(_, weights)| weights),
            }
        };
        let of_slot = |i: usize| {
            let s = low + (i as f64 + 0.5) * slot;
            ends[1..ends.len() - 1].partition_point(|&end| end <= s) as u16
        };
        Self {
            first: (S_END - low) as f32,
            scale: (1.0 / slot) as f32,
            slots: (0..SLOTS).map(of_slot).collect(),
            last: (ends.len() - 2) as u16,
            cells: ends.windows(2).map(cell).collect(),
        }
    }

    /// The windows at r = 2 − s.
    #[inline(always)]
    pub(super) fn at(&self, r: f32) -> [Window; N] {
        // Nothing here can panic, so that a window which no lookup uses costs nothing.
        let slot = f32x4::splat((self.first - r) * self.scale).fast_trunc_int().to_array()[0];
        // The end of the range is no slot, nor is NaN.
        let cell = self.slots.get(slot as u32 as usize).copied().unwrap_or(self.last);
        let Some(cell) = self.cells.get(usize::from(cell)) else {
            return [Window { start: 0, weights: NONE }; N];
        };
        let x = f32x4::splat((cell.from - r) * cell.inverse);
        core::array::from_fn(|i| {
            let [c0, c1, c2, c3] = cell.weights[i].map(f32x4::new);
            Window { start: cell.starts[i], weights: (c0 + x * c1) + (x * x) * (c2 + x * c3) }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.slots[..]) + size_of_val(&self.cells[..])
    }
}

/// The first node of the window between two places that have no node between them, and the
/// coefficients of its weights.
fn window(nodes: &[f64], from: f64, to: f64) -> (usize, [[f32; FOUR]; FOUR]) {
    let start = lagrange::weights(nodes, 0.5 * (from + to), FOUR)[0].0;
    let window = &nodes[start..(start + FOUR).min(nodes.len())];
    // The cubics through four places of the cell are the weights themselves.
    let values = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|x| {
        let mut weights = [0.0; FOUR];
        let exact = lagrange::weights(window, from + x * (to - from), FOUR);
        exact.into_iter().for_each(|(i, weight)| weights[i] = weight);
        weights
    });
    let cubics: [_; FOUR] = core::array::from_fn(|k| cubic_through_thirds(values.map(|at| at[k])));
    (start, core::array::from_fn(|power| cubics.map(|cubic| cubic[power] as f32)))
}

/// A table by its places, each with the values of all γ next to each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Planes<T> {
    /// Values at a place: γ, at least four.
    pub(super) shapes: usize,
    pub(super) values: Vec<T>,
}

impl<T: Copy + Default> Planes<T> {
    /// From the values at all places of each of `count` nodes of γ; `guards` places follow, which
    /// are read with weight 0.
    pub(super) fn new(count: usize, guards: usize, of: impl Fn(usize) -> Vec<T>) -> Self {
        let shapes = count.max(FOUR);
        let mut values = Vec::new();
        for shape in 0..count {
            let plane = of(shape);
            values.resize((plane.len() + guards) * shapes, T::default());
            for (place, value) in plane.into_iter().enumerate() {
                values[place * shapes + shape] = value;
            }
        }
        Self { shapes, values }
    }

    /// The values of a window at a place; `None` where there is no such place.
    #[inline(always)]
    fn at(&self, window: Window, place: usize) -> Option<&[T; FOUR]> {
        let start = self.start(window, place)?;
        self.values.get(start..start.wrapping_add(FOUR))?.first_chunk()
    }

    /// The values of a window at a place and the next, by one test.
    #[inline(always)]
    fn two(&self, window: Window, place: usize) -> Option<[&[T; FOUR]; 2]> {
        let start = self.start(window, place)?;
        let both = self.values.get(start..start.wrapping_add(self.shapes + FOUR))?;
        Some([both.first_chunk()?, both.last_chunk()?])
    }

    #[inline(always)]
    fn start(&self, window: Window, place: usize) -> Option<usize> {
        // In 64 bits: the place that NaN gives would come round to 0 in 32.
        let start = (place as u64).wrapping_mul(self.shapes as u64) + u64::from(window.start);
        usize::try_from(start).ok()
    }

    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}

/// NaN, for places that do not exist.
const NONE: f32x4 = f32x4::splat(f32::NAN);

impl Planes<Node> {
    /// (value, slope) at a place and the next; `None` where there are none.
    #[inline(always)]
    pub(super) fn pair(&self, window: Window, place: usize) -> Option<f32x4> {
        // Not by `map`, whose closure is a call of its own in some programs.
        let [low, high] = self.two(window, place)?;
        Some(combined([window.halves(low), window.halves(high)]))
    }

    /// [`pair`](Self::pair), NaN where there are none.
    #[inline(always)]
    pub(super) fn pair_or_nan(&self, window: Window, place: i32) -> f32x4 {
        self.pair(window, place as u32 as usize).unwrap_or(NONE)
    }

    /// [`pair`](Self::pair), linear in w between a place and another.
    #[inline(always)]
    pub(super) fn between(&self, window: Window, low: usize, high: usize, w: f32) -> f32x4 {
        let (Some([a, b]), Some([c, d])) = (self.two(window, low), self.two(window, high)) else {
            return NONE;
        };
        let ([a, b], w) = ([window.halves(a), window.halves(b)], f32x4::splat(w));
        let [c, d] = [window.halves(c), window.halves(d)];
        combined([a + w * (c - a), b + w * (d - b)])
    }
}

impl Planes<Cell> {
    /// The coefficients of a cell.
    #[inline(always)]
    pub(super) fn cell(&self, window: Window, place: usize) -> Cell {
        let Some(cells) = self.at(window, place) else { return [f32::NAN; 4] };
        let ([a, b, c, d], [p, q, r, s]) = (window.weights.to_array(), *cells);
        let low = f32x4::new(p) * a + f32x4::new(q) * b;
        let high = f32x4::new(r) * c + f32x4::new(s) * d;
        (low + high).to_array()
    }
}

impl Window {
    /// The weighted sums of the first and the third node, and of the second and the fourth.
    #[inline(always)]
    fn halves(self, nodes: &[Node; FOUR]) -> f32x4 {
        let [a, b, c, d] = *nodes;
        let (low, high) =
            (self.weights.unpack_lo(self.weights), self.weights.unpack_hi(self.weights));
        f32x4::new([a[0], a[1], b[0], b[1]]) * low + f32x4::new([c[0], c[1], d[0], d[1]]) * high
    }
}

/// The sums of the halves of each.
#[inline(always)]
fn combined([a, b]: [f32x4; 2]) -> f32x4 {
    pairs(a, b) + pairs(swap_halves(a), swap_halves(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_those_of_the_axes() {
        let even: Vec<f64> = (0..21).map(|i| 1.25 + f64::from(i) * 0.746 / 20.0).collect();
        let crowded = [1.25, 1.6, 1.9, 1.95, 1.99, 1.993, 1.995, 1.996];
        let axes: [&[f64]; 4] = [&even, &crowded, &[1.25, 1.996], &[0.3, 1.5, 1.996]];
        let range = [1.25, 1.996];
        let windows = Windows::new(axes, range);
        for i in 0..=30_000 {
            // As single precision holds it.
            let r = (S_END - range[0] - (range[1] - range[0]) * f64::from(i) / 3e4) as f32;
            let s = (S_END - f64::from(r)).clamp(range[0], range[1]);
            for (nodes, window) in axes.into_iter().zip(windows.at(r)) {
                // A function that no cubic is.
                let f = |s: f64| (3.0 * s).sin();
                let exact = lagrange::weights(nodes, s, FOUR);
                let want: f64 = exact.into_iter().map(|(k, w)| w * f(nodes[k])).sum();
                let weights = window.weights.to_array().into_iter();
                let read = nodes[window.start as usize..].iter().zip(weights);
                let got: f64 = read.map(|(&node, w)| f64::from(w) * f(node)).sum();
                assert!((got - want).abs() < 1e-6, "{s} of {nodes:?}: {got} for {want}");
            }
        }
        // Just out of range, by rounding, the last cells go on; NaN gives no weights.
        for s in [range[0] - 1e-7, range[1] + 1e-7] {
            for window in windows.at((S_END - s) as f32) {
                assert!((window.weights.to_array().iter().sum::<f32>() - 1.0).abs() < 1e-5);
            }
        }
        assert!(windows.at(f32::NAN).iter().all(|window| window.weights.is_nan().all()));
    }
}
