//! Numbers of textures that are out of range, and views and random numbers that are none.

use microfacet_sampler::lobe::Batch as _;
use microfacet_sampler::{Masking, MicrofacetDistribution as _};

use super::*;

/// What a lobe gives at some views, by its bits.
fn bits(lobe: FamilyLobe<'_>) -> Vec<u32> {
    let mut bits: Vec<u32> = lobe.sigma().map(f32::to_bits).to_vec();
    bits.push((lobe.gamma() as f32).to_bits());
    for z in [1.0, 0.6, 0.01, 0.0] {
        let v = view(z, 0.7);
        let m = lobe.sample_visible_normal(v, [0.3, 0.8]);
        bits.extend(m.map(f32::to_bits));
        bits.extend([lobe.g1(v), lobe.d(m), lobe.visible_normal_pdf(v, m)].map(f32::to_bits));
    }
    bits
}

#[test]
fn roughness_is_clamped() {
    let family = family();
    let shape = Tables::embedded().student_t(1.0, 2.5).unwrap();
    let [low, high] = [1e-8, 1e6];
    for (given, taken) in [
        (0.0, low),
        (-0.0, low),
        (-1.0, low),
        (f32::NEG_INFINITY, low),
        (1e-9, low),
        (1e-45, low),
        (f32::NAN, low),
        (2e6, high),
        (f32::MAX, high),
        (f32::INFINITY, high),
    ] {
        for [given, taken] in [
            [[given, given], [taken, taken]],
            [[given, 0.3], [taken, 0.3]],
            [[0.3, given], [0.3, taken]],
        ] {
            for gamma in [1.6, 2.5, INF] {
                assert_eq!(
                    bits(family.at(given, gamma)),
                    bits(family.at(taken, gamma)),
                    "{given:?}"
                );
            }
            assert_eq!(family.at(given, 2.5).sigma(), taken);
            assert_eq!(shape.with_roughness(given).sigma(), taken);
        }
    }
}

#[test]
fn shapes_are_clamped() {
    let family = family();
    let [low, high] = [1.501, INF];
    for (given, taken) in [
        (f32::NAN, low),
        (1.5, low),
        (1.500_999_9, low),
        (1.0, low),
        (0.0, low),
        (-2.0, low),
        (f32::NEG_INFINITY, low),
        (INF, high),
        (1e18, high),
        (f32::MAX, high),
        (1.8, 1.8),
        (1.8_f32.next_down(), 1.8_f32.next_down()),
        (2.0, 2.0),
    ] {
        // The end of a table is that end where single precision rounds it outwards.
        let exact = if taken == 1.8 { 1.8 } else { f64::from(taken) };
        assert_eq!(family.at(0.3, given).gamma(), exact, "{given}");
        assert_eq!(bits(family.at(0.3, given)), bits(family.at(0.3, taken)), "{given}");
    }
    assert_eq!(family.gammas().collect::<Vec<_>>(), [[1.8, f64::INFINITY], [1.501, 1.8]]);
}

#[test]
fn every_normal_is_of_unit_length_above_the_horizon_and_faces() {
    let (family, mut random) = (family(), random());
    let odd = [0.0, 1.0, f32::NAN, -1.0, 2.0, 0.5, 1e-45, 1.0_f32.next_down(), -INF, INF];
    let mut views: Vec<Vec3> = COSINES.iter().map(|&z| view(z, 2.0)).collect();
    views.extend([-0.1, -0.5, -1.0].map(|z| view(z, -1.0)));
    views.extend([Vec3::X, -Vec3::Y, Vec3::NAN, Vec3::new(0.0, f32::NAN, 1.0)]);
    views.extend([Vec3::new(1e-20, 0.0, 1.0), Vec3::new(1.0, 0.0, 1e-30), Vec3::ZERO]);
    let [mut lengths, mut hidden] = std::array::from_fn(|_| Worst::default());
    for gamma in [&gammas()[..], &[f32::NAN, 1.0, 1.5, 0.0, -INF, 1e18]].concat() {
        for sigma in [&SIGMAS[..], &[[0.0, 0.3], [f32::NAN, INF]]].concat() {
            let lobe = family.at(sigma, gamma);
            for &v in &views {
                let g1 = lobe.g1(v);
                assert!((0.0..=1.0).contains(&g1) || v.is_nan(), "{gamma} {sigma:?} {v}: {g1}");
                let u = odd[random.random_range(0..odd.len())];
                let other = odd[random.random_range(0..odd.len())];
                for u in [[u, other], [random.random(), other], [u, random.random()]] {
                    let m = Vec3::from(lobe.sample_visible_normal(v, u)).as_dvec3();
                    let what = || format!("{gamma} {sigma:?} {v} {u:?}: {m}");
                    lengths.see((m.length() - 1.0).abs(), what);
                    assert!(m.z > 0.0, "{}", what());
                    if v.z >= 0.0 && v != Vec3::ZERO && !v.is_nan() {
                        hidden.see(-v.as_dvec3().dot(m), what);
                    }
                    let clamped = u.map(|u| if u > 0.0 { u.min(1.0) } else { 0.0 });
                    let again = Vec3::from(lobe.sample_visible_normal(v, clamped)).as_dvec3();
                    assert_eq!(m, again, "{}", what());
                }
            }
        }
    }
    lengths.allowed(4.0 * f64::from(f32::EPSILON));
    hidden.allowed(4.0 * f64::from(f32::EPSILON));
}

/// As of bound lobes: a direction that is none sees nothing, alone, in a pair and in a batch.
#[test]
fn what_is_no_direction_is_masked() {
    let (tables, family) = (Tables::embedded(), family());
    let nan = f32::NAN;
    let none = [
        [0.0, 0.0, 0.0],
        [nan, 0.0, 0.8],
        [0.6, nan, 0.8],
        [0.6, 0.0, nan],
        [nan, nan, nan],
        [0.6, 0.0, -0.8],
        [1.0, 0.0, 0.0],
    ];
    for gamma in [1.501, 1.6, 1.8, 2.5, INF] {
        let lobe = family.at([0.3, 0.5], gamma);
        let bound = tables.student_t([0.3, 0.5], lobe.gamma()).unwrap();
        let mut g1 = [1.0; 7];
        lobe.g1_batch(&none, &mut g1).unwrap();
        for (v, batch) in none.into_iter().zip(g1) {
            let masking = Masking::HeightCorrelated;
            let up = [0.0, 0.0, 1.0];
            assert_eq!([lobe.g1(v), batch, bound.g1(v)], [0.0; 3], "{gamma} {v:?}");
            let weights = [lobe.reflection_weight(up, v, masking), lobe.g2(v, up, masking)];
            assert_eq!(weights, [0.0; 2], "{gamma} {v:?}");
        }
    }
}
