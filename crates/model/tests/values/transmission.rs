//! Albedos of transmission against brute force, limits and reciprocity.

use microfacet_model::fresnel::Dielectric;
use microfacet_model::{AlbedoIntegrator, Masking, MicrofacetDistribution, Shape, StudentT};

use glam::DVec3;

use crate::{assert_near, direction};

const GAMMAS: [f64; 5] = [1.55, 2.0, 3.0, 11.0, f64::INFINITY];
const ETAS: [f64; 8] = [0.3, 0.67, 0.9, 0.999, 1.001, 1.1, 1.5, 4.0];

/// T by the midpoint rule over the two random numbers of a visible normal.
fn brute_force(material: &StudentT, pane: Dielectric, v: DVec3, masking: Masking) -> f64 {
    const STEPS: u32 = 240;
    let mut sum = 0.0;
    for i in 0..STEPS {
        for j in 0..STEPS {
            let u = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(STEPS));
            let m = material.sample_visible_normal(v, u);
            let mu = v.dot(m);
            let Some(inside) = pane.refracted_cos(mu) else { continue };
            let l = (mu / pane.eta() - inside) * m - v / pane.eta();
            if l.z < 0.0 {
                let g2 = material.g2(v, DVec3::new(l.x, l.y, -l.z), masking);
                sum += (1.0 - pane.reflectance(mu)) * g2 / material.g1(v);
            }
        }
    }
    sum / f64::from(STEPS * STEPS)
}

#[test]
fn agrees_with_brute_force() {
    for (gamma, eta, sigma, cos) in [
        // Nearly all facets are vertical, beyond any slope at which an integral can end.
        (1.501, 1.5, 0.3, 0.4),
        (1.501, 0.67, 0.3, 0.4),
        (1.505, 1.5, 1.0, 0.9),
        (1.55, 0.3, 0.05, 0.1),
        (1.55, 0.999, 0.05, 0.7),
        (2.0, 0.67, 1.0, 0.95),
        (3.0, 0.9, 0.3, 0.7),
        (2.0, 1.5, 0.3, 0.4),
        (11.0, 1.1, 1.0, 0.4),
        (f64::INFINITY, 4.0, 1.0, 0.7),
    ] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        let material = StudentT::new(sigma, gamma).unwrap();
        let pane = Dielectric::new(eta).unwrap();
        let got = integrator.transmission(sigma, cos, pane).unwrap();
        assert!(got.error < 2e-6, "{gamma} {eta} {sigma} {cos}: estimate {:e}", got.error);
        for masking in Masking::ALL {
            let want = brute_force(&material, pane, direction(cos, 0.0), masking);
            let at = format!("gamma {gamma}, eta {eta}, sigma {sigma}, cos {cos}");
            // The midpoint rule's error at the edges of the domain.
            assert_near(got.of(masking)[0], want, 1e-3, at);
        }
    }
}

/// 2 ∫ μ dμ by the midpoint rule in √μ.
fn average(f: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    const STEPS: u32 = 250;
    let mut sums = [0.0; 2];
    for step in (0..STEPS).map(|i| (f64::from(i) + 0.5) / f64::from(STEPS)) {
        let values = f(step * step);
        sums = [0, 1].map(|i| sums[i] + 4.0 * step * step * step * values[i] / f64::from(STEPS));
    }
    sums
}

#[test]
fn as_much_passes_either_way() {
    // f(v, l)/η² is the same both ways (Veach 1997, eq. 5.14,
    // <https://graphics.stanford.edu/papers/veach_thesis/>), so that the average of what enters
    // is η² times that of what leaves.
    for gamma in [1.6, 3.0, f64::INFINITY] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for (sigma, eta) in [(0.2, 1.5), (1.0, 3.0)] {
            let pane = Dielectric::new(eta).unwrap();
            let of = |pane: Dielectric| {
                average(|cos| {
                    let passed = integrator.transmission(sigma, cos, pane).unwrap();
                    Masking::ALL.map(|masking| passed.of(masking)[0])
                })
            };
            for (enters, leaves) in of(pane).into_iter().zip(of(pane.reversed())) {
                let at = format!("gamma {gamma}, sigma {sigma}, eta {eta}");
                // The midpoint rule's error at the kink of what leaves, times η².
                assert_near(enters, eta * eta * leaves, 2e-5 * eta * eta, at);
            }
        }
    }
}

/// From inside, transmission's average is that from outside, and reflection's has a kink; the
/// midpoint rule knows nothing of either.
#[test]
fn averages_of_both_shares_are_those_over_all_views() {
    for gamma in [1.6, f64::INFINITY] {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for (sigma, eta) in [(0.2, 1.5), (0.2, 1.0 / 1.5), (1.0, 1.0 / 3.0), (0.01, 1.0)] {
            let pane = Dielectric::new(eta).unwrap();
            let found = integrator.interface_average(sigma, pane).unwrap();
            for share in [0, 1] {
                let want = average(|cos| {
                    let shares = integrator.interface(sigma, cos, pane).unwrap();
                    Masking::ALL.map(|masking| shares.of(masking)[share])
                });
                for (masking, want) in Masking::ALL.into_iter().zip(want) {
                    let at = format!("gamma {gamma}, sigma {sigma}, eta {eta}, share {share}");
                    assert_near(found.of(masking)[share], want, 3e-5, at);
                }
            }
        }
    }
}

#[test]
fn without_a_difference_all_that_is_not_shadowed_passes() {
    let pane = Dielectric::new(1.0).unwrap();
    for gamma in GAMMAS {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-7);
        for (sigma, cos) in [(0.01, 0.2), (0.3, 0.05), (1.0, 0.6), (3.0, 1.0)] {
            let material = StudentT::new(sigma, gamma).unwrap();
            let lambda = material.lambda(direction(cos, 0.0));
            let got = integrator.transmission(sigma, cos, pane).unwrap();
            for (masking, want) in [
                (Masking::Uncorrelated, 1.0 / (1.0 + lambda)),
                (Masking::HeightCorrelated, (1.0 + lambda) / (1.0 + 2.0 * lambda)),
            ] {
                let at = format!("gamma {gamma}, sigma {sigma}, cos {cos}");
                assert!(got.error < 1e-7, "{at}: {:e}", got.error);
                assert_near(got.of(masking)[0], want, got.error, at);
            }
        }
    }
}

#[test]
fn with_reflection_at_most_everything() {
    for gamma in GAMMAS.into_iter().chain([1.501]) {
        let integrator = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for eta in ETAS {
            let pane = Dielectric::new(eta).unwrap();
            let kink = ((1.0 - eta) * (1.0 + eta)).max(0.0).sqrt();
            for sigma in [1e-6, 0.01, 0.3, 3.0] {
                for cos in [0.0, 1e-3, 0.1, 0.5, 0.9, 1.0] {
                    let passed = integrator.transmission(sigma, cos, pane).unwrap();
                    let weight = |mu: f64| [pane.reflectance(mu)];
                    let reflected =
                        integrator.reflection_with_kink(sigma, cos, kink, weight).unwrap();
                    let at = format!("gamma {gamma}, eta {eta}, sigma {sigma}, cos {cos}");
                    assert!(passed.error < 1e-4, "{at}: {passed:?}");
                    for masking in Masking::ALL {
                        let [t, r] = [&passed, &reflected].map(|albedo| albedo.of(masking)[0]);
                        let slack = passed.error + reflected.error;
                        assert!(t >= 0.0 && r >= 0.0 && t + r <= 1.0 + slack, "{at}: {t} + {r}");
                        if sigma == 1e-6 && gamma == f64::INFINITY && cos > 1e-3 {
                            assert_near(t, 1.0 - pane.reflectance(cos), 1e-4, &at);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn refuses_what_is_no_view() {
    let integrator = AlbedoIntegrator::new(Shape::new(2.0).unwrap(), 1e-6);
    let pane = Dielectric::new(1.5).unwrap();
    for (sigma, cos) in [(-1.0, 0.5), (f64::NAN, 0.5), (0.3, -0.1), (0.3, 1.1), (0.3, f64::NAN)] {
        assert!(integrator.transmission(sigma, cos, pane).is_err(), "{sigma} {cos}");
    }
    let smooth = integrator.interface(0.0, 0.4, pane).unwrap();
    assert_eq!(smooth.uncorrelated, [pane.reflectance(0.4), 1.0 - pane.reflectance(0.4)]);
    let smooth = integrator.transmission(0.0, 0.4, pane).unwrap();
    assert_eq!(smooth.uncorrelated[0], 1.0 - pane.reflectance(0.4));
}
