//! Axes of tables: the quantity along an axis, its nodes, and interpolation between them.
//!
//! Each coordinate has a file with its formula, its inverse, the spacing of its nodes, the checks
//! of its parameters, and the fast evaluations that lookups use, which tests compare with the
//! formula: [`InverseShape`] and [`LogShape`] of γ, [`LogRoughness`] of σ, [`ReflectanceRoot`] and
//! [`CrossingRoot`] of η, [`HalfTangent`], [`Rational`], [`ViewBlend`] and [`CriticalBlend`] of the
//! elevation of a view, [`Azimuth`] of its azimuth, [`MirroredRoot`] and [`OddRoot`] of a random
//! number. Baking, lookups, measurement and export all call them. Interpolation is by Lagrange
//! polynomials ([`lagrange`]) or by Hermite cells.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::error::LoadError;

mod azimuth;
mod coordinate;
mod critical_angle;
mod crowded;
pub mod half_tangent;
pub mod hermite;
mod interpolation;
mod inverse_shape;
pub mod lagrange;
mod log_roughness;
mod log_shape;
mod random_number;
mod rational;
mod refractive_index;
mod view_blend;

pub use azimuth::{Azimuth, PreparedAzimuth};
pub use coordinate::even_nodes;
pub use critical_angle::{CriticalBlend, PreparedCritical};
pub use half_tangent::HalfTangent;
pub use interpolation::Interpolation;
pub use inverse_shape::InverseShape;
pub use log_roughness::LogRoughness;
pub use log_shape::LogShape;
pub use random_number::{MirroredRoot, OddRoot};
pub use rational::Rational;
pub use refractive_index::{CrossingRoot, ReflectanceRoot};
pub use view_blend::{FastBlend, FastView, PreparedView, ViewBlend};

pub use random_number::{above_zero, roots};

use coordinate::Coordinate;
use interpolation::part;

/// How a physical quantity maps to the coordinate along an axis.
///
/// The mapping is data in the file; a reader needs to know only the formula of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Mapping {
    /// The shape γ.
    InverseShape,
    /// The shape γ.
    LogShape(LogShape),
    /// The roughness σ.
    LogRoughness(LogRoughness),
    /// The index of refraction η.
    ReflectanceRoot,
    /// The index of refraction η, in parts.
    CrossingRoot(CrossingRoot),
    /// A view, by z = cot θ_v/σ_v, or a slope.
    HalfTangent(HalfTangent),
    /// A view, by z = cot θ_v/σ_v, or a slope.
    Rational(Rational),
    /// A view, by cos θ_v.
    ViewBlend(ViewBlend),
    /// A view from the dense side of an interface, by cos θ_v.
    CriticalBlend(CriticalBlend),
    /// The azimuth of a view.
    Azimuth(Azimuth),
    /// A random number u.
    MirroredRoot,
    /// A random number u, where the tabulated quantity is odd about u = ½.
    OddRoot,
}

impl Mapping {
    /// One mapping of every kind, with the parameters of baked tables or other valid ones.
    pub const EVERY: [Self; 12] = [
        Self::InverseShape,
        Self::LogShape(LogShape::BAKED),
        Self::LogRoughness(LogRoughness::BAKED),
        Self::ReflectanceRoot,
        Self::CrossingRoot(CrossingRoot { crowded: true }),
        Self::HalfTangent(HalfTangent { knots: Some([[0.7, 0.6], [0.9, 0.8]]) }),
        Self::Rational(Rational::BAKED),
        Self::ViewBlend(ViewBlend::BAKED),
        Self::CriticalBlend(CriticalBlend::BAKED),
        Self::Azimuth(Azimuth { sigma: [0.1, 0.2], turn: 0.3, fold: false }),
        Self::MirroredRoot,
        Self::OddRoot,
    ];

    /// The name of the mapping's kind in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::InverseShape => "inverse_shape",
            Self::LogShape(_) => "log_shape",
            Self::LogRoughness(_) => "log_roughness",
            Self::ReflectanceRoot => "reflectance_root",
            Self::CrossingRoot(_) => "crossing_root",
            Self::HalfTangent(_) => "half_tangent",
            Self::Rational(_) => "rational",
            Self::ViewBlend(_) => "view_blend",
            Self::CriticalBlend(_) => "critical_blend",
            Self::Azimuth(_) => "azimuth",
            Self::MirroredRoot => "mirrored_root",
            Self::OddRoot => "odd_root",
        }
    }

    /// The formula in one line, in terms of the parameters' names.
    pub fn formula(&self) -> &'static str {
        self.get().formula()
    }

    /// The number of values along an axis of n nodes.
    pub(crate) fn values(&self, n: usize) -> usize {
        self.get().values(n)
    }

    /// The coordinate of the i-th of n nodes; `None` if the mapping prescribes none.
    pub(crate) fn placed(&self, i: usize, n: usize) -> Option<f64> {
        self.get().placement().node(i, n)
    }

    fn knots(&self) -> &'static [f64] {
        self.get().knots()
    }

    fn get(&self) -> &dyn Coordinate {
        match self {
            Self::InverseShape => &InverseShape,
            Self::LogShape(coordinate) => coordinate,
            Self::LogRoughness(coordinate) => coordinate,
            Self::ReflectanceRoot => &ReflectanceRoot,
            Self::CrossingRoot(coordinate) => coordinate,
            Self::HalfTangent(coordinate) => coordinate,
            Self::Rational(coordinate) => coordinate,
            Self::ViewBlend(coordinate) => coordinate,
            Self::CriticalBlend(coordinate) => coordinate,
            Self::Azimuth(coordinate) => coordinate,
            Self::MirroredRoot => &MirroredRoot,
            Self::OddRoot => &OddRoot,
        }
    }
}

/// Nodes of an axis, by index, with their weights in an interpolated value.
pub type Weights = Vec<(usize, f64)>;

/// One axis of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Short name, such as `gamma`, `view` or `u1`.
    pub name: String,
    /// The map from the quantity to the coordinate.
    pub mapping: Mapping,
    /// How values between nodes are interpolated.
    pub interpolation: Interpolation,
    /// Node coordinates, ascending. Values sit at the nodes (not at cell centres).
    pub nodes: Vec<f64>,
}

impl Axis {
    /// An axis with the given nodes.
    pub fn new(
        name: &str,
        mapping: Mapping,
        interpolation: Interpolation,
        nodes: Vec<f64>,
    ) -> Self {
        Self { name: name.into(), mapping, interpolation, nodes }
    }

    /// An axis of the `count` nodes that its mapping prescribes.
    ///
    /// # Panics
    /// If the mapping prescribes no nodes.
    pub fn placed(
        name: &str,
        mapping: Mapping,
        interpolation: Interpolation,
        count: usize,
    ) -> Self {
        let node = |i| mapping.placed(i, count).expect("a mapping that places its nodes");
        Self::new(name, mapping, interpolation, (0..count).map(node).collect())
    }

    /// The number of values along this axis.
    pub fn len(&self) -> usize {
        self.mapping.values(self.nodes.len())
    }

    /// Whether its nodes are exactly those that its mapping prescribes.
    pub(crate) fn is_placed(&self) -> bool {
        let n = self.nodes.len();
        self.nodes.iter().enumerate().all(|(i, node)| self.mapping.placed(i, n) == Some(*node))
    }

    /// Whether it has no nodes; never true for an axis that was validated.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The coordinates of the first and the last node.
    ///
    /// # Panics
    /// Without nodes; an axis that was validated has some.
    pub fn ends(&self) -> [f64; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// The coordinate of γ, σ or η on an axis of that quantity; `None` for other axes.
    pub fn coordinate(&self, quantity: f64) -> Option<f64> {
        match self.mapping {
            Mapping::InverseShape => Some(InverseShape.coordinate(quantity)),
            Mapping::LogShape(axis) => Some(axis.coordinate(quantity)),
            Mapping::LogRoughness(axis) => Some(axis.coordinate(quantity)),
            Mapping::ReflectanceRoot => Some(ReflectanceRoot.coordinate(quantity)),
            Mapping::CrossingRoot(axis) => Some(axis.coordinate(quantity)),
            _ => None,
        }
    }

    /// The γ, σ or η at a coordinate on an axis of that quantity; `None` for other axes.
    pub fn quantity(&self, t: f64) -> Option<f64> {
        match self.mapping {
            Mapping::InverseShape => Some(InverseShape.quantity(t)),
            Mapping::LogShape(axis) => Some(axis.quantity(t)),
            Mapping::LogRoughness(axis) => Some(axis.quantity(t)),
            Mapping::ReflectanceRoot => Some(ReflectanceRoot.quantity(t)),
            Mapping::CrossingRoot(axis) => Some(axis.quantity(t)),
            _ => None,
        }
    }

    /// The γ, σ or η of all nodes on an axis of that quantity; empty for other axes.
    pub fn quantities(&self) -> Vec<f64> {
        self.nodes.iter().filter_map(|&t| self.quantity(t)).collect()
    }

    /// Nodes, by index, with their weights in the value at the coordinate t; `None` where the axis
    /// does not cover t.
    ///
    /// A t within rounding of a node is taken as that node.
    pub fn weights(&self, t: f64) -> Option<Weights> {
        let [first, last] = self.ends();
        // t may have been rounded by a logarithm and its inverse, which albedo tables use.
        let same = match self.interpolation {
            Interpolation::Lagrange6 => 1e-9 * (1.0 + last.abs()),
            _ => 1e-12 * (1.0 + t.abs()),
        };
        if let Some(i) = self.nodes.iter().position(|node| (node - t).abs() <= same) {
            return Some(alloc::vec![(i, 1.0)]);
        }
        let between = t > first && t < last && self.interpolation != Interpolation::Nodes;
        between.then(|| {
            let (before, part) = part(&self.nodes, self.mapping.knots(), t);
            let weights = lagrange::weights(part, t, self.interpolation.window());
            weights.into_iter().map(|(i, weight)| (before + i, weight)).collect()
        })
    }

    /// The axis of the nodes alone that interpolation reads anywhere in [from, to].
    #[must_use]
    pub fn cut(&self, from: f64, to: f64) -> Self {
        let read = |t: f64| {
            let (before, part) = part(&self.nodes, self.mapping.knots(), t);
            let [first, last] = lagrange::read(part, t, self.interpolation.window());
            [before + first, before + last]
        };
        let ([first, _], [_, last]) = (read(from), read(to));
        Self { nodes: self.nodes[first..last].to_vec(), ..self.clone() }
    }

    /// Checks what every reader relies on: finite, strictly ascending nodes within the mapping's
    /// range, equal to those that it prescribes if any, and evenly spaced for
    /// [`Interpolation::Lagrange6`].
    pub fn validate(&self) -> Result<(), LoadError> {
        let fail = |why: &str| Err(LoadError::Invalid(format!("axis `{}`: {why}", self.name)));
        let unsupported =
            |why: &str| Err(LoadError::Unsupported(format!("axis `{}`: {why}", self.name)));
        let (mapping, n) = (self.mapping.get(), self.nodes.len());
        if n == 0 {
            return fail("no nodes");
        }
        if self.nodes.iter().any(|x| !x.is_finite()) {
            return fail("a node is not finite");
        }
        if self.nodes.windows(2).any(|pair| pair[0] >= pair[1]) {
            return fail("nodes do not ascend");
        }
        if let Some(why) = mapping.fault().or_else(|| mapping.count_fault(n)) {
            return fail(why);
        }
        let ([low, high], [first, last]) = (mapping.range(), self.ends());
        if first < low || last > high {
            return fail("a node lies outside the range of its mapping");
        }
        let misplaced = |(i, x): (usize, &f64)| {
            self.mapping.placed(i, n).is_some_and(|at| (x - at).abs() > 1e-12)
        };
        if self.nodes.iter().enumerate().any(misplaced) {
            return unsupported("this mapping needs nodes spread evenly over its range");
        }
        if self.interpolation == Interpolation::Lagrange6 && !lagrange::is_even(&self.nodes) {
            return unsupported("this interpolation needs evenly spaced nodes");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::SQRT_2;

    use super::coordinate::Placement;
    use super::*;

    #[test]
    fn descriptions_are_read_back_and_know_no_other_fields() {
        for mapping in Mapping::EVERY {
            let text = serde_json::to_string(&mapping).unwrap();
            assert!(text.contains(&format!("\"kind\":\"{}\"", mapping.name())), "{text}");
            assert_eq!(serde_json::from_str::<Mapping>(&text).unwrap(), mapping);
            // A mapping without parameters is its name alone, and ignores other fields.
            if text.contains(',') {
                let more = text.replacen('{', "{\"more\":1,", 1);
                assert!(serde_json::from_str::<Mapping>(&more).is_err(), "{more}");
            }
        }
    }

    #[test]
    fn quantities_are_the_same_again() {
        const INF: f64 = f64::INFINITY;
        let crossing = |crowded| Mapping::CrossingRoot(CrossingRoot { crowded });
        let [shape, sigma] =
            [Mapping::LogShape(LogShape::BAKED), Mapping::LogRoughness(LogRoughness::BAKED)];
        for (mapping, tolerance, quantities) in [
            (Mapping::InverseShape, 1e-15, &[1.501, 1.8, 2.0, 5.0, 1e9, INF][..]),
            (shape, 1e-14, &[1.5 + 1e-6, 1.501, 2.0, 40.0, 1e9, INF]),
            (sigma, 1e-14, &[1e-8, 1e-4, 0.015, 0.3, 3.0, 1e3]),
            (Mapping::ReflectanceRoot, 1e-13, &[1.0, 1.0001, 1.33, 1.5, 2.4, 40.0, INF]),
            (crossing(false), 1e-13, &[1.0, 1.0001, 1.33, SQRT_2, 1.5, 2.4, 40.0, INF]),
            (crossing(true), 1e-13, &[1.0, 1.0001, 1.33, SQRT_2, 1.5, 2.4, 40.0, INF]),
        ] {
            let axis = Axis::new("a", mapping, Interpolation::Linear, Vec::new());
            for &x in quantities {
                let back = axis.quantity(axis.coordinate(x).unwrap()).unwrap();
                let same = back == x || (back / x - 1.0).abs() < tolerance;
                assert!(same, "{mapping:?}: {back} for {x}");
            }
        }
        assert_eq!(LogShape::BAKED.coordinate(INF), 0.0);
        let t = libm::acos(1.0 - 2.0 * libm::sqrt(0.2)) / core::f64::consts::PI;
        assert!((ReflectanceRoot.coordinate(1.5) - t).abs() < 1e-15);
    }

    #[test]
    fn nodes_that_a_mapping_places_are_accepted_and_others_refused() {
        let placed = |mapping: &Mapping| mapping.get().placement() != Placement::Free;
        for mapping in Mapping::EVERY.into_iter().filter(placed) {
            let axis = Axis::placed("a", mapping, Interpolation::Linear, 13);
            axis.validate().unwrap();
            let mut moved = axis.clone();
            moved.nodes[3] += 1e-3;
            assert!(matches!(moved.validate(), Err(LoadError::Unsupported(_))), "{mapping:?}");
        }
    }

    #[test]
    fn parameters_out_of_range_are_refused() {
        let bad = [
            (Mapping::LogShape(LogShape { scale: f64::NAN }), 1),
            (Mapping::LogRoughness(LogRoughness { offset: 0.0, ..LogRoughness::BAKED }), 1),
            (Mapping::Rational(Rational { scale: -1.0, crowded: false }), 5),
            // The product of these would be 0, and the number of quadrature panels infinite.
            (Mapping::ViewBlend(ViewBlend { floor: 1e-200, slope: 1e-200, ..ViewBlend::BAKED }), 7),
            (Mapping::CriticalBlend(CriticalBlend { kink: 1e-320, ..CriticalBlend::BAKED }), 13),
            (Mapping::ViewBlend(ViewBlend { weight: 0.95, ..ViewBlend::BAKED }), 7),
            (Mapping::CriticalBlend(CriticalBlend { root: 1.0, ..CriticalBlend::BAKED }), 13),
            (Mapping::CriticalBlend(CriticalBlend { sharp: -0.1, ..CriticalBlend::UPRIGHT }), 16),
            (Mapping::CriticalBlend(CriticalBlend { between: 1.0, ..CriticalBlend::UPRIGHT }), 16),
            (Mapping::Azimuth(Azimuth { sigma: [0.0, 1.0], turn: 0.0, fold: true }), 5),
            // Too few nodes, or not as many in each part.
            (Mapping::HalfTangent(HalfTangent::default()), 1),
            (Mapping::ViewBlend(ViewBlend::BAKED), 5),
            (Mapping::CriticalBlend(CriticalBlend::BAKED), 12),
            (Mapping::CriticalBlend(CriticalBlend::UPRIGHT), 13),
            (Mapping::CriticalBlend(CriticalBlend::UPRIGHT), 17),
        ];
        for (mapping, count) in bad {
            let nodes = (0..count).map(|i| i as f64 / (count - 1).max(1) as f64).collect();
            let axis = Axis::new("a", mapping, Interpolation::Lagrange6, nodes);
            assert!(matches!(axis.validate(), Err(LoadError::Invalid(_))), "{mapping:?}");
        }
    }

    #[test]
    fn weights_cover_nodes_and_what_is_between() {
        let axis = |interpolation, nodes: &[f64]| {
            Axis::new("gamma", Mapping::InverseShape, interpolation, nodes.to_vec())
        };
        let node = |i| Some(Vec::from([(i, 1.0)]));
        let range = axis(Interpolation::Lagrange4, &[0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(range.weights(0.2), node(1));
        assert_eq!(range.weights(0.11).unwrap().len(), 4);
        assert_eq!([0.0, 0.6, f64::NAN].map(|t| range.weights(t)), [const { None }; 3]);
        let points = axis(Interpolation::Nodes, &[0.1, 0.2]);
        assert_eq!([0.15, 0.1].map(|t| points.weights(t)), [None, node(0)]);
        // Of an axis in parts they are those of one part, which may have few.
        let nodes = even_nodes(0.0, 1.0, 21);
        let crossing = Mapping::CrossingRoot(CrossingRoot { crowded: true });
        let parts = Axis::new("eta", crossing, Interpolation::Lagrange6, nodes);
        let read = |axis: &Axis, t: f64| -> Vec<usize> {
            axis.weights(t).unwrap().into_iter().map(|(i, _)| i).collect()
        };
        assert_eq!((read(&parts, 0.49), read(&parts, 0.5)), ((5..=10).collect(), [10].into()));
        assert_eq!(read(&parts, 0.51), (10..=15).collect::<Vec<_>>());
        let cut = parts.cut(0.46, 0.57);
        assert_eq!(cut.nodes, parts.nodes[5..=15]);
        assert_eq!(read(&cut, 0.51), (5..=10).collect::<Vec<_>>());
        assert_eq!(parts.cut(0.51, 0.52).nodes, parts.nodes[10..=15]);
        let one = axis(Interpolation::Lagrange6, &[0.7]);
        assert_eq!([0.7 + 1e-10, 0.71].map(|t| one.weights(t)), [node(0), None]);
    }
}
