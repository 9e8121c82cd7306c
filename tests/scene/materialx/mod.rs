//! MaterialX documents.

mod bsdfs;
mod documents;
mod models;

use microfacet_baker::scene::{Format, Reflectance, Roughness, Scene};
use microfacet_tables::Interval;

use crate::{Folder, anisotropic, assert_close, assert_refused, isotropic, load, names, png};

fn document(content: &str) -> String {
    format!("<materialx version=\"1.39\">{content}</materialx>")
}

fn shader(class: &str, inputs: &[(&str, f64)]) -> Scene {
    let inputs: String = inputs
        .iter()
        .map(|(name, value)| format!("<input name=\"{name}\" type=\"float\" value=\"{value}\"/>"))
        .collect();
    let text = format!("<{class} name=\"a\" type=\"surfaceshader\">{inputs}</{class}>");
    load("a.mtlx", &document(&text))
}

#[test]
fn standard_surface_follows_its_definition() {
    let default = shader("standard_surface", &[]);
    assert_eq!(names(&default), ["a"]);
    assert_close(default.materials[0].lobe.roughness, [0.04; 2], [0.04; 2]);
    assert_eq!(default.materials[0].lobe.gamma, Interval::point(2.0));
    assert_eq!(default.materials[0].fresnel, Some(Reflectance::dielectric(1.5)));
    assert_eq!(default.materials[0].masking, None);
    assert_eq!(default.materials[0].origin.format, Format::MaterialX);

    let mirror = shader("standard_surface", &[("specular_roughness", 0.0), ("metalness", 1.0)]);
    assert_eq!(mirror.materials[0].lobe.roughness, Roughness::Smooth);

    let brushed =
        shader("standard_surface", &[("specular_roughness", 0.6), ("specular_anisotropy", 0.36)]);
    // aspect = sqrt(1 - 0.36) = 0.8
    assert_close(brushed.materials[0].lobe.roughness, [0.45; 2], [0.288; 2]);
    let extreme =
        shader("standard_surface", &[("specular_roughness", 1.0), ("specular_anisotropy", 1.0)]);
    assert_close(extreme.materials[0].lobe.roughness, [1.0; 2], [0.02f64.sqrt(); 2]);

    let layered = shader(
        "standard_surface",
        &[
            ("specular_roughness", 0.5),
            ("transmission", 1.0),
            ("transmission_extra_roughness", 0.25),
            ("coat", 0.5),
            ("coat_roughness", 0.4),
            ("coat_affect_roughness", 1.0),
            ("sheen", 1.0),
        ],
    );
    assert_eq!(names(&layered), ["a", "a.transmission", "a.coat"]);
    let roughness = |i: usize, r: f64| {
        assert_close(layered.materials[i].lobe.roughness, [r * r; 2], [r * r; 2])
    };
    // The coat roughens by t = 0.5 * 0.4 * 1 = 0.2.
    roughness(0, 0.5 + 0.5 * 0.2);
    roughness(1, 0.75 + 0.25 * 0.2);
    roughness(2, 0.4);
    assert_eq!(layered.ignored[0].name, "a.sheen");

    let diffuse = shader("standard_surface", &[("specular", 0.0)]);
    assert_eq!(diffuse.materials, []);
    assert_eq!(diffuse.ignored.len(), 1);
}

#[test]
fn open_pbr_surface_follows_its_definition() {
    let default = shader("open_pbr_surface", &[]);
    assert_close(default.materials[0].lobe.roughness, [0.09; 2], [0.09; 2]);
    assert_eq!(default.materials[0].fresnel, Some(Reflectance::dielectric(1.5)));

    let brushed = shader(
        "open_pbr_surface",
        &[("specular_roughness", 0.5), ("specular_roughness_anisotropy", 0.5)],
    );
    // sqrt(2 / (1 + 0.25))
    let along = 0.25 * 1.6f64.sqrt();
    assert_close(brushed.materials[0].lobe.roughness, [along; 2], [0.5 * along; 2]);
    let line = shader(
        "open_pbr_surface",
        &[("specular_roughness", 0.5), ("specular_roughness_anisotropy", 1.0)],
    );
    assert_close(line.materials[0].lobe.roughness, [0.25 * 2f64.sqrt(); 2], [1e-8; 2]);

    let coated = shader(
        "open_pbr_surface",
        &[
            ("specular_roughness", 0.5),
            ("coat_weight", 0.5),
            ("coat_roughness", 0.6),
            ("coat_roughness_anisotropy", 0.5),
            ("fuzz_weight", 0.1),
        ],
    );
    assert_eq!(names(&coated), ["a", "a.coat"]);
    // (0.5^4 + 2 * 0.6^4)^(1/4), mixed half and half with 0.5
    let r = 0.5 * 0.5 + 0.5 * 0.3217f64.powf(0.25);
    assert_close(coated.materials[0].lobe.roughness, [r * r; 2], [r * r; 2]);
    assert_eq!(coated.materials[0].fresnel, None, "relative to the coat");
    let along = 0.36 * 1.6f64.sqrt();
    assert_close(coated.materials[1].lobe.roughness, [along; 2], [0.5 * along; 2]);
    assert_eq!(coated.materials[1].fresnel, Some(Reflectance::dielectric(1.6)));
    assert_eq!(coated.ignored[0].name, "a.fuzz_weight");
}

#[test]
fn materials_name_shaders_and_looks_use_them() {
    let text = document(
        r#"
        <standard_surface name="SR_gold" type="surfaceshader"/>
        <open_pbr_surface name="SR_shared" type="surfaceshader"/>
        <gltf_pbr name="SR_other" type="surfaceshader"/>
        <surfacematerial name="gold" type="material">
            <input name="surfaceshader" type="surfaceshader" nodename="SR_gold"/>
        </surfacematerial>
        <surfacematerial name="one" type="material">
            <input name="surfaceshader" type="surfaceshader" nodename="SR_shared"/>
        </surfacematerial>
        <surfacematerial name="two" type="material">
            <input name="surfaceshader" type="surfaceshader" nodename="SR_shared"/>
        </surfacematerial>
        <nodegraph name="NG_definition" nodedef="ND_x">
            <standard_surface name="inner" type="surfaceshader"/>
        </nodegraph>
        <look name="L"><materialassign name="m" material="two" geom="*"/></look>
        "#,
    );
    let scene = load("a.mtlx", &text);
    let used: Vec<_> = scene.materials.iter().map(|m| (&m.name[..], m.used)).collect();
    assert_eq!(used, [("gold", false), ("one", false), ("two", true), ("SR_other", false)]);

    let without_look = text.replace("materialassign", "other");
    assert!(load("a.mtlx", &without_look).materials.iter().all(|m| m.used));

    let old = r#"<material name="m"><shaderref name="s" node="standard_surface"/></material>"#;
    let old = load("a.mtlx", &document(old));
    let [ignored] = &old.ignored[..] else { panic!("{:?}", old.ignored) };
    assert!(ignored.reason.contains("before 1.38; upgrade") && !ignored.understood);
}

/// A shader whose roughness comes from the output "o" of a graph.
fn graph(nodes: &str) -> String {
    document(&format!(
        r#"<nodegraph name="G" fileprefix="maps/"><input name="amount" type="float" value="0.25"/>{nodes}
             <output name="x" type="float" nodename="absent"/><output name="o" type="float" nodename="end"/></nodegraph>
           <open_pbr_surface name="a" type="surfaceshader">
             <input name="specular_roughness" type="float" nodegraph="G" output="o"/></open_pbr_surface>"#
    ))
}

#[test]
fn node_graphs_are_followed() {
    let folder = Folder::new(&[("a.png", png())]);
    std::fs::create_dir(folder.path("maps")).unwrap();
    std::fs::rename(folder.path("a.png"), folder.path("maps/a.png")).unwrap();
    let check = |nodes: &str, r: [f64; 2]| {
        std::fs::write(folder.path("a.mtlx"), graph(nodes)).unwrap();
        let scene = folder.load("a.mtlx").unwrap();
        assert_eq!(scene.warnings, [""; 0]);
        let alpha = r.map(|r| r * r);
        assert_close(scene.materials[0].lobe.roughness, alpha, alpha);
    };
    let image = r#"<image name="i" type="float"><input name="file" type="filename" value="a.png"/></image>"#;
    let colour = r#"<tiledimage name="i" type="color3"><input name="file" type="filename" value="a.png" colorspace="lin_rec709"/></tiledimage>"#;
    let node =
        |tag: &str, inputs: &str| format!("<{tag} name=\"end\" type=\"float\">{inputs}</{tag}>");
    let with = |source: &str, tag: &str, inputs: &str| source.to_owned() + &node(tag, inputs);

    check(&node("constant", r#"<input name="value" type="float" value="0.3"/>"#), [0.3; 2]);
    check(
        &node("constant", r#"<input name="value" type="float" interfacename="amount"/>"#),
        [0.25; 2],
    );
    check(&with(image, "dot", r#"<input name="in" type="float" nodename="i"/>"#), [0.2, 0.4]);
    check(
        &with(
            image,
            "multiply",
            r#"<input name="in1" type="float" nodename="i"/><input name="in2" type="float" value="0.5"/>"#,
        ),
        [0.1, 0.2],
    );
    check(
        &with(
            image,
            "add",
            r#"<input name="in1" type="float" nodename="i"/><input name="in2" type="float" interfacename="amount"/>"#,
        ),
        [0.45, 0.65],
    );
    check(
        &with(
            image,
            "subtract",
            r#"<input name="in1" type="float" value="1"/><input name="in2" type="float" nodename="i"/>"#,
        ),
        [0.6, 0.8],
    );
    check(&with(image, "invert", r#"<input name="in" type="float" nodename="i"/>"#), [0.6, 0.8]);
    check(
        &with(
            image,
            "mix",
            r#"<input name="bg" type="float" value="0.1"/><input name="fg" type="float" value="0.6"/><input name="mix" type="float" nodename="i"/>"#,
        ),
        [0.2, 0.3],
    );
    check(
        &with(
            image,
            "clamp",
            r#"<input name="in" type="float" nodename="i"/><input name="low" type="float" value="0.3"/>"#,
        ),
        [0.3, 0.4],
    );
    check(
        &with(
            image,
            "max",
            r#"<input name="in1" type="float" nodename="i"/><input name="in2" type="float" value="0.3"/>"#,
        ),
        [0.3, 0.4],
    );
    let green = r#"<input name="in" type="color3" nodename="i"/><input name="index" type="integer" value="1"/>"#;
    check(&with(colour, "extract", green), [0.4, 0.8]);
    let separate = colour.to_owned()
        + r#"<separate3 name="s" type="multioutput"><input name="in" type="color3" nodename="i"/></separate3>"#;
    check(
        &with(&separate, "dot", r#"<input name="in" type="float" nodename="s" output="outg"/>"#),
        [0.4, 0.8],
    );
    let decoded = |x: f64| ((x + 0.055) / 1.055f64).powf(2.4);
    let srgb = colour.replace("lin_rec709", "srgb_texture");
    check(&with(&srgb, "extract", green), [decoded(0.4), decoded(0.8)]);
}

#[test]
fn what_a_graph_does_otherwise_is_the_full_range() {
    for (nodes, part) in [
        (r#"<fractal3d name="end" type="float"/>"#, "fractal3d"),
        (
            r#"<image name="end" type="float"><input name="file" value="absent.png"/></image>"#,
            "absent.png",
        ),
        (r#"<image name="end" type="float"/>"#, "names no file"),
    ] {
        let scene = load("a.mtlx", &graph(nodes));
        assert_eq!(scene.materials[0].lobe.roughness, Roughness::Isotropic(Interval::UNIT));
        assert!(scene.warnings[0].contains(part), "{:?}", scene.warnings);
    }
}

#[test]
fn included_documents_belong_to_the_scene() {
    let include = |name: &str| {
        format!(
            "<materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n<xi:include href=\"{name}\"/></materialx>"
        )
    };
    let shader = document("<open_pbr_surface name=\"b\" type=\"surfaceshader\"/>");
    let folder = Folder::new(&[("a.mtlx", include("b.mtlx")), ("b.mtlx", shader)]);
    assert_eq!(names(&folder.load("a.mtlx").unwrap()), ["b"]);

    let missing = load("a.mtlx", &include("b.mtlx"));
    assert!(missing.warnings[0].contains("a.mtlx:2:1: b.mtlx is missing"));

    let circle = Folder::new(&[("a.mtlx", include("a.mtlx"))]);
    let message = circle.load("a.mtlx").unwrap_err().to_string();
    assert!(message.contains("a.mtlx -> a.mtlx"), "{message}");
}

#[test]
fn values_out_of_range_are_moved_and_warned_of() {
    let scene = shader("standard_surface", &[("specular_roughness", 1.5), ("metalness", -1.0)]);
    assert_eq!(scene.materials[0].lobe.roughness, isotropic(1.0));
    assert_eq!(scene.warnings.len(), 2);
    assert!(scene.warnings[0].contains("specular_roughness is 1.5, outside [0, 1]"));
    let both = shader(
        "open_pbr_surface",
        &[("specular_roughness", 0.5), ("specular_roughness_anisotropy", 0.0)],
    );
    assert_ne!(both.materials[0].lobe.roughness, anisotropic(0.25, 0.25));
}

#[test]
fn documents_of_another_grammar_are_refused() {
    assert_refused("a.mtlx", "<scene/>", ":1:1", &["<scene>", "<materialx>"]);
    assert_refused("a.mtlx", "<materialx>\n<a></materialx>", ":2:4", &["a"]);
}

/// The reason why the material "a" of a document is not understood, and that "b" still is.
#[track_caller]
fn not_understood(text: &str, parts: &[&str]) {
    let sound = "<gltf_pbr name=\"b\" type=\"surfaceshader\"/>";
    let scene = load("a.mtlx", &document(&format!("{text}{sound}")));
    assert_eq!(names(&scene), ["b"]);
    let [ignored] = &scene.ignored[..] else { panic!("{:?}", scene.ignored) };
    assert!(ignored.name == "a" && !ignored.understood, "{ignored}");
    for part in parts {
        assert!(ignored.reason.contains(part), "no {part:?} in {}", ignored.reason);
    }
}

#[test]
fn a_broken_material_is_named_at_its_place_and_the_others_are_read() {
    let input = |attributes: &str, parts: &[&str]| {
        let text = format!(
            "<open_pbr_surface name=\"a\" type=\"surfaceshader\">\n<input name=\"specular_roughness\" {attributes}/></open_pbr_surface>"
        );
        not_understood(&text, parts);
    };
    input("value=\"x\"", &["a.mtlx:2:1: specular_roughness", "number", "\"x\""]);
    input("nodename=\"n\"", &[":2:1", "no node \"n\""]);
    input("nodegraph=\"g\"", &[":2:1", "no nodegraph \"g\""]);
    input("interfacename=\"i\"", &[":2:1", "no interface \"i\""]);
    // The failure of one leaves nothing behind for another.
    let twice = "<dot name=\"n\"><input name=\"in\" value=\"x\"/></dot>\
        <surfacematerial name=\"a\"><input name=\"surfaceshader\" nodename=\"s\"/></surfacematerial>\
        <surfacematerial name=\"b\"><input name=\"surfaceshader\" nodename=\"s\"/></surfacematerial>\
        <gltf_pbr name=\"s\" type=\"surfaceshader\"><input name=\"roughness\" nodename=\"n\"/></gltf_pbr>";
    let scene = load("a.mtlx", &document(twice));
    assert_eq!(scene.ignored.len(), 2);
    assert!(scene.ignored.iter().all(|one| one.reason.contains("must be a number")), "{scene:?}");
}

#[test]
fn nodes_in_a_circle_are_warned_of() {
    let circle = graph("\n<dot name=\"end\"><input name=\"in\" nodename=\"end\"/></dot>");
    let scene = load("a.mtlx", &circle);
    assert!(scene.warnings[0].contains("a.mtlx:2:1: nodes are connected in a circle: end -> end"));
    assert!(scene.ignored[0].reason.contains("depends on itself"), "{}", scene.ignored[0]);
}

#[test]
fn a_broken_lobe_leaves_the_others() {
    let rough = |class: &str, inputs: &[(&str, &str)], kept: &[&str], lobe: &str| {
        let inputs: String = inputs
            .iter()
            .map(|(name, value)| {
                format!("<input name=\"{name}\" type=\"float\" value=\"{value}\"/>")
            })
            .collect();
        let text = format!("<{class} name=\"a\" type=\"surfaceshader\">{inputs}</{class}>");
        let scene = load("a.mtlx", &document(&text));
        assert_eq!(names(&scene), kept, "{class}");
        let [ignored] = &scene.ignored[..] else { panic!("{class}: {:?}", scene.ignored) };
        assert!(ignored.name == lobe && !ignored.understood, "{ignored}");
        assert!(ignored.reason.contains("must be a number"), "{ignored}");
    };
    for (class, roughness, coat, of_coat, name) in [
        (
            "open_pbr_surface",
            "specular_roughness",
            "coat_weight",
            "coat_roughness_anisotropy",
            "coat",
        ),
        ("standard_surface", "specular_roughness", "coat", "coat_anisotropy", "coat"),
        ("gltf_pbr", "roughness", "clearcoat", "clearcoat_roughness", "clearcoat"),
        ("UsdPreviewSurface", "roughness", "clearcoat", "clearcoatRoughness", "clearcoat"),
        ("disney_principled", "roughness", "clearcoat", "clearcoatGloss", "clearcoat"),
    ] {
        let coated = format!("a.{name}");
        for bad in ["nan", ""] {
            rough(class, &[(roughness, bad), (coat, "1")], &[&coated], "a");
            rough(class, &[(of_coat, bad), (coat, "1")], &["a"], &coated);
        }
        // Without its weight a coat may be there; a base under it depends on that.
        if name == "clearcoat" {
            rough(class, &[(coat, "x")], &["a"], &coated);
        }
        // What has no weight is not looked at.
        let unused = shader(class, &[(of_coat, f64::NAN)]);
        assert_eq!((names(&unused), unused.ignored.len()), (vec!["a"], 0), "{class}");
    }
    rough("standard_surface", &[("sheen", "x")], &["a"], "a.sheen");
    // The base depends on the coat's roughness only where that affects it.
    let coat = [("coat", "1"), ("coat_roughness", "x")];
    rough("standard_surface", &coat, &["a"], "a.coat");
    rough("standard_surface", &[&coat[..], &[("coat_affect_roughness", "1")]].concat(), &[], "a");
    // Both the reflection and the transmission.
    let glass = [("transmission", "1"), ("transmission_extra_roughness", "0.5")];
    let inputs = [&glass[..], &[("specular_roughness", "x"), ("coat", "1")]].concat();
    rough("standard_surface", &inputs, &["a.coat"], "a");
}

#[test]
fn a_range_is_a_remapping() {
    let check = |inputs: &[(&str, &str)], r: f64| {
        let inputs: String = inputs
            .iter()
            .map(|(name, value)| format!("<input name=\"{name}\" {value}/>"))
            .collect();
        let scene = load("a.mtlx", &graph(&format!("<range name=\"end\">{inputs}</range>")));
        assert_eq!(scene.warnings, [""; 0]);
        assert_close(scene.materials[0].lobe.roughness, [r * r; 2], [r * r; 2]);
    };
    let quarter = ("in", "interfacename=\"amount\"");
    check(&[quarter], 0.25);
    let [low, high] = [("inlow", "value=\"0.2\""), ("inhigh", "value=\"0.4\"")];
    check(&[quarter, low, high], 0.25);
    let [outlow, outhigh] = [("outlow", "value=\"0.2\""), ("outhigh", "value=\"0.6\"")];
    check(&[quarter, low, high, outlow, outhigh], 0.3);
    let gamma = ("gamma", "value=\"2\"");
    check(&[quarter, gamma, outlow, outhigh], 0.4);
    // (0.25 - 0.5) / 1 keeps its sign: -sqrt(0.25) = -0.5.
    let [low, high] = [("inlow", "value=\"0.5\""), ("inhigh", "value=\"1.5\"")];
    check(&[quarter, low, high, gamma, ("outlow", "value=\"0.6\"")], 0.4);
    let [yes, no] = [("doclamp", "value=\"true\""), ("doclamp", "value=\"false\"")];
    check(&[quarter, low, high, ("outlow", "value=\"0.6\""), yes], 0.6);
    check(&[quarter, low, high, ("outlow", "value=\"0.6\""), no], 0.5);

    let odd =
        |inputs: &str| load("a.mtlx", &graph(&format!("\n<range name=\"end\">{inputs}</range>")));
    let none = odd("<input name=\"gamma\" value=\"0\"/>");
    assert!(none.warnings[0].contains("a.mtlx:2:1: texture end has a gamma"), "{none:?}");
    // x / 1e-320 overflows over [0, 0.25], and 0 times infinity is no number.
    let image = "<image name=\"i\" type=\"float\"/>\n";
    let far = "<input name=\"in\" nodename=\"i\"/><input name=\"inhigh\" value=\"1e-320\"/>";
    let far = load("a.mtlx", &graph(&format!("{image}<range name=\"end\">{far}</range>")));
    assert!(far.warnings.iter().any(|it| it.contains("not finite")), "{far:?}");
    assert_eq!(far.materials[0].lobe.roughness.x(), Interval::UNIT);
    // A constant, of which a Fresnel term may be made.
    let ior = r#"<range name="r"><input name="in" value="1"/><input name="outhigh" value="1.7"/></range>
        <open_pbr_surface name="a" type="surfaceshader"><input name="specular_ior" nodename="r"/></open_pbr_surface>"#;
    let eta = load("a.mtlx", &document(ior)).materials[0].fresnel;
    assert_eq!(eta, Some(Reflectance::dielectric(1.7)));
}

#[test]
fn an_input_that_says_nothing_is_the_default() {
    let text = "<open_pbr_surface name=\"a\" type=\"surfaceshader\"><input name=\"specular_roughness\" type=\"float\"/></open_pbr_surface>";
    let scene = load("a.mtlx", &document(text));
    assert_close(scene.materials[0].lobe.roughness, [0.09; 2], [0.09; 2]);
}

#[test]
fn an_impossible_index_leaves_the_lobe_without_a_fresnel_term() {
    let scene = shader("open_pbr_surface", &[("specular_ior", 0.0)]);
    assert_eq!(scene.materials[0].fresnel, None);
    assert!(scene.warnings[0].contains("more than 0; the lobe has no Fresnel term"));
}
