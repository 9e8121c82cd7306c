//! Roughness and anisotropy by images, in each format: the range of σ along each axis, with the
//! format's own mapping at both ends.

use microfacet_baker::scene::{Roughness, Scene};
use png::ColorType;

use crate::{Folder, assert_close, named, png, png_of};

/// A scene beside images of 0.2 and 0.4 (`u.png`), of 0.4 and 0.8 (`v.png`), and of colours.
fn scene(name: &str, text: &str) -> Scene {
    let grey = |samples: [u8; 2]| png_of(ColorType::Grayscale, 2, &samples);
    let folder = Folder::new(&[
        ("u.png", grey([51, 102])),
        ("v.png", grey([102, 204])),
        ("rgb.png", png()),
        (name, text.as_bytes().to_vec()),
    ]);
    let scene = folder.load(name).unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    scene
}

#[track_caller]
fn check(scene: &Scene, name: &str, x: [f64; 2], y: [f64; 2]) {
    let roughness = named(scene, name).lobe.roughness;
    assert!(!roughness.is_isotropic(), "{roughness:?}");
    assert_close(roughness, x, y);
}

#[test]
fn pbrt_takes_the_square_root_of_both_ends_unless_told_not_to() {
    let image = |name: &str, file: &str, more: &str| {
        format!(
            "Texture '{name}' 'float' 'imagemap' 'string filename' '{file}' \
             'string encoding' 'linear' {more}\n"
        )
    };
    let material = |name: &str, more: &str| {
        format!(
            "MakeNamedMaterial '{name}' 'string type' 'conductor' 'texture uroughness' 'u' \
             'texture vroughness' 'v' {more}\n"
        )
    };
    let text = image("u", "u.png", "")
        + &image("v", "v.png", "'float scale' 0.5 'bool invert' true")
        + &material("remapped", "")
        + &material("alpha", "'bool remaproughness' false");
    let scene = scene("a.pbrt", &text);
    // 1 - 0.8 / 2 and 1 - 0.4 / 2.
    let (u, v) = ([0.2, 0.4], [0.6, 0.8]);
    check(&scene, "remapped", u.map(f64::sqrt), v.map(f64::sqrt));
    check(&scene, "alpha", u, v);
}

#[test]
fn mitsuba_takes_alpha_as_it_is_and_squares_the_roughness_of_principled() {
    let image = |name: &str, file: &str| {
        format!(
            "<texture name='{name}' type='bitmap'><string name='filename' value='{file}'/>\
             <boolean name='raw' value='true'/></texture>"
        )
    };
    let bsdf = |id: &str, class: &str, content: &str| {
        format!("<bsdf type='{class}' id='{id}'>{content}</bsdf>")
    };
    let two = |u: &str, v: &str| image("alpha_u", u) + &image("alpha_v", v);
    let shared = "<ref name='alpha_u' id='map'/><ref name='alpha_v' id='map'/>";
    let principled = image("roughness", "u.png") + &image("anisotropic", "v.png");
    let text = format!(
        "<scene version='3.0.0'>{}{}{}{}{}</scene>",
        image("map", "u.png").replace("name='map'", "id='map'"),
        bsdf("two", "roughconductor", &two("u.png", "v.png")),
        bsdf("one", "roughconductor", &two("u.png", "u.png")),
        bsdf("shared", "roughconductor", shared),
        bsdf("principled", "principled", &principled),
    );
    let scene = scene("a.xml", &text);
    check(&scene, "two", [0.2, 0.4], [0.4, 0.8]);
    let aspect = [0.8, 0.4].map(|anisotropic| f64::sqrt(1.0 - 0.9 * anisotropic));
    let (least, most) = (0.2 * 0.2, 0.4 * 0.4);
    check(
        &scene,
        "principled",
        [least / aspect[1], most / aspect[0]],
        [least * aspect[0], most * aspect[1]],
    );
    // One texture on both axes: no stand-in is needed.
    for name in ["one", "shared"] {
        let roughness = named(&scene, name).lobe.roughness;
        assert!(matches!(roughness, Roughness::Isotropic(_)), "{name}: {roughness:?}");
        assert_close(roughness, [0.2, 0.4], [0.2, 0.4]);
    }
}

#[test]
fn gltf_mixes_the_squared_roughness_with_1_by_the_squared_strength() {
    let text = r#"{"asset": {"version": "2.0"}, "materials": [{"name": "brushed",
        "pbrMetallicRoughness": {"roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}},
        "extensions": {"KHR_materials_anisotropy":
            {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0}}}}],
        "textures": [{"source": 0}], "images": [{"uri": "rgb.png"}]}"#;
    // The roughness is green, 0.4 and 0.8, the strength blue, 1 and 0; both are halved.
    let y = [0.2 * 0.2, 0.4 * 0.4];
    check(&scene("a.gltf", text), "brushed", [y[0], y[1] + (1.0 - y[1]) * 0.25], y);
}

#[test]
fn materialx_follows_images_of_anisotropy_in_every_model() {
    let image = |name: &str, file: &str| {
        format!(
            "<image name='{name}' type='float'><input name='file' type='filename' \
             value='{file}'/></image>"
        )
    };
    let model = |class: &str, roughness: &str, anisotropy: &str| {
        format!(
            "<{class} name='{class}' type='surfaceshader'>\
             <input name='{roughness}' type='float' nodename='u'/>\
             <input name='{anisotropy}' type='float' nodename='v'/></{class}>"
        )
    };
    let text = format!(
        "<materialx version='1.39'>{}{}{}{}{}{}\
         <roughness_anisotropy name='pair' type='vector2'>\
         <input name='roughness' type='float' nodename='u'/>\
         <input name='anisotropy' type='float' nodename='v'/></roughness_anisotropy>\
         <conductor_bsdf name='c' type='BSDF'>\
         <input name='roughness' type='vector2' nodename='pair'/></conductor_bsdf>\
         <surface name='nodes' type='surfaceshader'>\
         <input name='bsdf' type='BSDF' nodename='c'/></surface></materialx>",
        image("u", "u.png"),
        image("v", "v.png"),
        model("standard_surface", "specular_roughness", "specular_anisotropy"),
        model("open_pbr_surface", "specular_roughness", "specular_roughness_anisotropy"),
        model("gltf_pbr", "roughness", "anisotropy_strength"),
        model("disney_principled", "roughness", "anisotropic"),
    );
    let scene = scene("a.mtlx", &text);
    let (least, most) = (0.2 * 0.2, 0.4 * 0.4);
    // The aspect of the greatest and of the least anisotropy.
    let aspect = [0.8, 0.4].map(|anisotropy| f64::sqrt(1.0 - anisotropy));
    let x = [least / aspect[1], most / aspect[0]];
    let y = [least * aspect[0], most * aspect[1]];
    for name in ["standard_surface", "disney_principled", "nodes"] {
        check(&scene, name, x, y);
    }
    let stretch = |a: f64| f64::sqrt(2.0 / (1.0 + (1.0 - a) * (1.0 - a)));
    check(
        &scene,
        "open_pbr_surface",
        [least * stretch(0.4), most * stretch(0.8)],
        [least * 0.2 * stretch(0.8), most * 0.6 * stretch(0.4)],
    );
    let along = |alpha: f64, strength: f64| alpha + (1.0 - alpha) * strength * strength;
    check(&scene, "gltf_pbr", [along(least, 0.4), along(most, 0.8)], [least, most]);
}
