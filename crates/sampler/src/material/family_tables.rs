//! The data that lookups of every shape read, for exports to other languages.

use alloc::vec::Vec;

use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::axis::hermite::Cell;

use super::family::Family;
use super::family_part::Part;
use super::heavy::CELLS_PER_ROW;
use super::windows::{Planes, Windows};

/// The tables and constants of the shapes of one kind of in-plane slopes, laid out as in this
/// crate.
#[derive(Clone, Debug)]
pub struct PartTables {
    /// The smallest γ and the largest, which stands for ∞.
    pub gammas: [f32; 2],
    /// The places of γ among the nodes of in-plane slopes, of slopes across and of masking.
    pub windows: WindowTables,
    /// (value, slope) of in-plane slopes: by view, by half, by node; a row and a node that are read
    /// with weight 0 follow.
    pub slopes: ByShape<2>,
    /// The view coordinate of slopes, in cells.
    pub lines: Lines,
    /// Nodes of a half row of slopes.
    pub numbers: usize,
    /// Factors from min(u, 1−u)^¼ to cells, along the plane of incidence and across it.
    pub scales: [f32; 2],
    /// (value, slope) of slopes across the plane for u > ½, and a node that is read with weight 0.
    pub across: ByShape<2>,
    /// (value, slope) of G1/q over the number of cells, and a node that is read with weight 0.
    pub masking: ByShape<2>,
    /// κ of the view coordinate of masking times (2γ−3)/(γ−1).
    pub masking_scale: f32,
    /// Whether that coordinate is crowded.
    pub masking_crowded: bool,
    /// Cells of that coordinate.
    pub masking_cells: f32,
    /// The part of the visible area that tables hold, over M₀, as the cubics of cells of the view
    /// coordinate of slopes; its γ are those of masking. Empty where tables hold the whole.
    pub rests: ByShape<4>,
    /// The area of the heavy part over M₀, for the same cells.
    pub rhos: Vec<Cell>,
    /// Cells of these areas between two views of the slope table.
    pub heavy_per_row: f32,
}

/// A table over γ and places, with the values of all γ at a place next to each other.
#[derive(Clone, Debug)]
pub struct ByShape<const N: usize> {
    /// Values at a place.
    pub shapes: usize,
    /// By place, by γ.
    pub values: Vec<[f32; N]>,
}

/// Four of the nodes of γ, and their weights, by r = 2 − s = (2γ−3)/(γ−1).
#[derive(Clone, Debug)]
pub struct WindowTables {
    /// r at the start of the first slot, and slots in a unit of r.
    pub first: f32,
    /// See `first`.
    pub scale: f32,
    /// The cell of each slot.
    pub slots: Vec<u16>,
    /// The cell of r beyond the last slot.
    pub last: u16,
    /// By cell.
    pub cells: Vec<WindowCell>,
}

/// The weights of nodes of γ between two places.
#[derive(Clone, Copy, Debug)]
pub struct WindowCell {
    /// r where the position is 0, and what it rises by as r falls by 1.
    pub from: f32,
    /// See `from`.
    pub inverse: f32,
    /// The first node, by table.
    pub starts: [u32; 3],
    /// The coefficients of four weights, by table, by power of the position.
    pub weights: [[[f32; 4]; 4]; 3],
}

impl PartTables {
    /// Those of a family, from large γ to small ones.
    #[must_use]
    pub fn of(family: &Family) -> Vec<Self> {
        family.parts.iter().map(Self::new).collect()
    }

    fn new(part: &Part) -> Self {
        Self {
            gammas: part.range,
            windows: WindowTables::new(&part.windows),
            slopes: ByShape::new(&part.slopes),
            lines: part.lines,
            numbers: part.half as usize,
            scales: part.scales,
            across: ByShape::new(&part.across),
            masking: ByShape::new(&part.masking),
            masking_scale: part.masking_view.scale as f32,
            masking_crowded: part.masking_view.crowded,
            masking_cells: part.masking_cells,
            rests: ByShape::new(&part.rests),
            rhos: part.rhos.clone(),
            heavy_per_row: CELLS_PER_ROW as f32,
        }
    }
}

impl<const N: usize> ByShape<N> {
    fn new(planes: &Planes<[f32; N]>) -> Self {
        Self { shapes: planes.shapes, values: planes.values.clone() }
    }
}

impl WindowTables {
    fn new(windows: &Windows<3>) -> Self {
        let cell = |cell: &super::windows::Between<3>| WindowCell {
            from: cell.from,
            inverse: cell.inverse,
            starts: cell.starts,
            weights: cell.weights,
        };
        Self {
            first: windows.first,
            scale: windows.scale,
            slots: windows.slots.clone(),
            last: windows.last,
            cells: windows.cells.iter().map(cell).collect(),
        }
    }
}
