//! Lagrange polynomials through a few nodes, for axes that have no Hermite cells.

use alloc::vec::Vec;

use wide::f32x4;

use microfacet_core::math::within;

/// The number of nodes that the polynomial of albedo tables goes through.
pub const SIX: usize = 6;

/// The first of the `window` of `n` nodes that a polynomial goes through. The cell that ends at
/// node `above` is in their middle, or as near to it as the ends allow: windows at the ends are
/// shifted, not shortened.
#[inline]
fn first_node(above: usize, n: usize, window: usize) -> usize {
    above.saturating_sub(window / 2).min(n - window)
}

/// The first node of the window about t; `nodes` ascend, and a t at a node belongs to the cell
/// above it.
fn window_at(nodes: &[f64], t: f64, window: usize) -> usize {
    first_node(nodes.partition_point(|&node| node <= t), nodes.len(), window)
}

/// Nodes, by index, with their weights in the value at t; fewer than `window` where there are fewer
/// nodes.
pub fn weights(nodes: &[f64], t: f64, window: usize) -> Vec<(usize, f64)> {
    let window = window.min(nodes.len());
    let start = window_at(nodes, t, window);
    let nodes = &nodes[start..start + window];
    let weight = |i: usize| {
        let others = (0..window).filter(|&j| j != i);
        others.map(|j| (t - nodes[j]) / (nodes[i] - nodes[j])).product()
    };
    (0..window).map(|i| (start + i, weight(i))).collect()
}

/// The nodes that a polynomial through `window` of them reads anywhere in [from, to].
pub fn nodes_read(nodes: &[f64], from: f64, to: f64, window: usize) -> &[f64] {
    &nodes[read(nodes, from, window)[0]..read(nodes, to, window)[1]]
}

/// The first of the nodes that a polynomial through `window` of them reads at t, and the one after
/// the last.
pub(super) fn read(nodes: &[f64], t: f64, window: usize) -> [usize; 2] {
    let window = window.min(nodes.len());
    let start = window_at(nodes, t, window);
    [start, start + window]
}

pub(super) fn is_even(nodes: &[f64]) -> bool {
    let [first, .., last] = nodes else { return true };
    let step = (last - first) / (nodes.len() - 1) as f64;
    let off = |(i, x): (usize, &f64)| (x - first - i as f64 * step).abs() > 1e-9 * step;
    !nodes.iter().enumerate().any(off)
}

/// [`weights`] of six of `n` ≥ 6 nodes spread evenly over [0, 1], in single precision: the first
/// node, and the weights. A t outside [0, 1] is taken at the nearer end, NaN at 0.
#[inline]
pub fn six(t: f32, n: usize) -> (usize, [f32; SIX]) {
    // Of 32 bits a conversion is one instruction.
    let last = (n - 1) as i32 as f32;
    let x = within(t * last, [0.0, last]);
    let start = first_node(x as i32 as usize + 1, n, SIX);
    (start, six_weights(x - start as i32 as f32))
}

/// Weights of the polynomial through the nodes 0 … 5 at x.
#[inline]
pub(super) fn six_weights(x: f32) -> [f32; SIX] {
    // Products from the left and from the right together leave out one factor at each node.
    const C: [f32; SIX] =
        [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 12.0, 1.0 / 12.0, -1.0 / 24.0, 1.0 / 120.0];
    let mut weights = C;
    let (mut left, mut right) = (1.0, 1.0);
    for i in 0..SIX {
        weights[i] *= left;
        left *= x - i as f32;
        let j = SIX - 1 - i;
        weights[j] *= right;
        right *= x - j as f32;
    }
    weights
}

/// [`weights`] of fewer than six nodes in single precision, of the first on; 0 for those that there
/// are not.
#[must_use]
pub fn few(nodes: &[f64], t: f64) -> [f32; SIX] {
    let mut all = [0.0; SIX];
    for (i, weight) in weights(nodes, t, SIX) {
        all[i] = weight as f32;
    }
    all
}

/// The place between the first and the last of six nodes.
pub const MIDDLE: f32 = 2.5;

/// Weights of six nodes: of the first four, and of the last four, where those that are in both have
/// 0. Lanes that are loaded from four nodes in a row need no node beyond the six.
pub type SixLanes = [f32x4; 2];

/// [`six`] in lanes: `x` is the place among the nodes 0, 1, … less [`MIDDLE`], and `last` the first
/// of the last six nodes. Beyond the ends the polynomials of the ends go on.
#[inline(always)]
#[must_use]
pub fn six_lanes(x: f32, last: f32) -> (usize, SixLanes) {
    // A sum with this number is rounded to a whole number, which its last bits are. At a node
    // either of the windows that meet there serves.
    const SHIFT: f32 = 8_388_608.0;
    let shifted = within(x, [0.0, last]) + SHIFT;
    let x = x - (shifted - SHIFT);
    ((shifted.to_bits() - SHIFT.to_bits()) as usize, lanes_about(x))
}

/// Weights of the polynomial through the nodes −5/2, −3/2 … 5/2 at x.
#[inline(always)]
fn lanes_about(x: f32) -> SixLanes {
    let lanes = |nodes: [f32; 4]| f32x4::splat(x) - f32x4::from(nodes);
    // The product over the other nodes, of which all lanes share some.
    let upper = (x - 1.5) * (x - 2.5);
    let lower = ((x + 2.5) * (x + 1.5)) * ((x + 0.5) * (x - 0.5));
    let first = lanes([-1.5, -2.5, -2.5, -2.5]) * lanes([-0.5, -0.5, -1.5, -1.5]);
    let third = lanes([0.5, 0.5, 0.5, -0.5])
        * f32x4::from([-1.0 / 120.0, 1.0 / 24.0, -1.0 / 12.0, 1.0 / 12.0]);
    let last = lanes([0.0, 0.0, 2.5, 1.5]) * f32x4::from([0.0, 0.0, -1.0 / 24.0, 1.0 / 120.0]);
    [(first * third) * upper, last * lower]
}

/// Σ weightᵢ nodeᵢ over the six nodes from `start` on, for each channel.
#[inline]
pub fn combine<const N: usize>(nodes: &[[f32; N]], start: usize, weights: &[f32; SIX]) -> [f32; N] {
    let mut sum = [0.0; N];
    for (node, w) in nodes[start..start + SIX].iter().zip(weights) {
        for (sum, x) in sum.iter_mut().zip(node) {
            *sum += w * x;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_met_and_windows_shift_at_the_ends() {
        let nodes = [0.0, 0.1, 0.25, 0.3, 0.6, 0.8, 1.0];
        for window in [1, 4, 6] {
            for t in [0.0, 0.05, 0.25, 0.4, 0.99, 1.0] {
                let power = window as i32 - 1;
                let all = weights(&nodes, t, window);
                let sum: f64 = all.iter().map(|&(i, w)| w * nodes[i].powi(power)).sum();
                // With a window of one node the value is that of the node, x⁰.
                assert!((sum - t.powi(power)).abs() < 1e-13, "{window}, {t}: {sum}");
                assert_eq!((all.len(), all[window - 1].0 - all[0].0), (window, window - 1));
            }
        }
        assert_eq!(weights(&nodes, 0.27, 4)[0].0, 1);
        assert_eq!([0.0, 1.0].map(|t| weights(&nodes, t, 4)[0].0), [0, 3]);
        assert_eq!(weights(&nodes[..3], 0.2, 6).len(), 3);
    }

    #[test]
    fn what_is_read_is_what_a_part_needs() {
        let nodes: Vec<f64> = (0..20).map(f64::from).collect();
        for (from, to) in [(0.0, 0.5), (3.2, 7.9), (18.5, 19.0), (5.0, 5.0)] {
            let part = nodes_read(&nodes, from, to, 6);
            for t in [from, 0.5 * (from + to), to] {
                let named = |nodes: &[f64]| -> Vec<(f64, f64)> {
                    weights(nodes, t, 6).into_iter().map(|(i, w)| (nodes[i], w)).collect()
                };
                assert_eq!(named(part), named(&nodes), "[{from}, {to}] at {t}");
            }
        }
    }

    #[test]
    fn the_fast_form_is_the_exact_one() {
        for n in [6, 7, 26] {
            let nodes: Vec<f64> = (0..n).map(|i| i as f64 / (n - 1) as f64).collect();
            for i in 0..=997 {
                let t = i as f32 / 997.0;
                let ((start, fast), exact) = (six(t, n), weights(&nodes, f64::from(t), SIX));
                let slow =
                    |node: usize| exact.iter().find(|at| at.0 == node).map_or(0.0, |at| at.1);
                let got: f64 = (0..SIX).map(|i| (f64::from(fast[i]) - slow(start + i)).abs()).sum();
                // The rounding of t, times n, shifts the polynomial.
                assert!(got < 4e-6 * n as f64, "{n} nodes, {t}: off by {got}");
            }
            assert_eq!([f32::NAN, -1.0].map(|t| six(t, n)), [six(0.0, n); 2]);
            assert_eq!(six(7.0, n), six(1.0, n));
        }
    }

    #[test]
    fn lanes_hold_the_same_weights() {
        for n in [6, 7, 26] {
            let last = (n - SIX) as f32;
            for i in -1..=998 {
                let x = i as f32 / 997.0 * (n - 1) as f32;
                let (start, [low, high]) = six_lanes(x - MIDDLE, last);
                let ([a, b, c, d], [none, nor, e, f]) = (low.to_array(), high.to_array());
                assert_eq!([none, nor], [0.0; 2]);
                // The six nodes are about x, as near as the ends allow.
                let middle = start as f32 + MIDDLE;
                let near = (x - middle).abs() < 0.501;
                let at_end = (start == 0 && x < middle) || (start + SIX == n && x > middle);
                assert!(near || at_end, "{n} nodes, {x}: {start}");
                let mut off = 0.0;
                for (got, want) in [a, b, c, d, e, f].into_iter().zip(six_weights(x - start as f32))
                {
                    off += (got - want).abs();
                }
                // The rounding of x.
                assert!(off < 4e-7 * n as f32, "{n} nodes, {x}: off by {off}");
            }
            assert_eq!([f32::NAN, -7.0].map(|x| six_lanes(x, last).0), [0; 2]);
            assert_eq!(six_lanes(77.0, last).0, n - SIX);
        }
    }

    #[test]
    fn uneven_nodes_are_seen() {
        assert!(is_even(&[0.3]) && is_even(&[]) && is_even(&[0.1, 0.2, 0.3]));
        assert!(!is_even(&[0.1, 0.2, 0.31]));
    }
}
