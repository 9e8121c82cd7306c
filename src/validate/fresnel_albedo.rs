//! Errors of albedo tables under an exact Fresnel term, as for those of moments.

use std::collections::BTreeMap;

use rayon::prelude::*;

use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_sampler::{BindError, FresnelAlbedo, FresnelEntry, MaterialEntry, Provenance, Table, Tables};

use super::albedo::{TOLERANCE, gammas, model_masking, outside, place, points_at, stated};
use super::certificate::round_up;
use crate::bake::albedo::Domain;
use crate::bake::fresnel_albedo::Reflectances;

/// The table with its certificate: the largest error of any channel, and its root mean square over points and channels.
///
/// # Errors
/// [`BindError`] if the table does not cover the domain.
pub fn certified(table: Table, domain: Domain, fresnel: &FresnelEntry) -> Result<Table, BindError> {
    let gammas = gammas(&table, domain);
    let points = points_at(gammas.len());
    let masking = table.masking.expect("validated on load");
    let reflectances = Reflectances::new(fresnel).map_err(|_| BindError::NoTable(table.name.clone()))?;
    let errors = gammas
        .par_iter()
        .enumerate()
        .map(|(i, &gamma)| {
            let model =
                AlbedoIntegrator::new(Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?, TOLERANCE);
            let point = |i| {
                let (sigma, cos) = place(i, domain.sigma);
                let exact = reflectances.albedo(&model, sigma, f64::from(cos));
                let exact = exact.map_err(|_| BindError::Sigma(sigma as f32))?.of(model_masking(masking));
                let got = read(&table, fresnel, sigma, gamma, cos)?;
                let error = got.iter().zip(exact).map(|(got, exact)| (f64::from(*got) - exact).abs());
                Ok((error.collect(), outside(sigma, cos)))
            };
            (i * points..(i + 1) * points).map(point).collect()
        })
        .collect::<Result<Vec<Vec<(Vec<f64>, bool)>>, BindError>>()?;
    let largest = |outside: bool| {
        let part = errors.iter().flatten().filter(move |point| point.1 == outside);
        part.flat_map(|point| &point.0).copied().fold(0.0, f64::max)
    };
    let inside = || errors.iter().flatten().filter(|point| !point.1).flat_map(|point| &point.0);
    let rms = (inside().map(|error| error * error).sum::<f64>() / inside().count() as f64).sqrt();
    let mut certificate: BTreeMap<String, f64> = table.certificate.clone();
    certificate.extend([
        ("e_max_error".to_owned(), round_up(largest(false))),
        ("e_rms_error".to_owned(), round_up(rms)),
        ("e_max_error_outside".to_owned(), round_up(largest(true))),
        ("points".to_owned(), errors.iter().flatten().count() as f64),
    ]);
    certificate.extend(stated(domain));
    Ok(Table { certificate, ..table })
}

/// What a renderer reads for a material of this σ and γ.
fn read(
    table: &Table,
    fresnel: &FresnelEntry,
    sigma: f64,
    gamma: f64,
    cos: f32,
) -> Result<Vec<f32>, BindError> {
    let entry = MaterialEntry {
        name: String::new(),
        sigma: [[sigma; 2]; 2],
        s: [1.0 / (gamma - 1.0); 2],
        distribution: String::new(),
        masking: table.masking,
        fresnel: Some(*fresnel),
    };
    let provenance = Provenance { materials: vec![entry], ..Provenance::default() };
    let set = Tables::from_tables(provenance, vec![table.clone()])
        .map_err(|why| BindError::NoTable(why.to_string()))?;
    Ok(match set.material_fresnel_albedo("")? {
        FresnelAlbedo::Conductor(rgb) => rgb.eval(cos).into(),
        FresnelAlbedo::Dielectric(sides) => sides.eval(cos).into(),
    })
}
