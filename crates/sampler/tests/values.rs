//! Values of the run-time functions against the f64 model, and the properties their docs promise.

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::lobe::Tabulated;
use microfacet_sampler::{Masking, MicrofacetDistribution as _, StudentT, Tables};
use microfacet_tables::Precision;

const GAMMAS: [f64; 9] = [1.501, 1.55, 1.799_99, 1.8, 2.0, 3.0, 8.5, 1e5, f64::INFINITY];

fn directions() -> impl Iterator<Item = Vec3> {
    let thetas = [0.0, 1e-4, 0.3, 0.9, 1.4, 1.56, 1.5705];
    let phis = [0.0, 0.8, 2.9, -1.6];
    thetas.into_iter().flat_map(move |theta: f64| {
        phis.into_iter().map(move |phi: f64| {
            DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()).as_vec3()
        })
    })
}

fn pairs() -> impl Iterator<Item = (StudentT, model::StudentT)> {
    let tables = Tables::embedded();
    let roughness = [[0.3, 0.3], [1e-3, 0.01], [4.0, 0.5]];
    GAMMAS.into_iter().flat_map(move |gamma| {
        let tables = tables.clone();
        roughness.into_iter().map(move |sigma: [f64; 2]| {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let [x, y] = lobe.sigma().map(f64::from);
            (lobe, model::StudentT::new([x, y], gamma).unwrap())
        })
    })
}

#[test]
fn g1_and_g2_are_the_models() {
    for (lobe, truth) in pairs() {
        for v in directions() {
            let exact = truth.g1(v.as_dvec3());
            // The certificate's 4e-6 and the rounding of f32.
            assert!(
                (f64::from(lobe.g1(v)) - exact).abs() < 4.2e-6,
                "{truth:?} {v}: {} {exact}",
                lobe.g1(v)
            );
            let l = Vec3::new(0.36, -0.48, 0.8);
            for form in Masking::ALL {
                let exact = truth.g2(v.as_dvec3(), l.as_dvec3(), form);
                assert!((f64::from(lobe.g2(v, l, form)) - exact).abs() < 1e-5, "{truth:?} {v}");
            }
        }
        for below in [Vec3::X, -Vec3::Z, Vec3::new(0.6, 0.0, -0.8)] {
            assert_eq!(lobe.g1(below), 0.0);
            assert_eq!(lobe.lambda(below), f32::INFINITY);
            assert_eq!(lobe.g2(below, Vec3::Z, Masking::HeightCorrelated), 0.0);
        }
    }
}

#[test]
fn densities_are_the_models() {
    for (lobe, truth) in pairs() {
        for v in directions() {
            for u in [[0.02, 0.3], [0.4, 0.9], [0.77, 0.51], [0.99, 0.04]] {
                let m = Vec3::from(lobe.sample_visible_normal(v, u));
                let exact = truth.d(m.as_dvec3());
                let d = f64::from(lobe.d(m));
                if exact > 1e35 {
                    // Next to the horizon at γ < 2, f32 holds the order of magnitude only.
                    assert!(d > 1e34, "{truth:?} {m}: {d} {exact}");
                    continue;
                }
                // Rounding of the exponent: |ln D| times a few ulp.
                let scale = 1.0 + (exact * f64::from(lobe.sigma()[0] * lobe.sigma()[1])).ln().abs();
                assert!(
                    (d / exact - 1.0).abs() < 2e-6 * scale || exact < 1e-35,
                    "{truth:?} {m}: {d} {exact}"
                );
                let exact = truth.visible_normal_pdf(v.as_dvec3(), m.as_dvec3());
                let pdf = f64::from(lobe.visible_normal_pdf(v, m));
                // v·m cancels where m almost faces away.
                let facing = v.as_dvec3().dot(m.as_dvec3());
                // The certificate limits the absolute error of G1; the density divides by the area,
                // 1/G1.
                let g1 = truth.g1(v.as_dvec3());
                let tolerance = 4.2e-6 / g1 + 2e-6 * scale + 3e-7 / facing.max(1e-9);
                assert!(
                    (pdf - exact).abs() <= tolerance * exact + 1e-30,
                    "{truth:?} {v} {m}: {pdf} {exact}"
                );
            }
        }
    }
}

#[test]
fn table_pdf_approaches_the_analytic_density() {
    for (lobe, truth) in pairs() {
        for v in directions().filter(|v| v.z > 0.1) {
            for u in [[0.2, 0.3], [0.4, 0.9], [0.77, 0.51], [0.6, 0.2]] {
                let m = Vec3::from(lobe.sample_visible_normal(v, u));
                let table = f64::from(lobe.table_pdf(v, m));
                let exact = truth.visible_normal_pdf(v.as_dvec3(), m.as_dvec3());
                assert!((table / exact - 1.0).abs() < 0.02, "{truth:?} {v} {u:?}: {table} {exact}");
            }
        }
    }
}

#[test]
fn sampled_normals_are_unit_upward_and_facing_and_rise_with_u() {
    for (lobe, truth) in pairs() {
        for v in directions() {
            let azimuth = Vec3::new(v.x, v.y, 0.0);
            let mut last = f32::NEG_INFINITY;
            for i in 0..=64 {
                let u = i as f32 / 64.0;
                for other in [0.0, 0.3, 1.0] {
                    let m = Vec3::from(lobe.sample_visible_normal(v, [u, other]));
                    let what = format!("{truth:?} {v} u {u} {other}: {m}");
                    assert!((m.length() - 1.0).abs() < 4.0 * f32::EPSILON && m.z > 0.0, "{what}");
                    assert!(v.dot(m) > -1.2e-7, "{what} faces away by {:e}", v.dot(m));
                }
                // In the plane of incidence (u₂ = ½) of an isotropic material, the tilt towards the
                // viewer rises.
                let m = Vec3::from(lobe.sample_visible_normal(v, [u, 0.5]));
                let [x, y] = lobe.sigma();
                if x == y && lobe.gamma() >= 1.8 && azimuth.length() > 0.0 {
                    let tilt = m.dot(azimuth / azimuth.length()) / m.z;
                    assert!(
                        tilt >= last - 1e-6 * tilt.abs(),
                        "{truth:?} {v} {u}: {tilt} after {last}"
                    );
                    last = tilt;
                }
            }
        }
    }
}

/// Where a texture of roughness crosses the limit of smooth surfaces, the light of one bounce jumps
/// to all of it.
#[test]
fn smooth_surfaces_brighten_little_at_the_limit() {
    let tables = Tables::embedded();
    for gamma in [1.501, 1.52, 1.55, 1.6, 1.8, 1.9, 2.0, 2.2, 3.0, f64::INFINITY] {
        let is_smooth =
            |sigma: f64| tables.student_t(sigma, gamma).unwrap().is_effectively_smooth();
        // By bisection on a logarithmic scale.
        let (mut low, mut high) = (1e-8_f64, 1e-2_f64);
        assert!(is_smooth(low) && !is_smooth(high), "{gamma}");
        for _ in 0..40 {
            let middle = (low * high).sqrt();
            if is_smooth(middle) { low = middle } else { high = middle }
        }
        let integrator = model::AlbedoIntegrator::new(model::Shape::new(gamma).unwrap(), 1e-6);
        for cos in [0.01, 0.1, 0.8] {
            let returned = integrator.reflection(high, cos, |_| [1.0]).unwrap();
            for form in Masking::ALL {
                let lost = 1.0 - returned.of(form)[0];
                assert!(lost < 6e-3, "gamma {gamma}, sigma {high:e}, cos {cos}: {lost:e}");
            }
        }
    }
}

/// Slopes whose square overflows: Beckmann's D is 0 there, and not 0·∞.
#[test]
fn beckmann_is_zero_on_the_horizon() {
    let tables = Tables::embedded();
    for (sigma, z) in [(0.01, 1e-18), (0.4, 1e-19), (1e-8, 1e-12), (0.3, 1e-30), (0.3, 1e-45)] {
        let lobe = tables.student_t(sigma, f64::INFINITY).unwrap();
        let (m, v) = (Vec3::new(1.0, 0.0, z), Vec3::new(0.8, 0.0, 0.6));
        assert_eq!((lobe.d(m), lobe.visible_normal_pdf(v, m)), (0.0, 0.0), "{sigma} {z}");
    }
}

/// Rounding to 16 bits separates the halves of the random numbers by up to 1e-3 where they meet;
/// samples would leave out the gap, or draw it twice.
#[test]
fn slopes_are_continuous_at_one_half_at_every_precision() {
    let set = Tables::embedded();
    for precision in [Precision::F32, Precision::F16, Precision::U16] {
        let tables = set.tables().iter().map(|table| table.clone().rounded(precision)).collect();
        let rounded = Tables::from_tables(Default::default(), tables).unwrap();
        for gamma in [1.8, 1.94, 3.0, 5.03, f64::INFINITY] {
            let lobe = rounded.student_t(1.0, gamma).unwrap();
            for z in [0.02_f32, 0.3, 0.55, 0.8, 0.99] {
                let v = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let normal = |u| Vec3::from(lobe.sample_visible_normal(v, [u, 0.5]));
                let jump = normal(0.5).distance(normal(0.5_f32.next_up()));
                assert!(jump < 1e-6, "{precision:?}, gamma {gamma}, {z}: {jump}");
            }
        }
    }
}
