//! F0 of metals, of dielectrics, and of what lies between them.

use microfacet_baker::scene::Reflectance;

use super::document;
use crate::load;

/// The Fresnel term of a material with these factors and extensions.
fn fresnel(pbr: &str, extensions: &str) -> Option<Reflectance> {
    let material = format!("{{'pbrMetallicRoughness': {{{pbr}}}, 'extensions': {{{extensions}}}}}");
    let scene = load("a.gltf", &document(&material, ""));
    assert_eq!(scene.warnings, [""; 0]);
    scene.materials[0].fresnel
}

/// Checks F0 against numbers worked out by hand.
#[track_caller]
fn assert_f0(pbr: &str, extensions: &str, wanted: [f64; 3]) {
    let Some(Reflectance::Schlick(f0)) = fresnel(pbr, extensions) else {
        panic!("{:?}", fresnel(pbr, extensions))
    };
    assert!(f0.iter().zip(wanted).all(|(f0, wanted)| (f0 - wanted).abs() < 1e-15), "{f0:?}");
}

const COPPER: &str = "'baseColorFactor': [0.9, 0.6, 0.5, 1]";
const GLASS: &str = "'metallicFactor': 0";
const TEXTURE: &str = "{'index': 0}";

#[test]
fn a_metal_has_its_base_colour() {
    // Both factors are 1 by default.
    assert_f0("", "", [1.0; 3]);
    assert_f0(COPPER, "", [0.9, 0.6, 0.5]);
    // The index of refraction is the dielectric's.
    assert_f0(COPPER, "'KHR_materials_ior': {'ior': 2}", [0.9, 0.6, 0.5]);
    assert_f0(COPPER, "'KHR_materials_specular': {'specularFactor': 0}", [0.9, 0.6, 0.5]);
}

#[test]
fn a_dielectric_has_that_of_its_index() {
    assert_f0(&format!("{GLASS}, {COPPER}"), "", [0.04; 3]);
    assert_f0(GLASS, "'KHR_materials_ior': {'ior': 2}", [1.0 / 9.0; 3]);
    assert_f0(GLASS, "'KHR_materials_ior': {'ior': 0}", [1.0; 3]);
    // Colours and textures of metals have no influence.
    assert_f0(&format!("{GLASS}, 'baseColorFactor': [1.2, 1, 1, 1]"), "", [0.04; 3]);
    let textures =
        format!("{GLASS}, 'baseColorTexture': {TEXTURE}, 'metallicRoughnessTexture': {TEXTURE}");
    let scene =
        load("a.gltf", &document(&format!("{{'pbrMetallicRoughness': {{{textures}}}}}"), ""));
    let Some(Reflectance::Schlick([f0, ..])) = scene.materials[0].fresnel else { unreachable!() };
    assert!((f0 - 0.04).abs() < 1e-15, "{f0}");
}

#[test]
fn between_both_it_is_mixed_for_each_channel() {
    // 0.04 * 0.75 + [0.9, 0.6, 0.5] * 0.25
    let half = format!("{COPPER}, 'metallicFactor': 0.25");
    assert_f0(&half, "", [0.255, 0.18, 0.155]);
}

#[test]
fn textures_that_vary_it_leave_it_open() {
    let with = |texture: &str| format!("{COPPER}, '{texture}': {TEXTURE}");
    let open = |pbr: &str| {
        let material = format!("{{'pbrMetallicRoughness': {{{pbr}}}}}");
        load("a.gltf", &document(&material, "")).materials[0].fresnel
    };
    assert_eq!(open(&with("baseColorTexture")), None);
    assert_eq!(open(&with("metallicRoughnessTexture")), None);
}

#[test]
fn the_specular_extension_tints_a_dielectric() {
    let specular = |value: &str| format!("'KHR_materials_specular': {{{value}}}");
    let colour = "'specularColorFactor': [0.5, 1, 100]";
    assert_f0(GLASS, &specular(""), [0.04; 3]);
    assert_f0(GLASS, &specular(colour), [0.02, 0.04, 1.0]);
    // `specularFactor` is F90, here other than Schlick's 1.
    assert_eq!(fresnel(GLASS, &specular("'specularFactor': 0.5")), None);
    for texture in ["specularTexture", "specularColorTexture"] {
        assert_eq!(fresnel(GLASS, &specular(&format!("'{texture}': {TEXTURE}"))), None);
    }
}

#[test]
fn a_film_leaves_it_open_where_there_is_one() {
    let film = |value: &str| format!("'KHR_materials_iridescence': {{{value}}}");
    assert_eq!(fresnel(GLASS, &film("'iridescenceFactor': 0.5")), None);
    // The texture is multiplied with the factor, which is 0 by default.
    for none in ["", "'iridescenceFactor': 0, 'iridescenceTexture': {'index': 0}"] {
        assert_f0(GLASS, &film(none), [0.04; 3]);
    }
}

#[test]
fn a_dielectric_that_reflects_nothing_has_no_lobe() {
    let scene = |pbr: &str, extensions: &str| {
        let specular = "'KHR_materials_specular': {'specularFactor': 0}";
        let material = format!(
            "{{'name': 'm', 'pbrMetallicRoughness': {{{pbr}}}, 'extensions': {{{specular}{extensions}}}}}"
        );
        load("a.gltf", &document(&material, ""))
    };
    let none = scene(GLASS, "");
    assert_eq!(none.materials, []);
    let [ignored] = &none.ignored[..] else { panic!("{:?}", none.ignored) };
    assert!(ignored.understood && ignored.reason.contains("specularFactor is 0"), "{ignored}");
    // A dielectric that transmits has facets, and metal reflects.
    let through = scene(GLASS, ", 'KHR_materials_transmission': {'transmissionFactor': 1}");
    assert_eq!((through.materials.len(), through.materials[0].fresnel), (1, None));
    assert_eq!(scene("'metallicFactor': 0.5", "").materials.len(), 1);
}

#[test]
fn specular_and_glossiness_state_it() {
    let gloss = |value: &str| format!("'KHR_materials_pbrSpecularGlossiness': {{{value}}}");
    assert_f0("", &gloss(""), [1.0; 3]);
    assert_f0(COPPER, &gloss("'specularFactor': [0.1, 0.2, 0.3]"), [0.1, 0.2, 0.3]);
    let material = format!(
        "{{'extensions': {{{}}}}}",
        gloss(&format!("'specularGlossinessTexture': {TEXTURE}"))
    );
    assert_eq!(load("a.gltf", &document(&material, "")).materials[0].fresnel, None);
}
