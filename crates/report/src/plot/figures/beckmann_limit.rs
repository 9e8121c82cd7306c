//! The distance of the family from its limit at large γ, after figure 10 of Ribardière et al. 2017
//! (doi:10.1111/cgf.13137), who state less than 0.5 % for the distribution and 0.3 % for masking at
//! γ = 40 and σ < 1.2. Their definition of the distance was not available; of the usual ones drawn
//! here, the mean over the hemisphere keeps both bounds at γ = 40 and exceeds both at γ = 30.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use microfacet_model::{MicrofacetDistribution, StudentT};

use crate::plot::{Axis, Curve, Dash, Figure, Key, Panel};

/// The shapes that are compared with γ = ∞; those of like colours differ in their dashes.
const GAMMAS: [f64; 4] = [30.0, 40.0, 50.0, 100.0];
const DASHES: [Dash; 4] = [Dash::Dotted, Dash::Solid, Dash::Dashed, Dash::DashDotted];
/// The range of σ, and the steps in it.
const SIGMAS: [f64; 2] = [0.05, 1.2];
const STEPS: usize = 46;
/// Polar angles, at the middles of as many intervals of [0, π/2].
const ANGLES: usize = 2000;

struct At {
    theta: f64,
    /// |ΔD| per steradian, and D(0), which is the same for both.
    d: f64,
    peak: f64,
    /// |ΔG1|, and G1 of the limit.
    g1_error: f64,
    g1: f64,
}

impl At {
    fn unit(&self) -> f64 {
        self.d / self.peak
    }
}

/// A measure of distance: its name, the unit of a hundredth of it, the printed bound in that unit,
/// and its value from all angles.
type Measure = (&'static str, &'static str, f64, fn(&[At]) -> f64);

const PER_CENT: &str = "%";

const BOUND_OF_D: f64 = 0.5;
const BOUND_OF_G1: f64 = 0.3;

const MEASURES: [Measure; 12] = [
    ("mean of |ΔD| over the hemisphere", "0.01/sr", BOUND_OF_D, |all| {
        integral(all, |at| at.d) / (2.0 * PI)
    }),
    ("largest |ΔD|/D(0)", PER_CENT, BOUND_OF_D, |all| largest(all, At::unit)),
    ("largest |ΔP₂₂|/P₂₂(0)", PER_CENT, BOUND_OF_D, |all| {
        largest(all, |at| at.unit() * at.theta.cos().powi(4))
    }),
    ("∫ |ΔD| cos θ dω", PER_CENT, BOUND_OF_D, |all| integral(all, |at| at.d * at.theta.cos())),
    ("mean over θ of |ΔD|/D(0)", PER_CENT, BOUND_OF_D, |all| mean(all, At::unit)),
    ("RMSE over θ of D/D(0)", PER_CENT, BOUND_OF_D, |all| {
        mean(all, |at| at.unit().powi(2)).sqrt()
    }),
    ("mean of |ΔG₁| over the hemisphere", PER_CENT, BOUND_OF_G1, |all| {
        integral(all, |at| at.g1_error) / (2.0 * PI)
    }),
    ("largest |ΔG₁|", PER_CENT, BOUND_OF_G1, |all| largest(all, |at| at.g1_error)),
    ("largest |ΔG₁|/G₁", PER_CENT, BOUND_OF_G1, |all| largest(all, |at| at.g1_error / at.g1)),
    ("∫ |ΔG₁| cos θ dω / π", PER_CENT, BOUND_OF_G1, |all| {
        integral(all, |at| at.g1_error * at.theta.cos()) / PI
    }),
    ("mean over θ of |ΔG₁|", PER_CENT, BOUND_OF_G1, |all| mean(all, |at| at.g1_error)),
    ("RMSE over θ of G₁", PER_CENT, BOUND_OF_G1, |all| {
        mean(all, |at| at.g1_error.powi(2)).sqrt()
    }),
];

fn largest(all: &[At], f: impl Fn(&At) -> f64) -> f64 {
    all.iter().map(f).fold(0.0, f64::max)
}

fn mean(all: &[At], f: impl Fn(&At) -> f64) -> f64 {
    all.iter().map(f).sum::<f64>() / all.len() as f64
}

/// The integral over the solid angle of the hemisphere.
fn integral(all: &[At], f: impl Fn(&At) -> f64) -> f64 {
    FRAC_PI_2 * mean(all, |at| 2.0 * PI * at.theta.sin() * f(at))
}

/// One panel for each measure: three rows for D, then three for masking.
pub(super) fn figure() -> Figure {
    let [low, high] = SIGMAS;
    let sigmas = (0..=STEPS).map(|i| low + (high - low) * i as f64 / STEPS as f64);
    let of_gamma =
        GAMMAS.map(|gamma| sigmas.clone().map(|sigma| distances(sigma, gamma)).collect::<Vec<_>>());
    let panel = |(title, unit, bound, measure): Measure| {
        let curve = |((gamma, dash), all): ((f64, Dash), &Vec<Vec<At>>)| {
            let points = sigmas.clone().zip(all.iter().map(|all| 100.0 * measure(all)));
            Curve::new(Key::Gamma(gamma), format!("γ = {gamma}"), points).dashed(dash)
        };
        let mut curves: Vec<Curve> =
            GAMMAS.into_iter().zip(DASHES).zip(&of_gamma).map(curve).collect();
        let printed = [(0.0, bound), (high, bound)];
        let bound = Curve::new(Key::Nth(8), "bound printed for γ = 40", printed);
        curves.push(bound.dashed(Dash::LongDashed));
        let highest = curves.iter().flat_map(|curve| &curve.points).map(|p| p.1);
        let y = Axis::linear(format!("distance ({unit})"), 0.0, 1.05 * highest.fold(0.0, f64::max));
        Panel::new(title, Axis::linear("roughness σ", 0.0, high), y, curves)
    };
    Figure::new(MEASURES.map(panel))
}

fn distances(sigma: f64, gamma: f64) -> Vec<At> {
    let of = |gamma| StudentT::new(sigma, gamma).expect("the figure's own parameters");
    let (family, limit) = (of(gamma), of(f64::INFINITY));
    let peak = limit.d(DVec3::Z);
    let at = |theta: f64| {
        let w = DVec3::new(theta.sin(), 0.0, theta.cos());
        let g1 = limit.g1(w);
        let (d, g1_error) = ((family.d(w) - limit.d(w)).abs(), (family.g1(w) - g1).abs());
        At { theta, d, peak, g1_error, g1 }
    };
    (0..ANGLES).map(|i| at(FRAC_PI_2 * (i as f64 + 0.5) / ANGLES as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_falls_like_one_over_gamma() {
        for panel in figure().panels {
            let of =
                |gamma| panel.curves.iter().find(|curve| curve.key == Key::Gamma(gamma)).unwrap();
            for (a, b) in of(50.0).points.iter().zip(&of(100.0).points) {
                let ratio = a.1 / b.1;
                assert!((1.9..2.2).contains(&ratio), "{} at {}: {ratio}", panel.title, a.0);
            }
        }
    }

    #[test]
    fn the_mean_over_the_hemisphere_keeps_the_printed_bounds_from_gamma_40() {
        let panels = figure().panels;
        let means: Vec<_> =
            panels.iter().filter(|panel| panel.title.starts_with("mean of")).collect();
        for (panel, bound) in means.iter().zip([BOUND_OF_D, BOUND_OF_G1]) {
            let highest = |gamma| {
                let curve = panel.curves.iter().find(|curve| curve.key == Key::Gamma(gamma));
                curve.unwrap().points.iter().map(|p| p.1).fold(0.0, f64::max)
            };
            assert!(highest(40.0) < bound && highest(30.0) > bound, "{}", panel.title);
        }
        assert_eq!(means.len(), 2);
    }

    /// In the slope r, with x = r²/σ², the first term is e⁻ˣ (x²/2 − x)/γ, largest at x = 2 − √2.
    #[test]
    fn the_distance_of_slopes_is_that_of_its_series() {
        let x = 2.0 - 2_f64.sqrt();
        let series = (-x).exp() * (x - 0.5 * x * x);
        let all = distances(0.5, 1e4);
        let found = 1e4 * largest(&all, |at| at.unit() * at.theta.cos().powi(4));
        assert!((found / series - 1.0).abs() < 1e-3, "{found} {series}");
    }
}
