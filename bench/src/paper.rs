//! Two comparisons of Ribardière et al. 2017 (doi:10.1111/cgf.13137), repeated with tables: the
//! time by γ and by σ (after figure 4), and the error of the rational approximation of masking
//! (after figure 5).

use std::cell::RefCell;

use glam::Vec3;
use microfacet_bake::plot::{self, Axis, Curve, Dash, Figure, Key, Panel};
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::{StudentT, printed};
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::Tables;

use crate::clock::{self, Calls};
use crate::inputs::{Inputs, Stream};
use crate::masking::{self, Evaluate};
use crate::rivals::rational::Rational;
use crate::rows::{Quantity, normals, values};
use crate::sampler::{self, Draw};
use crate::settings::{GAMMA, SIGMA, Settings};

/// Shapes at [`SIGMA`], and roughnesses at [`GAMMA`].
const GAMMAS: [f64; 12] = [1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.5, 8.0, 12.0, 20.0, 30.0, 40.0];
const SIGMAS: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0];

/// The time of one method for one material.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Timing {
    /// What it computes.
    pub(crate) quantity: Quantity,
    /// The method.
    pub(crate) method: &'static str,
    /// Whether this is a point over γ (else over σ).
    pub(crate) by_gamma: bool,
    /// Its shape.
    pub(crate) gamma: f64,
    /// Its roughness.
    pub(crate) sigma: f64,
    /// Nanoseconds a call.
    pub(crate) ns: f64,
}

/// A method as the clock runs it: G1, or normals.
enum Method<'a> {
    G1(Evaluate<'a>),
    Normal(Draw<'a>),
}

/// Every method at every material, in turns.
pub(crate) fn times(set: &Tables, settings: &Settings) -> Vec<Timing> {
    let inputs = Inputs::new(settings.seed, settings.calls);
    let by_gamma = GAMMAS.map(|gamma| (true, gamma, SIGMA));
    let by_sigma = SIGMAS.map(|sigma| (false, GAMMA, sigma));
    let points = by_gamma.into_iter().chain(by_sigma);
    let all: Vec<(Timing, Method)> = points
        .flat_map(|(by_gamma, gamma, sigma)| {
            methods(set, gamma, sigma, settings.seed).into_iter().map(move |(name, method)| {
                let quantity = match method {
                    Method::G1(_) => Quantity::G1,
                    Method::Normal(_) => Quantity::Normal,
                };
                (Timing { quantity, method: name, by_gamma, gamma, sigma, ns: 0.0 }, method)
            })
        })
        .collect();
    let mut runs: Vec<Calls> = all
        .iter()
        .map(|(_, method)| match method {
            Method::G1(evaluate) => values(evaluate, &inputs),
            Method::Normal(draw) => normals(draw, &inputs),
        })
        .collect();
    // There are so many that fewer rounds must suffice.
    let times = clock::medians(&mut runs, settings.rounds.div_ceil(8), settings.calls);
    all.iter().zip(times).map(|((at, _), ns)| Timing { ns, ..at.clone() }).collect()
}

/// All methods that are defined for a material.
fn methods(
    set: &Tables,
    gamma: f64,
    sigma: f64,
    seed: u64,
) -> Vec<(&'static str, Method<'static>)> {
    let truth = StudentT::new(sigma, gamma).expect("constants");
    let lobe = set.student_t(sigma, gamma).expect("the general set covers all shapes");
    let z = move |w: Vec3| f64::from(w.z) / (sigma * f64::from((w.x * w.x + w.y * w.y).sqrt()));
    let g1 = |lambda: f64| (1.0 / (1.0 + lambda)) as f32;
    let mut all: Vec<(&str, Method)> = vec![(
        "eq. 13-15, hypergeometric",
        Method::G1(masking::each(move |w| g1(printed::lambda_hypergeometric(gamma, z(w))))),
    )];
    if printed::lambda_integer(gamma, 1.0).is_some() {
        let sum = move |w| g1(printed::lambda_integer(gamma, z(w)).unwrap_or(f64::NAN));
        all.push(("eq. 21, integer", Method::G1(masking::each(sum))));
    }
    if printed::lambda_half_integer(gamma, 1.0).is_some() {
        let sum = move |w| g1(printed::lambda_half_integer(gamma, z(w)).unwrap_or(f64::NAN));
        all.push(("eq. 21, half-integer", Method::G1(masking::each(sum))));
    }
    let rational = Rational::new(sigma, gamma);
    all.push(("eq. 22-23, rational", Method::G1(masking::each(move |w| rational.g1(w)))));
    let table = lobe.clone();
    all.push(("table", Method::G1(masking::each(move |w| table.g1(w)))));
    let inversion = move |v: Vec3, u: [f32; 2]| {
        truth.sample_visible_normal(v.as_dvec3(), u.map(f64::from)).as_vec3()
    };
    all.push(("inversion of the CDF, f64", Method::Normal(sampler::each(inversion))));
    let stream = RefCell::new(Stream::new(seed));
    let exact = move |v: Vec3, _| {
        let stream = &mut *stream.borrow_mut();
        truth.sample_visible_by_rejection(v.as_dvec3(), &mut || f64::from(stream.next())).as_vec3()
    };
    all.push(("exact by rejection, f64", Method::Normal(sampler::each(exact))));
    let table = move |v: Vec3, u| lobe.sample_visible_normal(v, u);
    all.push(("table", Method::Normal(sampler::each(table))));
    all
}

/// The times as a drawing of four panels.
pub(crate) fn times_svg(times: &[Timing]) -> String {
    // One range for all, so that heights can be compared.
    let highest = times.iter().map(|at| at.ns).fold(10.0, f64::max);
    let panel = |quantity: Quantity, by_gamma| {
        let mut curves: Vec<Curve> = Vec::new();
        for at in times.iter().filter(|at| at.quantity == quantity && at.by_gamma == by_gamma) {
            let point = (if by_gamma { at.gamma } else { at.sigma }, at.ns.max(0.1));
            match curves.iter_mut().find(|curve| curve.name == at.method) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve {
                    key: Key::Method(key(at.method)),
                    name: at.method.into(),
                    dash: Dash::Solid,
                    points: vec![point],
                }),
            }
        }
        let what = if quantity == Quantity::G1 { "G1" } else { "a visible normal" };
        let (title, x) = if by_gamma {
            (format!("{what} by γ, σ = {SIGMA}"), Axis::log("γ", 1.5, 50.0))
        } else {
            (format!("{what} by σ, γ = {GAMMA}"), Axis::linear("σ", 0.0, 1.0))
        };
        let y = Axis::log("ns a call", 1.0, 1.5 * highest);
        Panel { title, x, y, curves, marks: Vec::new() }
    };
    Figure::new(vec![
        panel(Quantity::G1, true),
        panel(Quantity::G1, false),
        panel(Quantity::Normal, true),
        panel(Quantity::Normal, false),
    ])
    .svg()
}

/// What a method is by its name, for its colour.
fn key(name: &str) -> plot::Method {
    match name {
        "eq. 13-15, hypergeometric" => plot::Method::Hypergeometric,
        "eq. 21, integer" => plot::Method::Integer,
        "eq. 21, half-integer" => plot::Method::HalfInteger,
        "eq. 22-23, rational" => plot::Method::Rational,
        "table" => plot::Method::Table,
        "inversion of the CDF, f64" => plot::Method::Inversion,
        "exact by rejection, f64" => plot::Method::Rejection,
        _ => plot::Method::Other,
    }
}

/// The errors of the rational approximation of G1 and of the table for one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approximation {
    /// The shape.
    pub(crate) gamma: f64,
    /// Polar angle of the view, degrees.
    pub(crate) degrees: f64,
    /// The exact G1.
    pub(crate) g1: f64,
    /// Approximation minus exact.
    pub(crate) rational_error: f64,
    /// Table minus exact.
    pub(crate) table_error: f64,
}

/// Over θ by half degrees, for the shapes that the approximation was made for, at σ = [`SIGMA`].
pub(crate) fn approximation(set: &Tables) -> Vec<Approximation> {
    let of_shape = |gamma: f64| {
        let truth = StudentT::new(SIGMA, gamma).expect("constants");
        let lobe = set.student_t(SIGMA, gamma).expect("the general set covers all shapes");
        (1..180).map(move |i| {
            let degrees = 0.5 * f64::from(i);
            let (sin, cos) = degrees.to_radians().sin_cos();
            // The view as rounded to single precision.
            let v = Vec3::new(sin as f32, 0.0, cos as f32);
            let g1 = truth.g1(v.as_dvec3());
            let z = f64::from(v.z) / (SIGMA * f64::from(v.x));
            let rational_error = 1.0 / (1.0 + printed::lambda_rational(gamma, z)) - g1;
            Approximation {
                gamma,
                degrees,
                g1,
                rational_error,
                table_error: f64::from(lobe.g1(v)) - g1,
            }
        })
    };
    [1.6, 1.8, 2.2, 3.0, 5.0, 10.0, 20.0, 40.0].into_iter().flat_map(of_shape).collect()
}

/// The errors as a drawing of two panels.
pub(crate) fn approximation_svg(all: &[Approximation]) -> String {
    let panel = |title: &str, error: fn(&Approximation) -> f64| {
        let mut curves: Vec<Curve> = Vec::new();
        for at in all {
            let key = Key::Gamma(at.gamma);
            // Smaller errors are below the rounding of single precision.
            let point = (at.degrees, error(at).abs().max(1e-9));
            match curves.last_mut().filter(|curve| curve.key == key) {
                Some(curve) => curve.points.push(point),
                None => curves.push(Curve {
                    key,
                    name: format!("γ = {}", at.gamma),
                    // Neighbours on the ramp of colours differ in this too.
                    dash: if curves.len().is_multiple_of(2) { Dash::Solid } else { Dash::Dashed },
                    points: vec![point],
                }),
            }
        }
        Panel {
            title: title.into(),
            x: Axis::linear("θ in degrees", 0.0, 90.0),
            y: Axis::log("error of G1", 1e-9, 3e-2),
            curves,
            marks: Vec::new(),
        }
    };
    Figure::new(vec![
        panel("Rational approximation, eq. 22–23", |at| at.rational_error),
        panel("Table, default quality", |at| at.table_error),
    ])
    .svg()
}
