//! Errors of albedo tables between their nodes, through the run-time lookup, against the model's quadrature.

use std::collections::BTreeMap;

use rayon::prelude::*;

use microfacet_common::shape::s_of_gamma;
use microfacet_model::{Albedo, AlbedoIntegrator, Shape};
use microfacet_sampler::axis::LogRoughness;
use microfacet_sampler::{BindError, Kind, Masking, Table, Tables};

use super::certificate::{low_discrepancy, round_up};
use crate::bake::albedo::{Domain, weights};
use crate::scene::Interval;

/// Accuracy of the model's values that tables are judged by.
pub(super) const TOLERANCE: f64 = 1e-7;
/// Views and roughnesses measured at each γ.
const POINTS: usize = 96;
/// So many are measured of the fewest shapes.
const LEAST: usize = 480;
/// Smallest σ and cos θ of the domain that the figures are promised for.
pub(super) const DOMAIN: (f64, f64) = (0.01, 0.02);
/// Smallest σ that is no mirror.
const SMOOTHEST: f64 = LogRoughness::BAKED.first;

/// Figures of one table, rounded up to three digits; those a bake has left there are kept.
fn measure(
    tables: &Tables,
    table: &Table,
    domain: Domain,
    references: &[Vec<Reference>],
) -> Result<BTreeMap<String, f64>, BindError> {
    let mut figures = table.certificate.clone();
    let masking = table.masking.expect("validated on load");
    let errors = references
        .par_iter()
        .map(|references| match table.kind {
            Kind::Albedo => references.iter().map(|at| directional(tables, masking, at, domain)).collect(),
            _ => references.iter().step_by(4).map(|at| average(tables, masking, at, domain)).collect(),
        })
        .collect::<Result<Vec<Vec<Point>>, BindError>>()?;
    let all: Vec<Point> = errors.into_iter().flatten().collect();
    let inside = || all.iter().filter(|point| !point.outside);
    for (i, name) in ["scale", "bias", "f82", "e"].into_iter().enumerate() {
        let worst = inside().max_by(|a, b| a.error[i].total_cmp(&b.error[i])).expect("points were measured");
        let sum: f64 = inside().map(|point| point.error[i] * point.error[i]).sum();
        figures.insert(format!("{name}_max_error"), round_up(worst.error[i]));
        figures.insert(format!("{name}_rms_error"), round_up((sum / inside().count() as f64).sqrt()));
        if name == "e" {
            figures.insert("worst_sigma".into(), worst.at[0]);
            figures.insert("worst_s".into(), s_of_gamma(worst.at[1]));
            if table.kind == Kind::Albedo {
                figures.insert("worst_cos_theta".into(), worst.at[2]);
            }
        }
    }
    let outside = all.iter().filter(|point| point.outside).map(|point| point.error[3]).fold(0.0, f64::max);
    if table.kind == Kind::Albedo {
        figures.insert("e_max_error_outside".into(), round_up(outside));
    }
    figures.insert("points".into(), all.len() as f64);
    figures.extend(stated(domain));
    Ok(figures)
}

/// What a certificate says of the domain it is about, unless that is everything.
pub(super) fn stated(domain: Domain) -> BTreeMap<String, f64> {
    let mut figures = BTreeMap::new();
    if domain != Domain::GENERAL {
        let ends = [("s_min", s_of_gamma(domain.gamma.max)), ("s_max", s_of_gamma(domain.gamma.min))];
        let sigmas = [("sigma_min", domain.sigma.min), ("sigma_max", domain.sigma.max)];
        figures.extend(ends.into_iter().chain(sigmas).map(|(key, value)| (key.into(), value)));
    }
    figures
}

/// Errors of scale, bias, F82 and E at one (σ, γ, cos θ).
struct Point {
    error: [f64; 4],
    at: [f64; 3],
    /// Outside the domain of the figures: cos θ below 0.02.
    outside: bool,
}

/// Adds to each table of a set of albedos the errors measured on it, over the domain it was baked for.
///
/// # Errors
/// [`BindError`] if the tables do not cover the domain.
pub fn certify(tables: &mut Tables, domain: Domain) -> Result<(), BindError> {
    certify_all(std::slice::from_mut(tables), domain)
}

/// The same for sets with the same nodes, such as one set in several precisions: what they are judged by is integrated once.
///
/// # Errors
/// As [`certify`].
pub fn certify_all(sets: &mut [Tables], domain: Domain) -> Result<(), BindError> {
    let Some(first) = sets.first().and_then(|set| set.table(Kind::Albedo)) else { return Ok(()) };
    let gammas = gammas(first, domain);
    let points = points_at(gammas.len());
    // Once for both forms of masking.
    let references = gammas
        .par_iter()
        .enumerate()
        .map(|(i, &gamma)| {
            let model =
                AlbedoIntegrator::new(Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?, TOLERANCE);
            let reference = |i| {
                let (sigma, cos) = place(i, domain.sigma);
                let exact = model.reflection(sigma, f64::from(cos), weights);
                let exact = exact.map_err(|_| BindError::Sigma(sigma as f32))?;
                Ok(Reference { gamma, sigma, cos, exact })
            };
            (i * points..(i + 1) * points).map(reference).collect()
        })
        .collect::<Result<Vec<Vec<Reference>>, BindError>>()?;
    for set in sets {
        let measured = set.tables().iter().map(|table| measure(set, table, domain, &references));
        let figures: Vec<_> = measured.collect::<Result<_, _>>()?;
        figures.into_iter().enumerate().for_each(|(i, figures)| set.set_certificate(i, figures));
    }
    Ok(())
}

/// Points at each of `shapes` measured shapes.
pub(super) fn points_at(shapes: usize) -> usize {
    POINTS.max(LEAST / shapes)
}

/// Albedos integrated to measure tables with so many γ nodes.
pub(crate) fn points(nodes: usize) -> usize {
    let shapes = 3 * nodes - 2;
    shapes * points_at(shapes)
}

/// What the model says of one material and view.
struct Reference {
    gamma: f64,
    sigma: f64,
    cos: f32,
    exact: Albedo<3>,
}

/// Shapes to measure at: two between every two nodes, and the nodes, as far as they are in the domain; and its ends.
pub(super) fn gammas(table: &Table, domain: Domain) -> Vec<f64> {
    let Interval { min, max } = domain.gamma;
    let axis = &table.axes[0];
    let nodes = &axis.nodes;
    let between = nodes.windows(2).flat_map(|pair| [0.31, 0.57].map(|w| pair[0] + w * (pair[1] - pair[0])));
    let all = nodes.iter().copied().chain(between).filter_map(|t| axis.quantity(t));
    let mut all: Vec<f64> = all.filter(|gamma| *gamma > min && *gamma < max).chain([min, max]).collect();
    all.dedup();
    all
}

/// σ log-uniform over the domain for one half of the numbers, uniform for the other; from 0.01 on where the domain goes on.
fn sigma_at(x: f64, Interval { min, max }: Interval) -> f64 {
    let low = DOMAIN.0.min(max).max(min);
    let sigma =
        if x < 0.5 { low * libm::pow(max / low, 2.0 * x) } else { low + (max - low) * (2.0 * x - 1.0) };
    sigma.clamp(low, max)
}

/// σ and cos θ of the i-th point.
pub(super) fn place(i: usize, sigma: Interval) -> (f64, f32) {
    let [a, b] = low_discrepancy(i);
    // An eighth outside the domain: grazing, and of these a half of surfaces smoother than it, seen where they mask.
    let sigma = match i % 16 {
        8 if sigma.min <= SMOOTHEST => DOMAIN.0 * libm::pow(SMOOTHEST / DOMAIN.0, a),
        _ => sigma_at(a, sigma),
    };
    // A half over the cosine, a quarter logarithmic and an eighth near the normal.
    let cos = match i % 8 {
        0 => {
            let grazing = 1e-5 * sigma.min(0.1);
            grazing * libm::pow(DOMAIN.1 / grazing, b)
        }
        1 => 1.0 - 0.02 * b * b,
        2 | 3 => libm::pow(DOMAIN.1, b),
        _ => DOMAIN.1 + (1.0 - DOMAIN.1) * b,
    };
    (sigma, cos as f32)
}

/// Whether a point is outside what the figures are promised for. Where all materials are smoother than that, it is the roughest that counts: without
/// a point there would be no figures.
pub(super) fn outside(sigma: f64, cos: f32, materials: Interval) -> bool {
    f64::from(cos) < DOMAIN.1 || sigma < DOMAIN.0.min(materials.max)
}

fn directional(
    tables: &Tables,
    masking: Masking,
    at: &Reference,
    domain: Domain,
) -> Result<Point, BindError> {
    let &Reference { gamma, sigma, cos, exact } = at;
    let exact = exact.of(masking);
    let got = tables.albedo(sigma, gamma, masking)?.moments(cos);
    let got = [got.scale, got.bias, got.f82].map(f64::from);
    let error = |i: usize| (got[i] - exact[i]).abs();
    let total = (got[0] + got[1] - exact[0] - exact[1]).abs();
    let error = [error(0), error(1), error(2), total];
    Ok(Point { error, at: [sigma, gamma, f64::from(cos)], outside: outside(sigma, cos, domain.sigma) })
}

/// Averages against quadrature of the directional albedo at the same material: what a furnace sees.
fn average(tables: &Tables, masking: Masking, at: &Reference, domain: Domain) -> Result<Point, BindError> {
    let &Reference { gamma, sigma, .. } = at;
    let got = tables.average_moments(sigma, gamma, masking)?;
    let exact = tables.albedo(sigma, gamma, masking)?.average_moments();
    let error = |a: f32, b: f32| f64::from((a - b).abs());
    let (scale, bias) = (error(got.scale, exact.scale), error(got.bias, exact.bias));
    let (f82, total) = (error(got.f82, exact.f82), error(got.total(), exact.total()));
    Ok(Point {
        error: [scale, bias, f82, total],
        at: [sigma, gamma, f64::NAN],
        outside: outside(sigma, 1.0, domain.sigma),
    })
}
