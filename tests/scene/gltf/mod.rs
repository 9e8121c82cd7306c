//! glTF 2.0 scenes.

mod fresnel;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use microfacet_baker::scene::{Format, Reflectance, Roughness};
use microfacet_tables::Interval;

use crate::{Folder, anisotropic, assert_close, isotropic, load, named, names, png};

fn document(materials: &str, rest: &str) -> String {
    format!("{{'asset': {{'version': '2.0'}},\n'materials': [{materials}]{rest}}}")
}

#[test]
fn roughness_is_squared_and_the_rest_is_ggx() {
    let scene = load(
        "a.gltf",
        &document(
            r#"
            {"name": "half", "pbrMetallicRoughness": {"roughnessFactor": 0.5}},
            {"pbrMetallicRoughness": {"metallicFactor": 0}},
            {"name": "mirror", "pbrMetallicRoughness": {"roughnessFactor": 0}},
            {"name": "half", "pbrMetallicRoughness": {"roughnessFactor": 0.1},
             "extensions": {"KHR_materials_ior": {"ior": 2}}},
            {"name": "gloss", "extensions": {"KHR_materials_pbrSpecularGlossiness": {"glossinessFactor": 0.25}}},
            {"name": "flat", "extensions": {"KHR_materials_unlit": {}}}
            "#,
            "",
        ),
    );
    assert_eq!(names(&scene), ["half", "material 1", "mirror", "half (2)", "gloss"]);
    for material in &scene.materials {
        assert_eq!(material.lobe.gamma, Interval::point(2.0));
        assert_eq!(material.masking, None);
        assert_eq!(material.origin.format, Format::Gltf);
        assert!(material.used, "there are no meshes");
    }
    let roughness: Vec<_> = scene.materials.iter().map(|m| m.lobe.roughness).collect();
    let expected = [
        isotropic(0.25),
        isotropic(1.0),
        Roughness::Smooth,
        isotropic(0.1 * 0.1),
        isotropic(0.5625),
    ];
    assert_eq!(roughness, expected);
    assert_eq!(scene.ignored[0].kind, "KHR_materials_unlit");
}

#[test]
fn extensions_add_anisotropy_and_a_coat() {
    let scene = load(
        "a.gltf",
        &document(
            r#"{"name": "car", "pbrMetallicRoughness": {"roughnessFactor": 0.5}, "extensions": {
                "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.57},
                "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.2},
                "KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_sheen": {"sheenRoughnessFactor": 0.5}}},
               {"name": "bare", "extensions": {"KHR_materials_clearcoat": {}}}"#,
            "",
        ),
    );
    assert_eq!(names(&scene), ["car", "car.clearcoat", "bare"]);
    // 0.25 + 0.75 * 0.25
    assert_eq!(scene.materials[0].lobe.roughness, anisotropic(0.4375, 0.25));
    assert_eq!(scene.materials[1].lobe.roughness, isotropic(0.2 * 0.2));
    assert_eq!(scene.materials[1].fresnel, Some(Reflectance::Schlick([0.04; 3])));
    assert_eq!(scene.materials[1].origin.lobe, Some("clearcoat"));
    assert_eq!(scene.ignored[0].name, "car.sheen");
}

#[test]
fn meshes_tell_what_is_used() {
    let materials = r#"{"name": "a"}, {"name": "b"}, {"name": "c"}"#;
    let meshes = r#", "meshes": [{"primitives": [{"attributes": {}, "material": 1}, {"attributes": {},
        "material": 1, "extensions": {"KHR_materials_variants": {"mappings": [{"material": 2, "variants": [0]}]}}}]}]"#;
    let scene = load("a.gltf", &document(materials, meshes));
    let used: Vec<_> = scene.materials.iter().map(|m| m.used).collect();
    assert_eq!(used, [false, true, true]);

    let bare = r#", "meshes": [{"primitives": [{"attributes": {}}]}]"#;
    let scene = load("a.gltf", &document(materials, bare));
    assert_eq!(names(&scene), ["a", "b", "c", "default material"]);
    assert!(named(&scene, "default material").used);
    assert_eq!(named(&scene, "default material").lobe.roughness, isotropic(1.0));
}

/// Materials that take the PNG's green and blue as roughness and as anisotropy.
const TEXTURED: &str = r#"
    {"name": "rough", "pbrMetallicRoughness": {"roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}}},
    {"name": "coated", "pbrMetallicRoughness": {"roughnessFactor": 0.5}, "extensions": {
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0}},
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 1,
            "clearcoatRoughnessTexture": {"index": 0}}}}"#;

#[track_caller]
fn assert_textured(scene: &microfacet_baker::scene::Scene) {
    assert_eq!(scene.warnings, [""; 0]);
    let check = |name: &str, x: [f64; 2], y: [f64; 2]| {
        assert_close(named(scene, name).lobe.roughness, x, y)
    };
    check("rough", [0.04, 0.16], [0.04, 0.16]);
    check("coated", [0.25, 0.4375], [0.25, 0.25]);
    check("coated.clearcoat", [0.16, 0.64], [0.16, 0.64]);
    assert!(named(scene, "rough").lobe.roughness.is_isotropic());
    assert!(!named(scene, "coated").lobe.roughness.is_isotropic());
}

#[test]
fn images_are_read_from_wherever_they_are() {
    let images = |image: &str| {
        document(TEXTURED, &format!(", 'textures': [{{'source': 0}}], 'images': [{image}]"))
    };
    let file = Folder::new(&[
        ("a b.png", png()),
        ("a.gltf", images(r#"{"uri": "a%20b.png"}"#).into_bytes()),
    ]);
    assert_textured(&file.load("a.gltf").unwrap());

    let base64 = STANDARD.encode(png());
    let uri = images(&format!("{{'uri': 'data:image/png;base64,{base64}'}}"));
    assert_textured(&load("a.gltf", &uri));

    let in_buffer = |buffer: &str| {
        let view = format!(
            "{{'bufferView': 0, 'mimeType': 'image/png'}}], 'buffers': [{{{buffer}'byteLength': 1}}], \
             'bufferViews': [{{'buffer': 0, 'byteOffset': 3, 'byteLength': {}}}",
            png().len()
        );
        images(&view)
    };
    let bytes = [&b"xxx"[..], &png()].concat();
    let buffer = Folder::new(&[
        ("a.bin", bytes.clone()),
        ("a.gltf", in_buffer("'uri': 'a.bin', ").into_bytes()),
    ]);
    assert_textured(&buffer.load("a.gltf").unwrap());

    let base64 = STANDARD.encode(&bytes);
    let uri = in_buffer(&format!("'uri': 'data:application/octet-stream;base64,{base64}', "));
    assert_textured(&load("a.gltf", &uri));

    let container = Folder::new(&[("a.glb", glb(&in_buffer(""), &bytes))]);
    assert_textured(&container.load("a.glb").unwrap());
}

/// A binary container of version 2.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let json = json.replace('\'', "\"");
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let word = |n: usize| u32::try_from(n).unwrap().to_le_bytes();
    let total = 12 + 8 + json.len() + 8 + binary.len();
    [
        &b"glTF"[..],
        &word(2),
        &word(total),
        &word(json.len()),
        b"JSON",
        &json,
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ]
    .concat()
}

#[test]
fn indices_may_be_written_as_decimals() {
    let png = png();
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
    let folder = Folder::new(&[("a.gltf", text.as_bytes()), ("a.bin", &png)]);
    let scene = folder.load("a.gltf").unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    let Roughness::Isotropic(range) = scene.materials[0].lobe.roughness else { unreachable!() };
    assert!((range.min - 0.16).abs() < 1e-12 && (range.max - 0.64).abs() < 1e-12, "{range:?}");
    let used: Vec<_> = scene.materials.iter().map(|material| material.used).collect();
    assert_eq!(used, [false, true]);
}

#[test]
fn text_of_another_encoding_refuses_nothing() {
    let text = b"{'asset': {'version': '2.0'}, 'meshes': [{'name': 'K\xf6rper',
        'primitives': [{'material': 0}]}], 'materials': [{'name': 'Gr\xfcn'}]}";
    let scene = Folder::new(&[("a.gltf", text)]).load("a.gltf").unwrap();
    assert_eq!(names(&scene), ["Gr\u{fffd}n"]);
    assert!(scene.warnings[0].contains("not UTF-8"), "{:?}", scene.warnings);
}

#[test]
fn what_is_no_container_is_refused() {
    let whole = glb(&document("{}", ""), b"");
    for (bytes, part) in [
        (&whole[..8], "container"),
        (&whole[..40], "ends inside"),
        (&[&b"glTF\x01\0\0\0"[..], &whole[8..]].concat(), "container of glTF 1.0"),
        (&[&b"glTF\x03\0\0\0"[..], &whole[8..]].concat(), "container of version 2"),
    ] {
        let message = Folder::new(&[("a.glb", bytes)]).load("a.glb").unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn retroreflection_is_red_of_its_texture() {
    let retro = |inside: &str| format!("{{'KHR_materials_retroreflection': {{{inside}}}}}");
    let base64 = STANDARD.encode(png());
    let images = format!(
        ", 'textures': [{{'source': 0}}], 'images': [{{'uri': 'data:image/png;base64,{base64}'}}]"
    );
    let share = |inside: &str| {
        let material = format!("{{'name': 'm', 'extensions': {}}}", retro(inside));
        let scene = load("a.gltf", &document(&material, &images));
        assert_eq!(scene.warnings, [""; 0]);
        assert_eq!(scene.materials[0].haze, None);
        scene.materials[0].retroreflection
    };
    assert_eq!(share(""), Interval::point(0.0));
    assert_eq!(share("'retroreflectionFactor': 0.75"), Interval::point(0.75));
    // Red is from 0.2 to 0.4, and not decoded from sRGB.
    let textured = share("'retroreflectionFactor': 0.5, 'retroreflectionTexture': {'index': 0}");
    assert_close(Roughness::Isotropic(textured), [0.1, 0.2], [0.1, 0.2]);
    assert_eq!(share("'retroreflectionTexture': {'index': 0}"), Interval::point(0.0));
}
