//! Haze and retroreflection, against the graph of OpenPBR 1.2 and numbers worked out by hand.

use microfacet_baker::plan::{AlbedoVerdict, AlbedoWish, Options, Plan, Verdict};
use microfacet_baker::scene::{Material, Roughness, Scene};
use microfacet_tables::Interval;

use super::{document, node, shader};
use crate::{Folder, assert_close, png};

/// The haze of the shader "a": its weight and its roughness.
fn haze(inputs: &[(&str, f64)]) -> Option<(Interval, Roughness)> {
    of(&shader("open_pbr_surface", inputs).materials[0])
}

fn of(material: &Material) -> Option<(Interval, Roughness)> {
    material.haze.as_ref().map(|haze| {
        assert_eq!(haze.lobe.gamma, Interval::point(2.0));
        (haze.weight, haze.lobe.roughness)
    })
}

#[test]
fn a_haze_is_spread_then_stretched() {
    let (weight, roughness) = haze(&[("specular_haze", 0.25)]).unwrap();
    assert_eq!(weight, Interval::point(0.25));
    // 0.3 + 0.7 * 0.3
    assert_close(roughness, [0.51f64.powi(2); 2], [0.51f64.powi(2); 2]);

    let inputs = [
        ("specular_roughness", 0.5),
        ("specular_roughness_anisotropy", 0.5),
        ("specular_haze", 0.25),
        ("specular_haze_spread", 0.2),
    ];
    // sqrt(2 / (1 + 0.25)), of 0.5 + 0.5 * 0.2 = 0.6.
    let along = 0.36 * 1.6f64.sqrt();
    assert_close(haze(&inputs).unwrap().1, [along; 2], [0.5 * along; 2]);
}

#[test]
fn a_coat_roughens_after_the_spread() {
    let inputs = [
        ("specular_roughness", 0.5),
        ("specular_haze", 0.5),
        ("specular_haze_spread", 0.2),
        ("coat_weight", 0.5),
        ("coat_roughness", 0.4),
    ];
    // (0.6^4 + 2 * 0.4^4)^(1/4), mixed half and half with 0.6.
    let r = 0.5 * 0.6 + 0.5 * (0.1296f64 + 2.0 * 0.0256).powf(0.25);
    assert_close(haze(&inputs).unwrap().1, [r * r; 2], [r * r; 2]);
    // The other order would give another roughness.
    let core = 0.5 * 0.5 + 0.5 * (0.0625f64 + 2.0 * 0.0256).powf(0.25);
    assert!((core + (1.0 - core) * 0.2 - r).abs() > 0.005);

    let scene = shader("open_pbr_surface", &inputs);
    assert_eq!(of(&scene.materials[1]), None, "{:?}", scene.materials[1]);
}

#[test]
fn textures_drive_weight_spread_and_retroreflectivity() {
    let image = node("image", "i", "float", &[("file", "a.png")]);
    let from = "type='float' nodename='i'";
    let inputs = [
        ("specular_roughness", "0.5"),
        ("specular_haze", from),
        ("specular_haze_spread", from),
        ("specular_retroreflectivity", from),
    ];
    let text = document(&(image + &node("open_pbr_surface", "a", "surfaceshader", &inputs)));
    let folder = Folder::new(&[("a.png", png()), ("a.mtlx", text.into_bytes())]);
    let scene = folder.load("a.mtlx").unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    // Red of the image is from 0.2 to 0.4: roughnesses of 0.6 and 0.7.
    let (weight, roughness) = of(&scene.materials[0]).unwrap();
    assert_close(Roughness::Isotropic(weight), [0.2, 0.4], [0.2, 0.4]);
    assert_close(roughness, [0.36, 0.49], [0.36, 0.49]);
    let share = scene.materials[0].retroreflection;
    assert_close(Roughness::Isotropic(share), [0.2, 0.4], [0.2, 0.4]);
}

#[test]
fn both_lobes_are_planned_and_stand_in_a_recipe() {
    let inputs = [
        ("base_metalness", 1.0),
        ("specular_haze", 0.25),
        ("specular_retroreflectivity", 0.5),
        ("coat_weight", 1.0),
        ("coat_roughness", 0.4),
    ];
    let scene = shader("open_pbr_surface", &inputs);
    let plan = |options| Plan::new(&scene, options).unwrap();

    // Core, haze and coat are GGX.
    assert_eq!(plan(Options::default()).verdicts, [const { Verdict::ClosedForm }; 3]);
    let tabulated = plan(Options { tabulate_ggx: true, ..Options::default() });
    let same = Verdict::Same { need: 0, as_material: 0 };
    assert_eq!(tabulated.verdicts, [Verdict::Bake(0), same.clone(), same]);
    let albedos = plan(Options { albedo: AlbedoWish::All, ..Options::default() });
    let baked = |verdict: &AlbedoVerdict| matches!(verdict, AlbedoVerdict::Bake(_));
    assert_eq!(albedos.albedo_verdicts.len(), 3);
    assert!(albedos.albedo_verdicts.iter().all(baked), "{:?}", albedos.albedo_verdicts);
    let [base, coat] = &albedos.materials[..] else { panic!("{:?}", albedos.materials) };
    assert_eq!(*base, scene.materials[0].entry());
    assert!(base.haze.is_some() && coat.haze.is_none());

    let again = Scene::from_recipe_str(&scene.to_recipe()).unwrap();
    assert_eq!(again.materials.len(), 2);
    for (a, b) in again.materials.iter().zip(&scene.materials) {
        assert!(a.asks_the_same(b), "{a:?} is not {b:?}");
    }
}
