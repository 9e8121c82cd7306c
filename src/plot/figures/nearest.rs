//! A Beckmann and the distributions nearest to it, after Sawicki 2021, figures 1–5.

use std::f64::consts::FRAC_PI_2;

use microfacet_model::classic::Isotropic;

use crate::convert::{Form, Target};
use crate::distribution::{DistributionKind, Named};
use crate::plot::figures::curve;
use crate::plot::{Axis, Figure, Key, Panel};
use crate::progress::Stage;

/// Beckmann's m in the comparisons.
const WIDTHS: [f64; 2] = [0.1, 0.3];

pub(super) fn unit_forms() -> Figure {
    Figure::new(WIDTHS.map(unit_form).into())
}

pub(super) fn deviations() -> Figure {
    Figure::new(WIDTHS.map(deviation).into())
}

pub(super) fn highlights() -> Figure {
    Figure::new(WIDTHS.map(highlight).into())
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

fn unit_form(m: f64) -> Panel {
    let x = Axis::linear("β in degrees", 0.0, (3.0 * m).min(FRAC_PI_2).to_degrees());
    let curves = nearest_to_beckmann(m).into_iter().map(|(name, d)| {
        curve(Key::Kind(name.kind), label(&name), &x, |theta| d.relative_d(theta.to_radians()))
    });
    Panel {
        title: format!("Relative D nearest to Beckmann, m = {m}"),
        curves: curves.collect(),
        x,
        y: Axis::linear("D(β)/D(0)", 0.0, 1.05),
        marks: Vec::new(),
    }
}

fn deviation(m: f64) -> Panel {
    let x = Axis::linear("β in degrees", 0.0, (3.0 * m).min(FRAC_PI_2).to_degrees());
    let mut all = nearest_to_beckmann(m);
    let (_, beckmann) = all.remove(0);
    let curves = all.into_iter().map(|(name, d)| {
        curve(Key::Kind(name.kind), label(&name), &x, |theta| {
            d.relative_d(theta.to_radians()) / beckmann.relative_d(theta.to_radians()) - 1.0
        })
    });
    Panel {
        title: format!("Relative error against Beckmann, m = {m}"),
        curves: curves.collect(),
        x,
        y: Axis::linear("D/D(0) over Beckmann's, minus 1", -1.05, 3.0),
        marks: Vec::new(),
    }
}

/// The angle between the view and the light that makes the highlight.
const LIGHT_DEGREES: f64 = 45.0;

/// Brightness D/(4 cos θ_v) along the equator of a distant sphere, with view, light and normals in
/// one plane and without masking, relative to the value where the half vector is the normal.
fn highlight(m: f64) -> Panel {
    let light = LIGHT_DEGREES.to_radians();
    let x = Axis::linear("distance from the centre, in radii", -0.7, 0.995);
    let curves = nearest_to_beckmann(m).into_iter().map(|(name, d)| {
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
        curve(Key::Kind(name.kind), label(&name), &x, |x| brightness(x) / at_half)
    });
    Panel {
        title: format!("Highlight across a sphere, light at 45°, Beckmann m = {m}"),
        curves: curves.collect(),
        x,
        y: Axis::linear("brightness relative to the centre of the highlight", 0.0, 1.5),
        marks: Vec::new(),
    }
}

fn label(named: &Named) -> String {
    let values: Vec<String> = named.values.iter().map(|x| format!("{x:.4}")).collect();
    format!("{} {}", named.kind.name(), values.join(", "))
}
