//! Damaged scenes: every one must be read or refused, without a panic.

use std::fs;
#[cfg(target_os = "linux")]
use std::fs::File;
use std::time::{Duration, Instant};

use proptest::prelude::*;

use microfacet_baker::scene::Scene;

use crate::{Folder, assert_not_understood, assert_refused, assert_warned, load, names};

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
fn an_include_of_a_folder_is_warned_of_at_its_place() {
    for include in ["", "."] {
        let text = format!("WorldBegin\nInclude \"{include}\"\nMaterial \"conductor\"\n");
        let scene = load("a.pbrt", &text);
        assert_warned(&scene, "a.pbrt:2:1", &["is a folder"]);
        assert_eq!(scene.materials.len(), 1);
    }
}

/// The message that `name` is refused with, which must come soon.
#[track_caller]
fn soon_refused(folder: &Folder, name: &str) -> String {
    let start = Instant::now();
    let message = folder.load(name).unwrap_err().to_string();
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}: {message}", start.elapsed());
    message
}

/// The scene in one file, which must be read soon.
#[track_caller]
fn soon_loaded(name: &str, text: &str) -> Scene {
    let start = Instant::now();
    let scene = load(name, text);
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    scene
}

/// Checks that the file is refused soon, with a message that holds all of `parts`.
#[track_caller]
fn assert_soon_refused(name: &str, text: &str, parts: &[&str]) {
    let message = soon_refused(&Folder::new(&[(name, text)]), name);
    for part in parts {
        assert!(message.contains(part), "no {part:?} in {message}");
    }
}

/// A folder with `odd`, which is a device, a FIFO or a file of 5 GB with nothing in it.
#[cfg(target_os = "linux")]
fn odd_files() -> Vec<(Folder, &'static str)> {
    let new = || Folder::new::<&str>(&[]);
    let (device, fifo, sparse) = (new(), new(), new());
    std::os::unix::fs::symlink("/dev/zero", device.path("odd")).unwrap();
    let made = std::process::Command::new("mkfifo").arg(fifo.path("odd")).status().unwrap();
    assert!(made.success());
    File::create(sparse.path("odd")).unwrap().set_len(5 << 30).unwrap();
    vec![(device, "character device"), (fifo, "FIFO"), (sparse, "")]
}

#[test]
#[cfg(target_os = "linux")]
fn devices_fifos_and_files_without_end_are_refused_as_scenes() {
    for (folder, what) in odd_files() {
        for name in ["a.toml", "a.pbrt", "a.pbrt.gz", "a.xml", "a.gltf", "a.glb", "a.mtlx"] {
            fs::rename(folder.path("odd"), folder.path(name)).unwrap();
            let message = soon_refused(&folder, name);
            assert!(message.contains(name) && message.contains(what), "{message}");
            fs::rename(folder.path(name), folder.path("odd")).unwrap();
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn devices_fifos_and_files_without_end_are_refused_within_scenes() {
    let include = "odd";
    let scenes = [
        ("a.pbrt", format!("Include \"{include}\"\n")),
        ("a.xml", format!("<scene><include filename=\"{include}\"/></scene>")),
        ("a.mtlx", format!("<materialx><include href=\"{include}\"/></materialx>")),
        (
            "a.toml",
            "[[material]]\nname = \"a\"\ndistribution = { measured = \"odd\" }\n".to_owned(),
        ),
    ];
    for (folder, what) in odd_files() {
        for (name, text) in &scenes {
            fs::write(folder.path(name), text).unwrap();
            let message = soon_refused(&folder, name);
            assert!(message.contains("odd") && message.contains(what), "{message}");
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn devices_fifos_and_files_without_end_are_no_images() {
    let image = "\"images\": [{\"uri\": \"odd\"}], \"textures\": [{\"source\": 0}]";
    let view = "\"images\": [{\"bufferView\": 0}], \"textures\": [{\"source\": 0}], \
                \"buffers\": [{\"uri\": \"odd\"}], \
                \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 5000000000}]";
    let gltf = |image: &str| {
        format!(
            "{{\"asset\": {{\"version\": \"2.0\"}}, \"materials\": [{{\"pbrMetallicRoughness\": \
             {{\"metallicRoughnessTexture\": {{\"index\": 0}}}}}}], {image}}}"
        )
    };
    let scenes = [
        (
            "a.pbrt",
            "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"odd\"\n\
             Material \"conductor\" \"texture roughness\" \"t\"\n"
                .to_owned(),
        ),
        ("a.gltf", gltf(image)),
        ("b.gltf", gltf(view)),
    ];
    for (folder, _) in odd_files() {
        for (name, text) in &scenes {
            fs::write(folder.path(name), text).unwrap();
            let start = Instant::now();
            let scene = folder.load(name).unwrap();
            assert!(start.elapsed() < Duration::from_secs(60));
            assert!(scene.warnings[0].contains("assumed to cover [0, 1]"), "{:?}", scene.warnings);
        }
    }
}

#[test]
fn files_that_include_the_next_twice_are_refused() {
    let kinds = [
        ("pbrt", "Include \"NEXT\"\nInclude \"NEXT\"\n", ""),
        (
            "xml",
            "<scene><include filename=\"NEXT\"/><include filename=\"NEXT\"/></scene>",
            "<scene/>",
        ),
        (
            "mtlx",
            "<materialx><include href=\"NEXT\"/><include href=\"NEXT\"/></materialx>",
            "<materialx/>",
        ),
    ];
    for (extension, twice, last) in kinds {
        let name = |i: usize| format!("{i}.{extension}");
        let folder = Folder::new::<&str>(&[]);
        for i in 0..31 {
            let text = if i < 30 { twice.replace("NEXT", &name(i + 1)) } else { last.to_owned() };
            fs::write(folder.path(&name(i)), text).unwrap();
        }
        let message = soon_refused(&folder, &name(0));
        assert!(message.contains("more than 10000 times"), "{message}");
        assert!(message.contains(&format!(".{extension}:")), "no place: {message}");
    }
}

#[test]
fn parameters_that_double_are_refused() {
    let double = |i: usize| format!("<default name=\"a{}\" value=\"$a{i}$a{i}\"/>", i + 1);
    let doubles: String = (0..60).map(double).collect();
    let text = format!("<scene>\n<default name=\"a0\" value=\"xxxxxxxx\"/>{doubles}</scene>");
    assert_soon_refused("a.xml", &text, &["a.xml:2:", "more than 64 MiB"]);

    let many: String =
        (0..1001).map(|i| format!("<default name=\"n{i}\" value=\"\"/>\n")).collect();
    assert_refused("a.xml", &format!("<scene>{many}</scene>"), ":1001:1", &["more than 1000"]);
    let many: String = (0..65).map(|i| format!("<path value=\"n{i}\"/>\n")).collect();
    assert_refused("a.xml", &format!("<scene>{many}</scene>"), ":65:1", &["more than 64 <path>"]);
}

#[test]
fn xml_that_its_parser_cannot_take_is_refused() {
    let attributes: String = (0..300_000).map(|i| format!(" a{i}=\"\"")).collect();
    assert_refused(
        "a.xml",
        &format!("<scene>\n<a{attributes}/></scene>"),
        ":2:2",
        &["256 attributes"],
    );
    let spaces: String = (0..100).map(|i| format!("<a xmlns:a{i}=\"b\"/>\n")).collect();
    assert_refused(
        "a.mtlx",
        &format!("<materialx>{spaces}</materialx>"),
        ":65:4",
        &["64 namespaces"],
    );
    let elements = "<a/>".repeat(2_200_000);
    assert_refused("a.xml", &format!("<scene>{elements}</scene>"), "", &["2097152 elements"]);
    let attributes = "<a b=\"\" c=\"\"/>".repeat(800_000);
    assert_refused("a.xml", &format!("<scene>{attributes}</scene>"), "", &["1572864 attributes"]);
    // Together, by files that are small enough.
    let part = format!("<scene>{}</scene>", "<a/>".repeat(600_000));
    let whole = "<scene>\n<include filename=\"b.xml\"/><include filename=\"b.xml\"/>\
                 <include filename=\"b.xml\"/><include filename=\"b.xml\"/></scene>";
    let folder = Folder::new(&[("a.xml", whole), ("b.xml", &part)]);
    assert!(soon_refused(&folder, "a.xml").contains("2097152 elements"));
    let part = format!("<scene><!--{}--></scene>", " ".repeat(20_000_000));
    let folder = Folder::new(&[("a.xml", whole), ("b.xml", &part)]);
    let message = soon_refused(&folder, "a.xml");
    assert!(message.contains("a.xml:2:") && message.contains("64 MiB"), "{message}");
}

/// Each of them would be escaped by itself.
#[test]
fn very_many_ampersands_and_tokens_are_refused() {
    for many in ["&", "&#1", "<a>"] {
        let count = (40 << 20) / many.len();
        let text = format!("<materialx>\n<a b=\"{}\"/></materialx>", many.repeat(count));
        assert_soon_refused("a.mtlx", &text, &["a.mtlx:2:"]);
    }
    let text = format!("<materialx a=\"{}&#{}\"/>", "&".repeat(200_000), "1".repeat(1 << 20));
    assert_eq!(soon_loaded("a.mtlx", &text).materials, []);
}

/// Each file is nested no deeper than it may be, and all of them together very deep.
#[test]
fn includes_do_not_add_to_the_nesting() {
    let folder = Folder::new::<&str>(&[]);
    for i in 0..60 {
        let include = format!("<include filename=\"{}.xml\"/>", i + 1);
        let inner = if i < 59 { include } else { String::new() };
        let text = format!("<scene>{}{inner}{}</scene>", "<a>".repeat(250), "</a>".repeat(250));
        fs::write(folder.path(&format!("{i}.xml")), text).unwrap();
    }
    assert!(soon_refused(&folder, "0.xml").contains("nested more than 256 deep"));
}

#[test]
fn long_chains_of_references_take_no_stack() {
    let links: String = (0..100_000)
        .map(|i| format!("<bsdf type=\"mask\" id=\"b{i}\"><ref id=\"b{}\"/></bsdf>", i + 1))
        .collect();
    let text = format!(
        "<scene>{links}<bsdf type=\"roughconductor\" id=\"b100000\"/>\
         <shape type=\"cube\"><ref id=\"b0\"/></shape></scene>"
    );
    let scene = load("a.xml", &text);
    assert!(scene.materials[0].used && scene.materials.len() == 1);
}

#[test]
fn bsdfs_that_hold_each_other_are_warned_of_at_their_place() {
    let case = |text: &str, place: &str, circle: &str| {
        let text = format!("<scene version=\"3.0.0\">\n{text}</scene>");
        assert_warned(&load("a.xml", &text), place, &[circle]);
        let shape = "<shape type=\"cube\"><ref id=\"a\"/></shape></scene>";
        assert_warned(&load("a.xml", &text.replace("</scene>", shape)), place, &[circle]);
    };
    let bsdf = |id: &str, class: &str, inner: &str| {
        format!("<bsdf type=\"{class}\" id=\"{id}\"><ref id=\"{inner}\"/></bsdf>\n")
    };
    case(&bsdf("a", "twosided", "a"), ":2:30", "circle: a -> a");
    let two = bsdf("a", "mask", "b") + &bsdf("b", "bumpmap", "a");
    case(&two, ":3:29", "circle: a -> b -> a");
    let nested = "<bsdf type=\"blendbsdf\" id=\"a\"><bsdf type=\"roughconductor\"/>\
                  <bsdf type=\"twosided\">\n<ref id=\"a\"/></bsdf></bsdf>";
    case(nested, ":3:1", "circle: a -> a");
    let alias = bsdf("x", "mask", "a") + "<alias id=\"x\" as=\"a\"/>";
    case(&alias, ":2:26", "circle: a -> a");
}

#[test]
fn mixtures_of_each_other_are_warned_of_at_their_place() {
    let mix = |name: &str, parts: &str| {
        format!(
            "MakeNamedMaterial \"{name}\" \"string type\" \"mix\" \"string materials\" [ {parts} ]\n"
        )
    };
    let metal = "MakeNamedMaterial \"metal\" \"string type\" \"conductor\"\n";
    for last in ["", "Material \"mix\" \"string materials\" [ \"a\" \"b\" ]\nShape \"sphere\"\n"] {
        let own =
            metal.to_owned() + &mix("a", "\"metal\" \"a\"") + &mix("b", "\"metal\" \"metal\"");
        let circles = |text: String, circle: &str| {
            let scene = load("a.pbrt", &(text + last));
            assert_warned(&scene, ":2:1", &[circle]);
            assert_eq!(names(&scene), ["metal"]);
        };
        circles(own, "circle: a -> a");
        let two = metal.to_owned() + &mix("a", "\"b\" \"metal\"") + &mix("b", "\"metal\" \"a\"");
        circles(two, "circle: a -> b -> a");
    }
    // Each of the next twice: a diamond, and no circle.
    let chain: String =
        (0..64).map(|i| mix(&format!("m{i}"), &format!("\"m{0}\" \"m{0}\"", i + 1))).collect();
    let end = metal.replace("metal", "m64");
    assert_eq!(names(&load("a.pbrt", &(chain + &end))), ["m64"]);
}

#[test]
fn nodes_of_shaders_and_values_in_a_circle_are_warned_of() {
    let document = |text: &str| format!("<materialx version=\"1.39\">\n{text}</materialx>");
    let mix = |name: &str, of: &str| {
        format!(
            "<mix name=\"{name}\" type=\"surfaceshader\"><input name=\"fg\" nodename=\"{of}\"/>\
             <input name=\"mix\" value=\"1\"/></mix>\n"
        )
    };
    let warned = |text: &str, circle: &str| {
        let scene = load("a.mtlx", &document(text));
        let start = format!("a.mtlx:2:1: nodes are connected in a circle: {circle};");
        assert!(scene.warnings[0].contains(&start), "{:?}", scene.warnings);
        assert!(scene.materials.is_empty() && scene.ignored.iter().all(|one| !one.understood));
    };
    warned(&(mix("a", "b") + &mix("b", "a")), "a -> b -> a");
    warned(&mix("a", "a"), "a -> a");
    // Through a graph and its interface.
    let through = "<dot name=\"n\"><input name=\"in\" nodegraph=\"g\"/></dot>\
         <nodegraph name=\"g\"><input name=\"i\" nodename=\"n\"/>\
         <dot name=\"m\"><input name=\"in\" interfacename=\"i\"/></dot>\
         <output name=\"o\" nodename=\"m\"/></nodegraph>";
    warned(through, "n -> o -> m -> i -> n");
    // A graph twice in a chain, by different outputs, is no circle.
    let twice = document(
        "<nodegraph name=\"g\"><input name=\"i\" nodename=\"n\"/>\
         <output name=\"o\" interfacename=\"i\"/><constant name=\"c\"><input name=\"value\" value=\"0.5\"/></constant>\
         <output name=\"p\" nodename=\"c\"/></nodegraph>\
         <dot name=\"n\"><input name=\"in\" nodegraph=\"g\" output=\"p\"/></dot>\
         <standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"specular_roughness\" nodegraph=\"g\" output=\"o\"/>\
         </standard_surface>",
    );
    assert_eq!(load("a.mtlx", &twice).materials[0].lobe.roughness, crate::isotropic(0.25));
}

#[test]
fn pbrt_scenes_that_would_fill_the_memory_are_refused() {
    let refused = |text: &str, part: &str| {
        let folder = Folder::new(&[("a.pbrt", text)]);
        let message = soon_refused(&folder, "a.pbrt");
        assert!(message.contains("a.pbrt:") && message.contains(part), "{message}");
    };
    let with = |unit: &str, count: usize| unit.repeat(count);
    refused(&with("AttributeBegin\n", 20_000), "10000 deep");
    refused(&with("Material \"conductor\"\n", 100_001), "100000 materials");
    let named: String = (0..100_001).map(|i| format!("NamedMaterial \"{i}\"\n")).collect();
    refused(&named, "100000 materials");
    let textures: String =
        (0..100_001).map(|i| format!("Texture \"{i}\" \"float\" \"constant\"\n")).collect();
    refused(&textures, "100000 textures");
    refused(&format!("Material \"hair\" {}", with("\"float a\" 1 ", 65)), "64 parameters");
    let attributes: String =
        (0..65).map(|i| format!("Attribute \"material\" \"float a{i}\" 1\n")).collect();
    refused(&attributes, "64 attributes");
    let long = format!("Material \"hair\" \"string s\" \"{}\"\n", "x".repeat(4000));
    refused(&with(&long, 5000), "16 MiB of parameters");
    // Blocks copy the attributes in force, and share them.
    let values = format!("\"{}\" ", "x".repeat(4000)).repeat(16);
    let attributes: String =
        (0..64).map(|i| format!("Attribute \"material\" \"string a{i}\" [ {values}]\n")).collect();
    let blocks = "AttributeBegin Material \"conductor\" AttributeEnd\n".repeat(20_000);
    assert_eq!(load("a.pbrt", &(attributes + &blocks)).materials.len(), 20_000);
}

#[test]
fn gltf_scenes_that_would_fill_the_memory_are_refused() {
    for list in ["materials", "textures", "images", "buffers"] {
        let elements = "{},".repeat(1_100_000);
        let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"{list}\":[{elements}{{}}]}}");
        assert_soon_refused("a.gltf", &text, &["a.gltf:1", "more than 1048576 elements"]);
    }
    // For each of the materials it is said why the texture cannot be read, which quotes it.
    let mut materials =
        "{\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0}}},".repeat(99_999);
    materials.push_str("{}");
    let source = "x".repeat(16 << 20);
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"materials\":[{materials}],\
         \"textures\":[{{\"source\":\"{source}\"}}]}}"
    );
    assert_eq!(soon_loaded("a.gltf", &text).warnings.len(), 1);
    let materials = "{},".repeat(100_000);
    let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"materials\":[{materials}{{}}]}}");
    assert_soon_refused("a.gltf", &text, &["a.gltf", "more than 100000 materials"]);
    let container = [&b"glTF\x02\0\0\0\0\0\0\0\xff\xff\xff\xffJSON"[..], &[b' '; 99]].concat();
    let message = soon_refused(&Folder::new(&[("a.glb", container)]), "a.glb");
    assert!(message.contains("4294967295 bytes") && message.contains("128 MiB"), "{message}");
}

#[test]
fn recipes_that_would_take_hours_are_refused() {
    let entry = |i: usize, rest: &str| format!("[[material]]\nname = \"{i}\"\n{rest}\n");
    // The parser takes 80 times the memory of a material.
    let ones = "1,".repeat(5 << 20);
    let long = [entry(0, "sigma = 1\ngamma = 3"), entry(1, &format!("theta = [{ones}]"))].concat();
    assert_refused("a.toml", &long, ":5:1", &["10485795 bytes", "at most 8 MiB"]);
    let blank = "\n".repeat((64 << 20) + 1);
    assert_soon_refused("a.toml", &blank, &["a.toml", "at most 64 MiB"]);
    let gtr = "distribution = \"gtr\"\nc = 0.2\ngamma = 1.5";
    let many: String = (0..1001).map(|i| entry(i, gtr)).collect();
    assert_refused("a.toml", &many, ":5003:16", &["more than 1000", "distribution"]);
}

/// A name stands in every lobe of its material.
#[test]
fn names_longer_than_names_are_refused() {
    let name = "b".repeat(1025);
    let inner = "<bsdf type=\"roughconductor\"/>".repeat(3);
    let text = format!("<scene><bsdf type=\"twosided\" id=\"{name}\">\n{inner}</bsdf></scene>");
    assert_refused("a.xml", &text, ":2:1", &["1025 bytes", "1024"]);
    assert_eq!(load("a.xml", &text.replace(&name, &name[1..])).materials.len(), 3);
}

#[test]
fn a_roughness_that_overflows_is_not_understood() {
    let text = "Texture \"a\" \"float\" \"constant\" \"float value\" 1e308\n\
                Texture \"b\" \"float\" \"scale\" \"texture tex\" \"a\" \"texture scale\" \"a\"\n\
                Material \"conductor\" \"texture roughness\" \"b\"\n";
    let scene = load("a.pbrt", text);
    let name = "conductor at a.pbrt:3";
    assert_not_understood(&scene, name, ":3:1", &["a.pbrt:3:22: ", "[inf, inf]", "finite"]);
    let node = |name: &str, class: &str, a: &str, b: &str| {
        format!(
            "<{class} name=\"{name}\"><input name=\"in1\" {a}/><input name=\"in2\" {b}/></{class}>"
        )
    };
    let huge = "value=\"1e308\"";
    let text = format!(
        "<materialx>\n{}{}<standard_surface name=\"s\" type=\"surfaceshader\">\
         <input name=\"specular_roughness\" nodename=\"nan\"/></standard_surface></materialx>",
        node("inf", "multiply", huge, huge),
        node("nan", "subtract", "nodename=\"inf\"", "nodename=\"inf\""),
    );
    let scene = load("a.mtlx", &text);
    for part in ["a.mtlx:2:", "come to", "finite"] {
        assert!(scene.ignored[0].reason.contains(part), "{}", scene.ignored[0]);
    }
}

/// The suggestion compares names, in time that grows with the square of their length.
#[test]
fn long_words_get_no_suggestion() {
    let (a, b) = ("a".repeat(1 << 20), "b".repeat(1 << 20));
    let text = format!(
        "<scene><texture id=\"{a}\" type=\"bitmap\"/><shape><ref id=\"{b}\"/></shape></scene>"
    );
    let scene = soon_loaded("a.xml", &text);
    let [warning] = &scene.warnings[..] else { panic!("{} warnings", scene.warnings.len()) };
    assert!(warning.contains("nothing has the id") && warning.len() < 2000, "{}", warning.len());
}

/// Every lookup by name is by an index.
#[test]
fn documents_of_many_nodes_take_linear_time() {
    let nodes: String = (0..30_000)
        .map(|i| {
            format!(
                "<standard_surface name=\"s{i}\" type=\"surfaceshader\">\
                 <input name=\"specular_roughness\" nodename=\"z\"/></standard_surface>\
                 <surfacematerial name=\"m{i}\"><input name=\"surfaceshader\" nodename=\"s{i}\"/></surfacematerial>"
            )
        })
        .collect();
    let text = format!(
        "<materialx>{nodes}<constant name=\"z\"><input name=\"value\" value=\"0.5\"/></constant></materialx>"
    );
    let start = Instant::now();
    let scene = load("a.mtlx", &text);
    assert!(scene.materials.len() == 30_000 && scene.materials[29_999].name == "m29999");
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}

/// A scene may have very many of what is not understood, each with a long text.
#[test]
fn what_is_not_understood_is_bounded() {
    // Suggestions for 20 000 names among 10 000.
    let (near, far) = ("n".repeat(20), "f".repeat(20));
    let named: String = (0..10_000)
        .map(|i| format!("MakeNamedMaterial \"{near}{i}\" \"string type\" \"hair\"\n"))
        .collect();
    let lost: String = (0..20_000).map(|i| format!("NamedMaterial \"{far}{i}\"\n")).collect();
    let scene = soon_loaded("a.pbrt", &(named + &lost));
    assert_eq!(scene.warnings.len(), 10_001);
    assert!(scene.warnings[10_000].contains("further warnings are not listed"));
    // One long value that very many materials quote.
    let long = "x".repeat(4000);
    let texture = format!("Texture \"t\" \"float\" \"constant\" \"float value\" \"{long}\"\n");
    let materials = "Material \"conductor\" \"texture roughness\" \"t\"\n".repeat(20_000);
    let scene = soon_loaded("a.pbrt", &(texture + &materials));
    assert_eq!(scene.ignored.len(), 20_000);
    assert!(scene.ignored.iter().all(|ignored| ignored.reason.len() < 1100));
    // References to nothing.
    let lost: String = (0..100_000).map(|i| format!("<ref id=\"{far}{i}\"/>")).collect();
    let text = format!("<scene><shape type=\"cube\">{lost}</shape></scene>");
    assert_eq!(soon_loaded("a.xml", &text).warnings.len(), 10_001);
}

/// Each of them may be told the names that are known.
#[test]
fn unknown_names_are_bounded() {
    let members: String = (0..1_000_000).map(|i| format!("\"a{i}\":0,")).collect();
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"materials\":[{{{members}\"name\":\"m\"}}]}}"
    );
    assert_eq!(soon_loaded("a.gltf", &text).warnings.len(), 100);
    let inputs = |word: &str| {
        (0..100_000).map(|i| format!("<input name=\"{word}{i}\"/>")).collect::<String>()
    };
    let text = format!(
        "<materialx><nodedef name=\"d\" node=\"n\">{}</nodedef><n type=\"float\">{}</n></materialx>",
        inputs("known"),
        inputs("other")
    );
    assert_eq!(soon_loaded("a.mtlx", &text).warnings.len(), 10_001);
    let properties: String =
        (0..100_000).map(|i| format!("<float name=\"a{i}\" value=\"1\"/>")).collect();
    let text = format!("<scene><bsdf type=\"conductor\">{properties}</bsdf></scene>");
    assert_eq!(soon_loaded("a.xml", &text).warnings.len(), 10_001);
}
