//! Errors of the tables of a distribution outside the family, read by the run-time sampler, against
//! quadrature.
//!
//! Points are spaced along the tables' own axes, as in [`certificate`](super::certificate): even
//! steps of θ would nearly all miss a narrow distribution.

use glam::Vec3;
use microfacet_model::classic::{Marginal, MarginalView};
use microfacet_sampler::{Lobe, MicrofacetDistribution, Tables};
use microfacet_tables::axis::HalfTangent;
use microfacet_tables::{
    Axis, Kind, LoadError, Mapping, MaterialEntry, Provenance, Quantity, Table,
};
use rayon::prelude::*;

use super::certificate::{
    Along, Found, ROUNDING, Seen, climbed, cotangent, exact_cotangent, number, places, view,
};
use crate::bake::radial_axes;
use crate::progress::Stage;
use crate::table_spec::Quality;

/// Normals drawn for either certificate of slopes; a quarter is left for climbs.
pub(crate) const POINTS: usize = 8000;
/// Climbs of each certificate; three times as many for slopes across.
const CLIMBS: usize = 32;
/// Points in each cell of the tables with one axis.
const PER_CELL: usize = 12;

/// Slopes across are tested at in-plane slopes that random numbers at least this far from 0 and 1
/// draw: in single precision, rarer in-plane slopes are hardly ever drawn.
const RARE: f64 = ROUNDING;

/// Cotangents, divided by σ, of views that see the steepest slopes. Random numbers just below 1 are
/// so coarse that a single view would draw few of these.
const SLANTS: [f64; 5] = [0.0, 0.03, 0.1, 0.3, 1.0];
/// The number of [`SLANTS`].
pub(crate) const SLANTED: f64 = SLANTS.len() as f64;
/// Number of random numbers just below 1, all of which are tried.
const LAST: f64 = 16.0;
/// Ways to draw slopes across: from each view of [`SLANTS`], by the row of the in-plane slope or by
/// the random numbers just below 1.
const WAYS: usize = 2 * SLANTS.len();

/// Largest errors measured.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// Error of G1.
    pub g1: f64,
    /// Error of the CDF of the in-plane slope.
    pub along: f64,
    /// Error of the CDF of the slope across, given in-plane slopes that random numbers no closer to
    /// 0 and 1 than 2⁻²⁴ draw.
    pub across: f64,
    /// Error of D/D(0).
    pub density: f64,
}

/// Measures a lobe made from tables against the distribution that they were baked from, at points
/// spaced by the nodes of default quality.
pub fn measure(radial: &Lobe, marginal: &Marginal) -> Errors {
    let kappa = marginal.beyond(0.0).excess;
    let axes = radial_axes(Quality::Default.into(), kappa, marginal.reach());
    let error = |kind: Kind| {
        let of_kind = axes.iter().find(|(of, _)| *of == kind);
        of_kind.map_or(0.0, |(_, axes)| found(radial, marginal, kind, axes).worst.error)
    };
    Errors {
        g1: error(Kind::RadialShadowing),
        along: error(Kind::RadialSlope),
        across: error(Kind::RadialConditional),
        density: error(Kind::RadialDensity),
    }
}

/// The largest error of one table with these axes.
fn found(radial: &Lobe, marginal: &Marginal, kind: Kind, axes: &[Axis]) -> Found {
    let ruler = Ruler::new(radial, marginal, axes);
    let mut first = Along::whole(axes[0].nodes.len()).up_to(read(kind, &axes[0]));
    if kind == Kind::RadialDensity {
        // D has a kink at the largest slope.
        let end = HalfTangent::default().coordinate(marginal.reach());
        first = first.and([end * (1.0 - 1e-5), end * (1.0 - 1e-6), end]);
    }
    let (numbers, points) = match axes.get(1) {
        Some(axis) => (Along::mirrored(axis.nodes.len()), POINTS - POINTS / 4),
        None => (Along::none(), PER_CELL * (axes[0].nodes.len() - 1)),
    };
    let u = |b: f64| number(b, 0.5 * numbers.cells);
    let error = |[way, a, b]: [f64; 3]| match kind {
        Kind::RadialShadowing => ruler.g1(a),
        Kind::RadialDensity => ruler.density(a),
        Kind::RadialSlope => ruler.along(a, u(b)),
        _ => {
            let first = ruler.first_number(way as usize, a, a / first.cells);
            ruler.across(way as usize, first, u(b))
        }
    };
    let ways = if kind == Kind::RadialConditional { WAYS } else { 1 };
    let cells = [first.cells, numbers.cells];
    searched(places([&first, &numbers], points), cells, ways, error)
}

/// The share of the first axis that lookups read.
pub fn read(kind: Kind, axis: &Axis) -> f64 {
    match axis.mapping {
        // In-plane slopes end at their bound R, which is κ of this axis.
        Mapping::Rational(_) if kind == Kind::RadialConditional => 0.5,
        _ => 1.0,
    }
}

/// Measures the points of a sweep, drawing in each of `ways` in turn, and climbs from the worst.
fn searched(
    sweep: Vec<[f64; 2]>,
    [a, b]: [f64; 2],
    ways: usize,
    error: impl Fn([f64; 3]) -> f64 + Sync,
) -> Found {
    let at = |i: usize, [x, y]: [f64; 2]| {
        // A point has the way instead of a shape.
        let way = i % ways;
        // Each random number has one coordinate, so that climbs start from it only once.
        let x = if way < SLANTS.len() { x } else { last(x / a) / LAST * a };
        let at = [way as f64, x, y];
        Seen { error: error(at), at }
    };
    let seen: Vec<Seen> =
        sweep.into_par_iter().enumerate().map(|(i, place)| at(i, place)).collect();
    let cells = [0.0, a, b];
    let found = climbed(seen, if ways > 1 { 3 * CLIMBS } else { CLIMBS }, cells, &error);
    // The maximum is measured again with all ways.
    let [_, a, b] = found.worst.at;
    let seen: Vec<Seen> = (0..ways).map(|i| at(i, [a, b])).collect();
    let again = climbed(seen, ways, cells, &error);
    let worst = if again.worst.exceeds(&found.worst) { again.worst } else { found.worst };
    Found { worst, points: found.points + again.points, ..found }
}

/// The number of random numbers between the last one below 1 and the one at a share of an axis.
fn last(share: f64) -> f64 {
    (LAST * share).round()
}

/// Measures one of the tables of a distribution.
pub struct Ruler<'a> {
    radial: &'a Lobe,
    marginal: &'a Marginal<'a>,
    slanted: [(Vec3, MarginalView<'a>); SLANTS.len()],
    axes: &'a [Axis],
}

impl<'a> Ruler<'a> {
    /// For the table with these axes.
    pub fn new(radial: &'a Lobe, marginal: &'a Marginal<'a>, axes: &'a [Axis]) -> Self {
        let slanted = SLANTS.map(|z| (view(z * marginal.sigma()), MarginalView::new(marginal, z)));
        Self { radial, marginal, slanted, axes }
    }

    /// The error at coordinates along the axes, in shares of what is read of them; of slopes
    /// across, the largest over all slanted views.
    pub fn error(&self, kind: Kind, [first, u]: [f64; 2]) -> f64 {
        let cells = |axis: usize| (self.axes[axis].nodes.len() - 1) as f64;
        let place = first * cells(0) * read(kind, &self.axes[0]);
        let u = || number(2.0 * u * cells(1), cells(1));
        match kind {
            Kind::RadialShadowing => self.g1(place),
            Kind::RadialDensity => self.density(place),
            Kind::RadialSlope => self.along(place, u()),
            _ => {
                let error = |way| self.across(way, self.first_number(way, place, 0.0), u());
                (0..SLANTS.len()).map(error).max_by(f64::total_cmp).unwrap_or(f64::NAN)
            }
        }
    }

    /// The cotangent or slope, divided by σ, at `place` cells along the first axis.
    fn quantity(&self, place: f64) -> f64 {
        // Without a γ axis s is 1.
        cotangent(&self.axes[0], 1.0, place / (self.axes[0].nodes.len() - 1) as f64)
    }

    fn view(&self, place: f64) -> Vec3 {
        view(self.quantity(place) * self.marginal.sigma())
    }

    fn g1(&self, place: f64) -> f64 {
        let v = self.view(place);
        let theta = f64::from(v.x).atan2(v.z.into());
        (f64::from(self.radial.g1(v)) - self.marginal.g1(theta)).abs()
    }

    fn density(&self, place: f64) -> f64 {
        let (marginal, sigma) = (self.marginal, self.marginal.sigma());
        // The normal of this slope, as a view whose cotangent is the reciprocal.
        let m = view(1.0 / (self.quantity(place) * sigma));
        let exact = marginal.d(1.0 / (exact_cotangent(m) * sigma));
        ((f64::from(self.radial.d(m)) - exact) / marginal.d(0.0)).abs()
    }

    /// In-plane slope and slope across of a normal.
    fn slopes(&self, v: Vec3, u: [f32; 2]) -> [f64; 2] {
        let [x, y, z] = self.radial.sample_visible_normal(v, u).map(f64::from);
        [x, y].map(|slope| slope / (z * self.marginal.sigma()))
    }

    fn along(&self, place: f64, u: f32) -> f64 {
        let v = self.view(place);
        let exact = MarginalView::new(self.marginal, exact_cotangent(v) / self.marginal.sigma());
        let [x, _] = self.slopes(v, [u, 0.5]);
        (exact.shares(x).below - f64::from(u)).abs()
    }

    /// The first random number that draws the in-plane slope at `place` cells, or, for the second
    /// half of the ways, the number just below 1 that a share of the axis stands for.
    fn first_number(&self, way: usize, place: f64, share: f64) -> f32 {
        let u = match self.slanted.get(way) {
            Some((_, seen)) => 1.0 - seen.shares(self.quantity(place)).above,
            None => 1.0 - RARE * (1.0 + last(share)),
        };
        u.clamp(RARE, 1.0 - RARE) as f32
    }

    /// Error of the slope across at the in-plane slope of a first number, from one of [`SLANTS`].
    fn across(&self, way: usize, first: f32, u: f32) -> f64 {
        let v = self.slanted[way % SLANTS.len()].0;
        let [x, y] = self.slopes(v, [first, u]);
        let tail = self.marginal.across_at(x.abs()).tail(y.abs());
        let got = if y < 0.0 { tail } else { 1.0 - tail };
        (got - f64::from(u)).abs()
    }
}

/// Measures the four tables of one distribution and writes their certificates.
///
/// # Errors
/// [`LoadError::Invalid`] if the tables do not make a lobe.
pub fn certify(
    tables: &mut [Table],
    entry: &MaterialEntry,
    marginal: &Marginal,
    stage: &Stage,
) -> Result<(), LoadError> {
    let provenance = Provenance { materials: vec![entry.clone()], ..Provenance::default() };
    let radial = Tables::from_tables(provenance, tables.to_vec())?
        .material(&entry.name)
        .map_err(|why| LoadError::Invalid(why.to_string()))?;
    stage.split(tables.len());
    for table in tables {
        let quantity = match table.kind {
            Kind::RadialShadowing => Quantity::G1,
            Kind::RadialDensity => Quantity::Density,
            _ => Quantity::Cdf,
        };
        let found = found(&radial, marginal, table.kind, &table.axes);
        table.certificate = found.certificate(quantity, false);
        stage.step();
    }
    Ok(())
}
