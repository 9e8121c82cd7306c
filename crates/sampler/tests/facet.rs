//! A facet agrees with the separate functions of its lobe, whatever the length of the normal.

use glam::Vec3;

use microfacet_sampler::lobe::{Facet, Reflecting};
use microfacet_sampler::{Ggx, Masking, MicrofacetDistribution, Skew, Tables};

const COSINES: [f32; 6] = [1.0, 0.9, 0.4, 0.05, 1e-3, 1e-6];

fn directions() -> impl Iterator<Item = Vec3> {
    COSINES.into_iter().enumerate().map(|(i, z)| {
        let (y, x) = (0.7 + 2.1 * i as f32).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * x, r * y, z)
    })
}

fn check(name: &str, lobe: &impl MicrofacetDistribution) {
    for v in directions() {
        for l in directions() {
            let half = v + l;
            let m = half.normalize();
            for masking in Masking::ALL {
                let facet = lobe.facet(v, half, l, masking);
                let pdf = f64::from(lobe.visible_normal_pdf(v, m));
                let facing = f64::from(v.dot(m));
                let got = f64::from(facet.density) * facing;
                // The tolerance of D, and the rounding of the half vector's length.
                let tolerance = 4e-6 * (1.0 + f64::from(lobe.d(m)).max(1e-38).ln().abs());
                let lost = facet.density == f32::MAX || pdf < 1e-35;
                assert!(
                    (got - pdf).abs() <= tolerance * pdf || lost,
                    "{name} {v} {l}: {got} for {pdf}"
                );
                let weight = lobe.reflection_weight(v, l, masking);
                assert!(
                    (facet.weight - weight).abs() < 1e-6,
                    "{name} {v} {l} {masking}: {} for {weight}",
                    facet.weight
                );
                // Powers of 2 change no bit of the normal.
                for length in [0.125, 8.0] {
                    let scaled = lobe.facet(v, length * half, l, masking);
                    assert_eq!(scaled, facet, "{name} {v} {l}, length {length}");
                }
            }
        }
        // Not a number, at the horizon and below it.
        let below = Vec3::new(0.6, 0.0, -0.8);
        for (v, m, l) in [(below, Vec3::Z, v), (Vec3::X, Vec3::Z, v), (v, below, v)] {
            let facet = lobe.facet(v, m, l, Masking::HeightCorrelated);
            assert_eq!(facet.density * facet.weight, 0.0, "{name} {v} {m} {l}: {facet:?}");
        }
        for l in [below, Vec3::Y, Vec3::NAN] {
            let facet = lobe.facet(v, Vec3::Z, l, Masking::HeightCorrelated);
            assert_eq!(facet.weight, 0.0, "{name} {v} {l}");
        }
        let none = lobe.facet(Vec3::NAN, v, v, Masking::HeightCorrelated);
        assert_eq!(none, Facet::default(), "{name}");
    }
}

#[test]
fn facets_are_those_of_the_separate_functions() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    for sigma in [[0.5, 0.5], [0.02, 0.3], [5.0, 1.0]] {
        check("ggx", &Ggx::new(sigma).unwrap());
        for gamma in [1.501, 1.7, 1.8, 2.0, 2.3, 4.0, 40.0, 1e4, f64::INFINITY] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            check(&format!("{sigma:?} {gamma}"), &lobe);
            check(&format!("bounded {sigma:?} {gamma}"), &lobe.bounded());
            let per_hit = family.at(sigma, gamma as f32).bounded();
            check(&format!("bounded per hit {sigma:?} {gamma}"), &per_hit);
        }
    }
    // Upright, tilted, and tilted so far that views lie below the lobe's horizon.
    for turns in [[0.0; 3], [0.2, -0.1, 0.5], [1.0, 0.0, 0.0]] {
        let skew = Skew::new([0.3, 0.1], turns).unwrap();
        for gamma in [1.6, 2.5, f64::INFINITY] {
            let lobe = tables.ellipsoid(skew, gamma).unwrap();
            check(&format!("{turns:?} {gamma}"), &lobe);
        }
    }
}

fn check_reflecting(name: &str, lobe: &impl Reflecting) {
    let ends = [0.0, 1e-7, 0.01, 0.3, 0.5, 0.8, 0.999_999, 1.0];
    for v in directions() {
        for u in ends.into_iter().flat_map(|a| ends.map(|b| [a, b])) {
            let (m, share) = lobe.sample_reflecting_normal(v, u);
            let (m, want) = (Vec3::from(m), Vec3::from(lobe.sample_visible_normal(v, u)));
            assert_eq!(share, 1.0);
            // The length of what is not normalised is needed as a square.
            let length2 = m.dot(m);
            assert!((1e-36..1e36).contains(&length2), "{name} {v} {u:?}: {m}");
            let unit = m / length2.sqrt();
            assert!((unit - want).length() < 4e-7, "{name} {v} {u:?}: {unit} for {want}");
            // On the silhouette v·m may be negative by rounding.
            let facing = v.dot(m) / length2.sqrt();
            assert!(facing > -5e-7, "{name} {v} {u:?}: {facing}");
        }
    }
}

#[test]
fn normals_that_reflect_are_the_visible_ones_of_any_length() {
    let tables = Tables::embedded();
    for sigma in [[0.5, 0.5], [0.02, 0.3], [1e-8, 1e-8], [1e6, 1e6], [1e-8, 1e6]] {
        check_reflecting(&format!("ggx {sigma:?}"), &Ggx::new(sigma).unwrap());
        for gamma in [1.501, 1.8, 2.0, 4.0, f64::INFINITY] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            check_reflecting(&format!("{sigma:?} {gamma}"), &lobe);
        }
    }
    let skew = Skew::new([0.3, 0.1], [0.2, -0.1, 0.5]).unwrap();
    check_reflecting("tilted", &tables.ellipsoid(skew, 2.5).unwrap());
}

/// A matrix may reduce a steep normal to the size that its z had before the factor of the heavy
/// part.
#[test]
fn normals_of_almost_singular_matrices_are_of_unit_length() {
    let tables = Tables::embedded();
    for gamma in [1.501, 1.51, 1.6] {
        let skew = Skew::new([1e-8, 1e6], [0.3, 0.0, 0.0]).unwrap();
        let lobe = tables.ellipsoid(skew, gamma).unwrap();
        for elevation in [8e-4_f32, 1e-4, 4e-5, 1e-5, 6e-6] {
            let v = Vec3::new(elevation.cos(), 0.0, elevation.sin());
            for i in 0..4000 {
                let u = [1.0 - i as f32 * 1e-7, 0.5];
                let m = Vec3::from(lobe.sample_visible_normal(v, u));
                let length = m.as_dvec3().length();
                assert!((length - 1.0).abs() < 5e-7, "gamma {gamma}, {elevation}, {u:?}: {length}");
            }
        }
    }
}
