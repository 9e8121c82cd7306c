//! Values of the model against references, brute force, limits and identities.

mod anisotropic_panes;
mod radial;
mod reference;
mod reflection;
mod skewed;
mod transmission;

use core::f64::consts::PI;
use core::fmt::Display;

use glam::DVec3;
use microfacet_model::fresnel::schlick_weight;
use microfacet_model::{Albedo, Masking, MicrofacetDistribution};

/// The rows of a data file as text, header dropped.
///
/// `tests/data` holds excerpts. Set `MICROFACET_REFERENCE` to a folder with the complete files of
/// the same names to test against those.
fn rows(name: &str) -> Vec<Vec<String>> {
    let folder = std::env::var("MICROFACET_REFERENCE")
        .unwrap_or_else(|_| format!("{}/tests/data", env!("CARGO_MANIFEST_DIR")));
    let text = std::fs::read_to_string(format!("{folder}/{name}")).expect("reference file");
    let rows: Vec<_> =
        text.lines().skip(1).map(|row| row.split(',').map(String::from).collect()).collect();
    assert!(rows.len() >= 25, "{name} has too few rows to mean anything");
    rows
}

fn schlick(cos: f64) -> [f64; 2] {
    [1.0 - schlick_weight(cos), schlick_weight(cos)]
}

fn direction(cos: f64, phi: f64) -> DVec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

/// E for both forms of masking by brute force: f cos θ_l with F = 1 over the hemisphere of l, in
/// solid angle, by the midpoint rule.
fn brute_force(lobe: &impl MicrofacetDistribution, v: DVec3, steps: usize) -> [f64; 2] {
    let at = |i: usize| (i as f64 + 0.5) / steps as f64;
    let mut sum = [0.0; 2];
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let (sin, cos) = libm::sincos(0.5 * PI * at(i));
        let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * at(j));
        let l = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
        let part = sin * lobe.d((v + l).normalize()) / (4.0 * v.z);
        sum = [0, 1].map(|form| sum[form] + part * lobe.g2(v, l, Masking::ALL[form]));
    }
    sum.map(|x| x * PI * PI / (steps * steps) as f64)
}

/// The largest difference of two albedos; a NaN stays one.
fn apart<const N: usize>(a: &Albedo<N>, b: &Albedo<N>) -> f64 {
    let pairs = Masking::ALL.into_iter().flat_map(|form| a.of(form).into_iter().zip(b.of(form)));
    let worst = |worst: f64, x: f64| if worst.is_nan() || x <= worst { worst } else { x };
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worst)
}

#[track_caller]
fn assert_near(got: f64, want: f64, tolerance: f64, at: impl Display) {
    let error = (got - want).abs();
    assert!(error < tolerance, "{at}: {got} against {want}, off by {error:e} of {tolerance:e}");
}

/// Asserts that E = scale + bias lies in [0, 1 + `slack`].
#[track_caller]
fn assert_share(albedo: &Albedo<2>, slack: f64, at: impl Display) {
    for form in Masking::ALL {
        let [scale, bias] = albedo.of(form);
        assert!((0.0..=1.0 + slack).contains(&(scale + bias)), "{at}: E = {}", scale + bias);
    }
}
