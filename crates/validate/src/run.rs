//! A validation run: many configurations, one verdict.

use glam::Vec3;
use rayon::prelude::*;

use microfacet_baker::progress::Stage;
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::statistics::{NormalsTest, sidak, test_visible_normals};
use microfacet_sampler::{MaterialError, MicrofacetDistribution as _, Tables};

use super::configuration::Configuration;
use super::pdf_integral;

/// Probability with which a run of [`USUAL`] configurations rejects a correct set, or correct
/// BSDFs.
pub const LEVEL: f64 = 0.01;
/// The level of a single test is that of a run of at least this many configurations. Else a run of
/// one would reject a correct set for one seed in a hundred, and a rejection found among many would
/// be judged at another level when it is repeated alone.
pub const USUAL: usize = 100;
/// Allowed deviation of the integral of `table_pdf` from one.
pub const PDF_TOLERANCE: f64 = 1e-6;

/// Options of a run.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Normals, or lights of a BSDF, drawn for each configuration.
    pub samples: usize,
    /// Factor on γ of what is drawn or compared with; other than 1 to see it rejected.
    pub gamma_factor: f64,
}

/// The result for one configuration.
#[derive(Clone, Copy, Debug)]
pub struct Report {
    /// Material and view.
    pub configuration: Configuration,
    /// The statistical tests of the normals drawn.
    pub normals: NormalsTest,
    /// Error of G1 for the view.
    pub g1_error: f64,
    /// Integral of `table_pdf` over all normals, with the configuration's γ and θ.
    pub pdf_integral: f64,
}

impl Judged for Report {
    fn p(&self) -> f64 {
        self.normals.p()
    }

    fn sound(&self) -> bool {
        // Written so that a NaN fails.
        (self.pdf_integral - 1.0).abs() <= PDF_TOLERANCE
    }
}

/// The result for one configuration, as a run judges it.
pub trait Judged {
    /// The smallest p-value of its tests.
    fn p(&self) -> f64;

    /// Whether its tests that are not statistical pass.
    fn sound(&self) -> bool {
        true
    }
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Outcome<R = Report> {
    /// One report a configuration, the smallest p first.
    pub reports: Vec<R>,
    /// Level of a single test after Šidák's correction.
    pub level: f64,
}

impl<R: Judged> Outcome<R> {
    /// Configurations of which a χ² rejects.
    pub fn rejected(&self) -> usize {
        // Written so that a NaN is rejected.
        self.reports.iter().filter(|report| !(report.p() >= self.level)).count()
    }

    /// Whether all tests pass.
    pub fn passed(&self) -> bool {
        self.rejected() == 0 && self.reports.iter().all(Judged::sound)
    }
}

impl Outcome {
    /// The report whose integral of `table_pdf` is furthest from one.
    pub fn worst_integral(&self) -> Option<&Report> {
        let off = |report: &Report| (report.pdf_integral - 1.0).abs();
        self.reports.iter().max_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

/// Samples between two counts of the progress.
const COUNTED: usize = 4096;

/// Judges all configurations in parallel, each by a number of χ² tests, and counts their samples in
/// a stage of the progress; `one` calls its second argument for each sample.
pub(crate) fn judge<C: Sync, R: Judged + Send, E: Send>(
    configurations: &[C],
    tests: usize,
    samples: usize,
    stage: &Stage,
    one: impl Fn(&C, &mut dyn FnMut()) -> Result<R, E> + Sync,
) -> Result<Outcome<R>, E> {
    // One step more for the work that does not depend on the number of samples.
    stage.split(configurations.len() * (1 + samples / COUNTED));
    let counted = |configuration| {
        let mut drawn = 0;
        let mut count = || {
            drawn += 1;
            if drawn % COUNTED == 0 {
                stage.step();
            }
        };
        let report = one(configuration, &mut count);
        stage.step();
        report
    };
    let mut reports: Vec<R> = configurations.par_iter().map(counted).collect::<Result<_, E>>()?;
    reports.sort_by(|a, b| a.p().total_cmp(&b.p()));
    Ok(Outcome { level: sidak(LEVEL, tests * reports.len().max(USUAL)), reports })
}

/// The estimated seconds on the current threads of `count` tasks of `microseconds` each.
pub(crate) fn on_threads(count: usize, microseconds: f64) -> f64 {
    1e-6 * microseconds * count as f64 / rayon::current_num_threads() as f64
}

/// The estimated seconds of a run on the current threads.
pub fn seconds(configurations: usize, options: Options) -> f64 {
    // Microseconds for the grids and the integral of a configuration, and for a normal: fitted to
    // `microfacet-bake validate --threads 1` with 1e3 and 1e6 samples.
    on_threads(configurations, 37_000.0 + 0.17 * options.samples as f64)
}

/// Tests all `configurations` in parallel, each by two χ², and counts their normals in a stage of
/// the progress.
///
/// # Errors
/// [`MaterialError`] if the set does not hold what it declares to cover.
pub fn run(
    tables: &Tables,
    configurations: &[Configuration],
    options: Options,
    stage: &Stage,
) -> Result<Outcome, MaterialError> {
    judge(configurations, 2, options.samples, stage, |configuration, count| {
        one(tables, configuration, options, count)
    })
}

fn one(
    tables: &Tables,
    configuration: &Configuration,
    options: Options,
    count: &mut dyn FnMut(),
) -> Result<Report, MaterialError> {
    let Configuration { sigma_x, sigma_y, gamma, seed, .. } = *configuration;
    let lobe = tables.lobe([sigma_x, sigma_y], gamma)?;
    // The model gets the roughness as rounded for the sampler.
    let sigma = [sigma_x as f32, sigma_y as f32];
    let judged = gamma * options.gamma_factor;
    let truth = model::StudentT::new(sigma, judged).map_err(|_| MaterialError::Gamma(judged))?;
    let v = configuration.view();
    let normals = test_visible_normals(&truth, v.as_dvec3(), options.samples, seed, |u| {
        count();
        lobe.sample_visible_normal(v, u).into()
    });
    let theta = configuration.theta as f32;
    let in_plane = Vec3::new(theta.sin(), 0.0, theta.cos().max(0.0));
    Ok(Report {
        configuration: *configuration,
        normals,
        g1_error: (f64::from(lobe.g1(v)) - truth.g1(v.as_dvec3())).abs(),
        pdf_integral: pdf_integral::integral(&tables.lobe(1.0, gamma)?, gamma, in_plane),
    })
}
