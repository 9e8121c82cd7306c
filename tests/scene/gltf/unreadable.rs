//! Values of a wrong kind, each of which affects only what contains it.

use super::degraded::beside;
use super::{TEXTURED, document};
use crate::{
    Folder, assert_close, assert_not_understood, assert_warned, isotropic, load, named, names,
};

#[test]
fn a_value_that_cannot_be_read_costs_its_lobe_alone() {
    let pbr = |member: &str| format!("{{'name': 'm', 'pbrMetallicRoughness': {{{member}}}}}");
    let texture = |index: &str| pbr(&format!("'metallicRoughnessTexture': {{{index}}}"));
    let (pbr_of, member) = ("(pbrMetallicRoughness): ", "metallicRoughnessTexture: ");
    for (material, name, parts) in [
        (
            pbr("'roughnessFactor': '0.5'"),
            "m",
            [pbr_of, "): roughnessFactor: ", "'0.5', expected a number"],
        ),
        (
            pbr("'roughnessFactor': 1e999"),
            "m",
            [pbr_of, "): roughnessFactor: number out of", "range"],
        ),
        (texture(""), "m", [pbr_of, member, "index is missing"]),
        (texture("'index': -1"), "m", [member, "index: -1 is not a whole number", "from 0"]),
        (texture("'index': '0'"), "m", [member, "'0' is not a whole number", "from 0 to 2^53"]),
        (texture("'index': {}"), "m", [member, "{} is not a whole number", "from 0 to 2^53"]),
        ("null".to_owned(), "material 0", ["(material)", "null", "an object"]),
        ("[]".to_owned(), "material 0", ["(material)", "sequence", "an object"]),
        (
            pbr("'roughnessFactor': 0.5, 'roughnessFactor': 0.2"),
            "m",
            [pbr_of, "): a second member roughnessFactor;", "remove one"],
        ),
    ] {
        let scene = beside(&material, "");
        assert_not_understood(&scene, name, "a.gltf", &parts);
        assert_eq!((names(&scene), scene.ignored.len()), (vec!["good"], 1));
        assert_eq!(scene.warnings, [""; 0]);
    }
    let scene = beside("{'name': 'm', 'extensions': {'KHR_materials_clearcoat': []}}", "");
    let parts = ["extensions: KHR_materials_clearcoat: ", "sequence", "an object"];
    assert_not_understood(&scene, "m.clearcoat", "a.gltf", &parts);
    assert_eq!(names(&scene), ["m", "good"]);
    for (colour, count) in [("1, 0.5, 0.2", "3 numbers"), ("1, 1, 1, 1, 1", "5 numbers")] {
        let scene = beside(&pbr(&format!("'baseColorFactor': [{colour}]")), "");
        let parts = ["baseColorFactor: the list has ", count, "must have 4", "without its Fresnel"];
        assert_warned(&scene, "a.gltf", &parts);
        assert_eq!((names(&scene), named(&scene, "m").fresnel), (vec!["m", "good"], None));
    }
}

#[test]
fn lists_and_numbers_of_another_kind_are_said_in_words_of_json() {
    let case = |value: &str, part: &str| {
        let scene =
            beside(&format!("{{'pbrMetallicRoughness': {{'baseColorFactor': {value}}}}}"), "");
        assert_warned(&scene, "a.gltf", &["baseColorFactor: ", part, "without its Fresnel"]);
    };
    case("5", "expected a list");
    case("[1, '2', 1, 1]", "invalid type: string '2', expected a number");
    case("[1, {}, 1, 1]", "invalid type: object, expected a number");
    case("{}", "an object where a list is expected, as in glTF 1.0");
}

#[test]
fn a_name_that_is_none_leaves_the_material() {
    let scene = beside("{'name': 5}", "");
    assert_eq!((names(&scene), scene.ignored.len()), (vec!["material 0", "good"], 0));
}

#[test]
fn a_member_that_is_null_is_absent() {
    let materials = "
        {'name': null, 'pbrMetallicRoughness': null, 'extensions': null},
        {'pbrMetallicRoughness': {'roughnessFactor': null, 'metallicRoughnessTexture': null},
         'extensions': {'KHR_materials_clearcoat': null, 'KHR_materials_unlit': null}}";
    let scene = load("a.gltf", &document(materials, ", 'meshes': null, 'images': null"));
    assert_eq!(names(&scene), ["material 0", "material 1"]);
    assert!(scene.materials.iter().all(|m| m.used && m.lobe.roughness == isotropic(1.0)));
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn a_texture_that_cannot_be_read_covers_all() {
    let image = "'textures': [{'source': 0}], 'images': [{'bufferView': 0}]";
    for (rest, why) in [
        ("'textures': [null]", "null"),
        ("'textures': [{'source': -1}]", "source: -1 is not a whole number"),
        ("'textures': [{}]", "no PNG or JPEG image"),
        ("'textures': []", "no such texture"),
        ("'textures': [{'source': 0}], 'images': []", "no such image"),
        ("'textures': [{'source': 0}], 'images': [{'uri': 7}]", "uri: invalid type: integer `7`"),
        ("IMAGE, 'bufferViews': [{'buffer': 0}], 'buffers': [{}]", "byteLength is missing"),
        (
            "IMAGE, 'bufferViews': [{'buffer': 0, 'byteLength': 1}], 'buffers': [[]]",
            "sequence, expected an object",
        ),
    ] {
        let rest = format!(", {}", rest.replace("IMAGE", image));
        let scene = load("a.gltf", &document(TEXTURED, &rest));
        assert_close(named(&scene, "rough").lobe.roughness, [0.0, 0.25], [0.0, 0.25]);
        assert_eq!(scene.ignored, []);
        assert_warned(&scene, "a.gltf", &["texture 0 cannot be read (", why, "[0, 1]"]);
    }
    // An unreadable texture has no effect unless it is used.
    let scene = beside("{}", ", 'textures': [null], 'images': [5], 'buffers': ['']");
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn with_a_mesh_that_cannot_be_read_every_material_may_be_used() {
    for (mesh, why) in [
        ("{'name': 'x'}", "primitives is missing"),
        ("null", "null"),
        ("{'primitives': [{'material': 0.5}]}", "primitives: material: 0.5 is not a whole number"),
        ("{'primitives': [{'material': -1}]}", ": -1 is not a whole number"),
        ("{'primitives': [{'material': 1e300}]}", "1e300 is not a whole number"),
    ] {
        let meshes = format!(", 'meshes': [{{'primitives': [{{'material': 1}}]}}, {mesh}]");
        let scene = beside("{}", &meshes);
        assert_warned(&scene, "a.gltf", &["mesh 1 cannot be read (", why, "count as used"]);
        assert!(scene.materials.iter().all(|material| material.used));
    }
}

#[test]
fn a_required_extension_that_is_not_known_costs_its_materials_alone() {
    let required = |names: &str| format!(", 'extensionsRequired': [5, {names}]");
    let one = |name: &str| format!("{{'name': 'm', 'extensions': {{'{name}': {{}}}}}}");
    let scene = beside(&one("ADSK_x"), &required("'KHR_texture_transform', 'ADSK_x'"));
    let parts = ["ADSK_x is not known", "extensionsRequired"];
    assert_not_understood(&scene, "m", "a.gltf", &parts);
    assert_eq!((names(&scene), scene.ignored.len()), (vec!["good"], 1));
    // An extension that is not required may be ignored (specification, 3.12).
    let scene = beside(&one("ADSK_x"), &required("'ADSK_y'"));
    assert_eq!((named(&scene, "m").lobe.roughness, scene.ignored.len()), (isotropic(1.0), 0));
    // Known extensions are read, or leave the lobe as it is.
    let known = "anisotropy clearcoat ior specular transmission iridescence dispersion \
                 emissive_strength volume diffuse_transmission";
    for known in known.split(' ').map(|name| format!("KHR_materials_{name}")) {
        let scene = beside(&one(&known), &required(&format!("'{known}'")));
        assert_eq!((names(&scene), scene.ignored.len()), (vec!["m", "good"], 0), "{known}");
    }
    // Extensions of primitives concern geometry.
    let draco = "{'material': 0, 'extensions': {'KHR_draco_mesh_compression': {}}}";
    let meshes = format!(", 'meshes': [{{'primitives': [{draco}]}}]");
    let scene = beside("{}", &(required("'KHR_draco_mesh_compression'") + &meshes));
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn text_of_another_encoding_refuses_nothing() {
    let text = b"{'asset': {'version': '2.0'}, 'meshes': [{'name': 'K\xf6rper',
        'primitives': [{'material': 0}]}], 'materials': [{'name': 'Gr\xfcn'}]}";
    let scene = Folder::new(&[("a.gltf", text)]).load("a.gltf").unwrap();
    assert_eq!(names(&scene), ["Gr\u{fffd}n"]);
    assert!(scene.warnings[0].contains("not UTF-8"), "{:?}", scene.warnings);
}
