//! Certificates of tables of visible normals: interpolation errors between nodes, measured with the
//! f32 sampler.
//!
//! All points are fixed, so that the certificate is part of the table's reproducible bytes: listed
//! points (ends of axes, middles of cells), a low-discrepancy sequence, and climbs from the worst
//! of both to the maxima nearby, which no sequence meets.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use glam::Vec3;
use rayon::prelude::*;

use microfacet_core::shape::{S_END, gamma_of_s, s_of_gamma};
use microfacet_model::{Shape, SignedSlope, UnitView, VisibleSlope, across_cdf};
use microfacet_sampler::{MaterialError, MicrofacetDistribution, StudentT, Tables};
use microfacet_tables::axis::{HalfTangent, MirroredRoot};
use microfacet_tables::{
    Axis, Certificate, Coordinate, Errors, Interpolation, Kind, Mapping, Quantity, Table,
};

use crate::progress::Stage;
use crate::table_spec::{GAMMA_WHOLE, SEAM};

/// Points measured at each γ of a range; a single γ takes three times as many.
pub const POINTS: usize = 4000;

/// The range of s of all shapes.
pub const ALL_SHAPES: [f64; 2] = [0.0, S_END];

/// One ulp of f32 just below 1. The rounding of single precision differs from point to point; this
/// margin is left for points that were not measured.
pub(super) const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// A point of a table, in cells along the axes of shapes, of views and of random numbers. Halves of
/// a mirrored axis are joined at u = ½, so that u = 0 and 1 are its ends.
pub(super) type Place = [f64; 3];

/// Coordinates to measure at along one axis.
#[derive(Clone, Debug)]
pub(super) struct Along {
    /// Number of cells; 0 where there is no axis.
    pub(super) cells: f64,
    /// Listed coordinates.
    names: Vec<f64>,
}

impl Along {
    pub(super) fn none() -> Self {
        Self { cells: 0.0, names: vec![0.0] }
    }

    /// An axis with so many nodes; both ends are listed.
    pub(super) fn whole(nodes: usize) -> Self {
        let cells = (nodes - 1) as f64;
        let near = 1e-7 * cells;
        Self { cells, names: vec![0.0, near, cells - near, cells] }
    }

    /// A mirrored axis with so many nodes in either half; u = 0, ½ and 1, the numbers next to them,
    /// and 1e-7 are listed.
    pub(super) fn mirrored(nodes: usize) -> Self {
        let half = (nodes - 1) as f64;
        let near = |u: f64| half * MirroredRoot::of_number(u);
        let low = [0.0, near(1e-7), half * (1.0 - ROUNDING)];
        let high = [2.0 * half, 2.0 * half - near(ROUNDING), half * (1.0 + ROUNDING)];
        Self { cells: 2.0 * half, names: [&low[..], &[half], &high].concat() }
    }

    /// The same with more listed coordinates, given as shares of the axis.
    pub(super) fn and(mut self, names: impl IntoIterator<Item = f64>) -> Self {
        let cells = self.cells;
        self.names.extend(names.into_iter().map(|share| (share * cells).clamp(0.0, cells)));
        self
    }

    /// The axis up to a share of it.
    pub(super) fn up_to(mut self, share: f64) -> Self {
        self.cells = (self.cells * share).ceil();
        self.names.iter_mut().for_each(|name| *name *= share);
        self
    }

    fn middles(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.cells as usize).map(|cell| cell as f64 + 0.5)
    }

    /// The coordinate of the number x in [0, 1).
    fn place(&self, within: Within, x: f64) -> f64 {
        match within {
            _ if self.cells == 0.0 => 0.0,
            Within::Node => (x * (self.cells + 1.0)).floor(),
            Within::Middle => (x * self.cells).floor() + 0.5,
            Within::Anywhere => towards_ends(x) * self.cells,
        }
    }
}

/// The position of points within the cells of an axis.
#[derive(Clone, Copy)]
enum Within {
    /// At the nodes, where errors of neighbouring rows do not mix.
    Node,
    Middle,
    Anywhere,
}

/// Combinations of [`Within`] that points of the sequence take in turn, on two axes and on one.
const TURNS: [[Within; 2]; 4] = [
    [Within::Middle, Within::Middle],
    [Within::Node, Within::Middle],
    [Within::Anywhere, Within::Middle],
    [Within::Anywhere, Within::Anywhere],
];
const TURNS_ALONE: [[Within; 2]; 4] = [TURNS[0], TURNS[3], TURNS[3], TURNS[3]];

/// u at `place` cells along a mirrored axis with `half` cells in each half.
pub fn number(place: f64, half: f64) -> f32 {
    let of_half = |t: f64| MirroredRoot::number(t / half);
    let u = if place <= half { of_half(place) } else { 1.0 - of_half(2.0 * half - place) };
    u as f32
}

/// About `points` points on two axes: pairs of listed coordinates, listed coordinates with middles
/// of cells, and the sequence.
pub(super) fn places([a, b]: [&Along; 2], points: usize) -> Vec<[f64; 2]> {
    let corners = a.names.iter().flat_map(|&x| b.names.iter().map(move |&y| [x, y]));
    let edges = a.names.iter().flat_map(|&x| b.middles().map(move |y| [x, y]));
    let others = b.names.iter().flat_map(|&y| a.middles().map(move |x| [x, y]));
    let edges: Vec<[f64; 2]> = edges.chain(others).collect();
    // If these are more than a third of all points, an evenly spaced subset of them.
    let kept = edges.len().min(points / 3);
    let edges = (0..kept).map(|i| edges[i * edges.len() / kept]);
    let named: Vec<[f64; 2]> = corners.chain(edges).collect();
    let turns = if a.cells > 0.0 && b.cells > 0.0 { TURNS } else { TURNS_ALONE };
    let sequence = (0..points.saturating_sub(named.len())).map(|i| {
        let ([x, y], [of_a, of_b]) = (low_discrepancy(PLASTIC, i), turns[i % turns.len()]);
        [a.place(of_a, x), b.place(of_b, y)]
    });
    named.iter().copied().chain(sequence).collect()
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) error: f64,
    pub(super) at: Place,
}

impl Seen {
    /// Key to sort errors by: none is below 0, and a NaN of either sign is the worst.
    fn rank(&self) -> u64 {
        self.error.abs().to_bits()
    }

    pub(super) fn exceeds(&self, other: &Self) -> bool {
        self.rank() > other.rank()
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) worst: Seen,
    /// Root mean square error, without the climbs.
    pub(super) rms: f64,
    pub(super) points: usize,
}

impl Found {
    /// The certificate of a table of one quantity, rounded up; `with_rms` adds the root mean
    /// square.
    pub(super) fn certificate(&self, of: Quantity, with_rms: bool) -> Certificate {
        let errors = Errors {
            largest: round_up(self.worst.error + ROUNDING),
            rms: with_rms.then(|| round_up(self.rms)),
            outside: None,
        };
        Certificate {
            errors: [(of, errors)].into(),
            points: Some(self.points as u32),
            ..Certificate::default()
        }
    }
}

/// Climbs from the worst of `seen`, `climbs` times and from points in different cells, along axes
/// of `cells` cells (0 for a missing axis). Each cell has hills of its own: points a whole cell
/// apart would leave out the neighbour's, by which the error of γ = 1.6 was missed by 9 %.
pub(super) fn climbed(
    mut seen: Vec<Seen>,
    climbs: usize,
    cells: Place,
    error: impl Fn(Place) -> f64 + Sync,
) -> Found {
    let sum: f64 = seen.iter().map(|seen| seen.error * seen.error).sum();
    let rms = (sum / seen.len().max(1) as f64).sqrt();
    seen.sort_by_key(|seen| Reverse(seen.rank()));
    let mut starts: Vec<Seen> = Vec::new();
    for one in &seen {
        let apart = |a: &Seen| (0..3).any(|k| a.at[k].floor() != one.at[k].floor());
        if starts.len() < climbs && starts.iter().all(apart) {
            starts.push(*one);
        }
    }
    let tops: Vec<(Seen, usize)> =
        starts.par_iter().map(|start| climb(*start, cells, &error)).collect();
    let points = seen.len() + tops.iter().map(|(_, points)| points).sum::<usize>();
    let worst = tops.iter().map(|(top, _)| *top).reduce(|a, b| if b.exceeds(&a) { b } else { a });
    Found { worst: worst.unwrap_or(Seen { error: 0.0, at: [0.0; 3] }), rms, points }
}

/// The maximum uphill from `start`, to a hundredth of a cell, and the number of points measured on
/// the way.
fn climb(start: Seen, cells: Place, error: &impl Fn(Place) -> f64) -> (Seen, usize) {
    let (mut top, mut step, mut points) = (start, 0.25, 0);
    while step > 0.005 {
        let mut best = top;
        for (k, sign) in (0..3).flat_map(|k| [(k, -1.0), (k, 1.0)]) {
            let mut at = top.at;
            at[k] = (at[k] + sign * step).clamp(0.0, cells[k]);
            if cells[k] > 0.0 && at != top.at {
                points += 1;
                let next = Seen { error: error(at), at };
                best = if next.exceeds(&best) { next } else { best };
            }
        }
        if best.exceeds(&top) { top = best } else { step *= 0.5 }
    }
    (top, points)
}

/// The errors of one table of visible normals or masking, in a set with all tables that a material
/// is made from, measured at about [`POINTS`] points for each of a few γ between every two nodes,
/// and rounded up to three digits.
///
/// `s` limits the shapes to those that the table covers: nodes beyond serve interpolation only, and
/// between those the table is less accurate.
pub(crate) fn measure(
    tables: &Tables,
    table: &Table,
    s: [f64; 2],
    stage: &Stage,
) -> Result<Certificate, MaterialError> {
    let ruler = Ruler::new(tables, table, s);
    let found = ruler.measured(POINTS, stage)?;
    let quantity = match table.kind {
        Kind::Shadowing => Quantity::G1,
        _ => Quantity::Cdf,
    };
    Ok(Certificate { at: ruler.named(found.worst.at), ..found.certificate(quantity, true) })
}

/// Rounds up to three significant digits, so that no certificate is below the measured error.
pub(super) fn round_up(x: f64) -> f64 {
    if !(x > 0.0) {
        return x;
    }
    let text = format!("{:.2e}", x * 1.005);
    text.parse().expect("a number just printed")
}

/// Views and first random numbers with which slopes across are drawn, which depend on neither apart
/// from rounding.
const BESIDE: [([f32; 2], f32); 4] =
    [([0.0, 1.0], 0.4), ([1.0, 0.0], 1.0), ([0.6, 0.8], 0.0), ([1.0, 0.0], 0.5)];

/// The shapes along the axis of a table that are measured.
#[derive(Clone, Debug)]
pub struct Shapes {
    nodes: Vec<f64>,
    /// Whether the table covers shapes between its nodes.
    is_range: bool,
    /// The ends of the range of shapes to measure.
    s: [f64; 2],
}

impl Shapes {
    fn new(axis: &Axis, [low, high]: [f64; 2]) -> Self {
        let [first, last] = axis.ends();
        let [low, high] = [first.max(low), last.min(high)];
        // At the seam itself, γ = 1.8, the tables of the whole distribution are read.
        let beside = low == s_of_gamma(GAMMA_WHOLE) && high > low + SEAM;
        let low = if beside { low + SEAM } else { low };
        let is_range = axis.interpolation != Interpolation::Nodes && axis.nodes.len() > 1;
        // Slightly inside the far end, since 1 + 1/s may round to just outside, but not below the
        // near end.
        let s = [low, (high * (1.0 - 1e-15)).max(low)];
        Self { nodes: axis.nodes.clone(), is_range, s }
    }

    /// Number of cells; 0 for a list of single shapes.
    fn cells(&self) -> f64 {
        if self.is_range { (self.nodes.len() - 1) as f64 } else { 0.0 }
    }

    /// The ends of a range, in cells.
    pub(crate) fn ends(&self) -> [f64; 2] {
        let (nodes, count) = (&self.nodes, self.nodes.len());
        self.s.map(|s| {
            let cell = nodes.partition_point(|&node| node <= s).clamp(1, count - 1) - 1;
            cell as f64 + (s - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
        })
    }

    /// Coordinates to measure at, in cells: all of a list; of a range its ends, nodes, and three
    /// points between every two nodes.
    fn sweep(&self) -> Vec<f64> {
        let count = self.nodes.len();
        if !self.is_range {
            return (0..count).map(|i| i as f64).collect();
        }
        let ends = self.ends();
        let between = (0..count - 1).flat_map(|i| [0.0, 0.21, 0.5, 0.83].map(|w| i as f64 + w));
        let inside = between.filter(|&place| place > ends[0] && place < ends[1]);
        inside.chain(ends).collect()
    }

    /// The coordinate in cells at a share of the range; for a list, the index of the shape nearest
    /// to s.
    pub fn place(&self, share: f64, s: f64) -> f64 {
        if self.is_range {
            let [first, last] = self.ends();
            return first + share * (last - first);
        }
        let off = |i: &usize| (self.nodes[*i] - s).abs();
        (0..self.nodes.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0) as f64
    }

    /// s at a coordinate in cells, inside the ends.
    pub fn s(&self, place: f64) -> f64 {
        let nodes = &self.nodes;
        if !self.is_range {
            return nodes[place as usize];
        }
        let cell = (place as usize).min(nodes.len() - 2);
        let s = nodes[cell] + (place - cell as f64) * (nodes[cell + 1] - nodes[cell]);
        s.clamp(self.s[0], self.s[1])
    }
}

/// Measures one table.
pub struct Ruler<'a> {
    tables: &'a Tables,
    table: &'a Table,
    /// The shapes that are measured.
    pub shapes: Shapes,
    views: Along,
    numbers: Along,
}

/// A lobe made from the tables, and its shape in the model.
pub type LobeAndShape = (StudentT, Shape);

impl<'a> Ruler<'a> {
    /// For one of the tables, between two s.
    pub fn new(tables: &'a Tables, table: &'a Table, s: [f64; 2]) -> Self {
        let nodes = |axis: usize| table.axes[axis].nodes.len();
        let (views, numbers) = match table.kind {
            Kind::Shadowing => (Along::whole(nodes(1)), Along::none()),
            Kind::VisibleSlopeConditional => (Along::none(), Along::mirrored(nodes(1))),
            _ => (Along::whole(nodes(1)), Along::mirrored(nodes(2))),
        };
        Self { tables, table, shapes: Shapes::new(&table.axes[0], s), views, numbers }
    }

    fn measured(&self, points: usize, stage: &Stage) -> Result<Found, MaterialError> {
        // A maximum that is missed at one γ is found at a neighbouring γ. A single γ has no
        // neighbour and takes more points.
        let points = if self.shapes.is_range { points } else { 3 * points };
        let points = match self.table.kind {
            Kind::VisibleSlopeConditional => points / BESIDE.len(),
            _ => points,
        };
        // A quarter of the points is left for the climbs.
        let places = places([&self.views, &self.numbers], points - points / 4);
        let at_shape = |&place: &f64| {
            let lobe = self.lobe(place)?;
            let seen = places.iter().map(|&[a, b]| {
                let at = [place, a, b];
                Seen { error: self.error(&lobe, at), at }
            });
            let seen = seen.collect::<Vec<_>>();
            stage.step();
            Ok(seen)
        };
        let shapes = self.shapes.sweep();
        // The climbs take as long as a third of a shape.
        stage.split(shapes.len() + 1);
        let seen = shapes.par_iter().map(at_shape).collect::<Result<Vec<_>, MaterialError>>()?;
        let cells = [self.shapes.cells(), self.views.cells, self.numbers.cells];
        // `lobe` did not fail at the points of the sweep on either side, so it does not fail here.
        let error = |at: Place| self.lobe(at[0]).map_or(f64::NAN, |lobe| self.error(&lobe, at));
        Ok(climbed(seen.concat(), (points / 200).max(2), cells, error))
    }

    /// The lobe and the shape at a coordinate in cells along the axis of shapes.
    pub fn lobe(&self, place: f64) -> Result<LobeAndShape, MaterialError> {
        let gamma = gamma_of_s(self.shapes.s(place));
        let shape = Shape::new(gamma).map_err(|_| MaterialError::Gamma(gamma))?;
        Ok((self.tables.student_t(1.0, gamma)?, shape))
    }

    fn error(&self, lobe: &LobeAndShape, [_, a, b]: Place) -> f64 {
        let u = number(b, 0.5 * self.numbers.cells);
        self.error_at(lobe, || self.view(lobe.1.s(), a), u)
    }

    /// The error at a view, where the table has one, and a random number.
    pub fn error_at(&self, (lobe, shape): &LobeAndShape, v: impl Fn() -> Vec3, u: f32) -> f64 {
        match self.table.kind {
            Kind::Shadowing => g1_error(lobe, shape, v()),
            Kind::VisibleSlopeConditional => across_error(lobe, shape, u),
            _ => along_error(lobe, shape, v(), u),
        }
    }

    /// A view in the plane y = 0.
    fn view(&self, s: f64, place: f64) -> Vec3 {
        view(cotangent(&self.table.axes[1], s, place / self.views.cells))
    }

    /// s, and z = cot θ/σ and u where the table has such axes.
    fn named(&self, [shape, a, b]: Place) -> BTreeMap<Coordinate, f64> {
        let s = self.shapes.s(shape);
        let z = (self.views.cells > 0.0).then(|| exact_cotangent(self.view(s, a)));
        let half = 0.5 * self.numbers.cells;
        let at = [
            (Coordinate::S, Some(s_of_gamma(gamma_of_s(s)))),
            (Coordinate::Cotangent, z.filter(|z| z.is_finite())),
            (Coordinate::U, (half > 0.0).then(|| number(b, half).into())),
        ];
        at.into_iter().filter_map(|(coordinate, x)| Some((coordinate, x?))).collect()
    }
}

/// z at the coordinate t of an axis of views.
pub fn cotangent(axis: &Axis, s: f64, t: f64) -> f64 {
    match axis.mapping {
        Mapping::Rational(mapping) => mapping.quantity(t, mapping.kappa(s)),
        Mapping::HalfTangent(mapping) => mapping.quantity(t),
        _ => HalfTangent::default().quantity(t),
    }
}

/// The view in the plane y = 0 with the cotangent z of its polar angle.
pub fn view(z: f64) -> Vec3 {
    let UnitView { sin, cos } = UnitView::from_cotangent(z);
    Vec3::new(sin as f32, 0.0, cos as f32)
}

/// The cotangent of a view after rounding to f32.
pub(super) fn exact_cotangent(v: Vec3) -> f64 {
    f64::from(v.z) / f64::from(v.x)
}

/// Steps of the additive recurrence in the plane: powers of the reciprocal of the plastic number.
const PLASTIC: [f64; 2] = [0.7548776662466927, 0.5698402909980532];

/// The i-th point of the additive recurrence with these steps (Roberts 2018,
/// <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>), in [0, 1)ᴺ.
pub(super) fn low_discrepancy<const N: usize>(steps: [f64; N], i: usize) -> [f64; N] {
    steps.map(|a| (0.5 + a * (i + 1) as f64).fract())
}

/// Maps x ∈ [0, 1) so that two fifths of it go to the ends, logarithmically down to 1e-7.
fn towards_ends(x: f64) -> f64 {
    let tail = |y: f64| 0.1 * libm::exp(-13.8 * y);
    match x {
        x if x < 0.2 => tail(5.0 * x),
        x if x < 0.4 => 1.0 - tail(5.0 * (x - 0.2)),
        x => (x - 0.4) / 0.6,
    }
}

fn g1_error(lobe: &StudentT, shape: &Shape, v: Vec3) -> f64 {
    let exact = 1.0 / (1.0 + shape.lambda(shape.asinh_slope(exact_cotangent(v))));
    (f64::from(lobe.g1(v)) - exact).abs()
}

/// Difference between the CDF of the sampled slope and the random number it was sampled with.
///
/// Where the heavy part is peeled: the error of the remaining part, weighted by its share, plus the
/// error of that share.
fn along_error(lobe: &StudentT, shape: &Shape, v: Vec3, u: f32) -> f64 {
    let at = UnitView::from_cotangent(exact_cotangent(v));
    let whole = VisibleSlope::new(shape, at);
    if shape.gamma() >= GAMMA_WHOLE || lobe.tabulated_share(Vec3::X) >= 1.0 {
        let m = lobe.sample_visible_normal(v, [u, 0.5]);
        return (whole.cdf(slope_of(shape, m)) - f64::from(u)).abs();
    }
    let share = lobe.tabulated_share(v);
    let exact_share = 1.0 - at.sin * shape.first_moment(0.0) / whole.area();
    let of_share = (f64::from(share) - exact_share).abs();
    if !(share > 0.0) {
        // At grazing the share vanishes, and the error of its part no longer matters.
        return of_share;
    }
    let rest = VisibleSlope::peeled(shape, at);
    let m = lobe.sample_visible_normal(v, [u * share, 0.5]);
    let inside = (rest.cdf(slope_of(shape, m)) - f64::from(u * share) / f64::from(share)).abs();
    f64::from(share) * inside + of_share
}

/// The in-plane unit slope of a normal sampled with σ = 1 and a view in the plane y = 0.
fn slope_of(shape: &Shape, [x, _, z]: [f32; 3]) -> SignedSlope {
    signed(shape, f64::from(x) / f64::from(z))
}

fn signed(shape: &Shape, x: f64) -> SignedSlope {
    SignedSlope { w: shape.asinh_slope(x.abs()), sign: if x < 0.0 { -1.0 } else { 1.0 } }
}

/// The largest error of slopes across over all of [`BESIDE`].
fn across_error(lobe: &StudentT, shape: &Shape, u: f32) -> f64 {
    let error = |([x, z], u1): ([f32; 2], f32)| {
        let m = lobe.sample_visible_normal(Vec3::new(x, 0.0, z), [u1, u]);
        // t = y/√(z² + s x²) does not depend on u₁.
        let [x, y, z] = m.map(f64::from);
        let t = y / (z * z + shape.s() * x * x).sqrt();
        (across_cdf(shape, signed(shape, t)) - f64::from(u)).abs()
    };
    // `max` would drop a NaN.
    BESIDE
        .map(error)
        .into_iter()
        .fold(0.0, |worst, error| if error <= worst { worst } else { error })
}
