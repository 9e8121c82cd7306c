//! The white furnace: with F = 1 all light must come back, and what is missing is an error.
//!
//! Single scattering is the model's, by quadrature; what compensates for the rest comes from tables, as in a renderer. The walk is the
//! reference that needs neither.

use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use microfacet_common::shape::gamma_of_s;
use microfacet_model as model;
use microfacet_sampler::{
    Albedo, Axis, Kind, LobeEntry, Masking, MaterialError, Reflectance, Subject, Table, Tables,
};

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

/// Puts one material and view into the furnace; σ = 0 is a mirror, and a view at the horizon itself stands 1e-30 above it.
///
/// # Errors
/// [`MaterialError`] for what the tables do not cover.
pub fn furnace(
    tables: &Tables,
    masking: Masking,
    sigma: f64,
    gamma: f64,
    cos_theta: f64,
) -> Result<Furnace, MaterialError> {
    let albedo = tables.albedo(sigma, gamma, masking)?;
    let cos = (cos_theta as f32).max(1e-30);
    let shape = model::Shape::new(gamma).map_err(|_| MaterialError::Gamma(gamma))?;
    let exact = model::AlbedoIntegrator::new(shape, 1e-6)
        .reflection(sigma, f64::from(cos), |_| [1.0])
        .map_err(|_| MaterialError::Sigma(sigma))?;
    let [single] = exact.of(masking);
    let turquin = single * f64::from(albedo.turquin(direction(cos), 1.0));
    let kulla_conty = single + lobe(&albedo, cos);
    Ok(Furnace { sigma, gamma, cos_theta, single, turquin, kulla_conty })
}

/// ∫ of the compensating lobe times the cosine over all lights, by the midpoint rule in the logarithm of the cosine: what a smooth surface
/// loses, it loses at grazing.
fn lobe(albedo: &Albedo, cos_theta: f32) -> f64 {
    const STEPS: usize = 4000;
    /// Lights below e⁻³⁰ bring nothing.
    const RANGE: f64 = 30.0;
    let v = direction(cos_theta);
    let step = RANGE / STEPS as f64;
    let at = |i: usize| {
        let cos = libm::exp(-(i as f64 + 0.5) * step);
        f64::from(albedo.compensation(v, direction(cos as f32))) * cos * cos * step
    };
    2.0 * std::f64::consts::PI * (0..STEPS).map(at).sum::<f64>()
}

/// A view at this cosine, for lobes that are round.
pub fn direction(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

/// The furnace over what one albedo table covers.
#[derive(Clone, Copy, Debug)]
pub struct Survey {
    /// The form of masking.
    pub masking: Masking,
    /// Materials and views.
    pub points: usize,
    /// Where the least light came back with the Kulla–Conty lobe.
    pub lowest: Furnace,
    /// Where the most did.
    pub highest: Furnace,
}

impl Survey {
    /// Whether all of it is within [`TOLERANCE`] of 1.
    pub fn passed(&self) -> bool {
        // A NaN fails.
        [self.lowest, self.highest].iter().all(|row| (row.kulla_conty - 1.0).abs() <= TOLERANCE)
    }
}

/// Puts a grid of materials between the nodes of each albedo table, and views from grazing to normal, into the furnace.
///
/// # Errors
/// [`MaterialError`] if the set does not hold what it says it covers.
pub fn survey(tables: &Tables) -> Result<Vec<Survey>, MaterialError> {
    const VIEWS: [f64; 10] = [1e-7, 1e-5, 1e-3, 0.02, 0.07, 0.2, 0.45, 0.8, 0.995, 1.0];
    let of_family = |table: &&Table| {
        let Subject { lobe, reflectance, .. } = &table.subject;
        table.kind == Kind::Albedo
            && (lobe, reflectance) == (&LobeEntry::Family, &Some(Reflectance::Moments))
    };
    tables
        .tables()
        .iter()
        .filter(of_family)
        .filter_map(|table| Some((table, table.subject.masking?, table.subject.covers?)))
        .map(|(table, masking, covers)| {
            let [shapes, roughnesses] = [&table.axes[0], &table.axes[1]];
            let gammas = between(shapes, covers.s.map(gamma_of_s), 11);
            let sigmas = between(roughnesses, covers.sigma.unwrap_or_default(), 14);
            let pairs: Vec<_> =
                gammas.iter().flat_map(|&g| sigmas.iter().map(move |&s| (g, s))).collect();
            let rows = pairs
                .par_iter()
                .flat_map_iter(|&(g, s)| VIEWS.map(|cos| furnace(tables, masking, s, g, cos)))
                .collect::<Result<Vec<_>, MaterialError>>()?;
            let order = |a: &&Furnace, b: &&Furnace| a.kulla_conty.total_cmp(&b.kulla_conty);
            let lowest = *rows.iter().min_by(order).expect("a grid has points");
            let highest = *rows.iter().max_by(order).expect("a grid has points");
            Ok(Survey { masking, points: rows.len(), lowest, highest })
        })
        .collect()
}

/// `count` quantities of an axis in a range, off its nodes; the one there is of a single node.
fn between(axis: &Axis, range: [f64; 2], count: usize) -> Vec<f64> {
    let [first, last] = axis.ends();
    let mut ends = range.map(|x| axis.coordinate(x).unwrap_or(f64::NAN).clamp(first, last));
    ends.sort_by(f64::total_cmp);
    let [low, high] = ends;
    let count = if low == high { 1 } else { count };
    let at = |i: usize| low + (high - low) * (i as f64 + 0.43) / count as f64;
    (0..count).filter_map(|i| axis.quantity(at(i))).collect()
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
