//! Errors of the tables of a distribution outside the family, through the run-time sampler, against quadrature.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use microfacet_model::classic::{Marginal, MarginalView};
use microfacet_sampler::{Kind, LoadError, MaterialEntry, Provenance, Radial, Table, Tables};
use rayon::prelude::*;

use super::certificate::{low_discrepancy, round_up};

/// Views, and normals drawn at each.
const VIEWS: usize = 200;
const NORMALS: usize = 40;
/// Normals drawn for a certificate.
pub(crate) const POINTS: usize = VIEWS * NORMALS;

/// Largest errors seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// Of G1.
    pub g1: f64,
    /// Of the CDF of the in-plane slope.
    pub along: f64,
    /// Of the CDF of the slope across.
    pub across: f64,
    /// Of D/D(0).
    pub density: f64,
}

impl Errors {
    fn worse(self, other: Self) -> Self {
        Self {
            g1: self.g1.max(other.g1),
            along: self.along.max(other.along),
            across: self.across.max(other.across),
            density: self.density.max(other.density),
        }
    }
}

/// Measures a bound material against the distribution it was baked from.
pub fn measure(radial: &Radial, marginal: &Marginal) -> Errors {
    let at_view = |i: usize| {
        let theta = (i as f64 + 0.37) / VIEWS as f64 * std::f64::consts::FRAC_PI_2;
        let (sin, cos) = (libm::sin(theta), libm::cos(theta));
        let v = Vec3::new(sin as f32, 0.0, cos as f32);
        let (tangent, sigma) = (f64::from(v.x) / f64::from(v.z), marginal.sigma());
        let exact = MarginalView::new(marginal, 1.0 / (tangent * sigma));
        let mut worst = Errors {
            g1: (f64::from(radial.g1(v)) - marginal.g1(theta)).abs(),
            density: ((f64::from(radial.d(v)) - marginal.d(tangent / sigma)) / marginal.d(0.0)).abs(),
            ..Errors::default()
        };
        for j in 0..NORMALS {
            let u = low_discrepancy(i * NORMALS + j);
            let DVec3 { x, y, z } = radial.sample_visible_normal(v, u.map(|u| u as f32)).as_dvec3();
            let (x, y) = (x / (z * marginal.sigma()), y / (z * marginal.sigma()));
            let tail = marginal.across_at(x.abs()).tail(y.abs());
            let across = if y < 0.0 { tail } else { 1.0 - tail };
            worst.along = worst.along.max((exact.shares(x).below - u[0]).abs());
            worst.across = worst.across.max((across - u[1]).abs());
        }
        worst
    };
    (0..VIEWS).into_par_iter().map(at_view).reduce(Errors::default, Errors::worse)
}

/// Writes what [`measure`] finds into the four tables of one distribution.
///
/// # Errors
/// [`LoadError::Invalid`] if the tables do not bind.
pub fn certify(tables: &mut [Table], entry: &MaterialEntry, marginal: &Marginal) -> Result<(), LoadError> {
    let provenance = Provenance { materials: vec![entry.clone()], ..Provenance::default() };
    let radial = Tables::from_tables(provenance, tables.to_vec())?
        .radial(&entry.name)
        .map_err(|why| LoadError::Invalid(why.to_string()))?;
    let errors = measure(&radial, marginal);
    for table in tables {
        let (key, error) = match table.kind {
            Kind::RadialShadowing => ("g1_max_error", errors.g1),
            Kind::RadialSlope => ("cdf_max_error", errors.along),
            Kind::RadialConditional => ("cdf_max_error", errors.across),
            _ => ("d_max_error", errors.density),
        };
        let points = if key == "cdf_max_error" { POINTS } else { VIEWS };
        table.certificate = BTreeMap::from([(key.into(), round_up(error)), ("points".into(), points as f64)]);
    }
    Ok(())
}
