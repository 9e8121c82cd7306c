//! pbrt-v4 scenes.

mod fresnel;
mod textures;

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use microfacet_baker::scene::{Format, Masking, Reflectance, Roughness};
use microfacet_sampler::Metal;
use microfacet_tables::Interval;

use crate::{Folder, anisotropic, assert_says, assert_warned, isotropic, load, named, names};

/// A house of one distribution at a few roughnesses, as exporters write them.
const HOUSE: &str = r#"
MakeNamedMaterial "paint"
    "string type" [ "coateddiffuse" ]
    "rgb reflectance" [ 0.3 0.4 0.5 ]
    "float roughness" [ 0.04 ]
Texture "tiles-kd" "spectrum" "imagemap"
    "string filename" [ "textures/tiles.png" ]
MakeNamedMaterial "tiles"  # polished
    "string type" [ "coateddiffuse" ]
    "texture reflectance" [ "tiles-kd" ]
    "float vroughness" [ 0.0009 ]
    "float uroughness" [ 0.0009 ]
MakeNamedMaterial "raw"
    "string type" "dielectric"
    "bool remaproughness" false
    "float roughness" .04
MakeNamedMaterial "window"
    "string type" [ "dielectric" ]
MakeNamedMaterial "frame"
    "string type" [ "conductor" ]
    "spectrum eta" [ "metal-Al-eta" ]
    "spectrum k" [ "metal-Al-k" ]
    "float uroughness" [ 0.09 ]
    "float vroughness" [ 0.01 ]
MakeNamedMaterial "plaster"
    "string type" [ "diffuse" ]
MakeNamedMaterial "sofa"
    "string type" [ "measured" ]
    "string filename" [ "leather.bsdf" ]
"#;

#[test]
fn roughness_is_remapped_and_the_rest_is_ggx() {
    let scene = load("house.pbrt", HOUSE);
    assert_eq!(names(&scene), ["paint", "tiles", "raw", "window", "frame"]);
    for material in &scene.materials {
        assert_eq!(material.lobe.gamma, Interval::point(2.0));
        assert_eq!(material.masking, Some(Masking::HeightCorrelated));
        assert_eq!(material.origin.format, Format::Pbrt);
        assert!(material.used, "no shape says otherwise");
    }
    let roughness = |name| named(&scene, name).lobe.roughness;
    assert_eq!(roughness("paint"), isotropic(0.2));
    assert_eq!(roughness("tiles"), isotropic(0.03));
    assert_eq!(roughness("raw"), isotropic(0.04));
    assert_eq!(roughness("window"), Roughness::Smooth);
    assert_eq!(roughness("frame"), anisotropic(0.3, 0.1));
    assert_eq!(named(&scene, "paint").fresnel, Some(Reflectance::dielectric(1.5)));
    assert_eq!(named(&scene, "frame").fresnel, Some(Metal::Aluminium.into()));
    assert_eq!(named(&scene, "raw").origin.place.line, Some(13));

    let ignored: Vec<_> = scene.ignored.iter().map(|i| (&i.name[..], &i.kind[..])).collect();
    assert_eq!(ignored, [("plaster", "diffuse"), ("sofa", "measured")]);
    assert_eq!(scene.warnings, [""; 0]);
}

#[test]
fn below_a_thousandth_alpha_is_smooth() {
    let material = |parameters: &str| {
        let text = format!("Material 'conductor' 'bool remaproughness' false {parameters}");
        load("a.pbrt", &text).materials[0].lobe.roughness
    };
    assert_eq!(material("'float roughness' 0.0009"), Roughness::Smooth);
    assert_eq!(material("'float roughness' 0.001"), isotropic(0.001));
    // One rough axis makes the other rough, too.
    assert_eq!(material("'float uroughness' 0.5"), anisotropic(0.5, 1e-4));
    assert_eq!(material("'float uroughness' 0.0005 'float vroughness' 0.0009"), Roughness::Smooth);
    assert_eq!(material("'float uroughness' 0.5 'float roughness' 0.25"), anisotropic(0.5, 0.25));
}

#[test]
fn a_material_is_used_where_a_shape_wears_it() {
    let scene = load(
        "a.pbrt",
        r#"
        MakeNamedMaterial "outer" "string type" "conductor" "float roughness" 0.01
        MakeNamedMaterial "inner" "string type" "conductor" "float roughness" 0.04
        MakeNamedMaterial "left" "string type" "conductor" "float roughness" 0.09
        MakeNamedMaterial "right" "string type" "mix" "string materials" [ "left" "inner" ]
        MakeNamedMaterial "blend" "string type" "mix" "string materials" [ "right" "left" ]
        MakeNamedMaterial "spare" "string type" "conductor" "float roughness" 0.16
        WorldBegin
        Shape "sphere"   # in the default material
        NamedMaterial "outer"
        AttributeBegin
            NamedMaterial "spare"
            Material "conductor" "float roughness" 0.25
            AttributeBegin
                NamedMaterial "blend"
                Shape "sphere" "float radius" 1
            AttributeEnd
        AttributeEnd
        Shape "trianglemesh" "integer indices" [ 0 1 2 ] "string name" [ "a ] # [ \" b" ] # ]
            "point3 P" [ 0 0 0  1 0 0  0 1 0 ]
        Material "interface"
        Shape "sphere"
        "#,
    );
    let used = |name: &str| named(&scene, name).used;
    assert!(used("outer"), "returned to at AttributeEnd");
    assert!(used("left") && used("inner"), "parts of a mixture of a mixture");
    assert!(!used("spare") && !used("conductor at a.pbrt:13"), "replaced before a shape");
}

#[test]
fn attributes_are_defaults_in_their_block() {
    let scene = load(
        "a.pbrt",
        r#"
        AttributeBegin
            Attribute "material" "float roughness" 0.04 "bool remaproughness" false
            Material "conductor"
            Material "conductor" "float roughness" 0.5
        AttributeEnd
        Material "conductor"
        "#,
    );
    let roughness: Vec<_> = scene.materials.iter().map(|m| m.lobe.roughness).collect();
    assert_eq!(roughness, [isotropic(0.04), isotropic(0.5), Roughness::Smooth]);
}

#[test]
fn included_files_belong_to_the_scene() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(br#"NamedMaterial "b" Shape "sphere""#).unwrap();
    let folder = Folder::new(&[
        (
            "a.pbrt",
            &br#"Include "materials.pbrt" NamedMaterial "a" Import "shapes.pbrt.gz" Shape "disk""#
                [..],
        ),
        (
            "materials.pbrt",
            br#"MakeNamedMaterial "a" "string type" "conductor" "float roughness" 0.01
                MakeNamedMaterial "b" "string type" "conductor" "float roughness" 0.04
                MakeNamedMaterial "c" "string type" "conductor" "float roughness" 0.09"#,
        ),
        ("shapes.pbrt.gz", &packed.finish().unwrap()),
    ]);
    let scene = folder.load("a.pbrt").unwrap();
    let used: Vec<_> = scene.materials.iter().map(|m| m.used).collect();
    assert_eq!(used, [true, true, false], "an import leaves the current material as it was");
    assert!(scene.materials[0].origin.place.file.ends_with("materials.pbrt"));
    assert_warned(&folder.load("shapes.pbrt.gz").unwrap(), ":1:1", &["'b' is not defined"]);
}

#[test]
fn damage_in_a_packed_file_has_a_line() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::none());
    packed.write_all("WorldBegin\n".repeat(100).as_bytes()).unwrap();
    // The header of the file has 10 bytes, and that of its block 5.
    let packed = &packed.finish().unwrap()[..10 + 5 + 37 * 11 + 3];
    let error = Folder::new(&[("a.pbrt.gz", packed)]).load("a.pbrt.gz").unwrap_err().to_string();
    assert!(error.contains("a.pbrt.gz:38:4: cannot be read"), "{error}");
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
