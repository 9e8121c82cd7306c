//! An average albedo is the integral of the albedos that lookups return; otherwise the white
//! furnace would gain or lose light.

use glam::Vec3;
use microfacet_baker::bake::albedo::{AlbedoLobe, bake};
use microfacet_baker::plan::RequiredAlbedo;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::albedo::ViewCurve;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Precision, Reflectance, Roughness, Side};
use rand::{RngExt, SeedableRng};

use crate::sets::set_of;

/// 2∫ μ dμ of functions of the view, by the midpoint rule in ln h, h the tangent of half the
/// elevation.
fn over_views<const N: usize>(f: impl Fn(Vec3) -> [f32; N]) -> [f64; N] {
    const STEPS: usize = 12_000;
    let step = 31.0 / STEPS as f64;
    let mut sum = [0.0; N];
    for i in 0..STEPS {
        let h = (-(i as f64 + 0.5) * step).exp();
        let (sin, cos) = ((1.0 - h * h) / (1.0 + h * h), 2.0 * h / (1.0 + h * h));
        for (sum, x) in sum.iter_mut().zip(f(Vec3::new(sin as f32, 0.0, cos as f32))) {
            *sum += 2.0 * step * cos * cos * sin * f64::from(x);
        }
    }
    sum
}

/// The largest relative error of 1 − E_avg over materials, random ones and corners.
fn worst(set: &Tables, gammas: [f64; 2], sigmas: [f64; 2]) -> f64 {
    let mut random = rand::rngs::StdRng::seed_from_u64(1);
    // Log-uniform in γ − 3/2 and in σ.
    let between = |[low, high]: [f64; 2], share: f64| low * (high / low).powf(share);
    let offsets = gammas.map(|gamma| gamma - 1.5);
    let mut materials = Vec::new();
    for share in [0.0, 0.06, 0.2, 0.5, 0.7, 1.0] {
        let sigma = between(sigmas, share);
        materials.extend(gammas.map(|gamma| [sigma, gamma]));
        materials.extend([1.5016, 2.0, f64::INFINITY].map(|gamma| [sigma, gamma]));
    }
    materials.extend([[0.0, gammas[0]], [6.519e-8, 1.5016], [3.17e-3, f64::INFINITY]]);
    let mut anywhere =
        |_| [between(sigmas, random.random()), 1.5 + between(offsets, random.random())];
    materials.extend((0..100).map(&mut anywhere));
    let (mut worst, mut count) = ((0.0, [0.0; 2], Masking::Uncorrelated), 0);
    for ([sigma, gamma], masking) in
        materials.iter().flat_map(|&material| Masking::ALL.map(|masking| (material, masking)))
    {
        let Ok(albedo) = set.albedo(sigma, gamma, masking) else { continue };
        let [lost, bias, f82] = over_views(|v| {
            let (lost, moments) = (albedo.lost(v), albedo.moments(v));
            assert!(lost.is_sign_positive(), "{sigma} {gamma} {v}");
            [lost, moments.bias, moments.f82]
        });
        let (got, average) = (f64::from(albedo.lost_average()), albedo.average_moments());
        let at = format!("sigma {sigma}, gamma {gamma}, {masking}");
        for (got, want) in [(average.bias, bias), (average.f82, f82)] {
            assert!((f64::from(got) - want).abs() < 1e-6, "{at}: {got} for {want}");
        }
        let error = if lost > 0.0 { (got / lost - 1.0).abs() } else { got };
        if error > worst.0 {
            worst = (error, [sigma, gamma], masking);
        }
        count += 1;
    }
    let (error, [sigma, gamma], masking) = worst;
    println!("{error:.1e} of {count} materials at sigma {sigma:.2e}, gamma {gamma}, {masking}");
    assert!(count > 200, "{count}");
    error
}

/// `cargo test --test lobes closure:: -- --nocapture` prints the figures of `docs/albedo.md`.
#[test]
fn the_default_set_closes() {
    assert!(worst(&Tables::embedded(), [1.501, 100.0], [1e-8, 3.0]) < 5e-5);
}

#[test]
fn a_draft_set_closes() {
    // Heavy tails of smooth surfaces, where draft tables are the coarsest.
    let (gammas, sigmas) = ([1.501, 1.52], [1e-8, 1e-6]);
    let lobe = AlbedoLobe::family(Roughness::Isotropic(sigmas.into()), gammas.into());
    let need = RequiredAlbedo { lobe, ..RequiredAlbedo::general() };
    let tables = bake(&need.spec(Quality::Draft, Precision::F32).unwrap()).unwrap();
    let set = set_of(tables, None);
    assert!(worst(&set, gammas, sigmas) < 5e-4);
}

/// From the dense side there is a kink at the critical angle.
#[test]
fn a_smooth_dielectric_closes() {
    let lobe = AlbedoLobe::student_t([0.01; 2], 2.0);
    for side in [Side::Thin, Side::Dense] {
        let reflectance = Reflectance::Interface { side, index: [1.5; 2].into() };
        let maskings = vec![Masking::HeightCorrelated];
        let need = RequiredAlbedo { lobe: lobe.clone(), reflectance, maskings, coarse: false };
        let table = bake(&need.spec(Quality::Draft, Precision::F32).unwrap()).unwrap().remove(0);
        let curve = ViewCurve::<2>::from_table(&table, 0.01, 2.0, 1.5).unwrap();
        let want = over_views(|v| curve.eval(v));
        for (got, want) in curve.average().into_iter().zip(want) {
            assert!((f64::from(got) - want).abs() < 2e-6, "{side:?}: {got} for {want}");
        }
    }
}
