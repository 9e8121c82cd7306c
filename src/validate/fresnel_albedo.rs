//! Errors of albedo tables under an exact Fresnel term, as for those of moments.

use std::collections::BTreeMap;

use rayon::prelude::*;

use microfacet_common::shape::s_of_gamma;
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use microfacet_sampler::{
    Axis, BindError, FresnelAlbedo, FresnelEntry, Masking, MaterialEntry, Provenance, Table, Tables,
};

use super::albedo::{gammas, outside, place, points_at, stated};
use super::certificate::{low_discrepancy, round_up};
use crate::bake::albedo::Domain;
use crate::bake::dielectric_albedo::Side;
use crate::bake::fresnel_albedo::Metal;

/// Accuracy of the model's values that tables are judged by; more would take seconds at a kink.
const TOLERANCE: f64 = 1e-6;
/// Each table is measured at this share of the points of one of moments.
const SHARE: usize = 2;

/// The table with its certificate: the largest error of any channel, and its root mean square over points and channels.
///
/// # Errors
/// [`BindError`] if the table does not cover the domain.
pub fn certified(table: Table, domain: Domain, fresnel: &FresnelEntry) -> Result<Table, BindError> {
    let gammas = gammas(&table, domain);
    let points = points_at(gammas.len()) / SHARE;
    let masking = table.masking.expect("validated on load");
    let surface = Surface::new(fresnel, &table).map_err(|_| BindError::NoTable(table.name.clone()))?;
    let errors = gammas
        .par_iter()
        .enumerate()
        .map(|(i, &gamma)| {
            let model =
                AlbedoIntegrator::new(Shape::new(gamma).map_err(|_| BindError::Gamma(gamma))?, TOLERANCE);
            let point = |i| {
                let (sigma, cos) = place(i, domain.sigma);
                let eta = surface.index(i);
                let exact = surface.albedo(&model, masking, [sigma, eta], f64::from(cos));
                let exact = exact.map_err(|_| BindError::Sigma(sigma as f32))?;
                let got = surface.read(&table, [sigma, gamma, eta], cos)?;
                let error = got.iter().zip(exact).map(|(got, exact)| (f64::from(*got) - exact).abs());
                let at = [sigma, gamma, f64::from(cos), eta];
                Ok(Point { error: error.collect(), at, outside: outside(sigma, cos, domain.sigma) })
            };
            (i * points..(i + 1) * points).map(point).collect()
        })
        .collect::<Result<Vec<Vec<Point>>, BindError>>()?;
    let part = |outside: bool| errors.iter().flatten().filter(move |point| point.outside == outside);
    let worst = part(false).max_by(|a, b| a.largest().total_cmp(&b.largest())).expect("points were measured");
    let squares: Vec<f64> = part(false).flat_map(|point| &point.error).map(|error| error * error).collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let mut certificate: BTreeMap<String, f64> = table.certificate.clone();
    certificate.extend([
        ("e_max_error".to_owned(), round_up(worst.largest())),
        ("e_rms_error".to_owned(), round_up(rms)),
        ("e_max_error_outside".to_owned(), round_up(part(true).map(Point::largest).fold(0.0, f64::max))),
        ("points".to_owned(), errors.iter().flatten().count() as f64),
        ("worst_sigma".to_owned(), worst.at[0]),
        ("worst_s".to_owned(), s_of_gamma(worst.at[1])),
        ("worst_cos_theta".to_owned(), worst.at[2]),
    ]);
    if worst.at[3].is_finite() {
        certificate.insert("worst_eta".to_owned(), worst.at[3]);
    }
    certificate.extend(stated(domain));
    Ok(Table { certificate, ..table })
}

/// Errors of the channels at one (σ, γ, cos θ, η).
struct Point {
    error: Vec<f64>,
    at: [f64; 4],
    outside: bool,
}

impl Point {
    fn largest(&self) -> f64 {
        self.error.iter().copied().fold(0.0, f64::max)
    }
}

/// What a table is of.
enum Surface {
    Metal(Metal, FresnelEntry),
    /// The axis of indices, and the first and the last of them.
    Interface(Side, Axis, [f64; 2]),
}

impl Surface {
    fn new(fresnel: &FresnelEntry, table: &Table) -> Result<Self, ParameterError> {
        Ok(match Metal::new(fresnel)? {
            Some(metal) => Self::Metal(metal, *fresnel),
            None => {
                let ends = fresnel.indices().ok_or(ParameterError::Eta(f64::NAN))?;
                let side = Side::ALL.into_iter().find(|side| table.channels == side.channels());
                Self::Interface(side.ok_or(ParameterError::Eta(f64::NAN))?, table.axes[2].clone(), ends)
            }
        })
    }

    /// The index of refraction, ≥ 1, of the i-th point.
    fn index(&self, i: usize) -> f64 {
        let Self::Interface(_, axis, ends) = self else { return f64::NAN };
        if ends[0] == ends[1] {
            return ends[0];
        }
        let [first, last] = ends.map(|eta| axis.coordinate(eta).unwrap_or(f64::NAN));
        // Apart from the directions in which the other coordinates go; not at the ends of the domain, of which one has no index.
        let [x, _] = low_discrepancy(7 * i + 3);
        let t = (first + x * (last - first)).clamp(1e-4, 1.0 - 1e-4);
        axis.quantity(t).unwrap_or(f64::NAN)
    }

    fn albedo(
        &self,
        model: &AlbedoIntegrator,
        masking: Masking,
        [sigma, eta]: [f64; 2],
        cos: f64,
    ) -> Result<Vec<f64>, ParameterError> {
        Ok(match self {
            Self::Metal(metal, _) => metal.albedo(model, sigma, cos)?.of(masking).into(),
            Self::Interface(side, ..) => side.albedo(model, sigma, eta, cos)?.of(masking).into(),
        })
    }

    /// What a renderer reads.
    fn read(&self, table: &Table, [sigma, gamma, eta]: [f64; 3], cos: f32) -> Result<Vec<f32>, BindError> {
        let fresnel = if let Self::Metal(_, fresnel) = self { Some(*fresnel) } else { None };
        let entry = MaterialEntry {
            name: String::new(),
            sigma: [[sigma; 2]; 2],
            s: [s_of_gamma(gamma); 2],
            distribution: String::new(),
            theta: None,
            masking: table.masking,
            fresnel,
        };
        let provenance = Provenance { materials: vec![entry], ..Provenance::default() };
        let set = Tables::from_tables(provenance, vec![table.clone()])
            .map_err(|why| BindError::NoTable(why.to_string()))?;
        let masking = table.masking.expect("validated on load");
        Ok(match self {
            Self::Interface(side, ..) => {
                let eta = if *side == Side::Leaving { 1.0 / eta } else { eta };
                set.interface_albedo(sigma, gamma, eta, masking)?.eval(cos).into()
            }
            Self::Metal(..) => match set.material_fresnel_albedo("")? {
                FresnelAlbedo::Conductor(rgb) => rgb.eval(cos).into(),
                FresnelAlbedo::Dielectric(_) => unreachable!("the entry is a conductor's"),
            },
        })
    }
}
