//! The shapes that a set serves: those that every kind of table a lobe needs covers.

use alloc::vec::Vec;

use microfacet_core::shape::gamma_of_s;
use microfacet_tables::{Interpolation, Kind, SAME, Table, Weights};

use crate::error::MaterialError;

/// The kinds of tables that a Student-t lobe reads, one of each list; earlier ones are preferred.
pub(super) const LOBE: [&[Kind]; 3] = [
    &[Kind::Shadowing],
    &[Kind::VisibleSlope, Kind::VisibleSlopePeeled],
    &[Kind::VisibleSlopeConditional],
];

/// Weights along the γ axis at s; `None` where the table does not cover s, even if its axis does.
pub(super) fn shape_weights(table: &Table, s: f64) -> Option<Weights> {
    if table.subject.lobe.contains_s(s) { table.axes[0].weights(s) } else { None }
}

/// Weights at an end of the axis, for a shape that is outside by rounding alone.
pub(super) fn end_weights(table: &Table, s: f64) -> Option<Weights> {
    let [first, last] = table.axes[0].ends();
    table.subject.lobe.contains_s(s).then(|| table.axes[0].weights(s.clamp(first, last)))?
}

fn serves(table: &Table, s: f64) -> bool {
    shape_weights(table, s).or_else(|| end_weights(table, s)).is_some()
}

/// Whether a lobe of the shape s finds all its tables.
pub(crate) fn contains(tables: &[Table], s: f64) -> bool {
    LOBE.iter().all(|kinds| of_kinds(tables, kinds).any(|table| serves(table, s)))
}

/// The shapes that lobes can have, as ascending intervals of s; a single shape is an interval of no
/// width.
pub(crate) fn shapes(tables: &[Table]) -> Vec<[f64; 2]> {
    let [first, rest @ ..] =
        LOBE.map(|kinds| united(of_kinds(tables, kinds).flat_map(intervals).collect()));
    rest.iter().fold(first, |all, other| {
        let pairs = all.iter().flat_map(|a| other.iter().map(move |b| common(*a, *b)));
        united(pairs.flatten().collect())
    })
}

/// The intersection of two intervals: a single shape where their ends differ by rounding alone.
fn common(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let (low, high) = (a[0].max(b[0]), a[1].min(b[1]));
    (low <= high * (1.0 + SAME)).then_some([low.min(high), high])
}

/// The error of a γ that no tables serve.
pub(super) fn not_covered(tables: &[Table], gamma: f64) -> MaterialError {
    let ends = || shapes(tables).into_iter().flatten().map(gamma_of_s);
    let below = ends().filter(|&end| end < gamma).reduce(f64::max);
    let above = ends().filter(|&end| end > gamma).reduce(f64::min);
    MaterialError::NotCovered { gamma, nearest: [below, above] }
}

fn of_kinds<'a>(tables: &'a [Table], kinds: &[Kind]) -> impl Iterator<Item = &'a Table> {
    tables.iter().filter(|table| kinds.contains(&table.kind))
}

/// The intervals of s that a table covers.
fn intervals(table: &Table) -> Vec<[f64; 2]> {
    let axis = &table.axes[0];
    if axis.interpolation == Interpolation::Nodes || axis.nodes.len() == 1 {
        return axis.nodes.iter().map(|&s| [s; 2]).collect();
    }
    alloc::vec![table.subject.lobe.s()]
}

/// Ascending intervals; those that touch are joined.
fn united(mut all: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all.dedup_by(|next, last| {
        let touch = next[0] <= last[1] * (1.0 + SAME);
        if touch {
            last[1] = last[1].max(next[1]);
        }
        touch
    });
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_that_meet_but_for_rounding_are_one_shape() {
        let end = 1.25 * (1.0 + 5e-10);
        assert_eq!(common([0.0, 1.25], [end, 1.9]), Some([1.25; 2]));
        assert_eq!(common([0.0, 1.25], [1.26, 1.9]), None);
        assert_eq!(common([0.0, 1.25], [0.5, 1.9]), Some([0.5, 1.25]));
    }

    #[test]
    fn intervals_that_touch_are_one() {
        let all = united(alloc::vec![[1.25, 1.9], [0.5, 0.5], [0.1, 0.2], [0.3, 1.25], [0.0, 0.1]]);
        assert_eq!(all, [[0.0, 0.2], [0.3, 1.9]]);
    }
}
