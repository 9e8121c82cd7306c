//! χ² of the directions that a BSDF draws against its own density, on the whole sphere.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_baker::progress::Stage;
use microfacet_model::statistics::{ChiSquare, chi_square};
use microfacet_sampler::{Bsdf, Tables, Transport};

use super::configuration::Configuration;
use super::grid::Grid;
use super::specimen::Unmade;
use crate::run::{Judged, Options, Outcome, judge, on_threads};

/// The approximate number of cells, and the fewest and the most lights that they are made from.
const CELLS: usize = 256;
const PILOT: [usize; 2] = [4096, 8192];
/// From this share on, draws without a light are a cell of their own; the error of quadrature is
/// some 1e-6 in each cell.
const LEAST_LEFT: f64 = 2e-3;

/// Draws `samples` lights by `draw(choice, u)`, and compares their counts with the integrals of
/// `density`. Draws without a light are a cell of their own, which is expected to hold 1 minus the
/// integral of the density. The elevations `edges` are edges of cells. Cells are also small where
/// there are many lights of `guide`, for example of a narrow peak that is seldom drawn.
pub fn test(
    v: Vec3,
    samples: usize,
    seed: u64,
    edges: Vec<f64>,
    guide: &[Vec3],
    mut draw: impl FnMut(f32, [f32; 2]) -> Option<Vec3>,
    density: impl Fn(Vec3) -> f32,
) -> ChiSquare {
    let mut random = StdRng::seed_from_u64(seed);
    let mut next = || draw(random.random(), [random.random(), random.random()]);
    let pilots = (samples / 50).clamp(PILOT[0], PILOT[1]);
    let drawn = (0..pilots).filter_map(|_| next());
    let pilot: Vec<Vec3> = drawn.chain(guide.iter().copied()).collect();
    let grid = Grid::new(v, &pilot, (pilots + guide.len()) / CELLS, edges);
    let rest = grid.count();
    let mut counts = vec![0_u64; rest + 1];
    for _ in 0..samples {
        counts[next().map_or(rest, |l| grid.cell(l))] += 1;
    }
    let mut shares = grid.shares(samples, density);
    let left = 1.0 - shares.iter().sum::<f64>();
    if left < LEAST_LEFT {
        // So small a rest would mostly be the quadrature errors of all cells.
        let lost = counts.pop().unwrap_or(0);
        counts[rest - 1] += lost;
        shares[rest - 1] += left;
    } else {
        shares.push(left);
    }
    let expected: Vec<f64> = shares.iter().map(|share| share * samples as f64).collect();
    chi_square(&counts, &expected)
}

/// The result for one configuration.
#[derive(Clone, Debug)]
pub struct Report {
    /// Material and view.
    pub configuration: Configuration,
    /// The test.
    pub test: ChiSquare,
}

impl Judged for Report {
    fn p(&self) -> f64 {
        self.test.p
    }
}

/// The estimated seconds of a run on the current threads.
pub fn seconds(configurations: usize, options: Options) -> f64 {
    // Microseconds for the cells of a configuration and the integral of each, and for a light:
    // fitted to `microfacet-bake bsdf --only chi-square --threads 1` with 1e4 and 5e5 samples.
    on_threads(configurations, 240_000.0 + 0.7 * options.samples as f64)
}

/// Tests all `configurations` in parallel, with the albedos of `tables`, and counts their lights in
/// a stage of the progress.
///
/// # Errors
/// [`Unmade`] for a configuration whose BSDF cannot be made.
pub fn run(
    tables: &Tables,
    configurations: &[Configuration],
    options: Options,
    stage: &Stage,
) -> Result<Outcome<Report>, Unmade> {
    judge(configurations, 1, options.samples, stage, |configuration, count| {
        one(tables, configuration, options, count)
    })
}

fn one(
    tables: &Tables,
    configuration: &Configuration,
    options: Options,
    count: &mut dyn FnMut(),
) -> Result<Report, Unmade> {
    let judged = configuration.specimen.bsdf(tables)?;
    let factor = options.gamma_factor;
    let drawn = match factor == 1.0 {
        true => judged.clone(),
        false => configuration.specimen.reshaped(factor).bsdf(tables)?,
    };
    let v = configuration.view();
    let draw = |choice, u| {
        count();
        let sample = drawn.sample(v, choice, u, Transport::Radiance)?;
        (!sample.delta).then_some(sample.l.into())
    };
    // Facets alone, as often by reflection as by refraction.
    let facets = configuration.specimen.facets().bsdf(tables)?;
    let mut random = StdRng::seed_from_u64(!configuration.seed);
    let mut by_facet = |i: usize| {
        let (choice, u) = ([0.0, 1.0][i % 2], [random.random(), random.random()]);
        let sample = facets.sample(v, choice, u, Transport::Radiance)?;
        (!sample.delta).then_some(sample.l.into())
    };
    let guide: Vec<Vec3> = (0..PILOT[0]).filter_map(&mut by_facet).collect();
    let (seed, edges) = (configuration.seed, configuration.edges());
    let density = |l| Bsdf::<3>::pdf(&judged, v, l);
    let test = test(v, options.samples, seed, edges, &guide, draw, density);
    Ok(Report { configuration: *configuration, test })
}
