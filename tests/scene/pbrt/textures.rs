//! Ranges of float textures.

use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};
use png::ColorType;

use microfacet_baker::scene::{Roughness, Scene};
use microfacet_tables::Interval;

use crate::{
    Folder, assert_close, assert_not_understood, assert_warned, isotropic, load, named, png_of,
};

/// A PNG of 51 and 102.
fn grey() -> Vec<u8> {
    png_of(ColorType::Grayscale, 4, &[[51; 15].as_slice(), &[102]].concat())
}

/// A scene whose only α is the image, under the parameters of its texture.
fn scene(file: &str, image: Vec<u8>, parameters: &str) -> Scene {
    let text = format!(
        "Texture 't' 'float' 'imagemap' 'string filename' '{file}' {parameters}
         Material 'dielectric' 'texture roughness' 't' 'bool remaproughness' false"
    );
    Folder::new(&[(file, image), ("a.pbrt", text.into_bytes())]).load("a.pbrt").unwrap()
}

#[track_caller]
fn check(file: &str, image: Vec<u8>, parameters: &str, sigma: [f64; 2]) {
    let scene = scene(file, image, parameters);
    assert_eq!(scene.warnings, [""; 0]);
    assert_close(scene.materials[0].lobe.roughness, sigma, sigma);
}

const LINEAR: &str = "'string encoding' 'linear'";

/// 51/255 and 102/255 by the definition of sRGB.
const DECODED: [f64; 2] = [0.033_104_766_570_885_055, 0.132_868_321_553_817_98];

#[test]
fn an_image_is_read_in_the_channels_of_its_filter() {
    let png = png_of(ColorType::Rgb, 2, &[51, 102, 255, 51, 204, 0]);
    let mean = [1.0 / 3.0, 1.6 / 3.0];
    for (filter, sigma) in [
        ("", mean),
        ("'string filter' 'bilinear'", mean),
        ("'string filter' 'trilinear'", mean),
        ("'string filter' 'point'", [0.2, 0.2]),
        ("'string filter' 'ewa'", [0.2, 1.6 / 3.0]),
        ("'string filter' 'EWA'", [0.2, 1.6 / 3.0]),
    ] {
        check("rgb.png", png.clone(), &format!("{LINEAR} {filter}"), sigma);
    }
}

#[test]
fn opacity_counts_where_it_is_not_1_everywhere() {
    let image = |alpha| png_of(ColorType::Rgba, 2, &[51, 51, 51, 255, 102, 102, 102, alpha]);
    check("a.png", image(255), LINEAR, [0.2, 0.4]);
    check("a.png", image(102), LINEAR, [0.4, 1.0]);
    check("a.png", image(102), &format!("{LINEAR} 'string filter' 'point'"), [0.2, 0.4]);
    // Decoded from sRGB like the colours.
    check("a.png", image(255), "", DECODED);
    check("a.png", image(102), "", [DECODED[1], 1.0]);
    let pixels = [(0.5_f32, 0.25_f32, 0.75_f32, 0.25_f32), (0.5, 0.5, 0.5, 0.75)];
    let floats = SpecificChannels::rgba(|Vec2(x, _)| pixels[x]);
    let mut exr = std::io::Cursor::new(Vec::new());
    Image::from_channels((2, 1), floats).write().to_buffered(&mut exr).unwrap();
    check("a.exr", exr.into_inner(), "", [0.25, 0.75]);
}

#[test]
fn the_mean_is_of_decoded_channels() {
    let image = png_of(ColorType::Rgb, 2, &[51, 102, 102].repeat(2));
    let mean = (DECODED[0] + 2.0 * DECODED[1]) / 3.0;
    check("rgb.png", image, "", [mean, mean]);
}

/// A JPEG of 8 by 8 pixels of 102, in its segments: one component, and codes of one bit.
const JPEG: [&[u8]; 9] = [
    b"\xFF\xD8",
    b"\xFF\xDB\0\x43\0",
    &[1; 64],
    b"\xFF\xC0\0\x0B\x08\0\x08\0\x08\x01\x01\x11\0",
    // The mean by a difference of eight bits, and no other coefficient.
    b"\xFF\xC4\0\x14\0\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x08",
    b"\xFF\xC4\0\x14\x10\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
    b"\xFF\xDA\0\x08\x01\x01\0\0\x3F\0",
    // 8 (102 - 128) = -208: the code 0, then 255 - 208 = 00101111, and the code 0.
    &[0b0001_0111, 0b1011_1111],
    b"\xFF\xD9",
];

#[test]
fn only_a_png_has_an_encoding_to_choose() {
    let jpeg = JPEG.concat();
    check("a.jpg", jpeg, LINEAR, [DECODED[1], DECODED[1]]);
    let scene = scene("A.PNG", grey(), "'string encoding' 'gamma 2.2'");
    assert_warned(&scene, ":1:1", &["A.PNG", "other than 'sRGB' and 'linear'"]);
}

#[test]
fn textures_give_ranges() {
    let folder = Folder::new(&[
        ("grey.png", grey()),
        (
            "a.pbrt",
            br#"
            Texture "linear" "float" "imagemap" "string filename" "grey.png" "string encoding" "linear"
            Texture "scaled" "float" "scale" "texture tex" "linear" "float scale" 0.5
            Texture "inverted" "float" "imagemap" "string filename" "grey.png"
                "string encoding" "linear" "bool invert" true "float scale" 2
            Texture "srgb" "float" "imagemap" "string filename" "grey.png"
            Texture "board" "float" "checkerboard" "float tex1" 0.3 "texture tex2" "linear"
            Texture "half" "float" "mix" "texture tex1" "linear" "float tex2" 1
            MakeNamedMaterial "scaled" "string type" "dielectric" "texture roughness" "scaled"
                "bool remaproughness" false
            MakeNamedMaterial "inverted" "string type" "dielectric" "texture roughness" "inverted"
                "bool remaproughness" false
            MakeNamedMaterial "remapped" "string type" "dielectric" "texture roughness" "linear"
            MakeNamedMaterial "srgb" "string type" "dielectric" "texture roughness" "srgb"
                "bool remaproughness" false
            MakeNamedMaterial "board" "string type" "dielectric" "texture uroughness" "board"
                "float vroughness" 0.5 "bool remaproughness" false
            MakeNamedMaterial "half" "string type" "dielectric" "texture uroughness" "half"
                "texture vroughness" "half" "bool remaproughness" false
            "#
            .to_vec(),
        ),
    ]);
    let scene = folder.load("a.pbrt").unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    let check = |name: &str, x: [f64; 2], y: [f64; 2]| {
        assert_close(named(&scene, name).lobe.roughness, x, y)
    };
    check("scaled", [0.1, 0.2], [0.1, 0.2]);
    check("inverted", [0.2, 0.6], [0.2, 0.6]);
    check("remapped", [0.2f64.sqrt(), 0.4f64.sqrt()], [0.2f64.sqrt(), 0.4f64.sqrt()]);
    check("srgb", DECODED, DECODED);
    check("board", [0.2, 0.4], [0.5, 0.5]);
    check("half", [0.6, 0.7], [0.6, 0.7]);
    assert!(named(&scene, "half").lobe.roughness.is_isotropic(), "one texture on both axes");
    assert!(!named(&scene, "board").lobe.roughness.is_isotropic());
}

#[test]
fn textures_that_double_their_references_take_no_longer() {
    let chain = |length: u32| {
        let texture = |i: u32| {
            format!(
                "Texture 't{}' 'float' 'mix' 'texture tex1' 't{i}' 'texture tex2' 't{i}'\n",
                i + 1
            )
        };
        let textures: String = (0..length).map(texture).collect();
        format!(
            "Texture 't0' 'float' 'constant' 'float value' 0.25\n{textures}\
             Material 'conductor' 'texture roughness' 't{length}'"
        )
    };
    // Without values that are kept, 2^100 references would be followed.
    assert_eq!(load("a.pbrt", &chain(100)).materials[0].lobe.roughness, isotropic(0.5));
    let scene = load("a.pbrt", &chain(1000));
    let name = "conductor at a.pbrt:1002";
    assert_not_understood(&scene, name, ":1002:1", &["a.pbrt:874:30: ", "more than 128 deep"]);
}

#[test]
fn a_missing_image_is_the_full_range_with_a_warning() {
    let scene = load(
        "a.pbrt",
        r#"
        Texture "t" "float" "imagemap" "string filename" "absent.png" "float scale" 0.25
        Material "conductor" "texture roughness" "t"
        Texture "n" "float" "fbm"
        Material "conductor" "texture roughness" "n"
        "#,
    );
    assert_eq!(
        scene.materials[0].lobe.roughness,
        Roughness::Isotropic(Interval { min: 0.0, max: 0.5 })
    );
    assert_eq!(scene.materials[1].lobe.roughness, Roughness::Isotropic(Interval::UNIT));
    let [missing, noise] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    assert!(missing.contains("a.pbrt:2:9: ") && missing.contains("absent.png"), "{missing}");
    assert!(noise.contains("fbm") && noise.contains("[0, 1]"), "{noise}");
}
