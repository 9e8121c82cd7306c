//! Binding: the γ axis of a table collapsed at one shape, leaving the slice that lookups read.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use crate::axis::{Axis, Interpolation, Mapping};
use crate::cells::{Cell, Node, cells, limit_slopes};
use crate::error::BindError;
use crate::table::{Kind, Table};

/// Relative difference under which two values of s count as the same node; γ itself is given in double precision.
const SAME: f64 = 1e-12;

/// Weights of up to four neighbouring nodes of the γ axis at s, or `None` where the axis does not cover it.
fn weights(axis: &Axis, s: f64) -> Option<Vec<(usize, f64)>> {
    let nodes = &axis.nodes;
    if let Some(i) = nodes.iter().position(|x| (x - s).abs() <= SAME * (1.0 + s)) {
        return Some(vec![(i, 1.0)]);
    }
    let covered = s > nodes[0] && s < nodes[nodes.len() - 1];
    let count = match axis.interpolation {
        Interpolation::Lagrange4 if covered => nodes.len().min(4),
        Interpolation::Linear if covered => 2,
        _ => return None,
    };
    // The window of `count` nodes that has s in its middle cell, or as near to it as the ends allow.
    let above = nodes.iter().position(|&x| x > s)?;
    let first = above.saturating_sub(count / 2).min(nodes.len() - count);
    let window = first..first + count;
    let weight = |i: usize| {
        let others = window.clone().filter(|&j| j != i);
        others.map(|j| (s - nodes[j]) / (nodes[i] - nodes[j])).product()
    };
    Some(window.clone().map(|i| (i, weight(i))).collect())
}

/// Whether the table covers s.
pub(crate) fn covers(table: &Table, s: f64) -> bool {
    weights(&table.axes[0], s).is_some()
}

/// The slice of a (value, slope) table at s.
fn slice(table: &Table, s: f64) -> Option<Vec<Node>> {
    let weights = weights(&table.axes[0], s)?;
    let size = table.values.len() / table.axes[0].nodes.len();
    let mut sum = vec![0.0_f32; size];
    for (i, weight) in weights {
        let weight = weight as f32;
        for (into, x) in sum.iter_mut().zip(&table.values[i * size..]) {
            *into += weight * x;
        }
    }
    Some(sum.chunks_exact(2).map(|node| [node[0], node[1]]).collect())
}

/// Makes a run of nodes ascend in spite of rounding and of the negative weights of the γ interpolation.
pub(crate) fn make_monotone(run: &mut [Node]) {
    let mut last = 0.0_f32;
    for node in run.iter_mut() {
        last = last.max(node[0]);
        node[0] = last;
    }
    limit_slopes(run);
}

/// Slices of one shape.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slices {
    /// G1/q over the number of cells, by cell of the view coordinate; the coordinate in cells then needs no scaling of its own.
    pub(crate) shadowing: Vec<Cell>,
    /// Cells of that axis.
    pub(crate) shadowing_cells: f32,
    /// κ of the view coordinate q.
    pub(crate) kappa: f32,
    /// Whether the shadowing table's axis is 1 − √(1−q) instead of q.
    pub(crate) crowded_shadowing: bool,
    /// In-plane slopes: rows by view, each `2 (cells + 1)` nodes, the half for u ≤ ½ first; and a node that is read with weight 0.
    pub(crate) slope: Vec<Node>,
    /// Cells of the view axis.
    pub(crate) rows: usize,
    /// Whether the view axis is crowded towards normal incidence.
    pub(crate) crowded: bool,
    /// Cells of one half of the u₁ axis.
    pub(crate) cells: usize,
    /// How often t is the square root of 2 min(u, 1−u): 0, 1 or 2.
    pub(crate) roots: u32,
    /// Whether `slope` is without its heavy part.
    pub(crate) peeled: bool,
    /// Slopes across the plane, the half for u > ½.
    pub(crate) across: Vec<Node>,
    /// As `roots`, for u₂.
    pub(crate) across_roots: u32,
    /// What the common case reads besides `slope`; absent where it does not apply.
    pub(crate) plain: Option<Plain>,
}

/// The case that most materials are, laid out for speed: nothing peeled off, no crowded axis, and fourth roots of both numbers.
#[derive(Clone, Debug)]
pub(crate) struct Plain {
    /// Slopes across by cell.
    pub(crate) across: Vec<Cell>,
    /// What takes min(u, 1−u)^(1/4) to cells, for u₁ and u₂.
    pub(crate) scales: [f32; 2],
    /// Cells of the view axis.
    pub(crate) rows: f32,
    /// 1 over it.
    pub(crate) row: f32,
    /// Nodes of half a row of `slope`.
    pub(crate) half: u32,
}

impl Slices {
    pub(crate) fn bind(tables: &[Table], gamma: f64, s: f64) -> Result<Self, BindError> {
        let (_, shadowing, axis) = find(tables, &[Kind::Shadowing], gamma, s)?;
        let (kappa, crowded_shadowing) = match axis[1].mapping {
            Mapping::Rational { scale, pole } => (scale / (pole - s), false),
            Mapping::RationalRoot { scale, pole } => (scale / (pole - s), true),
            _ => unreachable!("validated on load"),
        };
        let kinds = [Kind::VisibleSlope, Kind::VisibleSlopePeeled];
        let (kind, mut slope, axis) = find(tables, &kinds, gamma, s)?;
        let (rows, numbers) = (axis[1].nodes.len() - 1, axis[2].nodes.len());
        slope.chunks_exact_mut(numbers).for_each(make_monotone);
        slope.push([0.0; 2]);
        let crowded = axis[1].mapping == Mapping::HalfTangentRoot;
        let slope_roots = roots(&axis[2]);
        let (_, mut across, axis) = find(tables, &[Kind::VisibleSlopeConditional], gamma, s)?;
        make_monotone(&mut across);
        let peeled = kind == Kind::VisibleSlopePeeled;
        let across_roots = roots(&axis[1]);
        let plain = (!peeled && !crowded && slope_roots == 2 && across_roots == 2).then(|| Plain {
            scales: [numbers, across.len()].map(|nodes| ((nodes - 1) as f64 * FOURTH_ROOT_OF_2) as f32),
            across: cells(&across, 1.0),
            rows: rows as f32,
            row: (1.0 / rows as f64) as f32,
            half: numbers as u32,
        });
        let shadowing_cells = shadowing.len() - 1;
        Ok(Self {
            shadowing: cells(&shadowing, 1.0 / shadowing_cells as f64),
            shadowing_cells: shadowing_cells as f32,
            kappa: kappa as f32,
            crowded_shadowing,
            slope,
            rows,
            crowded,
            cells: numbers - 1,
            roots: slope_roots,
            peeled,
            across,
            across_roots,
            plain,
        })
    }

    /// Bytes that lookups of this material touch.
    pub(crate) fn bytes(&self) -> usize {
        let across = match &self.plain {
            Some(plain) => size_of_val(&plain.across[..]),
            None => size_of_val(&self.across[..]),
        };
        size_of_val(&self.shadowing[..]) + size_of_val(&self.slope[..]) + across
    }
}

/// ⁴√2: the factor 2 of a mirrored axis is in the scale, not applied before the roots.
const FOURTH_ROOT_OF_2: f64 = 1.189_207_115_002_721_1;

pub(crate) fn roots(axis: &Axis) -> u32 {
    match axis.mapping {
        Mapping::MirroredPower { power, .. } => power.trailing_zeros(),
        _ => unreachable!("validated on load"),
    }
}

/// The slice of the first table of one of `kinds` that covers s; earlier kinds are preferred.
fn find<'a>(
    tables: &'a [Table],
    kinds: &[Kind],
    gamma: f64,
    s: f64,
) -> Result<(Kind, Vec<Node>, &'a [Axis]), BindError> {
    for &kind in kinds {
        for table in tables.iter().filter(|table| table.kind == kind) {
            if let Some(nodes) = slice(table, s) {
                return Ok((kind, nodes, &table.axes));
            }
        }
    }
    Err(BindError::NotCovered { kind: kinds[0].name(), gamma, covered: coverage(tables, kinds) })
}

/// What a set covers, in words.
fn coverage(tables: &[Table], kinds: &[Kind]) -> String {
    let mut parts = Vec::new();
    for table in tables.iter().filter(|table| kinds.contains(&table.kind)) {
        let axis = &table.axes[0];
        let gamma = |s: f64| if s == 0.0 { f64::INFINITY } else { 1.0 + 1.0 / s };
        if axis.interpolation == Interpolation::Nodes || axis.nodes.len() == 1 {
            parts.extend(axis.nodes.iter().rev().map(|&s| format!("gamma = {}", gamma(s))));
        } else {
            // The larger s is the smaller gamma.
            parts.push(format!("[{:.6}, {}]", gamma(axis.nodes[axis.nodes.len() - 1]), gamma(axis.nodes[0])));
        }
    }
    if parts.is_empty() { "nothing".into() } else { parts.join(", ") }
}
