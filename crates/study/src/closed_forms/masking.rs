//! Masking G1 as a share of two polynomials. It depends on s = 1/(γ−1) and on z = cot θ/σ alone,
//! and z enters as c/t, so that both ends of it are finite: the terms of a degree n are
//! c^i t^(n−i) s^j.

use std::f64::consts::PI;

use microfacet_core::shape::s_of_gamma;
use microfacet_model::Shape;

use super::form::Form;
use super::measure::{Largest, crowded};
use super::share::{Samples, Terms};

/// The least γ that is fitted.
const LEAST_GAMMA: f64 = 1.501;

/// The names of the variables in a text: cos θ, σ sin θ, s.
pub(super) const NAMES: [&str; 4] = ["c", "t", "s", ""];

/// G1 of the model.
fn truth(shape: &Shape, z: f64) -> f64 {
    1.0 / (1.0 + shape.lambda(shape.asinh_slope(z)))
}

/// c and t of z.
fn place(z: f64, s: f64) -> [f64; 4] {
    [z / (1.0 + z), 1.0 / (1.0 + z), s, 0.0]
}

/// All terms of a degree that a search begins with, s up to its cube. None that is kept is without
/// c, so that G1 is 0 at the horizon.
pub(super) fn terms(degree: u8) -> Terms {
    let all = |c: u8| (0..4).map(move |s| [c, degree - c, s, 0]);
    let kept = (1..=degree).flat_map(all).collect();
    let lost = (0..=degree).flat_map(all).filter(|term| term[0] < degree || term[2] < 3).collect();
    Terms::share(kept, lost)
}

/// The z that are fitted: the share q ∈ (0, 1) of z + 1, and of z and the area at grazing, which
/// grows as 1/(2−s).
fn cotangents(s: f64, n: usize) -> impl Iterator<Item = f64> {
    let middles = (0..n).map(move |i| 0.5 * (1.0 - libm::cos(PI * (i as f64 + 0.5) / n as f64)));
    middles.flat_map(move |q| [1.0, 0.8 / (2.0 - s)].map(|scale| scale * q / (1.0 - q)))
}

/// What is fitted, at `shapes` times 2 `views` places.
pub(super) fn samples(shapes: usize, views: usize) -> Samples {
    let mut samples = Samples { places: Vec::new(), wanted: Vec::new() };
    for u in crowded(shapes) {
        let shape = Shape::from_s(u * s_of_gamma(LEAST_GAMMA)).expect("in the family");
        for z in cotangents(shape.s(), views) {
            samples.places.push(place(z, shape.s()));
            samples.wanted.push(truth(&shape, z));
        }
    }
    samples
}

/// A plain polynomial: powers to the fourth of q = z/(z + 1.3/(2−s)) and s, at its own places. The
/// factor is the best of a few that were tried.
pub(super) fn plain(samples: &Samples) -> (Terms, Samples) {
    let all = |q: u8| (0..5).map(move |s| [q, s, 0, 0]);
    let terms = Terms::polynomial((0..5).flat_map(all).collect());
    let places = samples.places.iter().map(|[c, t, s, _]| plain_place(c / t, *s));
    (terms, Samples { places: places.collect(), wanted: samples.wanted.clone() })
}

/// q and s.
pub(super) fn plain_place(z: f64, s: f64) -> [f64; 4] {
    [z / (z + 1.3 / (2.0 - s)), s, 0.0, 0.0]
}

/// Parts of the domain, by name: γ, and the unit cotangent z, small at grazing.
pub(super) const PARTS: [&str; 5] = ["error", "γ = 1.501", "γ = ∞", "z < 0.01", "z > 100"];

/// Largest errors in each part, and the largest excess over 1 of the formula without its limit.
pub(super) struct Errors {
    pub(super) parts: [Largest; PARTS.len()],
    pub(super) above: f64,
}

/// The errors of min(1, G1) by a formula of γ, s and z, over places between the fitted ones and
/// towards both ends, for γ up to `most`.
pub(super) fn errors(most: f64, g1: impl Fn(f64, f64, f64) -> f64) -> Errors {
    let mut errors = Errors { parts: Default::default(), above: f64::NEG_INFINITY };
    for i in 0..=SHAPES {
        let s = s_of_gamma(LEAST_GAMMA) * f64::from(i) / f64::from(SHAPES);
        let shape = Shape::from_s(s).expect("in the family");
        let gamma = shape.gamma();
        if gamma > most {
            continue;
        }
        let far = (-60..=80).map(|i| libm::exp10(0.1 * f64::from(i)));
        for z in cotangents(s, 211).chain(far) {
            let raw = g1(gamma, s, z);
            errors.above = errors.above.max(raw - 1.0);
            // `min` would take 1 for what is no number.
            let limited = if raw > 1.0 { 1.0 } else { raw };
            let of = [true, i == SHAPES, i == 0, z < 0.01, z > 100.0];
            for (part, _) in errors.parts.iter_mut().zip(of).filter(|(_, of)| *of) {
                part.take(limited - truth(&shape, z), [gamma, z, 0.0]);
            }
        }
    }
    errors
}

/// Shapes that are checked, evenly in s.
const SHAPES: u32 = 250;

/// G1 of a form in single precision, without its limit.
pub(super) fn single(form: &Form, s: f64, z: f64) -> f64 {
    let [kept, lost] = form.parts(place(z, s).map(|x| x as f32));
    f64::from(kept / (kept + lost))
}
