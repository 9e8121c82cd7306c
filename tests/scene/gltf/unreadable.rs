//! Values of a wrong kind, each of which costs no more than what it is a part of.

use super::degraded::beside;
use super::{TEXTURED, document};
use crate::{assert_close, assert_not_understood, assert_warned, isotropic, load, named, names};

#[test]
fn a_material_that_cannot_be_read_is_named() {
    let case = |material: &str, name: &str, parts: &[&str]| {
        let scene = beside(material, "");
        assert_not_understood(&scene, name, "a.gltf", &[parts, &["(material)"]].concat());
        assert_eq!((names(&scene), &scene.warnings[..]), (vec!["good"], &[][..]));
    };
    let pbr = |member: &str| format!(r#"{{"name": "m", "pbrMetallicRoughness": {{{member}}}}}"#);
    let rough = pbr(r#""roughnessFactor": "0.5""#);
    case(&rough, "m", &["pbrMetallicRoughness: roughnessFactor: ", "\"0.5\"", "f64"]);
    case(&pbr(r#""roughnessFactor": 1e999"#), "m", &["roughnessFactor: number out of range"]);
    for (colour, count) in [("1, 0.5, 0.2", "3 numbers"), ("1, 1, 1, 1, 1", "5 numbers")] {
        let colour = pbr(&format!("\"baseColorFactor\": [{colour}]"));
        case(&colour, "m", &["baseColorFactor: the list has ", count, "must have 4"]);
    }
    let texture = |index: &str| pbr(&format!("\"metallicRoughnessTexture\": {{{index}}}"));
    case(&texture(""), "m", &["metallicRoughnessTexture: missing field `index`"]);
    case(&texture("\"index\": -1"), "m", &["metallicRoughnessTexture: index: ", "`-1`"]);
    case("null", "material 0", &["null", "an object"]);
    // Serde takes a list for the members in their order.
    let coat = r#"{"name": "m", "extensions": {"KHR_materials_clearcoat": []}}"#;
    case(coat, "m", &["extensions: KHR_materials_clearcoat: ", "sequence", "an object"]);
    case("[]", "material 0", &["sequence", "an object"]);
}

#[test]
fn a_name_that_is_none_leaves_the_material() {
    let scene = beside("{\"name\": 5}", "");
    assert_eq!((names(&scene), scene.ignored.len()), (vec!["material 0", "good"], 0));
}

#[test]
fn a_member_that_is_null_is_absent() {
    let materials = r#"
        {"name": null, "pbrMetallicRoughness": null, "extensions": null},
        {"pbrMetallicRoughness": {"roughnessFactor": null, "metallicRoughnessTexture": null},
         "extensions": {"KHR_materials_clearcoat": null, "KHR_materials_unlit": null}}"#;
    let scene = load("a.gltf", &document(materials, ", \"meshes\": null, \"images\": null"));
    assert_eq!(names(&scene), ["material 0", "material 1"]);
    assert!(scene.materials.iter().all(|m| m.used && m.lobe.roughness == isotropic(1.0)));
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn a_texture_that_cannot_be_read_covers_all() {
    let case = |rest: &str, why: &str| {
        let scene = load("a.gltf", &document(TEXTURED, &format!(", {rest}")));
        assert_close(named(&scene, "rough").lobe.roughness, [0.0, 0.25], [0.0, 0.25]);
        assert_eq!(scene.ignored, []);
        assert_warned(&scene, "a.gltf", &["texture 0 cannot be read (", why, "[0, 1]"]);
    };
    case("\"textures\": [null]", "null");
    case("\"textures\": [{\"source\": -1}]", "source: invalid type: integer `-1`");
    case("\"textures\": [{}]", "no PNG or JPEG image");
    case("\"textures\": []", "no such texture");
    let image = |image: &str, rest: &str| {
        format!("\"textures\": [{{\"source\": 0}}], \"images\": [{image}]{rest}")
    };
    case(&image("", ""), "no such image");
    case(&image("{\"uri\": 7}", ""), "uri: invalid type: integer `7`");
    let view = |view: &str, buffer: &str| {
        let rest = format!(", \"bufferViews\": [{view}], \"buffers\": [{buffer}]");
        image("{\"bufferView\": 0}", &rest)
    };
    case(&view("{\"buffer\": 0}", "{}"), "missing field `byteLength`");
    case(&view("{\"buffer\": 0, \"byteLength\": 1}", "[]"), "sequence, expected an object");
}

#[test]
fn a_texture_that_cannot_be_read_matters_only_where_it_is_used() {
    let scene = beside("{}", ", \"textures\": [null], \"images\": [5], \"buffers\": [\"\"]");
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn with_a_mesh_that_cannot_be_read_every_material_may_be_used() {
    let case = |mesh: &str, why: &str| {
        let meshes = format!(", \"meshes\": [{{\"primitives\": [{{\"material\": 1}}]}}, {mesh}]");
        let scene = beside("{}", &meshes);
        assert_warned(&scene, "a.gltf", &["mesh 1 cannot be read (", why, "count as used"]);
        assert!(scene.materials.iter().all(|material| material.used));
    };
    case("{\"name\": \"x\"}", "missing field `primitives`");
    case("null", "null");
    let primitive = |number: &str| format!("{{\"primitives\": [{{\"material\": {number}}}]}}");
    case(&primitive("0.5"), "primitives: material: 0.5 is not a whole number");
    case(&primitive("-1"), "`-1`, expected a whole number");
    case(&primitive("1e300"), "1e300 is not a whole number");
}

#[test]
fn a_required_extension_that_is_not_known_costs_its_materials_alone() {
    let required = |names: &str| format!(", \"extensionsRequired\": [5, {names}]");
    let one = |name: &str| format!("{{\"name\": \"m\", \"extensions\": {{\"{name}\": {{}}}}}}");
    let scene = beside(&one("ADSK_x"), &required("\"KHR_texture_transform\", \"ADSK_x\""));
    let parts = ["ADSK_x is not known", "extensionsRequired"];
    assert_not_understood(&scene, "m", "a.gltf", &parts);
    assert_eq!((names(&scene), scene.ignored.len()), (vec!["good"], 1));
    // One that is not required may be left aside (specification, 3.12).
    let scene = beside(&one("ADSK_x"), &required("\"ADSK_y\""));
    assert_eq!((named(&scene, "m").lobe.roughness, scene.ignored.len()), (isotropic(1.0), 0));
    // Of these some are read, and the others leave the lobe as it is.
    for known in ["anisotropy", "clearcoat", "ior", "specular", "transmission", "iridescence"]
        .into_iter()
        .chain(["dispersion", "emissive_strength", "volume", "diffuse_transmission"])
    {
        let known = format!("KHR_materials_{known}");
        let scene = beside(&one(&known), &required(&format!("\"{known}\"")));
        assert_eq!((names(&scene), scene.ignored.len()), (vec!["m", "good"], 0), "{known}");
    }
    // What primitives require has to do with geometry.
    let draco = r#"{"material": 0, "extensions": {"KHR_draco_mesh_compression": {}}}"#;
    let meshes = format!(", \"meshes\": [{{\"primitives\": [{draco}]}}]");
    let scene = beside("{}", &(required("\"KHR_draco_mesh_compression\"") + &meshes));
    assert_eq!((scene.ignored.len(), scene.warnings.len()), (0, 0));
}

#[test]
fn text_of_another_encoding_refuses_nothing() {
    let text = b"{\"asset\": {\"version\": \"2.0\"}, \"meshes\": [{\"name\": \"K\xf6rper\",
        \"primitives\": [{\"material\": 0}]}], \"materials\": [{\"name\": \"Gr\xfcn\"}]}";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, text).unwrap();
    let scene = microfacet_scene::load(&path).unwrap();
    assert_eq!(names(&scene), ["Gr\u{fffd}n"]);
    assert!(scene.warnings[0].contains("not UTF-8"), "{:?}", scene.warnings);
}
