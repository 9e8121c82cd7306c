//! What a table covers, and its axes of γ, σ and η collapsed at one material, which leaves the view.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use crate::axis::{Axis, Mapping, ViewBlend};
use crate::format::Table;

/// Nodes of an axis with their weights.
pub(super) type Weights = Vec<(usize, f64)>;

/// Two σ that have come through a coordinate and back are the same within this.
const SAME: f64 = 1e-9;

fn quantity(axis: &Axis, t: f64) -> f64 {
    axis.quantity(t).expect("validated on load")
}

/// σ of the first node of an albedo table.
pub(super) fn first_sigma(table: &Table) -> f64 {
    quantity(&table.axes[1], table.axes[1].nodes[0])
}

/// σ of the last.
pub(super) fn last_sigma(table: &Table) -> f64 {
    quantity(&table.axes[1], table.axes[1].ends()[1])
}

/// Whether σ is smoother than a table's first node, and so a mirror.
pub(super) fn is_mirror(sigma: f64, first: f64) -> bool {
    sigma < first * (1.0 - SAME)
}

/// Whether a table begins with the coordinate itself, so that it serves all smaller σ as mirrors; those of a recipe may begin
/// higher.
pub(super) fn reaches_mirrors(table: &Table) -> bool {
    match table.axes[1].mapping {
        Mapping::LogRoughness(axis) => first_sigma(table) <= 1.01 * axis.first,
        _ => unreachable!("validated on load"),
    }
}

/// Weights along the axis γ; `None` where the table does not cover it.
pub(super) fn at_shape(table: &Table, gamma: f64) -> Option<Weights> {
    let shapes = &table.axes[0];
    shapes.weights(shapes.coordinate(gamma).expect("validated on load"))
}

/// Weights along the axes γ and σ, and the σ that they are at: no less than the first node of a table that serves smaller ones
/// as mirrors. `None` where the table does not cover them, and for what is no roughness.
pub(super) fn at_material(table: &Table, sigma: f64, gamma: f64) -> Option<(Vec<Weights>, f64)> {
    let rows = at_shape(table, gamma)?;
    let first = first_sigma(table);
    if !(sigma >= 0.0) || is_mirror(sigma, first) && !reaches_mirrors(table) {
        return None;
    }
    let (roughnesses, at) = (&table.axes[1], sigma.max(first));
    let columns = roughnesses.weights(roughnesses.coordinate(at).expect("validated on load"))?;
    Some((vec![rows, columns], at))
}

/// The values of a table of N channels along its last axis, the axes before it collapsed; one node where all are.
pub(super) fn collapse<const N: usize>(table: &Table, at: &[Weights]) -> Vec<[f32; N]> {
    let views = table.axes.get(at.len()).map_or(1, Axis::len);
    let mut sum = vec![[0.0_f64; N]; views];
    // All combinations of the nodes along the axes, as one index and the product of the weights.
    let mut rows = vec![(0, 1.0)];
    for (axis, weights) in table.axes.iter().zip(at) {
        let all = rows
            .iter()
            .flat_map(|&(row, a)| weights.iter().map(move |&(i, b)| (row * axis.len() + i, a * b)));
        rows = all.collect();
    }
    for (row, weight) in rows {
        let row = table.values[row * views * N..].chunks_exact(N);
        for (into, node) in sum.iter_mut().zip(row) {
            for (x, value) in into.iter_mut().zip(node) {
                *x += weight * f64::from(*value);
            }
        }
    }
    sum.into_iter().map(|node| node.map(|x| x as f32)).collect()
}

/// The mapping of an axis of views.
pub(super) fn view_blend(axis: &Axis) -> ViewBlend {
    match axis.mapping {
        Mapping::ViewBlend(blend) => blend,
        _ => unreachable!("validated on load"),
    }
}

/// What tables cover, in words.
pub(super) fn domains<'a>(tables: impl Iterator<Item = &'a Table>) -> String {
    let ends = |axis: &Axis| {
        let [a, b] = axis.ends().map(|t| quantity(axis, t));
        if a == b { format!("= {a:.6}") } else { format!("in [{:.6}, {:.6}]", a.min(b), a.max(b)) }
    };
    let one = |table: &Table| format!("gamma {} with sigma {}", ends(&table.axes[0]), ends(&table.axes[1]));
    const SHOWN: usize = 8;
    let mut all: Vec<String> = tables.map(one).collect();
    if all.len() > SHOWN {
        let more = all.len() - SHOWN;
        all.truncate(SHOWN);
        all.push(format!("{more} more"));
    }
    all.join("; ")
}
