//! Albedos of anisotropic dielectrics against brute force, round lobes, symmetries and
//! reciprocity.

use core::f64::consts::{FRAC_PI_2, PI};

use microfacet_model::fresnel::Dielectric;
use microfacet_model::{
    Albedo, AlbedoIntegrator, Masking, MicrofacetDistribution, Shape, StudentT,
};

use glam::DVec3;

use crate::{apart, assert_near, direction};

const GAMMAS: [f64; 5] = [1.501, 1.55, 2.0, 3.0, f64::INFINITY];
const ETAS: [f64; 8] = [1.0 / 3.0, 0.67, 0.9, 0.999, 1.0, 1.001, 1.5, 3.0];

fn integrator(gamma: f64, tolerance: f64) -> AlbedoIntegrator {
    AlbedoIntegrator::new(Shape::new(gamma).unwrap(), tolerance)
}

/// The shares reflected and transmitted.
fn both(
    model: &AlbedoIntegrator,
    sigma: [f64; 2],
    (cos, phi): (f64, f64),
    pane: Dielectric,
) -> [Albedo<1>; 2] {
    let eta = pane.eta();
    let kink = ((1.0 - eta) * (1.0 + eta)).max(0.0).sqrt();
    let weight = |mu: f64| [pane.reflectance(mu)];
    let reflected = model.reflection_anisotropic_with_kink(sigma, cos, phi, kink, weight);
    [reflected, model.transmission_anisotropic(sigma, cos, phi, pane)].map(Result::unwrap)
}

/// The same by the midpoint rule over the two random numbers of a visible normal.
fn brute_force(material: &StudentT, pane: Dielectric, v: DVec3, masking: Masking) -> [f64; 2] {
    const STEPS: u32 = 300;
    let mut sums = [0.0; 2];
    let g1 = material.g1(v);
    for i in 0..STEPS {
        for j in 0..STEPS {
            let u = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(STEPS));
            let m = material.sample_visible_normal(v, u);
            let mu = v.dot(m);
            let reflectance = pane.reflectance(mu);
            let l = 2.0 * mu * m - v;
            if l.z > 0.0 {
                sums[0] += reflectance * material.g2(v, l, masking) / g1;
            }
            let Some(inside) = pane.refracted_cos(mu) else { continue };
            let l = (mu / pane.eta() - inside) * m - v / pane.eta();
            if l.z < 0.0 {
                let g2 = material.g2(v, DVec3::new(l.x, l.y, -l.z), masking);
                sums[1] += (1.0 - reflectance) * g2 / g1;
            }
        }
    }
    sums.map(|sum| sum / f64::from(STEPS * STEPS))
}

#[test]
fn agrees_with_brute_force() {
    for (gamma, eta, sigma, cos, phi) in [
        (1.501, 1.5, [0.3, 0.1], 0.4, 0.3),
        (1.501, 0.67, [0.3, 0.1], 0.4, 0.3),
        (1.55, 0.3, [0.05, 0.5], 0.1, 1.0),
        (1.55, 0.999, [0.05, 0.2], 0.7, 2.0),
        (2.0, 0.67, [1.0, 0.1], 0.95, 0.8),
        (2.0, 0.67, [0.03, 0.9], 0.6, -0.1),
        (3.0, 0.9, [0.3, 0.7], 0.7, 1.5),
        (2.0, 1.5, [0.6, 0.15], 0.4, 4.0),
        (11.0, 1.1, [1.0, 0.2], 0.4, 0.0),
        (f64::INFINITY, 3.0, [0.1, 1.0], 0.7, FRAC_PI_2),
        (f64::INFINITY, 1.0 / 3.0, [0.1, 1.0], 0.97, 0.7),
    ] {
        let model = integrator(gamma, 1e-6);
        let material = StudentT::new(sigma, gamma).unwrap();
        let pane = Dielectric::new(eta).unwrap();
        let got = both(&model, sigma, (cos, phi), pane);
        let at = format!("gamma {gamma}, eta {eta}, sigma {sigma:?}, cos {cos}, phi {phi}");
        for masking in Masking::ALL {
            let want = brute_force(&material, pane, direction(cos, phi), masking);
            for (got, want) in got.iter().zip(want) {
                assert!(got.error < 5e-5, "{at}: estimate {:e}", got.error);
                // The midpoint rule's error at the edges of the domain.
                assert_near(got.of(masking)[0], want, 1e-3, &at);
            }
        }
    }
}

#[test]
fn nearly_round_lobes_are_round() {
    let mut worst = 0.0_f64;
    for gamma in GAMMAS {
        let model = integrator(gamma, 1e-9);
        for eta in ETAS {
            let pane = Dielectric::new(eta).unwrap();
            let kink = ((1.0 - eta) * (1.0 + eta)).max(0.0).sqrt();
            for (sigma, cos, phi) in [(0.02, 0.5, 0.4), (0.3, 0.1, 2.0), (1.0, 0.8, 5.0)] {
                let near = both(&model, [sigma, sigma * (1.0 + 1e-13)], (cos, phi), pane);
                let weight = |mu: f64| [pane.reflectance(mu)];
                let round = [
                    model.reflection_with_kink(sigma, cos, kink, weight).unwrap(),
                    model.transmission(sigma, cos, pane).unwrap(),
                ];
                let at = format!("gamma {gamma}, eta {eta}, sigma {sigma}, cos {cos}");
                for (near, round) in near.iter().zip(&round) {
                    let off = apart(near, round);
                    assert!(off <= near.error + round.error, "{at}: {off:e} {near:?} {round:?}");
                    worst = worst.max(off);
                }
            }
        }
    }
    println!("largest difference {worst:e}");
}

#[test]
fn turning_lobe_and_view_by_a_right_angle_changes_nothing() {
    for gamma in [1.55, f64::INFINITY] {
        let model = integrator(gamma, 1e-8);
        for eta in [0.67, 3.0] {
            let pane = Dielectric::new(eta).unwrap();
            for (cos, phi) in [(0.05, 0.3), (0.7, 1.9), (1.0, 0.0)] {
                let here = both(&model, [0.5, 0.1], (cos, phi), pane);
                let turned = both(&model, [0.1, 0.5], (cos, phi + FRAC_PI_2), pane);
                let mirrored = both(&model, [0.5, 0.1], (cos, -phi), pane);
                for (i, here) in here.iter().enumerate() {
                    let at = format!("gamma {gamma}, eta {eta}, cos {cos}, phi {phi}");
                    for other in [&turned[i], &mirrored[i]] {
                        let off = apart(here, other);
                        assert!(off <= here.error.max(1e-9), "{at}: {off:e}, {here:?}");
                    }
                }
            }
        }
    }
}

/// The average of T over all views, by the midpoint rule in √μ and over azimuths, both of a quarter
/// of the turn, in which a lobe's albedo is even at either end.
fn average(model: &AlbedoIntegrator, sigma: [f64; 2], pane: Dielectric) -> [f64; 2] {
    const STEPS: [u32; 2] = [120, 12];
    let at = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let mut sums = [0.0; 2];
    for i in 0..STEPS[0] {
        let root = at(i, STEPS[0]);
        for j in 0..STEPS[1] {
            // Even steps of half-way azimuths: those of slopes and of unit slopes are both smooth.
            let half = FRAC_PI_2 * at(j, STEPS[1]);
            let [x, y] = sigma.map(f64::sqrt);
            let (sin, cos) = libm::sincos(half);
            let phi = libm::atan2(x * sin, y * cos);
            let rate = x * y / (x * x * sin * sin + y * y * cos * cos);
            let passed = model.transmission_anisotropic(sigma, root * root, phi, pane).unwrap();
            let share = 4.0 * root * root * root * rate / f64::from(STEPS[0] * STEPS[1]);
            sums = [0, 1].map(|i| sums[i] + share * passed.of(Masking::ALL[i])[0]);
        }
    }
    sums
}

#[test]
fn as_much_passes_either_way() {
    for (gamma, sigma, eta) in
        [(1.6, [0.1, 0.4], 1.5), (3.0, [1.0, 0.2], 1.5), (f64::INFINITY, [0.2, 0.6], 3.0)]
    {
        let model = integrator(gamma, 1e-5);
        let pane = Dielectric::new(eta).unwrap();
        let [enters, leaves] = [pane, pane.reversed()].map(|pane| average(&model, sigma, pane));
        for (enters, leaves) in enters.into_iter().zip(leaves) {
            let at = format!("gamma {gamma}, sigma {sigma:?}, eta {eta}");
            // The midpoint rule's error at the kink of what leaves, times η².
            assert_near(enters, eta * eta * leaves, 1e-4 * eta * eta, at);
        }
    }
}

#[test]
fn with_reflection_at_most_everything() {
    for gamma in GAMMAS {
        let model = integrator(gamma, 1e-5);
        for eta in ETAS {
            let pane = Dielectric::new(eta).unwrap();
            for sigma in [[0.3, 0.15], [0.02, 0.6], [3.0, 0.3], [1e-6, 1e-5]] {
                for (cos, phi) in [
                    (0.0, 0.3),
                    (1e-3, FRAC_PI_2),
                    (0.1, 0.0),
                    (0.5, 0.25 * PI),
                    (0.9, FRAC_PI_2),
                    (1.0, 0.0),
                    (1.0, 1.0),
                ] {
                    let albedos = both(&model, sigma, (cos, phi), pane);
                    let at =
                        format!("gamma {gamma}, eta {eta}, sigma {sigma:?}, cos {cos}, phi {phi}");
                    let slack: f64 = albedos.iter().map(|albedo| albedo.error).sum();
                    assert!(slack < 1e-3, "{at}: {albedos:?}");
                    for masking in Masking::ALL {
                        let [r, t] = [0, 1].map(|i| albedos[i].of(masking)[0]);
                        assert!(r >= 0.0 && t >= 0.0 && r + t <= 1.0 + slack, "{at}: {r} + {t}");
                        if sigma[0] == 1e-6 && gamma == f64::INFINITY && cos > 1e-3 {
                            assert_near(t, 1.0 - pane.reflectance(cos), 1e-4, &at);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn tolerances_are_kept() {
    for gamma in [1.6, 3.0, f64::INFINITY] {
        let [coarse, fine] = [1e-5, 1e-7].map(|tolerance| integrator(gamma, tolerance));
        for eta in [1.0 / 3.0, 0.67, 0.95, 1.05, 1.5, 3.0] {
            let pane = Dielectric::new(eta).unwrap();
            for sigma in [[0.3, 0.15], [0.1, 1.0], [0.02, 0.6]] {
                for (cos, phi) in [(0.02, 0.3), (0.4, 1.2), (0.75, 0.0), (0.97, 0.7)] {
                    let [a, b] = [&coarse, &fine].map(|model| both(model, sigma, (cos, phi), pane));
                    let at = format!("gamma {gamma}, eta {eta}, {sigma:?}, cos {cos}, phi {phi}");
                    for (a, b) in a.iter().zip(&b) {
                        let off = apart(a, b);
                        assert!(off <= 2e-5 + b.error, "{at}: {off:e}, {a:?}, {b:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn refuses_what_is_no_lobe_or_view() {
    let model = integrator(2.0, 1e-6);
    let pane = Dielectric::new(1.5).unwrap();
    for (sigma, cos) in [([0.0, 0.1], 0.5), ([0.1, f64::NAN], 0.5), ([0.1, 0.2], 1.1)] {
        assert!(model.transmission_anisotropic(sigma, cos, 0.0, pane).is_err(), "{sigma:?} {cos}");
    }
}
