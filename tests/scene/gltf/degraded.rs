//! What is not understood in a scene, and liberties of its writers, while the rest is read.

use microfacet_bake::scene::{Roughness, Scene};

use super::document;
use crate::{assert_not_understood, assert_warned, isotropic, load, named, names};

/// A good material after others, which must be read whatever they say.
pub(super) fn beside(materials: &str, rest: &str) -> Scene {
    let good = "{\"name\": \"good\", \"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5}}";
    let scene = load("a.gltf", &document(&format!("{materials},\n{good}"), rest));
    assert_eq!(named(&scene, "good").roughness, isotropic(0.25));
    scene
}

#[test]
fn a_factor_out_of_range_costs_its_lobe_alone() {
    let case = |material: &str, left: &[&str], name: &str, parts: &[&str]| {
        let scene = beside(&format!("{{\"name\": \"m\", {material}}}"), "");
        assert_not_understood(&scene, name, "a.gltf", parts);
        assert_eq!((names(&scene), scene.ignored.len()), ([left, &["good"]].concat(), 1));
        assert_eq!(scene.warnings, [""; 0]);
    };
    let rough = |value: &str| format!("\"pbrMetallicRoughness\": {{\"roughnessFactor\": {value}}}");
    case(&rough("1.5"), &[], "m", &["roughnessFactor is 1.5", "0 to 1"]);
    case(&rough("-0.5"), &[], "m", &["roughnessFactor is -0.5"]);
    let extension = |name: &str, value: &str| {
        format!("\"extensions\": {{\"KHR_materials_{name}\": {{{value}}}}}")
    };
    let gloss = extension("pbrSpecularGlossiness", "\"glossinessFactor\": 2");
    case(&gloss, &[], "m", &["pbrSpecularGlossiness", "glossinessFactor is 2"]);
    let brushed = extension("anisotropy", "\"anisotropyStrength\": -1");
    case(&brushed, &[], "m", &["anisotropyStrength is -1"]);
    for coat in
        ["\"clearcoatFactor\": 3", "\"clearcoatFactor\": 1, \"clearcoatRoughnessFactor\": 3"]
    {
        let coat = extension("clearcoat", coat);
        case(&coat, &["m"], "m.clearcoat", &["KHR_materials_clearcoat", "Factor is 3"]);
    }
}

#[test]
fn a_bad_fresnel_value_leaves_the_lobe() {
    let case = |pbr: &str, extensions: &str, parts: &[&str]| {
        let material = format!(
            "{{\"name\": \"m\", \"pbrMetallicRoughness\": {{{pbr}}}, \"extensions\": {{{extensions}}}}}"
        );
        let scene = beside(&material, "");
        assert_eq!((named(&scene, "m").fresnel, scene.ignored.len()), (None, 0));
        assert_eq!(named(&scene, "m").roughness, isotropic(1.0));
        assert_warned(&scene, "a.gltf", &[parts, &["\"m\"", "without its Fresnel term"]].concat());
    };
    let glass = "\"metallicFactor\": 0";
    case(glass, "\"KHR_materials_ior\": {\"ior\": 0.5}", &["ior is 0.5", "at least 1"]);
    case("\"metallicFactor\": 2", "", &["metallicFactor is 2", "0 to 1"]);
    case("\"baseColorFactor\": [0, -1, 0, 1]", "", &["baseColorFactor is -1"]);
    let specular = |value: &str| format!("\"KHR_materials_specular\": {{{value}}}");
    case(glass, &specular("\"specularFactor\": 1.5"), &["specularFactor is 1.5"]);
    case(glass, &specular("\"specularColorFactor\": [1, -2, 1]"), &["specularColorFactor has -2"]);
}

#[test]
fn meshes_with_materials_that_do_not_exist_are_warned_of() {
    let meshes = ", \"meshes\": [{\"primitives\": [{\"material\": 3}, {\"material\": 1}]}]";
    let scene = beside("{}", meshes);
    assert_warned(&scene, "a.gltf", &["material 3", "2 materials"]);
    assert!(named(&scene, "good").used && !named(&scene, "material 0").used);
}

#[test]
fn indices_may_be_written_as_decimals() {
    let png = crate::png();
    let text = document(
        "{\"pbrMetallicRoughness\": {\"metallicRoughnessTexture\": {\"index\": 0.0}}}, {}",
        &format!(
            ", \"meshes\": [{{\"primitives\": [{{\"material\": 1.0}}]}}],
            \"textures\": [{{\"source\": 0.0}}], \"images\": [{{\"bufferView\": 0.0}}],
            \"bufferViews\": [{{\"buffer\": 0.0, \"byteOffset\": 0.0, \"byteLength\": {}.0}}],
            \"buffers\": [{{\"uri\": \"a.bin\"}}]",
            png.len()
        ),
    );
    let folder = crate::Folder::new(&[("a.gltf", text.as_bytes()), ("a.bin", &png)]);
    let scene = folder.load("a.gltf").unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    let Roughness::Isotropic(range) = scene.materials[0].roughness else { unreachable!() };
    assert!((range.min - 0.16).abs() < 1e-12 && (range.max - 0.64).abs() < 1e-12, "{range:?}");
    let used: Vec<_> = scene.materials.iter().map(|material| material.used).collect();
    assert_eq!(used, [false, true]);
}
