//! D of lobes against the model in double precision, for a roughness and for normals of every order
//! of magnitude.

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_sampler::{MicrofacetDistribution, Skew, Tables};

/// γ, and the relative error of D. Up to γ = 16 D is read from a table, and rounding of the slope
/// of a normal counts γ times; beyond, D comes of a logarithm, whose size counts as well.
const ERRORS: [(f64, f64); 14] = [
    (1.501, 9e-7),
    (1.55, 1e-6),
    (1.6, 9e-7),
    (1.9, 1.1e-6),
    (2.0, 5.5e-7),
    (2.5, 1.1e-6),
    (4.0, 1.5e-6),
    (7.3, 2.3e-6),
    (15.0, 4.2e-6),
    (16.0, 4.7e-6),
    (16.001, 8.5e-6),
    (40.0, 1.1e-5),
    (1e4, 1.4e-5),
    (f64::INFINITY, 9e-6),
];

/// The error for γ ≤ 16 where (slope/σ)² leaves single precision, which no table covers.
const ON_THE_HORIZON: f64 = 7.5e-6;

/// Normals of the lobe, and others down to the horizon.
fn normals(gamma: f64, [x, y]: [f64; 2]) -> impl Iterator<Item = Vec3> {
    let s = 1.0 / (gamma - 1.0);
    let of_lobe = (0..2000).map(move |i| {
        // P(slope > x) = (1 + s x²)^(−1/s), which falls to 1e-12.
        let log = -27.6 * (f64::from(i) * 0.618_034).fract();
        let slope = (if s == 0.0 { -log } else { (-s * log).exp_m1() / s }).sqrt();
        let (sin, cos) = f64::from(i).sin_cos();
        DVec3::new(x * slope * cos, y * slope * sin, 1.0)
    });
    let low = (0..189).map(|i| {
        let z = 10.0_f64.powf(-0.1 * f64::from(i));
        let (sin, cos) = f64::from(i).sin_cos();
        DVec3::new(cos, sin, z / (1.0 - z * z).sqrt().max(1e-9))
    });
    // A square of z that is subnormal has lost its digits.
    of_lobe.chain(low).map(|m| m.normalize().as_vec3()).filter(|m| m.z > 1.2e-19)
}

/// Whether D of the lobe is that of the truth at the normals of roughness `sigma`.
fn check(
    lobe: &impl MicrofacetDistribution,
    truth: &impl model::MicrofacetDistribution,
    sigma: [f64; 2],
    (gamma, limit): (f64, f64),
) {
    let mut in_range = 0;
    for m in normals(gamma, sigma) {
        let [x, y] = [f64::from(m.x) / sigma[0], f64::from(m.y) / sigma[1]];
        let growth = (x * x + y * y) / (gamma - 1.0) / f64::from(m.z).powi(2);
        let limit = if growth > 3.4e38 { limit.max(ON_THE_HORIZON) } else { limit };
        let (d, exact) = (lobe.d(m), truth.d(m.as_dvec3()));
        if exact > f64::from(f32::MAX) {
            assert!(d > 0.999_99 * f32::MAX && d.is_finite(), "{gamma} {sigma:?} {m:?}: {d:e}");
        } else if exact < f64::from(f32::MIN_POSITIVE) {
            assert!((0.0..=f32::MIN_POSITIVE).contains(&d), "{gamma} {sigma:?} {m:?}: {d:e}");
        } else {
            let error = f64::from(d) / exact - 1.0;
            assert!(error.abs() < limit, "{gamma} {sigma:?} {m:?}: {error:e}");
            in_range += 1;
        }
    }
    assert!(in_range > 100, "{gamma} {sigma:?}: {in_range}");
    // At the horizon, below it, and what is not a number.
    let outside = [Vec3::X, Vec3::new(0.6, 0.0, -0.8), -Vec3::Z, Vec3::NAN];
    assert_eq!(outside.map(|m| lobe.d(m)), [0.0; 4], "{gamma} {sigma:?}");
}

#[test]
fn d_is_the_models_for_every_roughness() {
    for of in ERRORS {
        for sigma in
            [[1e-8; 2], [1e-3, 0.01], [0.3, 0.5], [4.0, 4.0], [1e-8, 1e6], [1e6, 1e-8], [1e6; 2]]
        {
            let lobe = Tables::embedded().student_t(sigma, of.0).unwrap();
            let truth = model::StudentT::new(lobe.sigma().map(f64::from), of.0).unwrap();
            check(&lobe, &truth, sigma, of);
        }
    }
}

#[test]
fn d_is_the_models_for_matrices_of_extreme_entries() {
    for of in ERRORS {
        for [p, r] in [[1e-18_f32; 2], [1e18; 2], [1e-18, 0.3], [1e12, 0.3]] {
            // There s (slope/σ)² is subnormal, and has lost its digits.
            if p == 1e18 && of.0 > 40.0 {
                continue;
            }
            let sigma = [p, r].map(f64::from);
            let skew = Skew { p: sigma[0], q: 0.0, r: sigma[1], x: 0.0, y: 0.0 };
            let lobe = Tables::embedded().ellipsoid(skew, of.0).unwrap();
            let truth = model::Ellipsoid::new(skew, of.0).unwrap();
            check(&lobe, &truth, sigma, of);
        }
    }
}
