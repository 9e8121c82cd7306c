//! BSDFs that are not understood, and those of Mitsuba 0.6 alone, while the rest is read.

use microfacet_baker::scene::{Reflectance, Roughness, Scene};
use microfacet_tables::Interval;

use super::scene;
use crate::{
    Folder, anisotropic, assert_not_understood, assert_warned, isotropic, load, named, names,
};

/// The good BSDF after the text must be read whatever the text contains.
fn beside(text: &str) -> Scene {
    let good = "<bsdf type='roughconductor' id='good'><float name='alpha' value='0.2'/></bsdf>";
    let scene = load("a.xml", &scene(&format!("{text}\n{good}")));
    assert_eq!(named(&scene, "good").lobe.roughness, isotropic(0.2));
    scene
}

fn bsdf(class: &str, properties: &str) -> Scene {
    beside(&format!("<bsdf type='{class}' id='a'>{properties}</bsdf>"))
}

#[test]
fn an_impossible_value_costs_its_bsdf_alone() {
    let case = |class: &str, text: &str, parts: &[&str]| {
        let scene = bsdf(class, text);
        assert_not_understood(&scene, "a", ":1:24", parts);
        assert_eq!((names(&scene), scene.ignored.len()), (vec!["good"], 1));
    };
    let rough = "roughconductor";
    let alpha = |value: &str, parts: &[&str]| {
        case(rough, &format!("\n<float name='alpha' {value}/>"), parts);
    };
    alpha("value='x'", &["a.xml:2:1: ", "alpha", "number", "\"x\""]);
    alpha("value='$a'", &["a.xml:2:1: ", "$a", "<default name='a'"]);
    alpha("", &["a.xml:2:1: ", "no attribute \"value\""]);
    alpha("value='-1'", &["-1", "more than 0"]);
    case(rough, "<float name='alpha_u' value='1'/>", &["both alpha_u and alpha_v"]);
    let mixed = "<float name='alpha' value='1'/><float name='alpha_v' value='1'/>";
    case(rough, mixed, &["both alpha_u and alpha_v"]);
    case("principled", "<float name='roughness' value='1.5'/>", &["1.5", "0 to 1"]);
    case("roughcloth", "", &["(roughcloth)", "not a BSDF that is known here"]);
}

#[test]
fn a_bsdf_without_a_type_is_listed() {
    let scene = beside("\n<bsdf id='a'/>");
    assert_not_understood(&scene, "a", ":2:1", &["no type", "no attribute \"type\""]);
}

#[test]
fn distributions_of_other_versions_cost_their_lobe() {
    for name in ["phong", "as", "AS"] {
        let property = format!("\n<string name='distribution' value='{name}'/>");
        let scene = bsdf("roughconductor", &property);
        let parts = ["a.xml:2:1: ", &format!("\"{name}\""), "0.6", "beckmann and ggx"];
        assert_not_understood(&scene, "a", ":1:24", &parts);
    }
    let scene = bsdf("roughplastic", "<string name='distribution' value='gxg'/>");
    assert_not_understood(&scene, "a", ":1:24", &["\"gxg\"", "did you mean `ggx`?"]);
}

#[test]
fn a_bad_fresnel_value_leaves_the_lobe() {
    let case = |class: &str, property: &str, place: &str, parts: &[&str]| {
        let (name, value) =
            if class == "principled" { ("roughness", 0.5) } else { ("alpha", 0.25) };
        let rough = format!("<float name='{name}' value='{value}'/>");
        let scene = bsdf(class, &format!("{rough}\n{property}"));
        let a = named(&scene, "a");
        assert_eq!((a.fresnel, scene.ignored.len()), (None, 0));
        assert_eq!(a.lobe.roughness, isotropic(0.25));
        assert_warned(&scene, place, &[parts, &["without its Fresnel term"]].concat());
    };
    let glass = "roughdielectric";
    case(glass, "<string name='int_ior' value='watr'/>", ":2:1", &["watr", "`water`"]);
    case(glass, "<float name='int_ior' value='-1'/>", ":1:24", &["more than 0"]);
    let both = "<float name='int_ior' value='-1.5'/><float name='ext_ior' value='-1'/>";
    case(glass, both, ":1:24", &["-1.5", "more than 0"]);
    case(glass, "<float name='ext_ior' value='x'/>", ":2:1", &["ext_ior", "number"]);
    let eta = "<rgb name='eta' value='0 1 1'/><rgb name='k' value='3 2 2'/>";
    case("roughconductor", eta, ":1:24", &["eta must be more than 0"]);
    let eta = "<rgb name='eta' value='a,b,c'/><rgb name='k' value='3 2 2'/>";
    case("roughconductor", eta, ":2:1", &["eta must be three numbers", "\"a,b,c\""]);
    let k = "<rgb name='k' value='3 2'/><rgb name='eta' value='1 1 1'/>";
    case("roughconductor", k, ":2:1", &["k must be three numbers", "\"3 2\""]);
    let metal = "<string name='material' value='Unobtainium'/>";
    case("roughconductor", metal, ":2:1", &["\"Unobtainium\" is no preset", "give eta and k"]);
    case("pplastic", "<float name='eta' value='-1'/>", ":1:24", &["more than 0"]);
    case("principled", "<float name='eta' value='-1'/>", ":1:24", &["more than 0"]);
}

#[test]
fn references_to_nothing_are_warned_of() {
    let inner = "\n<ref id='god'/>";
    let scene = bsdf("twosided", inner);
    assert_warned(&scene, ":2:1", &["nothing has the id \"god\"; did you mean `good`?"]);
    let scene = beside("\n<shape type='cube'><ref id='b'/><ref id='good'/></shape>");
    assert_warned(&scene, ":2:20", &["id \"b\""]);
    assert!(named(&scene, "good").used);
    let scene = beside("\n<shape type='cube'><ref/></shape>");
    assert_warned(&scene, ":2:20", &["no attribute \"id\""]);
    let scene = bsdf("roughconductor", "\n<ref name='alpha' id='b'/>");
    assert_not_understood(&scene, "a", ":1:24", &["a.xml:2:1: ", "id \"b\""]);
}

#[test]
fn textures_in_a_circle_cost_the_bsdfs_that_use_them() {
    let alpha = "<ref name='alpha' id='t'/>";
    let scene = beside(&format!(
        "\n<texture type='checkerboard' id='t'><ref name='color0' id='t'/></texture>
         <bsdf type='roughconductor' id='a'>{alpha}</bsdf>
         <bsdf type='roughconductor' id='b'>{alpha}</bsdf>"
    ));
    assert_warned(&scene, ":2:37", &["circle: t -> t"]);
    for (name, place) in [("a", ":3:10"), ("b", ":4:10")] {
        assert_not_understood(&scene, name, place, &["depends on itself"]);
    }
}

#[test]
fn spellings_of_version_0_6_are_read() {
    let scene = bsdf(
        "roughdielectric",
        "<float name='alphaU' value='0.3'/><float name='alphaV' value='0.1'/>
         <string name='intIOR' value='water'/><float name='extIOR' value='1'/>",
    );
    assert_eq!(scene.materials[0].lobe.roughness, anisotropic(0.3, 0.1));
    assert_eq!(scene.materials[0].fresnel, Some(Reflectance::dielectric(1.333)));
    assert_eq!(scene.warnings, [""; 0]);
}

#[test]
fn a_coating_is_a_lobe_beside_the_bsdf_inside() {
    let inner = "<bsdf type='roughconductor'><float name='alpha' value='0.4'/></bsdf>";
    let scene = bsdf(
        "roughcoating",
        &format!(
            "<string name='distribution' value='ggx'/><float name='intIOR' value='1.5'/>
                  <float name='extIOR' value='1'/>{inner}"
        ),
    );
    assert_eq!(names(&scene), ["a.coating", "a", "good"]);
    let [coating, metal, _] = &scene.materials[..] else { unreachable!() };
    assert_eq!(coating.lobe.roughness, isotropic(0.1));
    assert_eq!(coating.lobe.gamma, Interval::point(2.0));
    assert_eq!(coating.fresnel, Some(Reflectance::dielectric(1.5)));
    assert_eq!(coating.origin.lobe, Some("coating"));
    assert_eq!(metal.lobe.roughness, isotropic(0.4));
    let scene = bsdf("coating", inner);
    assert_eq!(named(&scene, "a.coating").lobe.roughness, Roughness::Smooth);
    let clear = Some(Reflectance::dielectric(1.5046 / 1.000_277));
    assert_eq!(named(&scene, "a.coating").fresnel, clear);
    // A bad coat leaves what is inside, under the name that its own lobe would have.
    let bad = format!("<float name='alpha' value='-1'/>{inner}");
    let scene = bsdf("roughcoating", &bad);
    assert_eq!(names(&scene), ["a", "good"]);
    assert_not_understood(&scene, "a.coating", ":1:24", &["-1"]);
}

#[test]
fn an_empty_id_is_none() {
    let rough = "<float name='alpha' value='0.3'/>";
    let scene = beside(&format!("\n<bsdf type='roughplastic' id=''>{rough}</bsdf>"));
    assert_eq!(names(&scene), ["roughplastic at line 2", "good"]);
    let scene = bsdf("twosided", "<bsdf type='roughplastic' id=''/>");
    assert_eq!(names(&scene), ["a", "good"]);
}

#[test]
fn what_names_no_file_or_value_is_left_out() {
    let case = |element: &str, parts: &[&str]| {
        let scene = beside(&format!("\n{element}"));
        assert_warned(&scene, ":2:1", &[&["it is left out"], parts].concat());
    };
    case("<include/>", &["<include>", "no attribute \"filename\""]);
    case("<default name='x'/>", &["<default>", "no attribute \"value\""]);
    case("<default value='x'/>", &["<default>", "no attribute \"name\""]);
    case("<path/>", &["<path>", "no attribute \"value\""]);
    for folder in [".", ""] {
        let scene = beside(&format!("\n<include filename='{folder}'/>"));
        let named = format!("\"{folder}\" is a folder");
        assert_warned(&scene, ":2:1", &[&named, "all others count as used"]);
    }
    // A missing file may use any material.
    let shape = "<shape type='cube'><bsdf type='diffuse'/></shape>";
    assert!(!named(&beside(shape), "good").used);
    assert!(named(&beside(&format!("{shape}<include/>")), "good").used);
}

#[test]
fn an_included_file_that_is_not_well_formed_costs_itself_alone() {
    let good = "<bsdf type='roughconductor' id='good'/>";
    let include = |name: &str| format!("\n<include filename='{name}'/>");
    let whole = include("b.xml") + &include("c.xml") + good;
    let cases: [(&[u8], &str); 3] = [
        (b"<scene>\n<bsdf></scene>", "b.xml:2:7: expected `</bsdf>`"),
        (b"", "b.xml:1:1"),
        (b"<scene a='\xff'/>", "UTF-8"),
    ];
    for (text, why) in cases {
        let folder = Folder::new(&[
            ("a.xml", scene(&whole).as_bytes()),
            ("b.xml", text),
            ("c.xml", b"<bsdf type='roughplastic' id='c'/>"),
        ]);
        let scene = folder.load("a.xml").unwrap();
        assert_eq!(names(&scene), ["c", "good"]);
        assert_warned(&scene, "a.xml:2:1", &["b.xml is not well formed", why, "are not seen"]);
        // The included file counts as included, since its change may change the scene.
        assert_eq!(scene.included.len(), 2);
    }
}

#[test]
fn plugins_of_version_0_6_are_told_apart() {
    for class in ["phong", "ward", "sssbrdf"] {
        let scene = bsdf(class, "<float name='alpha' value='0.3'/>");
        assert_not_understood(&scene, "a", ":1:24", &[class, "0.6"]);
    }
    for class in ["roughdiffuse", "difftrans", "hk", "irawan"] {
        let scene = bsdf(class, "");
        assert!(scene.ignored.len() == 1 && scene.ignored[0].understood, "{:?}", scene.ignored);
    }
    let inner = "<bsdf type='roughplastic'/><bsdf type='diffuse'/>";
    let scene = bsdf("mixturebsdf", &format!("<string name='weights' value='0.5, 0.5'/>{inner}"));
    assert_eq!(names(&scene), ["a", "good"]);
    assert_eq!((scene.ignored.len(), &scene.ignored[0].kind[..]), (1, "diffuse"));
}

#[test]
fn a_property_that_a_plugin_has_not_is_warned_of() {
    let case = |class: &str, property: &str, parts: &[&str]| {
        let scene = bsdf(class, &format!("\n{property}"));
        assert_warned(&scene, "a.xml:2:1", parts);
        assert_eq!(scene.doubts().count(), 1);
    };
    let float = |name: &str| format!("<float name='{name}' value='0.3'/>");
    let typo = ["roughconductor has no parameter `alhpa`", "did you mean `alpha`?"];
    case("roughconductor", &float("alhpa"), &typo);
    case("roughdielectric", &float("intIRO"), &["`intIRO`", "did you mean `int_ior`?"]);
    // The same next to many sound materials.
    let scene = beside(&format!(
        "{}\n<bsdf type='roughconductor'>{}</bsdf>",
        "<bsdf type='diffuse'/>".repeat(150),
        float("alhpa")
    ));
    assert_warned(&scene, "a.xml:2:29", &typo);
    // A smooth conductor has no such property.
    case("conductor", &float("alpha"), &["conductor has no parameter `alpha`"]);
    case("principled", &float("Roughness"), &["`Roughness`", "did you mean `roughness`?"]);
    case("principledthin", &float("spec_tran"), &["`spec_tran`", "`spec_trans`?"]);
    case("roughplastic", "<float value='0.3'/>", &["<float> in roughplastic has no name"]);
    let texture = "<texture type='checkerboard' name='alpha'>\n\
                   <float name='colour0' value='1'/></texture>";
    let scene = bsdf("roughconductor", texture);
    assert_warned(&scene, ":2:1", &["checkerboard has no parameter `colour0`", "`color0`?"]);
}

#[test]
fn properties_of_either_version_are_not_warned_of() {
    let float = |name: &&str| format!("<float name='{name}' value='0.3'/>");
    for (class, names) in [
        ("roughconductor", "alphaU alphaV eta k specularReflectance sampleVisible"),
        ("roughconductor", "alpha_u alpha_v eta k specular_reflectance sample_visible"),
        ("dielectric", "int_ior ext_ior specular_reflectance specular_transmittance"),
        ("thindielectric", "intIOR extIOR specularTransmittance ensureEnergyConservation"),
        ("roughplastic", "diffuseReflectance nonlinear alpha intIOR"),
        ("pplastic", "alpha eta diffuse_reflectance"),
        ("roughcoating", "alpha thickness sigmaA int_ior"),
        ("principled", "base_color roughness anisotropic metallic spec_trans specular spec_tint"),
        ("principled", "sheen sheen_tint flatness clearcoat clearcoat_gloss eta"),
        ("principled", "main_specular_sampling_rate clearcoat_sampling_rate"),
        ("principledthin", "diff_trans diffuse_transmittance_sampling_rate spec_trans eta"),
        ("diffuse", "anything"),
        ("twosided", "anything"),
    ] {
        let properties: String = names.split(' ').collect::<Vec<_>>().iter().map(float).collect();
        let inner = "<bsdf type='diffuse'/><ref id='good'/><default name='x' value='1'/>";
        let scene = bsdf(class, &format!("{properties}{inner}"));
        assert_eq!(scene.warnings, [""; 0], "{class} {names}");
    }
    // Properties in the older spelling are read.
    let scene = bsdf("principled", "<float name='specTrans' value='1'/>");
    assert_eq!(scene.warnings, [""; 0]);
    let older = "<float name='alphaU' value='0.2'/><float name='alphaV' value='0.3'/>";
    assert_eq!(bsdf("roughconductor", older).materials[0].lobe.roughness, anisotropic(0.2, 0.3));
}
