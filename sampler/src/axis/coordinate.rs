//! What every coordinate says of itself: to those who check a file, and to those who place the nodes of a new table.

use alloc::vec::Vec;

/// A coordinate t along an axis, with its parameters.
pub(crate) trait Coordinate {
    /// The formula in one line, with the names of the parameters: what a file says of it, and `docs/format.md`.
    fn formula(&self) -> &'static str;

    /// Whether the parameters are in range, or else what is wrong.
    fn check(&self) -> Result<(), &'static str> {
        Ok(())
    }

    /// Smallest and largest t.
    fn range(&self) -> [f64; 2] {
        [0.0, 1.0]
    }

    /// Where its nodes stand.
    fn placement(&self) -> Placement {
        Placement::Even
    }

    /// Whether it can have so many nodes, or else what is wrong; a number of 0 is refused before.
    fn check_count(&self, n: usize) -> Result<(), &'static str> {
        if n < 2 && self.placement() == Placement::Even {
            Err("needs at least two nodes")
        } else {
            Ok(())
        }
    }

    /// How many values stand along an axis of n nodes.
    fn values(&self, n: usize) -> usize {
        n
    }
}

/// Where the nodes of an axis stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Placement {
    /// Anywhere in the coordinate's range.
    Free,
    /// Evenly over [0, 1], both of which are nodes.
    Even,
    /// Evenly over [0, 1), for 1 is 0 again.
    Closed,
}

impl Placement {
    /// Where the i-th of n nodes stands; `None` if anywhere.
    pub(crate) fn node(self, i: usize, n: usize) -> Option<f64> {
        match self {
            Self::Free => None,
            // A single node is 0.
            Self::Even => Some(i as f64 / (n - 1).max(1) as f64),
            Self::Closed => Some(i as f64 / n as f64),
        }
    }
}

/// `count` ≥ 2 numbers evenly from `low` to `high`, both of which are met exactly.
pub fn even_nodes(low: f64, high: f64, count: usize) -> Vec<f64> {
    let step = (high - low) / (count - 1) as f64;
    (0..count).map(|i| if i + 1 == count { high } else { low + i as f64 * step }).collect()
}

/// Whether every one of some parameters is positive and not absurd, so that no product of a few leaves the range of numbers;
/// NaN is neither.
pub(super) fn positive(parameters: &[f64]) -> bool {
    parameters.iter().all(|x| (1e-12..1e6).contains(x))
}

/// The x ∈ [low, high] at which an ascending function reaches `target`, by bisection down to the last bit.
pub(super) fn bisect(mut low: f64, mut high: f64, target: f64, f: impl Fn(f64) -> f64) -> f64 {
    // Some 55 halvings, more for a root close to 0.
    loop {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            return middle;
        }
        if f(middle) < target { low = middle } else { high = middle }
    }
}
