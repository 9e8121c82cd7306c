//! The position of a view among the nodes of a table, at one azimuth.

use microfacet_tables::axis::lagrange::{SIX, six};
use microfacet_tables::axis::{PreparedCritical, PreparedView};

pub(super) enum Elevation<'a> {
    Blend(&'a PreparedView),
    Critical(&'a PreparedCritical),
}

impl Elevation<'_> {
    /// The first of the six of `n` nodes about cos θ, and their weights.
    pub(super) fn six(&self, cos: f32, n: usize) -> (usize, [f32; SIX]) {
        match self {
            Self::Blend(view) => six(view.clamped(cos), n),
            Self::Critical(view) => view.six(f64::from(cos), n),
        }
    }

    /// The view of the first node.
    pub(super) fn floor(&self) -> f64 {
        match self {
            Self::Blend(view) => view.floor(),
            Self::Critical(view) => view.floor(),
        }
    }

    /// The coordinate of a view no lower than the first node.
    pub(super) fn coordinate(&self, cos: f64) -> f64 {
        match self {
            Self::Blend(view) => view.coordinate(cos),
            Self::Critical(view) => view.coordinate(cos),
        }
    }

    /// The t at which the coordinate turns sharply, between sections of equal width, if there are
    /// any.
    pub(super) fn ends(&self) -> &[f64] {
        match self {
            Self::Blend(_) => &[],
            Self::Critical(view) => view.ends(),
        }
    }
}
