//! The family by γ and by σ: its density of slopes and its masking, as in figure 3 of Ribardière et
//! al. 2017 (doi:10.1111/cgf.13137).

use glam::DVec3;
use microfacet_model::{MicrofacetDistribution, StudentT};

use crate::plot::figures::curve;
use crate::plot::{Axis, Dash, Figure, Key, Panel, shape_name};

/// The shapes at σ = [`SIGMA`], and the roughnesses at γ = [`GAMMA`].
const GAMMAS: [f64; 5] = [1.6, 2.0, 3.0, 5.0, f64::INFINITY];
const SIGMAS: [f64; 5] = [0.2, 0.35, 0.5, 0.75, 1.0];
/// The dashes of [`SIGMAS`].
const DASHES: [Dash; 5] =
    [Dash::Solid, Dash::LongDashed, Dash::Dashed, Dash::DashDotted, Dash::Dotted];
const SIGMA: f64 = 0.5;
const GAMMA: f64 = 3.0;

/// P22 on a logarithmic scale, since the shapes differ in their tails, and G1.
pub(super) fn figure() -> Figure {
    let of = |sigma, gamma| StudentT::new(sigma, gamma).expect("the figure's own parameters");
    let by_gamma = GAMMAS.map(|g| (Key::Gamma(g), None, shape_name(g), of(SIGMA, g)));
    let by_sigma = std::array::from_fn(|i| {
        let s = SIGMAS[i];
        (Key::Sigma(s), Some(DASHES[i]), format!("σ = {s}"), of(s, GAMMA))
    });
    let rows = [(format!("σ = {SIGMA}"), by_gamma), (format!("γ = {GAMMA}"), by_sigma)];
    let p22 = |of: &StudentT, x: f64| of.p22(x, 0.0);
    let g1 = |of: &StudentT, theta: f64| {
        let (sin, cos) = theta.to_radians().sin_cos();
        of.g1(DVec3::new(sin, 0.0, cos))
    };
    let panels = rows.iter().flat_map(|(fixed, row)| {
        let curves = |x: &Axis, f: fn(&StudentT, f64) -> f64| {
            let drawn = row.iter().map(|(key, dash, name, of)| {
                let curve = curve(*key, name, x, |at| f(of, at));
                let own = curve.dash;
                curve.dashed(dash.unwrap_or(own))
            });
            drawn.collect::<Vec<_>>()
        };
        let slopes = Axis::linear("slope x, at y = 0", -8.0, 8.0);
        let angles = Axis::degrees("angle θ of the view", 0.0, 90.0);
        let [of_slopes, of_angles] = [curves(&slopes, p22), curves(&angles, g1)];
        let density = format!("Density of slopes, {fixed}");
        let masking = format!("Masking, {fixed}");
        [
            Panel::new(density, slopes, Axis::log("density P₂₂(x, 0)", 1e-8, 20.0), of_slopes),
            Panel::new(masking, angles, Axis::linear("masking G₁(θ)", 0.0, 1.05), of_angles),
        ]
    });
    Figure::new(panels)
}
