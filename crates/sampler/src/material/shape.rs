//! The data that lookups of one shape read, for exports to other languages.

use alloc::vec::Vec;

use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::axis::hermite::{Cell, Node};

use super::heavy::CELLS_PER_ROW;
use super::student_t::StudentT;

/// The slices and constants of a Student-t lobe of one shape, whatever its roughness, laid out as
/// in this crate. Cells are followed by a guard cell, which is read at position 0 for the end of
/// the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeTables {
    /// s and 1 − γ/2 of D; s > 0.
    pub normals: [f32; 2],
    /// κ of the view coordinate of masking.
    pub kappa: f32,
    /// Whether that coordinate is crowded.
    pub masking_crowded: bool,
    /// Cells of the view coordinate of masking.
    pub masking_cells: f32,
    /// G1/q over the number of cells, as the cubic's coefficients in each cell of the view.
    pub masking: Vec<Cell>,
    /// The view coordinate of slopes, in cells.
    pub lines: Lines,
    /// Nodes of a half row of slopes, for u ≤ ½ or u > ½.
    pub numbers: usize,
    /// Factors from min(u, 1−u)^¼ to cells, along the plane of incidence and across it.
    pub scales: [f32; 2],
    /// (value, slope) of in-plane slopes: by view, by half, by node; then a row and a node that are
    /// read with weight 0.
    pub slopes: Vec<Node>,
    /// Slopes across the plane for u > ½, as the cubic's coefficients in each cell.
    pub across: Vec<Cell>,
    /// The heavy part, which closed forms draw; `None` where the tables hold the whole
    /// distribution.
    pub heavy: Option<HeavyTables>,
}

/// The part of the visible normals that is not in the tables.
#[derive(Clone, Debug, PartialEq)]
pub struct HeavyTables {
    /// The share of the heavy part in the visible area, as the cubic's coefficients in each cell of
    /// the view coordinate of slopes.
    pub shares: Vec<Cell>,
    /// Cells of `shares` between two views of the slope table.
    pub cells_per_row: f32,
    /// 1/(2γ−3).
    pub exponent: f32,
    /// √s.
    pub root_s: f32,
}

impl ShapeTables {
    /// The tables of the lobe's shape; its roughness does not matter.
    #[must_use]
    pub fn new(lobe: &StudentT) -> Self {
        let slices = &lobe.slices;
        let heavy = || HeavyTables {
            shares: slices.heavy.shares.clone(),
            cells_per_row: CELLS_PER_ROW as f32,
            exponent: slices.heavy.tail.exponent,
            root_s: slices.heavy.tail.root_s,
        };
        Self {
            normals: [slices.normals.law.s, slices.normals.law.power],
            kappa: slices.kappa,
            masking_crowded: slices.shadowing_view.crowded,
            masking_cells: slices.shadowing_cells,
            masking: slices.shadowing.clone(),
            lines: slices.lines,
            numbers: slices.half_cells + 1,
            scales: slices.scales,
            slopes: slices.slope.clone(),
            across: slices.across_cells.clone(),
            heavy: slices.peeled.then(heavy),
        }
    }
}
