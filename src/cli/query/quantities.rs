//! Quantities at a point, from the tables and from the model.

use std::collections::HashMap;
use std::fmt::{Display, LowerExp};
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec3, Vec3};

use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::fresnel::schlick_weight;
use microfacet_sampler::albedo::Moments;
use microfacet_sampler::{Masking, MicrofacetDistribution as _, StudentT, Tables};
use microfacet_validate::furnace::direction;

use super::Method;
use crate::cli::values::Unit;
use crate::cli::{Result, anyhow, bail};

/// A quantity that `query` computes at a point.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    D,
    G1,
    Normal,
    Albedo,
    AlbedoAverage,
}

impl Quantity {
    /// The columns that a quantity reads, and those that it appends, each followed by the method.
    pub(super) fn columns(self) -> [&'static [&'static str]; 2] {
        match self {
            Self::D => [&["sigma_x", "sigma_y", "gamma", "theta", "phi"], &["d"]],
            Self::G1 => [&["sigma_x", "sigma_y", "gamma", "theta", "phi"], &["lambda", "g1"]],
            Self::Normal => [
                &["sigma_x", "sigma_y", "gamma", "theta", "phi", "u1", "u2"],
                &["m_x", "m_y", "m_z", "pdf"],
            ],
            Self::Albedo => [
                &["sigma", "gamma", "cos_theta", "masking"],
                &["E", "schlick_scale", "schlick_bias"],
            ],
            Self::AlbedoAverage => [&["sigma", "gamma", "masking"], &["E_avg"]],
        }
    }
}

/// A quantity, the tables, and the model's integrators for the shapes that were queried last.
pub(super) struct Known {
    quantity: Quantity,
    unit: Unit,
    set: Tables,
    integrators: Mutex<HashMap<u64, Arc<model::AlbedoIntegrator>>>,
}

/// Tolerance of the model's albedos.
const EXACT: f64 = 1e-10;
/// Number of shapes whose integrators are kept; repeated rows of one shape are then computed twice
/// as fast.
const SHAPES: usize = 64;

impl Known {
    pub(super) fn new(quantity: Quantity, unit: Unit, set: Tables) -> Self {
        Self { quantity, unit, set, integrators: Mutex::default() }
    }

    /// The name of the unit of angles.
    pub(super) fn angles(&self) -> &'static str {
        self.unit.angles().name()
    }

    /// The quantity at the point of a row, in the columns that it appends.
    pub(super) fn values(&self, fields: &[&str], method: Method) -> Result<Vec<String>> {
        match self.quantity {
            Quantity::D => self.d(&self.point(fields)?, method),
            Quantity::G1 => self.g1(&self.point(fields)?, method),
            Quantity::Normal => self.normal(&self.point(fields)?, method),
            Quantity::Albedo => self.albedo(fields, method),
            Quantity::AlbedoAverage => self.albedo_average(fields, method),
        }
    }

    /// A note on a row whose two methods cannot be compared directly; printed once.
    pub(super) fn note(&self, fields: &[&str]) -> Option<String> {
        if self.quantity != Quantity::Normal {
            return None;
        }
        let at = self.point(fields).ok()?;
        let peeled = self.lobe(&at).ok()?.tabulated_share(Vec3::X) < 1.0;
        peeled.then(|| {
            format!(
                "for gamma = {} the table and the exact method map u1 to normals in different \
                 orders: the table takes u1 first to choose between its part and the heavy tail; \
                 both draw the same distribution, but m_table and m_exact are different normals \
                 (`microfacet-bake validate` compares the distributions)",
                at.gamma
            )
        })
    }

    /// A warning of a probable mistake in a row that can be computed: an azimuth in another unit.
    /// Printed once.
    pub(super) fn doubt(&self, fields: &[&str]) -> Option<String> {
        let [names, _] = self.quantity.columns();
        let phi = fields[names.iter().position(|name| *name == "phi")?];
        self.unit.doubt(phi.parse().ok()?)
    }

    /// The first fields of a row as numbers.
    fn numbers<const N: usize>(&self, fields: &[&str]) -> Result<[f64; N]> {
        let [names, _] = self.quantity.columns();
        let mut numbers = [0.0; N];
        for ((x, name), text) in numbers.iter_mut().zip(names).zip(fields) {
            *x = text.parse().map_err(|_| anyhow!("{name} \"{text}\" is not a number"))?;
            match *name {
                "theta" => *x = self.unit.theta(*x)?,
                "phi" => *x = self.unit.phi(*x)?,
                "u1" | "u2" | "cos_theta" if !(0.0..=1.0).contains(x) => {
                    bail!("{name} = {x} must lie in [0, 1]")
                }
                // The constructors check σ and γ, with their own messages.
                _ => {}
            }
        }
        Ok(numbers)
    }

    fn point(&self, fields: &[&str]) -> Result<Point> {
        let [x, y, gamma, theta, phi] = self.numbers(fields)?;
        let exact = model::StudentT::new([x, y], gamma)?;
        let u = match self.quantity {
            Quantity::Normal => {
                let [.., u1, u2] = self.numbers::<7>(fields)?;
                [u1, u2]
            }
            _ => [0.5; 2],
        };
        let (sin, cos) = theta.sin_cos();
        let direction = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
        Ok(Point { sigma: [x, y], gamma, exact, direction, u })
    }

    fn lobe(&self, at: &Point) -> Result<StudentT> {
        Ok(self.set.student_t(at.sigma, at.gamma)?)
    }

    fn d(&self, at: &Point, method: Method) -> Result<Vec<String>> {
        let m = at.direction;
        Ok(vec![match method {
            Method::Table => text(self.lobe(at)?.d(m.as_vec3())),
            Method::Exact => text(at.exact.d(m)),
        }])
    }

    fn g1(&self, at: &Point, method: Method) -> Result<Vec<String>> {
        let v = at.direction;
        Ok(match method {
            Method::Table => {
                let (lobe, v) = (self.lobe(at)?, v.as_vec3());
                [lobe.lambda(v), lobe.g1(v)].map(text).into()
            }
            Method::Exact => [at.exact.lambda(v), at.exact.g1(v)].map(text).into(),
        })
    }

    fn normal(&self, at: &Point, method: Method) -> Result<Vec<String>> {
        let v = at.direction;
        Ok(match method {
            Method::Table => {
                let (lobe, v) = (self.lobe(at)?, v.as_vec3());
                let ([x, y, z], pdf) = lobe.sample_with_pdf(v, at.u.map(|u| u as f32));
                [x, y, z, pdf].map(text).into()
            }
            Method::Exact => {
                let m = at.exact.sample_visible_normal(v, at.u);
                [m.x, m.y, m.z, at.exact.visible_normal_pdf(v, m)].map(text).into()
            }
        })
    }

    fn albedo(&self, fields: &[&str], method: Method) -> Result<Vec<String>> {
        let [sigma, gamma, cos] = self.numbers(fields)?;
        let masking = masking(fields)?;
        Ok(match method {
            Method::Table => {
                let albedo = self.set.albedo(sigma, gamma, masking)?;
                let v = direction(cos as f32);
                let Moments { scale, bias, .. } = albedo.moments(v);
                [albedo.albedo(v), scale, bias].map(text).into()
            }
            Method::Exact => {
                let schlick = |cos| [1.0 - schlick_weight(cos), schlick_weight(cos)];
                let albedo = self.integrator(gamma)?.reflection(sigma, cos, schlick)?;
                let [scale, bias] = albedo.of(masking);
                [scale + bias, scale, bias].map(text).into()
            }
        })
    }

    fn albedo_average(&self, fields: &[&str], method: Method) -> Result<Vec<String>> {
        let [sigma, gamma] = self.numbers(fields)?;
        let masking = masking(fields)?;
        Ok(vec![match method {
            Method::Table => text(self.set.average_moments(sigma, gamma, masking)?.total()),
            Method::Exact => {
                let albedo = self.integrator(gamma)?.average(sigma, |_| [1.0])?;
                text(albedo.of(masking)[0])
            }
        }])
    }

    fn integrator(&self, gamma: f64) -> Result<Arc<model::AlbedoIntegrator>> {
        let kept = || self.integrators.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(integrator) = kept().get(&gamma.to_bits()) {
            return Ok(integrator.clone());
        }
        let integrator = Arc::new(model::AlbedoIntegrator::new(model::Shape::new(gamma)?, EXACT));
        let mut kept = kept();
        if kept.len() == SHAPES {
            kept.clear();
        }
        kept.insert(gamma.to_bits(), integrator.clone());
        Ok(integrator)
    }
}

/// A material and a direction, and for visible normals two random numbers.
struct Point {
    sigma: [f64; 2],
    gamma: f64,
    exact: model::StudentT,
    /// A view, or for D a microfacet normal.
    direction: DVec3,
    u: [f64; 2],
}

/// The form of masking that the last field of a row names.
fn masking(fields: &[&str]) -> Result<Masking> {
    let text = fields.last().unwrap_or(&"");
    text.parse().map_err(|why| anyhow!("masking \"{text}\": {why}"))
}

/// A number with all its digits, with an exponent if it is very small or very large.
fn text<T: Copy + Into<f64> + Display + LowerExp>(x: T) -> String {
    match x.into().abs() {
        1e-9..1e15 | 0.0 => x.to_string(),
        _ => format!("{x:e}"),
    }
}
