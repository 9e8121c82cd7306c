//! Uses of albedos: reflectances from moments, and the lobe of all further bounces.

use glam::Vec3;
use microfacet_model::fresnel::{F82Tint, schlick_weight};
use microfacet_model::{AlbedoIntegrator, Shape};
use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Kind, Table};

const COSINES: [f32; 5] = [0.02, 0.1, 0.35, 0.8, 1.0];

fn view(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

fn for_each_albedo(mut check: impl FnMut(f64, f64, Masking, Albedo)) {
    let tables = Tables::embedded();
    for (sigma, gamma) in [(0.05, 1.6), (0.3, 2.0), (0.8, 5.0), (1.5, f64::INFINITY)] {
        for masking in Masking::ALL {
            check(sigma, gamma, masking, tables.albedo(sigma, gamma, masking).unwrap());
        }
    }
}

#[test]
fn moments_make_the_albedo_of_every_schlick_reflectance() {
    for_each_albedo(|sigma, gamma, masking, albedo| {
        let model = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for (f0, f90) in [(0.0, 1.0), (0.04, 1.0), (0.9, 0.2), (1.0, 1.0)] {
            for cos in COSINES {
                let schlick = |mu| [f0 + (f90 - f0) * schlick_weight(mu)];
                let want = model.reflection(sigma, cos.into(), schlick).unwrap().of(masking)[0];
                let got = albedo.moments(view(cos)).schlick(f0 as f32, f90 as f32);
                let at =
                    format!("sigma {sigma}, gamma {gamma}, {masking:?}, {cos}, F0 {f0}, F90 {f90}");
                assert!((f64::from(got) - want).abs() < 3e-4, "{at}: {got} for {want}");
            }
        }
    });
}

#[test]
fn moments_make_the_albedo_of_every_tinted_metal() {
    for_each_albedo(|sigma, gamma, masking, albedo| {
        let model = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-6);
        for (f0, tint) in [(0.9, 1.0), (0.9, 0.3), (0.5, 0.0)] {
            let metal = F82Tint::new(f0, tint).unwrap();
            for cos in COSINES {
                let want = model.reflection(sigma, cos.into(), |mu| [metal.reflectance(mu)]);
                let want = want.unwrap().of(masking)[0];
                let got = albedo.moments(view(cos)).f82_tint(f0 as f32, tint as f32);
                let at = format!(
                    "sigma {sigma}, gamma {gamma}, {masking:?}, {cos}, F0 {f0}, tint {tint}"
                );
                assert!((f64::from(got) - want).abs() < 3e-4, "{at}: {got} for {want}");
                // Without a tint the reflectance is Schlick's, and a tint lowers it.
                let plain = albedo.moments(view(cos)).schlick(f0 as f32, 1.0);
                assert!(if tint == 1.0 { got == plain } else { got < plain }, "{at}");
            }
        }
    });
}

/// Mean of f(l)/pdf(l) over a grid of random numbers: ∫ f over the hemisphere, if the density is
/// that of the lights.
fn by_sampling(albedo: &Albedo, f: impl Fn(Vec3) -> f32) -> f64 {
    // Heights need many steps towards the horizon; a few azimuths integrate trigonometric
    // polynomials without error.
    const STEPS: [usize; 2] = [1 << 14, 8];
    let step = |i: usize, n: usize| (i as f32 + 0.5) / n as f32;
    let numbers = (0..STEPS[0])
        .flat_map(|i| (0..STEPS[1]).map(move |j| [step(i, STEPS[0]), step(j, STEPS[1])]));
    let worth = |u| {
        let l = Vec3::from(albedo.sample_compensation(u));
        f64::from(f(l)) / f64::from(albedo.compensation_pdf(l))
    };
    numbers.map(worth).sum::<f64>() / (STEPS[0] * STEPS[1]) as f64
}

#[test]
fn lights_of_the_compensation_have_its_density() {
    let albedo = Tables::embedded().albedo(0.5, 2.0, Masking::HeightCorrelated).unwrap();
    let pi = std::f64::consts::PI;
    // Integrals over the hemisphere that detect other densities: by height, by azimuth, and both.
    type Integrand = fn(Vec3) -> f32;
    let sums: [(f64, Integrand); 5] = [
        (pi, |l| l.z),
        (2.0 * pi / 3.0, |l| l.z * l.z),
        (pi / 4.0, |l| l.z * l.x * l.x),
        (pi / 4.0, |l| l.z * l.y * l.y),
        (0.0, |l| l.z * l.x * l.y),
    ];
    for (i, (want, f)) in sums.into_iter().enumerate() {
        let got = by_sampling(&albedo, f);
        assert!((got - want).abs() < 1e-4, "{i}: {got} for {want}");
    }
    for u in [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.5], [f32::MIN_POSITIVE, 0.25]] {
        let l = Vec3::from(albedo.sample_compensation(u));
        assert!((l.length() - 1.0).abs() < 1e-6 && l.z >= 0.0, "{u:?}: {l}");
        assert!(albedo.compensation_pdf(l) >= 0.0);
    }
    assert_eq!(albedo.compensation_pdf(Vec3::NEG_Z), 0.0);
}

#[test]
fn the_compensation_returns_what_is_lost() {
    for_each_albedo(|sigma, gamma, masking, albedo| {
        for cos in COSINES {
            let v = view(cos);
            let got = by_sampling(&albedo, |l| albedo.compensation(v, l) * l.z);
            let want = f64::from(albedo.lost(v));
            let at = format!("sigma {sigma}, gamma {gamma}, {masking:?}, {cos}");
            assert!((got / want - 1.0).abs() < 2e-4, "{at}: {got} for {want}");
        }
    });
}

/// The message with which the albedo of (σ, γ) is refused.
fn refused(set: &Tables, sigma: f64, gamma: f64, masking: Masking) -> String {
    let average = set.average_moments(sigma, gamma, masking).unwrap_err().to_string();
    let message = set.albedo(sigma, gamma, masking).unwrap_err().to_string();
    assert_eq!(message, average);
    message
}

fn without(drop: impl Fn(&Table) -> bool) -> Tables {
    let set = Tables::embedded();
    let kept = set.tables().iter().filter(|table| !drop(table)).cloned().collect();
    Tables::from_tables(set.provenance().clone(), kept).unwrap()
}

#[test]
fn what_no_albedo_table_covers_is_refused_with_what_they_cover() {
    let set = Tables::embedded();
    for masking in Masking::ALL {
        // Between a mirror and the first node: the exact albedo of this view is 0.34, not 1.
        for sigma in [1e-9, 1e-300, -1.0, 3.1, f64::NAN, f64::INFINITY] {
            for gamma in [1.501, 2.0, f64::INFINITY] {
                let message = refused(&set, sigma, gamma, masking);
                assert!(message.contains("[1e-8, 3] and 0, a mirror"), "{sigma}: {message}");
            }
        }
        assert_eq!(set.albedo(0.0, 1.501, masking).unwrap().albedo(view(1e-7)), 1.0);
        assert!(set.albedo(1e-8, 1.501, masking).unwrap().albedo(view(1e-7)) < 0.5);
        // The smallest roughness of a lobe, as it is in single precision.
        assert!(set.albedo(1e-8_f32.into(), 1.501, masking).is_ok());
        assert!(set.albedo(3.0, 2.0, masking).is_ok());
        let message = refused(&set, 0.3, 1.5005, masking);
        assert!(message.contains("gamma [1.501, inf] with sigma 0 or [1e-8, 3]"), "{message}");
    }
    // Where a set has γ = 3, but no albedo of it, the message does not propose a recipe line
    // `gamma = 3`.
    let message =
        refused(&without(|table| table.kind.is_albedo()), 0.3, 3.0, Masking::Uncorrelated);
    assert!(message.contains("nor for any other"), "{message}");
    assert!(!message.contains("gamma = 3"), "{message}");
    let other = without(|table| table.subject.masking == Some(Masking::Uncorrelated));
    let message = refused(&other, 0.3, 3.0, Masking::Uncorrelated);
    assert!(message.contains("uncorrelated masking, only for height-correlated"), "{message}");
    assert!(!message.contains("gamma = 3"), "{message}");
    let glass = |set: &Tables| {
        let why = set.dielectric_albedo(0.3, 3.0, 1.5, Masking::Uncorrelated).unwrap_err();
        why.to_string()
    };
    let message = glass(&without(|table| table.kind.is_albedo()));
    assert!(message.contains("it holds none"), "{message}");
    let message = glass(&set);
    assert!(message.contains("index [1.3, 1.7]"), "{message}");
    assert!(message.ends_with("height-correlated masking"), "{message}");
}

#[test]
fn a_lobe_that_is_not_covered_is_told_what_the_set_serves() {
    let set = Tables::embedded();
    let message = set.student_t(0.3, 1.5001).unwrap_err().to_string();
    assert!(message.contains("the nearest that this set serves is 1.501;"), "{message}");
    // No recipe has tables of it.
    assert!(message.contains("take gamma = 1.501 or more"), "{message}");
    assert_eq!(set.shapes().len(), 1);
    // One kind of table missing for some shapes: only those of all kinds are served.
    let set = without(|table| table.kind == Kind::VisibleSlopePeeled);
    let message = set.student_t(0.3, 1.6).unwrap_err().to_string();
    assert!(message.ends_with("the nearest that this set serves is 1.8"), "{message}");
    assert!(set.tabulates(1.8) && !set.tabulates(1.799) && set.covers(2.0));
    let set = without(|table| table.kind == Kind::Shadowing);
    let message = set.student_t(0.3, 3.0).unwrap_err().to_string();
    assert!(message.ends_with("this set serves none") && set.shapes().is_empty(), "{message}");
}

/// A table whose description covers shapes beyond its axis is refused, since no lobe could be made
/// of them.
#[test]
fn what_a_table_covers_lies_on_its_axis() {
    for kind in [Kind::VisibleSlope, Kind::Albedo] {
        let mut table = Tables::embedded().table(kind).unwrap().clone();
        table.subject.lobe.gamma.min = 1.50002;
        let error = Tables::from_tables(Default::default(), vec![table]).unwrap_err().to_string();
        assert!(error.contains("it covers gamma = 1.50002"), "{error}");
    }
}
