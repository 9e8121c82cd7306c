//! The tables of a [`Family`](super::family::Family), and one γ of them as lookups read it.

use alloc::vec::Vec;

use microfacet_core::math::{sqrt, within};
use microfacet_core::shape::{S_END, gamma_of_s};
use microfacet_lanes::{Ints, Lanes, f32x4};
use microfacet_tables::axis::half_tangent::Lines;
use microfacet_tables::axis::hermite::{
    Cell, Node, basis, coefficients, cubic, cubic_lanes, hermite, hermite_lanes,
};
use microfacet_tables::axis::{MirroredRoot, Rational};
use microfacet_tables::{Interpolation, Kind, Mapping, Table};

use super::heavy::{self, Tail, cell_of_share, cells_of_share};
use super::lanes::sum;
use super::normals::PowerLaw;
use super::slices::{Slice, Slices, ascending_across, ascending_rows};
use super::surface::{Shape, Shapes, moment_of};
use super::windows::{Planes, Window, Windows};

/// Stands for γ = ∞: the reciprocal of γ − 1, and its square, are still normal numbers.
const LARGEST: f64 = 1e18;

/// The tables of the shapes of one kind of in-plane slopes, whole or peeled.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The smallest and the largest γ; the largest that lookups take, finite, is apart.
    pub(super) gammas: [f64; 2],
    pub(super) range: [f32; 2],
    /// Of in-plane slopes, of slopes across and of G1.
    pub(super) windows: Windows<3>,
    /// In-plane slopes, as in [`Slices`].
    pub(super) slopes: Planes<Node>,
    pub(super) lines: Lines,
    pub(super) half: u32,
    pub(super) scales: [f32; 2],
    /// Slopes across, the half for u > ½.
    pub(super) across: Planes<Node>,
    /// G1/q over the number of cells.
    pub(super) masking: Planes<Node>,
    pub(super) masking_view: Rational,
    pub(super) masking_cells: f32,
    /// The part of the area that is not heavy, over M₀, by cell of the view coordinate; empty for
    /// whole distributions. It is smooth in γ up to 3/2, as the share of the heavy part is not.
    pub(super) rests: Planes<Cell>,
    /// ρ of the same views, to which that of the heavy part is equal.
    pub(super) rhos: Vec<Cell>,
}

impl Part {
    /// Of the table of in-plane slopes of a kind with the widest range of γ, and the tables of G1
    /// and of slopes across that hold most of it; `None` where there is no range.
    pub(super) fn new(tables: &[Table], kind: Kind) -> Option<Self> {
        let interpolated = |kind: Kind| {
            let of = move |table: &&Table| {
                table.kind == kind && table.axes[0].interpolation == Interpolation::Lagrange4
            };
            tables.iter().filter(of)
        };
        let within = |range: [f64; 2], table: &Table| {
            let [low, high] = table.subject.lobe.s();
            [range[0].max(low), range[1].min(high)]
        };
        let width = |range: [f64; 2]| range[1] - range[0];
        let most = |kind: Kind, range: [f64; 2]| {
            let by = |a: &&Table, b: &&Table| {
                // The first of those that hold as much.
                width(within(range, a)).total_cmp(&width(within(range, b))).reverse()
            };
            let table = interpolated(kind).min_by(by)?;
            Some((table, within(range, table)))
        };
        let (slope, range) = most(kind, [0.0, S_END])?;
        let (shadowing, range) = most(Kind::Shadowing, range)?;
        let (across, range) = most(Kind::VisibleSlopeConditional, range)?;
        (width(range) > 0.0).then(|| Self::of([slope, shadowing, across], range))
    }

    fn of([slope, shadowing, across]: [&Table; 3], range: [f64; 2]) -> Self {
        let (Mapping::HalfTangent(view), Mapping::Rational(masking_view)) =
            (slope.axes[1].mapping, shadowing.axes[1].mapping)
        else {
            unreachable!("validated on load")
        };
        let (rows, numbers) = (slope.axes[1].len() - 1, slope.axes[2].nodes.len());
        let (cells, across_cells) = (shadowing.axes[1].len() - 1, across.axes[1].len() - 1);
        // One row and one node more than the table has are read with weight 0.
        let axes = [slope, across, shadowing].map(|table| &table.axes[0].nodes[..]);
        let windows = Windows::new(axes, range);
        let slopes = Planes::new(slope.axes[0].nodes.len(), 2 * numbers + 1, |i| {
            let mut nodes = Slice::node(slope, i).nodes;
            ascending_rows(&mut nodes, numbers);
            nodes
        });
        let across = Planes::new(across.axes[0].nodes.len(), 1, |i| {
            let mut nodes = Slice::node(across, i).nodes;
            ascending_across(&mut nodes);
            nodes
        });
        let masking = Planes::new(shadowing.axes[0].nodes.len(), 1, |i| {
            let scaled = |x: f32| (f64::from(x) / cells as f64) as f32;
            Slice::node(shadowing, i).nodes.into_iter().map(|node| node.map(scaled)).collect()
        });
        let at_node = |i: usize| {
            let s = shadowing.axes[0].nodes[i];
            let slices =
                Slices::new([Slice::node(shadowing, i), Slice::node(slope, 0)], gamma_of_s(s), s);
            let moment = f64::from(slices.first_moment());
            move |t: f64| slices.heavy_and_area(moment, t)
        };
        let rests = |i: usize| {
            let at = at_node(i);
            cells_of_share(rows, |t| {
                let [rho, area] = at(t);
                (area - rho).max(0.0)
            })
        };
        let peeled = slope.kind == Kind::VisibleSlopePeeled;
        Self {
            gammas: [range[1], range[0]].map(gamma_of_s),
            range: [range[1], range[0]].map(|s| gamma_of_s(s).min(LARGEST) as f32),
            windows,
            slopes,
            lines: view.lines(rows as f32),
            half: numbers as u32,
            scales: [numbers - 1, across_cells].map(MirroredRoot::scale),
            across,
            masking,
            masking_view,
            masking_cells: cells as f32,
            rests: if peeled {
                Planes::new(shadowing.axes[0].nodes.len(), 0, rests)
            } else {
                Planes::default()
            },
            rhos: if peeled {
                let at = at_node(0);
                cells_of_share(rows, |t| at(t)[0])
            } else {
                Vec::new()
            },
        }
    }

    /// γ within the range, NaN at its lower end; finite.
    #[inline(always)]
    pub(super) fn clamped(&self, gamma: f32) -> f32 {
        within(gamma, self.range)
    }

    /// A clamped γ in double precision, in which an end that was rounded outwards is that end.
    pub(super) fn exact(&self, gamma: f32) -> f64 {
        let [low, high] = self.gammas;
        if gamma >= LARGEST as f32 { high } else { f64::from(gamma).clamp(low, high) }
    }

    pub(super) fn bytes(&self) -> usize {
        self.windows.bytes()
            + self.slopes.bytes()
            + self.across.bytes()
            + self.masking.bytes()
            + self.rests.bytes()
            + size_of_val(&self.rhos[..])
    }
}

/// One γ of a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtShape<'a> {
    part: &'a Part,
    gamma: f32,
    s: f32,
    /// κ of G1's coordinate.
    kappa: f32,
    tail: Tail,
    slopes: Window,
    across: Window,
    masking: Window,
}

impl<'a> AtShape<'a> {
    /// Of a γ within the part's range.
    #[inline(always)]
    pub(super) fn new(part: &'a Part, gamma: f32) -> Self {
        let (above_one, twice) = (gamma - 1.0, 2.0 * gamma - 3.0);
        let (s, exponent) = (1.0 / above_one, 1.0 / twice);
        // 2 − s without cancellation.
        let [slopes, across, masking] = part.windows.at(twice * s);
        Self {
            part,
            gamma,
            s,
            // As `Rational::kappa`: scale/(2 − s).
            kappa: part.masking_view.scale as f32 * (above_one * exponent),
            tail: Tail { exponent, root_s: sqrt(s) },
            slopes,
            across,
            masking,
        }
    }

    pub(super) fn bytes(self) -> usize {
        self.part.bytes()
    }

    pub(super) fn gamma(self) -> f64 {
        self.part.exact(self.gamma)
    }

    /// The area of the heavy part and the rest, at a view coordinate in rows; NaN for NaN.
    #[inline(always)]
    fn areas(self, at: f32) -> [f32; 2] {
        let (cell, w) = cell_of_share(f32x4::splat(at));
        let (cell, w) = (cell.to_array()[0] as u32 as usize, w.to_array()[0]);
        let rest = cubic(&self.part.rests.cell(self.masking, cell), w);
        self.part.rhos.get(cell).map_or([f32::NAN; 2], |rho| [cubic(rho, w), rest])
    }
}

/// Shapes of one part: one for each lane, or one for all.
#[derive(Clone, Copy)]
pub(super) struct PerLane<'a>(pub(super) &'a [AtShape<'a>]);

impl<'a> PerLane<'a> {
    #[inline(always)]
    fn part(self) -> &'a Part {
        self.0[0].part
    }

    #[inline(always)]
    fn at(self, lane: usize) -> &'a AtShape<'a> {
        &self.0[lane.min(self.0.len() - 1)]
    }
}

impl Shapes for PerLane<'_> {
    #[inline(always)]
    fn s_lanes<L: Lanes>(self) -> L {
        L::from_fn(|i| self.at(i).s)
    }

    #[inline(always)]
    fn peeled(self) -> bool {
        !self.part().rests.is_empty()
    }

    #[inline(always)]
    fn lines(self) -> Lines {
        self.part().lines
    }

    #[inline(always)]
    fn half(self) -> u32 {
        self.part().half
    }

    #[inline(always)]
    fn scales(self) -> [f32; 2] {
        self.part().scales
    }

    #[inline(always)]
    fn between_lanes<L: Lanes>(self, low: L::Ints, w: L) -> [L; 4] {
        let (low, w, stride) = (low.to_array(), w.to_array(), 2 * self.part().half as usize);
        L::columns(|i| self.at(i).between(low[i] as usize, low[i] as usize + stride, w[i]))
    }

    #[inline(always)]
    fn across_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L {
        let (table, cells) = (&self.part().across, cells.to_array());
        let pair = |i: usize| table.pair_or_nan(self.at(i).across, cells[i]);
        hermite_lanes(L::columns(pair), w)
    }

    #[inline(always)]
    fn parts<L: Lanes>(self, u: L, at: L) -> [L; 2] {
        let (cells, w) = cell_of_share(at);
        let (part, places) = (self.part(), cells.to_array());
        let rest = |i: usize| part.rests.cell(self.at(i).masking, places[i] as u32 as usize);
        let rest = cubic_lanes(L::columns(|i| f32x4::new(rest(i))), w);
        let heavy = cubic_lanes(coefficients(&part.rhos, cells), w);
        heavy::parts_of_areas(u, heavy, rest)
    }

    #[inline(always)]
    fn tails<L: Lanes>(self) -> [L; 2] {
        let tail = |i: usize| self.at(i).tail;
        [L::from_fn(|i| tail(i).exponent), L::from_fn(|i| tail(i).root_s)]
    }

    #[inline(always)]
    fn masking_view(self) -> (Rational, f32) {
        (self.part().masking_view, self.part().masking_cells)
    }

    #[inline(always)]
    fn masking_lanes<L: Lanes>(self, cells: L::Ints, w: L) -> L {
        let (table, cells) = (&self.part().masking, cells.to_array());
        let pair = |i: usize| table.pair_or_nan(self.at(i).masking, cells[i]);
        hermite_lanes(L::columns(pair), w)
    }
}

/// Those of one shape for all lanes.
macro_rules! for_all_lanes {
    ($(fn $name:ident$(<$lanes:ident>)?($($value:ident: $type:ty),*) -> $out:ty;)*) => {$(
        #[inline(always)]
        fn $name$(<$lanes: Lanes>)?(self $(, $value: $type)*) -> $out {
            PerLane(&[self]).$name($($value),*)
        }
    )*};
}

impl Shapes for AtShape<'_> {
    for_all_lanes! {
        fn s_lanes<L>() -> L;
        fn peeled() -> bool;
        fn lines() -> Lines;
        fn half() -> u32;
        fn scales() -> [f32; 2];
        fn between_lanes<L>(low: L::Ints, w: L) -> [L; 4];
        fn across_lanes<L>(cells: L::Ints, w: L) -> L;
        fn parts<L>(u: L, at: L) -> [L; 2];
        fn tails<L>() -> [L; 2];
        fn masking_view() -> (Rational, f32);
        fn masking_lanes<L>(cells: L::Ints, w: L) -> L;
    }
}

impl<'a> Shape for AtShape<'a> {
    type Seed = (&'a Part, f32);
    type MaskingCell = f32x4;

    #[inline(always)]
    fn seed(self) -> Self::Seed {
        (self.part, self.gamma)
    }

    #[inline(always)]
    fn of_seed((part, gamma): Self::Seed) -> Self {
        Self::new(part, gamma)
    }

    #[inline(always)]
    fn s(self) -> f32 {
        self.s
    }

    /// The reads test themselves.
    #[inline(always)]
    fn reads(self, _high: usize, _across: usize) -> bool {
        true
    }

    #[inline(always)]
    fn between(self, low: usize, high: usize, w: f32) -> f32x4 {
        let nodes = self.part.slopes.between(self.slopes, low, high, w);
        // Nodes of negative weight may make slopes leave the range in which the cubic ascends, see
        // `limit_slopes`. `fast_max` takes NaN to the other number, which no normal is made of.
        let [from, _, to, _] = nodes.to_array();
        let rise = to - from;
        let limit = if rise > 0.0 { 3.0 * rise } else { 0.0 };
        let most = f32x4::new([f32::MAX, limit, f32::MAX, limit]);
        nodes.fast_max(f32x4::ZERO).fast_min(most)
    }

    #[inline(always)]
    fn across(self, cell: usize, w: f32) -> f32 {
        let pair = self.part.across.pair(self.across, cell);
        pair.map_or(f32::NAN, |pair| sum(pair * basis(f32x4::splat(w))).to_array()[0])
    }

    #[inline(always)]
    fn share(self, at: f32) -> f32 {
        let [heavy, rest] = self.areas(at);
        heavy / (heavy + rest)
    }

    /// Without the division, which everything else would wait for.
    #[inline(always)]
    fn part(self, u: f32, at: f32) -> heavy::Part {
        let [heavy, rest] = self.areas(at);
        heavy::Part::of_areas(u, heavy, rest)
    }

    #[inline(always)]
    fn kappa(self) -> f32 {
        self.kappa
    }

    #[inline(always)]
    fn masking_cell(self, cell: usize) -> Option<f32x4> {
        self.part.masking.pair(self.masking, cell)
    }

    #[inline(always)]
    fn masking(nodes: f32x4, w: f32) -> f32 {
        let [v0, s0, v1, s1] = nodes.to_array();
        hermite([v0, s0], [v1, s1], w)
    }

    #[inline(always)]
    fn masking_of_two(self, cells: [usize; 2], w: f32x4) -> Option<f32x4> {
        let [a, b] = cells;
        let a = self.part.masking.pair(self.masking, a)?;
        let b = self.part.masking.pair(self.masking, b)?;
        // Lanes [v0, v0, …] of both, and so on, by one transposition.
        let nodes = f32x4::transpose([a, b, a, b]);
        Some(hermite_lanes(nodes, w))
    }

    #[inline(always)]
    fn first_moment(self) -> f32 {
        moment_of(self)
    }

    #[inline(always)]
    fn d(self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32 {
        PowerLaw::of_shape(self.s, self.gamma).d(r2, z2, length2, scale)
    }
}
