//! Materials that are not understood, while the rest of the scene is read.

use microfacet_baker::scene::Scene;

use crate::{
    anisotropic, assert_not_understood, assert_refused, assert_says, assert_warned, isotropic,
    load, named, names,
};

/// The good material after the text must be read whatever the text contains.
fn beside(text: &str) -> Scene {
    let good = "MakeNamedMaterial 'good' 'string type' 'conductor' 'float roughness' 0.04";
    let scene = load("a.pbrt", &format!("{text}\n{good}"));
    assert_eq!(named(&scene, "good").lobe.roughness, isotropic(0.2));
    scene
}

const NAMED: &str = "MakeNamedMaterial 'a' 'string type' 'conductor'";

#[test]
fn an_impossible_value_costs_its_material_alone() {
    let case = |text: &str, name: &str, parts: &[&str]| {
        let scene = beside(text);
        assert_not_understood(&scene, name, ":1:1", parts);
        assert_eq!((names(&scene), scene.ignored.len()), (vec!["good"], 1));
        assert_eq!(scene.warnings, [""; 0]);
    };
    let value = |value: &str, parts: &[&str]| {
        case(&format!("{NAMED} {value}"), "a", &[&["a.pbrt:1:49: "], parts].concat());
    };
    value("'float roughness' -0.5", &["-0.5", "0 or more", "'a'"]);
    value("'float roughness' 'rough'", &["number", "rough"]);
    value("'float roughness' nan", &["number", "nan"]);
    value("'bool remaproughness' 1", &["true or false"]);
    value("'texture roughness' 't'", &["'t' is not defined"]);
    case("MakeNamedMaterial 'a' 'float roughness' 1", "a", &["no type"]);
    case("Material 'conductr'", "conductr at a.pbrt:1", &["(conductr)", "not a material of"]);
}

#[test]
fn an_undefined_texture_is_named_with_the_nearest() {
    let scene = beside(
        "Texture 'grey' 'float' 'constant'\nMaterial 'conductor' 'texture roughness' 'gray'",
    );
    let parts = ["'gray' is not defined; did you mean `grey`?"];
    assert_not_understood(&scene, "conductor at a.pbrt:2", ":2:1", &parts);
}

#[test]
fn textures_in_a_circle_cost_the_materials_that_use_them() {
    let scene = beside(
        "Texture 't' 'float' 'scale' 'texture tex' 't'
         MakeNamedMaterial 'a' 'string type' 'conductor' 'texture roughness' 't'
         MakeNamedMaterial 'b' 'string type' 'conductor' 'texture roughness' 't'",
    );
    for (name, place) in [("a", ":2:10"), ("b", ":3:10")] {
        assert_not_understood(&scene, name, place, &["a.pbrt:1:29: ", "depends on itself"]);
    }
}

#[test]
fn a_bad_interface_leaves_the_other() {
    let scene = beside(
        "MakeNamedMaterial 'a' 'string type' 'coatedconductor' 'float conductor.roughness' -1",
    );
    assert_eq!(names(&scene), ["a.interface", "good"]);
    assert_not_understood(&scene, "a.conductor", ":1:1", &["conductor.roughness", "-1"]);
}

#[test]
fn a_bad_fresnel_value_leaves_the_lobe() {
    let case = |material: &str, place: &str, parts: &[&str]| {
        let scene = beside(&format!("MakeNamedMaterial 'a' {material} 'float roughness' 0.25"));
        assert_eq!(named(&scene, "a").lobe.roughness, isotropic(0.5));
        assert_eq!((named(&scene, "a").fresnel, scene.ignored.len()), (None, 0));
        assert_warned(&scene, place, &[parts, &["without its Fresnel term"]].concat());
    };
    case("'string type' 'dielectric' 'float eta' 0", ":1:50", &["is 0", "more than 0"]);
    case("'string type' 'dielectric' 'float eta' 'x'", ":1:50", &["eta must be a number", "'x'"]);
    let metal = "'string type' 'conductor' 'rgb eta' [ 0 1 1 ] 'rgb k' [ 3 2 2 ]";
    case(metal, ":1:1", &["[0.0, 1.0, 1.0]", "eta must be more than 0"]);
    let bright = "'string type' 'conductor' 'rgb reflectance' [ 0.5 1.5 1 ]";
    case(bright, ":1:49", &["[0.5, 1.5, 1.0]", "from 0 to 1"]);
    let both = "'string type' 'conductor' 'rgb reflectance' [ 0.5 1 1 ] 'rgb k' [ 3 2 2 ]";
    case(both, ":1:49", &["either reflectance or eta and k", "remove one"]);
}

#[test]
fn names_that_nothing_defines_are_warned_of() {
    let scene = beside(&format!("{NAMED} 'float roughness' 1\nNamedMaterial 'A' Shape 'sphere'"));
    assert_warned(&scene, ":2:1", &["'A' is not defined; did you mean `a`?"]);
    let scene = beside("Material 'mix' 'string materials' [ 'goode' 'good' ]\nShape 'sphere'");
    assert_warned(&scene, ":1:16", &["'goode' is not defined; did you mean `good`?"]);
    assert!(named(&scene, "good").used, "the other part");
}

/// The names are compared in the order of their definition, up to a limit.
#[test]
fn a_name_is_suggested_among_very_many() {
    let named = |name: &str| format!("MakeNamedMaterial '{name}' 'string type' 'hair'\n");
    let others = |count: usize| (0..count).map(|i| named(&format!("m{i}"))).collect::<String>();
    for materials in [others(5000) + &named("velvet"), named("velvet") + &others(20_000)] {
        let scene = load("a.pbrt", &(materials + "NamedMaterial 'velvte' Shape 'sphere'"));
        let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
        assert_says(warning, &["'velvte' is not defined; did you mean `velvet`?"]);
    }
}

#[test]
fn of_two_definitions_the_first_counts() {
    let scene = beside(&format!("{NAMED} 'float roughness' 0.01\n{NAMED} 'float roughness' 1"));
    assert_eq!(names(&scene), ["a", "good"]);
    assert_eq!(scene.materials[0].lobe.roughness, isotropic(0.1));
    assert_warned(&scene, ":2:1", &["twice", "a.pbrt:1:1"]);
}

#[test]
fn materials_of_other_versions_are_not_understood() {
    for class in [
        "disney",
        "fourier",
        "glass",
        "kdsubsurface",
        "matte",
        "metal",
        "mirror",
        "plastic",
        "substrate",
        "translucent",
        "uber",
    ] {
        let scene = beside(&format!("Material '{class}' 'float roughness' 0.1"));
        let parts = [&format!("({class})")[..], "pbrt-v3", "pbrt --upgrade old.pbrt > new.pbrt"];
        assert_not_understood(&scene, &format!("{class} at a.pbrt:1"), ":1:1", &parts);
    }
    // These materials exist in both versions.
    for class in ["hair", "subsurface", "mix"] {
        let scene = beside(&format!("Material '{class}'"));
        assert!(scene.ignored.iter().all(|ignored| ignored.understood), "{:?}", scene.ignored);
    }
}

#[test]
fn subsurface_beside_materials_of_v3_is_warned_of() {
    let skin = |parameters: &str| format!("Material 'subsurface' {parameters}\n");
    let rough = skin("'float uroughness' 0.04 'float vroughness' 0.09");
    let mixture = "Material 'mix' 'string namedmaterial1' 'good' 'string namedmaterial2' 'good'";
    // The warning does not depend on the order of the materials.
    for text in [rough.clone() + "Material 'matte'", rough.clone() + mixture] {
        let scene = beside(&text);
        assert_warned(&scene, ":1:1", &["pbrt-v4", "materials of pbrt-v3", "pbrt --upgrade"]);
        assert_eq!(scene.materials[0].lobe.roughness, anisotropic(0.2, 0.3));
    }
    // Both versions agree where no roughness is mapped, and a scene of v4 alone needs no warning.
    let unmapped = skin("'float roughness' 0.04 'bool remaproughness' false");
    for text in [rough, skin("") + mixture, unmapped + mixture] {
        assert_eq!(beside(&text).warnings, [""; 0]);
    }
}

#[test]
fn parts_of_mixtures_of_v3_are_used() {
    let scene = beside(
        "MakeNamedMaterial 'spare' 'string type' 'conductor'
         MakeNamedMaterial 'pane' 'string type' 'dielectric'
         Material 'mix' 'string namedmaterial1' 'good' 'string namedmaterial2' [ 'pane' ]
         Shape 'sphere'
         Material 'mix' 'string namedmaterial1' 'goode' 'string namedmaterial2' 'pane'",
    );
    let used = |name| named(&scene, name).used;
    assert!(used("good") && used("pane") && !used("spare"));
    assert_warned(&scene, ":5:25", &["'goode' is not defined; did you mean `good`?"]);
}

#[test]
fn directives_of_other_versions_are_passed_over_with_one_warning() {
    let scene = beside(
        "SearchPath '/scenes'\nRenderer 'sampler'\nVolume 'homogeneous' 'point p0' [ 0 0 0 ]
         SurfaceIntegrator 'path' 'integer maxdepth' [ 5 ]\nVolumeIntegrator 'emission'",
    );
    assert_warned(&scene, ":1:1", &["SearchPath", "pbrt-v1", "pbrt --upgrade"]);
    let scene = beside("\nSurfaceIntegrator 'path'");
    assert_warned(&scene, ":2:1", &["SurfaceIntegrator", "pbrt-v2"]);
    let similar = &["unknown directive SurfaceIntegrators"];
    assert_refused("a.pbrt", "SurfaceIntegrators 'path'", ":1:1", similar);
}

#[test]
fn the_boundary_of_a_medium_has_nothing_to_bake() {
    for class in ["interface", "none", ""] {
        let scene = beside(&format!(
            "MakeNamedMaterial 'fog' 'string type' '{class}'
             NamedMaterial 'fog' Shape 'sphere' Material '{class}' Shape 'sphere'"
        ));
        let [fog, other] = &scene.ignored[..] else { panic!("{:?}", scene.ignored) };
        for ignored in [fog, other] {
            assert!(ignored.understood, "{ignored}");
            assert!(ignored.reason.contains("boundary of a medium"), "{ignored}");
        }
        assert_eq!((&fog.name[..], &fog.kind[..]), ("fog", class));
        let kind = if class.is_empty() { "interface" } else { class };
        let name = format!("{kind} at a.pbrt:2");
        assert_eq!((&other.name[..], &other.kind[..]), (&name[..], kind));
        assert_eq!(scene.warnings, [""; 0]);
    }
}

#[test]
fn a_blank_name_is_replaced_by_the_place() {
    let scene = beside(
        "MakeNamedMaterial '' 'string type' 'conductor' 'float roughness' 0.25
         MakeNamedMaterial ' '
         MakeNamedMaterial 'spare' 'string type' 'conductor'
         NamedMaterial '' Shape 'sphere'",
    );
    let named = named(&scene, "conductor at a.pbrt:1");
    assert!(named.used && named.lobe.roughness == isotropic(0.5), "{named:?}");
    assert_not_understood(&scene, "material at a.pbrt:2", ":2:10", &["it has no type"]);
}

#[test]
fn a_parameter_that_a_class_has_not_is_warned_of() {
    let case = |text: &str, place: &str, parts: &[&str]| {
        let scene = beside(text);
        assert_warned(&scene, place, parts);
        assert_eq!(scene.doubts().count(), 1);
    };
    let conductor = |parameter: &str, parts: &[&str]| {
        case(&format!("Material 'conductor' {parameter}"), ":1:22", parts);
    };
    let typo = ["conductor has no parameter `roughnes`", "; did you mean `roughness`?"];
    conductor("'float roughnes' 0.3", &typo);
    conductor("'float urougness' 0.3", &["`urougness`", "did you mean `uroughness`?"]);
    conductor(
        "'string metal' 'Cu'",
        &["`metal`; it has type, ", " eta, k, ", "; this one is not read"],
    );
    conductor("'float thickness' 1", &["conductor has no parameter `thickness`"]);
    conductor("'spectrum roughness' [ 0.3 ]", &["type spectrum; it may be float, texture"]);
    conductor("'string remaproughness' 'false'", &["remaproughness of", "it may be bool"]);
    let coated = "MakeNamedMaterial 'a' 'string type' 'coatedconductor' 'float roughness' 1";
    case(coated, ":1:55", &["coatedconductor has no parameter `roughness`", "conductor.roughness"]);
    let mixture = "Material 'mix' 'string material' [ 'good' 'good' ]";
    case(mixture, ":1:16", &["mix has no parameter `material`", "`materials`?"]);
    let attribute = "Attribute 'material' 'float roughnes' 0.3";
    case(attribute, ":1:22", &["a material has no parameter `roughnes`", "`roughness`?"]);
    let texture = "Texture 't' 'float' 'constant' 'float valu' 1";
    case(texture, ":1:32", &["constant has no parameter `valu`", "`value`?"]);
}

/// All parameters that pbrt-v4 takes, also those that do not affect a lobe.
#[test]
fn parameters_that_a_class_has_are_not_warned_of() {
    let rough = |prefix: &str| {
        let axes = ["", "u", "v"];
        axes.map(|axis| format!("'float {prefix}{axis}roughness' 0.2 ")).concat()
    };
    let both = "'texture displacement' 'none' 'string normalmap' 'n.png'";
    let layer = "'float thickness' 0.1 'float g' 0 'rgb albedo' [ 0 0 0 ] \
                 'integer maxdepth' 10 'integer nsamples' 1 'spectrum reflectance' 'x'";
    let remap = "'bool remaproughness' false";
    for (class, parameters) in [
        ("conductor", format!("{} {remap} 'rgb eta' [ 1 1 1 ] 'rgb k' [ 1 1 1 ]", rough(""))),
        ("conductor", "'rgb reflectance' [ 0.9 0.9 0.9 ]".to_owned()),
        ("dielectric", format!("{} {remap} 'spectrum eta' 'glass-BK7'", rough(""))),
        ("thindielectric", "'float eta' 1.4".to_owned()),
        ("coateddiffuse", format!("{} {remap} {layer} 'blackbody eta' 3000", rough(""))),
        (
            "coatedconductor",
            format!(
                "{} {} {remap} {} 'float interface.eta' 1.4 'rgb conductor.eta' [ 1 1 1 ] \
                 'texture conductor.k' 't'",
                rough("interface."),
                rough("conductor."),
                layer.replace("spectrum reflectance", "texture albedo"),
            ),
        ),
        (
            "subsurface",
            format!(
                "{} {remap} 'float eta' 1.4 'float scale' 1 'float g' 0 'string name' 'Milk' \
                 'rgb sigma_a' [ 1 1 1 ] 'rgb sigma_s' [ 1 1 1 ] 'rgb mfp' [ 1 1 1 ] \
                 'rgb reflectance' [ 1 1 1 ]",
                rough("")
            ),
        ),
        // Earlier versions of pbrt-v4 had it.
        ("diffuse", "'float sigma' 20".to_owned()),
    ] {
        let scene = beside(&format!("Material '{class}' {parameters} {both}"));
        assert_eq!(scene.warnings, [""; 0], "{class}");
        assert!(scene.ignored.iter().all(|ignored| ignored.understood), "{:?}", scene.ignored);
    }
    let mixture = "Material 'mix' 'float amount' 0.5 'string materials' [ 'good' 'good' ]";
    assert_eq!(beside(mixture).warnings, [""; 0]);
    let plane = "'string mapping' 'planar' 'vector3 v1' [ 1 0 0 ] 'vector3 v2' [ 0 1 0 ] \
                 'float udelta' 0 'float vdelta' 0 'float uscale' 1 'float vscale' 1";
    for (class, parameters) in [
        ("constant", "'float value' 1"),
        ("scale", "'float tex' 1 'texture scale' 't'"),
        ("mix", "'float tex1' 1 'float tex2' 1 'float amount' 1"),
        ("directionmix", "'float tex1' 1 'float tex2' 1 'vector3 dir' [ 0 1 0 ]"),
        ("checkerboard", &format!("'integer dimension' 2 'float tex1' 1 {plane}")),
        ("dots", &format!("'float inside' 1 'float outside' 0 {plane}")),
        ("bilerp", &format!("'float v00' 1 'float v01' 0 'float v10' 1 {plane}")),
        (
            "imagemap",
            &format!(
                "'string filename' 'a.png' 'string wrap' 'clamp' 'string filter' 'ewa' \
                 'string encoding' 'linear' 'float scale' 2 'bool invert' true \
                 'float maxanisotropy' 8 {plane}"
            ),
        ),
        ("fbm", "'integer octaves' 8 'float roughness' 0.5"),
    ] {
        let scene = beside(&format!("Texture 'a' 'float' '{class}' {parameters}"));
        assert_eq!(scene.warnings, [""; 0], "{class}");
    }
    let attributes = "Attribute 'material' 'float roughness' 0.3 'float beta_m' 0.3 \
                      'rgb transmittance' [ 0 0 0 ]\nMaterial 'diffuse'\nMaterial 'hair'";
    assert_eq!(load("a.pbrt", attributes).warnings, [""; 0]);
}
