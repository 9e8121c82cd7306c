//! The coordinate of views among the nodes of a table, at one azimuth.

use microfacet_tables::Mapping;
use microfacet_tables::axis::lagrange::{SIX, six};
use microfacet_tables::axis::{CriticalBlend, PreparedCritical, PreparedView, ViewBlend};

/// The coordinate of views, before the material is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// From outside, or of a lobe that does not refract.
    Blend(ViewBlend),
    /// From the dense side of a dielectric, with 1/η of it.
    Critical(CriticalBlend, f64),
}

/// The coordinate of views for one material.
#[derive(Clone, Copy, Debug)]
pub(super) enum Elevation {
    Blend(PreparedView),
    Critical(PreparedCritical),
}

impl View {
    /// Of the axis of a table of dielectrics of index η, or of one that does not read η.
    pub(super) fn of(mapping: Mapping, eta: f64) -> Option<Self> {
        match mapping {
            Mapping::ViewBlend(blend) => Some(Self::Blend(blend)),
            Mapping::CriticalBlend(blend) => Some(Self::Critical(blend, 1.0 / eta)),
            _ => None,
        }
    }

    pub(super) fn prepare(&self, sigma: f64, gamma: f64) -> Elevation {
        match self {
            Self::Blend(blend) => Elevation::Blend(blend.prepare(sigma, gamma)),
            Self::Critical(blend, inverse) => {
                Elevation::Critical(blend.prepare(sigma, gamma, *inverse))
            }
        }
    }
}

impl Elevation {
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
