//! Points at which albedo tables are measured: corners, the middle of every cell along every edge,
//! faces, the interior, and the crease of tilted lobes.
//!
//! Edges, where the windows of a polynomial are one-sided and errors largest, and the crease, where
//! E has a kink, are listed because random points miss them. All points are fixed, so that
//! certificates are part of a table's reproducible bytes.

use rayon::prelude::*;

use microfacet_model::Ellipsoid;
use microfacet_sampler::Masking;
use microfacet_tables::axis::LogRoughness;
use microfacet_tables::{Axis, Interval, Mapping};

use super::certificate::low_discrepancy;
use crate::bake::albedo::{AlbedoSpec, Site, area_ratio, ellipsoid, product};

/// Smallest σ and cos θ of the promised domain, for which certificates state the largest error.
const PROMISED: (f64, f64) = (0.01, 0.02);
/// Smallest σ that is not a mirror.
const SMOOTHEST: f64 = LogRoughness::BAKED.first;
/// Interior points: one for this number of nodes, within limits. With half as many points the
/// climbs missed a maximum of the default set, an F82 error of 8.4e-5, and found 7.3e-5.
const NODES_A_POINT: usize = 4;
const FEWEST: usize = 240;
const MOST: usize = 6144;

/// Views at corners and along edges: the ends of the promised range, and grazing views outside,
/// down to the horizon itself.
const VIEWS: [f64; 5] = [1.0, PROMISED.1, 1e-4, 3e-7, 0.0];

/// Number of last cells that hold the cusp at the normal.
const LAST_CELLS: f64 = 2.0;

/// Lines across a crease in each cell of either axis, one of them in the middle of the cell.
const LINES: usize = 4;

/// A point to measure at.
#[derive(Clone, Debug)]
pub struct Point {
    /// Coordinates along the axes.
    at: Vec<f64>,
    /// The same point in quantities.
    pub site: Site,
    /// Whether it lies in the promised domain.
    pub promised: bool,
    /// Whether it was found on a crease.
    pub on_crease: bool,
}

/// The promised range of an axis, in its coordinate.
pub struct Range {
    ends: Vec<f64>,
    /// The first coordinate and the last; a full circle of azimuths is [0, 1], although its ends
    /// coincide.
    whole: [f64; 2],
    /// The middles of the cells in the range.
    cells: Vec<f64>,
}

impl Range {
    fn new(axis: &Axis, spec: &AlbedoSpec) -> Self {
        let of = |ends: [f64; 2]| {
            let mut ends = ends.map(|x| axis.coordinate(x).unwrap_or(f64::NAN));
            ends.sort_by(f64::total_cmp);
            ends
        };
        let [low, high] = match axis.mapping {
            Mapping::LogShape(_) => of(spec.lobe.gamma.into()),
            Mapping::LogRoughness(_) => {
                let Interval { min, max } = spec.lobe.roughness.x();
                of([PROMISED.0.min(max).max(min).max(SMOOTHEST), max.max(SMOOTHEST)])
            }
            Mapping::ReflectanceRoot | Mapping::CrossingRoot(_) => {
                of(spec.reflectance.indices().unwrap_or(Interval::UNIT).into())
            }
            Mapping::Azimuth(_) if axis.len() == 1 => [0.0; 2],
            // The ends of a full circle coincide, so a quarter turn is the other end.
            Mapping::Azimuth(azimuth) => [0.0, if azimuth.fold { 1.0 } else { 0.25 }],
            _ => [0.0, 1.0],
        };
        let whole = if is_circle(axis) { [0.0, 1.0] } else { [low, high] };
        let mut nodes = axis.nodes.clone();
        nodes.push(whole[1]);
        let middle = |pair: &[f64]| 0.5 * (pair[0].max(whole[0]) + pair[1].min(whole[1]));
        let inside = |pair: &&[f64]| pair[1] > whole[0] && pair[0] < whole[1];
        let cells = nodes.windows(2).filter(inside).map(middle).collect();
        let ends = if low == high { vec![low] } else { vec![low, high] };
        Self { ends, whole, cells }
    }

    /// The ends, or along an edge the middles of the cells instead.
    fn stops(&self, along: bool) -> &[f64] {
        if along { &self.cells } else { &self.ends }
    }

    /// The coordinate at the share x ∈ [0, 1] of the range; around the full circle for an azimuth.
    pub fn at(&self, x: f64) -> f64 {
        let [first, last] = self.whole;
        first + x * (last - first)
    }

    /// The middle of the cell at the share x ∈ [0, 1] of all cells; without cells, the only
    /// coordinate.
    fn cell(&self, x: f64) -> f64 {
        let i = (x * self.cells.len() as f64) as usize;
        self.cells.get(i).copied().unwrap_or(self.ends[0])
    }
}

/// Whether an axis is closed: the full circle of azimuths, whose nodes are evenly spaced.
fn is_circle(axis: &Axis) -> bool {
    matches!(axis.mapping, Mapping::Azimuth(azimuth) if !azimuth.fold) && axis.len() > 1
}

/// Whether the lobe differs by azimuth.
pub(super) fn has_azimuths(spec: &AlbedoSpec) -> bool {
    spec.axes.iter().any(|axis| matches!(axis.mapping, Mapping::Azimuth(_)) && axis.len() > 1)
}

/// Number of the points at corners and along edges, without making a list: plans of very many lobes
/// need only the number.
pub fn edge_count(spec: &AlbedoSpec) -> usize {
    let ranges = ranges(spec);
    let (view, materials) = ranges.split_last().expect("the view is an axis");
    let ends = |along: Option<usize>| -> usize {
        materials.iter().enumerate().map(|(i, range)| range.stops(along == Some(i)).len()).product()
    };
    let edges: usize = (0..materials.len()).map(|along| ends(Some(along))).sum();
    ends(None) * (VIEWS.len() + view.cells.len()) + edges * VIEWS.len()
}

/// About the number of the points on a crease, which crosses half of all azimuths once, and most
/// views twice.
pub fn crease_count(spec: &AlbedoSpec) -> usize {
    let count = |k: usize| spec.axes.get(k).map_or(0, Axis::len);
    if has_crease(spec) { LINES * (count(0) / 2 + 2 * count(1)) } else { 0 }
}

/// Number of the interior points.
pub fn interior_count(spec: &AlbedoSpec) -> usize {
    (spec.nodes() / NODES_A_POINT).clamp(FEWEST, MOST)
}

/// The promised range of each axis.
pub fn ranges(spec: &AlbedoSpec) -> Vec<Range> {
    spec.axes.iter().map(|axis| Range::new(axis, spec)).collect()
}

/// A view by its coordinate or its cosine.
#[derive(Clone, Copy)]
enum View {
    At(f64),
    Cos(f64),
}

fn point(spec: &AlbedoSpec, material: &[f64], view: View) -> Point {
    let t = if let View::At(t) = view { t } else { 1.0 };
    let mut at = [material, &[t]].concat();
    let mut site = Site::new(&spec.axes, &at);
    if let View::Cos(cos) = view {
        site.cos = cos;
        at[material.len()] = coordinate(&spec.axes[material.len()], &site);
    }
    // If all materials are smoother than the promised domain, the roughest is promised: otherwise
    // no point would be.
    let roughest = spec.lobe.is_family().then(|| spec.lobe.roughness.x().max);
    let smoothest = roughest.map_or(0.0, |roughest| PROMISED.0.min(roughest) * (1.0 - 1e-9));
    let promised = site.cos as f32 >= PROMISED.1 as f32 && site.sigma >= smoothest;
    Point { at, site, promised, on_crease: false }
}

/// The coordinate of a view; for a view below the first node, that of the first node.
fn coordinate(axis: &Axis, Site { gamma, sigma, eta, cos, .. }: &Site) -> f64 {
    match axis.mapping {
        Mapping::ViewBlend(view) => {
            let view = view.prepare(*sigma, *gamma);
            view.coordinate(cos.max(view.floor()))
        }
        Mapping::CriticalBlend(view) => {
            let view = view.prepare(*sigma, *gamma, 1.0 / eta);
            view.coordinate(cos.max(view.floor()))
        }
        _ => unreachable!("the last axis is the view"),
    }
}

/// The point of a view by its cosine, at coordinates along the axes of materials.
pub fn seen(spec: &AlbedoSpec, material: &[f64], cos: f64) -> Point {
    point(spec, material, View::Cos(cos))
}

/// The promised views of the material of a site, from the lowest to the normal: cos θ at a share
/// of their range, spaced as on the axis.
pub fn promised_views(axis: &Axis, site: Site) -> impl Fn(f64) -> f64 + use<> {
    let low = coordinate(axis, &Site { cos: PROMISED.1, ..site });
    let axis = axis.clone();
    // The coordinate and its inverse round.
    move |share| site.cos_at(&axis, low + share * (1.0 - low)).clamp(PROMISED.1, 1.0)
}

/// Whether two points are a cell or more apart along some axis.
pub fn are_apart(spec: &AlbedoSpec, a: &Point, b: &Point) -> bool {
    let apart = |(k, axis): (usize, &Axis)| (a.at[k] - b.at[k]).abs() >= cell(axis);
    spec.axes.iter().enumerate().any(|(k, axis)| axis.nodes.len() > 1 && apart((k, axis)))
}

/// The width of a cell; nodes are evenly spaced.
fn cell(axis: &Axis) -> f64 {
    let [first, last] = axis.ends();
    (last - first) / (axis.nodes.len() - 1).max(1) as f64
}

/// The neighbours of a point, `cells` away along each axis, that are promised if the point is; of a
/// point on a crease, also neighbours on the crease.
pub fn beside(spec: &AlbedoSpec, point: &Point, cells: f64) -> Vec<Point> {
    let crease = Crease::of(spec).filter(|_| point.on_crease);
    let mut points = Vec::new();
    for (k, (axis, range)) in spec.axes.iter().zip(ranges(spec)).enumerate() {
        let (cell, [low, high]) = (cell(axis), range.whole);
        for step in [-cells, cells] {
            let mut at = point.at.clone();
            at[k] += step * cell;
            at[k] = if is_circle(axis) { at[k].rem_euclid(1.0) } else { at[k].clamp(low, high) };
            points.extend(crease.iter().filter_map(|crease| crease.nearest(k, &at)));
            let (material, view) = at.split_at(at.len() - 1);
            points.push(self::point(spec, material, View::At(view[0])));
        }
    }
    points.retain(|other| other.promised == point.promised && other.at != point.at);
    points
}

/// The middles of all cells of the view at the material of a point, that are promised if the point
/// is.
pub fn other_views(spec: &AlbedoSpec, from: &Point) -> Vec<Point> {
    let (_, material) = from.at.split_last().expect("the view is an axis");
    let view = ranges(spec).pop().expect("the view is an axis");
    let mut points: Vec<Point> =
        view.cells.iter().map(|&t| point(spec, material, View::At(t))).collect();
    points.retain(|other| other.promised == from.promised);
    points
}

/// The number of cells of the view.
pub fn cells_of_view(spec: &AlbedoSpec) -> usize {
    ranges(spec).last().map_or(0, |view| view.cells.len())
}

/// Points of surfaces smoother than the promised ones, where tails are heaviest: in the middle of
/// the cell of the smallest γ, of every cell of σ and of every third cell of the view. None for a
/// table without such surfaces.
pub fn smooth(spec: &AlbedoSpec) -> Vec<Point> {
    if !spec.lobe.is_family() {
        return Vec::new();
    }
    let ranges = ranges(spec);
    let (view, materials) = ranges.split_last().expect("the view is an axis");
    let mut material: Vec<f64> = materials.iter().map(|range| range.ends[0]).collect();
    let gamma = |t: f64| {
        let at = [&[t], &material[1..], &[1.0]].concat();
        Site::new(&spec.axes, &at).gamma
    };
    let shapes =
        if materials[0].cells.is_empty() { &materials[0].ends } else { &materials[0].cells };
    let heaviest = shapes.iter().copied().min_by(|a, b| gamma(*a).total_cmp(&gamma(*b)));
    material[0] = heaviest.unwrap_or(material[0]);
    let mut points = Vec::new();
    for sigma in smooth_cells(spec) {
        material[1] = sigma;
        let seen = view.cells.iter().skip(1).step_by(3);
        points.extend(seen.map(|&view| point(spec, &material, View::At(view))));
    }
    points
}

/// The middles of cells of σ below the promised domain.
fn smooth_cells(spec: &AlbedoSpec) -> Vec<f64> {
    let Interval { min, max } = spec.lobe.roughness.x();
    let covered = min..PROMISED.0.min(max);
    let axis = &spec.axes[1];
    let middles = axis.nodes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    middles.filter(|&t| axis.quantity(t).is_some_and(|sigma| covered.contains(&sigma))).collect()
}

/// The curve of views at which G1 of a tilted lobe reaches its clamp.
///
/// With height-correlated masking E has a kink there, and the errors of polynomials across it have
/// a narrow ridge, which crosses cells anywhere.
struct Crease<'a> {
    spec: &'a AlbedoSpec,
    ellipsoid: Ellipsoid,
}

impl<'a> Crease<'a> {
    /// `None` where E has no such kink.
    fn of(spec: &'a AlbedoSpec) -> Option<Self> {
        let kink = spec.maskings.contains(&Masking::HeightCorrelated);
        ellipsoid(&spec.lobe).ok().filter(|_| kink).map(|ellipsoid| Self { spec, ellipsoid })
    }

    /// The promised points of the crease with the coordinate t along an axis: 0, azimuth, or 1,
    /// view.
    fn crossings(&self, axis: usize, t: f64) -> Vec<Point> {
        let at = |x: f64| if axis == 0 { [t, x] } else { [x, t] };
        let clamped =
            |x: f64| area_ratio(&self.ellipsoid, &Site::new(&self.spec.axes, &at(x))) < 1.0;
        let other = &self.spec.axes[1 - axis];
        // At normal incidence itself the curve meets every azimuth.
        let last = if is_circle(other) { 1.0 } else { 1.0 - 1e-3 * cell(other) };
        let stops = other.nodes.iter().copied().filter(|node| *node < last).chain([last]);
        let stops: Vec<(f64, bool)> = stops.map(|x| (x, clamped(x))).collect();
        let changes = stops.windows(2).filter(|pair| pair[0].1 != pair[1].1);
        let root = |pair: &[(f64, bool)]| {
            let [(mut low, first), (mut high, _)] = [pair[0], pair[1]];
            for _ in 0..48 {
                let middle = 0.5 * (low + high);
                *(if clamped(middle) == first { &mut low } else { &mut high }) = middle;
            }
            let [azimuth, view] = at(low);
            Point { on_crease: true, ..point(self.spec, &[azimuth], View::At(view)) }
        };
        changes.map(root).filter(|place| place.promised).collect()
    }

    /// Of the points of the crease with the coordinate of `at` along an axis, the nearest along the
    /// other.
    fn nearest(&self, axis: usize, at: &[f64]) -> Option<Point> {
        let other = 1 - axis;
        let circle = is_circle(&self.spec.axes[other]);
        let away = |place: &Point| {
            let away = (place.at[other] - at[other]).abs();
            if circle { away.min(1.0 - away) } else { away }
        };
        self.crossings(axis, at[axis]).into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }
}

pub(super) fn has_crease(spec: &AlbedoSpec) -> bool {
    Crease::of(spec).is_some()
}

/// The points at which the crease of a tilted lobe crosses lines of equal azimuth and of equal
/// view, several in each cell; none for other lobes.
pub fn crease(spec: &AlbedoSpec) -> Vec<Point> {
    let Some(crease) = Crease::of(spec) else { return Vec::new() };
    let lines = |(k, axis): (usize, &Axis)| {
        let step = cell(axis) / LINES as f64;
        (0..(1.0 / step).round() as usize).map(move |i| (k, i as f64 * step))
    };
    let lines: Vec<(usize, f64)> = spec.axes.iter().enumerate().flat_map(lines).collect();
    lines.into_par_iter().flat_map_iter(|(k, t)| crease.crossings(k, t)).collect()
}

/// All corners of the promised domain, and along each of its edges the middle of every cell.
pub fn edges(spec: &AlbedoSpec) -> Vec<Point> {
    let ranges = ranges(spec);
    let (view, materials) = ranges.split_last().expect("the view is an axis");
    let views = VIEWS.map(View::Cos).into_iter();
    let of_corner = views.clone().chain(view.cells.iter().map(|&t| View::At(t)));
    let mut places = Vec::new();
    for at in ends(materials, None) {
        places.extend(of_corner.clone().map(|view| point(spec, &at, view)));
    }
    for at in (0..materials.len()).flat_map(|along| ends(materials, Some(along))) {
        places.extend(views.clone().map(|view| point(spec, &at, view)));
    }
    places
}

/// The middle of every cell over azimuths and views; none for a lobe that is the same at every
/// azimuth.
///
/// Errors over azimuths have many hills of a cell's width. With the middles of half the cells, as
/// on a chessboard, an F82 error of 8.5e-4 at σ = (0.05, 0.4), γ = 1.6 was certified as 8.13e-4.
pub fn middles(spec: &AlbedoSpec) -> Vec<Point> {
    let ranges = ranges(spec);
    let Some([before @ .., azimuth, view]) = around(spec, &ranges) else { return Vec::new() };
    let before: Vec<f64> = before.iter().map(|range| range.ends[0]).collect();
    let views = |&phi: &f64| {
        let material = [&before[..], &[phi]].concat();
        view.cells.iter().map(move |&t| point(spec, &material, View::At(t)))
    };
    azimuth.cells.iter().flat_map(views).collect()
}

/// The ranges of a lobe that has an axis of azimuths, which is the last but one.
fn around<'a>(spec: &AlbedoSpec, ranges: &'a [Range]) -> Option<&'a [Range]> {
    let is_azimuth = |axis: &Axis| matches!(axis.mapping, Mapping::Azimuth(_));
    spec.axes.iter().any(is_azimuth).then_some(ranges)
}

/// Number of the points of [`middles`].
pub fn middle_count(spec: &AlbedoSpec) -> usize {
    let ranges = ranges(spec);
    match around(spec, &ranges) {
        Some([.., azimuth, view]) => azimuth.cells.len() * view.cells.len(),
        _ => 0,
    }
}

/// The materials at which averages of the family are measured: all combinations of ends and middles
/// of cells, of surfaces smoother than the promised ones, too.
pub fn of_averages(spec: &AlbedoSpec) -> Vec<Point> {
    let [shapes, roughness, ..] = &ranges(spec)[..] else { return Vec::new() };
    let shapes = [&shapes.ends[..], &shapes.cells].concat();
    let roughness = [&smooth_cells(spec), &roughness.ends[..], &roughness.cells].concat();
    let seen = |material: Vec<f64>| seen(spec, &material, 1.0);
    product([&shapes[..], &roughness[..]]).into_iter().map(seen).collect()
}

/// All combinations of the axes' ends; for the axis `along`, the middles of its cells instead.
fn ends<'a>(materials: &'a [Range], along: Option<usize>) -> impl Iterator<Item = Vec<f64>> {
    let here = |(i, range): (usize, &'a Range)| range.stops(along == Some(i));
    product(materials.iter().enumerate().map(here)).into_iter()
}

/// Interior points: a third anywhere, a third on a face with the view in the middle of a cell, and
/// a third with some axis in the middle of a cell; an eighth of all lies outside the promised
/// domain. The same points serve the refined tables of a lobe, in which some of them are nodes.
pub fn interior(spec: &AlbedoSpec) -> Vec<Point> {
    let ranges = ranges(spec);
    let (view, materials) = ranges.split_last().expect("the view is an axis");
    let place = |i: usize| {
        let x = low_discrepancy(steps(), i);
        let of = |k: usize, range: &Range| {
            let x = x[k];
            match (i % 3, i / 3 % (2 * ranges.len())) {
                (1, j) if j / 2 == k => {
                    if j % 2 == 0 {
                        range.ends[0]
                    } else {
                        range.ends[range.ends.len() - 1]
                    }
                }
                (2, j) if j / 2 == k => range.cell(x),
                // Only a few shapes are used, since to prepare a shape takes longer than to
                // integrate at one view.
                _ if matches!(spec.axes[k].mapping, Mapping::LogShape(_)) => some_shape(range, x),
                _ => range.at(x),
            }
        };
        let material: Vec<f64> =
            materials.iter().enumerate().map(|(k, range)| of(k, range)).collect();
        let b = x[materials.len()];
        let at = match (i % 8, i % 3) {
            (0, _) => return outside(spec, material, x, i % 16 == 8),
            (_, 1) if i / 3 % (2 * ranges.len()) / 2 == materials.len() => View::Cos(PROMISED.1),
            (_, 1) => View::At(view.cell(b)),
            // Near normal incidence, where masking begins with a cusp.
            (1 | 5, _) => {
                View::At(1.0 - LAST_CELLS * b / (spec.axes[materials.len()].len() - 1) as f64)
            }
            (2 | 3, _) => View::Cos(libm::pow(PROMISED.1, b)),
            _ => View::Cos(PROMISED.1 + (1.0 - PROMISED.1) * b),
        };
        point(spec, &material, at)
    };
    (0..interior_count(spec)).map(place).collect()
}

/// The coordinate of a shape: an end of the range, the middle of a cell, or one between two
/// middles.
fn some_shape(range: &Range, x: f64) -> f64 {
    let n = range.cells.len();
    let i = (x * (2 * n + 1) as f64) as usize;
    match range.cells.get(i / 2) {
        // Between the middle of this cell and that of the one before.
        Some(cell) if i.is_multiple_of(2) && i > 0 => 0.62 * cell + 0.38 * range.cells[i / 2 - 1],
        Some(cell) if i % 2 == 1 => *cell,
        Some(_) => range.ends[0],
        None => range.ends[range.ends.len() - 1],
    }
}

/// A point at a view grazing enough for the surface to mask and, if `smooth` and the range has any,
/// of a surface smoother than the promised ones.
fn outside(spec: &AlbedoSpec, mut material: Vec<f64>, x: [f64; 4], smooth: bool) -> Point {
    let Interval { min, max } = spec.lobe.roughness.x();
    if spec.lobe.is_family() && min <= SMOOTHEST && smooth {
        let roughest = PROMISED.0.min(max);
        let sigma = roughest * libm::pow(SMOOTHEST / roughest, x[1]);
        material[1] = spec.axes[1].coordinate(sigma).unwrap_or(material[1]);
    }
    let sigma = Site::new(&spec.axes, &[&material[..], &[1.0]].concat()).sigma;
    let grazing = 1e-5 * sigma.min(0.1);
    let cos = grazing * libm::pow(PROMISED.1 / grazing, x[material.len()]);
    point(spec, &material, View::Cos(cos))
}

/// Steps of the low-discrepancy sequence in four dimensions: powers of the reciprocal of the root
/// of x⁵ = x + 1.
fn steps() -> [f64; 4] {
    const ROOT: f64 = 1.167_303_978_261_418_7;
    [1, 2, 3, 4].map(|k| libm::pow(ROOT, -f64::from(k)))
}
