//! The average of the albedo over all views.

use core::f64::consts::FRAC_PI_2;

use super::AlbedoIntegrator;
use crate::converge::{Albedo, add, differences, largest};
use crate::error::ParameterError;

/// Steps of the averaging rule: the first, and how often it is halved at most.
const COARSEST_STEP: f64 = 0.4;
const HALVINGS: i32 = 4;
/// Nodes of the averaging rule beyond this t count for less than 1e-13.
const LAST_NODE: f64 = 2.3;
/// Nodes whose share of the average is less than this may err more, in inverse proportion.
const RARE: f64 = 0.02;

impl AlbedoIntegrator {
    /// Cosine-weighted average 2∫₀¹ E(μ) μ dμ of the reflection albedo, for equal roughness σ ≥ 0.
    ///
    /// By the tanh-sinh rule over θ (Takahasi and Mori 1974,
    /// <https://doi.org/10.2977/prims/1195192451>), whose nodes crowd at both ends: E has a cusp at
    /// normal incidence and varies within the roughness at grazing. The step is halved until three
    /// successive sums show that the error aimed at is reached.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 ≤ σ < ∞.
    pub fn average<const N: usize>(
        &self,
        sigma: f64,
        weight: impl Fn(f64) -> [f64; N],
    ) -> Result<Albedo<N>, ParameterError> {
        self.over_views(&[0.0, FRAC_PI_2], |tolerance, cos| {
            self.reflection_to(tolerance, sigma, cos, &weight)
        })
    }

    /// The average over views of an albedo, given for a tolerance and cos θ, by the rule of
    /// [`average`](Self::average) in each part between these θ: nodes crowd at them as well.
    pub(crate) fn over_views<const N: usize>(
        &self,
        parts: &[f64],
        albedo: impl Fn(f64, f64) -> Result<Albedo<N>, ParameterError>,
    ) -> Result<Albedo<N>, ParameterError> {
        let (mut sum, mut error) = ([[0.0; N]; 2], 0.0);
        let (mut before, mut last_change) = (Albedo::new(sum, error), f64::INFINITY);
        let mut step = COARSEST_STEP;
        let parts: Vec<[f64; 2]> =
            parts.windows(2).map(|ends| [ends[0], ends[1]]).filter(|[a, b]| b > a).collect();
        for halving in 0..=HALVINGS {
            let nodes = libm::floor(LAST_NODE / step) as i32;
            // After the first pass only the new nodes, which lie between the old ones.
            for node in (-nodes..=nodes).filter(|node| halving == 0 || node % 2 != 0) {
                for &part in &parts {
                    let (sin, cos, measure) = tanh_sinh(part, step * f64::from(node));
                    let share = 2.0 * sin * cos * measure;
                    let tolerance = self.tolerance * (RARE / share).clamp(1.0, 1e4);
                    let albedo = albedo(tolerance, cos)?;
                    add(&mut sum, share, &albedo.both());
                    error += share * albedo.error;
                }
            }
            let now = sum.map(|form| form.map(|x| step * x));
            let change = largest(&differences(&now, &before.both()));
            // The change falls faster than geometrically.
            let ahead =
                if change == 0.0 { 0.0 } else { change * (10.0 * change / last_change).min(1.0) };
            before = Albedo::new(now, step * error + ahead);
            if halving > 1 && ahead < self.tolerance {
                break;
            }
            (last_change, step) = (change, 0.5 * step);
        }
        Ok(before)
    }
}

/// sin θ, cos θ and dθ/dt of θ = a + (b − a)/2 (1 + tanh(π/2 sinh t)) between a and b ≤ π/2.
fn tanh_sinh([a, b]: [f64; 2], t: f64) -> (f64, f64, f64) {
    let q = FRAC_PI_2 * libm::sinh(t);
    // From the distance to either end, which keeps its digits there.
    let [low, high] = [-2.0 * q, 2.0 * q].map(|x| (b - a) / (1.0 + libm::exp(x)));
    let (theta, complement) = (a + low, FRAC_PI_2 - b + high);
    let cosh = libm::cosh(q);
    let measure = 0.5 * (b - a) * FRAC_PI_2 * libm::cosh(t) / (cosh * cosh);
    (libm::sin(theta), libm::sin(complement), measure)
}
