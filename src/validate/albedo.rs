//! Errors of albedo tables between their nodes, through the run-time lookup, against the model's quadrature.

use std::collections::BTreeMap;

use rayon::prelude::*;

use microfacet_model::{AlbedoIntegrator, Masking as ModelMasking, Shape};
use microfacet_sampler::{BindError, GRAZING_FLOOR, Kind, Masking, Table, Tables};

use super::certificate::{low_discrepancy, round_up};
use crate::bake::albedo::weights;

/// Accuracy of the model's values that tables are judged by.
const TOLERANCE: f64 = 1e-7;
/// Views and roughnesses measured at each γ.
const POINTS: usize = 96;
/// Smallest σ and cos θ of the domain that the figures are promised for.
const DOMAIN: (f64, f64) = (0.01, 0.02);

/// Figures of one table, rounded up to three digits; those a bake has left there are kept.
pub(super) fn measure(tables: &Tables, table: &Table) -> Result<BTreeMap<String, f64>, BindError> {
    let mut figures = table.certificate.clone();
    let masking = table.masking.expect("validated on load");
    let errors = gammas(table)
        .par_iter()
        .enumerate()
        .map(|(i, &gamma)| match table.kind {
            Kind::Albedo => directional(tables, table, masking, gamma, i),
            _ => averages(tables, table, masking, gamma, i),
        })
        .collect::<Result<Vec<_>, BindError>>()?;
    let all: Vec<Point> = errors.into_iter().flatten().collect();
    let inside = || all.iter().filter(|point| !point.grazing);
    for (i, name) in ["scale", "bias", "f82", "e"].into_iter().enumerate() {
        let worst = inside().max_by(|a, b| a.error[i].total_cmp(&b.error[i])).expect("points were measured");
        let sum: f64 = inside().map(|point| point.error[i] * point.error[i]).sum();
        figures.insert(format!("{name}_max_error"), round_up(worst.error[i]));
        figures.insert(format!("{name}_rms_error"), round_up((sum / inside().count() as f64).sqrt()));
        if name == "e" {
            figures.insert("worst_sigma".into(), worst.at[0]);
            figures.insert("worst_s".into(), 1.0 / (worst.at[1] - 1.0));
            if table.kind == Kind::Albedo {
                figures.insert("worst_cos_theta".into(), worst.at[2]);
            }
        }
    }
    let grazing = all.iter().filter(|point| point.grazing).map(|point| point.error[3]).fold(0.0, f64::max);
    if table.kind == Kind::Albedo {
        figures.insert("e_max_error_grazing".into(), round_up(grazing));
    }
    figures.insert("points".into(), all.len() as f64);
    Ok(figures)
}

/// Errors of scale, bias, F82 and E at one (σ, γ, cos θ).
struct Point {
    error: [f64; 4],
    at: [f64; 3],
    /// Outside the domain of the figures: cos θ below 0.02.
    grazing: bool,
}

/// Shapes to measure at: two between every two nodes, and the nodes.
fn gammas(table: &Table) -> Vec<f64> {
    let axis = &table.axes[0];
    let nodes = &axis.nodes;
    let between = nodes.windows(2).flat_map(|pair| [0.31, 0.57].map(|w| pair[0] + w * (pair[1] - pair[0])));
    nodes.iter().copied().chain(between).filter_map(|t| axis.quantity(t)).collect()
}

fn largest_sigma(table: &Table) -> f64 {
    let axis = &table.axes[1];
    axis.quantity(axis.nodes[axis.nodes.len() - 1]).expect("validated on load")
}

/// σ log-uniform over the domain for one half of the numbers, uniform for the other.
fn sigma_at(x: f64, largest: f64) -> f64 {
    let low = DOMAIN.0;
    let sigma = if x < 0.5 {
        low * libm::pow(largest / low, 2.0 * x)
    } else {
        low + (largest - low) * (2.0 * x - 1.0)
    };
    sigma.clamp(low.min(largest), largest)
}

fn model_masking(masking: Masking) -> ModelMasking {
    match masking {
        Masking::Uncorrelated => ModelMasking::Uncorrelated,
        Masking::HeightCorrelated => ModelMasking::HeightCorrelated,
    }
}

fn directional(
    tables: &Tables,
    table: &Table,
    masking: Masking,
    gamma: f64,
    index: usize,
) -> Result<Vec<Point>, BindError> {
    let shape = Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?;
    let model = AlbedoIntegrator::new(shape, TOLERANCE);
    (0..POINTS)
        .map(|i| {
            let [a, b] = low_discrepancy(index * POINTS + i);
            let sigma = sigma_at(a, largest_sigma(table));
            // A half over the cosine, a quarter logarithmic, an eighth near the normal and an eighth below the domain.
            let cos = match i % 8 {
                0 => GRAZING_FLOOR * libm::pow(DOMAIN.1 / GRAZING_FLOOR, b),
                1 => 1.0 - 0.02 * b * b,
                2 | 3 => libm::pow(DOMAIN.1, b),
                _ => DOMAIN.1 + (1.0 - DOMAIN.1) * b,
            } as f32;
            let exact = model
                .reflection(sigma, f64::from(cos), weights)
                .map_err(|_| BindError::Sigma(sigma as f32))?
                .of(model_masking(masking));
            let got = tables.albedo(sigma, gamma, masking)?.moments(cos);
            let got = [got.scale, got.bias, got.f82].map(f64::from);
            let error = |i: usize| (got[i] - exact[i]).abs();
            let total = (got[0] + got[1] - exact[0] - exact[1]).abs();
            let grazing = f64::from(cos) < DOMAIN.1;
            Ok(Point {
                error: [error(0), error(1), error(2), total],
                at: [sigma, gamma, f64::from(cos)],
                grazing,
            })
        })
        .collect()
}

/// Averages against quadrature of the directional albedo at the same material: what a furnace sees.
fn averages(
    tables: &Tables,
    table: &Table,
    masking: Masking,
    gamma: f64,
    index: usize,
) -> Result<Vec<Point>, BindError> {
    (0..POINTS / 4)
        .map(|i| {
            let sigma = sigma_at(low_discrepancy(index * POINTS + i)[0], largest_sigma(table));
            let albedo = tables.albedo(sigma, gamma, masking)?;
            let (got, exact) = (albedo.average_rest(), albedo.integrate());
            let [scale, bias, f82] = [0, 1, 2].map(|i| f64::from((got[i] - exact[i]).abs()));
            let total = f64::from((got[0] + got[1] - exact[0] - exact[1]).abs());
            Ok(Point { error: [scale, bias, f82, total], at: [sigma, gamma, f64::NAN], grazing: false })
        })
        .collect()
}
