//! The albedos of dielectrics of one index of refraction at any shape and roughness: the nodes of
//! the set's own tables, with the axis of the index collapsed, so that errors are those of the
//! tables' certificates.

use alloc::vec::Vec;

use microfacet_core::Masking;
use microfacet_core::math::unit;
use microfacet_tables::axis::lagrange::{SIX, few, six};
use microfacet_tables::axis::{LogRoughness, LogShape};
use microfacet_tables::{Axis, Interpolation, Mapping, Table};
use wide::f32x4;

use super::curve::{DielectricAlbedo, MaterialPoint, ViewCurve};
use super::elevation::{Elevation, View};

/// Lanes of six nodes of two channels.
const LANES: usize = 3;

/// The albedos of dielectrics of one index, under one form of masking.
#[derive(Clone, Debug)]
pub(crate) struct InterfaceAlbedos {
    pub(crate) masking: Masking,
    shapes: Nodes<LogShape>,
    sigmas: Nodes<LogRoughness>,
    /// Seen from outside, and from inside.
    sides: [Side; 2],
}

/// The shares of light reflected and transmitted, seen from one side.
#[derive(Clone, Debug)]
struct Side {
    view: View,
    /// Nodes along the view.
    views: usize,
    /// Both shares at the nodes: by γ, by σ, by view.
    values: Vec<f32>,
}

/// Nodes along an axis of the material, evenly spaced in its coordinate.
#[derive(Clone, Debug, PartialEq)]
struct Nodes<M> {
    /// `None` for one node.
    coordinate: Option<M>,
    /// The coordinates of the nodes.
    at: Vec<f64>,
    /// The smallest and the largest quantity that is covered; nodes may lie beyond.
    ends: [f64; 2],
    quantities: Vec<f64>,
}

/// Six nodes from the first on, and their weights. Where there are fewer nodes, the last weights
/// are 0.
type Six = (usize, [f32; SIX]);

/// A place among the nodes of γ and σ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    shape: Six,
    sigma: Six,
    /// Nodes of σ.
    width: usize,
}

/// An axis of the material of [`InterfaceTables`], whose nodes are evenly spaced in a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceAxis<M> {
    /// `None` for one node.
    pub coordinate: Option<M>,
    /// The coordinates of the nodes.
    pub nodes: Vec<f64>,
    /// The smallest and the largest quantity that is covered.
    pub ends: [f64; 2],
}

/// The shares of [`InterfaceTables`] seen from one side, and what is derived from them at each node
/// of γ and σ, those of σ fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceSide {
    /// The coordinate of views.
    pub view: View,
    /// Nodes along the view.
    pub views: usize,
    /// The shares reflected and transmitted: by γ, by σ, by view.
    pub values: Vec<[f32; 2]>,
    /// Averages over views: reflected, transmitted, the binary logarithm of what is lost, and
    /// transmitted with Turquin's factor.
    pub averages: Vec<[f32; 4]>,
    /// The density of further bounces: factors at the ends of its bands, and shares below them.
    pub bands: Vec<[[f32; 33]; 2]>,
}

/// The albedos of dielectrics of one index of refraction at any γ and σ, as
/// [`FamilyDielectric`](crate::FamilyDielectric) reads them, for exports to other languages.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceTables {
    /// The index, inside over outside.
    pub eta: f32,
    /// The form of masking.
    pub masking: Masking,
    /// The average that a smooth interface transmits from outside.
    pub smooth_transmitted: f32,
    /// γ.
    pub shapes: InterfaceAxis<LogShape>,
    /// σ.
    pub sigmas: InterfaceAxis<LogRoughness>,
    /// Seen from outside, and from inside.
    pub sides: [InterfaceSide; 2],
}

impl<M: Copy> Nodes<M> {
    fn axis(&self) -> InterfaceAxis<M> {
        let Self { coordinate, at, ends, .. } = self;
        InterfaceAxis { coordinate: *coordinate, nodes: at.clone(), ends: *ends }
    }

    /// Of an axis between two quantities; of no axis, one node. `None` where nothing is to be read
    /// between nodes.
    fn new(
        axis: Option<(&Axis, M)>,
        ends: [f64; 2],
        quantity: impl Fn(&M, f64) -> f64,
    ) -> Option<Self> {
        let Some((axis, mapping)) = axis else {
            let (at, quantities) = (alloc::vec![0.0], alloc::vec![ends[0]]);
            return Some(Self { coordinate: None, at, ends: [ends[0]; 2], quantities });
        };
        // Nodes of `Lagrange6` are even, which is checked when a table is loaded.
        if axis.len() > 1 && axis.interpolation != Interpolation::Lagrange6 {
            return None;
        }
        let quantities: Vec<f64> = axis.nodes.iter().map(|&t| quantity(&mapping, t)).collect();
        // Of a mirror, the smallest roughness that is not one.
        let ends = [ends[0].max(quantities.iter().fold(f64::INFINITY, |a, &b| a.min(b))), ends[1]];
        Some(Self { coordinate: Some(mapping), at: axis.nodes.clone(), ends, quantities })
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
        (x, (0, few(&self.at, t)))
    }
}

impl Nodes<LogShape> {
    fn of_shapes(table: &Table) -> Option<Self> {
        let axis = table.axes.iter().find_map(|axis| match axis.mapping {
            Mapping::LogShape(mapping) => Some((axis, mapping)),
            _ => None,
        });
        Self::new(axis, table.subject.lobe.gamma.into(), LogShape::quantity)
    }
}

impl Nodes<LogRoughness> {
    fn of_roughnesses(table: &Table) -> Option<Self> {
        let axis = table.axes.iter().find_map(|axis| match axis.mapping {
            Mapping::LogRoughness(mapping) => Some((axis, mapping)),
            _ => None,
        });
        Self::new(axis, table.subject.lobe.roughness.x().into(), LogRoughness::quantity)
    }
}

impl Place {
    /// The sum over the nodes about the place of what is added for each of them, by its index and
    /// its weight.
    #[inline(always)]
    fn each(&self, mut add: impl FnMut(usize, f32)) {
        let ((first, weights), (start, inner)) = (self.shape, self.sigma);
        for (i, a) in weights.into_iter().enumerate() {
            // Where there are fewer than six nodes, the last weights are 0.
            if a == 0.0 {
                continue;
            }
            let row = (first + i) * self.width + start;
            for (j, b) in inner.into_iter().enumerate() {
                if b != 0.0 {
                    add(row + j, a * b);
                }
            }
        }
    }

    /// The value at the place of what is tabulated at the nodes.
    pub(crate) fn interpolate(&self, nodes: &[f32x4]) -> f32x4 {
        let mut sum = f32x4::ZERO;
        self.each(|node, weight| sum += nodes[node] * weight);
        sum
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
    /// The shares reflected and transmitted of a view at cos θ, each in [0, 1].
    #[inline]
    fn shares(&self, place: &Place, view: &Elevation, cos: f32) -> [f32; 2] {
        let Self { views, values, .. } = self;
        let (start, [a, b, c, d, e, f]) = view.six(unit(cos), *views);
        let mut sum = [f32x4::ZERO; LANES];
        place.each(|node, weight| {
            let from = 2 * (node * views + start);
            let nodes: &[f32; 2 * SIX] = values[from..].first_chunk().expect("six views");
            let (fours, _) = nodes.as_chunks::<4>();
            for (sum, four) in sum.iter_mut().zip(fours) {
                *sum += f32x4::from(*four) * weight;
            }
        });
        let weights = [[a, a, b, b], [c, c, d, d], [e, e, f, f]].map(f32x4::from);
        let [p, q, r, s] =
            (sum[0] * weights[0] + sum[1] * weights[1] + sum[2] * weights[2]).to_array();
        // Interpolation may leave [0, 1] by the table's error.
        [p + r, q + s].map(unit)
    }
}

/// The shares of light at one γ and σ, from both sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InterfaceAt<'a> {
    albedos: &'a InterfaceAlbedos,
    pub(crate) place: Place,
    sigma: f64,
    gamma: f64,
    outside: Elevation,
}

impl InterfaceAt<'_> {
    /// The shares reflected and transmitted of a view at cos θ, from outside for side 0.
    #[inline]
    pub(crate) fn shares(&self, side: usize, cos: f32) -> [f32; 2] {
        let of = &self.albedos.sides[side];
        if side == 0 {
            return of.shares(&self.place, &self.outside, cos);
        }
        // Views from inside are few, and plastics have none.
        of.shares(&self.place, &of.view.prepare(self.sigma, self.gamma), cos)
    }
}

impl InterfaceAlbedos {
    /// From the tables of the thin and of the dense side; η ∈ (0, ∞), inside over outside. `each`
    /// is called for every node of γ and σ, those of σ fastest.
    ///
    /// `None` where the tables do not hold the index, or one has other nodes than the other.
    pub(super) fn new(
        [thin, dense]: [&Table; 2],
        eta: f64,
        mut each: impl FnMut(&DielectricAlbedo),
    ) -> Option<Self> {
        let masking = thin.subject.masking?;
        let index = eta.max(1.0 / eta);
        let tables = if eta < 1.0 { [dense, thin] } else { [thin, dense] };
        let [shapes, other_shapes] = tables.map(Nodes::of_shapes);
        let [sigmas, other_sigmas] = tables.map(Nodes::of_roughnesses);
        if shapes != other_shapes || sigmas != other_sigmas {
            return None;
        }
        let (shapes, sigmas) = (shapes?, sigmas?);
        let mut values = [const { Vec::new() }; 2];
        for (i, &gamma) in shapes.quantities.iter().enumerate() {
            for (j, &sigma) in sigmas.quantities.iter().enumerate() {
                let point = MaterialPoint { sigma, gamma, eta: index };
                let curves = tables.map(|table| ViewCurve::of_node(table, [i, j], &point));
                let [outside, inside] = curves;
                let albedo = DielectricAlbedo { masking, outside: outside?, inside: inside? };
                values[0].extend(albedo.outside.nodes().flatten());
                values[1].extend(albedo.inside.nodes().flatten());
                each(&albedo);
            }
        }
        let side = |table: &Table, values| {
            let axis = table.axes.last()?;
            let view = View::of(axis.mapping, index)?;
            Some(Side { view, views: axis.len(), values })
        };
        let [outside, inside] = values;
        let sides = [side(tables[0], outside)?, side(tables[1], inside)?];
        Some(Self { masking, shapes, sigmas, sides })
    }

    /// At a σ and γ, clamped to what is covered.
    pub(crate) fn at(&self, sigma: f32, gamma: f32) -> InterfaceAt<'_> {
        let (gamma, shape) = self.shapes.place(gamma.into(), LogShape::coordinate);
        let (sigma, of_sigma) = self.sigmas.place(sigma.into(), LogRoughness::coordinate);
        let place = Place { shape, sigma: of_sigma, width: self.sigmas.len() };
        let outside = self.sides[0].view.prepare(sigma, gamma);
        InterfaceAt { albedos: self, place, sigma, gamma, outside }
    }

    /// The axes and shares, without what is derived from them.
    pub(crate) fn tables(&self, eta: f32, smooth_transmitted: f32) -> InterfaceTables {
        let sides = self.sides.each_ref().map(|Side { view, views, values }| InterfaceSide {
            view: *view,
            views: *views,
            values: values.as_chunks().0.to_vec(),
            averages: Vec::new(),
            bands: Vec::new(),
        });
        let (masking, shapes, sigmas) = (self.masking, self.shapes.axis(), self.sigmas.axis());
        InterfaceTables { eta, masking, smooth_transmitted, shapes, sigmas, sides }
    }

    /// The memory that it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.sides.iter().map(|side| size_of_val(&side.values[..])).sum()
    }
}
