//! The white furnace: with F = 1 all light must come back, and any deviation is an error.
//!
//! Single scattering is computed with the model, by quadrature; the compensation comes from tables,
//! as in a renderer. The random walk is a reference independent of both.

use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use microfacet_baker::progress::Stage;
use microfacet_model as model;
use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Masking, MaterialError, Tables};
use microfacet_tables::{Axis, Kind, LobeSpec, Quantity, Reflectance, Subject, Table};

use crate::run::on_threads;

/// Allowed deviation from 1 with the Kulla–Conty lobe
/// ([2017](https://blog.selfshadow.com/publications/s2017-shading-course/)).
pub const TOLERANCE: f64 = 2e-3;
/// Bounces after which a walk is abandoned; it then counts as energy lost.
const LIMIT: usize = 1_000_000;
/// Walks that share a random number generator.
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
    /// E by the model's quadrature: the share of light that one bounce returns.
    pub single: f64,
    /// The share with Turquin's scaling
    /// ([2019](https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf)).
    pub turquin: f64,
    /// The share with the Kulla–Conty lobe.
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

/// The result of the random walk.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Light that left after its first bounce: the height-correlated E.
    pub single: Estimate,
    /// All light that left.
    pub total: Estimate,
    /// Mean number of bounces.
    pub bounces: f64,
}

/// Runs the furnace for one material and view. σ = 0 is a mirror; cos θ is clamped to [1e-30, 1].
///
/// # Errors
/// [`MaterialError`] for a material that the tables do not cover.
pub fn furnace(
    tables: &Tables,
    masking: Masking,
    sigma: f64,
    gamma: f64,
    cos_theta: f64,
) -> Result<Furnace, MaterialError> {
    let albedo = tables.albedo(sigma, gamma, masking)?;
    let cos = (cos_theta as f32).max(1e-30).clamp(1e-30, 1.0);
    let shape = model::Shape::new(gamma).map_err(|_| MaterialError::Gamma(gamma))?;
    let exact = model::AlbedoIntegrator::new(shape, 1e-6)
        .reflection(sigma, f64::from(cos), |_| [1.0])
        .expect("the tables hold sigma, and the cosine is that of a view");
    let [single] = exact.of(masking);
    let turquin = single * f64::from(albedo.turquin(direction(cos), 1.0));
    let kulla_conty = single + lobe(&albedo, cos);
    Ok(Furnace { sigma, gamma, cos_theta, single, turquin, kulla_conty })
}

/// Runs the furnace for a lobe of σx and σy and a view at cos θ and azimuth φ (radians from the x
/// axis), with the albedo of that lobe; cos θ is clamped as by [`furnace`]. σ of the result is
/// √(σx σy).
///
/// # Errors
/// [`MaterialError::Gamma`] for γ outside the family.
///
/// # Panics
/// Unless both σ are positive.
pub fn anisotropic(
    albedo: &Albedo,
    sigma: [f64; 2],
    gamma: f64,
    cos_theta: f64,
    phi: f64,
) -> Result<Furnace, MaterialError> {
    /// Azimuths of lights in a quarter of a turn, which repeats mirrored.
    const AZIMUTHS: u32 = 16;
    let cos = (cos_theta as f32).clamp(1e-30, 1.0);
    let at = |sin: f32, cos: f32, phi: f64| {
        let (s, c) = libm::sincos(phi);
        Vec3::new(sin * c as f32, sin * s as f32, cos)
    };
    let v = at(direction(cos).x, cos, phi);
    let shape = model::Shape::new(gamma).map_err(|_| MaterialError::Gamma(gamma))?;
    let exact = model::AlbedoIntegrator::new(shape, 1e-6)
        .reflection_anisotropic(sigma, f64::from(cos), phi, |_| [1.0])
        .expect("both sigma are positive, and the cosine is that of a view");
    let [single] = exact.of(albedo.masking());
    let lobe = |i: u32| {
        let phi = std::f64::consts::FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(AZIMUTHS);
        over_lights(|sin, cos| f64::from(albedo.compensation(v, at(sin, cos, phi))))
    };
    let kulla_conty = single + (0..AZIMUTHS).map(lobe).sum::<f64>() / f64::from(AZIMUTHS);
    let turquin = single * f64::from(albedo.turquin(v, 1.0));
    let sigma = (sigma[0] * sigma[1]).sqrt();
    Ok(Furnace { sigma, gamma, cos_theta, single, turquin, kulla_conty })
}

/// ∫ of the compensating lobe times the cosine over all lights.
fn lobe(albedo: &Albedo, cos_theta: f32) -> f64 {
    let v = direction(cos_theta);
    over_lights(|sin, cos| f64::from(albedo.compensation(v, Vec3::new(sin, 0.0, cos))))
}

/// ∫ f cos θ over the hemisphere of lights, of f(sin θ, cos θ) that does not depend on the azimuth.
///
/// The midpoint rule in ln tan θ resolves the horizon, where a smooth surface loses its light, and
/// the normal, around which f of heavy tails changes within the roughness. Even steps of ln cos θ
/// would miss that change: 2.5e-4 of the integral at σ = 0.01 and γ = 1.501.
pub(crate) fn over_lights(f: impl Fn(f32, f32) -> f64) -> f64 {
    const STEPS: usize = 4000;
    /// Lights within e⁻¹⁶ of the normal or e⁻³⁰ of the horizon contribute nothing.
    const RANGE: [f64; 2] = [-16.0, 30.0];
    let step = (RANGE[1] - RANGE[0]) / STEPS as f64;
    let at = |i: usize| {
        let tan = libm::exp(RANGE[0] + (i as f64 + 0.5) * step);
        let cos = 1.0 / libm::hypot(1.0, tan);
        let sin = tan * cos;
        f(sin as f32, cos as f32) * (sin * cos) * (sin * cos) * step
    };
    2.0 * std::f64::consts::PI * (0..STEPS).map(at).sum::<f64>()
}

/// The view with this cosine and azimuth 0, for isotropic lobes.
pub fn direction(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// The furnace over the domain of one albedo table.
#[derive(Clone, Copy, Debug)]
pub struct Survey {
    /// The form of masking.
    pub masking: Masking,
    /// Number of materials and views.
    pub points: usize,
    /// Allowed deviation from 1: [`TOLERANCE`], or the error of E that the table's certificate
    /// states, if that is larger.
    pub allowed: f64,
    /// The material and view for which the Kulla–Conty lobe returns the least light.
    pub lowest: Furnace,
    /// The material and view for which it returns the most.
    pub highest: Furnace,
}

impl Survey {
    /// Whether every point is as close to 1 as is allowed.
    pub fn passed(&self) -> bool {
        // Written so that a NaN fails.
        [self.lowest, self.highest].iter().all(|row| (row.kulla_conty - 1.0).abs() <= self.allowed)
    }
}

/// Cosines of the views of a survey.
const VIEWS: [f64; 10] = [1e-7, 1e-5, 1e-3, 0.02, 0.07, 0.2, 0.45, 0.8, 0.995, 1.0];

/// The form of masking of each albedo table of the family, the deviation that it is allowed, and
/// the materials of a survey of it.
fn surveyed(tables: &Tables) -> Vec<(Masking, f64, Vec<[f64; 2]>)> {
    let materials = |(table, masking): (&Table, Masking)| {
        let lobe = &table.subject.lobe;
        let gammas = between(&table.axes[0], [lobe.gamma.max, lobe.gamma.min], 11);
        let sigmas = between(&table.axes[1], lobe.roughness.x().into(), 14);
        let pairs =
            gammas.iter().flat_map(|&gamma| sigmas.iter().map(move |&sigma| [sigma, gamma]));
        let stated = table.certificate.errors.get(&Quantity::E);
        let errors = stated.into_iter().flat_map(|of| [Some(of.largest), of.outside]).flatten();
        (masking, errors.fold(TOLERANCE, f64::max), pairs.collect())
    };
    of_family(tables).map(materials).collect()
}

/// The estimated seconds of [`survey`] on the current threads.
pub fn survey_seconds(tables: &Tables) -> f64 {
    surveyed(tables).iter().map(|(_, _, materials)| seconds(materials.len() * VIEWS.len())).sum()
}

/// The estimated seconds of so many furnaces on the current threads.
pub fn seconds(rows: usize) -> f64 {
    // Microseconds for a row: 2200 of `microfacet-bake furnace --threads 1`, 3400 of the survey.
    on_threads(rows, 3000.0)
}

/// Runs the furnace for a grid of materials between the nodes of each albedo table, with views from
/// grazing to normal; each material is one step of the stage.
///
/// # Errors
/// [`MaterialError`] if the set does not hold what it declares to cover.
pub fn survey(tables: &Tables, stage: &Stage) -> Result<Vec<Survey>, MaterialError> {
    let all = surveyed(tables);
    stage.split(all.iter().map(|(_, _, materials)| materials.len()).sum());
    all.into_iter()
        .map(|(masking, allowed, materials)| {
            let views = |&[sigma, gamma]: &[f64; 2]| {
                let rows = VIEWS.map(|cos| furnace(tables, masking, sigma, gamma, cos));
                stage.step();
                rows
            };
            let rows = materials
                .par_iter()
                .flat_map_iter(views)
                .collect::<Result<Vec<_>, MaterialError>>()?;
            let order = |a: &&Furnace, b: &&Furnace| a.kulla_conty.total_cmp(&b.kulla_conty);
            let lowest = *rows.iter().min_by(order).expect("a grid has points");
            let highest = *rows.iter().max_by(order).expect("a grid has points");
            Ok(Survey { masking, points: rows.len(), allowed, lowest, highest })
        })
        .collect()
}

/// The tables that a furnace reads, each with its form of masking.
fn of_family(tables: &Tables) -> impl Iterator<Item = (&Table, Masking)> {
    let is_read = |table: &&Table| {
        let Subject { lobe, reflectance, .. } = &table.subject;
        table.kind == Kind::Albedo && lobe.is_family() && *reflectance == Some(Reflectance::Mirror)
    };
    let read = tables.tables().iter().filter(is_read);
    read.filter_map(|table| Some((table, table.subject.masking?)))
}

/// Whether a set has tables that a furnace reads.
pub fn has_furnace(tables: &Tables) -> bool {
    of_family(tables).next().is_some()
}

/// The round lobes that a furnace can be run for with one form of masking, by table.
pub fn domains(tables: &Tables, masking: Masking) -> Vec<LobeSpec> {
    let of = of_family(tables).filter(|(_, of)| *of == masking);
    of.map(|(table, _)| table.subject.lobe.clone()).collect()
}

/// `count` quantities of an axis in a range, between its nodes; for a single node, that node.
fn between(axis: &Axis, range: [f64; 2], count: usize) -> Vec<f64> {
    let [first, last] = axis.ends();
    let mut ends = range.map(|x| axis.coordinate(x).unwrap_or(f64::NAN).clamp(first, last));
    ends.sort_by(f64::total_cmp);
    let [low, high] = ends;
    let count = if low == high { 1 } else { count };
    let at = |i: usize| low + (high - low) * (i as f64 + 0.43) / count as f64;
    (0..count).filter_map(|i| axis.quantity(at(i))).collect()
}

/// The estimated seconds of [`walk`] on the current threads.
pub fn walk_seconds(sigma: f64, gamma: f64, walks: usize) -> f64 {
    // Microseconds for a ray, of which long tails take many bounces: fitted to `microfacet-bake
    // furnace --threads 1 --walks 1e5`, within a factor of two for sigma of 0.3 to 3.
    on_threads(walks, 1.0 + 0.2 * sigma / (gamma - 1.5))
}

/// Follows `walks` rays on the microsurface, in parallel and counted in a stage of the progress;
/// the same seed gives the same result on any number of threads.
///
/// # Errors
/// [`model::ParameterError`] for parameters outside the family.
pub fn walk(
    sigma: f64,
    gamma: f64,
    cos_theta: f64,
    walks: usize,
    seed: u64,
    stage: &Stage,
) -> Result<Walk, model::ParameterError> {
    stage.split(walks.div_ceil(BATCH));
    let material = model::StudentT::new(sigma, gamma)?;
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
        stage.step();
        counts
    };
    let add = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [first, out, bounces] =
        (0..walks.div_ceil(BATCH)).into_par_iter().map(batch).reduce(|| [0; 3], add);
    let estimate = |count: usize| {
        let mean = count as f64 / walks as f64;
        Estimate { mean, error: (mean * (1.0 - mean) / walks as f64).sqrt() }
    };
    Ok(Walk {
        single: estimate(first),
        total: estimate(out),
        bounces: bounces as f64 / walks as f64,
    })
}
