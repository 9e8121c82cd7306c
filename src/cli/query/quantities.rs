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
use crate::cli::remedy;
use crate::cli::values::Unit;

/// Values for the columns of one row, or why there are none.
type Values = Result<Vec<String>, String>;

/// A quantity that `query` computes at a point.
pub(super) trait Quantity: Sync {
    fn inputs(&self) -> &'static [&'static str];
    fn output_stems(&self) -> &'static [&'static str];
    fn values(&self, fields: &[&str], known: &Known, method: Method)
    -> Result<Vec<String>, String>;

    /// What a reader should know who compares the two methods in a row; printed once.
    fn note(&self, _fields: &[&str], _known: &Known) -> Option<String> {
        None
    }

    /// What in a row looks like a mistake, though it can be computed; printed once.
    fn doubt(&self, _fields: &[&str]) -> Option<String> {
        None
    }

    fn outputs(&self, method: Method) -> Vec<String> {
        let suffix = match method {
            Method::Table => "table",
            Method::Exact => "exact",
        };
        self.output_stems().iter().map(|stem| format!("{stem}_{suffix}")).collect()
    }
}

/// The tables, and the model's integrators for the shapes that were queried last.
pub(super) struct Known {
    set: Tables,
    integrators: Mutex<HashMap<u64, Arc<model::AlbedoIntegrator>>>,
}

/// Error aimed at by the model's albedos.
const EXACT: f64 = 1e-10;
/// Number of shapes whose integrators are kept; repeated rows of one shape are then computed twice
/// as fast.
const SHAPES: usize = 64;

impl Known {
    pub(super) fn new(set: Tables) -> Self {
        Self { set, integrators: Mutex::default() }
    }

    fn integrator(&self, gamma: f64) -> Result<Arc<model::AlbedoIntegrator>, String> {
        let kept = || self.integrators.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(integrator) = kept().get(&gamma.to_bits()) {
            return Ok(integrator.clone());
        }
        let shape = model::Shape::new(gamma).map_err(|why| why.to_string())?;
        let integrator = Arc::new(model::AlbedoIntegrator::new(shape, EXACT));
        let mut kept = kept();
        if kept.len() == SHAPES {
            kept.clear();
        }
        kept.insert(gamma.to_bits(), integrator.clone());
        Ok(integrator)
    }
}

fn parse(text: &str, name: &str, unit: Unit) -> Result<f64, String> {
    let x: f64 = text.parse().map_err(|_| format!("{name} \"{text}\" is not a number"))?;
    match name {
        "theta" => unit.theta(x),
        "phi" => unit.phi(x),
        "u1" | "u2" | "cos_theta" if !(0.0..=1.0).contains(&x) => {
            Err(format!("{name} = {x} must lie in [0, 1]"))
        }
        // The constructors check σ and γ, with their own messages.
        _ => Ok(x),
    }
}

/// A number with all its digits, by powers of ten where zeros would fill the line.
fn text<T: Copy + Into<f64> + Display + LowerExp>(x: T) -> String {
    match x.into().abs() {
        1e-9..1e15 | 0.0 => x.to_string(),
        _ => format!("{x:e}"),
    }
}

/// The fields of a row as numbers.
fn numbers(fields: &[&str], names: &[&str], unit: Unit) -> Result<Vec<f64>, String> {
    fields.iter().zip(names).map(|(text, name)| parse(text, name, unit)).collect()
}

/// A material and a view, and for normals two random numbers.
struct Point<'a> {
    sigma: [f64; 2],
    gamma: f64,
    theta: f64,
    phi: f64,
    u: [f64; 2],
    set: &'a Tables,
}

impl<'a> Point<'a> {
    fn new(fields: &[&str], names: &[&str], unit: Unit, set: &'a Tables) -> Result<Self, String> {
        let values = numbers(fields, names, unit)?;
        let &[x, y, gamma, theta, phi, ref rest @ ..] = &values[..] else {
            unreachable!("five columns were found")
        };
        model::StudentT::new([x, y], gamma).map_err(|why| why.to_string())?;
        let u = if let &[a, b] = rest { [a, b] } else { [0.5; 2] };
        Ok(Self { sigma: [x, y], gamma, theta, phi, u, set })
    }

    fn view(&self) -> DVec3 {
        let (sin, cos) = self.theta.sin_cos();
        DVec3::new(sin * self.phi.cos(), sin * self.phi.sin(), cos)
    }

    fn lobe(&self) -> Result<StudentT, String> {
        self.set.student_t(self.sigma, self.gamma).map_err(|why| remedy::told(&why))
    }

    fn exact(&self) -> model::StudentT {
        model::StudentT::new([self.sigma[0], self.sigma[1]], self.gamma).expect("checked in `new`")
    }
}

/// The azimuth of a row, if it looks like one in another unit.
fn doubt(fields: &[&str], names: &[&str], unit: Unit) -> Option<String> {
    let phi = fields[names.iter().position(|name| *name == "phi")?];
    unit.doubt(phi.parse().ok()?)
}

pub(super) struct G1(pub(super) Unit);

impl Quantity for G1 {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma_x", "sigma_y", "gamma", "theta", "phi"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["lambda", "g1"]
    }

    fn doubt(&self, fields: &[&str]) -> Option<String> {
        doubt(fields, self.inputs(), self.0)
    }

    fn values(&self, fields: &[&str], known: &Known, method: Method) -> Values {
        let at = Point::new(fields, self.inputs(), self.0, &known.set)?;
        let v = at.view();
        Ok(match method {
            Method::Table => {
                let lobe = at.lobe()?;
                vec![text(lobe.lambda(v.as_vec3())), text(lobe.g1(v.as_vec3()))]
            }
            Method::Exact => vec![text(at.exact().lambda(v)), text(at.exact().g1(v))],
        })
    }
}

pub(super) struct Normal(pub(super) Unit);

impl Quantity for Normal {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma_x", "sigma_y", "gamma", "theta", "phi", "u1", "u2"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["m_x", "m_y", "m_z", "pdf"]
    }

    fn doubt(&self, fields: &[&str]) -> Option<String> {
        doubt(fields, self.inputs(), self.0)
    }

    fn note(&self, fields: &[&str], known: &Known) -> Option<String> {
        let at = Point::new(fields, self.inputs(), self.0, &known.set).ok()?;
        let peeled = at.lobe().ok()?.tabulated_share(Vec3::X) < 1.0;
        peeled.then(|| {
            format!(
                "for gamma = {} the table and the exact method map u1 to normals in different orders: the table takes u1 first to \
                 choose between its part and the heavy tail; both draw the same distribution, but m_table and m_exact are different \
                 normals (`microfacet-bake validate` compares the distributions)",
                at.gamma
            )
        })
    }

    fn values(&self, fields: &[&str], known: &Known, method: Method) -> Values {
        let at = Point::new(fields, self.inputs(), self.0, &known.set)?;
        let v = at.view();
        Ok(match method {
            Method::Table => {
                let lobe = at.lobe()?;
                let m = lobe.sample_visible_normal(v.as_vec3(), at.u.map(|u| u as f32));
                [m.x, m.y, m.z, lobe.visible_normal_pdf(v.as_vec3(), m)].map(text).into()
            }
            Method::Exact => {
                let m = at.exact().sample_visible_normal(v, at.u);
                [m.x, m.y, m.z, at.exact().visible_normal_pdf(v, m)].map(text).into()
            }
        })
    }
}

/// The form of masking named in a field.
fn masking(text: &str) -> Result<Masking, String> {
    text.parse().map_err(|why| format!("masking \"{text}\": {why}"))
}

pub(super) struct Albedo;

impl Quantity for Albedo {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma", "gamma", "cos_theta", "masking"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["E", "schlick_scale", "schlick_bias"]
    }

    fn values(&self, fields: &[&str], known: &Known, method: Method) -> Values {
        let values = numbers(&fields[..3], self.inputs(), Unit::default())?;
        let &[sigma, gamma, cos] = &values[..] else { unreachable!("three columns were found") };
        let masking = masking(fields[3])?;
        Ok(match method {
            Method::Table => {
                let albedo =
                    known.set.albedo(sigma, gamma, masking).map_err(|why| remedy::told(&why))?;
                let v = direction(cos as f32);
                let Moments { scale, bias, .. } = albedo.moments(v);
                [albedo.albedo(v), scale, bias].map(text).into()
            }
            Method::Exact => {
                let schlick = |cos| [1.0 - schlick_weight(cos), schlick_weight(cos)];
                let albedo = known
                    .integrator(gamma)?
                    .reflection(sigma, cos, schlick)
                    .map_err(|why| remedy::told(&why))?;
                let [scale, bias] = albedo.of(masking);
                [scale + bias, scale, bias].map(text).into()
            }
        })
    }
}

pub(super) struct AlbedoAverage;

impl Quantity for AlbedoAverage {
    fn inputs(&self) -> &'static [&'static str] {
        &["sigma", "gamma", "masking"]
    }

    fn output_stems(&self) -> &'static [&'static str] {
        &["E_avg"]
    }

    fn values(&self, fields: &[&str], known: &Known, method: Method) -> Values {
        let values = numbers(&fields[..2], self.inputs(), Unit::default())?;
        let &[sigma, gamma] = &values[..] else { unreachable!("two columns were found") };
        let masking = masking(fields[2])?;
        Ok(match method {
            Method::Table => {
                let average = known
                    .set
                    .average_moments(sigma, gamma, masking)
                    .map_err(|why| remedy::told(&why))?;
                vec![average.total().to_string()]
            }
            Method::Exact => {
                let albedo = known
                    .integrator(gamma)?
                    .average(sigma, |_| [1.0])
                    .map_err(|why| remedy::told(&why))?;
                vec![albedo.of(masking)[0].to_string()]
            }
        })
    }
}
