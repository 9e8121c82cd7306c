//! The albedos of dielectrics of one index of refraction at any shape and roughness: the nodes of
//! the set's own tables, with the axis of the index collapsed, so that errors are those of the
//! tables' certificates.

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_tables::axis::lagrange::{SIX, six, weights};
use microfacet_tables::axis::{
    CriticalBlend, LogRoughness, LogShape, PreparedCritical, PreparedView, ViewBlend,
};
use microfacet_tables::{Axis, Mapping, Table};
use wide::f32x4;

use super::curve::{DielectricAlbedo, MaterialPoint, ViewCurve};
use super::elevation::Elevation;

/// Lanes of six nodes of two channels.
const LANES: usize = 3;

/// The albedos of dielectrics of one index, under one form of masking.
#[derive(Clone, Debug)]
pub(crate) struct InterfaceAlbedos {
    pub(crate) masking: Masking,
    /// Seen from outside, and from inside.
    sides: [Side; 2],
}

/// The shares of light reflected and transmitted, seen from one side.
#[derive(Clone, Debug)]
struct Side {
    grid: Grid,
    view: View,
    /// Nodes along the view.
    views: usize,
    /// Both shares at the nodes: by γ, by σ, by view.
    values: Vec<[f32; 2]>,
}

/// The nodes of γ and σ.
#[derive(Clone, Debug)]
struct Grid {
    shapes: Nodes<LogShape>,
    sigmas: Nodes<LogRoughness>,
}

/// Nodes along an axis of the material, evenly spaced in its coordinate.
#[derive(Clone, Debug)]
struct Nodes<M> {
    /// `None` for one node.
    coordinate: Option<M>,
    /// The coordinates of the nodes.
    at: Vec<f64>,
    /// The smallest and the largest quantity.
    ends: [f64; 2],
    quantities: Vec<f64>,
}

/// Six nodes from the first on, and their weights. Where there are fewer nodes, the last weights
/// are 0.
pub(crate) type Six = (usize, [f32; SIX]);

/// A place among the nodes of γ and σ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    shape: Six,
    sigma: Six,
    /// Nodes of σ.
    width: usize,
}

#[derive(Clone, Copy, Debug)]
enum View {
    Blend(ViewBlend),
    /// With 1/η of the dense side.
    Critical(CriticalBlend, f64),
}

/// The view's coordinate at one γ and σ.
#[derive(Clone, Copy, Debug)]
enum PreparedFor {
    Blend(PreparedView),
    Critical(PreparedCritical),
}

impl<M: Copy> Nodes<M> {
    /// Of an axis between two quantities; of no axis, one node.
    fn new(axis: Option<(&Axis, M)>, ends: [f64; 2], quantity: impl Fn(&M, f64) -> f64) -> Self {
        let Some((axis, mapping)) = axis else {
            let quantities = alloc::vec![ends[0]];
            return Self { coordinate: None, at: alloc::vec![0.0], ends: [ends[0]; 2], quantities };
        };
        // A coordinate and its inverse may round to a quantity beyond an end.
        let within = |&t: &f64| quantity(&mapping, t).max(ends[0]).min(ends[1]);
        let quantities: Vec<f64> = axis.nodes.iter().map(within).collect();
        let ends = quantities
            .iter()
            .fold([f64::INFINITY, 0.0_f64], |[low, high], &x| [low.min(x), high.max(x)]);
        Self { coordinate: Some(mapping), at: axis.nodes.clone(), ends, quantities }
    }

    fn len(&self) -> usize {
        self.at.len()
    }

    /// The quantity clamped to the ends (NaN to the first), and the place among the nodes.
    fn place(&self, x: f64, coordinate: impl Fn(&M, f64) -> f64) -> (f64, Six) {
        let x = x.max(self.ends[0]).min(self.ends[1]);
        let mut one = [0.0; SIX];
        one[0] = 1.0;
        let (Some(mapping), [first, .., last]) = (&self.coordinate, &self.at[..]) else {
            return (x, (0, one));
        };
        let t = coordinate(mapping, x);
        if self.len() >= SIX {
            return (x, six(((t - first) / (last - first)) as f32, self.len()));
        }
        let mut all = [0.0; SIX];
        for (i, weight) in weights(&self.at, t, SIX) {
            all[i] = weight as f32;
        }
        (x, (0, all))
    }
}

impl Grid {
    fn of(table: &Table) -> Self {
        let lobe = &table.subject.lobe;
        let of = |which: fn(&Mapping) -> bool| table.axes.iter().find(|axis| which(&axis.mapping));
        let shape = of(|mapping| matches!(mapping, Mapping::LogShape(_)));
        let shape = shape.and_then(|axis| match axis.mapping {
            Mapping::LogShape(mapping) => Some((axis, mapping)),
            _ => None,
        });
        let sigma = of(|mapping| matches!(mapping, Mapping::LogRoughness(_)));
        let sigma = sigma.and_then(|axis| match axis.mapping {
            Mapping::LogRoughness(mapping) => Some((axis, mapping)),
            _ => None,
        });
        Self {
            shapes: Nodes::new(shape, lobe.gamma.into(), LogShape::quantity),
            sigmas: Nodes::new(sigma, lobe.roughness.x().into(), LogRoughness::quantity),
        }
    }

    /// All nodes, those of σ fastest: their indices of γ and σ, and their materials.
    fn nodes(&self, eta: f64) -> impl Iterator<Item = ([usize; 2], MaterialPoint)> {
        let shapes = self.shapes.quantities.iter().enumerate();
        shapes.flat_map(move |(i, &gamma)| {
            let sigmas = self.sigmas.quantities.iter().enumerate();
            sigmas.map(move |(j, &sigma)| ([i, j], MaterialPoint { sigma, gamma, eta }))
        })
    }

    /// σ and γ, clamped to what is covered, and their place.
    fn place(&self, sigma: f32, gamma: f32) -> ([f64; 2], Place) {
        let (gamma, shape) = self.shapes.place(gamma.into(), LogShape::coordinate);
        let (sigma, of_sigma) = self.sigmas.place(sigma.into(), LogRoughness::coordinate);
        ([sigma, gamma], Place { shape, sigma: of_sigma, width: self.sigmas.len() })
    }
}

impl Place {
    /// The rows of the grid about the place with their weights, from the first.
    #[inline(always)]
    fn rows(&self) -> impl Iterator<Item = (usize, f32)> {
        let (&(first, weights), &(start, inner)) = (&self.shape, &self.sigma);
        let width = self.width;
        // Where there are fewer than six nodes, the last weights are 0.
        weights.into_iter().enumerate().filter(|(_, a)| *a != 0.0).flat_map(move |(i, a)| {
            let row = (first + i) * width + start;
            let inner = inner.into_iter().enumerate().filter(|(_, b)| *b != 0.0);
            inner.map(move |(j, b)| (row + j, a * b))
        })
    }

    /// The value at the place of what is tabulated at the nodes.
    pub(crate) fn interpolate(&self, nodes: &[f32x4]) -> f32x4 {
        self.rows().fold(f32x4::ZERO, |sum, (row, weight)| sum + nodes[row] * weight)
    }

    /// The node with the largest weight.
    pub(crate) fn nearest(&self) -> usize {
        let largest = |(start, weights): &Six| {
            let mut best = 0;
            for (i, weight) in weights.iter().enumerate() {
                if *weight > weights[best] {
                    best = i;
                }
            }
            start + best
        };
        largest(&self.shape) * self.width + largest(&self.sigma)
    }
}

impl Side {
    /// `None` where the table does not hold the index of the dense side.
    fn new(table: &Table, dense: f64) -> Option<Self> {
        let grid = Grid::of(table);
        let view = match table.axes.last()?.mapping {
            Mapping::ViewBlend(blend) => View::Blend(blend),
            Mapping::CriticalBlend(blend) => View::Critical(blend, 1.0 / dense),
            _ => return None,
        };
        let mut values = Vec::new();
        for (node, point) in grid.nodes(dense) {
            values.extend(ViewCurve::<2>::of_node(table, node, &point)?.nodes());
        }
        Some(Self { grid, view, views: table.axes.last()?.len(), values })
    }

    fn at(&self, sigma: f32, gamma: f32) -> SideAt<'_> {
        let ([sigma, gamma], place) = self.grid.place(sigma, gamma);
        let view = match self.view {
            View::Blend(blend) => PreparedFor::Blend(blend.prepare(sigma, gamma)),
            View::Critical(blend, inverse) => {
                PreparedFor::Critical(blend.prepare(sigma, gamma, inverse))
            }
        };
        SideAt { side: self, place, view }
    }
}

/// The shares of light seen from one side, at one γ and σ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SideAt<'a> {
    side: &'a Side,
    pub(crate) place: Place,
    view: PreparedFor,
}

impl SideAt<'_> {
    /// The shares reflected and transmitted of a view at cos θ, each in [0, 1].
    pub(crate) fn shares(&self, cos: f32) -> [f32; 2] {
        let Side { views, values, .. } = self.side;
        let elevation = match &self.view {
            PreparedFor::Blend(view) => Elevation::Blend(view),
            PreparedFor::Critical(view) => Elevation::Critical(view),
        };
        let (start, [a, b, c, d, e, f]) = elevation.six(unit(cos), *views);
        let mut sum = [f32x4::ZERO; LANES];
        for (row, weight) in self.place.rows() {
            let nodes: &[[f32; 2]; SIX] =
                values[row * views + start..].first_chunk().expect("six views");
            for (sum, pair) in sum.iter_mut().zip(nodes.as_chunks::<2>().0) {
                let [[p, q], [r, s]] = *pair;
                *sum += f32x4::from([p, q, r, s]) * weight;
            }
        }
        let weights = [[a, a, b, b], [c, c, d, d], [e, e, f, f]].map(f32x4::from);
        let [p, q, r, s] =
            (sum[0] * weights[0] + sum[1] * weights[1] + sum[2] * weights[2]).to_array();
        // Interpolation may leave [0, 1] by the table's error.
        [p + r, q + s].map(unit)
    }
}

impl InterfaceAlbedos {
    /// From the tables of the thin and of the dense side; η ∈ (0, ∞), inside over outside. `each`
    /// is called for every node of γ and σ, those of σ fastest.
    ///
    /// `None` where the tables do not hold the index, or have other nodes than each other.
    pub(super) fn new(
        [thin, dense]: [&Table; 2],
        eta: f64,
        mut each: impl FnMut(&DielectricAlbedo),
    ) -> Option<Self> {
        let masking = thin.subject.masking?;
        let index = eta.max(1.0 / eta);
        let tables = if eta < 1.0 { [dense, thin] } else { [thin, dense] };
        let [outside, inside] = tables.map(|table| Side::new(table, index));
        let all = Self { masking, sides: [outside?, inside?] };
        let [a, b] =
            all.sides.each_ref().map(|side| [side.grid.shapes.len(), side.grid.sigmas.len()]);
        if a != b {
            return None;
        }
        for (node, point) in all.sides[0].grid.nodes(index) {
            let [outside, inside] = tables.map(|table| ViewCurve::of_node(table, node, &point));
            each(&DielectricAlbedo { masking, outside: outside?, inside: inside? });
        }
        Some(all)
    }

    /// Seen from outside and from inside, at a σ and γ that are clamped to what is covered.
    pub(crate) fn at(&self, sigma: f32, gamma: f32) -> [SideAt<'_>; 2] {
        self.sides.each_ref().map(|side| side.at(sigma, gamma))
    }

    /// The memory that it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.sides.iter().map(|side| size_of_val(&side.values[..])).sum()
    }
}
