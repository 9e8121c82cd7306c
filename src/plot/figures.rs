//! The content of each figure.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use microfacet_model::classic::Isotropic;
use microfacet_model::{MicrofacetDistribution, Shape, StudentT, printed};

use super::{Curve, Legend, Panel, PlotError};
use crate::convert::{Form, Target};
use crate::distribution::{DistributionKind, Named};
use crate::progress::Stage;

/// One of the printed forms of Λ(γ, z) that are compared.
type PrintedLambda = fn(f64, f64) -> Option<f64>;

/// Names of the figures.
pub const NAMES: [&str; 5] =
    ["student-t", "distributions", "relative-error", "highlights", "printed-formulas"];

/// Points of a curve.
const POINTS: usize = 400;

/// A figure by name.
///
/// `student-t`: P22 and G1 by γ and by σ (Ribardière et al. 2017, doi:10.1111/cgf.13137, figure 3).
/// `distributions` and `relative-error`: the distributions of least RMSE to a Beckmann, and their
/// deviation from it (after Sawicki 2021, figures 1–2). `highlights`: the brightness across a
/// sphere (after figures 3–5). `printed-formulas`: the error of Λ as Ribardière et al. 2017 print
/// it.
///
/// # Errors
/// [`PlotError::Unknown`], listing the names.
pub fn figure(name: &str) -> Result<Vec<Panel>, PlotError> {
    match name {
        "student-t" => Ok(student_t()),
        "distributions" => Ok(WIDTHS.iter().map(|&m| unit_forms(m)).collect()),
        "relative-error" => Ok(WIDTHS.iter().map(|&m| deviations(m)).collect()),
        "printed-formulas" => {
            Ok([3.0, 10.5, 40.0, 150.0].into_iter().map(printed_formulas).collect())
        }
        "highlights" => Ok(WIDTHS.iter().map(|&m| highlight(m)).collect()),
        _ => Err(PlotError::Unknown(name.into())),
    }
}

/// Beckmann's m in the comparisons.
const WIDTHS: [f64; 2] = [0.1, 0.3];

fn curve(name: String, low: f64, high: f64, f: impl Fn(f64) -> f64) -> Curve {
    let at = |i: usize| low + (high - low) * i as f64 / POINTS as f64;
    Curve { name, points: (0..=POINTS).map(at).map(|x| (x, f(x))).collect() }
}

fn degrees(theta: f64) -> DVec3 {
    let (sin, cos) = theta.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

fn student_t() -> Vec<Panel> {
    let of = |sigma, gamma| StudentT::new(sigma, gamma).expect("the figures' own parameters");
    let gammas = [1.6, 2.0, 3.0, 5.0, 40.0];
    let sigmas = [0.2, 0.35, 0.5, 0.75, 1.0];
    let slopes = |name: String, t: StudentT| curve(name, -2.0, 2.0, move |x| t.p22(x, 0.0));
    let masking =
        |name: String, t: StudentT| curve(name, 0.0, 90.0, move |theta| t.g1(degrees(theta)));
    let by_gamma = |f: &dyn Fn(String, StudentT) -> Curve| {
        gammas.iter().map(|&g| f(format!("γ = {g}"), of(0.5, g))).collect::<Vec<_>>()
    };
    let by_sigma = |f: &dyn Fn(String, StudentT) -> Curve| {
        sigmas.iter().map(|&s| f(format!("σ = {s}"), of(s, 3.0))).collect::<Vec<_>>()
    };
    let panel = |title: &str, x_label, y_label, y, legend, curves| Panel {
        title: title.into(),
        x_label,
        y_label,
        y,
        legend,
        curves,
    };
    let (slope, angle) = ("slope x (slope y = 0)", "θ in degrees");
    vec![
        panel("P22 by γ, σ = 0.5", slope, "P22", (0.0, 1.4), Legend::Right, by_gamma(&slopes)),
        panel("G1 by γ, σ = 0.5", angle, "G1", (0.0, 1.05), Legend::Left, by_gamma(&masking)),
        panel("P22 by σ, γ = 3", slope, "P22", (0.0, 8.5), Legend::Right, by_sigma(&slopes)),
        panel("G1 by σ, γ = 3", angle, "G1", (0.0, 1.05), Legend::Left, by_sigma(&masking)),
    ]
}

/// The decimal logarithm of Λ's relative error in each printed form that is defined at γ, over
/// log₁₀ of z = cot θ/σ.
fn printed_formulas(gamma: f64) -> Panel {
    let shape = Shape::new(gamma).expect("the figure's own parameters");
    let forms: [(&str, PrintedLambda); 4] = [
        ("13–15", |gamma, z| Some(printed::lambda_hypergeometric(gamma, z))),
        ("21, integer", printed::lambda_integer),
        ("21, half-integer", printed::lambda_half_integer),
        ("22–23", |gamma, z| Some(printed::lambda_rational(gamma, z))),
    ];
    let defined =
        forms.into_iter().filter(|(_, form)| form(gamma, 1.0).is_some_and(f64::is_finite));
    let digits = |(name, form): (&str, PrintedLambda)| {
        curve(name.into(), -2.0, 3.0, |log_z| {
            let z = libm::exp10(log_z);
            let truth = shape.lambda(shape.asinh_slope(z));
            // No error at all is drawn as half an ulp.
            let error = form(gamma, z)
                .map_or(f64::NAN, |lambda| (lambda - truth).abs() / truth.max(1e-300));
            libm::log10(error.max(1.1e-16)).min(5.0)
        })
    };
    Panel {
        title: format!("Λ as printed, γ = {gamma}"),
        x_label: "log10 of cot θ/σ",
        y_label: "log10 of the relative error of Λ",
        y: (-17.0, 5.5),
        legend: Legend::Right,
        curves: defined.map(digits).collect(),
    }
}

/// A Beckmann and the nearest distribution of each other kind.
fn nearest_to_beckmann(m: f64) -> Vec<(Named, Box<dyn Isotropic>)> {
    let beckmann = Named { kind: DistributionKind::Beckmann, values: vec![m] };
    let from = beckmann.build().expect("m is positive");
    let others = [
        DistributionKind::BlinnPhong,
        DistributionKind::Gauss,
        DistributionKind::TrowbridgeReitz,
        DistributionKind::Schlick,
        DistributionKind::Sawicki,
    ];
    let nearest = others.map(|kind| {
        let found = Target::new(&*from)
            .by_rmse(kind, Form::Relative, &Stage::unwatched())
            .expect("a smooth problem of one variable")
            .to;
        let built = found.build().expect("it was built to be judged");
        (found, built)
    });
    [(beckmann, from)].into_iter().chain(nearest).collect()
}

fn unit_forms(m: f64) -> Panel {
    let reach = (3.0 * m).min(FRAC_PI_2).to_degrees();
    let one = |(name, d): (Named, Box<dyn Isotropic>)| {
        curve(label(&name), 0.0, reach, |theta| d.relative_d(theta.to_radians()))
    };
    Panel {
        title: format!("Relative D nearest to Beckmann, m = {m}"),
        x_label: "β in degrees",
        y_label: "D(β)/D(0)",
        y: (0.0, 1.05),
        legend: Legend::Right,
        curves: nearest_to_beckmann(m).into_iter().map(one).collect(),
    }
}

fn deviations(m: f64) -> Panel {
    let reach = (3.0 * m).min(FRAC_PI_2).to_degrees();
    let mut all = nearest_to_beckmann(m);
    let (_, beckmann) = all.remove(0);
    let one = |(name, d): (Named, Box<dyn Isotropic>)| {
        let deviation = |theta: f64| {
            d.relative_d(theta.to_radians()) / beckmann.relative_d(theta.to_radians()) - 1.0
        };
        curve(label(&name), 0.0, reach, deviation)
    };
    Panel {
        title: format!("Relative error against Beckmann, m = {m}"),
        x_label: "β in degrees",
        y_label: "D/D(0) over Beckmann's, minus 1",
        y: (-1.05, 3.0),
        legend: Legend::Left,
        curves: all.into_iter().map(one).collect(),
    }
}

/// The angle between the view and the light that makes the highlight.
const LIGHT_DEGREES: f64 = 45.0;

/// Brightness D/(4 cos θ_v) along the equator of a distant sphere, with view, light and normals in
/// one plane and without masking, relative to the value where the half vector is the normal.
fn highlight(m: f64) -> Panel {
    let light = LIGHT_DEGREES.to_radians();
    let one = |(name, d): (Named, Box<dyn Isotropic>)| {
        let brightness = |x: f64| {
            let normal = x.asin();
            let (cos_v, cos_l) = (normal.cos(), (normal - light).cos());
            if cos_v > 0.0 && cos_l > 0.0 {
                d.d((normal - 0.5 * light).abs()) / (4.0 * cos_v)
            } else {
                0.0
            }
        };
        let at_half = brightness((0.5 * light).sin());
        curve(label(&name), -0.7, 0.995, |x| brightness(x) / at_half)
    };
    Panel {
        title: format!("Highlight across a sphere, light at 45°, Beckmann m = {m}"),
        x_label: "distance from the centre, in radii",
        y_label: "brightness relative to the centre of the highlight",
        y: (0.0, 1.5),
        legend: Legend::Right,
        curves: nearest_to_beckmann(m).into_iter().map(one).collect(),
    }
}

fn label(named: &Named) -> String {
    let values: Vec<String> = named.values.iter().map(|x| format!("{x:.4}")).collect();
    format!("{} {}", named.kind.name(), values.join(", "))
}
