//! Stress test: runs every public function of sampler and model at generated corners and random
//! points, and counts violations.
//!
//! A violation is a NaN, an infinity, a value out of range, a normal that is not of unit length,
//! lies below the horizon or faces away, or a broken monotonicity. Errors of the single-precision
//! sampler against the model are measured along the way, by region.

mod bsdf;
mod bsdfs;
mod checks;
mod corners;
mod derived;
mod per_hit;

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use microfacet_baker::progress::Stage;
use microfacet_baker::table_spec::GAMMA_WHOLE;
use microfacet_sampler::{MaterialError, Tables};

use super::configuration::shapes;
use super::run::on_threads;

use per_hit::Families;

use corners::{corner_materials, corner_points, random_material, random_points};

/// Points drawn for each random material.
const POINTS_PER_MATERIAL: u64 = 256;

/// One material, view and pair of random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// σx and σy.
    pub sigma: [f32; 2],
    /// γ.
    pub gamma: f64,
    /// Polar angle of the view, radians; up to 1e-6 beyond π/2.
    pub theta: f64,
    /// Azimuth of the view, radians.
    pub phi: f64,
    /// Random numbers.
    pub u: [f32; 2],
}

impl Point {
    /// The view as `query` forms it.
    pub fn view(&self) -> Vec3 {
        direction(self.theta, self.phi)
    }
}

/// The direction of two angles, rounded as a renderer has it.
pub(super) fn direction(theta: f64, phi: f64) -> Vec3 {
    let (sin, cos) = theta.sin_cos();
    DVec3::new(sin * phi.cos(), sin * phi.sin(), cos).as_vec3()
}

/// The largest of some values, and its point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// The largest value.
    pub value: f64,
    /// Its point.
    pub at: Point,
}

impl Worst {
    pub(crate) fn see(&mut self, value: f64, at: &Point) {
        // A NaN counts as the worst, and stays.
        if value.is_nan() || value > self.value {
            *self = Self { value, at: *at };
        }
    }
}

/// A broken rule.
#[derive(Clone, Copy, Debug, Default)]
pub struct Violation {
    /// How often it was broken.
    pub count: u64,
    /// The offending value that was largest in magnitude.
    pub worst: Worst,
}

/// Quantities whose error against the model is measured, in the order of [`Region::errors`].
pub const ERRORS: [&str; 4] = ["g1 abs", "d rel", "pdf rel", "cdf abs"];

/// The result for a region of the domain.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// Points tested.
    pub points: u64,
    /// Largest errors, in the order of [`ERRORS`].
    pub errors: [Worst; 4],
    /// Broken rules, by name.
    pub violations: BTreeMap<&'static str, Violation>,
}

impl Region {
    fn merge(&mut self, other: &Self) {
        self.points += other.points;
        for (mine, theirs) in self.errors.iter_mut().zip(&other.errors) {
            mine.see(theirs.value, &theirs.at);
        }
        for (&rule, theirs) in &other.violations {
            let mine = self.violations.entry(rule).or_default();
            mine.count += theirs.count;
            mine.worst.see(theirs.worst.value, &theirs.worst.at);
        }
    }
}

/// Names of the lobes that are tested: of σ and γ bound once, of σ given at a hit, and of both.
pub const LOBES: [&str; 3] = ["bound", "sigma per hit", "per hit"];
/// Names of the parts of the domain by shape.
pub const SHAPES: [&str; 4] = ["gamma < 1.8", "gamma < 4", "gamma < 1e4", "to inf"];
/// Names of the parts of the domain by view.
pub const VIEWS: [&str; 4] = ["near n", "between", "grazing", "below horizon"];
/// Names of the parts of the domain by roughness.
pub const ROUGHNESSES: [&str; 2] = ["ordinary", "extreme"];

/// The result of a stress run, by region.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Indexed by position in [`LOBES`], [`SHAPES`], [`VIEWS`] and [`ROUGHNESSES`]. Not on the
    /// stack, which a run on many threads would overflow: each halving of the points holds some
    /// reports.
    pub regions: Box<[Regions; LOBES.len()]>,
}

/// The result for one kind of lobe.
pub type Regions = [[[Region; ROUGHNESSES.len()]; VIEWS.len()]; SHAPES.len()];

impl Report {
    fn region(&mut self, lobe: usize, at: &Point) -> &mut Region {
        let shape = [GAMMA_WHOLE, 4.0, 1e4].iter().filter(|&&gamma| at.gamma >= gamma).count();
        let cos = at.view().z;
        let view = match cos {
            _ if cos < 0.0 => 3,
            _ if cos < 1e-2 => 2,
            _ if at.theta < 1e-2 => 0,
            _ => 1,
        };
        let inside = at.sigma.iter().all(|sigma| (1e-4..=10.0).contains(sigma));
        &mut self.regions[lobe][shape][view][usize::from(!inside)]
    }

    fn merge(mut self, other: Self) -> Self {
        let theirs = other.regions.as_flattened().as_flattened().as_flattened();
        let mine = self.regions.as_flattened_mut().as_flattened_mut().as_flattened_mut();
        mine.iter_mut().zip(theirs).for_each(|(a, b)| a.merge(b));
        self
    }

    /// All regions together.
    pub fn total(&self) -> Region {
        total(self.regions.as_flattened())
    }
}

/// Regions of any lobes together.
fn total(regions: &[[[Region; ROUGHNESSES.len()]; VIEWS.len()]]) -> Region {
    let mut total = Region::default();
    regions.as_flattened().as_flattened().iter().for_each(|region| total.merge(region));
    total
}

/// The estimated seconds of a run of at least so many points on the current threads.
pub fn seconds(tables: &Tables, points: u64) -> f64 {
    // Microseconds of `microfacet-bake validate --stress --threads 1` for a point of a bound lobe.
    on_threads(points.max(corner_count(&corner_materials(tables))) as usize, 4.5)
}

/// The number of corner points, about: it varies a little between materials.
fn corner_count(materials: &[([f32; 2], f64)]) -> u64 {
    let first = materials
        .first()
        .map_or(0, |&(sigma, gamma)| corner_points(sigma, gamma, 0).iter().map(Vec::len).sum());
    (first * materials.len()) as u64
}

/// Tests all corners and then random points until `points` are tested of bound lobes, and some of
/// them of lobes per hit; counts those of bound lobes in a stage of the progress. The same `seed`
/// gives the same points. A set without lobes has none.
///
/// # Errors
/// [`MaterialError`] if the set does not hold what it declares to cover.
pub fn run(
    tables: &Tables,
    points: u64,
    seed: u64,
    stage: &Stage,
) -> Result<Report, MaterialError> {
    let corners = corner_materials(tables);
    let families = Families::of(tables);
    stage.split(usize::try_from(points.max(corner_count(&corners))).unwrap_or(usize::MAX));
    let corners = corners
        .par_iter()
        .enumerate()
        .map(|(i, &(sigma, gamma))| {
            let mut report = Report::default();
            let points = corner_points(sigma, gamma, i);
            let count = points.iter().map(Vec::len).sum();
            checks::check(tables, &families, sigma, gamma, points, &mut report)?;
            stage.steps(count);
            Ok::<_, MaterialError>(report)
        })
        .try_reduce(Report::default, |a, b| Ok(a.merge(b)))?;
    let shapes = shapes(tables);
    if shapes.is_empty() {
        return Ok(corners);
    }
    let left =
        points.saturating_sub(total(&corners.regions[0]).points).div_ceil(POINTS_PER_MATERIAL);
    let random = (0..left)
        .into_par_iter()
        .fold(
            || Ok(Report::default()),
            |report: Result<Report, MaterialError>, i| {
                let mut report = report?;
                let mut numbers = corners::numbers(seed, i);
                let (sigma, gamma) = random_material(tables, &shapes, &mut numbers);
                let points = random_points(sigma, gamma, POINTS_PER_MATERIAL, &mut numbers);
                checks::check(tables, &families, sigma, gamma, points, &mut report)?;
                stage.steps(POINTS_PER_MATERIAL as usize);
                Ok(report)
            },
        )
        .try_reduce(Report::default, |a, b| Ok(a.merge(b)))?;
    Ok(corners.merge(random))
}
