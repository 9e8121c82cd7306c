//! The model against its own definitions: normalisations, defining integrals, and samplers by χ².

#![allow(
    clippy::disallowed_methods,
    reason = "only what is baked must be the same on every system"
)]

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use microfacet_model::statistics::test_visible_normals;
use microfacet_model::{
    Ellipsoid, Masking, MicrofacetDistribution, Shape, SignedSlope, Skew, StudentT, UnitView,
    VisibleSlope, across_cdf, across_quantile,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const GAMMAS: [f64; 7] = [1.55, 1.8, 2.0, 2.5, 3.0, 20.0, f64::INFINITY];

/// ∫ f(m) dm over the upper hemisphere by the midpoint rule in (r, ψ) of unit slopes, r = w/(1−w).
fn over_hemisphere(material: &StudentT, f: impl Fn(DVec3) -> f64) -> f64 {
    let (radial, angular) = (4000, 64);
    let (sx, sy) = (material.sigma_x(), material.sigma_y());
    let mut sum = 0.0;
    for i in 0..radial {
        // 1 − w = t⁴ resolves the heavy tails.
        let t = (f64::from(i) + 0.5) / f64::from(radial);
        let rest = t * t * t * t;
        let r = (1.0 - rest) / rest;
        let dr = 4.0 * t * t * t / (rest * rest) / f64::from(radial);
        for j in 0..angular {
            let psi = (f64::from(j) + 0.5) / f64::from(angular) * 2.0 * PI;
            let m = DVec3::new(sx * r * libm::cos(psi), sy * r * libm::sin(psi), 1.0).normalize();
            let area = sx * sy * r * dr * 2.0 * PI / f64::from(angular);
            sum += f(m) * m.z * m.z * m.z * area;
        }
    }
    sum
}

#[test]
fn d_is_normalised_and_p22_is_its_density_of_slopes() {
    for gamma in GAMMAS {
        let material = StudentT::new([0.3, 0.8], gamma).unwrap();
        let total = over_hemisphere(&material, |m| material.d(m) * m.z);
        assert!((total - 1.0).abs() < 1e-5, "gamma {gamma}: {total}");
        let m = DVec3::new(0.3, -0.2, 0.7).normalize();
        let p22 = material.p22(-m.x / m.z, -m.y / m.z);
        assert!((material.d(m) * m.z.powi(4) / p22 - 1.0).abs() < 1e-13);
    }
}

#[test]
fn g1_is_its_defining_integral() {
    // cos θ_v = G1 ∫ (v·m)⁺ D dm; γ starts at 2 because heavier tails extend beyond the grid.
    for gamma in [2.0, 2.5, 3.0, 20.0, f64::INFINITY] {
        let material = StudentT::new([0.4, 0.9], gamma).unwrap();
        for theta in [0.3_f64, 1.0, 1.4] {
            let v = DVec3::new(theta.sin() * 0.6, theta.sin() * 0.8, theta.cos());
            let seen = over_hemisphere(&material, |m| v.dot(m).max(0.0) * material.d(m));
            let (g1, got) = (v.z / seen, material.g1(v));
            assert!((g1 - got).abs() < 2e-4, "gamma {gamma}, theta {theta}: {g1} {got}");
        }
    }
}

#[test]
fn beckmann_g1_is_the_closed_form() {
    let material = StudentT::beckmann(0.5).unwrap();
    for theta in [0.2_f64, 0.9, 1.3, 1.5] {
        let a = 1.0 / (0.5 * theta.tan());
        let lambda = 0.5 * (libm::erf(a) - 1.0) + libm::exp(-a * a) / (2.0 * a * PI.sqrt());
        let v = DVec3::new(theta.sin(), 0.0, theta.cos());
        assert!((material.lambda(v) - lambda).abs() < 1e-15 + 1e-13 * lambda);
        let l = DVec3::new(0.0, 0.6, 0.8);
        let both = 1.0 / (1.0 + material.lambda(v) + material.lambda(l));
        assert!((material.g2(v, l, Masking::HeightCorrelated) - both).abs() < 1e-15);
        assert_eq!(material.g2(v, l, Masking::Uncorrelated), material.g1(v) * material.g1(l));
    }
}

#[test]
fn blinn_phong_is_an_identity() {
    let exponent = 37.0;
    let material = StudentT::blinn_phong(exponent).unwrap();
    for cos in [0.05, 0.4, 0.9, 1.0_f64] {
        let m = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let want = (exponent + 2.0) / (2.0 * PI) * cos.powf(exponent);
        assert!((material.d(m) / want - 1.0).abs() < 1e-12, "{cos}");
    }
}

#[test]
fn quantiles_invert_their_cdfs() {
    for gamma in GAMMAS {
        let shape = Shape::new(gamma).unwrap();
        for z in [0.0, 1e-3, 0.4, 2.0, 50.0, f64::INFINITY] {
            for slopes in [
                VisibleSlope::new(&shape, UnitView::from_cotangent(z)),
                VisibleSlope::peeled(&shape, UnitView::from_cotangent(z)),
            ] {
                for u in [1e-9, 1e-3, 0.2, 0.5, 0.8, 0.999] {
                    let back = slopes.cdf(slopes.quantile(u));
                    assert!((back - u).abs() < 1e-13, "gamma {gamma}, z {z}, u {u}: {back}");
                }
            }
        }
        for u in [1e-9, 0.1, 0.5, 0.9] {
            let t: SignedSlope = across_quantile(&shape, u);
            assert!((across_cdf(&shape, t) - u).abs() < 1e-14);
        }
    }
}

/// Three samplers: by rejection, by inverse CDFs, and (for its own density) that of the NDF.
#[test]
fn samplers_draw_the_visible_normals() {
    for gamma in GAMMAS {
        let material = StudentT::new([0.5, 0.2], gamma).unwrap();
        for theta in [0.1_f64, 1.0, 1.55] {
            let v = DVec3::new(theta.sin() * 0.8, theta.sin() * -0.6, theta.cos());
            let mut random = StdRng::seed_from_u64(3);
            let exact = |_: [f32; 2]| {
                material.sample_visible_by_rejection(v, &mut || random.random()).as_vec3()
            };
            let outcome = test_visible_normals(&material, v, 100_000, 5, exact);
            assert!(outcome.p() > 1e-4, "exact, gamma {gamma}, theta {theta}: {outcome:?}");
            let inverse =
                |u: [f32; 2]| material.sample_visible_normal(v, u.map(f64::from)).as_vec3();
            let outcome = test_visible_normals(&material, v, 20_000, 5, inverse);
            assert!(outcome.p() > 1e-4, "inverse, gamma {gamma}, theta {theta}: {outcome:?}");
        }
        // At normal incidence visible normals are the NDF weighted by m·n, which sample_ndf draws.
        let draw = |u: [f32; 2]| -> Vec3 { material.sample_ndf(u.map(f64::from)).as_vec3() };
        let outcome = test_visible_normals(&material, DVec3::Z, 100_000, 5, draw);
        assert!(outcome.p() > 1e-4, "ndf, gamma {gamma}: {outcome:?}");
    }
}

/// A normal over x at the cosine z, however small.
fn low(z: f64) -> DVec3 {
    DVec3::new(1.0, 0.0, z)
}

#[test]
fn d_follows_its_power_law_down_to_the_smallest_cosines() {
    // α²/π for every normal on the horizon.
    let ggx = StudentT::ggx(0.5).unwrap();
    for z in [1e-10, 1e-150, 1e-160, 1e-200, 1e-300, 5e-324] {
        let relative = ggx.d(low(z)) / (0.25 / PI);
        assert!((relative - 1.0).abs() < 1e-12, "{z}: {relative}");
    }
    for gamma in [1.501, 1.6, 1.9, 2.1, 2.4] {
        let lobe = StudentT::new([0.5, 0.3], gamma).unwrap();
        let skew = Skew::new([0.5, 0.3], [0.2, 0.1, 0.0]).unwrap();
        let tilted = Ellipsoid::new(skew, gamma).unwrap();
        for z in [1e-140_f64, 1e-155, 1e-165, 1e-290] {
            // D ∝ z^(2γ−4) there, and does not overflow.
            let power = (2.0 * gamma - 4.0) * (z.ln() - 1e-100_f64.ln());
            for [at, from] in
                [[lobe.d(low(z)), lobe.d(low(1e-100))], [tilted.d(low(z)), tilted.d(low(1e-100))]]
            {
                assert!(((at / from).ln() - power).abs() < 1e-11, "{gamma} {z}: {at} from {from}");
            }
        }
        // At the smallest cosine D overflows for γ near 3/2.
        assert!(lobe.d(low(5e-324)) <= f64::MAX && tilted.d(low(5e-324)) <= f64::MAX);
    }
    assert_eq!(StudentT::beckmann(0.5).unwrap().d(low(1e-200)), 0.0);
    // Roughnesses whose product underflows.
    for gamma in [1.6, 2.0, 4.0, f64::INFINITY] {
        let smooth = StudentT::new(1e-200, gamma).unwrap();
        assert_eq!(smooth.d(DVec3::Z), f64::MAX);
        let aside = smooth.d(DVec3::new(0.6, 0.0, 0.8));
        assert!((0.0..1e-100).contains(&aside), "{gamma}: {aside}");
    }
}

#[test]
fn densities_of_all_draws_are_finite() {
    let ends = [0.0, 1e-300, 1e-17, 0.25, 0.5, 0.76, 0.9, 1.0 - 1e-16, 1.0];
    let mut seed = 1_u64;
    let mut uniform = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for gamma in [1.500_001, 1.501, 1.51, 1.6, 1.9, 2.0, 3.0, f64::INFINITY] {
        for sigma in [1e-8, 0.5, 1e6] {
            let lobe = StudentT::new([sigma, 0.7 * sigma], gamma).unwrap();
            let skew = Skew::new([sigma, 0.7 * sigma], [0.3, -0.2, 0.5]).unwrap();
            let tilted = Ellipsoid::new(skew, gamma).unwrap();
            for v in [0.0_f64, 0.5, 1.3, 1.57].map(|t| DVec3::new(t.sin(), 0.0, t.cos())) {
                let mut normals: Vec<DVec3> = Vec::new();
                for u in ends.iter().flat_map(|&a| ends.map(|b| [a, b])) {
                    normals.push(lobe.sample_visible_normal(v, u));
                    normals.push(tilted.sample_visible_normal(v, u));
                    normals.push(lobe.sample_ndf(u));
                    normals.push(tilted.sample_ndf(u));
                    normals.push(lobe.sample_visible_by_rejection(v, &mut uniform));
                }
                for m in normals {
                    assert!((m.length() - 1.0).abs() < 1e-14 && m.z > 0.0, "{gamma} {sigma} {m}");
                    let densities = [
                        lobe.d(m),
                        tilted.d(m),
                        lobe.visible_normal_pdf(v, m),
                        tilted.visible_normal_pdf(v, m),
                    ];
                    let sound = densities.iter().all(|x| (0.0..=f64::MAX).contains(x));
                    assert!(sound, "{gamma} {sigma} {v} {m}: {densities:?}");
                }
            }
        }
    }
}
