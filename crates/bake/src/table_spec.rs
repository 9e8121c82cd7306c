//! Specifications of the tables to bake.

use microfacet_core::shape::s_of_gamma;
use microfacet_tables::axis::lagrange::nodes_read;
use microfacet_tables::axis::{InverseShape, even_nodes};
use microfacet_tables::{Interpolation, Kind, Precision};

pub use crate::quality::{Level, Quality, Resolution};
pub use microfacet_tables::GAMMA_MIN;

/// γ from which the whole visible distribution is tabulated; for smaller γ its heavy part is
/// peeled.
pub const GAMMA_WHOLE: f64 = 1.8;

/// The γ axis of a table, as nodes in s = 1/(γ−1).
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeAxis {
    /// Ascending nodes.
    pub nodes: Vec<f64>,
    /// `Nodes` for a list of single shapes, `Lagrange4` for a range.
    pub interpolation: Interpolation,
}

impl ShapeAxis {
    /// `count` nodes evenly over [low, high] in s.
    pub fn range(low: f64, high: f64, count: usize) -> Self {
        Self { nodes: even_nodes(low, high, count), interpolation: Interpolation::Lagrange4 }
    }

    /// Nodes over [low, high] crowded towards s = 2 by [`InverseShape::crowded_nodes`].
    pub fn crowded(low: f64, high: f64, count: usize, linear: f64) -> Self {
        let nodes = InverseShape::crowded_nodes(low, high, count, linear);
        Self { nodes, interpolation: Interpolation::Lagrange4 }
    }

    /// The first and the last node.
    pub fn ends(&self) -> [f64; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// The nodes of a range that interpolation in [from, to] reads.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let nodes = nodes_read(&self.nodes, from, to, self.interpolation.window()).to_vec();
        Self { nodes, ..*self }
    }

    /// Single shapes, sorted and without repetition.
    pub fn points(s: impl IntoIterator<Item = f64>) -> Self {
        let mut nodes: Vec<f64> = s.into_iter().collect();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        Self { nodes, interpolation: Interpolation::Nodes }
    }
}

/// A table to bake.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSpec {
    /// Name in the set.
    pub name: String,
    /// What the table holds.
    pub kind: Kind,
    /// The γ axis.
    pub shapes: ShapeAxis,
    /// The shapes it covers, as [min, max] of s; the axis may have nodes beyond, which
    /// interpolation reads.
    pub covers: [f64; 2],
    /// Nodes of the view axis; unused by kinds without one.
    pub views: usize,
    /// Nodes of a (half) axis of random numbers; unused by kinds without one.
    pub numbers: usize,
    /// How values are stored.
    pub precision: Precision,
}

impl TableSpec {
    /// Number of pairs of value and slope; in 128 bits, where no product of three lengths
    /// overflows.
    pub fn nodes(&self) -> u128 {
        let (views, numbers) = (self.views as u128, self.numbers as u128);
        let per_shape = match self.kind {
            Kind::Shadowing => views,
            Kind::VisibleSlopeConditional => numbers,
            // Both halves of u₁.
            _ => views.saturating_mul(2 * numbers),
        };
        per_shape.saturating_mul(self.shapes.nodes.len() as u128)
    }

    /// Number of values.
    pub fn values(&self) -> u128 {
        self.nodes().saturating_mul(Kind::VALUE_AND_SLOPE.len() as u128)
    }

    /// Bytes of its values as they are stored.
    pub fn bytes(&self) -> usize {
        let bytes = self.values().saturating_mul(self.precision.bytes() as u128);
        bytes.try_into().unwrap_or(usize::MAX)
    }
}

/// Distance in s from the seam at γ = [`GAMMA_WHOLE`] up to which the tables of the whole
/// distribution serve, and from which those of peeled slopes are measured.
pub(crate) const SEAM: f64 = 1e-9;

/// The general set: every γ ∈ [1.501, ∞], and by shape invariance every σ.
pub fn general_set(level: impl Into<Level>, precision: Precision) -> Vec<TableSpec> {
    let r = level.into().resolution();
    let (whole, heaviest) = (s_of_gamma(GAMMA_WHOLE), s_of_gamma(GAMMA_MIN));
    let spec = |kind: Kind, shapes: ShapeAxis, views, numbers| TableSpec {
        name: kind.name().into(),
        kind,
        covers: shapes.ends(),
        shapes,
        views,
        numbers,
        precision,
    };
    // Crowded shapes: G1 changes with the logarithm of 2 − s next to γ = 3/2, and with even nodes
    // in s most of the error of slopes is at grazing views next to the seam.
    let (range, crowded) = (ShapeAxis::range, ShapeAxis::crowded);
    let peeled = crowded(whole, heaviest, r.shadowing_shapes, 2.0);
    let peeled = spec(Kind::Shadowing, peeled, r.peeled_shadowing_views, 0);
    let across = range(0.0, heaviest, r.across_shapes);
    vec![
        spec(Kind::Shadowing, range(0.0, whole, r.shadowing_shapes), r.shadowing_views, 0),
        TableSpec { name: "shadowing_peeled".into(), ..peeled },
        spec(Kind::VisibleSlope, crowded(0.0, whole, r.shapes, 0.0), r.views, r.numbers),
        spec(Kind::VisibleSlopePeeled, range(whole, heaviest, r.peeled_shapes), r.views, r.numbers),
        spec(Kind::VisibleSlopeConditional, across, 0, r.across_numbers),
    ]
}
