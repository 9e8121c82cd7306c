//! The white furnace of complete BSDFs: what a white surface returns of the light of a view, by the
//! Kulla–Conty compensation.
//!
//! One bounce is integrated with the model under the exact reflectance. What compensation adds to
//! it is the difference between the BSDF's own f with and without it: for round lobes it does not
//! depend on the azimuth of the light, so that it is measured with lights on the side of the view,
//! away from any peak. Samples are a check of both, with their own standard error.

use std::fmt;

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use microfacet_baker::progress::Stage;
use microfacet_baker::table_set::Settings;
use microfacet_baker::table_spec::Quality;
use microfacet_model as model;
use microfacet_sampler::{AnyBsdf, Bsdf, Compensation, Masking, Tables, Transport};
use microfacet_tables::{Interval, Kind, LobeSpec, Quantity, Reflectance, Table};

use super::specimen::{self, HazeOf, LobeOf, Specimen, Surface, Unmade};
use crate::furnace::{Estimate, TOLERANCE, direction, over_lights};
use crate::run::on_threads;

/// Roughnesses and cosines of views; smaller ones are outside what certificates promise.
const SIGMAS: [f32; 6] = [0.0, 0.01, 0.1, 0.3, 1.0, 3.0];
const VIEWS: [f32; 6] = [1e-3, 0.02, 0.1, 0.3, 0.6, 1.0];
const PROMISED: f32 = 0.02;
/// Standard errors that the mean of samples may be off, among some hundred rows.
const ERRORS: f64 = 4.5;

/// Pairs of γ and η among which the ends of both ranges occur.
pub const PAIRS: [[f64; 2]; 7] = [
    [1.501, 1.5],
    [1.6, 1.33],
    [2.0, 1.5],
    [2.0, 1.0 / 1.5],
    [3.0, 2.4],
    [f64::INFINITY, 1.05],
    [f64::INFINITY, 3.0],
];

/// A white surface and a view in the furnace.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The surface.
    pub specimen: Specimen,
    /// Cosine of the view; below 0 it is from inside.
    pub cos_theta: f32,
    /// The share of light that returns.
    pub returned: f64,
    /// What one bounce returns, without compensation; for plastic, off the coat.
    pub single: f64,
    /// The mean weight of samples, for some rows.
    pub sampled: Option<Estimate>,
    /// The error that certificates state for what one bounce returns; `None` outside their domain.
    pub certified: Option<f64>,
}

impl Row {
    /// Whether all light returns, and no more than what is certified.
    pub fn passed(&self) -> bool {
        // Written so that a NaN fails.
        let most = self.certified.map_or(TOLERANCE, |error| error.min(TOLERANCE));
        -TOLERANCE <= self.returned - 1.0 && self.returned - 1.0 <= most && self.sampled_well()
    }

    /// The error of the mean of samples in standard errors, beyond the error of quadrature.
    pub fn standard_errors(&self) -> Option<f64> {
        // For mirrors the quadrature errs by up to 9e-5.
        const QUADRATURE: f64 = 1e-4;
        let Estimate { mean, error } = self.sampled?;
        let beyond = (mean - self.returned).abs() - QUADRATURE;
        // A NaN stays one, and fails.
        Some(if beyond <= 0.0 { 0.0 } else { beyond / error.max(1e-9) })
    }

    /// Whether samples agree with quadrature.
    fn sampled_well(&self) -> bool {
        self.standard_errors().is_none_or(|errors| errors <= ERRORS)
    }

    /// What the surface is, and from where it is seen.
    pub fn name(&self) -> &'static str {
        let Specimen { surface, haze, back, .. } = self.specimen;
        match surface {
            Surface::Dielectric(_) if haze.is_some() => NAMES[5],
            Surface::Dielectric(_) if self.cos_theta > 0.0 => NAMES[1],
            Surface::Dielectric(_) => NAMES[2],
            Surface::Plastic(..) => NAMES[3],
            _ if back > 0.0 => NAMES[6],
            _ if haze.is_some() => NAMES[4],
            _ => NAMES[0],
        }
    }
}

/// What [`Row::name`] returns.
pub const NAMES: [&str; 7] = [
    "mirror",
    "dielectric from outside",
    "dielectric from inside",
    "white plastic",
    "mirror with haze",
    "dielectric with haze",
    "mirror that sends light back",
];

/// Haze of the furnace; its σ is one of [`SIGMAS`].
const HAZE: HazeOf = HazeOf { weight: 0.4, sigma: [1.0; 2] };
/// The share of the light that goes back.
const BACK: f32 = 0.7;

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { specimen, cos_theta, returned, single, sampled, certified } = self;
        write!(f, "{specimen}; cos_theta {cos_theta}: 1 {:+.2e}", returned - 1.0)?;
        write!(f, ", of which one bounce {single:.5}")?;
        if let Some(error) = certified {
            write!(f, ", certified to {error:.1e}")?;
        }
        if let Some(Estimate { mean, error }) = sampled {
            write!(f, "; sampled {mean:.5} +- {error:.5}")?;
        }
        Ok(())
    }
}

/// The albedos for a furnace of these shapes and indices, at default quality.
///
/// # Errors
/// [`Unmade`] if they cannot be baked.
pub fn tables(pairs: &[[f64; 2]], masking: Masking, settings: Settings) -> Result<Tables, Unmade> {
    // A table for each roughness, since baking a range takes longer.
    let specimens: Vec<Specimen> = rows(pairs, masking).into_iter().map(|(one, _)| one).collect();
    specimen::tables(&specimens, Quality::Default, settings)
}

/// The rows of a survey: mirrors, dielectrics from both sides and white plastics, some with haze or
/// with light that goes back.
pub fn rows(pairs: &[[f64; 2]], masking: Masking) -> Vec<(Specimen, f32)> {
    let surfaces = |eta: f64| {
        let glass = Surface::Dielectric(eta);
        [
            (Surface::Mirror, 1.0, None, 0.0),
            (glass, 1.0, None, 0.0),
            (glass, -1.0, None, 0.0),
            (Surface::Plastic(eta, [1.0; 3]), 1.0, None, 0.0),
            (Surface::Mirror, 1.0, Some(HAZE), 0.0),
            (glass, 1.0, Some(HAZE), 0.0),
            (Surface::Mirror, 1.0, None, BACK),
        ]
    };
    let mut rows = Vec::new();
    for &[gamma, eta] in pairs {
        for (surface, side, haze, back) in surfaces(eta) {
            for sigma in SIGMAS {
                let lobe = if sigma == 0.0 { LobeOf::Smooth } else { LobeOf::StudentT };
                let compensation = Compensation::KullaConty;
                let sigma = [sigma; 2];
                let specimen =
                    Specimen { lobe, sigma, gamma, surface, masking, compensation, haze, back };
                rows.extend(VIEWS.map(|cos| (specimen, side * cos)));
            }
        }
    }
    rows
}

/// The estimated seconds of so many rows on the current threads.
pub fn seconds(rows: usize, samples: usize) -> f64 {
    // Microseconds of a row's quadrature, and of a sample, of which every fifth row has some: 12 s
    // for the 1,008 rows of `microfacet-bake bsdf --only furnace --threads 1`.
    on_threads(rows, 7_000.0 + 0.05 * samples as f64)
}

/// Runs the furnace for each row with the albedos of `tables`; every fifth row is also sampled.
///
/// # Errors
/// [`Unmade`] for a surface that cannot be made.
pub fn run(
    tables: &Tables,
    rows: &[(Specimen, f32)],
    samples: usize,
    seed: u64,
    stage: &Stage,
) -> Result<Vec<Row>, Unmade> {
    stage.split(rows.len());
    let one = |(i, &(specimen, cos)): (usize, &(Specimen, f32))| {
        let row = row(
            tables,
            specimen,
            cos,
            if i % 5 == 2 { samples } else { 0 },
            seed.wrapping_add(i as u64),
        );
        stage.step();
        row
    };
    rows.par_iter().enumerate().map(one).collect()
}

fn row(
    tables: &Tables,
    specimen: Specimen,
    cos_theta: f32,
    samples: usize,
    seed: u64,
) -> Result<Row, Unmade> {
    let whole = specimen.bsdf(tables)?;
    let v = direction(cos_theta);
    let parts = specimen.parts();
    let single = parts.iter().try_fold(0.0, |sum, (share, part)| {
        Ok(sum + f64::from(*share) * single(part, cos_theta)?)
    })?;
    // Of plastic only lights outside count: its coat's transmission is not returned.
    let sides: &[f32] =
        if matches!(specimen.surface, Surface::Dielectric(_)) { &[1.0, -1.0] } else { &[1.0] };
    let returned = single + broad(&whole, &specimen.facets().bsdf(tables)?, v, sides);
    let sampled = (samples > 0).then(|| sampled(&whole, v, samples, seed));
    let promised = cos_theta.abs() >= PROMISED && specimen.lobe != LobeOf::Smooth;
    let certified =
        || parts.iter().filter_map(|(_, part)| certified(tables, part)).reduce(f64::max);
    let certified = if promised { certified() } else { None };
    Ok(Row { specimen, cos_theta, returned, single, sampled, certified })
}

/// The light of one bounce off and through facets, by the model.
fn single(specimen: &Specimen, cos_theta: f32) -> Result<f64, Unmade> {
    let Specimen { sigma: [sigma, _], gamma, surface, masking, .. } = *specimen;
    let (sigma, cos) = (f64::from(sigma), f64::from(cos_theta.abs()));
    let unmade = |why: model::ParameterError| Unmade::new(specimen, &why);
    let shape = model::Shape::new(gamma).map_err(unmade)?;
    let integrator = model::AlbedoIntegrator::new(shape, 1e-6);
    let (eta, transmits) = match surface {
        Surface::Dielectric(eta) => (eta, true),
        Surface::Plastic(eta, _) => (eta, false),
        _ => {
            let [mirror] =
                integrator.reflection(sigma, cos, |_| [1.0]).map_err(unmade)?.of(masking);
            return Ok(mirror);
        }
    };
    // The index rounded to single precision, as in the BSDF.
    let eta = f64::from(eta as f32);
    let eta = if cos_theta > 0.0 { eta } else { 1.0 / eta };
    let pane = model::fresnel::Dielectric::new(eta).map_err(unmade)?;
    let [reflected, transmitted] =
        integrator.interface(sigma, cos, pane).map_err(unmade)?.of(masking);
    Ok(if transmits { reflected + transmitted } else { reflected })
}

/// ∫ (f of `whole` − f of `facets`) cos θ over the lights on some sides of the surface.
fn broad(whole: &AnyBsdf, facets: &AnyBsdf, v: Vec3, sides: &[f32]) -> f64 {
    over_lights(|sin, cos| {
        let more = |side: f32| {
            let l = Vec3::new(sin, 0.0, side * cos);
            let [f, g] = [whole, facets].map(|bsdf| bsdf.eval(v, l, Transport::Importance)[0]);
            f64::from(f) - f64::from(g)
        };
        sides.iter().map(|&side| more(side)).sum()
    })
}

fn sampled(bsdf: &AnyBsdf, v: Vec3, samples: usize, seed: u64) -> Estimate {
    let mut random = StdRng::seed_from_u64(seed);
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..samples {
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        let sample = bsdf.sample(v, choice, u, Transport::Importance);
        let weight = sample.map_or(0.0, |sample| f64::from(sample.weight[0]));
        (sum, squares) = (sum + weight, squares + weight * weight);
    }
    let n = samples as f64;
    let mean = sum / n;
    Estimate { mean, error: ((squares / n - mean * mean).max(0.0) / n).sqrt() }
}

/// The largest error that certificates state for the light of one bounce: for a dielectric the sum
/// of those of what it reflects and transmits.
fn certified(tables: &Tables, specimen: &Specimen) -> Option<f64> {
    // Tables hold the dense side's index over the thin side's.
    let index = match specimen.surface {
        Surface::Dielectric(eta) | Surface::Plastic(eta, _) => Some(eta.max(1.0 / eta)),
        _ => None,
    };
    let conductor = index.is_none();
    let embedded = Tables::embedded();
    let tables = if conductor { &embedded } else { tables };
    let lobe = LobeSpec::student_t([f64::from(specimen.sigma[0]); 2], specimen.gamma);
    let within = |Interval { min, max }: Interval, x: f64| {
        min * (1.0 - 1e-6) <= x && x <= max * (1.0 + 1e-6)
    };
    let read = tables.tables().iter().filter(|table| {
        let reflectance = table.subject.reflectance;
        let same = match index {
            Some(eta) => reflectance.and_then(|of| of.indices()).is_some_and(|of| within(of, eta)),
            None => reflectance == Some(Reflectance::Mirror),
        };
        table.kind == Kind::Albedo && same && table.subject.lobe.contains(&lobe)
    });
    let error = |table: &Table| -> f64 {
        let wanted = |of: &Quantity| !conductor || *of == Quantity::E;
        let errors = table.certificate.errors.iter().filter(|(of, _)| wanted(of));
        errors.map(|(_, errors)| errors.largest).sum()
    };
    read.map(error).reduce(f64::max)
}
