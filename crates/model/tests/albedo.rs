//! Directional albedos against independent quadratures, limits and identities.

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_model::fresnel::{self, Dielectric, schlick_weight};
use microfacet_model::{
    AlbedoIntegrator, Masking, MicrofacetDistribution, ParameterError, Shape, StudentT,
};

/// The rows of a data file as text, header dropped; see `reference.rs` for the folder.
fn rows(name: &str) -> Vec<Vec<String>> {
    let folder = std::env::var("MICROFACET_REFERENCE")
        .unwrap_or_else(|_| format!("{}/tests/data", env!("CARGO_MANIFEST_DIR")));
    let text = std::fs::read_to_string(format!("{folder}/{name}")).expect("reference file");
    let rows: Vec<_> =
        text.lines().skip(1).map(|row| row.split(',').map(String::from).collect()).collect();
    assert!(rows.len() >= 25, "{name} has too few rows to mean anything");
    rows
}

fn masking(name: &str) -> Masking {
    match name {
        "uncorrelated" => Masking::Uncorrelated,
        "height-correlated" => Masking::HeightCorrelated,
        _ => panic!("masking {name}"),
    }
}

fn schlick(cos: f64) -> [f64; 2] {
    [1.0 - schlick_weight(cos), schlick_weight(cos)]
}

#[test]
fn schlick_parts_match_the_reference() {
    for tolerance in [1e-6, 1e-10] {
        let mut worst = 0.0_f64;
        for row in rows("albedo.csv") {
            let f = |i: usize| row[i].parse::<f64>().expect("number");
            let integrator = AlbedoIntegrator::new(Shape::new(f(1)).unwrap(), tolerance);
            let albedo = integrator.reflection(f(0), f(2), schlick).unwrap();
            let [scale, bias] = albedo.of(masking(&row[3]));
            let error = (scale - f(5)).abs().max((bias - f(6)).abs());
            worst = worst.max(error);
            assert!(albedo.error < tolerance, "{row:?}: estimate {:e}", albedo.error);
            assert!(error < tolerance, "{row:?}: error {error:e}, estimate {:e}", albedo.error);
        }
        println!("tolerance {tolerance:e}: worst error {worst:e}");
    }
}

#[test]
fn anisotropic_views_match_the_reference() {
    for row in rows("albedo_aniso.csv") {
        let f = |i: usize| row[i].parse::<f64>().expect("number");
        let integrator = AlbedoIntegrator::new(Shape::new(f(2)).unwrap(), 1e-6);
        let albedo =
            integrator.reflection_anisotropic([f(0), f(1)], f(3), f(4), |_| [1.0]).unwrap();
        let error = (albedo.of(masking(&row[5]))[0] - f(6)).abs();
        assert!(
            albedo.error < 1e-6 && error < 1e-6,
            "{row:?}: error {error:e}, estimate {:e}",
            albedo.error
        );
    }
}

#[test]
fn averages_match_the_reference() {
    for row in rows("albedo_avg.csv") {
        let f = |i: usize| row[i].parse::<f64>().expect("number");
        let integrator = AlbedoIntegrator::new(Shape::new(f(1)).unwrap(), 1e-7);
        let albedo = integrator.average(f(0), |_| [1.0]).unwrap();
        let error = (albedo.of(masking(&row[2]))[0] - f(3)).abs();
        assert!(
            error < albedo.error && albedo.error < 1e-5,
            "{row:?}: error {error:e} of {:e}",
            albedo.error
        );
    }
}

/// E by brute force: f cos θ_l with F = 1 over the hemisphere of l, in solid angle, by the midpoint
/// rule.
fn brute_force(material: &StudentT, v: DVec3, masking: Masking) -> f64 {
    let (rings, sectors) = (800, 800);
    let mut sum = 0.0;
    for i in 0..rings {
        let (sin, cos) = libm::sincos(0.5 * PI * (i as f64 + 0.5) / rings as f64);
        for j in 0..sectors {
            let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * (j as f64 + 0.5) / sectors as f64);
            let l = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
            let m = (v + l).normalize();
            sum += sin * material.d(m) * material.g2(v, l, masking) / (4.0 * v.z);
        }
    }
    sum * 0.5 * PI / rings as f64 * 2.0 * PI / sectors as f64
}

#[test]
fn albedo_is_the_integral_over_light_directions() {
    for (sigma, gamma, cos) in
        [([0.5, 0.5], 2.0, 0.6), ([0.8, 0.3], 3.0, 0.35), ([0.4, 0.4], f64::INFINITY, 0.8)]
    {
        let material = StudentT::new([sigma[0], sigma[1]], gamma).unwrap();
        let (sin, phi) = (f64::sqrt(1.0 - cos * cos), 0.7);
        let (sin_phi, cos_phi) = libm::sincos(phi);
        let v = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
        let integrator = AlbedoIntegrator::new(*material.shape(), 1e-8);
        let albedo = integrator.reflection_anisotropic(sigma, cos, phi, |_| [1.0]).unwrap();
        for masking in [Masking::Uncorrelated, Masking::HeightCorrelated] {
            let want = brute_force(&material, v, masking);
            let got = albedo.of(masking)[0];
            // The midpoint rule is of second order in steps of 2e-3.
            assert!(
                (got - want).abs() < 2e-5,
                "sigma {sigma:?}, gamma {gamma}: {got} against {want}"
            );
        }
    }
}

#[test]
fn equal_roughness_takes_no_notice_of_azimuth() {
    let integrator = AlbedoIntegrator::new(Shape::new(1.7).unwrap(), 1e-8);
    let isotropic = integrator.reflection(0.4, 0.3, schlick).unwrap();
    // Nearly equal roughnesses take the anisotropic path round the whole circle.
    let near = integrator.reflection_anisotropic([0.4, 0.4 + 1e-12], 0.3, 2.0, schlick).unwrap();
    for i in 0..2 {
        assert!((isotropic.uncorrelated[i] - near.uncorrelated[i]).abs() < 1e-8);
        assert!((isotropic.height_correlated[i] - near.height_correlated[i]).abs() < 1e-8);
    }
}

/// Isotropic lobes have a quadrature of their own; that of anisotropic ones, for roughnesses that
/// hardly differ, shares neither its rays nor its error estimate.
#[test]
fn both_quadratures_agree_within_their_estimates() {
    let panes = [1.5, 1.02].map(|eta| Dielectric::new(eta).unwrap());
    let weights =
        |cos| [1.0, fresnel::f82_weight(cos), panes[0].reflectance(cos), panes[1].reflectance(cos)];
    for gamma in [1.501, 1.6, 2.0, 2.9, 3.6, f64::INFINITY] {
        let shape = Shape::new(gamma).unwrap();
        let fine = AlbedoIntegrator::new(shape, 1e-8);
        for tolerance in [1e-5, 1e-7] {
            let round = AlbedoIntegrator::new(shape, tolerance);
            for sigma in [1e-3, 0.06, 0.5, 2.0] {
                for cos in [1e-4, 0.02, 0.15, 0.7, 0.998, 1.0] {
                    let a = round.reflection(sigma, cos, weights).unwrap();
                    let sigmas = [sigma, sigma * (1.0 + 1e-12)];
                    let b = fine.reflection_anisotropic(sigmas, cos, 0.7, weights).unwrap();
                    assert!(a.error < tolerance, "gamma {gamma}, sigma {sigma}, cos {cos}");
                    for masking in [Masking::Uncorrelated, Masking::HeightCorrelated] {
                        for (x, y) in a.of(masking).iter().zip(b.of(masking)) {
                            let off = (x - y).abs();
                            assert!(
                                off <= a.error + b.error,
                                "gamma {gamma}, sigma {sigma}, cos {cos}: {off:e} of {:e}",
                                a.error + b.error
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_domain_has_an_estimate_that_holds() {
    let weights = |cos| [1.0 - schlick_weight(cos), schlick_weight(cos), fresnel::f82_weight(cos)];
    for gamma in [1.501, 1.6, 2.0, 3.6, 20.0, f64::INFINITY] {
        let shape = Shape::new(gamma).unwrap();
        let (coarse, fine) =
            (AlbedoIntegrator::new(shape, 1e-6), AlbedoIntegrator::new(shape, 1e-8));
        for sigma in [1e-4, 0.01, 0.1, 0.7, 3.0] {
            for cos in [1e-6, 1e-3, 0.02, 0.3, 0.9, 1.0] {
                let a = coarse.reflection(sigma, cos, weights).unwrap();
                let b = fine.reflection(sigma, cos, weights).unwrap();
                assert!(
                    a.error < 1e-6 && b.error < 1e-8,
                    "gamma {gamma}, sigma {sigma}, cos {cos}"
                );
                for masking in [Masking::Uncorrelated, Masking::HeightCorrelated] {
                    for (x, y) in a.of(masking).iter().zip(b.of(masking)) {
                        assert!(
                            (x - y).abs() < a.error + b.error,
                            "gamma {gamma}, sigma {sigma}, cos {cos}"
                        );
                    }
                    let e = a.of(masking)[0] + a.of(masking)[1];
                    assert!(e > 0.0 && e <= 1.0 + 1e-9, "E = {e}");
                }
            }
        }
    }
}

#[test]
fn grazing_and_smooth_limits() {
    for gamma in [1.501, 2.0, f64::INFINITY] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        let grazing = integrator.reflection(0.5, 0.0, |_| [1.0]).unwrap();
        // At grazing incidence height-correlated masking masks nothing once the view's own masking
        // is divided out.
        assert!((grazing.height_correlated[0] - 1.0).abs() < 1e-6, "gamma {gamma}: {grazing:?}");
        assert!(grazing.uncorrelated[0] < 0.99);
        let mirror = integrator.reflection(0.0, 0.3, schlick).unwrap();
        assert_eq!(mirror.uncorrelated, schlick(0.3));
    }
}

#[test]
fn refuses_what_is_outside_the_domain() {
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-6);
    for sigma in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            integrator.reflection(sigma, 0.5, schlick),
            Err(ParameterError::Sigma(_))
        ));
    }
    for cos in [-0.1, 1.1, f64::NAN] {
        for sigma in [0.0, 0.3] {
            let error = integrator.reflection(sigma, cos, schlick).unwrap_err();
            assert!(error.to_string().contains("[0, 1]"), "{error}");
        }
    }
}

/// Total reflection sets in with a square root: quadrature that is told of it no longer depends on
/// its order.
#[test]
fn leaving_a_dielectric_converges() {
    let inside = Dielectric::new(1.0 / 1.5).unwrap();
    let kink = (1.0 - 1.0 / 2.25_f64).sqrt();
    for gamma in [1.7, 3.0, f64::INFINITY] {
        let integrator = |tolerance| AlbedoIntegrator::new(Shape::new(gamma).unwrap(), tolerance);
        let (coarse, fine) = (integrator(1e-5), integrator(1e-10));
        for sigma in [0.03, 0.2, 0.454, 1.5] {
            for cos in [0.05, 0.4, kink - 0.01, kink, 0.8, 1.0] {
                let at = |by: &AlbedoIntegrator| {
                    by.reflection_with_kink(sigma, cos, kink, |c| [inside.reflectance(c)]).unwrap()
                };
                let (a, b) = (at(&coarse), at(&fine));
                assert!(a.error < 1e-4, "gamma {gamma}, sigma {sigma}, cos {cos}: {}", a.error);
                let off = (a.uncorrelated[0] - b.uncorrelated[0]).abs();
                assert!(
                    off <= a.error + b.error && off < 1e-5,
                    "gamma {gamma}, sigma {sigma}, cos {cos}: {off}"
                );
                // Quadrature that is not told of the kink agrees less closely than its error
                // estimate claims.
                let blind = fine.reflection(sigma, cos, |c| [inside.reflectance(c)]).unwrap();
                let off = (blind.height_correlated[0] - b.height_correlated[0]).abs();
                assert!(off < 1e-3, "gamma {gamma}, sigma {sigma}, cos {cos}: {off}");
            }
        }
    }
}
