//! Error against time of one directional albedo: deterministic quadrature and Monte Carlo with the
//! table's own sampler.
//!
//! `cargo run --profile dist -p microfacet-study -- albedo_convergence` prints the table in
//! `docs/albedo.md`. Both methods use the same materials, views and masking in one run; errors are
//! root mean squares over these, against quadrature at a tolerance of 1e-13. A second table has
//! every fifth node of the general tables: the largest error, and the largest as a share of its
//! estimate, against a tolerance of 1e-10.

use std::time::Instant;

use glam::Vec3;
use microfacet_baker::bake::albedo::{AlbedoSpec, CHANNELS, Integrand, Models, Site};
use microfacet_baker::table_spec::Quality;
use microfacet_model::{Albedo, AlbedoIntegrator, Shape};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::Precision;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use crate::{Outcome, print_head};

/// σ, γ and cos θ_v.
const VIEWS: [(f64, f64, f64); 6] = [
    (0.1, 2.0, 0.8),
    (0.5, 2.0, 0.4),
    (1.0, 3.0, 0.2),
    (0.3, 1.7, 0.6),
    (0.7, 40.0, 0.1),
    (2.0, 2.5, 0.9),
];

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    let truth: Vec<f64> = VIEWS.iter().map(|&view| quadrature(view, 1e-13)).collect();
    print_head(&["method", "nodes or samples", "RMS error", "time of one albedo, ms"]);
    for tolerance in [1e-3, 1e-5, 1e-6, 1e-7, 1e-9, 1e-11] {
        let (error, time) = timed(&truth, |view| quadrature(view, tolerance));
        println!("| quadrature | tolerance {tolerance:.0e} | {error:.1e} | {time:.3} |");
    }
    let tables = Tables::embedded();
    for samples in [1_000, 10_000, 100_000, 1_000_000, 10_000_000] {
        let (error, time) = timed(&truth, |view| monte_carlo(&tables, view, samples));
        println!("| Monte Carlo | {samples} | {error:.1e} | {time:.3} |");
    }
    nodes()
}

/// Errors of quadrature at nodes of the general tables.
fn nodes() -> Outcome {
    let spec = AlbedoSpec::general(Quality::Default, Precision::F32);
    let sites: Vec<Site> = Site::all(&spec.axes).into_iter().step_by(5).collect();
    let albedos = |tolerance: f64| {
        Models::with(&spec.lobe, sites.iter().map(|site| site.gamma), tolerance, |models| {
            let integrand = Integrand::new(&spec.reflectance)?;
            sites.par_iter().map(|site| integrand.at(models.at(site), site)).collect()
        })
    };
    let truth: Vec<Albedo<CHANNELS>> = albedos(1e-10)?;
    println!("\n{} nodes of the general tables:\n", sites.len());
    print_head(&["tolerance", "largest error", "largest error / estimate", "largest estimate"]);
    for tolerance in [1e-4, 3e-5, 1e-5, 1e-6, 1e-7] {
        let [mut error, mut share, mut estimate] = [0.0_f64; 3];
        for (got, truth) in albedos(tolerance)?.iter().zip(&truth) {
            let pairs = Masking::ALL
                .into_iter()
                .flat_map(|form| got.of(form).into_iter().zip(truth.of(form)));
            let off = pairs.map(|(got, truth)| (got - truth).abs()).fold(0.0, f64::max);
            error = error.max(off);
            share = share.max(off / got.error);
            estimate = estimate.max(got.error);
        }
        println!("| {tolerance:.0e} | {error:.1e} | {share:.2} | {estimate:.1e} |");
    }
    Ok(())
}

/// Root-mean-square error over the views, and the mean time in milliseconds, including everything
/// that one albedo needs.
fn timed(truth: &[f64], albedo: impl Fn((f64, f64, f64)) -> f64) -> (f64, f64) {
    let start = Instant::now();
    let errors = VIEWS.iter().zip(truth).map(|(&view, truth)| albedo(view) - truth);
    let sum: f64 = errors.map(|error| error * error).sum();
    let count = VIEWS.len() as f64;
    ((sum / count).sqrt(), 1e3 * start.elapsed().as_secs_f64() / count)
}

fn quadrature((sigma, gamma, cos): (f64, f64, f64), tolerance: f64) -> f64 {
    let shape = Shape::new(gamma).expect("in the family");
    let albedo = AlbedoIntegrator::new(shape, tolerance).reflection(sigma, cos, |_| [1.0]);
    albedo.expect("in the domain").of(Masking::HeightCorrelated)[0]
}

fn monte_carlo(tables: &Tables, (sigma, gamma, cos): (f64, f64, f64), samples: usize) -> f64 {
    let material = tables.student_t(sigma as f32, gamma).expect("covered");
    let v = Vec3::new((1.0 - cos * cos).sqrt() as f32, 0.0, cos as f32);
    let mut random = rand::rngs::StdRng::seed_from_u64(1);
    let mut sum = 0.0;
    for _ in 0..samples {
        let u = [random.random(), random.random()];
        let light = material.sample_reflected(v, u, Masking::HeightCorrelated);
        sum += light.map_or(0.0, |(_, weight)| f64::from(weight));
    }
    sum / samples as f64
}
