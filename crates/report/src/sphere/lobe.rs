//! The lobe in the plane of incidence: the drawing that the script fills, and pictures at three
//! views for a browser in which no script runs.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

use glam::Vec3;
use maud::{Markup, html};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{Lobe, Masking, MaterialError, Tables};

use super::super::texts;
use super::scene::Look;

/// The length of the longest arrow, as `REACH` of lobe.js, and the number of lights of a picture.
const REACH: f64 = 150.0;
const LIGHTS: usize = 361;
const VIEWS: [u32; 3] = [15, 45, 75];
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

fn legend() -> Markup {
    html! {
        ul.legend {
            li.key-shape { "the lobe" }
            li.key-ggx { "GGX" }
            li.key-beckmann { "Beckmann" }
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
                "Light in the plane of incidence, f cos\u{a0}θ of one bounce with F\u{a0}=\u{a0}1: "
                span #lobe-name {} ", beside GGX and Beckmann of the same σ. The view is at "
                span.of-angle {} span.screen { "; drag it" } ". At the outer circle f cos\u{a0}θ is "
                span.of-scale {} "."
            }
        }
    }
}

/// Pictures of a lobe at three views.
///
/// # Errors
/// [`MaterialError`] for a shape that the tables do not cover.
pub(super) fn stills(tables: &Tables, look: &Look, name: &str) -> Result<Markup, MaterialError> {
    let lobes = look.beside(tables)?;
    Ok(html! {
        div #lobe-still .stills {
            @for view in VIEWS {
                (still(&lobes, view, name))
            }
            (legend())
            p.note { "Light in the plane of incidence, f cos\u{a0}θ of one bounce with F\u{a0}=\u{a0}1, beside \
                     GGX and Beckmann of the same σ." }
        }
    })
}

impl Look {
    fn beside(&self, tables: &Tables) -> Result<[Lobe; 3], MaterialError> {
        let of = |gamma| tables.lobe(self.sigma, gamma);
        Ok([of(self.gamma)?, of(2.0)?, of(f64::INFINITY)?])
    }

    /// f cos of one bounce with F = 1 in the plane of incidence along x, at `lights` equally spaced
    /// lights from −90° to 90°: of the lobe, of GGX and of Beckmann. The view is `degrees` from the
    /// normal, on the negative side.
    ///
    /// # Errors
    /// [`MaterialError`] for a shape that neither the set nor the default set covers.
    pub fn in_plane(
        &self,
        set: &Tables,
        degrees: f64,
        lights: usize,
    ) -> Result<[Vec<f64>; 3], MaterialError> {
        let lobes = self.beside(&set.clone().with_fallback(&Tables::embedded()))?;
        Ok(lobes.map(|lobe| values(&lobe, degrees.to_radians(), lights)))
    }
}

fn still(lobes: &[Lobe; 3], degrees: u32, name: &str) -> Markup {
    let view = f64::from(degrees).to_radians();
    let values = lobes.each_ref().map(|lobe| values(lobe, view, LIGHTS));
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
            figcaption id=(id) { (texts::name(name)) ", view at θ\u{a0}=\u{a0}" (degrees) "°" }
        }
    }
}

/// The angle of light `i` of `lights` equally spaced ones from −90° to 90°.
fn angle(i: usize, lights: usize) -> f64 {
    PI * i as f64 / (lights - 1) as f64 - FRAC_PI_2
}

/// f cos of one bounce with F = 1 at lights from −90° to 90°; the view is on the negative side.
fn values(lobe: &Lobe, view: f64, lights: usize) -> Vec<f64> {
    let at = |angle: f64| Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32);
    let v = at(-view);
    let of = |i: usize| {
        let l = at(angle(i, lights));
        let (f, _) = lobe.eval_pdf(v, l, Masking::HeightCorrelated);
        f64::from(f * l.z)
    };
    (0..lights).map(of).collect()
}

/// A curve as the points of an SVG polyline, with the largest value `most` at [`REACH`].
fn points(values: &[f64], most: f64) -> String {
    let mut text = String::new();
    let at = |(i, value): (usize, &f64)| {
        let (r, angle) = (REACH * value / most, angle(i, values.len()));
        [r * angle.sin(), -r * angle.cos()]
    };
    for [x, y] in thinned(&values.iter().enumerate().map(at).collect::<Vec<_>>()) {
        write!(text, "{x:.1},{y:.1} ").expect("memory");
    }
    text.truncate(text.trim_end().len());
    text
}

/// A subset of the points whose connecting lines pass all others within 0.1, which is not visible.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    const SEEN: f64 = 0.1;
    let strays = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2], [x, y]: [f64; 2]| {
        let along = [bx - ax, by - ay];
        let length = along[0] * along[0] + along[1] * along[1];
        let t = ((x - ax) * along[0] + (y - ay) * along[1]) / length.max(f64::MIN_POSITIVE);
        let t = t.clamp(0.0, 1.0);
        (x - ax - t * along[0]).hypot(y - ay - t * along[1]) > SEEN
    };
    let mut kept = vec![0];
    for i in 1..points.len() {
        let from = kept[kept.len() - 1];
        if (from + 1..i).any(|j| strays(points[from], points[i], points[j])) {
            kept.push(i - 1);
        }
    }
    kept.push(points.len() - 1);
    kept.into_iter().map(|i| points[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_between_the_points_that_are_kept_meet_those_that_are_not() {
        let circle: Vec<[f64; 2]> = (0..=360)
            .map(|i| f64::from(i).to_radians().sin_cos())
            .map(|(sin, cos)| [REACH * cos, REACH * sin])
            .collect();
        let kept = thinned(&circle);
        assert_eq!([kept[0], kept[kept.len() - 1]], [circle[0], circle[360]]);
        // The chord of a sagitta of 0.1 is 11 long.
        assert!((80..120).contains(&kept.len()), "{}", kept.len());
        let off = |ends: &[[f64; 2]]| {
            let middle = [0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])];
            REACH - middle[0].hypot(middle[1])
        };
        assert!(kept.windows(2).all(|ends| off(ends) < 0.11));
        // A lobe narrower than the distance between two lights keeps its length.
        let needle = [[0.0, 0.0], [0.0, 0.0], [0.0, -150.0], [0.0, 0.0], [0.0, 0.0]];
        assert!(thinned(&needle).contains(&[0.0, -150.0]));
    }
}
