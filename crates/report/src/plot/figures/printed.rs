//! The error of each formula for Λ that Ribardière et al. 2017 (doi:10.1111/cgf.13137) print.

use microfacet_model::Shape;
use microfacet_model::printed::{FORMS, Form};

use crate::plot::figures::curve;
use crate::plot::{Axis, Curve, Dash, Figure, Key, Panel};

/// The colours and dashes of [`FORMS`]: the series and the sums agree where neither loses digits.
const KEYS: [(Key, Dash); FORMS.len()] = [
    (Key::Nth(1), Dash::Solid),
    (Key::Nth(8), Dash::Dashed),
    (Key::Nth(4), Dash::Dashed),
    (Key::Nth(2), Dash::DashDotted),
];

fn equation(form: &Form) -> String {
    format!("eq. {}", form.equation.replace('-', "–"))
}

/// Four shapes: a small integer, a half-integer, and two where sums lose all digits.
pub(super) fn figure() -> Figure {
    Figure::new([3.0, 10.5, 40.0, 150.0].map(panel))
}

/// The relative errors of Λ over z = cot θ/σ, as far as a formula has a correct digit.
fn panel(gamma: f64) -> Panel {
    let shape = Shape::new(gamma).expect("the figure's own parameters");
    let x = Axis::log("unit cotangent cot θ/σ", 1e-2, 1e3);
    // A sum of too many terms overflows, and is not drawn.
    let is_finite = |form: &Form| (form.lambda)(gamma, 1.0).map(f64::is_finite);
    let overflows = FORMS.iter().find(|form| is_finite(form) == Some(false));
    let missing = overflows.map_or(String::new(), |form| format!("; {} overflows", equation(form)));
    let defined = FORMS.into_iter().zip(KEYS).filter(|(form, _)| is_finite(form) == Some(true));
    let error = |form: Form, z: f64| {
        let truth = shape.lambda(shape.asinh_slope(z));
        let error = (form.lambda)(gamma, z).map_or(f64::NAN, |lambda| (lambda - truth).abs());
        // Where Λ is 0, any error is infinite.
        let relative = error / truth.max(1e-300);
        // An error of 0 is drawn as half an ulp; NaN stays NaN, and is not drawn.
        if relative < 1.1e-16 { 1.1e-16 } else { relative }
    };
    let curves = defined.map(|(form, (key, dash))| {
        let name = format!("{}, {}", equation(&form), form.name);
        let mut curve = curve(key, name, &x, |z| error(form, z)).dashed(dash);
        // After the first error of 1 the values are rounding noise.
        if let Some(lost) = curve.points.iter().position(|&(_, error)| error >= 1.0) {
            curve.points.truncate(lost + 1);
            // Above the panel, so that an error of exactly 1, from a Λ of 0, leaves it too.
            curve.points[lost].1 = 10.0;
        }
        curve
    });
    let curves: Vec<Curve> = curves.collect();
    let title = format!("γ = {gamma}{missing}");
    Panel::new(title, x, Axis::log("relative error of Λ", 1e-17, 1.0), curves)
}
