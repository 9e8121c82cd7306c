//! Surfaces that are graphs of BSDF nodes.

use microfacet_baker::scene::{Reflectance, Scene};
use microfacet_tables::Interval;

use super::{document, node};
use crate::{Folder, anisotropic, assert_close, isotropic, load, names, png};

/// A surface whose BSDF is the node "end".
fn surface(nodes: &str) -> String {
    document(&format!(
        r#"{nodes}<surface name="a" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="end"/></surface>"#
    ))
}

fn bsdf(class: &str, name: &str, inputs: &[(&str, &str)]) -> String {
    node(class, name, "BSDF", inputs)
}

fn one(class: &str, inputs: &[(&str, &str)]) -> Scene {
    load("a.mtlx", &surface(&bsdf(class, "end", inputs)))
}

const ROUGH: (&str, &str) = ("roughness", "0.2, 0.3");

#[test]
fn roughness_is_alpha_of_each_axis() {
    let scene = one("conductor_bsdf", &[ROUGH]);
    assert_eq!(names(&scene), ["a"]);
    assert_eq!(scene.materials[0].lobe.roughness, anisotropic(0.2, 0.3));
    assert_eq!(scene.materials[0].lobe.gamma, Interval::point(2.0));
    assert_eq!(one("dielectric_bsdf", &[]).materials[0].lobe.roughness, isotropic(0.05));

    let from = |node: &str| {
        let inputs = [("roughness", "nodename='r'")];
        let text = surface(&(node.to_owned() + &bsdf("dielectric_bsdf", "end", &inputs)));
        load("a.mtlx", &text).materials[0].lobe.roughness
    };
    let stretched = |node: &str, roughness: &str| {
        from(&bsdf(node, "r", &[(roughness, "0.6"), ("anisotropy", "0.36")]))
    };
    // The aspect is sqrt(1 - 0.36) = 0.8.
    assert_close(stretched("roughness_anisotropy", "roughness"), [0.45; 2], [0.288; 2]);
    assert_close(stretched("glossiness_anisotropy", "glossiness"), [0.2; 2], [0.128; 2]);
    let dual = from(&bsdf("roughness_dual", "r", &[("roughness", "0.5, 0.6")]));
    assert_close(dual, [0.25; 2], [0.36; 2]);
    let one = from(&bsdf("roughness_dual", "r", &[("roughness", "0.5, -1")]));
    assert_eq!(one, isotropic(0.25));
    let two = [("in1", "0.1"), ("in2", "0.4")];
    assert_eq!(from(&bsdf("combine2", "r", &two)), anisotropic(0.1, 0.4));
}

#[test]
fn one_texture_for_both_axes_is_isotropic() {
    let image = r#"<image name="i" type="float"><input name="file" value="a.png"/></image>"#;
    let load = |pair: &str| {
        let inputs = [("roughness", "nodename='r'")];
        let text = surface(&(image.to_owned() + pair + &bsdf("conductor_bsdf", "end", &inputs)));
        Folder::new(&[("a.png", png()), ("a.mtlx", text.into_bytes())]).load("a.mtlx").unwrap()
    };
    let of_image = "nodename='i'";
    let pairs = [
        bsdf("combine2", "r", &[("in1", of_image), ("in2", of_image)]),
        bsdf("convert", "r", &[("in", of_image)]),
    ];
    for pair in pairs {
        let roughness = load(&pair).materials[0].lobe.roughness;
        assert!(roughness.is_isotropic(), "{roughness:?}");
        assert_close(roughness, [0.2, 0.4], [0.2, 0.4]);
    }
    let half = bsdf("combine2", "r", &[("in1", of_image), ("in2", "0.2")]);
    let roughness = load(&half).materials[0].lobe.roughness;
    assert!(!roughness.is_isotropic());
    assert_close(roughness, [0.2, 0.4], [0.2; 2]);
}

#[test]
fn fresnel_terms_are_those_of_the_nodes() {
    let fresnel = |class, inputs: &[_]| one(class, inputs).materials[0].fresnel;
    let (n, k) = (("ior", "0.2, 0.9, 1.1"), ("extinction", "3.9, 2.4, 2.2"));
    let copper = Reflectance::Conductor { eta: [0.2, 0.9, 1.1], k: [3.9, 2.4, 2.2] };
    assert_eq!(fresnel("conductor_bsdf", &[n, k]), Some(copper));
    assert_eq!(fresnel("conductor_bsdf", &[n, k, ("thinfilm_thickness", "300")]), None);
    let glass = Some(Reflectance::dielectric(1.7));
    assert_eq!(fresnel("dielectric_bsdf", &[("ior", "1.7")]), glass);
    let copper = ("color0", "0.9, 0.6, 0.5");
    let schlick = |more| fresnel("generalized_schlick_bsdf", &[copper, more]);
    assert_eq!(schlick(("weight", "0.5")), Some(Reflectance::Schlick([0.9, 0.6, 0.5])));
    for other in ["color82", "color90"] {
        assert_eq!(schlick((other, "1, 1, 0.9")), None, "{other}");
    }
    assert_eq!(schlick(("exponent", "4")), None);

    // From the outputs of one node: r = 0.25 with a black edge is n = 3, k = 0.
    let inputs = [("reflectivity", "0.25 0.25 0.25"), ("edge_color", "0, 0, 0")];
    let artistic = bsdf("artistic_ior", "m", &inputs);
    let outputs =
        [("ior", "nodename='m' output='ior'"), ("extinction", "nodename='m' output='extinction'")];
    let text = surface(&(artistic + &bsdf("conductor_bsdf", "end", &outputs)));
    let Some(Reflectance::Conductor { eta, k }) = load("a.mtlx", &text).materials[0].fresnel else {
        panic!("no conductor")
    };
    assert!((eta[0] - 3.0).abs() < 1e-12 && k == [0.0; 3], "{eta:?} {k:?}");
}

#[test]
fn lobes_are_found_through_layers_and_mixtures() {
    let parts = bsdf("dielectric_bsdf", "coat", &[ROUGH])
        + &bsdf("dielectric_bsdf", "pane", &[ROUGH, ("scatter_mode", "T")])
        + &bsdf("conductor_bsdf", "metal", &[ROUGH])
        + &bsdf("generalized_schlick_bsdf", "other", &[ROUGH])
        + &bsdf("dielectric_bsdf", "none", &[ROUGH, ("weight", "0")])
        + &bsdf("oren_nayar_diffuse_bsdf", "diffuse", &[])
        + &bsdf("sheen_bsdf", "cloth", &[]);
    let of = |tree: &str| load("a.mtlx", &surface(&(parts.clone() + tree)));
    let end = |class: &str, inputs: &[(&str, &str)]| of(&bsdf(class, "end", inputs));
    let (coat, metal) = ("nodename='coat'", "nodename='metal'");
    let layered = bsdf("layer", "end", &[("top", coat), ("base", "nodename='m'")]);
    let all = ["a.dielectric", "a.conductor", "a.schlick"];
    for (amount, lobes) in
        [("0.5", &all[..]), ("0", &["a.dielectric", "a.schlick"]), ("1", &all[..2])]
    {
        let inputs = [("fg", metal), ("bg", "nodename='other'"), ("mix", amount)];
        assert_eq!(names(&of(&(bsdf("mix", "m", &inputs) + &layered))), lobes);
    }
    assert_eq!(names(&end("add", &[("in1", "nodename='none'"), ("in2", metal)])), ["a"]);
    let times = |factor: &str| end("multiply", &[("in1", metal), ("in2", factor)]);
    assert_eq!(names(&times("0, 0.1, 0")), ["a"]);
    assert_eq!(times("0").materials, []);
    // An interface that reflects and transmits.
    assert_eq!(names(&end("layer", &[("top", coat), ("base", "nodename='pane'")])), ["a"]);

    let fabric = end("layer", &[("top", "nodename='cloth'"), ("base", metal)]);
    assert_eq!((names(&fabric), &fabric.ignored[0].name[..]), (vec!["a"], "a.sheen"));
    // A film changes what it lies on.
    let film = bsdf("thin_film_bsdf", "film", &[])
        + &bsdf("layer", "end", &[("top", "nodename='film'"), ("base", coat)]);
    assert_eq!(of(&film).materials[0].fresnel, None);
}

/// A node that the document defines by a graph, which has an interface.
const DEFINED: &str = "
    <nodedef name='ND_paint' node='paint'>
      <input name='gloss' type='vector2' value='0.1, 0.1'/><output name='out' type='surfaceshader'/>
    </nodedef>
    <nodegraph name='NG_paint' nodedef='ND_paint'>
      <dielectric_bsdf name='d' type='BSDF'><input name='roughness' interfacename='gloss'/></dielectric_bsdf>
      <surface name='s' type='surfaceshader'><input name='bsdf' nodename='d'/></surface>
      <output name='out' type='surfaceshader' nodename='s'/>
    </nodegraph>";

#[test]
fn nodes_are_followed_into_the_graphs_that_define_them() {
    let uses = r#"<paint name="a" type="surfaceshader"/>
        <paint name="b" type="surfaceshader"><input name="gloss" value="0.3, 0.3"/></paint>"#;
    let scene = load("a.mtlx", &document(&format!("{DEFINED}{uses}")));
    assert_eq!(names(&scene), ["a", "b"]);
    assert_eq!(scene.materials[0].lobe.roughness, isotropic(0.1));
    assert_eq!(scene.materials[1].lobe.roughness, isotropic(0.3));
    // Also if the graph is named by an implementation.
    let named = DEFINED
        .replace("nodegraph name='NG_paint' nodedef='ND_paint'", "nodegraph name='NG_paint'")
        + "<implementation name='I' nodedef='ND_paint' nodegraph='NG_paint'/>";
    assert_eq!(names(&load("a.mtlx", &document(&(named + uses)))), ["a", "b"]);

    // A value may be defined too.
    let value = r#"<nodedef name="ND_h" node="half"><input name="in" value="1"/></nodedef>
        <nodegraph name="NG_h" nodedef="ND_h"><multiply name="m" type="float">
          <input name="in1" interfacename="in"/><input name="in2" value="0.5"/></multiply>
          <output name="out" nodename="m"/></nodegraph>
        <half name="h" type="float"><input name="in" value="0.8"/></half>
        <gltf_pbr name="a" type="surfaceshader"><input name="roughness" nodename="h"/></gltf_pbr>"#;
    let scene = load("a.mtlx", &document(value));
    assert_close(scene.materials[0].lobe.roughness, [0.16; 2], [0.16; 2]);
}

/// Each of many layers has the next twice; without care that takes forever.
#[test]
fn shared_and_deep_graphs_are_followed_once() {
    let layer = |i: usize, next: &str| {
        let next = format!("nodename='{next}'");
        bsdf("layer", &format!("l{i}"), &[("top", &next), ("base", &next)])
    };
    let deep: String = (1..20_000).map(|i| layer(i, &format!("l{}", i + 1))).collect();
    let text = bsdf("dot", "end", &[("in", "nodename='l1'")])
        + &deep
        + &layer(20_000, "metal")
        + &bsdf("conductor_bsdf", "metal", &[]);
    assert_eq!(names(&load("a.mtlx", &surface(&text))), ["a"]);
}
