//! Reads the tables of engines: as shipped, or as `export lut --layout` writes them.

use std::array;
use std::io::{Cursor, Read};

use base64::Engine;
use exr::prelude::{ReadChannels, ReadLayers};
use half::f16;

use microfacet_export::texture::Texture;
use microfacet_export::texture::engine::Layout;

/// The file of a layout in the folder of shipped ones.
pub fn file_of(layout: &Layout) -> Option<&'static str> {
    Some(match layout.name {
        "cycles" => "shader.tables",
        "openpbr" => "openpbr_ideal_metal_energy_complement_data.h",
        "three" => "DFGLUTData.js",
        "bevy" => "dfg.ktx2",
        "babylon" => "brdfTextureTools.js",
        "gltf" => "lut_ggx.png",
        // No file: built with the engine, rendered at its start, or given by its host.
        _ => return None,
    })
}

/// A file of a layout as the texture that its engine reads: square, of the size that the file has,
/// or that of the layout.
pub fn decode(layout: &Layout, bytes: &[u8]) -> Texture {
    let text = || String::from_utf8_lossy(bytes).into_owned();
    let (values, size): (Vec<f32>, _) = match layout.name {
        "cycles" => (array(&text(), "table_ggx_E[", '{', '}'), layout.size),
        "openpbr" => {
            let numbers = array(&text(), "clang-format off", '\n', '/');
            (numbers.into_iter().map(|x| x / 65535.0).collect(), layout.size)
        }
        "osl" => (array(&text(), "energy = ", '{', '}'), layout.size),
        "filament" => square(halves(&text().lines().skip(2).collect::<String>()), 3),
        "three" => square(halves(&between(&text(), "DATA = new", '[', ']')), 2),
        "bevy" => ktx2(bytes),
        "babylon" => {
            let text = text();
            let png = if text.starts_with("import") {
                let code = text.split("data:image/png;base64,").nth(1).expect("an image");
                let code = code.split('"').next().expect("its end");
                base64::engine::general_purpose::STANDARD.decode(code).expect("base64")
            } else {
                bytes.to_vec()
            };
            let (pixels, size) = pixels::<4>(&png);
            let texel = |[r, g, b, a]: [f32; 4]| [r, g, b].map(|x| x.powf(2.2) / a);
            (pixels.into_iter().flat_map(texel).collect(), size)
        }
        "gltf" => {
            let (pixels, size) = pixels::<3>(bytes);
            (pixels.concat(), size)
        }
        _ => floats(bytes),
    };
    let spec = layout.specs(2.0, size, false).remove(0);
    assert_eq!(values.len(), size[0] * size[1] * spec.channels.len(), "{}", layout.name);
    Texture { spec, values, half: false }
}

/// The text from the first `open` after a mark to the next `close`.
fn between(text: &str, mark: &str, open: char, close: char) -> String {
    let rest = text.split_once(mark).expect("the mark").1;
    let body = rest.split_once(open).expect("its beginning").1.trim_start_matches(open);
    body.split_once(close).expect("its end").0.to_owned()
}

/// The decimal numbers of [`between`].
fn array(text: &str, mark: &str, open: char, close: char) -> Vec<f32> {
    let body = between(text, mark, open, close);
    let numbers = body.split(',').map(|x| x.trim().trim_end_matches('f')).filter(|x| !x.is_empty());
    numbers.map(|x| x.parse().expect("a number")).collect()
}

/// Hexadecimal sixteen-bit floats.
fn halves(text: &str) -> Vec<f32> {
    let numbers = text.split(',').map(str::trim).filter(|x| !x.is_empty());
    let half = |x: &str| u16::from_str_radix(x.trim_start_matches("0x"), 16).expect("hexadecimal");
    numbers.map(|x| f16::from_bits(half(x)).to_f32()).collect()
}

/// Red, green, blue and opacity of any PNG, or the first N of them, and its height and width.
fn pixels<const N: usize>(file: &[u8]) -> (Vec<[f32; N]>, [usize; 2]) {
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().expect("an image");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a small image")];
    let frame = reader.next_frame(&mut bytes).expect("an image");
    let samples = frame.color_type.samples();
    let pixel = |pixel: &[u8]| {
        let (opacity, colour) = match samples {
            2 | 4 => pixel.split_last().expect("several samples"),
            _ => (&255, pixel),
        };
        array::from_fn(|i| if i == 3 { *opacity } else { colour[i % colour.len()] })
            .map(|x| f32::from(x) / 255.0)
    };
    let size = [frame.height, frame.width].map(|n| n as usize);
    (bytes.chunks(samples).map(pixel).collect(), size)
}

/// Colours of an OpenEXR image, and its height and width.
fn floats(file: &[u8]) -> (Vec<f32>, [usize; 2]) {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (vec![0.0; 3 * size.area()], size),
            |(values, size), at, (r, g, b): (f32, f32, f32)| {
                let first = 3 * at.flat_index_for_size(*size);
                values[first..first + 3].copy_from_slice(&[r, g, b]);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file))
        .expect("an image");
    let (values, size) = image.layer_data.channel_data.pixels;
    (values, [size.height(), size.width()])
}

fn square(values: Vec<f32>, channels: usize) -> (Vec<f32>, [usize; 2]) {
    let side = (values.len() / channels).isqrt();
    (values, [side, side])
}

fn ktx2(bytes: &[u8]) -> (Vec<f32>, [usize; 2]) {
    let reader = ktx2::Reader::new(bytes).expect("KTX 2");
    let header = reader.header();
    assert_eq!(header.format, Some(ktx2::Format::R16G16_SFLOAT));
    let level = reader.levels().next().expect("a level");
    let mut data = level.data.to_vec();
    if header.supercompression_scheme == Some(ktx2::SupercompressionScheme::Zstandard) {
        data.clear();
        let mut decoder = ruzstd::decoding::StreamingDecoder::new(level.data).expect("Zstandard");
        decoder.read_to_end(&mut data).expect("Zstandard");
    }
    let values = data.chunks(2).map(|x| f16::from_le_bytes([x[0], x[1]]).to_f32()).collect();
    (values, [header.pixel_height as usize, header.pixel_width as usize])
}
