//! Laws that the run-time sampler obeys in single precision, for every table, view and random
//! number.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use microfacet_sampler::{
    Bsdf, BsdfSettings, Dielectric, Masking, MicrofacetDistribution, StudentT, Tables,
};
use proptest::prelude::*;

fn material() -> impl Strategy<Value = StudentT> {
    let edges = vec![1.501, 1.6, 1.8_f64.next_down(), 1.8, 2.0, 3.0, 1e4, 1e16, f64::INFINITY];
    let gamma = prop_oneof![prop::sample::select(edges), 1.501..10.0];
    let sigma = || prop_oneof![prop::sample::select(vec![1e-4_f32, 0.3, 10.0]), 0.01..3.0_f32];
    let tables = Tables::embedded();
    (sigma(), sigma(), gamma)
        .prop_map(move |(x, y, gamma)| tables.student_t([x, y], gamma).unwrap())
}

fn theta() -> impl Strategy<Value = f32> {
    prop_oneof![prop::sample::select(vec![0.0, 1e-20, 1e-4, 1.57, FRAC_PI_2]), 0.0..FRAC_PI_2]
}

fn direction() -> impl Strategy<Value = Vec3> {
    (theta(), -PI..PI).prop_map(|(theta, phi)| at(theta, phi))
}

fn at(theta: f32, phi: f32) -> Vec3 {
    let (sin, cos) = theta.sin_cos();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos.max(0.0))
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        prop::sample::select(vec![0.0, 1e-45, 1e-12, 0.5, 1.0_f32.next_down(), 1.0]),
        0.0..1.0_f32
    ]
}

fn close(a: f32, b: f32, relative: f32) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn masking_is_reciprocal_and_ordered(t in material(), v in direction(), l in direction()) {
        let [separate, joint] = [Masking::Uncorrelated, Masking::HeightCorrelated].map(|masking| t.g2(v, l, masking));
        prop_assert_eq!(separate, t.g2(l, v, Masking::Uncorrelated));
        prop_assert_eq!(joint, t.g2(l, v, Masking::HeightCorrelated));
        prop_assert!(0.0 <= separate && separate <= joint * (1.0 + 1e-6));
        prop_assert!(joint <= t.g1(v).min(t.g1(l)) * (1.0 + 1e-6));
    }

    #[test]
    fn only_stretched_directions_matter(t in material(), theta in 0.01..1.55_f32, phi in -PI..PI) {
        // G1 of an anisotropic material is G1 of an isotropic one with the roughness along the
        // view.
        let v = at(theta, phi);
        let [x, y] = t.sigma();
        let along = (x * phi.cos()).hypot(y * phi.sin());
        prop_assert!((t.g1(v) - t.with_roughness(along).g1(at(theta, 1.0))).abs() < 2e-6);
    }

    #[test]
    fn mirrors_change_nothing(
        t in material(), v in direction(), m in direction(), u in number(),
        across in prop::sample::select(vec![0.0_f32, 0.125, 0.25, 0.75, 1.0]),
    ) {
        for mirror in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, 1.0)] {
            prop_assert_eq!(t.g1(v), t.g1(v * mirror));
            prop_assert_eq!(t.d(m), t.d(m * mirror));
            prop_assert_eq!(t.visible_normal_pdf(v, m), t.visible_normal_pdf(v * mirror, m * mirror));
        }
        let flip = Vec3::new(1.0, -1.0, 1.0);
        let [a, b] = [(v, across), (v * flip, 1.0 - across)]
            .map(|(v, across)| Vec3::from(t.sample_visible_normal(v, [u, across])));
        // At normal incidence the azimuth is that of the tangent frame, which the mirror keeps.
        prop_assert!((a - b * flip).length() < 1e-5, "{a} {b}");
    }

    #[test]
    fn numbers_outside_are_taken_at_the_ends(t in material(), v in direction(), u in number(), far in 0.0..9.0_f32) {
        prop_assert_eq!(t.sample_visible_normal(v, [-far, u]), t.sample_visible_normal(v, [0.0, u]));
        prop_assert_eq!(t.sample_visible_normal(v, [u, 1.0 + far]), t.sample_visible_normal(v, [u, 1.0]));
    }

    #[test]
    fn ggx_is_the_closed_form(alpha in 1e-3..3.0_f32, v in direction(), m in direction()) {
        let t = Tables::embedded().student_t(alpha, 2.0).unwrap();
        let lambda = |w: Vec3| {
            let w = w.as_dvec3();
            let tan2 = w.truncate().length_squared() / (w.z * w.z);
            0.5 * ((1.0 + f64::from(alpha).powi(2) * tan2).sqrt() - 1.0)
        };
        prop_assert!((f64::from(t.g1(v)) - 1.0 / (1.0 + lambda(v))).abs() < 1e-5 || v.z <= 0.0);
        if m.z > 1e-3 {
            let (a2, z2) = (f64::from(alpha).powi(2), f64::from(m.z).powi(2));
            let r2 = m.as_dvec3().truncate().length_squared();
            let d = a2 / (std::f64::consts::PI * (a2 * z2 + r2).powi(2));
            prop_assert!(close(t.d(m), d as f32, 1e-5), "{} {d}", t.d(m));
        }
    }
}

/// A surface has the same facets from below: those of the negated view, which a dielectric reflects
/// inside with their density, and not those of its mirror image.
#[test]
fn views_of_the_other_side_are_negated() {
    let lobe = Tables::embedded().student_t(0.5, 2.7).unwrap();
    let glass = Dielectric::new(lobe.clone(), 1.5, BsdfSettings::new()).unwrap();
    let v = Vec3::new(0.6, 0.0, -0.8);
    let image = v * Vec3::new(1.0, 1.0, -1.0);
    let mut seen = 0;
    for m in (0..400).map(|i| at(0.02 * (i % 20) as f32, 0.3 * (i / 20) as f32)) {
        let l = 2.0 * v.dot(m) * m - v;
        // All light is reflected below the critical angle's cosine of sqrt(1 - 1/1.5^2).
        if -v.dot(m) > 0.74 || v.dot(m) > -0.01 || l.z > -0.01 {
            continue;
        }
        let density = glass.pdf(v, l) * 4.0 * -v.dot(m);
        let [negated, mirrored] = [-v, image].map(|v| lobe.visible_normal_pdf(v, m));
        assert!(close(density, negated, 1e-4), "{m}: {density} is not {negated}");
        assert!(!close(density, mirrored, 0.03), "{m}: {density} is {mirrored}");
        seen += 1;
    }
    assert!(seen > 30 && lobe.g1(-v) == lobe.g1(image), "{seen}");
    // The example of docs/export.md.
    let m = Vec3::new(-0.5, 0.0, 0.75_f32.sqrt());
    let [negated, mirrored] = [-v, image].map(|v| lobe.visible_normal_pdf(v, m));
    assert!(
        (negated - 0.58).abs() < 5e-3 && (mirrored - 0.23).abs() < 5e-3,
        "{negated} {mirrored}"
    );
}

/// Where densities are subnormal f cos over the density has lost its digits; the weight has not.
#[test]
fn weights_keep_their_digits_in_the_far_tails_of_beckmann() {
    let mut worst = 0.0_f32;
    for sigma in [1e-3, 0.05] {
        let lobe = Tables::embedded().student_t(sigma, f64::INFINITY).unwrap();
        for i in 0..20_000 {
            let v = at(1.5 * (i as f32 * 0.618_034).fract(), i as f32);
            let along = if i % 2 == 0 { 0.0 } else { 1.0_f32.next_down() };
            let u = [along, (i as f32 * 0.754_877_7).fract()];
            let m =
                Vec3::from(lobe.sample_visible_normal(v, if i % 4 < 2 { u } else { [u[1], u[0]] }));
            let l = 2.0 * v.dot(m) * m - v;
            if l.z > 0.0 {
                let f_cos = lobe.d(m) * lobe.g2(v, l, Masking::HeightCorrelated) / (4.0 * v.z);
                let pdf = lobe.visible_normal_pdf(v, m) / (4.0 * v.dot(m));
                if pdf > 0.0 {
                    worst = worst.max(f_cos / pdf);
                }
                let weight = lobe.reflection_weight(v, l, Masking::HeightCorrelated);
                assert!((0.0..=1.0).contains(&weight), "{v} {l}: {weight}");
            }
        }
    }
    assert!(worst > 1.001, "{worst}: docs/export.md says otherwise");
}
