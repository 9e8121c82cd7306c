//! MaterialX documents.

mod bsdfs;
mod documents;
mod haze;
mod models;

use std::fs;

use microfacet_baker::scene::{Format, Reflectance, Roughness, Scene};
use microfacet_tables::Interval;

use crate::{Folder, anisotropic, assert_close, assert_says, load, names, png};

fn document(content: &str) -> String {
    format!("<materialx version='1.39'>{content}</materialx>")
}

/// A node with inputs: their names, and values or connections.
fn node(class: &str, name: &str, of_type: &str, inputs: &[(&str, &str)]) -> String {
    let input = |&(name, said): &(&str, &str)| {
        if said.contains('=') {
            return format!("<input name='{name}' {said}/>");
        }
        let of_type = match (name, said.split(',').count()) {
            ("file", _) => "filename",
            ("index", _) => "integer",
            _ if matches!(said, "true" | "false") => "boolean",
            (_, 3) => "color3",
            _ => "float",
        };
        format!("<input name='{name}' type='{of_type}' value='{said}'/>")
    };
    let inputs: String = inputs.iter().map(input).collect();
    format!("<{class} name='{name}' type='{of_type}'>{inputs}</{class}>")
}

/// The shader "a" of inputs that may be colours.
fn coloured(class: &str, inputs: &[(&str, &str)]) -> Scene {
    load("a.mtlx", &document(&node(class, "a", "surfaceshader", inputs)))
}

/// The shader "a".
fn shader(class: &str, inputs: &[(&str, f64)]) -> Scene {
    let texts: Vec<String> = inputs.iter().map(|(_, value)| value.to_string()).collect();
    let inputs = inputs.iter().zip(&texts).map(|((name, _), value)| (*name, &value[..]));
    coloured(class, &inputs.collect::<Vec<_>>())
}

#[test]
fn standard_surface_follows_its_definition() {
    let default = shader("standard_surface", &[]);
    assert_eq!(names(&default), ["a"]);
    let a = &default.materials[0];
    assert_close(a.lobe.roughness, [0.04; 2], [0.04; 2]);
    assert_eq!(a.lobe.gamma, Interval::point(2.0));
    assert_eq!(a.fresnel, Some(Reflectance::dielectric(1.5)));
    assert_eq!((a.masking, a.origin.format), (None, Format::MaterialX));

    let roughness = |inputs: &[(&str, f64)]| {
        let inputs = [&[("metalness", 1.0)], inputs].concat();
        shader("standard_surface", &inputs).materials[0].lobe.roughness
    };
    assert_eq!(roughness(&[("specular_roughness", 0.0)]), Roughness::Smooth);
    // aspect = sqrt(1 - 0.36) = 0.8
    let brushed = [("specular_roughness", 0.6), ("specular_anisotropy", 0.36)];
    assert_close(roughness(&brushed), [0.45; 2], [0.288; 2]);
    let extreme = [("specular_roughness", 1.0), ("specular_anisotropy", 1.0)];
    assert_close(roughness(&extreme), [1.0; 2], [0.02f64.sqrt(); 2]);

    let layered = [
        ("specular_roughness", 0.5),
        ("transmission", 1.0),
        ("transmission_extra_roughness", 0.25),
        ("coat", 0.5),
        ("coat_roughness", 0.4),
        ("coat_affect_roughness", 1.0),
        ("sheen", 1.0),
    ];
    let layered = shader("standard_surface", &layered);
    assert_eq!(names(&layered), ["a", "a.transmission", "a.coat"]);
    // The coat roughens by t = 0.5 * 0.4 * 1 = 0.2.
    for (i, r) in [0.5 + 0.5 * 0.2, 0.75 + 0.25 * 0.2, 0.4].into_iter().enumerate() {
        assert_close(layered.materials[i].lobe.roughness, [r * r; 2], [r * r; 2]);
    }
    assert_eq!(layered.ignored[0].name, "a.sheen");

    let diffuse = shader("standard_surface", &[("specular", 0.0)]);
    assert_eq!((diffuse.materials.len(), diffuse.ignored.len()), (0, 1));
}

#[test]
fn open_pbr_surface_follows_its_definition() {
    let default = shader("open_pbr_surface", &[]);
    assert_close(default.materials[0].lobe.roughness, [0.09; 2], [0.09; 2]);
    assert_eq!(default.materials[0].fresnel, Some(Reflectance::dielectric(1.5)));

    let brushed = |anisotropy: f64| {
        let inputs = [("specular_roughness", 0.5), ("specular_roughness_anisotropy", anisotropy)];
        shader("open_pbr_surface", &inputs).materials[0].lobe.roughness
    };
    // sqrt(2 / (1 + 0.25))
    let along = 0.25 * 1.6f64.sqrt();
    assert_close(brushed(0.5), [along; 2], [0.5 * along; 2]);
    assert_close(brushed(1.0), [0.25 * 2f64.sqrt(); 2], [1e-8; 2]);
    assert_ne!(brushed(0.0), anisotropic(0.25, 0.25));

    let coated = [
        ("specular_roughness", 0.5),
        ("coat_weight", 0.5),
        ("coat_roughness", 0.6),
        ("coat_roughness_anisotropy", 0.5),
        ("fuzz_weight", 0.1),
    ];
    let coated = shader("open_pbr_surface", &coated);
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

/// A shader whose roughness comes from the output "o" of a graph.
fn graph(nodes: &str) -> String {
    document(&format!(
        "<nodegraph name='G' fileprefix='maps/'><input name='amount' type='float' value='0.25'/>{nodes}
           <output name='x' type='float' nodename='absent'/>
           <output name='o' type='float' nodename='end'/></nodegraph>
         <open_pbr_surface name='a' type='surfaceshader'>
           <input name='specular_roughness' type='float' nodegraph='G' output='o'/></open_pbr_surface>"
    ))
}

#[test]
fn node_graphs_are_followed() {
    let folder = Folder::new::<&str>(&[]);
    fs::create_dir(folder.path("maps")).unwrap();
    fs::write(folder.path("maps/a.png"), png()).unwrap();
    let image = node("image", "i", "float", &[("file", "a.png")]);
    let colour = |space: &str| {
        let file = format!("type='filename' value='a.png' colorspace='{space}'");
        node("tiledimage", "i", "color3", &[("file", &file)])
    };
    let separate = colour("lin_rec709") + &node("separate3", "s", "multioutput", &[("in", COLOUR)]);
    let decoded = |x: f64| ((x + 0.055) / 1.055f64).powf(2.4);
    const FROM: &str = "type='float' nodename='i'";
    const COLOUR: &str = "type='color3' nodename='i'";
    const AMOUNT: &str = "type='float' interfacename='amount'";
    let green = [("in", COLOUR), ("index", "1")];
    for (source, tag, inputs, r) in [
        ("", "constant", &[("value", "0.3")][..], [0.3; 2]),
        ("", "constant", &[("value", AMOUNT)], [0.25; 2]),
        (&image, "dot", &[("in", FROM)], [0.2, 0.4]),
        (&image, "multiply", &[("in1", FROM), ("in2", "0.5")], [0.1, 0.2]),
        (&image, "add", &[("in1", FROM), ("in2", AMOUNT)], [0.45, 0.65]),
        (&image, "subtract", &[("in1", "1"), ("in2", FROM)], [0.6, 0.8]),
        (&image, "invert", &[("in", FROM)], [0.6, 0.8]),
        (&image, "mix", &[("bg", "0.1"), ("fg", "0.6"), ("mix", FROM)], [0.2, 0.3]),
        (&image, "clamp", &[("in", FROM), ("low", "0.3")], [0.3, 0.4]),
        (&image, "max", &[("in1", FROM), ("in2", "0.3")], [0.3, 0.4]),
        (&colour("lin_rec709"), "extract", &green, [0.4, 0.8]),
        (&separate, "dot", &[("in", "type='float' nodename='s' output='outg'")], [0.4, 0.8]),
        (&colour("srgb_texture"), "extract", &green, [decoded(0.4), decoded(0.8)]),
    ] {
        folder.write("a.mtlx", graph(&(source.to_owned() + &node(tag, "end", "float", inputs))));
        let scene = folder.load("a.mtlx").unwrap();
        assert_eq!(scene.warnings, [""; 0], "{tag}");
        let alpha = r.map(|r| r * r);
        assert_close(scene.materials[0].lobe.roughness, alpha, alpha);
    }
}

#[test]
fn a_range_is_a_remapping() {
    let quarter = ("in", "interfacename='amount'");
    let fifth = [("inlow", "0.2"), ("inhigh", "0.4")];
    let half = [("inlow", "0.5"), ("inhigh", "1.5"), ("outlow", "0.6")];
    let out = [("outlow", "0.2"), ("outhigh", "0.6")];
    let gamma = [("gamma", "2")];
    for (inputs, r) in [
        (vec![], 0.25),
        (fifth.to_vec(), 0.25),
        ([fifth, out].concat(), 0.3),
        ([&gamma[..], &out].concat(), 0.4),
        // (0.25 - 0.5) / 1 keeps its sign: -sqrt(0.25) = -0.5.
        ([&half[..], &gamma].concat(), 0.4),
        ([&half[..], &[("doclamp", "true")]].concat(), 0.6),
        ([&half[..], &[("doclamp", "false")]].concat(), 0.5),
    ] {
        let range = node("range", "end", "float", &[&[quarter], &inputs[..]].concat());
        let scene = load("a.mtlx", &graph(&range));
        assert_eq!(scene.warnings, [""; 0]);
        assert_close(scene.materials[0].lobe.roughness, [r * r; 2], [r * r; 2]);
    }

    let none = graph("\n<range name='end'><input name='gamma' value='0'/></range>");
    let none = load("a.mtlx", &none);
    assert_says(&none.warnings[0], &["a.mtlx:2:1: texture end has a gamma"]);
    // x / 1e-320 overflows over [0, 0.25], and 0 times infinity is no number.
    let far = "<image name='i' type='float'/>\n<range name='end'><input name='in' nodename='i'/>\
               <input name='inhigh' value='1e-320'/></range>";
    let far = load("a.mtlx", &graph(far));
    assert!(far.warnings.iter().any(|it| it.contains("not finite")), "{far:?}");
    assert_eq!(far.materials[0].lobe.roughness.x(), Interval::UNIT);
    // A constant, of which a Fresnel term may be made.
    let ior = node("range", "r", "float", &[("in", "1"), ("outhigh", "1.7")])
        + &node("open_pbr_surface", "a", "surfaceshader", &[("specular_ior", "nodename='r'")]);
    let eta = load("a.mtlx", &document(&ior)).materials[0].fresnel;
    assert_eq!(eta, Some(Reflectance::dielectric(1.7)));
}
