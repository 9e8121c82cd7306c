//! Slices of tables: the γ axis collapsed at one shape, as lookups read them.

use alloc::vec::Vec;

use microfacet_core::shape::s_of_gamma;
use microfacet_lanes::{Ints, Lanes, f32x4};
use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::axis::hermite::{
    Cell, Node, coefficients, cubic, cubic_cells, cubic_lanes, horner, horner_lanes, make_monotone,
};
use microfacet_tables::axis::{HalfTangent, MirroredRoot, Rational};
use microfacet_tables::{Axis, Kind, Mapping, Table, Weights};

use super::coverage::{self, end_weights, shape_weights};
use super::heavy::{self, Heavy};
use super::lanes::one::pair;
use super::lanes::swap_halves;
use super::normals::Normals;
use super::surface::{Shape, Shapes, moment_of};
use crate::error::MaterialError;

/// A (value, slope) table without its γ axis.
pub(crate) struct Slice<'a> {
    pub(crate) kind: Kind,
    pub(crate) nodes: Vec<Node>,
    pub(crate) axes: &'a [Axis],
}

impl<'a> Slice<'a> {
    /// A table that has no γ axis.
    pub(crate) fn whole(table: &'a Table) -> Self {
        Self { kind: table.kind, nodes: pairs(&table.values), axes: &table.axes }
    }

    /// At a node of the γ axis.
    pub(super) fn node(table: &'a Table, i: usize) -> Self {
        Self::at(table, alloc::vec![(i, 1.0)])
    }

    fn at(table: &'a Table, weights: Weights) -> Self {
        let nodes = pairs(&table.collapsed(&[weights]));
        Self { kind: table.kind, nodes, axes: &table.axes }
    }
}

/// Makes both halves of a row, which store 1 + h and 1 − h, end at one slope at u = ½.
///
/// Rounding to 16 bits separates the ends by up to 1e-3, a gap that samples would leave out or draw
/// twice.
fn join(row: &mut [Node]) {
    let (low, high) = row.split_at_mut(row.len() / 2);
    let ([.., before, low], [.., beyond, high]) = (low, high) else { return };
    let middle = 0.5 * (low[0] + (2.0 - high[0]));
    // Both halves still ascend. The second difference is exact.
    high[0] = 2.0 - middle.min(2.0 - beyond[0]).max(before[0]);
    low[0] = 2.0 - high[0];
}

/// Spreads the first nodes of an axis where they are equal, as rounding to 16 bits makes them next
/// to an end: all random numbers between them would draw one slope, which no density describes.
fn spread(nodes: &mut [Node]) {
    let Some(&[first, _]) = nodes.first() else { return };
    let Some(count) = nodes.iter().position(|node| node[0] > first) else { return };
    let step = nodes[count][0] - first;
    for (i, node) in nodes[..count].iter_mut().enumerate() {
        let share = i as f32 / count as f32;
        node[0] = first + step * (share * share);
    }
}

/// Makes both halves of all rows of in-plane slopes, of `half` nodes each, ascend and meet.
pub(super) fn ascending_rows(nodes: &mut [Node], half: usize) {
    nodes.chunks_exact_mut(2 * half).for_each(join);
    nodes.chunks_exact_mut(half).for_each(ascending_across);
}

/// Makes a row of slopes ascend, such as that of slopes across.
pub(super) fn ascending_across(row: &mut [Node]) {
    spread(row);
    make_monotone(row);
}

fn pairs(values: &[f32]) -> Vec<Node> {
    values.chunks_exact(2).map(|node| [node[0], node[1]]).collect()
}

/// All that lookups read of one shape, whatever the roughness.
#[derive(Clone, Debug)]
pub(crate) struct Slices {
    /// γ and s = 1/(γ−1), and D.
    pub(crate) gamma: f64,
    pub(crate) s: f32,
    pub(crate) normals: Normals,
    /// G1/q over the number of cells, by cell of the view coordinate, so that the coordinate in
    /// cells needs no further scaling.
    pub(crate) shadowing: Vec<Cell>,
    /// Cells of the view axis of G1.
    pub(crate) shadowing_cells: f32,
    /// The view coordinate q of G1, and its κ.
    pub(crate) shadowing_view: Rational,
    pub(crate) kappa: f32,
    /// M₀, see [`Shape::first_moment`].
    moment: f32,
    /// In-plane slopes: rows by view, each of `2 (cells + 1)` nodes with the half for u ≤ ½ first;
    /// then a row and a node that are read with weight 0.
    pub(crate) slope: Vec<Node>,
    /// Cells of the view axis of slopes, its coordinate, and the coordinate in cells as lookups
    /// compute it.
    pub(crate) rows: usize,
    pub(crate) view: HalfTangent,
    pub(crate) lines: Lines,
    /// Cells of one half of the u₁ axis.
    pub(crate) half_cells: usize,
    pub(crate) peeled: bool,
    /// Slopes across, the half for u > ½: by node, and by cell.
    pub(crate) across: Vec<Node>,
    pub(crate) across_cells: Vec<Cell>,
    /// Factors from min(u, 1−u)^(1/4) to cells, for u₁ and u₂.
    pub(crate) scales: [f32; 2],
    /// Constants of the heavy part, where `slope` is peeled.
    pub(crate) heavy: Heavy,
}

impl Slices {
    pub(crate) fn from_tables(tables: &[Table], gamma: f64, s: f64) -> Result<Self, MaterialError> {
        let find =
            |kinds| find(tables, kinds, gamma, s).map(|(table, weights)| Slice::at(table, weights));
        let [shadowing, slope, across] = coverage::LOBE.map(find);
        let (shadowing, slope, across) = (shadowing?, slope?, across?);
        let mut slices = Self::new([shadowing, slope], gamma, s);
        slices.normals = Normals::new(s);
        slices.across = across.nodes;
        ascending_across(&mut slices.across);
        slices.scales = [slices.half_cells, slices.across.len() - 1].map(MirroredRoot::scale);
        slices.across_cells = cubic_cells(&slices.across, 1.0);
        Ok(slices)
    }

    /// From the slices of G1 and of in-plane slopes; slopes across stay empty.
    pub(crate) fn new([shadowing, slope]: [Slice; 2], gamma: f64, s: f64) -> Self {
        let (Mapping::Rational(shadowing_view), [.., view, numbers]) =
            (shadowing.axes[shadowing.axes.len() - 1].mapping, slope.axes)
        else {
            unreachable!("validated on load")
        };
        let Mapping::HalfTangent(coordinate) = view.mapping else {
            unreachable!("validated on load")
        };
        let (shadowing_cells, rows) = (shadowing.nodes.len() - 1, view.nodes.len() - 1);
        let mut slopes = slope.nodes;
        ascending_rows(&mut slopes, numbers.nodes.len());
        slopes.resize(slopes.len() + numbers.nodes.len() * 2 + 1, [0.0; 2]);
        let mut slices = Self {
            gamma,
            s: s_of_gamma(gamma) as f32,
            normals: Normals::untabulated(s_of_gamma(gamma)),
            shadowing: cubic_cells(&shadowing.nodes, 1.0 / shadowing_cells as f64),
            shadowing_cells: shadowing_cells as f32,
            kappa: shadowing_view.kappa(s) as f32,
            moment: f32::NAN,
            shadowing_view,
            slope: slopes,
            rows,
            view: coordinate,
            lines: coordinate.lines(rows as f32),
            half_cells: numbers.nodes.len() - 1,
            peeled: slope.kind == Kind::VisibleSlopePeeled,
            across: Vec::new(),
            across_cells: Vec::new(),
            scales: [0.0; 2],
            heavy: Heavy::default(),
        };
        slices.moment = moment_of(&slices);
        if slices.peeled {
            let moment = f64::from(slices.first_moment());
            let share = |t: f64| slices.share_of_moment(moment, t);
            slices.heavy = Heavy::new(gamma, s, slices.rows, share);
        }
        slices
    }

    /// M₀ρ/area at the coordinate t of a view, from the table of G1.
    pub(super) fn share_of_moment(&self, moment: f64, t: f64) -> f64 {
        let [rho, area] = self.heavy_and_area(moment, t);
        (rho / area).clamp(0.0, 1.0)
    }

    /// ρ and area/M₀, of the length of 1 + τ², at the coordinate t of a view.
    pub(super) fn heavy_and_area(&self, moment: f64, t: f64) -> [f64; 2] {
        let [tau, rest] = self.view.parts(t);
        // ρ : z is 1 − τ² : 2τ.
        let (rho, z) = (rest * (1.0 + tau), 2.0 * tau);
        let kappa = f64::from(self.kappa);
        let at = self.shadowing_view.coordinate(z / rho, kappa) * f64::from(self.shadowing_cells);
        let cell = (at as usize).min(self.shadowing.len() - 2);
        let [c0, c1, c2, c3] = self.shadowing[cell].map(f64::from);
        let w = at - cell as f64;
        let shadowing = c0 + w * (c1 + w * (c2 + w * c3));
        [rho, (z + kappa * rho) / (moment * shadowing * f64::from(self.shadowing_cells))]
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.shadowing[..])
            + size_of_val(&self.slope[..])
            + size_of_val(&self.across_cells[..])
            + self.normals.bytes()
    }
}

impl Shapes for &Slices {
    #[inline(always)]
    fn s_lanes<L: Lanes>(self) -> L {
        L::splat(self.s)
    }

    #[inline(always)]
    fn peeled(self) -> bool {
        self.peeled
    }

    #[inline(always)]
    fn lines(self) -> Lines {
        self.lines
    }

    #[inline(always)]
    fn half(self) -> u32 {
        self.half_cells as u32 + 1
    }

    #[inline(always)]
    fn scales(self) -> [f32; 2] {
        self.scales
    }

    #[inline(always)]
    fn between_lanes<L: Lanes>(self, low: L::Ints, w: L) -> [L; 4] {
        let (nodes, low) = (&self.slope[..], low.to_array());
        let stride = 2 * (self.half_cells + 1);
        let read = |at: usize| {
            if at + 2 > nodes.len() { f32x4::splat(f32::NAN) } else { pair(nodes, at) }
        };
        L::columns_between(|i| read(low[i] as usize), |i| read(low[i] as usize + stride), w)
    }

    #[inline(always)]
    fn across_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L {
        cubic_lanes(coefficients(&self.across_cells, cells), w)
    }

    #[inline(always)]
    fn parts<L: Lanes>(self, u: L, at: L) -> [L; 2] {
        heavy::parts(u, self.heavy.shares(at))
    }

    #[inline(always)]
    fn tails<L: Lanes>(self) -> [L; 2] {
        self.heavy.tail.in_lanes()
    }

    #[inline(always)]
    fn masking_view(self) -> (Rational, f32) {
        (self.shadowing_view, self.shadowing_cells)
    }

    #[inline(always)]
    fn masking_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L {
        horner_lanes(coefficients(&self.shadowing, cells), w)
    }
}

impl<'a> Shape for &'a Slices {
    type Seed = Self;
    type MaskingCell = &'a Cell;

    #[inline(always)]
    fn seed(self) -> Self {
        self
    }

    #[inline(always)]
    fn of_seed(seed: Self) -> Self {
        seed
    }

    #[inline(always)]
    fn s(self) -> f32 {
        self.s
    }

    #[inline(always)]
    fn reads(self, high: usize, across: usize) -> bool {
        high + 2 <= self.slope.len() && across < self.across_cells.len()
    }

    #[inline(always)]
    fn between(self, low: usize, high: usize, w: f32) -> f32x4 {
        let nodes = &self.slope[..];
        if high + 2 > nodes.len() {
            return f32x4::splat(f32::NAN);
        }
        let (low, high) = (pair(nodes, low), pair(nodes, high));
        low + f32x4::splat(w) * (high - low)
    }

    #[inline(always)]
    fn across(self, cell: usize, w: f32) -> f32 {
        self.across_cells.get(cell).map_or(f32::NAN, |cell| cubic(cell, w))
    }

    #[inline(always)]
    fn share(self, at: f32) -> f32 {
        self.heavy.share(at)
    }

    #[inline(always)]
    fn kappa(self) -> f32 {
        self.kappa
    }

    #[inline(always)]
    fn masking_cell(self, cell: usize) -> Option<&'a Cell> {
        self.shadowing.get(cell)
    }

    #[inline(always)]
    fn masking(cell: &Cell, w: f32) -> f32 {
        horner(cell, w)
    }

    #[inline(always)]
    fn masking_of_two(self, cells: [usize; 2], w: f32x4) -> Option<f32x4> {
        let [a, b] = cells;
        let (a, b) = (self.shadowing.get(a)?, self.shadowing.get(b)?);
        // c₀ and c₁ of both, then c₂ and c₃.
        let (a, b) = (f32x4::new(*a), f32x4::new(*b));
        let (low, high) = (a.unpack_lo(b), a.unpack_hi(b));
        let ([wa, wb, ..], square) = (w.to_array(), w * w);
        let terms = (low + square * high) * f32x4::new([1.0, 1.0, wa, wb]);
        Some(terms + swap_halves(terms))
    }

    #[inline(always)]
    fn first_moment(self) -> f32 {
        self.moment
    }

    #[inline(always)]
    fn d(self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32 {
        self.normals.d(r2, z2, length2, scale)
    }
}

/// The first table of one of `kinds` that covers s, and its weights; earlier kinds are preferred,
/// and tables that hold s to those that end within rounding of it.
fn find<'a>(
    tables: &'a [Table],
    kinds: &[Kind],
    gamma: f64,
    s: f64,
) -> Result<(&'a Table, Weights), MaterialError> {
    for weights in [shape_weights, end_weights] {
        for &kind in kinds {
            let of_kind = tables.iter().filter(|table| table.kind == kind);
            let mut served = of_kind.filter_map(|table| Some((table, weights(table, s)?)));
            if let Some(found) = served.next() {
                return Ok(found);
            }
        }
    }
    Err(coverage::not_covered(tables, gamma))
}

/// See [`port::tables_of_shape`](crate::port::tables_of_shape).
pub(crate) fn tables_of_shape(tables: &[Table], gamma: f64) -> Result<[&Table; 3], MaterialError> {
    let find = |kinds| find(tables, kinds, gamma, s_of_gamma(gamma)).map(|(table, _)| table);
    let [shadowing, slope, across] = coverage::LOBE.map(find);
    Ok([shadowing?, slope?, across?])
}
