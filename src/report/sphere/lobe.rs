//! The lobe in the plane of incidence: the drawing that the script fills, and three of its views
//! for where none runs.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use maud::{Markup, html};
use microfacet_sampler::{Lobe, Masking, MaterialError, MicrofacetDistribution, Tables};

use super::scene::Look;

/// The length of the longest arrow, as `REACH` of lobe.js, and lights of a still.
const REACH: f64 = 150.0;
const LIGHTS: usize = 241;
/// The views of stills, in degrees.
const VIEWS: [u32; 3] = [15, 45, 75];
/// Names of the curves, as classes.
const CURVES: [&str; 3] = ["shape", "ggx", "beckmann"];

/// Axes, and curves of these points: of the shape, of GGX and of Beckmann.
fn drawing(points: [&str; 3], view: &str, inside: &Markup, id: &str) -> Markup {
    let [x, y] = [-REACH, 0.0];
    html! {
        svg viewBox="-170 -172 340 190" role="group" aria-labelledby=(id) {
            g class="axes" fill="none" stroke="currentColor" stroke-opacity="0.35" {
                path d=(format!("M{x} {y}A{REACH} {REACH} 0 0 1 {REACH} 0")) {}
                path d="M-165 0H165M0 0V-165" {}
            }
            @for (name, points) in CURVES.iter().zip(points).rev() {
                @let dash = match *name { "ggx" => "5 4", "beckmann" => "1.5 3", _ => "none" };
                polyline class={ "of-" (name) } points=(points) fill="none" stroke="currentColor"
                    stroke-width=(if *name == "shape" { "2.5" } else { "1.25" })
                    stroke-dasharray=(dash) stroke-linejoin="round" {}
            }
            path class="of-view" d=(view) stroke="currentColor" stroke-width="1.5" {}
            (inside)
        }
    }
}

/// What the curves are.
fn legend() -> Markup {
    html! {
        ul.legend {
            li.key-shape { "the lobe" }
            li.key-ggx { "GGX of the same σ" }
            li.key-beckmann { "Beckmann of the same σ" }
        }
    }
}

/// The drawing that the script fills.
pub(super) fn live() -> Markup {
    let handle = html! {
        g tabindex="0" role="slider" aria-label="Angle of the view" aria-valuemin="0"
            aria-valuemax="89" aria-valuenow="45" class="handle" {
            circle r="18" fill="transparent" {}
            circle r="8" fill="currentColor" {}
        }
    };
    html! {
        figure #lobe-live .live hidden {
            (drawing(["", "", ""], "", &handle, "lobe-caption"))
            (legend())
            figcaption #lobe-caption {
                "Light in the plane of incidence, f cos θ of one bounce with F = 1: "
                span #lobe-name {} ". View at " span.of-angle {} "; drag it. The outer circle is "
                span.of-scale {} "."
            }
        }
    }
}

/// Three views of a lobe.
///
/// # Errors
/// [`MaterialError`] for a shape that the tables do not cover.
pub(super) fn stills(tables: &Tables, look: &Look, name: &str) -> Result<Markup, MaterialError> {
    let lobes: Vec<Lobe> = [look.gamma, 2.0, f64::INFINITY]
        .into_iter()
        .map(|gamma| tables.lobe(look.sigma, gamma))
        .collect::<Result<_, _>>()?;
    Ok(html! {
        div #lobe-still .stills {
            @for view in VIEWS {
                (still(&lobes, view, name))
            }
            (legend())
        }
    })
}

fn still(lobes: &[Lobe], degrees: u32, name: &str) -> Markup {
    let view = f64::from(degrees).to_radians();
    let values: Vec<Vec<f64>> = lobes.iter().map(|lobe| values(lobe, view)).collect();
    let most = values.iter().flatten().copied().fold(f64::MIN_POSITIVE, f64::max);
    let points: Vec<String> = values.iter().map(|values| points(values, most)).collect();
    let [x, y] = [-REACH * view.sin(), -REACH * view.cos()];
    let id = format!("lobe-{degrees}");
    html! {
        figure {
            (drawing(
                [&points[0], &points[1], &points[2]],
                &format!("M0 0L{x:.1} {y:.1}"),
                &html! { circle cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="6"
                    fill="currentColor" {} },
                &id,
            ))
            figcaption id=(id) { (name) ", view at θ = " (degrees) "°" }
        }
    }
}

/// The light of a place among those of the plane of incidence, in radians.
fn angle(i: usize) -> f64 {
    PI * i as f64 / (LIGHTS - 1) as f64 - FRAC_PI_2
}

/// f cos of one bounce with F = 1, from −90° to 90°; the view stands on the negative side.
fn values(lobe: &Lobe, view: f64) -> Vec<f64> {
    let at = |angle: f64| Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32);
    let v = at(-view);
    let of = |i: usize| {
        let l = at(angle(i));
        if !(l.z > 1e-6) {
            return 0.0;
        }
        let white = lobe.d((v + l).normalize()) * lobe.g2(v, l, Masking::HeightCorrelated);
        f64::from(white / (4.0 * v.z))
    };
    (0..LIGHTS).map(of).collect()
}

/// Points as SVG has them, to a tenth; those that fall on one are one.
fn points(values: &[f64], most: f64) -> String {
    let point = |(i, value): (usize, &f64)| {
        let (r, angle) = (REACH * value / most, angle(i));
        // −0 would be another text than 0.
        let [x, y] = [r * angle.sin(), -r * angle.cos()].map(|x| (10.0 * x).round() / 10.0 + 0.0);
        format!("{x},{y}")
    };
    let mut points: Vec<String> = values.iter().enumerate().map(point).collect();
    points.dedup();
    points.join(" ")
}
