//! The errors of the rational approximation of G1 and of the table by γ and θ, after figure 5.

use glam::Vec3;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::{StudentT, printed};
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::Tables;

use serde::Serialize;

use crate::settings::SIGMA;

/// The errors for one view: a line of `figure-5.csv`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Approximation {
    pub(crate) gamma: f64,
    /// Polar angle of the view, degrees.
    #[serde(rename = "theta_degrees")]
    pub(crate) degrees: f64,
    /// The exact G1.
    pub(crate) g1: f64,
    /// Approximation minus exact.
    pub(crate) rational_error: f64,
    /// Table minus exact.
    pub(crate) table_error: f64,
}

/// Over θ by half degrees, for shapes that the approximation was made for, at σ = [`SIGMA`].
pub(crate) fn approximation(set: &Tables) -> Vec<Approximation> {
    let of_shape = |gamma: f64| {
        let truth = StudentT::new(SIGMA, gamma).expect("constants");
        let lobe = set.student_t(SIGMA, gamma).expect("the general set covers all shapes");
        (1..180).map(move |i| {
            let degrees = 0.5 * f64::from(i);
            let (sin, cos) = degrees.to_radians().sin_cos();
            // The view as rounded to single precision.
            let v = Vec3::new(sin as f32, 0.0, cos as f32);
            let g1 = truth.g1(v.as_dvec3());
            let z = f64::from(v.z) / (SIGMA * f64::from(v.x));
            let rational_error = 1.0 / (1.0 + printed::lambda_rational(gamma, z)) - g1;
            Approximation {
                gamma,
                degrees,
                g1,
                rational_error,
                table_error: f64::from(lobe.g1(v)) - g1,
            }
        })
    };
    [1.6, 1.8, 2.2, 3.0, 5.0, 10.0, 20.0, 40.0].into_iter().flat_map(of_shape).collect()
}
