//! Directional albedos of skewed lobes against untilted ones, brute force, sampling and identities.
//!
//! `cargo test --release -p microfacet-model --test albedo_skewed -- --ignored --nocapture` prints
//! the documented accuracy.

use core::f64::consts::PI;

use glam::DVec3;
use microfacet_model::fresnel::schlick_weight;
use microfacet_model::{
    AlbedoIntegrator, Ellipsoid, Masking, MicrofacetDistribution, ParameterError, Shape, Skew,
};

const FORMS: [Masking; 2] = [Masking::Uncorrelated, Masking::HeightCorrelated];

fn schlick(cos: f64) -> [f64; 2] {
    [1.0 - schlick_weight(cos), schlick_weight(cos)]
}

fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = f64::sqrt(1.0 - cos * cos);
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

/// Roughness p and r along two axes, a shear, and the mean slope in units of them.
fn skewed(gamma: f64, p: f64, r: f64, mean: [f64; 2]) -> Ellipsoid {
    let rows = [[p, 0.0, 0.0], [0.3 * p, r, 0.0], [mean[0] * p, mean[1] * r, 1.0]];
    Ellipsoid::new(Skew::from_matrix(rows).unwrap(), gamma).unwrap()
}

#[test]
fn without_a_tilt_it_is_the_anisotropic_albedo() {
    for gamma in [1.52, 2.0, 3.6, f64::INFINITY] {
        let shape = Shape::new(gamma).unwrap();
        let (isotropic, integrator) =
            (AlbedoIntegrator::new(shape, 1e-10), AlbedoIntegrator::new(shape, 1e-7));
        for sigma in [[0.3, 0.3], [0.1, 0.6], [2.0, 0.7]] {
            for turn in [0.0, 0.8] {
                let ellipsoid =
                    Ellipsoid::new(Skew::new(sigma, [0.0, 0.0, turn]).unwrap(), gamma).unwrap();
                for (cos, phi) in [(0.0, 0.3), (0.02, 2.0), (0.4, 0.9), (0.9, 4.0), (1.0, 0.0)] {
                    // θz turns directions into the principal frame.
                    let want =
                        isotropic.reflection_anisotropic(sigma, cos, phi + turn, schlick).unwrap();
                    let got = integrator.reflection_skewed(&ellipsoid, cos, phi, schlick).unwrap();
                    for form in FORMS {
                        for (a, b) in got.of(form).iter().zip(want.of(form)) {
                            let error = (a - b).abs();
                            assert!(
                                error < 1e-7 && error < got.error + want.error + 1e-12,
                                "gamma {gamma}, sigma {sigma:?}, cos {cos}: {a} against {b}, estimate {:e}",
                                got.error
                            );
                        }
                    }
                }
            }
        }
    }
}

/// E by brute force: f cos θ_l with F = 1 over the hemisphere of l, in solid angle, by the midpoint
/// rule.
fn brute_force(ellipsoid: &Ellipsoid, v: DVec3, weight: impl Fn(f64) -> f64) -> [f64; 2] {
    let (rings, sectors) = (500, 500);
    let mut sum = [0.0; 2];
    for i in 0..rings {
        let (sin, cos) = libm::sincos(0.5 * PI * (i as f64 + 0.5) / rings as f64);
        for j in 0..sectors {
            let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * (j as f64 + 0.5) / sectors as f64);
            let l = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
            let m = (v + l).normalize();
            let part = sin * ellipsoid.d(m) * weight(v.dot(m)) / (4.0 * v.z);
            for (sum, form) in sum.iter_mut().zip(FORMS) {
                *sum += part * ellipsoid.g2(v, l, form);
            }
        }
    }
    sum.map(|x| x * 0.5 * PI / rings as f64 * 2.0 * PI / sectors as f64)
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
            let want = brute_force(&ellipsoid, direction(cos, phi), |_| 1.0);
            for (form, want) in FORMS.into_iter().zip(want) {
                let got = albedo.of(form)[0] + albedo.of(form)[1];
                let error = (got - want).abs();
                // The midpoint rule is of second order in steps of 3e-3 and 1.3e-2.
                assert!(
                    error < 6e-6,
                    "gamma {gamma}, mean {mean:?}, cos {cos}: {got} against {want}"
                );
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
                for (sum, form) in sum.iter_mut().zip(FORMS) {
                    *sum += ellipsoid.g2(v, l, form) * area / v.z / POINTS as f64;
                }
            }
            let albedo = integrator.reflection_skewed(&ellipsoid, cos, phi, |_| [1.0]).unwrap();
            for (form, want) in FORMS.into_iter().zip(sum) {
                let error = (albedo.of(form)[0] - want).abs();
                // Of 20,000 lattice points; measured 1.3e-4.
                assert!(
                    error < 3e-4,
                    "gamma {gamma}, mean {mean:?}, cos {cos}: {:?} against {want}",
                    albedo.of(form)
                );
            }
        }
    }
}

#[test]
fn the_domain_has_an_estimate_that_holds() {
    for gamma in [1.501, 1.6, 2.0, 3.6, f64::INFINITY] {
        let shape = Shape::new(gamma).unwrap();
        let (coarse, fine) =
            (AlbedoIntegrator::new(shape, 1e-5), AlbedoIntegrator::new(shape, 1e-6));
        for (p, r) in [(0.01, 0.01), (0.6, 0.05), (3.0, 2.0)] {
            for mean in [[0.1, 0.0], [-0.6, 0.8], [1.5, 3.0]] {
                let ellipsoid = skewed(gamma, p, r, mean);
                for (cos, phi) in [(0.0, 1.0), (0.01, 3.0), (0.1, 5.0), (0.7, 2.0), (1.0, 0.0)] {
                    let [a, b] = [&coarse, &fine]
                        .map(|x| x.reflection_skewed(&ellipsoid, cos, phi, schlick).unwrap());
                    let name = format!("gamma {gamma}, sigma {p} {r}, mean {mean:?}, cos {cos}");
                    assert!(a.error < 1e-4, "{name}: estimate {:e}", a.error);
                    for form in FORMS {
                        for (x, y) in a.of(form).iter().zip(b.of(form)) {
                            assert!((x - y).abs() < a.error + b.error, "{name}: {x} against {y}");
                        }
                        let e = a.of(form)[0] + a.of(form)[1];
                        assert!((0.0..=1.0 + 1e-6).contains(&e), "{name}: E = {e}");
                    }
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
    assert!(
        integrator.reflection_skewed(&ellipsoid, 0.0, 0.0, |_| [1.0]).unwrap().height_correlated[0]
            > 0.99
    );
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
        let shape = Shape::new(gamma).unwrap();
        let (coarse, fine) =
            (AlbedoIntegrator::new(shape, 1e-5), AlbedoIntegrator::new(shape, 1e-7));
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
                        for form in FORMS {
                            assert!((0.0..=1.0 + 1e-6).contains(&a.of(form)[0]), "{:?}", a);
                        }
                        if views % 7 == 0 {
                            let b =
                                fine.reflection_skewed(&ellipsoid, cos, phi, |_| [1.0]).unwrap();
                            let error = FORMS.map(|form| (a.of(form)[0] - b.of(form)[0]).abs());
                            let error = error[0].max(error[1]);
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
