//! How values between the nodes of an axis are interpolated, and of which nodes.

use serde::{Deserialize, Serialize};

use super::lagrange;

/// How values between nodes are interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Interpolation {
    /// Linear.
    Linear,
    /// The cubic Hermite polynomial of the channels `value` and `slope`, the slope being the
    /// derivative with respect to the node index.
    Hermite,
    /// The Lagrange polynomial through the four nearest nodes (fewer if the axis has fewer).
    Lagrange4,
    /// The Lagrange polynomial through the six nearest nodes, evenly spaced in the coordinate
    /// (fewer if the axis has fewer).
    Lagrange6,
    /// None: only the nodes themselves are covered.
    Nodes,
}

impl Interpolation {
    /// The number of nodes that an interpolated value depends on; 1 for [`Nodes`](Self::Nodes).
    pub const fn window(self) -> usize {
        match self {
            Self::Linear | Self::Hermite => 2,
            Self::Lagrange4 => 4,
            Self::Lagrange6 => lagrange::SIX,
            Self::Nodes => 1,
        }
    }
}

/// The part of an axis that holds t, of those that meet at `knots`: the number of nodes before it,
/// and its own. A knot between the nodes belongs to both, and a t there to the one above.
pub(super) fn part<'a>(nodes: &'a [f64], knots: &[f64], t: f64) -> (usize, &'a [f64]) {
    let (mut first, mut last) = (0, nodes.len());
    for &knot in knots {
        let at = nodes.partition_point(|&node| node < knot);
        // A knot that is no node between others separates none.
        if nodes.get(at) != Some(&knot) {
            continue;
        }
        if t < knot {
            last = last.min(at + 1);
        } else {
            first = first.max(at);
        }
    }
    (first, &nodes[first..last])
}
