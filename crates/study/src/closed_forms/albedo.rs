//! The directional albedo E as a share of two polynomials of σ, μ = cos θ, s = 1/(γ−1) and ρ =
//! √(μ² + σ²(1−μ²)), of which the masking of GGX is made.

use microfacet_core::Masking;
use microfacet_core::shape::{gamma_of_s, s_of_gamma};
use microfacet_model::{AlbedoIntegrator, ParameterError, Shape};
use rayon::prelude::*;

use super::form::Form;
use super::measure::{Largest, crowded};
use super::share::{Samples, Terms};

/// The domain: γ from here, cosines from here, σ to 1.
const LEAST_GAMMA: f64 = 1.6;
const LEAST_COSINE: f64 = 0.02;

/// The names of the variables in a text.
pub(super) const NAMES: [&str; 4] = ["a", "rho", "mu", "s"];

fn place(sigma: f64, mu: f64, s: f64) -> [f64; 4] {
    [sigma, (mu * mu + sigma * sigma * (1.0 - mu * mu)).sqrt(), mu, s]
}

/// All terms of degree 4 in σ, μ and ρ (at most once) and 5 with s (at most twice). What is lost
/// has σ, so that a smooth surface loses nothing.
pub(super) fn terms() -> Terms {
    let mut terms = Terms::share(Vec::new(), Vec::new());
    for sigma in 0..=4 {
        for rho in 0..=1 {
            for mu in 0..=4 {
                for s in 0..=2 {
                    let degree = sigma + rho + mu;
                    if degree > 4 || degree + s > 5 {
                        continue;
                    }
                    terms.kept.push([sigma, rho, mu, s]);
                    if sigma > 0 {
                        terms.lost.push([sigma, rho, mu, s]);
                    }
                }
            }
        }
    }
    terms
}

/// E of the model, under height-correlated masking, at all of these s, σ and μ.
fn truths(s: &[f64], sigmas: &[f64], cosines: &[f64]) -> Result<Samples, ParameterError> {
    let of = |&s: &f64| -> Result<Vec<([f64; 4], f64)>, ParameterError> {
        let integrator = AlbedoIntegrator::new(Shape::from_s(s)?, 1e-6);
        let mut rows = Vec::new();
        for &sigma in sigmas {
            for &mu in cosines {
                let [e] =
                    integrator.reflection(sigma, mu, |_| [1.0])?.of(Masking::HeightCorrelated);
                rows.push((place(sigma, mu, s), e));
            }
        }
        Ok(rows)
    };
    let rows: Result<Vec<_>, ParameterError> = s.par_iter().map(of).collect();
    let (places, wanted) = rows?.into_iter().flatten().unzip();
    Ok(Samples { places, wanted })
}

/// s, σ and μ of a grid, denser towards both ends of s, small σ by a power, and small μ.
fn grid(sizes: [usize; 3], power: i32) -> [Vec<f64>; 3] {
    let most = s_of_gamma(LEAST_GAMMA);
    let powers = |n: usize| (1..=n).map(move |i| (i as f64 / n as f64).powi(power));
    let cosine = |u: f64| LEAST_COSINE + (1.0 - LEAST_COSINE) * u.powf(1.6);
    [
        crowded(sizes[0]).map(|u| most * u).collect(),
        powers(sizes[1]).collect(),
        crowded(sizes[2]).map(cosine).map(|mu| f64::min(mu, 1.0)).collect(),
    ]
}

/// What is fitted.
pub(super) fn samples(sizes: [usize; 3], power: i32) -> Result<Samples, ParameterError> {
    let [s, sigmas, cosines] = grid(sizes, power);
    truths(&s, &sigmas, &cosines)
}

/// Parts of the domain, by name.
pub(super) const PARTS: [&str; 7] =
    ["error", "γ = 1.6", "γ = 2", "γ = ∞", "σ < 0.05", "σ = 1", "μ = 0.02"];

/// The places and values that forms are checked at, between and beyond the fitted ones.
pub(super) fn check() -> Result<Samples, ParameterError> {
    let [mut s, mut sigmas, cosines] = grid([18, 29, 43], 2);
    s.push(1.0);
    sigmas.extend([1e-4, 5e-4]);
    truths(&s, &sigmas, &cosines)
}

/// The largest errors of a form in each part, computed in single precision.
pub(super) fn errors(form: &Form, check: &Samples) -> [Largest; PARTS.len()] {
    let mut parts: [Largest; PARTS.len()] = Default::default();
    for (place, wanted) in check.places.iter().zip(&check.wanted) {
        let [sigma, _, mu, s] = *place;
        let [kept, lost] = form.parts(place.map(|x| x as f32));
        let of = [
            true,
            s == s_of_gamma(LEAST_GAMMA),
            s == 1.0,
            s == 0.0,
            sigma < 0.05,
            sigma == 1.0,
            mu == LEAST_COSINE,
        ];
        let error = f64::from((kept / (kept + lost)).min(1.0)) - wanted;
        for (part, _) in parts.iter_mut().zip(of).filter(|(_, of)| *of) {
            part.take(error, [gamma_of_s(s), sigma, mu]);
        }
    }
    parts
}
