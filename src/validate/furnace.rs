//! The white furnace: with F = 1 all light must come back, and what is missing is an error.
//!
//! Single scattering is the model's, by quadrature; what compensates for the rest comes from tables, as in a renderer. The walk is the
//! reference that needs neither.

use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use microfacet_model as model;
use microfacet_sampler::{Albedo, BindError, Masking, Tables};

/// How far a furnace closed by the Kulla–Conty lobe may be from 1.
pub const TOLERANCE: f64 = 2e-3;
/// Bounces after which a walk is given up; it then counts as energy lost.
const LIMIT: usize = 1_000_000;
/// Walks that share a generator of random numbers.
const BATCH: usize = 1000;

/// One material and view in the furnace.
#[derive(Clone, Copy, Debug)]
pub struct Furnace {
    /// Roughness.
    pub sigma: f64,
    /// Shape.
    pub gamma: f64,
    /// Cosine of the view.
    pub cos_theta: f64,
    /// E by the model's quadrature: what one bounce returns.
    pub single: f64,
    /// With Turquin's scaling.
    pub turquin: f64,
    /// With the Kulla–Conty lobe.
    pub kulla_conty: f64,
}

/// A mean and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
}

/// What the random walk found.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Light that left after its first bounce: the height-correlated E.
    pub single: Estimate,
    /// Light that left at all.
    pub total: Estimate,
    /// Mean number of bounces.
    pub bounces: f64,
}

/// Puts one material and view into the furnace; σ = 0 is a mirror.
///
/// # Errors
/// [`BindError`] for what the tables do not cover.
pub fn furnace(
    tables: &Tables,
    masking: Masking,
    sigma: f64,
    gamma: f64,
    cos_theta: f64,
) -> Result<Furnace, BindError> {
    let albedo = tables.albedo(sigma, gamma, masking)?;
    let shape = model::Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?;
    let exact = model::AlbedoIntegrator::new(shape, 1e-6)
        .reflection(sigma, cos_theta, |_| [1.0])
        .map_err(|_| BindError::Sigma(sigma as f32))?;
    let [single] = match masking {
        Masking::Uncorrelated => exact.uncorrelated,
        Masking::HeightCorrelated => exact.height_correlated,
    };
    let turquin = single * f64::from(albedo.turquin(cos_theta as f32, 1.0));
    let kulla_conty = single + lobe(&albedo, cos_theta as f32);
    Ok(Furnace { sigma, gamma, cos_theta, single, turquin, kulla_conty })
}

/// ∫ of the compensating lobe times the cosine over all lights, by the midpoint rule in the cube root of the cosine.
fn lobe(albedo: &Albedo, cos_theta: f32) -> f64 {
    const STEPS: usize = 2000;
    let v = direction(cos_theta);
    let step = 1.0 / STEPS as f64;
    let at = |i: usize| {
        let x = (i as f64 + 0.5) * step;
        let cos = x * x * x;
        let lobe = f64::from(albedo.compensation(v, direction(cos as f32)));
        lobe * cos * 3.0 * x * x * step
    };
    2.0 * std::f64::consts::PI * (0..STEPS).map(at).sum::<f64>()
}

fn direction(cos: f32) -> Vec3 {
    // A view at the horizon itself has no lobe; the smallest one above it has its limit.
    let cos = cos.max(f32::MIN_POSITIVE);
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// Follows `walks` rays on the microsurface itself, in parallel; the same seed gives the same result on any number of threads.
///
/// # Errors
/// [`model::ParameterError`] for parameters outside the family.
pub fn walk(
    sigma: f64,
    gamma: f64,
    cos_theta: f64,
    walks: usize,
    seed: u64,
) -> Result<Walk, model::ParameterError> {
    let material = model::StudentT::isotropic(sigma, gamma)?;
    let v = DVec3::new((1.0 - cos_theta * cos_theta).max(0.0).sqrt(), 0.0, cos_theta);
    let batch = |i: usize| {
        let mut random = rand::rngs::StdRng::seed_from_u64(seed.wrapping_add(i as u64));
        let mut counts = [0_usize; 3];
        for _ in 0..BATCH.min(walks - i * BATCH) {
            if let Some((_, bounces)) = material.walk(v, LIMIT, &mut || random.random()) {
                counts[0] += usize::from(bounces == 1);
                counts[1] += 1;
                counts[2] += bounces;
            }
        }
        counts
    };
    let add = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [first, out, bounces] = (0..walks.div_ceil(BATCH)).into_par_iter().map(batch).reduce(|| [0; 3], add);
    let estimate = |count: usize| {
        let mean = count as f64 / walks as f64;
        Estimate { mean, error: (mean * (1.0 - mean) / walks as f64).sqrt() }
    };
    Ok(Walk { single: estimate(first), total: estimate(out), bounces: bounces as f64 / walks as f64 })
}
