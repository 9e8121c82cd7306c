//! Materials that are not understood, and other deviations, while the rest is read.

use microfacet_baker::scene::{Roughness, Scene};

use super::document;
use crate::{assert_not_understood, assert_warned, isotropic, load, named, names};

/// The good material after `materials` must be read whatever these contain.
pub(super) fn beside(materials: &str, rest: &str) -> Scene {
    let good = "{'name': 'good', 'pbrMetallicRoughness': {'roughnessFactor': 0.5}}";
    let scene = load("a.gltf", &document(&format!("{materials},\n{good}"), rest));
    assert_eq!(named(&scene, "good").lobe.roughness, isotropic(0.25));
    scene
}

#[test]
fn a_factor_out_of_range_costs_its_lobe_alone() {
    let case = |material: &str, left: &[&str], name: &str, parts: &[&str]| {
        let scene = beside(&format!("{{'name': 'm', {material}}}"), "");
        assert_not_understood(&scene, name, "a.gltf", parts);
        assert_eq!((names(&scene), scene.ignored.len()), ([left, &["good"]].concat(), 1));
        assert_eq!(scene.warnings, [""; 0]);
    };
    let rough = |value: &str| format!("'pbrMetallicRoughness': {{'roughnessFactor': {value}}}");
    case(&rough("1.5"), &[], "m", &["roughnessFactor is 1.5", "0 to 1"]);
    case(&rough("-0.5"), &[], "m", &["roughnessFactor is -0.5"]);
    let extension =
        |name: &str, value: &str| format!("'extensions': {{'KHR_materials_{name}': {{{value}}}}}");
    let gloss = extension("pbrSpecularGlossiness", "'glossinessFactor': 2");
    case(&gloss, &[], "m", &["pbrSpecularGlossiness", "glossinessFactor is 2"]);
    let brushed = extension("anisotropy", "'anisotropyStrength': -1");
    case(&brushed, &[], "m", &["anisotropyStrength is -1"]);
    for coat in ["'clearcoatFactor': 3", "'clearcoatFactor': 1, 'clearcoatRoughnessFactor': 3"] {
        let coat = extension("clearcoat", coat);
        case(&coat, &["m"], "m.clearcoat", &["KHR_materials_clearcoat", "Factor is 3"]);
    }
}

#[test]
fn a_bad_fresnel_value_leaves_the_lobe() {
    let case = |pbr: &str, extensions: &str, parts: &[&str]| {
        let material = format!(
            "{{'name': 'm', 'pbrMetallicRoughness': {{{pbr}}}, 'extensions': {{{extensions}}}}}"
        );
        let scene = beside(&material, "");
        assert_eq!((named(&scene, "m").fresnel, scene.ignored.len()), (None, 0));
        assert_eq!(named(&scene, "m").lobe.roughness, isotropic(1.0));
        assert_warned(&scene, "a.gltf", &[parts, &["'m'", "without its Fresnel term"]].concat());
    };
    let glass = "'metallicFactor': 0";
    case(glass, "'KHR_materials_ior': {'ior': 0.5}", &["ior is 0.5", "at least 1"]);
    case("'metallicFactor': 2", "", &["metallicFactor is 2", "0 to 1"]);
    case("'baseColorFactor': [0, -1, 0, 1]", "", &["baseColorFactor is -1"]);
    let specular = |value: &str| format!("'KHR_materials_specular': {{{value}}}");
    case(glass, &specular("'specularFactor': 1.5"), &["specularFactor is 1.5"]);
    case(glass, &specular("'specularColorFactor': [1, -2, 1]"), &["specularColorFactor has -2"]);
}

#[test]
fn meshes_with_materials_that_do_not_exist_are_warned_of() {
    let meshes = ", 'meshes': [{'primitives': [{'material': 3}, {'material': 1}]}]";
    let scene = beside("{}", meshes);
    assert_warned(&scene, "a.gltf", &["material 3", "2 materials"]);
    assert!(named(&scene, "good").used && !named(&scene, "material 0").used);
}

#[test]
fn indices_may_be_written_as_decimals() {
    let png = crate::png();
    let text = document(
        "{'pbrMetallicRoughness': {'metallicRoughnessTexture': {'index': 0.0}}}, {}",
        &format!(
            ", 'meshes': [{{'primitives': [{{'material': 1.0}}]}}],
            'textures': [{{'source': 0.0}}], 'images': [{{'bufferView': 0.0}}],
            'bufferViews': [{{'buffer': 0.0, 'byteOffset': 0.0, 'byteLength': {}.0}}],
            'buffers': [{{'uri': 'a.bin'}}]",
            png.len()
        ),
    );
    let folder = crate::Folder::new(&[("a.gltf", text.as_bytes()), ("a.bin", &png)]);
    let scene = folder.load("a.gltf").unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    let Roughness::Isotropic(range) = scene.materials[0].lobe.roughness else { unreachable!() };
    assert!((range.min - 0.16).abs() < 1e-12 && (range.max - 0.64).abs() < 1e-12, "{range:?}");
    let used: Vec<_> = scene.materials.iter().map(|material| material.used).collect();
    assert_eq!(used, [false, true]);
}

#[test]
fn a_member_that_gltf_has_not_is_warned_of() {
    let case = |material: &str, parts: &[&str]| {
        let scene = beside(&format!("{{'name': 'm', {material}}}"), "");
        assert_warned(&scene, "a.gltf", parts);
        assert_eq!(scene.doubts().count(), 1);
    };
    let owner = "pbrMetallicRoughness of material 'm' has no parameter `roughnessFactr`";
    let pbr = |members: &str| format!("'pbrMetallicRoughness': {{{members}}}");
    case(&pbr("'roughnessFactr': 0.3"), &[owner, "did you mean `roughnessFactor`?"]);
    case("'pbrMetalicRoughness': {}", &["material 'm' has no parameter", "`pbrMetallicRough"]);
    let extension = |name: &str, members: &str| format!("'extensions': {{'{name}': {members}}}");
    let coat = extension("KHR_materials_clearcoat", "{'clearcoatFacter': 1}");
    case(&coat, &["KHR_materials_clearcoat of", "`clearcoatFacter`", "`clearcoatFactor`?"]);
    let retro = extension("KHR_materials_retroreflection", "{'retroreflectionFactor': 0.5}");
    case(&retro, &["the extension KHR_materials_retroreflection of material 'm' is not read"]);
    let coats = extension("KHR_materials_clearcoats", "{}");
    case(&coats, &["KHR_materials_clearcoats", "did you mean `clearcoat`?"]);
    case(&extension("EXT_materials_x", "{}"), &["the extension EXT_materials_x"]);
}

#[test]
fn members_without_a_part_in_a_lobe_are_not_warned_of() {
    let texture = "{'index': 0, 'texCoord': 1, 'scale': 1, 'strength': 1, 'extensions': \
                   {'KHR_texture_transform': {'scale': [1, 1]}}}";
    let extensions = "'KHR_materials_anisotropy': {'anisotropyRotation': 1},
        'KHR_materials_clearcoat': {'clearcoatTexture': T, 'clearcoatNormalTexture': T},
        'KHR_materials_iridescence': {'iridescenceIor': 1.3, 'iridescenceTexture': T},
        'KHR_materials_specular': {'specularTexture': T, 'specularColorTexture': T},
        'KHR_materials_sheen': {'sheenColorFactor': [1, 1, 1]}, 'KHR_materials_volume': {},
        'KHR_materials_transmission': {'transmissionTexture': T}, 'KHR_materials_ior': {},
        'KHR_materials_dispersion': {'dispersion': 1}, 'KHR_xmp_json_ld': {'packet': 0},
        'KHR_materials_emissive_strength': {}, 'KHR_materials_diffuse_transmission': {},
        'ADOBE_materials_clearcoat_tint': {}, 'EXT_materials_absent': null";
    let material = format!(
        "'extras': {{'roughnessFactr': 1}}, 'normalTexture': T, 'occlusionTexture': T,
         'emissiveTexture': T, 'emissiveFactor': [1, 1, 1], 'alphaMode': 'MASK',
         'alphaCutoff': 0.5, 'doubleSided': true, 'pbrMetallicRoughness': {{
         'baseColorTexture': T, 'extras': 5, 'extensions': {{}}}}, 'extensions': {{{extensions}}}"
    );
    let scene = beside(
        &format!("{{'name': 'm', {}}}", material.replace(": T", &format!(": {texture}"))),
        "",
    );
    assert_eq!(scene.warnings, [""; 0]);
}
