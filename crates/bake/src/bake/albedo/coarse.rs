//! Coarse tables of dielectrics over ranges of γ, σ and η: few nodes, spread evenly over what is
//! covered and no more.

use microfacet_sampler::Masking;
use microfacet_tables::axis::{CriticalBlend, LogRoughness, LogShape, ViewBlend, even_nodes};
use microfacet_tables::{Axis, Interpolation, Interval, Mapping, Precision, Reflectance, Side};

use super::{AlbedoLobe, AlbedoSpec};
use crate::table_spec::Level;

/// The numbers of nodes of a coarse table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoarseNodes {
    /// Of γ.
    pub shapes: usize,
    /// Of σ.
    pub roughnesses: usize,
    /// Of η.
    pub indices: usize,
    /// Of views from the thin side, and in either half of those from the dense side.
    pub views: [usize; 2],
}

/// Tolerance of a node. The quadrature's estimates of errors are conservative: throughout the
/// domain even 1e-2 gives values that are right to 2e-4.
const TOLERANCE: f64 = 1e-3;

impl CoarseNodes {
    /// The nodes of a level, found by measuring
    /// (`cargo run --release -p microfacet-study -- dielectric_design`).
    pub fn at(level: Level) -> Self {
        let nodes = |counts| level.nodes(counts, 6);
        Self {
            shapes: nodes([6, 6, 9]),
            roughnesses: nodes([16, 22, 32]),
            indices: nodes([6, 6, 8]),
            views: [nodes([17, 21, 31]), nodes([25, 35, 51])],
        }
    }

    /// Nodes of the dense side's views, on both sides of the critical angle.
    pub fn dense(&self) -> usize {
        2 * self.views[1] - 1
    }
}

impl AlbedoSpec {
    /// Coarse tables of one side of dielectrics, of the family over ranges of γ and σ. They are not
    /// refined, since the nodes aim at too little for that.
    pub fn coarse(
        lobe: AlbedoLobe,
        (side, index): (Side, Interval),
        maskings: Vec<Masking>,
        nodes: &CoarseNodes,
        precision: Precision,
    ) -> Self {
        let (shape, rough) = (LogShape::BAKED, LogRoughness::BAKED);
        let of = |name, mapping, ends: [f64; 2], count| {
            let axis = Axis::new(name, mapping, Interpolation::Lagrange6, Vec::new());
            let [from, to] = ends.map(|x| axis.coordinate(x).expect("an axis of a quantity"));
            Axis { nodes: even_nodes(from, to, count), ..axis }
        };
        let (view, views) = match side {
            Side::Thin => (Mapping::ViewBlend(ViewBlend::BAKED), nodes.views[0]),
            Side::Dense => (Mapping::CriticalBlend(CriticalBlend::BAKED), nodes.dense()),
        };
        let Interval { min, max } = lobe.roughness.x();
        let sigmas = [min.max(rough.first), max];
        let gammas = [lobe.gamma.max, lobe.gamma.min];
        let axes = vec![
            of("gamma", Mapping::LogShape(shape), gammas, nodes.shapes),
            of("sigma", Mapping::LogRoughness(rough), sigmas, nodes.roughnesses),
            of("eta", Mapping::ReflectanceRoot, index.into(), nodes.indices),
            Axis::placed("view", view, Interpolation::Lagrange6, views),
        ];
        let reflectance = Reflectance::Interface { side, index };
        Self { lobe, reflectance, maskings, axes, tolerance: TOLERANCE, precision }
    }
}
