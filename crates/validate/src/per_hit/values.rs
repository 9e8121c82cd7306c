//! Errors of G1, D and the density of visible normals at random hits.

use glam::Vec3;
use rand::RngExt;

use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::{MaterialError, MicrofacetDistribution as _, Tables};
use microfacet_tables::{Kind, Quantity};

use super::Test;
use crate::stress::{Point, Worst, direction};

/// The quantities that are compared: an absolute error, and two relative ones.
pub const QUANTITIES: [&str; 3] = ["G1", "D", "density"];

/// One normal in this many is also a point at which values are compared.
const ONE_IN: usize = 8;
/// Errors of reading at a hit beyond those of the table: of G1, and a few ulp, which for densities
/// are multiplied by the exponent.
const G1: f64 = 2e-6;
const ULPS: f64 = 2e-6;
/// v·m has an error of an ulp, absolutely.
const FACING: f64 = 3e-7;
/// G1 at grazing is at most this wrong relative to itself, whatever its error may be.
const GRAZING: f64 = 1e-3;
/// The error of G1 of tables that were not measured.
const UNKNOWN: f64 = 1e-5;

/// The error of G1 that a set states.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed(f64);

impl Allowed {
    pub(super) fn of(tables: &Tables) -> Self {
        let of_g1 = tables.tables().iter().filter(|table| table.kind == Kind::Shadowing);
        let stated = of_g1.map(|table| table.certificate.error(Quantity::G1).unwrap_or(UNKNOWN));
        Self(stated.fold(0.0, f64::max) + G1)
    }
}

/// The largest errors of [`QUANTITIES`], and the largest shares of what is allowed where they are:
/// for G1 the error that the set states and 2e-6, for D 2e-6 (1 + |ln D σxσy|), and for the density
/// both, relative to G1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Values {
    /// The largest errors.
    pub errors: [Worst; 3],
    /// The largest shares of what is allowed.
    pub shares: [f64; 3],
}

impl Values {
    fn see(&mut self, i: usize, error: f64, allowed: f64, at: &Point) {
        self.errors[i].see(error, at);
        self.shares[i] = larger(self.shares[i], error / allowed);
    }

    pub(super) fn are_allowed(&self) -> bool {
        self.shares.iter().all(|share| *share <= 1.0)
    }

    /// The larger errors and shares of both.
    pub fn merge(&mut self, other: &Self) {
        for i in 0..QUANTITIES.len() {
            self.errors[i].see(other.errors[i].value, &other.errors[i].at);
            self.shares[i] = larger(self.shares[i], other.shares[i]);
        }
    }
}

/// The larger of two numbers; a NaN counts as the largest.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

impl Test<'_> {
    /// Values at random hits, one in eight at an end of the range of γ, where tables fail first.
    pub(super) fn values(&mut self, Allowed(g1_error): Allowed) -> Result<Values, MaterialError> {
        let mut values = Values::default();
        for i in 0..self.options.samples.div_ceil(ONE_IN) {
            let mut places = self.mixture.places(&mut self.random);
            match i % 16 {
                0 => places[0] = 0.0,
                1 => places[0] = 1.0,
                _ => (),
            }
            let hit = self.mixture.hit(places, &mut self.random);
            let v = direction(self.theta, hit.phi);
            let u = [self.random.random(), self.random.random()];
            let (lobe, truth) = (self.family.at(hit.sigma, hit.gamma), self.truth(&hit)?);
            let (sigma, gamma) = (lobe.sigma(), lobe.gamma());
            let at = Point { sigma, gamma, theta: self.theta, phi: hit.phi, u };
            let m = Vec3::from(lobe.sample_visible_normal(v, u));
            let (exact_v, exact_m) = (v.as_dvec3(), m.as_dvec3());

            let g1 = truth.g1(exact_v);
            values.see(0, (f64::from(lobe.g1(v)) - g1).abs(), g1_error, &at);

            let d = truth.d(exact_m);
            // Single precision holds no more.
            if !(1e-30..1e30).contains(&d) {
                continue;
            }
            let rounding = ULPS * (1.0 + (d * f64::from(sigma[0] * sigma[1])).ln().abs());
            let relative = |got: f32, want: f64| (f64::from(got) / want - 1.0).abs();
            values.see(1, relative(lobe.d(m), d), rounding, &at);

            let facing = exact_v.dot(exact_m);
            let pdf = truth.visible_normal_pdf(exact_v, exact_m);
            // At the silhouette v·m is mostly rounding.
            if facing > 1e-3 && (1e-30..1e30).contains(&pdf) {
                let allowed = (g1_error / g1).min(GRAZING) + rounding + FACING / facing;
                values.see(2, relative(lobe.visible_normal_pdf(v, m), pdf), allowed, &at);
            }
        }
        Ok(values)
    }
}
