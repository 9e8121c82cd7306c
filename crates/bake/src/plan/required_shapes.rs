//! Required shapes: single γ and ranges of γ, and the table specifications for each.

use microfacet_core::shape::s_of_gamma;
use microfacet_tables::{Interpolation, Interval, Precision};

use crate::certify::certificate::ALL_SHAPES;
use crate::table_spec::{GAMMA_MIN, GAMMA_WHOLE, Quality, SEAM, ShapeAxis, TableSpec, general_set};
use microfacet_tables::joined_name;

/// A γ, or a range of γ, that tables must cover.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RequiredShapes {
    gamma: Interval,
}

impl RequiredShapes {
    /// All shapes that tables can cover.
    pub(super) fn general() -> Self {
        Self { gamma: Interval { min: GAMMA_MIN, max: f64::INFINITY } }
    }

    /// The range of γ.
    pub fn gamma(&self) -> Interval {
        self.gamma
    }

    /// The shapes as [min, max] of s = 1/(γ−1).
    pub fn s(&self) -> [f64; 2] {
        [s_of_gamma(self.gamma.max), s_of_gamma(self.gamma.min)]
    }

    /// The range of s in which its tables are measured.
    pub(crate) fn certified_s(&self) -> [f64; 2] {
        if *self == Self::general() { ALL_SHAPES } else { self.s() }
    }

    /// The end of its tables' names; empty for the general set.
    fn label(&self) -> String {
        let Interval { min, max } = self.gamma;
        if *self == Self::general() {
            String::new()
        } else if min == max {
            format!("gamma_{min}")
        } else {
            format!("gamma_{min}_to_{max}")
        }
    }

    /// The specifications of the tables that cover it, cut out of a general set: slices for one
    /// shape, else sub-ranges with the nodes of the general set, so that values in between are the
    /// same bits.
    pub fn specs(&self, general: &[TableSpec]) -> Vec<TableSpec> {
        general.iter().filter_map(|spec| self.cut(spec)).collect()
    }

    /// The part of one table that these shapes require, or `None`.
    pub fn cut(&self, spec: &TableSpec) -> Option<TableSpec> {
        let [from, to] = self.s();
        let [low, high] = spec.shapes.ends();
        // At the seam, γ = 1.8, `visible_slope` is preferred to `visible_slope_peeled`.
        let after_seam = low >= s_of_gamma(GAMMA_WHOLE);
        // A range within rounding is one shape.
        let to = if to - from <= SEAM * to.min(1.0) { from } else { to };
        let covers = [from.max(low), to.min(high)];
        let shapes = if from == to {
            let here = if after_seam { from > low } else { from >= low } && from <= high;
            here.then(|| ShapeAxis { nodes: vec![from], interpolation: Interpolation::Nodes })
        } else {
            // Shapes closer to the seam than rounding are read from the tables before it.
            let beyond = if after_seam { low + SEAM } else { low };
            (to > beyond && from < high).then(|| spec.shapes.part(covers[0], covers[1]))
        };
        let name = joined_name(&[&spec.name, &self.label()]);
        shapes.map(|shapes| TableSpec { shapes, covers, name, ..spec.clone() })
    }
}

/// Disjoint required shapes that cover all `wants`: overlapping ranges become one, and single
/// shapes inside a range are dropped. The ranges come first; ranges and single shapes each descend
/// in γ.
pub(super) fn disjoint(wants: impl Iterator<Item = Interval>) -> Vec<RequiredShapes> {
    let (mut points, mut ranges): (Vec<Interval>, Vec<Interval>) =
        wants.partition(|want| want.is_point());
    let descending = |a: &Interval, b: &Interval| b.max.total_cmp(&a.max);
    ranges.sort_by(descending);
    let mut needs: Vec<RequiredShapes> = Vec::new();
    for range in ranges {
        match needs.last_mut() {
            Some(last) if range.max >= last.gamma.min => last.gamma = last.gamma.union(range),
            _ => needs.push(RequiredShapes { gamma: range }),
        }
    }
    points.sort_by(descending);
    points.dedup();
    points.retain(|&point| holder(&needs, point).is_none());
    needs.extend(points.into_iter().map(|gamma| RequiredShapes { gamma }));
    needs
}

/// The range over all single shapes, if its tables are smaller than the slices of these shapes.
pub(super) fn cheaper_range(needs: &[RequiredShapes]) -> Option<Interval> {
    let points: Vec<&RequiredShapes> = needs.iter().filter(|need| need.gamma.is_point()).collect();
    let hull = points.iter().map(|need| need.gamma).reduce(Interval::union)?;
    let general = general_set(Quality::Default, Precision::F32);
    let bytes =
        |need: &RequiredShapes| need.specs(&general).iter().map(TableSpec::bytes).sum::<usize>();
    let slices: usize = points.into_iter().map(bytes).sum();
    (bytes(&RequiredShapes { gamma: hull }) < slices).then_some(hull)
}

/// The index of the required shapes, as [`disjoint`] makes them, that cover `want`.
pub(super) fn find(needs: &[RequiredShapes], want: Interval) -> Option<usize> {
    let ranges = needs.partition_point(|need| !need.gamma.is_point());
    holder(&needs[..ranges], want).or_else(|| holder(&needs[ranges..], want).map(|i| ranges + i))
}

/// The index of the descending, disjoint required shapes that contain `want`.
fn holder(needs: &[RequiredShapes], want: Interval) -> Option<usize> {
    // The first that reaches down to it.
    let i = needs.partition_point(|need| need.gamma.min > want.min);
    needs.get(i).filter(|need| need.gamma.max >= want.max).map(|_| i)
}
