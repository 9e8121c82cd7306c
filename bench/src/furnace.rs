//! What a user would pick instead: samplers of a Student-t material, by the noise of a white
//! furnace and the time of a sample with its weight.
//!
//! The weight is f cos θ/pdf of one reflected light, with G2 height-correlated and no Fresnel term,
//! and 0 for a light below the horizon. Its mean is the albedo E whichever way lights are drawn;
//! its variance is the noise. The rival that needs no tables of inverse CDFs draws visible normals
//! of GGX, of the σ that makes the variance least, and weights them by the ratio of densities.

use std::hint::black_box;

use glam::Vec3;
use microfacet_sampler::lobe::{PseudoVisible, Reflecting};
use microfacet_sampler::{Masking, MicrofacetDistribution, StudentT, Tables};
use serde::Serialize;

use crate::clock::{self, Calls};
use crate::figures::Figure;
use crate::files::shape;
use crate::inputs::{Inputs, direction};
use crate::rivals::conductor::GgxConductor;
use crate::settings::Settings;

/// The materials: σ, each with every γ.
const SIGMAS: [f64; 2] = [0.3, 0.5];
const GAMMAS: [f64; 4] = [1.6, 2.5, 4.0, f64::INFINITY];

/// Cosines of the views that have a column.
const VIEWS: [f32; 3] = [0.9, 0.5, 0.1];

/// The σ that GGX may have, over that of the material.
const RANGE: [f64; 2] = [0.25, 4.0];
/// Golden sections of that interval: to 1e-3 of σ.
const SECTIONS: u32 = 16;

const MASKING: Masking = Masking::HeightCorrelated;

/// Weights for views and random numbers.
type Weights<'a> = Box<dyn Fn(&[Vec3], &[[f32; 2]], &mut [f32]) + 'a>;

/// A way to sample a material.
struct Choice<'a> {
    name: &'static str,
    /// Whether it is one of the run-time crate.
    ours: bool,
    /// The σ of the lobe whose normals are drawn.
    drawn: f64,
    weights: Weights<'a>,
}

impl<'a> Choice<'a> {
    /// One call after the other, as for all rivals; `None` is a light below the horizon.
    fn new(
        name: &'static str,
        ours: bool,
        drawn: f64,
        one: impl Fn(Vec3, [f32; 2]) -> Option<f32> + 'a,
    ) -> Self {
        let weights = move |v: &[Vec3], u: &[[f32; 2]], weights: &mut [f32]| {
            for ((v, u), weight) in v.iter().zip(u).zip(weights) {
                *weight = black_box(one(*v, *u).unwrap_or(0.0));
            }
        };
        Self { name, ours, drawn, weights: Box::new(weights) }
    }
}

/// Every way to sample a material.
fn choices<'a>(sigma: f64, lobe: &StudentT, points: &Points) -> Vec<Choice<'a>> {
    let (visible, bounded, pseudo) = (lobe.clone(), lobe.clone().bounded(), lobe.clone());
    let best = best_sigma(sigma, |drawn| points.noise(&ggx(drawn, lobe)).mean);
    vec![
        Choice::new("visible normals", true, sigma, move |v, u| {
            Some(visible.sample_reflected(v, u, MASKING)?.1)
        }),
        Choice::new("visible normals, bounded", true, sigma, move |v, u| {
            Some(bounded.sample_reflected(v, u, MASKING)?.1)
        }),
        Choice::new("pseudo-visible normals", true, sigma, move |v, u| {
            let m = Vec3::from(pseudo.sample_pseudo_visible_normal(v, u));
            let facing = v.dot(m);
            let l = 2.0 * facing * m - v;
            let weight = || pseudo.g2(v, l, MASKING) * (facing / (2.0 * v.z * m.z)).max(1.0);
            (l.z > 0.0).then(weight)
        }),
        ggx(best, lobe),
    ]
}

/// Visible normals of GGX with this σ, weighted by the ratio of densities.
fn ggx<'a>(sigma: f64, lobe: &StudentT) -> Choice<'a> {
    let (rival, lobe) = (GgxConductor::new(sigma as f32, |_| [1.0; 3]), lobe.clone());
    Choice::new(GGX, false, sigma, move |v, u| {
        let (l, _, pdf) = rival.sample(v, u)?;
        Some(lobe.eval_pdf(v, l, MASKING).0 * l.z / pdf)
    })
}

const GGX: &str = "GGX's normals, weighted";

/// The σ of the least variance, by golden sections of its logarithm.
fn best_sigma(sigma: f64, variance: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let [mut low, mut high] = RANGE.map(|factor| (sigma * factor).ln());
    let inner = |from: f64, to: f64| from + GOLDEN * (to - from);
    let at = |log: f64| (log, variance(log.exp()));
    let (mut left, mut right) = (at(inner(high, low)), at(inner(low, high)));
    for _ in 0..SECTIONS {
        if left.1 < right.1 {
            (high, right) = (right.0, left);
            left = at(inner(high, low));
        } else {
            (low, left) = (left.0, right);
            right = at(inner(low, high));
        }
    }
    (if left.1 < right.1 { left } else { right }).0.exp()
}

/// Views, and random numbers that are the same for each and cover the square evenly, so that
/// variances of two choices differ by what they draw.
struct Points {
    views: Vec<f32>,
    numbers: Vec<[f32; 2]>,
}

/// The variance of a weight: for each of [`VIEWS`], and its mean over the solid angle of all views;
/// and the largest weight.
struct Noise {
    of_views: [f64; 3],
    mean: f64,
    largest: f64,
}

impl Points {
    fn new(settings: &Settings) -> Self {
        let numbers = (0..settings.draws).map(|i| {
            let [a, b, ..] = sobol_burley::sample_4d(i as u32, 0, settings.picture_seed());
            [a, b]
        });
        let views = (0..settings.views).map(|i| (i as f32 + 0.5) / settings.views as f32);
        Self { views: views.collect(), numbers: numbers.collect() }
    }

    fn noise(&self, choice: &Choice) -> Noise {
        let mut largest = 0.0_f64;
        let mut variance = |cos: &f32| {
            let weights = self.weights(choice, *cos);
            largest = weights.iter().fold(largest, |a, b| a.max(f64::from(*b)));
            let mean = mean(&weights);
            let square = |weight: &f32| (f64::from(*weight) - mean).powi(2);
            weights.iter().map(square).sum::<f64>() / weights.len() as f64
        };
        let mean = self.views.iter().map(&mut variance).sum::<f64>() / self.views.len() as f64;
        let of_views = VIEWS.each_ref().map(variance);
        Noise { of_views, mean, largest }
    }

    fn weights(&self, choice: &Choice, cos: f32) -> Vec<f32> {
        let mut weights = vec![0.0; self.numbers.len()];
        let views = vec![direction(cos, 0.0); weights.len()];
        (choice.weights)(&views, &self.numbers, &mut weights);
        weights
    }
}

fn mean(weights: &[f32]) -> f64 {
    weights.iter().map(|&weight| f64::from(weight)).sum::<f64>() / weights.len() as f64
}

/// A choice, measured: a line of `furnace.csv`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) name: &'static str,
    pub(crate) ours: bool,
    pub(crate) sigma: f64,
    #[serde(serialize_with = "shape")]
    pub(crate) gamma: f64,
    /// The σ of the lobe whose normals are drawn.
    pub(crate) drawn_sigma: f64,
    /// Variance at cos θ = 0.9, 0.5 and 0.1, and its mean over views.
    pub(crate) variance_09: f64,
    pub(crate) variance_05: f64,
    pub(crate) variance_01: f64,
    pub(crate) variance: f64,
    /// The largest weight of all views.
    pub(crate) largest: f64,
    /// Nanoseconds of a sample with its weight.
    pub(crate) ns: f64,
    /// Mean variance times nanoseconds.
    pub(crate) variance_ns: f64,
}

/// All choices for every material.
pub(crate) fn rows(set: &Tables, settings: &Settings) -> Vec<Row> {
    let materials = SIGMAS.into_iter().flat_map(|sigma| GAMMAS.map(|gamma| (sigma, gamma)));
    materials.flat_map(|(sigma, gamma)| of_material(set, settings, sigma, gamma)).collect()
}

fn of_material(set: &Tables, settings: &Settings, sigma: f64, gamma: f64) -> Vec<Row> {
    let points = Points::new(settings);
    let lobe = set.student_t(sigma, gamma).expect("it has every shape");
    let choices = choices(sigma, &lobe, &points);
    let inputs = Inputs::new(settings.seed, settings.calls);
    let mut runs: Vec<Calls> = choices.iter().map(|choice| calls(choice, &inputs)).collect();
    let times = clock::medians(&mut runs, settings.rounds, settings.calls);
    let rows = choices.iter().zip(times).map(|(choice, ns)| {
        let Noise { of_views, mean, largest } = points.noise(choice);
        Row {
            name: choice.name,
            ours: choice.ours,
            sigma,
            gamma,
            drawn_sigma: choice.drawn,
            variance_09: of_views[0],
            variance_05: of_views[1],
            variance_01: of_views[2],
            variance: mean,
            largest,
            ns,
            variance_ns: mean * ns,
        }
    });
    rows.collect()
}

/// The least variance × time of the run-time crate over GGX's, at the worst material on either side
/// of γ = 2.
pub(crate) fn figures(rows: &[Row]) -> [Figure; 2] {
    let worst = |is: fn(f64) -> bool| {
        let rivals = rows.iter().filter(|row| row.name == GGX && is(row.gamma));
        rivals.map(|rival| best(rows, rival) / rival.variance_ns).reduce(f64::max)
    };
    [
        Figure::ratio(
            "variance x ns, gamma < 2, best / GGX weighted",
            1.0,
            0.8,
            worst(|gamma| gamma < 2.0),
        ),
        Figure::ratio(
            "variance x ns, gamma > 2, best / GGX weighted",
            1.0,
            0.5,
            worst(|gamma| gamma > 2.0),
        ),
    ]
}

/// The least variance × time of the run-time crate for a rival's material.
fn best(rows: &[Row], rival: &Row) -> f64 {
    let of_it = |row: &&Row| row.ours && [row.sigma, row.gamma] == [rival.sigma, rival.gamma];
    rows.iter().filter(of_it).map(|row| row.variance_ns).fold(f64::INFINITY, f64::min)
}

fn calls<'a>(choice: &'a Choice, inputs: &'a Inputs) -> Calls<'a> {
    let mut weights = vec![0.0; inputs.views.len()];
    Box::new(move |at| {
        let (v, u) = (&inputs.views[at.clone()], &inputs.numbers[at.clone()]);
        (choice.weights)(v, u, &mut weights[at]);
        black_box(&mut weights);
    })
}

#[cfg(test)]
mod tests {
    use microfacet_model::AlbedoIntegrator;

    use super::*;
    use crate::error::material;

    /// Every choice estimates the same albedo, and GGX the better the closer it is.
    #[test]
    fn every_choice_estimates_the_albedo() {
        let (set, points) = (Tables::embedded(), Points::new(&Settings::QUICK));
        for gamma in GAMMAS {
            let sigma = 0.5;
            let lobe = set.student_t(sigma, gamma).unwrap();
            for choice in choices(sigma, &lobe, &points) {
                for cos in VIEWS {
                    let shape = *material(sigma, gamma).shape();
                    let exact = AlbedoIntegrator::new(shape, 1e-6)
                        .reflection(sigma, f64::from(cos), |_| [1.0])
                        .unwrap();
                    let [exact] = exact.of(MASKING);
                    let got = mean(&points.weights(&choice, cos));
                    let name = choice.name;
                    assert!(
                        (got / exact - 1.0).abs() < 0.02,
                        "{gamma} {cos} {name}: {got} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn ggx_samples_itself_best() {
        let (set, points) = (Tables::embedded(), Points::new(&Settings::QUICK));
        let lobe = set.student_t(0.4, 2.0).unwrap();
        let best = best_sigma(0.4, |drawn| points.noise(&ggx(drawn, &lobe)).mean);
        assert!((best / 0.4 - 1.0).abs() < 0.1, "{best}");
        let [own, other] = [0.4, 0.8].map(|drawn| points.noise(&ggx(drawn, &lobe)));
        assert!(own.mean < other.mean && own.largest < 1.01, "{} {}", own.mean, own.largest);
    }

    #[test]
    fn the_least_value_is_found() {
        let best = best_sigma(0.3, |sigma| (sigma / 0.21).ln().powi(2));
        assert!((best / 0.21 - 1.0).abs() < 2e-3, "{best}");
    }
}
