//! A validation run: many configurations, one verdict.

use glam::Vec3;
use rayon::prelude::*;

use microfacet_model as model;
use microfacet_sampler::{BindError, Tables};

use super::chi_square::sidak;
use super::configuration::Configuration;
use super::normals::{Report, judge};
use super::pdf_integral;

/// Probability with which a run rejects a correct set.
pub const LEVEL: f64 = 0.01;
/// How far the integral of `table_pdf` may be from one.
pub const PDF_TOLERANCE: f64 = 1e-6;

/// What to do.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Normals drawn for each configuration.
    pub samples: usize,
    /// Factor on γ of the model that tables are judged against; 1 unless one wants to see them rejected.
    pub gamma_factor: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// All configurations, the least probable first.
    pub reports: Vec<Report>,
    /// Level of a single test after Šidák's correction.
    pub level: f64,
    /// Integral of `table_pdf` for each configuration.
    pub integrals: Vec<(Configuration, f64)>,
}

impl Outcome {
    /// Configurations whose χ² rejects.
    pub fn rejected(&self) -> usize {
        self.reports.iter().filter(|report| report.p() < self.level).count()
    }

    /// The integral furthest from one.
    pub fn worst_integral(&self) -> Option<(Configuration, f64)> {
        let off = |x: &(Configuration, f64)| (x.1 - 1.0).abs();
        self.integrals.iter().copied().max_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// Whether nothing rejects.
    pub fn passed(&self) -> bool {
        // A NaN fails.
        let sound = |x: f64| (x - 1.0).abs() <= PDF_TOLERANCE;
        self.rejected() == 0 && self.integrals.iter().all(|&(_, integral)| sound(integral))
    }
}

/// Judges all `configurations` in parallel, calling `progress` after each.
///
/// # Errors
/// [`BindError`] if the set does not hold what it says it covers.
pub fn run(
    tables: &Tables,
    configurations: &[Configuration],
    options: Options,
    progress: impl Fn() + Sync,
) -> Result<Outcome, BindError> {
    let results = configurations
        .par_iter()
        .map(|configuration| {
            let result = one(tables, configuration, options);
            progress();
            result
        })
        .collect::<Result<Vec<_>, BindError>>()?;
    let integrals = configurations.iter().zip(&results).map(|(at, (_, integral))| (*at, *integral)).collect();
    let mut reports: Vec<Report> = results.into_iter().map(|(report, _)| report).collect();
    reports.sort_by(|a, b| a.p().total_cmp(&b.p()));
    // Two tests a configuration.
    Ok(Outcome { level: sidak(LEVEL, 2 * reports.len()), reports, integrals })
}

/// One configuration: the tests, and the integral of `table_pdf`.
fn one(tables: &Tables, configuration: &Configuration, options: Options) -> Result<(Report, f64), BindError> {
    let Configuration { sigma_x, sigma_y, gamma, .. } = *configuration;
    // The model gets the roughness that the run time has rounded to.
    let bound = tables.student_t([sigma_x, sigma_y], gamma)?;
    let [x, y] = bound.sigma().map(f64::from);
    let truth = model::StudentT::anisotropic(x, y, gamma * options.gamma_factor)
        .map_err(|_| BindError::Gamma(gamma * options.gamma_factor))?;
    let v = configuration.view();
    let report =
        judge(configuration, &truth, bound.g1(v), options.samples, |u| bound.sample_visible_normal(v, u));
    let theta = configuration.theta as f32;
    let in_plane = Vec3::new(theta.sin(), 0.0, theta.cos().max(0.0));
    let integral = pdf_integral::integral(&bound.with_roughness(1.0)?, in_plane);
    Ok((report, integral))
}
