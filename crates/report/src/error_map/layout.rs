//! Which axes a map shows, and at how many points it is measured.

use microfacet_baker::plan;
use microfacet_tables::{Axis, Interpolation, Kind, Table};

use super::albedo::spec;
use super::{AXES, Place, Quantity, Span};

/// The axes that a map shows, by their index in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    /// Along x.
    pub x: usize,
    /// Along y, if there is a second.
    pub y: Option<usize>,
}

/// Most pixels along x and y, and along x alone.
const PIXELS: [usize; 2] = [48, 32];
const ALONE: usize = 96;
/// Fewest pixels along x, and along y.
const FEWEST: usize = 6;
/// Points in each cell of an axis, if [`LIMIT`] allows them.
const IN_CELL: f64 = 2.5;
/// Most points in a pixel along an axis.
const IN_PIXEL: usize = 4;
/// Points along an axis over which the largest error is taken: of other tables, and of albedos.
const OVER: [usize; 2] = [41, 6];
/// Seconds of one thread that a map may take.
const LIMIT: f64 = 1.5;

/// Quantities for y and x of the first map, by priority: a table gets the first pair that it has.
const FIRST: [(Quantity, Quantity); 9] = [
    (Quantity::Sigma, Quantity::Cosine),
    (Quantity::Azimuth, Quantity::Cosine),
    (Quantity::Eta, Quantity::Cosine),
    (Quantity::Gamma, Quantity::Cosine),
    (Quantity::Gamma, Quantity::Cotangent),
    (Quantity::Gamma, Quantity::Number),
    (Quantity::Number, Quantity::Cotangent),
    (Quantity::Number, Quantity::Slope),
    (Quantity::Gamma, Quantity::Sigma),
];
/// Pairs of quantities for y and x of a second map.
const SECOND: [(Quantity, Quantity); 3] = [
    (Quantity::Gamma, Quantity::Sigma),
    (Quantity::Eta, Quantity::Sigma),
    (Quantity::Number, Quantity::Cotangent),
];

/// The axes of a table's maps, at most two; none if errors change along no axis.
pub fn sides(table: &Table) -> Vec<Sides> {
    let of = |quantity: Quantity| {
        table.axes.iter().position(|axis| moves(axis) && Quantity::of(axis) == quantity)
    };
    let pair = |(y, x): &(Quantity, Quantity)| Some(Sides { x: of(*x)?, y: Some(of(*y)?) });
    let first = FIRST.iter().find_map(pair);
    let second = SECOND.iter().find_map(pair).filter(|second| first.as_ref() != Some(second));
    let alone = || Some(Sides { x: table.axes.iter().rposition(moves)?, y: None });
    first.or_else(alone).into_iter().chain(second).collect()
}

/// The estimated seconds of one thread that a map takes.
pub fn seconds(table: &Table, sides: Sides) -> f64 {
    Layout::new(table, sides).counts.iter().product::<usize>() as f64 * point_seconds(table)
}

/// Seconds of one thread to measure the error of a table at one point.
fn point_seconds(table: &Table) -> f64 {
    match table.kind {
        Kind::Albedo => spec(table).map_or(0.0, |spec| plan::place_seconds(&spec)),
        _ => plan::point_seconds(table),
    }
}

/// Whether errors change along an axis; they do not along a list of single shapes.
fn moves(axis: &Axis) -> bool {
    axis.nodes.len() > 1 && axis.interpolation != Interpolation::Nodes
}

/// Numbers of pixels, and of points along each axis.
pub(super) struct Layout {
    sides: [Option<usize>; 2],
    /// Pixels along x and y; `each` is the number of points in a pixel along x and y.
    pub(super) pixels: [usize; 2],
    each: [usize; 2],
    counts: [usize; AXES],
    /// Axes that are not shown: they stay at one value, or the largest error over them is taken.
    pub(super) fixed: Vec<usize>,
    pub(super) over: Vec<usize>,
}

impl Layout {
    pub(super) fn new(table: &Table, Sides { x, y }: Sides) -> Self {
        let sides = [Some(x), y];
        let hidden = (0..table.axes.len()).filter(|&i| !sides.contains(&Some(i)));
        let is_over =
            |&i: &usize| moves(&table.axes[i]) && !Quantity::of(&table.axes[i]).is_of_material();
        let (over, fixed): (Vec<usize>, Vec<usize>) = hidden.partition(is_over);
        let mut counts = [1; AXES];
        over.iter().for_each(|&i| counts[i] = OVER[usize::from(table.kind == Kind::Albedo)]);
        let others: usize = counts.iter().product();
        let most = (LIMIT / point_seconds(table) / others as f64) as usize;
        let wanted = |axis: usize| {
            let axis = &table.axes[axis];
            let twice = if Quantity::of(axis) == Quantity::Number { 2.0 } else { 1.0 };
            IN_CELL * (axis.len() - 1) as f64 * twice
        };
        let mut pixels = if y.is_some() { PIXELS } else { [ALONE, 1] };
        let mut each: [usize; 2] = std::array::from_fn(|i| {
            let wanted = sides[i].map_or(0.0, wanted);
            (wanted / pixels[i] as f64).ceil().clamp(1.0, IN_PIXEL as f64) as usize
        });
        let points =
            |pixels: [usize; 2], each: [usize; 2]| pixels.iter().chain(&each).product::<usize>();
        while points(pixels, each) > most && each != [1; 2] {
            let wider = usize::from(each[1] > each[0]);
            each[wider] -= 1;
        }
        while points(pixels, each) > most && pixels[0] > FEWEST {
            pixels = pixels.map(|n| if n > FEWEST { (n * 7 / 8).max(FEWEST) } else { n });
        }
        for (i, axis) in sides.into_iter().enumerate() {
            if let Some(axis) = axis {
                counts[axis] = pixels[i] * each[i];
            }
        }
        Self { sides, pixels, each, counts, fixed, over }
    }

    /// The number of successive points with one value of the first axis.
    pub(super) fn run(&self) -> usize {
        self.counts[1..].iter().product()
    }

    /// All points with their pixels' numbers, row by row from low y; the last axis is fastest.
    pub(super) fn places(&self, table: &Table, spans: &[Span]) -> Vec<(Place, usize)> {
        let mut all: Vec<(Place, usize)> = vec![([0.0; AXES], 0)];
        for axis in 0..AXES {
            let worst = spans.get(axis).and_then(|span| span.worst(table));
            let along = self.along(axis, worst);
            all = all.into_iter().flat_map(|at| self.extended(at, axis, &along)).collect();
        }
        all
    }

    /// Copies of a point, one at each share of one more axis.
    fn extended<'a>(
        &self,
        (place, pixel): (Place, usize),
        axis: usize,
        along: &'a [f64],
    ) -> impl Iterator<Item = (Place, usize)> + use<'a> {
        let side = self.sides.iter().position(|side| *side == Some(axis));
        let (each, stride) = side.map_or((1, 0), |i| (self.each[i], [1, self.pixels[0]][i]));
        along.iter().enumerate().map(move |(i, &share)| {
            let mut place = place;
            place[axis] = share;
            (place, pixel + i / each * stride)
        })
    }

    /// Equally spaced shares of an axis, both ends included; the one nearest to the certificate's
    /// largest error is moved to it. An axis with one point has it at that error, or in the middle.
    fn along(&self, axis: usize, worst: Option<f64>) -> Vec<f64> {
        let count = self.counts[axis];
        if count == 1 {
            return vec![worst.unwrap_or(0.5)];
        }
        let mut all: Vec<f64> = (0..count).map(|i| i as f64 / (count - 1) as f64).collect();
        if let Some(worst) = worst {
            // The share that is moved stays in the pixel of the largest error.
            let side = self.sides.iter().position(|side| *side == Some(axis));
            let each = side.map_or(1, |i| self.each[i]);
            let first = (worst * (count / each) as f64) as usize * each;
            let nearest = (worst * (count - 1) as f64).round() as usize;
            all[nearest.clamp(first, first + each - 1).min(count - 1)] = worst;
        }
        all
    }
}
