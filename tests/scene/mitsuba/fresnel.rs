//! Fresnel terms, against the plugins that define them.

use microfacet_baker::scene::{Reflectance, Scene};
use microfacet_sampler::Metal;

use super::bsdf;
use crate::{load, names};

fn one(class: &str, properties: &str) -> Scene {
    let scene = load("a.xml", &bsdf(class, properties));
    assert_eq!(scene.warnings, [""; 0]);
    scene
}

fn fresnel(class: &str, properties: &str) -> Option<Reflectance> {
    one(class, properties).materials[0].fresnel
}

const ETA: &str = "<rgb name='eta' value='0.2 0.9 1.1'/>";
const K: &str = "<rgb name='k' value='3.9 2.4 2.2'/>";

#[test]
fn a_conductor_is_a_mirror_by_default() {
    let none = "<string name='material' value='none'/>";
    for class in ["conductor", "roughconductor"] {
        for material in ["", none] {
            let of = |properties: &str| fresnel(class, &format!("{material}{properties}"));
            assert_eq!(of(""), Some(Reflectance::Mirror));
            // The index is 0 by default, and the extinction 1.
            assert_eq!(of(K), Some(Reflectance::Mirror));
            let zero = "<float name='eta' value='0'/>";
            assert_eq!(of(zero), Some(Reflectance::Mirror));
            assert_eq!(of(&[zero, K].concat()), Some(Reflectance::Mirror));
            let eta = [0.2, 0.9, 1.1];
            assert_eq!(of(ETA), Some(Reflectance::Conductor { eta, k: [1.0; 3] }));
            let k = [3.9, 2.4, 2.2];
            assert_eq!(of(&[ETA, K].concat()), Some(Reflectance::Conductor { eta, k }));
        }
    }
}

#[test]
fn an_index_is_the_same_at_all_wavelengths_or_a_triple() {
    let of = |eta: &str| fresnel("roughconductor", &format!("{eta}{K}"));
    let grey = Some(Reflectance::Conductor { eta: [0.7; 3], k: [3.9, 2.4, 2.2] });
    for tag in ["rgb", "float", "spectrum"] {
        assert_eq!(of(&format!("<{tag} name='eta' value='0.7'/>")), grey, "{tag}");
    }
    for spectrum in ["filename='eta.spd'", "value='400:0.2, 700:0.3'"] {
        assert_eq!(of(&format!("<spectrum name='eta' {spectrum}/>")), None);
    }
}

#[test]
fn a_conductor_of_version_0_6_is_copper_by_default() {
    let older = |properties: &str| {
        let text = bsdf("roughconductor", properties).replace("3.0.0", "0.6.0");
        load("a.xml", &text).materials[0].fresnel
    };
    assert_eq!(older(""), Some(Metal::Copper.into()));
    assert_eq!(older(ETA), None, "with the extinction of copper");
    let none = "<string name='material' value='none'/>";
    assert_eq!(older(none), Some(Reflectance::Mirror));
}

#[test]
fn presets_are_metals_where_their_index_is_known() {
    let material =
        |name: &str| fresnel("conductor", &format!("<string name='material' value='{name}'/>"));
    assert_eq!(material("Ag"), Some(Metal::Silver.into()));
    assert_eq!(material("Ni_palik"), Some(Metal::Nickel.into()));
    for other in ["Ir", "TiO2_palik", "a-C", "Te-e"] {
        assert_eq!(material(other), None, "{other}");
    }
}

#[test]
fn polarized_plastic_takes_an_index_of_its_own() {
    let eta = fresnel("pplastic", "<float name='eta' value='1.9'/>");
    assert_eq!(eta, Some(Reflectance::dielectric(1.9)));
    // No other plastic has `eta`.
    let other = load("a.xml", &bsdf("roughplastic", "<float name='eta' value='1.9'/>"));
    assert_eq!(other.materials[0].fresnel, Some(Reflectance::dielectric(1.49 / 1.000_277)));
    assert!(other.warnings[0].contains("roughplastic has no parameter `eta`"), "{other:?}");
}

#[test]
fn a_tint_changes_what_a_thin_surface_reflects() {
    let thin = |tint: &str| {
        let properties = format!("<float name='spec_trans' value='0.6'/>{tint}");
        let scene = one("principledthin", &properties);
        assert_eq!(names(&scene), ["a", "a.transmission"]);
        [scene.materials[0].fresnel, scene.materials[1].fresnel]
    };
    let dielectric = Some(Reflectance::dielectric(1.5));
    assert_eq!(thin(""), [dielectric; 2]);
    assert_eq!(thin("<float name='spec_tint' value='0'/>"), [dielectric; 2]);
    assert_eq!(thin("<float name='spec_tint' value='1'/>"), [None, dielectric]);
}
