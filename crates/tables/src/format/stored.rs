//! Ranges, roughnesses, shapes and axes as they are written in files: a number where one is enough.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use microfacet_core::shape::{gamma_of_s, s_of_gamma};
use serde::{Deserialize, Serialize};

use super::lobe::Roughness;
use crate::axis::{Axis, Azimuth, CriticalBlend, Interpolation, Mapping, ViewBlend};
use crate::interval::Interval;

/// An interval: its number if it is one, else its ends. ∞, for which JSON has no number, is null,
/// or a `max` that is missing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, or an object of `min` and `max`")]
pub(super) enum Range {
    Point(Option<f64>),
    Ends {
        min: f64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<f64>,
    },
}

impl From<Interval> for Range {
    fn from(interval: Interval) -> Self {
        let finite = |x: f64| (x < f64::INFINITY).then_some(x);
        match interval.is_point() {
            true => Self::Point(finite(interval.min)),
            false => Self::Ends { min: interval.min, max: finite(interval.max) },
        }
    }
}

impl From<Range> for Interval {
    fn from(range: Range) -> Self {
        let infinite = |x: Option<f64>| x.unwrap_or(f64::INFINITY);
        match range {
            Range::Point(x) => Self::point(infinite(x)),
            Range::Ends { min, max } => Self { min, max: infinite(max) },
        }
    }
}

/// An interval as a [`Range`].
pub(super) mod range {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{Interval, Range};

    pub(crate) fn serialize<S: Serializer>(of: &Interval, output: S) -> Result<S::Ok, S::Error> {
        Range::from(*of).serialize(output)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(input: D) -> Result<Interval, D::Error> {
        Range::deserialize(input).map(Interval::from)
    }
}

/// A roughness: that of a round lobe, or σx and σy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number or an object of `min` and `max`, or two for x and y")]
pub(super) enum Sigma {
    Round(Range),
    Two([Range; 2]),
}

impl From<Roughness> for Sigma {
    fn from(roughness: Roughness) -> Self {
        match roughness {
            Roughness::Anisotropic { x, y } => Self::Two([x, y].map(Range::from)),
            round => Self::Round(round.x().into()),
        }
    }
}

impl From<Sigma> for Roughness {
    fn from(sigma: Sigma) -> Self {
        match sigma {
            Sigma::Round(sigma) => match Interval::from(sigma) {
                none if none == Interval::point(0.0) => Self::Smooth,
                sigma => Self::Isotropic(sigma),
            },
            Sigma::Two([x, y]) => Self::anisotropic(x.into(), y.into()),
        }
    }
}

/// The γ of fewest digits for which 1/(γ−1) is exactly `s`; where there is none, the nearest.
pub(super) fn gamma_of(s: f64) -> f64 {
    let gamma = gamma_of_s(s);
    let is_same = |gamma: &f64| s_of_gamma(*gamma) == s;
    let rounded = (0..17).filter_map(|digits| format!("{gamma:.digits$e}").parse().ok());
    let near = [gamma.next_down(), gamma.next_up()];
    rounded.chain(near).find(is_same).unwrap_or(gamma)
}

/// The parameters of a table's subject that are single numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Single {
    /// γ of a lobe, or of the family where the table covers one γ.
    pub(super) gamma: Option<f64>,
    /// σ of the family, where the table covers one σ.
    pub(super) sigma: Option<f64>,
    /// Whether the table is of one lobe, not of the family.
    pub(super) is_lobe: bool,
    /// σx and σy of an upright lobe.
    pub(super) sigmas: Option<[f64; 2]>,
}

impl Single {
    /// The γ of one lobe.
    fn of_lobe(self) -> Option<f64> {
        self.gamma.filter(|_| self.is_lobe)
    }

    /// The mapping without the σ and γ of the table's own lobe, so that tables of different lobes
    /// share an axis.
    fn shared(self, mapping: Mapping) -> Mapping {
        match mapping {
            Mapping::Azimuth(azimuth) if Some(azimuth.sigma) == self.sigmas => {
                Mapping::Azimuth(Azimuth { sigma: [0.0; 2], ..azimuth })
            }
            Mapping::ViewBlend(view) => {
                let is = |all: &ViewBlend| {
                    self.of_lobe().is_some_and(|gamma| all.of_shape(gamma) == view)
                };
                let all = [ViewBlend::BAKED, ViewBlend::CLOSE].into_iter().find(is);
                Mapping::ViewBlend(all.unwrap_or(view))
            }
            Mapping::CriticalBlend(view) => {
                let is = |all: &CriticalBlend| {
                    self.of_lobe().is_some_and(|gamma| all.of_shape(gamma) == view)
                };
                let all = [CriticalBlend::BAKED, CriticalBlend::UPRIGHT].into_iter().find(is);
                Mapping::CriticalBlend(all.unwrap_or(view))
            }
            own => own,
        }
    }

    /// The mapping with the σ and γ of the table's own lobe.
    fn own(self, mapping: Mapping) -> Mapping {
        match (mapping, self.sigmas, self.of_lobe()) {
            (Mapping::Azimuth(azimuth), Some(sigma), _) if azimuth.sigma == [0.0; 2] => {
                Mapping::Azimuth(Azimuth { sigma, ..azimuth })
            }
            (Mapping::ViewBlend(view), _, Some(gamma)) => Mapping::ViewBlend(view.of_shape(gamma)),
            (Mapping::CriticalBlend(view), _, Some(gamma)) => {
                Mapping::CriticalBlend(view.of_shape(gamma))
            }
            (shared, ..) => shared,
        }
    }

    fn coordinate(self, axis: &Axis) -> Option<f64> {
        let sigma = matches!(axis.mapping, Mapping::LogRoughness(_));
        axis.coordinate(if sigma { self.sigma } else { self.gamma }?)
    }
}

/// An axis, which tables share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredAxis {
    name: String,
    mapping: Mapping,
    interpolation: Interpolation,
    /// Missing where the one node of each table is its γ, or its σ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    nodes: Option<Nodes>,
}

/// The number of nodes where the mapping prescribes them, else their coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number of nodes, or their coordinates")]
enum Nodes {
    Count(usize),
    Places(Vec<f64>),
}

/// More nodes than any file has values.
const MOST_NODES: usize = 1 << 31;

impl StoredAxis {
    pub(super) fn of(axis: &Axis, single: Single) -> Self {
        let Axis { ref name, mapping, interpolation, ref nodes } = *axis;
        let mapping = single.shared(mapping);
        let nodes = match nodes[..] {
            [node] if single.coordinate(axis) == Some(node) => None,
            _ if axis.is_placed() => Some(Nodes::Count(nodes.len())),
            _ => Some(Nodes::Places(nodes.clone())),
        };
        Self { name: name.clone(), mapping, interpolation, nodes }
    }

    /// A text that differs for different axes.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// The number of values along the axis; `None` if it is more than any file has.
    pub(super) fn len(&self) -> Option<usize> {
        let nodes = match &self.nodes {
            None => 1,
            Some(Nodes::Count(count)) => *count,
            Some(Nodes::Places(places)) => places.len(),
        };
        (nodes <= MOST_NODES).then(|| self.mapping.values(nodes))
    }

    /// The axis of one table. Memory is taken for as many numbers as the file states nodes.
    pub(super) fn axis(&self, single: Single) -> Result<Axis, String> {
        let Self { name, mapping, interpolation, nodes } = self;
        let (mapping, interpolation) = (single.own(*mapping), *interpolation);
        let mut axis = Axis { name: name.clone(), mapping, interpolation, nodes: Vec::new() };
        axis.nodes = match nodes {
            Some(Nodes::Places(places)) => places.clone(),
            Some(Nodes::Count(count)) => {
                let placed = (0..*count).map(|i| mapping.placed(i, *count)).collect::<Option<_>>();
                placed.ok_or_else(|| format!("axis `{name}`: its mapping places no nodes"))?
            }
            None => {
                let own = single.coordinate(&axis);
                [own.ok_or_else(|| format!("axis `{name}`: no nodes"))?].into()
            }
        };
        Ok(axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::LogShape;

    #[test]
    fn a_shape_has_as_few_digits_as_its_s_allows() {
        for gamma in [1.501, 1.8, 2.0, 2.43, 3.1, 1e6, 1.7320508075688772, f64::INFINITY] {
            assert_eq!(gamma_of(s_of_gamma(gamma)), gamma);
        }
        // An s that 1/(γ−1) reaches for no γ.
        let s = [0.7, 1.9].into_iter().find(|&s| s_of_gamma(gamma_of_s(s)) != s);
        for s in s.into_iter().chain([1.25, 0.3]) {
            assert!((s_of_gamma(gamma_of(s)) - s).abs() < 1e-15);
        }
    }

    #[test]
    fn numbers_stand_for_what_they_are_enough_for() {
        let text = |of: Sigma| serde_json::to_string(&of).unwrap();
        let range = Interval { min: 0.1, max: 0.3 };
        for (roughness, stored) in [
            (Roughness::Smooth, "0.0"),
            (Roughness::Isotropic(Interval::point(0.5)), "0.5"),
            (Roughness::Isotropic(range), r#"{"min":0.1,"max":0.3}"#),
            (
                Roughness::Anisotropic { x: range, y: Interval::point(0.5) },
                r#"[{"min":0.1,"max":0.3},0.5]"#,
            ),
        ] {
            assert_eq!(text(roughness.into()), stored);
            let read: Sigma = serde_json::from_str(stored).unwrap();
            assert_eq!(Roughness::from(read), roughness);
        }
        for (min, max, stored) in [
            (f64::INFINITY, f64::INFINITY, "null"),
            (1.5, f64::INFINITY, r#"{"min":1.5}"#),
            (2.0, 2.0, "2.0"),
        ] {
            let range = Range::from(Interval { min, max });
            assert_eq!(serde_json::to_string(&range).unwrap(), stored);
            let read: Range = serde_json::from_str(stored).unwrap();
            assert_eq!(Interval::from(read), Interval { min, max });
        }
        for other in ["\"0.3\"", "[0.3]", "[0.1,0.2,0.3]", "{}", r#"{"max":0.3}"#] {
            assert!(serde_json::from_str::<Sigma>(other).is_err(), "{other}");
        }
    }

    #[test]
    fn axes_are_the_same_bits_again() {
        let single = Single { gamma: Some(2.43), ..Single::default() };
        let shape = Mapping::LogShape(LogShape::BAKED);
        let axis = |mapping, nodes| Axis::new("a", mapping, Interpolation::Lagrange6, nodes);
        let own = axis(shape, [LogShape::BAKED.coordinate(2.43)].into());
        let other = axis(shape, [LogShape::BAKED.coordinate(2.5)].into());
        let even = Axis::placed("a", Mapping::MirroredRoot, Interpolation::Hermite, 11);
        let moved = axis(Mapping::InverseShape, [0.0, 0.3, 1.25].into());
        for (axis, nodes) in [
            (own, r#"lagrange6"}"#),
            (other, r#","nodes":[2.25129"#),
            (even, r#","nodes":11}"#),
            (moved, r#","nodes":[0.0,0.3,1.25]}"#),
        ] {
            let stored = serde_json::to_string(&StoredAxis::of(&axis, single)).unwrap();
            assert!(stored.contains(nodes), "{stored}");
            let read: StoredAxis = serde_json::from_str(&stored).unwrap();
            assert_eq!(read.len(), Some(axis.len()));
            assert_eq!(read.axis(single), Ok(axis));
        }
        let free = r#"{"name":"a","mapping":{"kind":"inverse_shape"},"interpolation":"nodes"}"#;
        let none: StoredAxis = serde_json::from_str(free).unwrap();
        assert!(none.axis(Single::default()).unwrap_err().contains("no nodes"));
        let many = free.replace("nodes\"}", "nodes\",\"nodes\":4e9}");
        assert!(serde_json::from_str::<StoredAxis>(&many).is_err());
        let many: StoredAxis = serde_json::from_str(&many.replace("4e9", "4000000000")).unwrap();
        assert_eq!(many.len(), None);
    }
}
