//! The properties of a coordinate by which files are checked and the nodes of new tables are
//! spaced.

use alloc::vec::Vec;

/// A coordinate t along an axis, with its parameters.
pub(crate) trait Coordinate {
    /// The formula in one line, with the names of the parameters, as in files and `docs/format.md`.
    fn formula(&self) -> &'static str;

    /// What is wrong with the parameters.
    fn fault(&self) -> Option<&'static str> {
        None
    }

    /// Smallest and largest t.
    fn range(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn placement(&self) -> Placement {
        Placement::Even
    }

    /// What is wrong with a number of nodes other than 0.
    fn count_fault(&self, n: usize) -> Option<&'static str> {
        (n < 2 && self.placement() == Placement::Even).then_some("needs at least two nodes")
    }

    /// The t between its first and its last at which parts meet, each of which is interpolated from
    /// its own nodes.
    fn knots(&self) -> &'static [f64] {
        &[]
    }

    /// The number of values along an axis of n nodes.
    fn values(&self, n: usize) -> usize {
        n
    }
}

/// The spacing of the nodes of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Placement {
    /// Anywhere in the coordinate's range.
    Free,
    /// Evenly over [0, 1], both of which are nodes.
    Even,
    /// Evenly over [0, 1), a circle that closes at 1.
    Closed,
}

impl Placement {
    /// The coordinate of the i-th of n nodes; `None` for [`Free`](Self::Free).
    pub(crate) fn node(self, i: usize, n: usize) -> Option<f64> {
        match self {
            Self::Free => None,
            // A single node is 0.
            Self::Even => Some(i as f64 / (n - 1).max(1) as f64),
            Self::Closed => Some(i as f64 / n as f64),
        }
    }
}

/// `count` ≥ 2 numbers spaced evenly from `low` to `high`; both ends are met to the bit.
pub fn even_nodes(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high - low) / (count - 1) as f64;
    (0..count).map(|i| if i + 1 == count { high } else { low + i as f64 * step }).collect()
}

/// Whether all parameters are positive and moderate, so that products of a few of them neither
/// overflow nor vanish; false for NaN.
pub(super) fn positive(parameters: &[f64]) -> bool {
    parameters.iter().all(|x| (1e-12..1e6).contains(x))
}

/// Finds the x ∈ [low, high] where an ascending function reaches `target`, by bisection to the last
/// bit.
pub(super) fn bisect(mut low: f64, mut high: f64, target: f64, f: impl Fn(f64) -> f64) -> f64 {
    // About 55 halvings, more for a root close to 0.
    loop {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            return middle;
        }
        if f(middle) < target { low = middle } else { high = middle }
    }
}
