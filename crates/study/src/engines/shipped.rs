//! Reads the tables of engines: as shipped, or as `export lut --layout` writes them.

use std::io::Read;

use base64::Engine;
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
            let image = image::load_from_memory(&png).expect("an image").to_rgba8();
            let texel = |p: &image::Rgba<u8>| {
                let [r, g, b, a] = p.0.map(|x| f32::from(x) / 255.0);
                [r, g, b].map(|x| x.powf(2.2) / a)
            };
            (image.pixels().flat_map(texel).collect(), size_of(&image))
        }
        "gltf" => {
            let image = image::load_from_memory(bytes).expect("an image").to_rgb8();
            let values = image.pixels().flat_map(|p| p.0.map(|x| f32::from(x) / 255.0)).collect();
            (values, size_of(&image))
        }
        _ => {
            let image = image::load_from_memory(bytes).expect("an image").to_rgb32f();
            (image.to_vec(), size_of(&image))
        }
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

fn size_of(image: &impl image::GenericImageView) -> [usize; 2] {
    [image.height(), image.width()].map(|n| n as usize)
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
