//! Cells of the sphere of lights, small where light is dense, and integrals over each.
//!
//! Coordinates are the elevation above the surface and the azimuth, from the components of a light
//! in double precision: both resolve single precision at the horizon and at the poles alike. The
//! horizon is always an edge. Other edges are medians of a pilot sample, so that cells hold about
//! the same share of the light, however narrow a lobe is and wherever it lies.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};

use microfacet_core::gauss_legendre;

/// Quadrature of a part of a cell, along both coordinates.
const RULE: [(f64, f64); 4] = gauss_legendre();
/// The most halvings of a cell: rounding errors of the density would call for more.
const DEEPEST: usize = 12;

/// Elevation and azimuth, each from a to b.
#[derive(Clone, Copy, Debug)]
struct Cell([[f64; 2]; 2]);

impl Cell {
    fn holds(&self, along: usize, at: f64) -> bool {
        self.0[along][0] < at && at < self.0[along][1]
    }

    fn cut(self, along: usize, at: f64) -> [Self; 2] {
        let (mut low, mut high) = (self, self);
        (low.0[along][1], high.0[along][0]) = (at, at);
        [low, high]
    }
}

#[derive(Clone, Copy, Debug)]
enum Node {
    /// Lights below `at` along a coordinate are in the next node, the others in `above`.
    Split {
        along: usize,
        at: f64,
        above: usize,
    },
    Leaf(usize),
}

#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// The azimuth that the others are counted from, opposite to the seam.
    ahead: [f64; 2],
    most: usize,
    edges: Vec<f64>,
    nodes: Vec<Node>,
    /// Each cell in parts that hold few of the pilot's lights, and the box that encloses these
    /// lights: quadrature first looks for peaks there.
    cells: Vec<Vec<[Cell; 2]>>,
}

impl Grid {
    /// Cells for a view from lights that were drawn for it, none with more than `most` of them if
    /// it can be divided. The elevations `edges` are edges of cells.
    pub(super) fn new(v: Vec3, pilot: &[Vec3], most: usize, mut edges: Vec<f64>) -> Self {
        edges.push(0.0);
        let r = f64::from(v.x).hypot(v.y.into());
        // Lobes lie opposite to the view; the seam is behind them.
        let ahead = if r > 0.0 { [-f64::from(v.x) / r, -f64::from(v.y) / r] } else { [1.0, 0.0] };
        let mut grid = Self { ahead, most, edges, nodes: Vec::new(), cells: Vec::new() };
        let mut places: Vec<_> = pilot.iter().map(|&l| grid.place(l)).collect();
        let whole = Cell([[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]);
        grid.grow(whole, &mut places);
        grid
    }

    pub(super) fn count(&self) -> usize {
        self.cells.len()
    }

    /// Elevation and azimuth of a light.
    fn place(&self, l: Vec3) -> [f64; 2] {
        let DVec3 { x, y, z } = l.as_dvec3();
        let [cos, sin] = self.ahead;
        [z.atan2(x.hypot(y)), (y * cos - x * sin).atan2(x * cos + y * sin)]
    }

    /// Divides a cell with the pilot's lights in it.
    fn grow(&mut self, cell: Cell, places: &mut [[f64; 2]]) {
        let node = self.nodes.len();
        self.nodes.push(Node::Leaf(self.cells.len()));
        let Some((along, at)) = self.edge(&cell, places) else {
            let mut parts = Vec::new();
            divide(cell, places, &mut parts);
            self.cells.push(parts);
            return;
        };
        let [(low, below), (high, above)] = split(&cell, along, at, places);
        self.grow(low, below);
        self.nodes[node] = Node::Split { along, at, above: self.nodes.len() };
        self.grow(high, above);
    }

    /// Where a cell is divided: at the horizon and other fixed edges, and then at the median along
    /// its longer side; `None` for one with few lights.
    fn edge(&self, cell: &Cell, places: &mut [[f64; 2]]) -> Option<(usize, f64)> {
        if let Some(&at) = self.edges.iter().find(|&&at| cell.holds(0, at)) {
            return Some((0, at));
        }
        if places.len() > self.most { median(cell, places) } else { None }
    }

    pub(super) fn cell(&self, l: Vec3) -> usize {
        let place = self.place(l);
        let mut node = 0;
        loop {
            node = match self.nodes[node] {
                Node::Leaf(cell) => return cell,
                Node::Split { along, at, above } => {
                    if place[along] < at {
                        node + 1
                    } else {
                        above
                    }
                }
            }
        }
    }

    /// The integral of a density over each cell, to a fraction of the standard deviation of the
    /// cell's count among `samples`.
    pub(super) fn shares(&self, samples: usize, density: impl Fn(Vec3) -> f32) -> Vec<f64> {
        /// Allowed error as a fraction of a standard deviation.
        const PART: f64 = 0.02;
        let typical = 1.0 / self.cells.len() as f64;
        let tolerance = PART * (typical / samples as f64).sqrt();
        let at = |[elevation, azimuth]: [f64; 2]| {
            let (sin, cos) = elevation.sin_cos();
            let [c, s] = self.ahead;
            let (y, x) = azimuth.sin_cos();
            let l = DVec3::new(cos * (x * c - y * s), cos * (x * s + y * c), sin);
            cos * f64::from(density(l.as_vec3()))
        };
        let part = |[cell, inner]: &[Cell; 2], tolerance: f64| {
            let [elevations, azimuths] = [0, 1].map(|i| panels(cell.0[i], inner.0[i]));
            let row = |e: &[f64]| {
                let e = [e[0], e[1]];
                azimuths.windows(2).map(move |a| Cell([e, [a[0], a[1]]]))
            };
            let panels = elevations.windows(2).flat_map(row);
            panels
                .map(|panel| refined(&panel, gauss(&panel, &at), tolerance, DEEPEST, &at))
                .sum::<f64>()
        };
        let cell = |parts: &Vec<[Cell; 2]>| {
            let tolerance = tolerance / parts.len() as f64;
            parts.iter().map(|sides| part(sides, tolerance)).sum()
        };
        self.cells.iter().map(cell).collect()
    }
}

/// The median of a cell's lights along the longer side of what encloses them.
fn median(cell: &Cell, places: &mut [[f64; 2]]) -> Option<(usize, f64)> {
    let Cell(sides) = enclosing(cell, places);
    let narrow = places.iter().map(|place| place[0].cos()).sum::<f64>() / places.len() as f64;
    let [tall, wide] = sides.map(|[a, b]| b - a);
    let along = usize::from(wide * narrow > tall);
    let (_, median, _) =
        places.select_nth_unstable_by(places.len() / 2, |a, b| a[along].total_cmp(&b[along]));
    let at = median[along];
    cell.holds(along, at).then_some((along, at))
}

/// Divides a cell further, down to few lights.
fn divide(cell: Cell, places: &mut [[f64; 2]], parts: &mut Vec<[Cell; 2]>) {
    const FEW: usize = 4;
    let edge = if places.len() > FEW { median(&cell, places) } else { None };
    let Some((along, at)) = edge else {
        parts.push([cell, enclosing(&cell, places)]);
        return;
    };
    for (half, places) in split(&cell, along, at, places) {
        divide(half, places, parts);
    }
}

/// Both parts of a cell, with the lights in each.
fn split<'a>(
    cell: &Cell,
    along: usize,
    at: f64,
    places: &'a mut [[f64; 2]],
) -> [(Cell, &'a mut [[f64; 2]]); 2] {
    places.sort_unstable_by(|a, b| a[along].total_cmp(&b[along]));
    let cut = places.partition_point(|place| place[along] < at);
    let (below, above) = places.split_at_mut(cut);
    let [low, high] = cell.cut(along, at);
    [(low, below), (high, above)]
}

/// The smallest box that holds these lights; the cell if there are none.
fn enclosing(cell: &Cell, places: &[[f64; 2]]) -> Cell {
    let side = |along: usize| {
        let all = || places.iter().map(|place| place[along]);
        [all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max)]
    };
    if places.is_empty() { *cell } else { Cell([side(0), side(1)]) }
}

/// The ends of the panels along one side of a cell: the range of its lights, and on both sides of
/// that ever wider ones, since density may fall off within a small part of the cell.
fn panels([low, high]: [f64; 2], [from, to]: [f64; 2]) -> Vec<f64> {
    const WIDER: f64 = 4.0;
    let width = (to - from).max(1e-6 * (high - low));
    let mut ends = vec![from, to];
    let mut step = width;
    while ends[0] > low || ends[ends.len() - 1] < high {
        let (first, last) = (ends[0], ends[ends.len() - 1]);
        if first > low {
            ends.insert(0, if first - step > low { first - step } else { low });
        }
        if last < high {
            ends.push(if last + step < high { last + step } else { high });
        }
        step *= WIDER;
    }
    ends
}

fn gauss(cell: &Cell, at: &impl Fn([f64; 2]) -> f64) -> f64 {
    let [[a, b], [c, d]] = cell.0;
    let row = |&(x, weight): &(f64, f64)| {
        let sum: f64 =
            RULE.iter().map(|(y, weight)| weight * at([a + x * (b - a), c + y * (d - c)])).sum();
        weight * sum
    };
    RULE.iter().map(row).sum::<f64>() * (b - a) * (d - c)
}

/// The integral over a cell, in four parts where their sum differs from the whole, or where a peak
/// next to the cell reaches into it between the nodes of the rule.
fn refined(
    cell: &Cell,
    whole: f64,
    tolerance: f64,
    depth: usize,
    at: &impl Fn([f64; 2]) -> f64,
) -> f64 {
    let [[a, b], [c, d]] = cell.0;
    let (e, f) = (0.5 * (a + b), 0.5 * (c + d));
    let parts = [[[a, e], [c, f]], [[a, e], [f, d]], [[e, b], [c, f]], [[e, b], [f, d]]].map(Cell);
    let sums = parts.map(|part| gauss(&part, at));
    let sum: f64 = sums.iter().sum();
    let agree = (sum - whole).abs() <= tolerance;
    if depth == 0 || agree && border(cell, at) <= BESIDE * sum + tolerance {
        return sum;
    }
    let finer = |(part, &sum): (&Cell, &f64)| refined(part, sum, 0.5 * tolerance, depth - 1, at);
    parts.iter().zip(&sums).map(finer).sum()
}

/// How far the largest density on a border may exceed the mean within.
const BESIDE: f64 = 30.0;

/// The area of a cell times the largest density at its corners and in the middle of its sides.
fn border(cell: &Cell, at: &impl Fn([f64; 2]) -> f64) -> f64 {
    let [[a, b], [c, d]] = cell.0;
    let (e, f) = (0.5 * (a + b), 0.5 * (c + d));
    let places = [[a, c], [a, f], [a, d], [e, c], [e, d], [b, c], [b, f], [b, d]];
    places.into_iter().map(at).fold(0.0, f64::max) * (b - a) * (d - c)
}
