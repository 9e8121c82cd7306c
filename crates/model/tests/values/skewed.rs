//! Directional albedos of skewed lobes against untilted ones, brute force, sampling and identities.
//!
//! `cargo test --release -p microfacet-model --test values skewed:: -- --ignored --nocapture`
//! prints the documented accuracy.

use core::f64::consts::PI;

use microfacet_model::{
    AlbedoIntegrator, Ellipsoid, Masking, MicrofacetDistribution, ParameterError, Shape, Skew,
};

use crate::{apart, assert_near, assert_share, brute_force, direction, schlick};

fn integrators(gamma: f64, tolerances: [f64; 2]) -> [AlbedoIntegrator; 2] {
    let shape = Shape::new(gamma).unwrap();
    tolerances.map(|tolerance| AlbedoIntegrator::new(shape, tolerance))
}

/// Roughness p and r along two axes, a shear, and the mean slope in units of them.
fn skewed(gamma: f64, p: f64, r: f64, mean: [f64; 2]) -> Ellipsoid {
    let rows = [[p, 0.0, 0.0], [0.3 * p, r, 0.0], [mean[0] * p, mean[1] * r, 1.0]];
    Ellipsoid::new(Skew::from_matrix(rows).unwrap(), gamma).unwrap()
}

#[test]
fn without_a_tilt_it_is_the_anisotropic_albedo() {
    for gamma in [1.52, 2.0, 3.6, f64::INFINITY] {
        let [isotropic, integrator] = integrators(gamma, [1e-10, 1e-7]);
        for sigma in [[0.3, 0.3], [0.1, 0.6], [2.0, 0.7]] {
            for turn in [0.0, 0.8] {
                let ellipsoid =
                    Ellipsoid::new(Skew::new(sigma, [0.0, 0.0, turn]).unwrap(), gamma).unwrap();
                for (cos, phi) in [(0.0, 0.3), (0.02, 2.0), (0.4, 0.9), (0.9, 4.0), (1.0, 0.0)] {
                    // θz turns directions into the principal frame.
                    let want =
                        isotropic.reflection_anisotropic(sigma, cos, phi + turn, schlick).unwrap();
                    let got = integrator.reflection_skewed(&ellipsoid, cos, phi, schlick).unwrap();
                    let error = apart(&got, &want);
                    assert!(
                        error < 1e-7 && error < got.error + want.error + 1e-12,
                        "gamma {gamma}, sigma {sigma:?}, cos {cos}: {error:e} of {:e}",
                        got.error
                    );
                }
            }
        }
    }
}

#[test]
fn it_is_the_integral_over_light_directions() {
    for gamma in [1.7, 2.0, 4.0, f64::INFINITY] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-7);
        for (p, r, mean, cos, phi) in [
            (0.4, 0.6, [0.7, -0.4], 0.6, 0.5),
            // Tilted towards a view and away from one, and beyond the disc of slopes.
            (0.5, 0.3, [-1.5, 0.5], 0.35, 3.0),
            (0.5, 0.3, [1.5, 0.5], 0.35, 3.0),
            (1.5, 1.2, [1.2, 1.6], 0.8, 4.0),
        ] {
            let ellipsoid = skewed(gamma, p, r, mean);
            let albedo = integrator.reflection_skewed(&ellipsoid, cos, phi, schlick).unwrap();
            let want = brute_force(&ellipsoid, direction(cos, phi), 500);
            for (form, want) in Masking::ALL.into_iter().zip(want) {
                let got = albedo.of(form)[0] + albedo.of(form)[1];
                // The midpoint rule is of second order in steps of 3e-3 and 1.3e-2.
                assert_near(got, want, 6e-6, format!("gamma {gamma}, mean {mean:?}, cos {cos}"));
            }
        }
    }
}

#[test]
fn it_is_the_mean_weight_of_sampled_reflections() {
    const POINTS: usize = 20_000;
    for gamma in [1.7, 2.0, 4.0, f64::INFINITY] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for (p, r, mean, cos, phi) in [
            (0.3, 0.3, [1.0, 0.0], 0.7, 0.4),
            // A view below the lobe's own horizon.
            (0.2, 0.1, [2.0, -1.5], 0.1, 2.8),
            (2.5, 1.0, [-1.0, 2.0], 0.3, 1.0),
        ] {
            let (ellipsoid, v) = (skewed(gamma, p, r, mean), direction(cos, phi));
            let area = ellipsoid.projected_area(v);
            let mut sum = [0.0; 2];
            for i in 0..POINTS {
                // The lattice of the plastic number: steps of its inverse and of its inverse
                // square.
                let i = i as f64 + 0.5;
                let u = [(i * 0.754877666246692760) % 1.0, (i * 0.569840290998053266) % 1.0];
                let m = ellipsoid.sample_visible_normal(v, u);
                let l = 2.0 * v.dot(m) * m - v;
                for (sum, form) in sum.iter_mut().zip(Masking::ALL) {
                    *sum += ellipsoid.g2(v, l, form) * area / v.z / POINTS as f64;
                }
            }
            let albedo = integrator.reflection_skewed(&ellipsoid, cos, phi, |_| [1.0]).unwrap();
            for (form, want) in Masking::ALL.into_iter().zip(sum) {
                let at = format!("gamma {gamma}, mean {mean:?}, cos {cos}");
                // Of 20,000 lattice points; measured 1.3e-4.
                assert_near(albedo.of(form)[0], want, 3e-4, at);
            }
        }
    }
}

#[test]
fn the_domain_has_an_estimate_that_holds() {
    for gamma in [1.501, 1.6, 2.0, 3.6, f64::INFINITY] {
        let both = integrators(gamma, [1e-5, 1e-6]);
        for (p, r) in [(0.01, 0.01), (0.6, 0.05), (3.0, 2.0)] {
            for mean in [[0.1, 0.0], [-0.6, 0.8], [1.5, 3.0]] {
                let ellipsoid = skewed(gamma, p, r, mean);
                for (cos, phi) in [(0.0, 1.0), (0.01, 3.0), (0.1, 5.0), (0.7, 2.0), (1.0, 0.0)] {
                    let [a, b] = both
                        .each_ref()
                        .map(|x| x.reflection_skewed(&ellipsoid, cos, phi, schlick).unwrap());
                    let name = format!("gamma {gamma}, sigma {p} {r}, mean {mean:?}, cos {cos}");
                    assert!(a.error < 1e-4, "{name}: estimate {:e}", a.error);
                    assert!(apart(&a, &b) < a.error + b.error, "{name}: {a:?} for {b:?}");
                    assert_share(&a, 1e-6, name);
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_seen_has_no_albedo() {
    // At grazing the lobe leans away by forty of its widths: the projected area underflows.
    let ellipsoid = skewed(f64::INFINITY, 0.05, 0.05, [40.0, 0.0]);
    let integrator = AlbedoIntegrator::new(*ellipsoid.shape(), 1e-6);
    for cos in [0.0, 1e-3] {
        let albedo = integrator.reflection_skewed(&ellipsoid, cos, PI, schlick).unwrap();
        assert_eq!((albedo.uncorrelated, albedo.height_correlated), ([0.0; 2], [0.0; 2]));
    }
    let seen = integrator.reflection_skewed(&ellipsoid, 0.0, 0.0, |_| [1.0]).unwrap();
    assert!(seen.height_correlated[0] > 0.99);
}

#[test]
fn refuses_other_shapes_and_directions_below() {
    let ellipsoid = skewed(2.0, 0.3, 0.3, [0.5, 0.0]);
    let integrator = AlbedoIntegrator::new(Shape::new(3.0).unwrap(), 1e-6);
    let error = integrator.reflection_skewed(&ellipsoid, 0.5, 0.0, schlick).unwrap_err();
    assert_eq!(error, ParameterError::OtherGamma { given: 2.0, prepared: 3.0 });
    assert!(error.to_string().contains("prepared for 3"), "{error}");
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-6);
    for cos in [-0.1, 1.1, f64::NAN] {
        let error = integrator.reflection_skewed(&ellipsoid, cos, 0.0, schlick).unwrap_err();
        assert!(matches!(error, ParameterError::CosTheta(_)));
    }
    let error = integrator.reflection_skewed(&ellipsoid, 0.5, f64::NAN, schlick).unwrap_err();
    assert!(matches!(error, ParameterError::Phi(_)));
}

#[test]
#[ignore = "prints figures; minutes"]
fn accuracy_over_the_domain() {
    let (mut views, mut missed, mut checked, mut outside) = (0, 0, 0, 0);
    let (mut estimate, mut worst, mut points) = (0.0_f64, 0.0_f64, 0);
    for gamma in [1.501, 1.6, 2.0, 4.0, f64::INFINITY] {
        let [coarse, fine] = integrators(gamma, [1e-5, 1e-7]);
        for (p, r) in [(0.01, 0.01), (0.05, 0.3), (0.5, 0.3), (1.0, 0.1), (3.0, 3.0)] {
            for (length, turn) in
                (0..10).map(|i| ([0.0, 0.1, 0.5, 2.0, 4.0][i / 2], [0.3, 2.0][i % 2]))
            {
                let ellipsoid =
                    skewed(gamma, p, r, [length * libm::cos(turn), length * libm::sin(turn)]);
                for cos in [0.0, 1e-3, 0.02, 0.1, 0.3, 0.6, 0.95, 1.0] {
                    for phi in [0.1, 1.7, 3.3, 5.0] {
                        let count = core::cell::Cell::new(0);
                        let weight = |_| {
                            count.set(count.get() + 1);
                            [1.0]
                        };
                        let a = coarse.reflection_skewed(&ellipsoid, cos, phi, weight).unwrap();
                        (views, points) = (views + 1, points + count.get());
                        missed += i32::from(a.error > 1e-5);
                        estimate = estimate.max(a.error);
                        for form in Masking::ALL {
                            assert!((0.0..=1.0 + 1e-6).contains(&a.of(form)[0]), "{a:?}");
                        }
                        if views % 7 == 0 {
                            let b =
                                fine.reflection_skewed(&ellipsoid, cos, phi, |_| [1.0]).unwrap();
                            let error = apart(&a, &b);
                            worst = worst.max(error);
                            (checked, outside) =
                                (checked + 1, outside + i32::from(error > a.error + b.error));
                        }
                    }
                }
            }
        }
    }
    println!(
        "{views} views, {} points each; {missed} estimates above 1e-5, at most {estimate:e}",
        points / views
    );
    println!("{checked} against 1e-7: at most {worst:e}, {outside} outside their estimates");
}
