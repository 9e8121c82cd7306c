//! Directional albedos against independent quadratures, limits and identities.

use microfacet_model::fresnel::{self, Dielectric, schlick_weight};
use microfacet_model::{AlbedoIntegrator, Masking, ParameterError, Shape, StudentT};

use crate::{apart, assert_near, brute_force, direction, rows, schlick};

fn masking(name: &str) -> Masking {
    Masking::ALL.into_iter().find(|masking| masking.name() == name).expect("a form of masking")
}

fn integrator(gamma: f64, tolerance: f64) -> AlbedoIntegrator {
    AlbedoIntegrator::new(Shape::new(gamma).unwrap(), tolerance)
}

#[test]
fn schlick_parts_match_the_reference() {
    for tolerance in [1e-6, 1e-10] {
        let mut worst = 0.0_f64;
        for row in rows("albedo.csv") {
            let f = |i: usize| row[i].parse::<f64>().expect("number");
            let albedo = integrator(f(1), tolerance).reflection(f(0), f(2), schlick).unwrap();
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
        let integrator = integrator(f(2), 1e-6);
        let albedo =
            integrator.reflection_anisotropic([f(0), f(1)], f(3), f(4), |_| [1.0]).unwrap();
        assert!(albedo.error < 1e-6, "{row:?}: estimate {:e}", albedo.error);
        assert_near(albedo.of(masking(&row[5]))[0], f(6), 1e-6, format!("{row:?}"));
    }
}

#[test]
fn averages_match_the_reference() {
    for row in rows("albedo_avg.csv") {
        let f = |i: usize| row[i].parse::<f64>().expect("number");
        let albedo = integrator(f(1), 1e-7).average(f(0), |_| [1.0]).unwrap();
        assert!(albedo.error < 1e-5, "{row:?}: estimate {:e}", albedo.error);
        assert_near(albedo.of(masking(&row[2]))[0], f(3), albedo.error, format!("{row:?}"));
    }
}

#[test]
fn albedo_is_the_integral_over_light_directions() {
    for (sigma, gamma, cos) in
        [([0.5, 0.5], 2.0, 0.6), ([0.8, 0.3], 3.0, 0.35), ([0.4, 0.4], f64::INFINITY, 0.8)]
    {
        let material = StudentT::new(sigma, gamma).unwrap();
        let integrator = integrator(gamma, 1e-8);
        let albedo = integrator.reflection_anisotropic(sigma, cos, 0.7, |_| [1.0]).unwrap();
        let all = brute_force(&material, direction(cos, 0.7), 800);
        for (masking, want) in Masking::ALL.into_iter().zip(all) {
            let at = format!("sigma {sigma:?}, gamma {gamma}");
            // The midpoint rule is of second order in steps of 2e-3.
            assert_near(albedo.of(masking)[0], want, 2e-5, at);
        }
    }
}

#[test]
fn equal_roughness_takes_no_notice_of_azimuth() {
    let integrator = integrator(1.7, 1e-8);
    let isotropic = integrator.reflection(0.4, 0.3, schlick).unwrap();
    // Nearly equal roughnesses take the anisotropic path round the whole circle.
    let near = integrator.reflection_anisotropic([0.4, 0.4 + 1e-12], 0.3, 2.0, schlick).unwrap();
    assert!(apart(&isotropic, &near) < 1e-8);
}

/// The quadrature of isotropic lobes and that of anisotropic ones, here for roughnesses that hardly
/// differ, share neither rays nor error estimate.
#[test]
fn both_quadratures_agree_within_their_estimates() {
    let panes = [1.5, 1.02].map(|eta| Dielectric::new(eta).unwrap());
    let weights =
        |cos| [1.0, fresnel::f82_weight(cos), panes[0].reflectance(cos), panes[1].reflectance(cos)];
    for gamma in [1.501, 1.6, 2.0, 2.9, 3.6, f64::INFINITY] {
        let fine = integrator(gamma, 1e-8);
        for tolerance in [1e-5, 1e-7] {
            let round = integrator(gamma, tolerance);
            for sigma in [1e-3, 0.06, 0.5, 2.0] {
                for cos in [1e-4, 0.02, 0.15, 0.7, 0.998, 1.0] {
                    let a = round.reflection(sigma, cos, weights).unwrap();
                    let sigmas = [sigma, sigma * (1.0 + 1e-12)];
                    let b = fine.reflection_anisotropic(sigmas, cos, 0.7, weights).unwrap();
                    let at = format!("gamma {gamma}, sigma {sigma}, cos {cos}");
                    assert!(a.error < tolerance, "{at}");
                    let (off, most) = (apart(&a, &b), a.error + b.error);
                    assert!(off <= most, "{at}: {off:e} of {most:e}");
                }
            }
        }
    }
}

#[test]
fn the_domain_has_an_estimate_that_holds() {
    let weights = |cos| [1.0 - schlick_weight(cos), schlick_weight(cos), fresnel::f82_weight(cos)];
    for gamma in [1.501, 1.6, 2.0, 3.6, 20.0, f64::INFINITY] {
        let [coarse, fine] = [1e-6, 1e-8].map(|tolerance| integrator(gamma, tolerance));
        for sigma in [1e-4, 0.01, 0.1, 0.7, 3.0] {
            for cos in [1e-6, 1e-3, 0.02, 0.3, 0.9, 1.0] {
                let a = coarse.reflection(sigma, cos, weights).unwrap();
                let b = fine.reflection(sigma, cos, weights).unwrap();
                let at = format!("gamma {gamma}, sigma {sigma}, cos {cos}");
                assert!(a.error < 1e-6 && b.error < 1e-8, "{at}");
                assert!(apart(&a, &b) < a.error + b.error, "{at}");
                for masking in Masking::ALL {
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
        let integrator = integrator(gamma, 1e-6);
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
    let integrator = integrator(2.0, 1e-6);
    for sigma in [-0.1, f64::NAN, f64::INFINITY] {
        let why = integrator.reflection(sigma, 0.5, schlick).unwrap_err();
        assert!(matches!(why, ParameterError::Sigma(_)));
    }
    for cos in [-0.1, 1.1, f64::NAN] {
        for sigma in [0.0, 0.3] {
            let error = integrator.reflection(sigma, cos, schlick).unwrap_err();
            assert!(error.to_string().contains("[0, 1]"), "{error}");
        }
    }
}

/// Total reflection sets in with a square root: quadrature that divides there does not depend on
/// its order.
#[test]
fn leaving_a_dielectric_converges() {
    let inside = Dielectric::new(1.0 / 1.5).unwrap();
    let kink = (1.0 - 1.0 / 2.25_f64).sqrt();
    for gamma in [1.7, 3.0, f64::INFINITY] {
        let [coarse, fine] = [1e-5, 1e-10].map(|tolerance| integrator(gamma, tolerance));
        for sigma in [0.03, 0.2, 0.454, 1.5] {
            for cos in [0.05, 0.4, kink - 0.01, kink, 0.8, 1.0] {
                let at = |by: &AlbedoIntegrator| {
                    by.reflection_with_kink(sigma, cos, kink, |c| [inside.reflectance(c)]).unwrap()
                };
                let (a, b) = (at(&coarse), at(&fine));
                let name = format!("gamma {gamma}, sigma {sigma}, cos {cos}");
                assert!(a.error < 1e-4, "{name}: {}", a.error);
                let off = (a.uncorrelated[0] - b.uncorrelated[0]).abs();
                assert!(off <= a.error + b.error && off < 1e-5, "{name}: {off}");
                // Quadrature without the kink agrees less closely than its error estimate says.
                let blind = fine.reflection(sigma, cos, |c| [inside.reflectance(c)]).unwrap();
                let off = (blind.height_correlated[0] - b.height_correlated[0]).abs();
                assert!(off < 1e-3, "{name}: {off}");
            }
        }
    }
}
