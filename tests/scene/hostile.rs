//! Damaged scenes: every one must be read or refused, without a panic and soon.

#[cfg(target_os = "linux")]
use std::fs::{self, File};
use std::time::{Duration, Instant};

use proptest::prelude::*;

use microfacet_baker::scene::{Scene, SceneError};

use crate::{
    Folder, assert_not_understood, assert_refused, assert_says, assert_warned, load, names,
};

const SCENES: [(&str, &str); 5] = [
    (
        "a.toml",
        "[[material]]\nname = 'a'\nsigma = [{ min = 0.1, max = 0.2 }, 0.3]\ngamma = 'inf'\n\
         fresnel = { conductor = { eta = [0.2, 0.9, 1.1], k = [3.9, 2.4, 2.2] } }\n\
         masking = 'uncorrelated'\n",
    ),
    (
        "a.pbrt",
        "Texture 't' 'float' 'scale' 'float scale' 0.5 # half\nAttributeBegin\n\
         Material 'coatedconductor' 'texture interface.roughness' [ 't' ] 'rgb conductor.eta' [ 1 2 3 ]\n\
         Shape 'trianglemesh' 'point3 P' [ 0 0 0  1 0 0 ]\nAttributeEnd\nInclude 'b.pbrt'\n",
    ),
    (
        "a.xml",
        "<scene version='3.0.0'><default name='r' value='0.3'/><include filename='b.xml'/>\
         <bsdf type='twosided' id='a'><bsdf type='principled'><float name='roughness' value='$r'/>\
         <ref name='anisotropic' id='t'/></bsdf></bsdf><texture type='checkerboard' id='t'/>\
         <shape type='cube'><ref id='a'/></shape></scene>",
    ),
    (
        "a.gltf",
        "{'asset': {'version': '2.0'}, 'materials': [{'pbrMetallicRoughness': {'roughnessFactor': 0.5, \
         'metallicRoughnessTexture': {'index': 0}}, 'extensions': {'KHR_materials_clearcoat': \
         {'clearcoatFactor': 1}}}], 'textures': [{'source': 0}], 'images': [{'bufferView': 0}], \
         'bufferViews': [{'buffer': 0, 'byteOffset': 3, 'byteLength': 9}], 'buffers': [{'uri': \
         'data:x;base64,AAAA'}]}",
    ),
    (
        "a.mtlx",
        "<materialx version='1.39'><nodegraph name='G'><mix name='m'><input name='fg' value='0.3'/>\
         <input name='mix' interfacename='x'/></mix><input name='x' value='0.5, 1'/>\
         <output name='o' nodename='m'/></nodegraph><standard_surface name='s' type='surfaceshader'>\
         <input name='specular_roughness' nodegraph='G' output='o'/></standard_surface></materialx>",
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

/// What a file gives, which must come soon.
#[track_caller]
fn soon(folder: &Folder, name: &str) -> Result<Scene, SceneError> {
    let start = Instant::now();
    let read = folder.load(name);
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}: {read:?}", start.elapsed());
    read
}

/// The scene in one file, which must be read soon.
#[track_caller]
fn soon_loaded(name: &str, text: &str) -> Scene {
    soon(&Folder::new(&[(name, text)]), name).unwrap()
}

/// Checks that the file is refused soon, with a message that holds all of `parts`.
#[track_caller]
fn assert_soon_refused(folder: &Folder, name: &str, parts: &[&str]) {
    assert_says(&soon(folder, name).unwrap_err().to_string(), parts);
}

/// The text of many numbered parts.
fn many(count: usize, part: impl Fn(usize) -> String) -> String {
    (0..count).map(part).collect()
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
fn devices_fifos_and_files_without_end_are_refused() {
    let scenes = [
        ("a.pbrt", "Include 'odd'\n"),
        ("a.xml", "<scene><include filename='odd'/></scene>"),
        ("a.mtlx", "<materialx><include href='odd'/></materialx>"),
        ("a.toml", "[[material]]\nname = 'a'\ndistribution = { measured = 'odd' }\n"),
    ];
    for (folder, what) in odd_files() {
        for name in ["b.toml", "b.pbrt", "b.pbrt.gz", "b.xml", "b.gltf", "b.glb", "b.mtlx"] {
            fs::rename(folder.path("odd"), folder.path(name)).unwrap();
            assert_soon_refused(&folder, name, &[name, what]);
            fs::rename(folder.path(name), folder.path("odd")).unwrap();
        }
        for (name, text) in scenes {
            folder.write(name, text);
            assert_soon_refused(&folder, name, &["odd", what]);
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn devices_fifos_and_files_without_end_are_no_images() {
    let gltf = |image: &str| {
        format!(
            "{{'asset': {{'version': '2.0'}}, 'materials': [{{'pbrMetallicRoughness': \
             {{'metallicRoughnessTexture': {{'index': 0}}}}}}], 'textures': [{{'source': 0}}], {image}}}"
        )
    };
    let view = "'images': [{'bufferView': 0}], 'buffers': [{'uri': 'odd'}], \
                'bufferViews': [{'buffer': 0, 'byteLength': 5000000000}]";
    let pbrt = "Texture 't' 'float' 'imagemap' 'string filename' 'odd'\n\
                Material 'conductor' 'texture roughness' 't'\n";
    for (folder, _) in odd_files() {
        for (name, text) in [
            ("a.pbrt", pbrt.to_owned()),
            ("a.gltf", gltf("'images': [{'uri': 'odd'}]")),
            ("b.gltf", gltf(view)),
        ] {
            folder.write(name, text);
            assert_says(&soon(&folder, name).unwrap().warnings[0], &["assumed to cover [0, 1]"]);
        }
    }
}

#[test]
fn files_that_include_the_next_twice_are_refused() {
    for (extension, twice, last) in [
        ("pbrt", "Include 'NEXT'\nInclude 'NEXT'\n", ""),
        ("xml", "<scene><include filename='NEXT'/><include filename='NEXT'/></scene>", "<scene/>"),
        (
            "mtlx",
            "<materialx><include href='NEXT'/><include href='NEXT'/></materialx>",
            "<materialx/>",
        ),
    ] {
        let name = |i: usize| format!("{i}.{extension}");
        let folder = Folder::new::<&str>(&[]);
        for i in 0..31 {
            let text = if i < 30 { twice.replace("NEXT", &name(i + 1)) } else { last.to_owned() };
            folder.write(&name(i), text);
        }
        let place = format!(".{extension}:");
        assert_soon_refused(&folder, &name(0), &["more than 10000 times", &place]);
    }
}

#[test]
fn parameters_that_double_are_refused() {
    let double = |i: usize| format!("<default name='a{}' value='$a{i}$a{i}'/>", i + 1);
    let text =
        format!("<scene>\n<default name='a0' value='xxxxxxxx'/>{}</scene>", many(60, double));
    let folder = Folder::new(&[("a.xml", text)]);
    assert_soon_refused(&folder, "a.xml", &["a.xml:2:", "more than 128 MiB"]);

    let text = format!("<scene>{}</scene>", many(65, |i| format!("<path value='n{i}'/>\n")));
    assert_warned(&load("a.xml", &text), ":65:1", &["more than 64 <path>", "it is left out"]);
    let name = "n".repeat(65);
    let text = format!("<scene>\n<default name='{name}' value='1'/></scene>");
    assert_warned(&load("a.xml", &text), ":2:1", &["more than 64 bytes", "it is left out"]);
}

#[test]
fn very_many_elements_and_attributes_are_refused() {
    let parts = ["a.xml:1:", "3145728 elements and attributes"];
    for many in ["<a/>".repeat(3_200_000), "<a b='' c=''/>".repeat(1_100_000)] {
        let text = format!("<scene>{many}</scene>");
        assert_soon_refused(&Folder::new(&[("a.xml", text)]), "a.xml", &parts);
    }
    let attributes = many(300_000, |i| format!(" a{i}=''"));
    let spaces = many(100_000, |i| format!(" xmlns:a{i}='b'"));
    let text = format!("<scene>\n<a{attributes}/><a{spaces}><a/></a></scene>");
    assert_eq!(soon_loaded("a.xml", &text).materials, []);
    // Together, by files that are small enough.
    let whole = format!("<scene>\n{}</scene>", "<include filename='b.xml'/>".repeat(4));
    let load = |part: String, parts: &[&str]| {
        let folder =
            Folder::new(&[("a.xml", &whole), ("b.xml", &format!("<scene>{part}</scene>"))]);
        assert_soon_refused(&folder, "a.xml", parts);
    };
    load("<a/>".repeat(900_000), &["3145728 elements"]);
    load(format!("<!--{}-->", " ".repeat(40_000_000)), &["a.xml:2:", "128 MiB"]);
}

/// Each of them stands for itself.
#[test]
fn very_many_ampersands_and_tokens_are_read() {
    for many in ["&", "&#1", "<a>"] {
        let count = (20 << 20) / many.len();
        let text = format!("<materialx>\n<a b='{}'/></materialx>", many.repeat(count));
        assert_eq!(soon_loaded("a.mtlx", &text).materials, []);
    }
    let text = format!("<materialx a='{}&#{}'/>", "&".repeat(200_000), "1".repeat(1 << 20));
    assert_eq!(soon_loaded("a.mtlx", &text).materials, []);
}

/// Each file is nested no deeper than it may be, and all of them together very deep.
#[test]
fn includes_do_not_add_to_the_nesting() {
    let folder = Folder::new::<&str>(&[]);
    for i in 0..60 {
        let include = format!("<include filename='{}.xml'/>", i + 1);
        let inner = if i < 59 { include } else { String::new() };
        let text = format!("<scene>{}{inner}{}</scene>", "<a>".repeat(120), "</a>".repeat(120));
        folder.write(&format!("{i}.xml"), text);
    }
    assert_soon_refused(&folder, "0.xml", &["nested more than 256 deep"]);
    let text = format!("<scene>\n{}", "<a>".repeat(256));
    assert_refused("a.xml", &text, ":2:766", &["nested more than 256 deep"]);
    let twosided = "<bsdf type='twosided'>".repeat(254) + "<bsdf type='roughconductor'/>";
    let scene = load("a.xml", &format!("<scene>{twosided}{}</scene>", "</bsdf>".repeat(254)));
    assert_eq!(scene.materials.len(), 1);
}

#[test]
fn long_chains_of_references_take_no_stack() {
    let link = |i: usize| format!("<bsdf type='mask' id='b{i}'><ref id='b{}'/></bsdf>", i + 1);
    let text = format!(
        "<scene>{}<bsdf type='roughconductor' id='b100000'/>\
         <shape type='cube'><ref id='b0'/></shape></scene>",
        many(100_000, link)
    );
    let scene = load("a.xml", &text);
    assert!(scene.materials[0].used && scene.materials.len() == 1);
}

/// Each of the next twice: a diamond, and no circle.
#[test]
fn mixtures_of_one_mixture_twice_are_followed_once() {
    let mix = |i: usize| {
        let next = i + 1;
        format!(
            "MakeNamedMaterial 'm{i}' 'string type' 'mix' 'string materials' [ 'm{next}' 'm{next}' ]\n"
        )
    };
    let end = "MakeNamedMaterial 'm64' 'string type' 'conductor'\n";
    assert_eq!(names(&load("a.pbrt", &(many(64, mix) + end))), ["m64"]);
}

#[test]
fn pbrt_scenes_that_would_fill_the_memory_are_refused() {
    let long = format!("Material 'hair' 'string s' '{}'\n", "x".repeat(4000));
    for (text, part) in [
        ("AttributeBegin\n".repeat(100_001), "100000 blocks"),
        ("Material 'conductor'\n".repeat(100_001), "100000 materials"),
        (many(100_001, |i| format!("NamedMaterial '{i}'\n")), "100000 materials"),
        (many(100_001, |i| format!("Texture '{i}' 'float' 'constant'\n")), "100000 textures"),
        (format!("Material 'hair' {}", "'float a' 1 ".repeat(65)), "64 parameters"),
        (many(65, |i| format!("Attribute 'material' 'float a{i}' 1\n")), "64 attributes"),
        (long.repeat(5000), "16 MiB of parameters"),
    ] {
        assert_soon_refused(&Folder::new(&[("a.pbrt", text)]), "a.pbrt", &["a.pbrt:", part]);
    }
    // Blocks copy the attributes in force, and share them.
    let values = format!("'{}' ", "x".repeat(4000)).repeat(16);
    let attributes = many(64, |i| format!("Attribute 'material' 'string a{i}' [ {values}]\n"));
    let blocks = "AttributeBegin Material 'conductor' AttributeEnd\n".repeat(20_000);
    assert_eq!(load("a.pbrt", &(attributes + &blocks)).materials.len(), 20_000);
}

#[test]
fn gltf_scenes_that_would_fill_the_memory_are_refused() {
    let document = |rest: &str| format!("{{'asset':{{'version':'2.0'}},{rest}}}");
    let refused = |rest: &str, parts: &[&str]| {
        assert_soon_refused(&Folder::new(&[("a.gltf", document(rest))]), "a.gltf", parts);
    };
    let elements = "{},".repeat(1_100_000);
    for list in ["materials", "textures", "images", "bufferViews", "buffers", "meshes"] {
        let part = format!("{list}: there are more than 1048576 elements");
        refused(&format!("'{list}':[{elements}{{}}]"), &["a.gltf", &part]);
    }
    refused(&format!("'meshes':[{}0]", "0,".repeat(30_000_000)), &["meshes", "1048576 elements"]);
    refused(&format!("'materials':[{}{{}}]", &elements[..300_000]), &["100000 materials"]);
    let members = many(1_100_000, |i| format!("'{i}':0,"));
    refused(&format!("'materials':[{{{members}'a':0}}]"), &["more than 1048576 members"]);
    let primitives = format!("'meshes':[{{'primitives':[{elements}{{}}]}}]");
    let scene = soon_loaded("a.gltf", &document(&primitives));
    assert_warned(&scene, "a.gltf", &["mesh 0", "primitives: ", "more than 1048576 elements"]);
    // For each of the materials it is said why the texture cannot be read, which quotes it.
    let material = "{'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}},";
    let materials = format!("'materials':[{}{{}}]", material.repeat(99_999));
    let textures = format!("'textures':[{{'source':'{}'}}]", "x".repeat(16 << 20));
    let scene = soon_loaded("a.gltf", &document(&format!("{materials},{textures}")));
    assert_eq!(scene.warnings.len(), 1);
    let container = [&b"glTF\x02\0\0\0\0\0\0\0\xff\xff\xff\xffJSON"[..], &[b' '; 99]].concat();
    let folder = Folder::new(&[("a.glb", container)]);
    assert_soon_refused(&folder, "a.glb", &["4294967295 bytes", "128 MiB"]);
}

#[test]
fn recipes_that_would_take_hours_are_refused() {
    let entry = |i: usize, rest: &str| format!("[[material]]\nname = \"{i}\"\n{rest}\n");
    // The parser takes 80 times the memory of a material.
    let ones = "1,".repeat(5 << 20);
    let long = [entry(0, "sigma = 1\ngamma = 3"), entry(1, &format!("theta = [{ones}]"))].concat();
    assert_refused("a.toml", &long, ":5:1", &["10485795 bytes", "at most 8 MiB"]);
    let blank = Folder::new(&[("a.toml", "\n".repeat((64 << 20) + 1))]);
    assert_soon_refused(&blank, "a.toml", &["a.toml", "at most 64 MiB"]);
    let gtr = many(1001, |i| entry(i, "distribution = \"gtr\"\nc = 0.2\ngamma = 1.5"));
    assert_refused("a.toml", &gtr, ":5003:16", &["more than 1000", "distribution"]);
}

/// A name stands in every lobe of its material.
#[test]
fn names_longer_than_names_are_shortened() {
    let name = "b".repeat(1025);
    let inner = "<bsdf type='roughconductor'/>".repeat(3);
    let scene = |name: &str| {
        let text = format!("<scene><bsdf type='twosided' id='{name}'>\n{inner}</bsdf></scene>");
        load("a.xml", &text)
    };
    let short = format!("{} ...", &name[1..]);
    let numbered = [2, 3].map(|number| format!("{short} ({number})"));
    assert_eq!(names(&scene(&name)), [&short, &numbered[0], &numbered[1]]);
    assert_eq!(names(&scene(&name[1..]))[0], &name[1..]);
}

#[test]
fn a_roughness_that_overflows_is_not_understood() {
    let text = "Texture 'a' 'float' 'constant' 'float value' 1e308\n\
                Texture 'b' 'float' 'scale' 'texture tex' 'a' 'texture scale' 'a'\n\
                Material 'conductor' 'texture roughness' 'b'\n";
    let scene = load("a.pbrt", text);
    let name = "conductor at a.pbrt:3";
    assert_not_understood(&scene, name, ":3:1", &["a.pbrt:3:22: ", "[inf, inf]", "finite"]);
    let node = |name: &str, class: &str, ends: &str| {
        format!(
            "<{class} name='{name}'><input name='in1' {ends}/><input name='in2' {ends}/></{class}>"
        )
    };
    let text = format!(
        "<materialx>\n{}{}<standard_surface name='s' type='surfaceshader'>\
         <input name='specular_roughness' nodename='nan'/></standard_surface></materialx>",
        node("inf", "multiply", "value='1e308'"),
        node("nan", "subtract", "nodename='inf'"),
    );
    let scene = load("a.mtlx", &text);
    assert_says(&scene.ignored[0].reason, &["a.mtlx:2:", "come to", "finite"]);
}

/// The suggestion compares names, in time that grows with the square of their length.
#[test]
fn long_words_get_no_suggestion() {
    let (a, b) = ("a".repeat(1 << 20), "b".repeat(1 << 20));
    let text =
        format!("<scene><texture id='{a}' type='bitmap'/><shape><ref id='{b}'/></shape></scene>");
    let scene = soon_loaded("a.xml", &text);
    let [warning] = &scene.warnings[..] else { panic!("{} warnings", scene.warnings.len()) };
    assert!(warning.contains("nothing has the id") && warning.len() < 2000, "{}", warning.len());
}

/// It is read once for all of them.
#[test]
fn many_textures_of_one_large_image_are_read_soon() {
    let material =
        |i| format!("{{'pbrMetallicRoughness':{{'metallicRoughnessTexture':{{'index':{i}}}}}}},");
    let (materials, textures) = (many(2000, material), "{'source':0},".repeat(2000));
    for (start, warnings) in [("data:image/png;base64,", 2000), ("", 1)] {
        let uri = start.to_owned() + &"A".repeat(60 << 20);
        let text = format!(
            "{{'asset':{{'version':'2.0'}},'materials':[{materials}{{}}],\
             'textures':[{textures}{{}}],'images':[{{'uri':'{uri}'}}]}}"
        );
        let scene = soon_loaded("a.gltf", &text);
        assert_eq!((scene.materials.len(), scene.warnings.len()), (2001, warnings));
    }
}

/// A message may quote the scene.
#[test]
fn messages_have_a_length() {
    let long = "x".repeat(1 << 20);
    for (text, part) in [
        (format!("{{'asset':{{'version':'{long}'}}}}"), "only version 2 is read"),
        (format!("{{'asset':{{'version':'2.0'}},'meshes':'{long}'}}"), "meshes: invalid type"),
        (format!("{{'{long}':0,'{long}':1}}"), "a second member"),
    ] {
        let error = soon(&Folder::new(&[("a.gltf", text)]), "a.gltf").unwrap_err().to_string();
        assert!(error.contains(part) && error.len() < 2000, "{} bytes, no {part}", error.len());
    }
}

/// Every lookup by name is by an index.
#[test]
fn documents_of_many_nodes_take_linear_time() {
    let nodes = many(30_000, |i| {
        format!(
            "<standard_surface name='s{i}' type='surfaceshader'>\
             <input name='specular_roughness' nodename='z'/></standard_surface>\
             <surfacematerial name='m{i}'><input name='surfaceshader' nodename='s{i}'/></surfacematerial>"
        )
    });
    let end = "<constant name='z'><input name='value' value='0.5'/></constant>";
    let scene = soon_loaded("a.mtlx", &format!("<materialx>{nodes}{end}</materialx>"));
    assert!(scene.materials.len() == 30_000 && scene.materials[29_999].name == "m29999");
}

/// A scene may have very many of what is not understood, each with a long text, and each of them
/// may be told the names that are known.
#[test]
fn what_is_not_understood_is_bounded() {
    // Suggestions for 20 000 names among 10 000.
    let (near, far) = ("n".repeat(20), "f".repeat(20));
    let named = many(10_000, |i| format!("MakeNamedMaterial '{near}{i}' 'string type' 'hair'\n"));
    let lost = many(20_000, |i| format!("NamedMaterial '{far}{i}'\n"));
    let scene = soon_loaded("a.pbrt", &(named + &lost));
    assert_eq!(scene.warnings.len(), 10_001);
    assert!(scene.warnings[10_000].contains("further warnings are not listed"));
    // One long value that very many materials quote.
    let long = "x".repeat(4000);
    let texture = format!("Texture 't' 'float' 'constant' 'float value' '{long}'\n");
    let materials = "Material 'conductor' 'texture roughness' 't'\n".repeat(20_000);
    let scene = soon_loaded("a.pbrt", &(texture + &materials));
    assert_eq!(scene.ignored.len(), 20_000);
    assert!(scene.ignored.iter().all(|ignored| ignored.reason.len() < 1100));
    // References to nothing, and members, inputs and properties that nothing has.
    let refs = many(100_000, |i| format!("<ref id='{far}{i}'/>"));
    let gltf = |materials: &str| {
        format!("{{'asset':{{'version':'2.0'}},'materials':[{materials}{{'name':'m'}}]}}")
    };
    let members = |count: usize| many(count, |i| format!("'a{i}':0,"));
    // Of one material a hundred are warned of.
    let one = soon_loaded("a.gltf", &gltf(&format!("{{{}'b':0}},", members(1_000_000))));
    assert_eq!(one.warnings.len(), 100);
    let each = format!("{}'b':0", members(100));
    let inputs = |word: &str| many(100_000, |i| format!("<input name='{word}{i}'/>"));
    let (known, other) = (inputs("known"), inputs("other"));
    let properties = many(100_000, |i| format!("<float name='a{i}' value='1'/>"));
    for (name, text) in [
        ("a.xml", format!("<scene><shape type='cube'>{refs}</shape></scene>")),
        ("a.gltf", gltf(&format!("{{{each}}},").repeat(1000))),
        (
            "a.mtlx",
            format!(
                "<materialx><nodedef name='d' node='n'>{known}</nodedef>\
                 <n type='float'>{other}</n></materialx>"
            ),
        ),
        ("a.xml", format!("<scene><bsdf type='conductor'>{properties}</bsdf></scene>")),
    ] {
        assert_eq!(soon_loaded(name, &text).warnings.len(), 10_001, "{name}");
    }
}
