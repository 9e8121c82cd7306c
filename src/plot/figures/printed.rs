//! The error of Λ in each form that Ribardière et al. 2017 (doi:10.1111/cgf.13137) print.

use microfacet_model::{Shape, printed};

use crate::plot::figures::curve;
use crate::plot::{Axis, Dash, Figure, Key, Method, Panel};

/// One of the printed forms of Λ(γ, z).
type Lambda = fn(f64, f64) -> Option<f64>;

const FORMS: [(Method, &str, Lambda); 4] = [
    (Method::Hypergeometric, "eq. 13–15, hypergeometric", |gamma, z| {
        Some(printed::lambda_hypergeometric(gamma, z))
    }),
    (Method::Integer, "eq. 21, integer γ", printed::lambda_integer),
    (Method::HalfInteger, "eq. 21, half-integer γ", printed::lambda_half_integer),
    (Method::Rational, "eq. 22–23, rational", |gamma, z| {
        Some(printed::lambda_rational(gamma, z))
    }),
];

/// Four shapes: a small integer, a half-integer, and two where sums lose all digits.
pub(super) fn figure() -> Figure {
    Figure::new([3.0, 10.5, 40.0, 150.0].into_iter().map(panel).collect())
}

/// The relative error of Λ in the forms that are defined at γ, over z = cot θ/σ, as far as a form
/// has a digit right.
fn panel(gamma: f64) -> Panel {
    let shape = Shape::new(gamma).expect("the figure's own parameters");
    let x = Axis::log("cot θ/σ", 1e-2, 1e3);
    let is_finite = |form: Lambda| form(gamma, 1.0).map(f64::is_finite);
    let defined = FORMS.into_iter().filter(|(_, _, form)| is_finite(*form) == Some(true));
    let overflows = FORMS.iter().find(|(_, _, form)| is_finite(*form) == Some(false));
    let missing = overflows.map_or(String::new(), |(_, name, _)| format!("; {name}: overflow"));
    let error = |form: Lambda, z: f64| {
        let truth = shape.lambda(shape.asinh_slope(z));
        let error = form(gamma, z).map_or(f64::NAN, |lambda| (lambda - truth).abs());
        // Where Λ is 0, any error is infinite.
        let relative = error / truth.max(1e-300);
        // No error at all is drawn as half an ulp; what is no number stays so, and is not drawn.
        if relative < 1.1e-16 { 1.1e-16 } else { relative }
    };
    let curves = defined.map(|(method, name, form)| {
        let mut curve = curve(Key::Method(method), name.into(), &x, |z| error(form, z));
        // What follows is noise of rounding.
        if let Some(lost) = curve.points.iter().position(|&(_, error)| error >= 1.0) {
            curve.points.truncate(lost + 1);
            // An error of 1, a Λ of 0, leaves the panel as well.
            curve.points[lost].1 = 10.0;
        }
        // The series and the sums agree where neither loses digits.
        if method != Method::Hypergeometric {
            curve.dash = Dash::Dashed;
        }
        curve
    });
    Panel {
        title: format!("Λ as printed, γ = {gamma}{missing}"),
        curves: curves.collect(),
        x,
        y: Axis::log("relative error of Λ", 1e-17, 1.0),
        marks: Vec::new(),
    }
}
