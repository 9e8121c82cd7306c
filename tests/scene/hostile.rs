//! Damaged scenes: every one must be read or refused, without a panic.

use proptest::prelude::*;

use crate::Folder;

const SCENES: [(&str, &str); 5] = [
    (
        "a.toml",
        "[[material]]\nname = \"a\"\nsigma = [{ min = 0.1, max = 0.2 }, 0.3]\ngamma = \"inf\"\n\
         fresnel = { conductor = { eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.2] } }\nmasking = \"uncorrelated\"\n",
    ),
    (
        "a.pbrt",
        "Texture \"t\" \"float\" \"scale\" \"float scale\" 0.5 # half\nAttributeBegin\n\
         Material \"coatedconductor\" \"texture interface.roughness\" [ \"t\" ] \"rgb conductor.eta\" [ 1 2 3 ]\n\
         Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0 ]\nAttributeEnd\nInclude \"b.pbrt\"\n",
    ),
    (
        "a.xml",
        "<scene version=\"3.0.0\"><default name=\"r\" value=\"0.3\"/><include filename=\"b.xml\"/>\
         <bsdf type=\"twosided\" id=\"a\"><bsdf type=\"principled\"><float name=\"roughness\" value=\"$r\"/>\
         <ref name=\"anisotropic\" id=\"t\"/></bsdf></bsdf><texture type=\"checkerboard\" id=\"t\"/>\
         <shape type=\"cube\"><ref id=\"a\"/></shape></scene>",
    ),
    (
        "a.gltf",
        "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5, \
         \"metallicRoughnessTexture\": {\"index\": 0}}, \"extensions\": {\"KHR_materials_clearcoat\": \
         {\"clearcoatFactor\": 1}}}], \"textures\": [{\"source\": 0}], \"images\": [{\"bufferView\": 0}], \
         \"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 3, \"byteLength\": 9}], \"buffers\": [{\"uri\": \
         \"data:x;base64,AAAA\"}]}",
    ),
    (
        "a.mtlx",
        "<materialx version=\"1.39\"><nodegraph name=\"G\"><mix name=\"m\"><input name=\"fg\" value=\"0.3\"/>\
         <input name=\"mix\" interfacename=\"x\"/></mix><input name=\"x\" value=\"0.5, 1\"/><output name=\"o\" nodename=\"m\"/>\
         </nodegraph><standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"specular_roughness\" \
         nodegraph=\"G\" output=\"o\"/></standard_surface></materialx>",
    ),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn damage_is_refused_and_never_fatal(
        scene in prop::sample::select(&SCENES[..]),
        at in any::<prop::sample::Index>(),
        removed in 0usize..40,
        from in any::<prop::sample::Index>(),
        inserted in 0usize..40,
        noise in prop::collection::vec(any::<u8>(), 0..3),
    ) {
        let (name, text) = scene;
        let bytes = text.as_bytes();
        let (at, from) = (at.index(bytes.len()), from.index(bytes.len()));
        let rest = &bytes[(at + removed).min(bytes.len())..];
        let moved = &bytes[from..(from + inserted).min(bytes.len())];
        let damaged = [&bytes[..at], moved, &noise, rest].concat();
        if let Err(error) = Folder::new(&[(name, damaged)]).load(name) {
            prop_assert!(error.to_string().contains(name), "{error}");
        }
    }
}

#[test]
fn an_include_of_a_folder_is_refused_at_its_place() {
    for include in ["", "."] {
        let text = format!("AttributeBegin\nInclude \"{include}\"\n");
        let error =
            Folder::new(&[("a.pbrt", text.into_bytes())]).load("a.pbrt").unwrap_err().to_string();
        assert!(error.contains("a.pbrt:2") && error.contains("folder"), "{error}");
    }
}
