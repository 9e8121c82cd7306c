//! The family by γ and by σ: its density of slopes and its masking, as in figure 3 of Ribardière et
//! al. 2017 (doi:10.1111/cgf.13137).

use glam::DVec3;
use microfacet_model::{MicrofacetDistribution, StudentT};

use crate::plot::figures::curve;
use crate::plot::{Axis, Curve, Figure, Key, Panel};

/// The shapes at σ = [`SIGMA`], and the roughnesses at γ = [`GAMMA`].
const GAMMAS: [f64; 5] = [1.6, 2.0, 3.0, 5.0, 40.0];
const SIGMAS: [f64; 5] = [0.2, 0.35, 0.5, 0.75, 1.0];
const SIGMA: f64 = 0.5;
const GAMMA: f64 = 3.0;

/// P22 on a logarithmic scale, for the shapes differ in their tails, and G1.
pub(super) fn figure() -> Figure {
    let by_gamma = GAMMAS.map(|g| (Key::Gamma(g), format!("γ = {g}"), of(SIGMA, g)));
    let by_sigma = SIGMAS.map(|s| (Key::Sigma(s), format!("σ = {s}"), of(s, GAMMA)));
    let rows = [(format!("σ = {SIGMA}"), by_gamma), (format!("γ = {GAMMA}"), by_sigma)];
    Figure::new(
        rows.iter().flat_map(|(fixed, row)| [slopes(fixed, row), masking(fixed, row)]).collect(),
    )
}

type Row = [(Key, String, StudentT); 5];

fn of(sigma: f64, gamma: f64) -> StudentT {
    StudentT::new(sigma, gamma).expect("the figure's own parameters")
}

fn slopes(fixed: &str, row: &Row) -> Panel {
    let x = Axis::linear("slope x (slope y = 0)", -8.0, 8.0);
    let curves = row.iter().map(|(key, name, t)| curve(*key, name.clone(), &x, |x| t.p22(x, 0.0)));
    let curves: Vec<Curve> = curves.collect();
    Panel {
        title: format!("Density of slopes, {fixed}"),
        y: Axis::log("P22", 1e-8, 20.0),
        x,
        curves,
        marks: Vec::new(),
    }
}

fn masking(fixed: &str, row: &Row) -> Panel {
    let x = Axis::linear("θ in degrees", 0.0, 90.0);
    let g1 = |t: &StudentT, theta: f64| {
        let (sin, cos) = theta.to_radians().sin_cos();
        t.g1(DVec3::new(sin, 0.0, cos))
    };
    let curves = row.iter().map(|(key, name, t)| curve(*key, name.clone(), &x, |x| g1(t, x)));
    let curves: Vec<Curve> = curves.collect();
    Panel {
        title: format!("Masking, {fixed}"),
        y: Axis::linear("G1", 0.0, 1.05),
        x,
        curves,
        marks: Vec::new(),
    }
}
