//! Ranges of images of every form.

use std::io::Cursor;

use exr::prelude::{
    Blocks, Image, IntegerBounds, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage,
};
use png::{BitDepth, ColorType};

use super::*;

/// The file of an image with these samples; colours of a palette and opacities if there are any.
fn png_of(
    color: ColorType,
    depth: BitDepth,
    [width, height]: [u32; 2],
    [palette, opacities]: [&[u8]; 2],
    samples: &[u8],
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if !palette.is_empty() {
        encoder.set_palette(palette);
    }
    if !opacities.is_empty() {
        encoder.set_trns(opacities);
    }
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    file
}

/// Without palette or opacities.
const PLAIN: [&[u8]; 2] = [&[]; 2];

fn png() -> Vec<u8> {
    let mut samples = [51, 102, 255].repeat(6);
    samples[15..].copy_from_slice(&[51, 204, 0]);
    png_of(ColorType::Rgb, BitDepth::Eight, [3, 2], PLAIN, &samples)
}

fn read(bytes: &[u8], channel: Channel, encoding: Encoding) -> Result<Interval, String> {
    super::range(bytes, channel, encoding, &Budget::new(limits::IMAGES))
}

#[test]
fn each_channel_has_its_own_range() {
    let range = |channel| read(&png(), channel, Encoding::Linear).unwrap();
    assert_eq!(range(Channel::Red), Interval::point(0.2));
    assert_eq!(range(Channel::Green), Interval { min: 0.4, max: 0.8 });
    assert_eq!(range(Channel::Blue), Interval::UNIT);
    assert_eq!(range(Channel::Alpha), Interval::point(1.0));
    let luminance = range(Channel::Luminance);
    assert!((luminance.min - (0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722)).abs() < 1e-15);
    assert!((luminance.max - (0.2126 * 0.2 + 0.7152 * 0.8)).abs() < 1e-15);
}

#[test]
fn srgb_is_decoded_where_it_is_meant() {
    let range = read(&png(), Channel::Green, Encoding::Srgb).unwrap();
    // 102/255 and 204/255 by the definition of sRGB.
    assert!((range.min - 0.132_868_321_553_817_97).abs() < 1e-15);
    assert!((range.max - 0.603_827_338_855_337_7).abs() < 1e-15);
}

#[test]
fn every_form_of_png_is_read() {
    let read = |file: &[u8], channel| read(file, channel, Encoding::Linear).unwrap();
    let interval = |min, max| Interval { min, max };
    let grey = |depth, samples: &[u8]| png_of(ColorType::Grayscale, depth, [2, 1], PLAIN, samples);
    // Two pixels in the high bits of a byte.
    for (depth, samples, range) in [
        (BitDepth::One, &[0b0100_0000][..], Interval::UNIT),
        (BitDepth::Two, &[0b0110_0000], interval(1.0 / 3.0, 2.0 / 3.0)),
        (BitDepth::Four, &[0x3C], interval(0.2, 0.8)),
        (BitDepth::Eight, &[51, 204], interval(0.2, 0.8)),
        (BitDepth::Sixteen, &[0x33, 0x33, 0x12, 0x34], interval(f64::from(0x1234) / 65535.0, 0.2)),
    ] {
        for channel in [Channel::Red, Channel::Blue, Channel::Luminance, Channel::AlphaOrMean] {
            assert_eq!(read(&grey(depth, samples), channel), range, "{depth:?}");
        }
        assert_eq!(read(&grey(depth, samples), Channel::Alpha), Interval::point(1.0));
    }
    let both = png_of(ColorType::GrayscaleAlpha, BitDepth::Eight, [1, 1], PLAIN, &[51, 102]);
    assert_eq!(read(&both, Channel::Green), Interval::point(0.2));
    assert_eq!(read(&both, Channel::Alpha), Interval::point(0.4));
    let deep = [0x33, 0x33, 0, 0, 0xFF, 0xFF, 0x66, 0x66];
    let deep = png_of(ColorType::Rgba, BitDepth::Sixteen, [1, 1], PLAIN, &deep);
    assert_eq!(read(&deep, Channel::Red), Interval::point(0.2));
    assert_eq!(read(&deep, Channel::Alpha), Interval::point(0.4));
    // The second of three colours is transparent, and the third is not used.
    let palette: [&[u8]; 2] = [&[51, 102, 153, 204, 255, 0, 1, 2, 3], &[255, 102]];
    for (depth, samples) in [
        (BitDepth::One, &[0b0100_0000][..]),
        (BitDepth::Two, &[0b0001_0000]),
        (BitDepth::Four, &[0x01]),
        (BitDepth::Eight, &[0, 1]),
    ] {
        let file = png_of(ColorType::Indexed, depth, [2, 1], palette, samples);
        assert_eq!(read(&file, Channel::Red), interval(0.2, 0.8), "{depth:?}");
        assert_eq!(read(&file, Channel::Blue), interval(0.0, 0.6));
        assert_eq!(read(&file, Channel::AlphaOrMean), interval(0.4, 1.0));
    }
    // One colour is.
    let key: [&[u8]; 2] = [&[], &[0, 51]];
    let keyed = png_of(ColorType::Grayscale, BitDepth::Eight, [2, 1], key, &[51, 204]);
    assert_eq!(read(&keyed, Channel::Alpha), Interval::UNIT);
    assert_eq!(read(&keyed, Channel::Red), interval(0.2, 0.8));
}

#[test]
fn floats_are_linear_already() {
    let red = |at| if at == Vec2(0, 1) { 0.75_f32 } else { 0.25 };
    let channels = SpecificChannels::rgb(|at| (red(at), 0.5_f32, 4.0_f32));
    let mut exr = Cursor::new(Vec::new());
    Image::from_channels((2, 2), channels).write().to_buffered(&mut exr).unwrap();
    let exr = exr.into_inner();
    let range = |channel| read(&exr, channel, Encoding::Srgb).unwrap();
    assert_eq!(range(Channel::Red), Interval { min: 0.25, max: 0.75 });
    assert_eq!(range(Channel::Blue), Interval::point(4.0));
}

#[test]
fn what_is_no_image_is_said_to_be_none() {
    let error = read(b"no image", Channel::Red, Encoding::Linear).unwrap_err();
    assert!(error.contains("cannot be decoded"), "{error}");
    let absent = Path::new("absent.png");
    let read = |left: &Budget| file(absent, left);
    let error = Textures::default().range(absent, Channel::Red, Encoding::Linear, read);
    assert!(error.as_ref().is_err_and(|why| why.contains("cannot be read")), "{error:?}");
}

#[test]
fn an_image_is_read_once_and_only_while_the_scene_may_have_more() {
    // What was read counts, also if it is no image.
    for (bytes, read_once) in [(png(), true), (b"no image".repeat(11), false)] {
        let mut textures = Textures { left: Budget::new(200), ..Textures::default() };
        let mut range = |key: usize| {
            let read = |left: &Budget| charge(left, bytes.len() as u64).map(|()| bytes.clone());
            textures.range(Path::new(&"x".repeat(key)), Channel::Red, Encoding::Linear, read)
        };
        assert!(bytes.len() < 100);
        for _ in 0..9 {
            assert_eq!(range(1).is_ok(), read_once);
        }
        let errors: Vec<String> = (2..9).filter_map(|key| range(key).err()).collect();
        assert!(errors.iter().any(|error| error.contains("come to more than")), "{errors:?}");
    }
}

#[test]
fn the_size_of_an_image_is_known_before_it_is_decoded() {
    // A PNG that claims 100 000 by 100 000 pixels, and has none.
    let mut png = png();
    png[16..24].copy_from_slice(&[0, 1, 0x86, 0xA0, 0, 1, 0x86, 0xA0]);
    let mut sum = flate2::Crc::new();
    sum.update(&png[12..29]);
    png[29..33].copy_from_slice(&sum.sum().to_be_bytes());
    // A JPEG without tables: a frame of one component, and the start of its scan.
    let jpeg = b"\xFF\xD8\xFF\xC0\0\x0B\x08\xFF\xFE\xFF\xFD\x01\x01\x11\0\
        \xFF\xDA\0\x08\x01\x01\0\0\x3F\0";
    // An OpenEXR image of one pixel in a window of many.
    let mut exr = Cursor::new(Vec::new());
    let pixel = SpecificChannels::rgb(|_| (0.0_f32, 0.0_f32, 0.0_f32));
    let mut image = Image::from_channels((1, 1), pixel);
    image.attributes.display_window = IntegerBounds::from_dimensions((30_000, 20_000));
    image.write().to_buffered(&mut exr).unwrap();
    for (bytes, size) in
        [(&png[..], "100000 x 100000"), (jpeg, "65533 x 65534"), (exr.get_ref(), "30000 x 20000")]
    {
        let error = read(bytes, Channel::Red, Encoding::Linear).unwrap_err();
        assert_eq!(error, format!("has {size} pixels, which take more than 512 MiB to decode"));
    }
}

#[test]
fn blocks_of_an_openexr_image_are_decoded_within_the_limit() {
    let mut exr = Cursor::new(Vec::new());
    let pixel = SpecificChannels::rgb(|_| (0.0_f32, 0.0_f32, 0.0_f32));
    let blocks = Blocks::Tiles(Vec2(8192, 8192));
    let tiles = exr::prelude::Encoding { blocks, ..exr::prelude::Encoding::UNCOMPRESSED };
    let layer = Layer::new((1, 1), LayerAttributes::default(), tiles, pixel);
    Image::from_layer(layer).write().to_buffered(&mut exr).unwrap();
    let error = read(exr.get_ref(), Channel::Red, Encoding::Linear).unwrap_err();
    let size = "has blocks of 8192 x 8192 pixels, which take more than 512 MiB to decode";
    assert_eq!(error, size);
}
