//! What another computation of G1 changes in a picture of rough gold, after figure 6: the same
//! renderer and the same random numbers, with the exact G1 and with another.

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::{self as sampler, StudentT, Tables};
use microfacet_study::spheres::sky::Sky;
use rayon::prelude::*;
use serde::Serialize;

use super::studio::Metal;
use crate::rivals::rational::Rational;
use crate::settings::{Film, SIGMA, Settings};

/// The shapes; the roughness is [`SIGMA`].
pub(super) const SHAPES: [f64; 5] = [1.6, 2.2, 3.0, 10.0, 40.0];
/// The computations of G1 that are compared with the exact one.
pub(super) const FORMS: [&str; 3] = ["rational, as printed", "rational, at most 1", "table"];

/// With this exposure the brightest highlight is just below white.
const EXPOSURE: f64 = 0.8;

/// Radiance by pixel, line by line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    pub(crate) film: Film,
    pub(crate) pixels: Vec<DVec3>,
}

/// How far a picture is from the exact one, over the pixels that show the sphere: a line of
/// `figure-6.csv`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Difference {
    pub(crate) gamma: f64,
    /// Of [`FORMS`].
    pub(crate) form: &'static str,
    /// Root mean square over pixels and channels, of radiance.
    pub(crate) rmse: f64,
    /// `rmse` over the mean radiance of the exact picture.
    #[serde(rename = "relative_rmse")]
    pub(crate) relative: f64,
    /// The RMSE of the picture encoded as sRGB, in steps of 1/255.
    #[serde(rename = "rmse_steps")]
    pub(crate) steps: f64,
    /// The largest difference of a pixel and channel, in steps of 1/255.
    #[serde(rename = "max_steps")]
    pub(crate) most_steps: f64,
    /// The largest difference of radiance over the channels, for each pixel.
    #[serde(skip)]
    pub(crate) pixels: Vec<f64>,
}

/// A shape: the exact picture, and the differences of the others from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Compared {
    pub(crate) gamma: f64,
    pub(crate) exact: Picture,
    /// Its mean radiance, over the pixels that show the sphere and the channels.
    pub(crate) mean: f64,
    pub(crate) differences: Vec<Difference>,
}

pub(crate) fn compared(set: &Tables, settings: &Settings) -> Vec<Compared> {
    SHAPES.map(|gamma| Compared::new(set, gamma, settings.shown, settings.picture_seed())).into()
}

impl Compared {
    fn new(set: &Tables, gamma: f64, film: Film, seed: u32) -> Self {
        let truth = model::StudentT::new(SIGMA, gamma).expect("constants");
        let lobe = set.student_t(SIGMA, gamma).expect("the general set covers all shapes");
        let rational = Rational::new(SIGMA, gamma);
        let exact = picture(&lobe, |w| truth.g1(w.as_dvec3()) as f32, film, seed);
        let others = [
            picture(&lobe, |w| rational.g1(w), film, seed),
            picture(&lobe, |w| rational.g1(w).min(1.0), film, seed),
            picture(&lobe, |w| lobe.g1(w), film, seed),
        ];
        let differences = FORMS
            .into_iter()
            .zip(&others)
            .map(|(form, other)| exact.difference(gamma, form, other));
        Self { gamma, mean: exact.mean(), differences: differences.collect(), exact }
    }
}

/// Rough gold in the studio, on all cores.
fn picture(lobe: &StudentT, g1: impl Fn(Vec3) -> f32 + Sync, film: Film, seed: u32) -> Picture {
    let (gold, sky) = (Metal::new(lobe.clone(), g1, sampler::Metal::Gold.into()), Sky::studio());
    let lines = (0..film.edge).into_par_iter();
    let lines = lines.map(|y| film.line(y, &gold, &sky, seed).collect::<Vec<_>>());
    Picture { film, pixels: lines.collect::<Vec<_>>().concat() }
}

impl Picture {
    /// The pixels that show the sphere.
    fn covered(&self) -> impl Iterator<Item = usize> {
        let Film { edge, .. } = self.film;
        (0..self.pixels.len()).filter(move |i| self.film.is_covered([i % edge, i / edge]))
    }

    fn mean(&self) -> f64 {
        let sum: f64 = self.covered().map(|i| self.pixels[i].element_sum()).sum();
        sum / (3 * self.covered().count()) as f64
    }

    fn difference(&self, gamma: f64, form: &'static str, other: &Self) -> Difference {
        let [mut squares, mut shown, mut most, mut count] = [0.0_f64; 4];
        for i in self.covered() {
            let (a, b) = (self.pixels[i], other.pixels[i]);
            let steps = 255.0 * (srgb(a) - srgb(b)).abs();
            squares += (a - b).length_squared();
            shown += steps.length_squared();
            most = most.max(steps.max_element());
            count += 3.0;
        }
        let rmse = (squares / count).sqrt();
        let pixels = self.pixels.iter().zip(&other.pixels);
        Difference {
            gamma,
            form,
            rmse,
            relative: rmse / self.mean(),
            steps: (shown / count).sqrt(),
            most_steps: most,
            pixels: pixels.map(|(a, b)| (a - b).abs().max_element()).collect(),
        }
    }
}

/// Radiance exposed and encoded as sRGB.
pub(super) fn srgb(radiance: DVec3) -> DVec3 {
    let shown = |x: f64| microfacet_report::srgb((EXPOSURE * x).clamp(0.0, 1.0));
    DVec3::from(radiance.to_array().map(shown))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILM: Film = Film { edge: 16, samples: 4 };

    #[test]
    fn the_same_form_twice_makes_no_difference_and_a_seed_does() {
        let lobe = Tables::embedded().student_t(SIGMA, 3.0).unwrap();
        let truth = model::StudentT::new(SIGMA, 3.0).unwrap();
        let exact = |seed| picture(&lobe, |w| truth.g1(w.as_dvec3()) as f32, FILM, seed);
        let none = exact(1).difference(3.0, "itself", &exact(1));
        assert_eq!([none.rmse, none.relative, none.steps, none.most_steps], [0.0; 4]);
        assert!(none.pixels.iter().all(|&x| x == 0.0));
        assert!(exact(1).difference(3.0, "another seed", &exact(2)).rmse > 0.01);
    }

    /// A factor of 1 + a on G1 is one of (1 + a)² on radiance.
    #[test]
    fn a_known_error_of_masking_has_its_rmse() {
        let lobe = Tables::embedded().student_t(SIGMA, 3.0).unwrap();
        let exact = picture(&lobe, |w| lobe.g1(w), FILM, 1);
        let other = picture(&lobe, |w| 1.05 * lobe.g1(w), FILM, 1);
        let squares: f64 = exact.covered().map(|i| exact.pixels[i].length_squared()).sum();
        let want = (1.05 * 1.05 - 1.0) * (squares / (3 * exact.covered().count()) as f64).sqrt();
        let got = exact.difference(3.0, "", &other);
        assert!((got.rmse / want - 1.0).abs() < 1e-4, "{} for {want}", got.rmse);
        assert!(got.relative > 0.1 && got.most_steps >= got.steps && got.steps > 1.0, "{got:?}");
    }

    #[test]
    fn tables_differ_less_than_the_rational_approximation() {
        let at = Compared::new(&Tables::embedded(), 3.0, FILM, 1);
        let rmse = |i: usize| at.differences[i].rmse;
        assert!(rmse(0) > 1e-4 && rmse(1) > 1e-4 && rmse(2) < 1e-6, "{at:?}");
    }
}
