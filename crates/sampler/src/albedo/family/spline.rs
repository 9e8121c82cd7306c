//! Splines through evenly spaced nodes: quadratic along γ and σ, cubic along the view.
//!
//! A value takes three or four neighbouring coefficients with weights that do not depend on the
//! table. Splines are smoother than polynomials through as many nodes, and err by less than half.

use alloc::vec::Vec;

use microfacet_lanes::{Ints, Lanes, f32x4};

use super::axes::Place;

/// How many coefficients a quadratic takes.
pub(super) const THREE: usize = 3;
/// How many coefficients a cubic takes.
pub(super) const FOUR: usize = 4;

/// The nearest whole numbers to small x ≥ −½, and how far the x are above them.
#[inline(always)]
fn nearest<L: Lanes>(x: L) -> (L::Ints, L) {
    // A sum with this is rounded to a whole number, which stands in its last bits.
    const SHIFT: f32 = 12_582_912.0;
    let shifted = x + SHIFT;
    (shifted.to_bits() & L::Ints::splat(0xffff), x - (shifted - SHIFT))
}

/// The first of the three coefficients at x ∈ [0, nodes − 1], and their weights; along two axes.
#[inline(always)]
pub(super) fn quadratic_weights(x: f32x4) -> Place {
    let (start, d) = nearest(x);
    // (½−d)²/2, ¾−d², (½+d)²/2.
    let half = d * 0.5;
    let ends = half * d + 0.125;
    let weights = [ends - half, f32x4::ONE - (ends + ends), ends + half];
    let [a, b, ..] = start.to_array();
    Place { first: [a as usize, b as usize], weights }
}

/// Powers of the distance d = x − ½ from the middle of a cell: (½−d)³/6, …, (½+d)³/6.
const POWERS: [[f32; FOUR]; FOUR] = [
    [1.0 / 48.0, 23.0 / 48.0, 23.0 / 48.0, 1.0 / 48.0],
    [-0.125, -0.625, 0.625, 0.125],
    [0.25, -0.25, -0.25, 0.25],
    [-1.0 / 6.0, 0.5, -0.5, 1.0 / 6.0],
];

/// [`cubic_weights`] in lanes, by coefficient.
#[inline(always)]
pub(super) fn cubic_weights_in_lanes<L: Lanes>(x: L) -> (L::Ints, [L; FOUR]) {
    let (cell, x) = nearest(x - 0.5);
    (cell, [weight(0, x), weight(1, x), weight(2, x), weight(3, x)])
}

#[inline(always)]
fn weight<L: Lanes>(i: usize, x: L) -> L {
    let [a, b, c, d] = POWERS.map(|power| power[i]);
    x * (x * (x * d + c) + b) + a
}

/// The cell of x ∈ [0, cells], which is also the first of its four coefficients, and their weights.
/// x = cells may also count to a cell beyond, with 0 for the weight of its last coefficient.
#[inline(always)]
pub(super) fn cubic_weights(x: f32) -> (usize, f32x4) {
    let (cell, x) = nearest(f32x4::splat(x - 0.5));
    let [a, b, c, d] = POWERS.map(f32x4::from);
    (cell.to_array()[0] as usize, a + x * (b + x * (c + x * d)))
}

/// The coefficients of the quadratic spline through rows of `width` values: two rows more than
/// nodes, of which there are one, or at least three.
pub(super) fn quadratic(mut rows: Vec<f64>, width: usize) -> Vec<f64> {
    let n = rows.len() / width;
    if n == 1 {
        return rows.repeat(THREE);
    }
    // At the ends the spline goes on as one parabola, which leaves differences of two
    // coefficients; between them (a + 6b + c)/8 is the value of a node.
    let difference = |i: usize, j: usize| -> Vec<f64> {
        (0..width).map(|k| rows[i * width + k] - rows[j * width + k]).collect()
    };
    let ends = [difference(0, 1), difference(n - 1, n - 2)];
    for x in &mut rows {
        *x *= 8.0;
    }
    let last = (n - 1) * width;
    rows[..width].copy_from_slice(&ends[0]);
    rows[last..].copy_from_slice(&ends[1]);
    solve(&mut rows, width, 6.0, -1.0);
    let beyond = |a: usize, b: usize, c: usize| -> Vec<f64> {
        let at = |row: usize, k: usize| rows[row * width + k];
        (0..width).map(|k| 3.0 * (at(a, k) - at(b, k)) + at(c, k)).collect()
    };
    let (mut all, after) = (beyond(0, 1, 2), beyond(n - 1, n - 2, n - 3));
    all.extend(rows);
    all.extend(after);
    all
}

/// The coefficients of the cubic spline through rows of `width` values: two rows more than nodes,
/// of which there are at least five. The outermost two cells at each end share one cubic.
pub(super) fn cubic(rows: &[f64], width: usize) -> Vec<f64> {
    let n = rows.len() / width;
    let mut all = alloc::vec![0.0; width];
    all.extend(rows.iter().map(|x| 6.0 * x));
    all.resize(all.len() + width, 0.0);
    let node = |row: usize, k: usize| rows[row * width + k];
    for k in 0..width {
        // One cubic through three nodes makes the coefficient at the middle one explicit.
        for i in [1, n - 2] {
            all[(i + 1) * width + k] = (8.0 * node(i, k) - node(i - 1, k) - node(i + 1, k)) / 6.0;
        }
    }
    solve(&mut all[2 * width..n * width], width, 4.0, 0.0);
    for k in 0..width {
        for (node, [at, inner, end, beyond]) in
            [(1, [2, 3, 1, 0]), (n - 2, [n - 1, n - 2, n, n + 1])]
        {
            let [a, b] = [at, inner].map(|row| all[row * width + k]);
            let outer = if node == 1 { 0 } else { n - 1 };
            let first = 6.0 * rows[node * width + k] - 4.0 * a - b;
            all[end * width + k] = first;
            all[beyond * width + k] = 6.0 * rows[outer * width + k] - 4.0 * first - a;
        }
    }
    all
}

/// Solves for coefficients whose sum of neighbours and `diagonal` times the coefficient is given,
/// but the first and the last with `end` times their one neighbour.
fn solve(rows: &mut [f64], width: usize, diagonal: f64, end: f64) {
    let n = rows.len() / width;
    let mut above: Vec<f64> = Vec::with_capacity(n);
    for i in 0..n {
        let (before, middle, after) = match i {
            0 => (0.0, 1.0, end),
            _ if i == n - 1 => (end, 1.0, 0.0),
            _ => (1.0, diagonal, 1.0),
        };
        let pivot = middle - before * above.last().unwrap_or(&0.0);
        above.push(after / pivot);
        for k in i * width..(i + 1) * width {
            let known = if i > 0 { before * rows[k - width] } else { 0.0 };
            rows[k] = (rows[k] - known) / pivot;
        }
    }
    for i in (0..n - 1).rev() {
        for k in i * width..(i + 1) * width {
            rows[k] -= above[i] * rows[k + width];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two functions, side by side.
    fn rows(n: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).flat_map(|i| [of(i as f64), 1.0 - of(i as f64)]).collect()
    }

    fn one(x: f32) -> (usize, [f32; THREE]) {
        let Place { first, weights } = quadratic_weights(f32x4::splat(x));
        (first[1], weights.map(|weight| weight.to_array()[1]))
    }

    #[test]
    fn parabolas_and_cubics_are_met() {
        let (parabola, cube) = (|x: f64| 0.3 + x * (0.2 - 0.1 * x), |x: f64| x * (x - 3.0) * x);
        for n in [3, 4, 5, 9] {
            let all = quadratic(rows(n, parabola), 2);
            assert_eq!(all.len(), 2 * (n + 2));
            for i in 0..=20 {
                let x = (n - 1) as f64 * f64::from(i) / 20.0;
                let (start, weights) = one(x as f32);
                let at = |j: usize| all[2 * (start + j)];
                let got: f64 = (0..3).map(|j| f64::from(weights[j]) * at(j)).sum();
                assert!((got - parabola(x)).abs() < 3e-6, "{n} {x}: {got}");
            }
        }
        for n in [5, 6, 12] {
            let all = cubic(&rows(n, cube), 2);
            assert_eq!(all.len(), 2 * (n + 2));
            for i in 0..=20 {
                let x = (n - 1) as f64 * f64::from(i) / 20.0;
                let (cell, weights) = cubic_weights((x as f32).min(n as f32 - 1.000_001));
                let weights = weights.to_array();
                let at = |j: usize| all[2 * (cell + j)];
                let got: f64 = (0..4).map(|j| f64::from(weights[j]) * at(j)).sum();
                assert!((got - cube(x)).abs() < 1e-6 * cube(11.0), "{n} {x}: {got}");
            }
        }
    }

    #[test]
    fn nodes_are_met_and_one_node_is_a_constant() {
        let steep = |x: f64| 1.0 / (0.2 + x);
        let all = quadratic(rows(7, steep), 2);
        for i in 0..7 {
            let (start, weights) = one(i as f32);
            let at = |j: usize| all[2 * (start + j)];
            let got: f64 = (0..3).map(|j| f64::from(weights[j]) * at(j)).sum();
            assert!((got - steep(i as f64)).abs() < 1e-6);
        }
        assert_eq!(quadratic(rows(1, steep), 2)[4], steep(0.0));
    }
}
