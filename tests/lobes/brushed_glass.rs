//! Compensated anisotropic glass by the albedos of its own lobe.

use std::sync::OnceLock;

use glam::Vec3;
use microfacet_sampler::{
    BindError, Bsdf, BsdfSettings, Compensation, Dielectric, Plastic, StandIn, Tables, Transport,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::sets::{draft, recipe};

const SIGMA: [f32; 2] = [0.15, 0.6];
const GAMMA: f64 = 3.0;
const GLASS: f64 = 1.5;

/// The brushed glass, and the round one that may stand in for it.
fn set() -> &'static Tables {
    static SET: OnceLock<Tables> = OnceLock::new();
    SET.get_or_init(|| {
        let glass = "fresnel = { dielectric = 1.5 }";
        let named = ["brushed", "[0.15, 0.6]", "3.0", glass];
        draft(&recipe(&[named, ["round", "0.3", "3.0", glass]]))
    })
}

/// Mean weight of samples of a view, and its standard error.
fn furnace(bsdf: &impl Bsdf, v: Vec3) -> [f64; 2] {
    const SAMPLES: u32 = 60_000;
    let mut random = StdRng::seed_from_u64(7);
    let [sum, squares] = (0..SAMPLES).fold([0.0; 2], |[sum, squares], _| {
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        let sample = bsdf.sample(v, choice, u, Transport::Importance);
        let weight = sample.map_or(0.0, |sample| f64::from(sample.weight[0]));
        [sum + weight, squares + weight * weight]
    });
    let [mean, square] = [sum, squares].map(|sum| sum / f64::from(SAMPLES));
    [mean, ((square - mean * mean).max(0.0) / f64::from(SAMPLES)).sqrt()]
}

fn views() -> impl Iterator<Item = Vec3> {
    let cosines = [0.1_f32, 0.5, 0.72, 0.76, 0.95];
    cosines.into_iter().flat_map(|cos| {
        let r = ((1.0 - cos) * (1.0 + cos)).sqrt();
        [0.0_f32, 0.9, std::f32::consts::FRAC_PI_2].into_iter().flat_map(move |phi| {
            [1.0, -1.0].map(|side| Vec3::new(r * phi.cos(), r * phi.sin(), side * cos))
        })
    })
}

/// How far from 1 a furnace is, beyond three standard errors, at the worst of all views.
fn off(bsdf: &impl Bsdf, views: impl Iterator<Item = Vec3>) -> f64 {
    let one = |v: Vec3| {
        let [mean, error] = furnace(bsdf, v);
        println!("{v}: {mean:.5} +- {error:.5}");
        assert!(error < 3e-3, "{v}: {error}");
        (mean - 1.0).abs() - 3.0 * error
    };
    views.map(one).fold(0.0, f64::max)
}

#[test]
fn white_furnaces_close_with_own_albedos_and_not_with_those_of_a_round_lobe() {
    let set = set();
    let lobe = || Tables::embedded().student_t(SIGMA, GAMMA).unwrap();
    for compensation in [Compensation::Turquin, Compensation::KullaConty] {
        let settings = BsdfSettings::new().compensated(compensation, set);
        let glass = Dielectric::new(lobe(), GLASS, settings).unwrap();
        // The error of draft tables.
        assert!(off(&glass, views()) < 3e-3, "{compensation:?}");
        let cavity = Dielectric::new(lobe(), 1.0 / GLASS, settings).unwrap();
        assert!(off(&cavity, views().take(6)) < 3e-3, "{compensation:?}");
        let coat = Plastic::<_, 3>::new(lobe(), GLASS, [1.0; 3], settings).unwrap();
        assert!(off(&coat, views().filter(|v| v.z > 0.0)) < 3e-3, "{compensation:?}");
    }
    let round = set.dielectric_albedo(0.3, GAMMA, GLASS, Default::default()).unwrap();
    let stood_in = Dielectric::<_, 3>::new(lobe(), GLASS, BsdfSettings::new()).unwrap();
    let stood_in = stood_in.compensated_by(round, Compensation::KullaConty);
    assert!(off(&stood_in, views()) > 0.03);
}

#[test]
fn a_brushed_glass_binds_by_name_and_by_parameters() {
    let set = set();
    let v = Vec3::new(0.48, 0.64, 0.6);
    let named = set.bsdf("brushed", Compensation::KullaConty, StandIn::Refused).unwrap();
    let lobe = || Tables::embedded().student_t(SIGMA, GAMMA).unwrap();
    let settings = BsdfSettings::new().compensated(Compensation::KullaConty, set);
    let made = Dielectric::<_, 3>::new(lobe(), GLASS, settings).unwrap();
    for l in [Vec3::new(-0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, -0.8)] {
        let [a, b] = [named.eval(v, l, Transport::Radiance), made.eval(v, l, Transport::Radiance)];
        assert!((a[0] / b[0] - 1.0).abs() < 1e-4, "{l}: {a:?} {b:?}");
        // Reciprocal but for η², further bounces included.
        let back = made.eval(l, v, Transport::Importance);
        assert!((back[0] / made.eval(v, l, Transport::Radiance)[0] - 1.0).abs() < 1e-3, "{l}");
    }
    // At another index there are no such tables, but lines of a recipe that make them.
    let why = Dielectric::new(lobe(), 1.7, settings).unwrap_err();
    assert!(matches!(why, BindError::NoAlbedo { stand_in: true, .. }), "{why}");
    let lines = why.recipe().unwrap();
    assert!(lines.contains("sigma = [0.15, 0.6]") && lines.contains("dielectric = 1.7"), "{lines}");
}
