//! Reads the tables of engines: as shipped, or as `export lut --layout` writes them.

use std::array;
use std::io::{Cursor, Read};

use base64::Engine;
use half::f16;

use microfacet_export::ExportFile;
use microfacet_export::texture::engine::Layout;
use microfacet_export::texture::{Texture, TextureSpec};

/// The tables of a layout, without their averages, as the engine reads them from the files that
/// `file` gives by their names in the engine; none where a file is absent. Images say their size
/// themselves; other tables are of `size`.
pub fn decode(
    layout: &Layout,
    size: &[usize],
    file: impl Fn(&str) -> Option<Vec<u8>>,
) -> Option<Vec<Texture>> {
    let text = |name: &str| Some(String::from_utf8_lossy(&file(name)?).into_owned());
    let openpbr = |name: &str| {
        let numbers = array(&text(&format!("openpbr_{name}_data.h"))?, "clang-format off", "//");
        Some(numbers.into_iter().map(|x| x / 65535.0).collect::<Vec<f32>>())
    };
    let mut size = size.to_vec();
    let tables: Vec<Vec<f32>> = match layout.name {
        "cycles" => vec![array(&text("shader.tables")?, "table_ggx_E[", "}")],
        "cycles-glass" => {
            let text = text("shader.tables")?;
            ["table_ggx_glass_E[", "table_ggx_glass_inv_E["]
                .map(|mark| array(&text, mark, "}"))
                .into()
        }
        "openpbr" => vec![openpbr("ideal_metal_energy_complement")?],
        "openpbr-dielectric" => {
            let [all, reflected] = ["ideal", "opaque"]
                .map(|which| openpbr(&format!("{which}_dielectric_energy_complement")));
            let texels: Vec<[f32; 2]> =
                all?.into_iter().zip(reflected?).map(|(all, reflected)| [all, reflected]).collect();
            texels.chunks(texels.len() / 2).map(<[_]>::concat).collect()
        }
        "mdl" => mdl(&file("ggx_smith.bin")?),
        "eevee" => vec![array(&text("eevee_lut.cc")?, "brdf_ggx[", ";")],
        "osl" => vec![array(&text("microfacet_tools_luts.h")?, "energy = ", "}")],
        "filament" => {
            let numbers = text("dfg.inc")?.lines().skip(2).collect::<String>();
            vec![square(halves(&numbers), 3, &mut size)]
        }
        "three" => {
            let numbers = halves(&between(&text("DFGLUTData.js")?, "DATA = new", '[', "]"));
            vec![square(numbers, 2, &mut size)]
        }
        "bevy" => vec![ktx2(&file("dfg.ktx2")?, &mut size)],
        "babylon" => {
            let bytes = file("brdfTextureTools.js")?;
            let text = String::from_utf8_lossy(&bytes);
            let png = if text.starts_with("import") {
                let code = text.split("data:image/png;base64,").nth(1).expect("an image");
                let code = code.split('"').next().expect("its end");
                base64::engine::general_purpose::STANDARD.decode(code).expect("base64")
            } else {
                bytes
            };
            let texel = |[r, g, b, a]: [f32; 4]| [r, g, b].map(|x| x.powf(2.2) / a);
            vec![pixels(&png, &mut size).into_iter().flat_map(texel).collect()]
        }
        "gltf" => vec![pixels::<3>(&file("lut_ggx.png")?, &mut size).concat()],
        other => panic!("{other} has no reader here"),
    };
    let specs = layout.specs(2.0, &size, false).into_iter().filter(TextureSpec::is_directional);
    let texture = |(spec, values): (TextureSpec, Vec<f32>)| {
        let texels: usize = spec.axes.iter().map(|axis| axis.len()).product();
        assert_eq!(values.len(), texels * spec.channels.len(), "{}", layout.name);
        Texture { spec, values, half: false }
    };
    Some(specs.zip(tables).map(texture).collect())
}

/// As [`decode`], from the files that were written for the layout.
pub fn written(layout: &Layout, size: &[usize], files: &[ExportFile]) -> Vec<Texture> {
    let file = |name: &str| {
        let named = files.iter().find(|file| file.name == name);
        // Some names say more than the engine's.
        named.or_else(|| files.first().filter(|_| files.len() == 1)).map(|f| f.contents.clone())
    };
    decode(layout, size, file).expect("every file")
}

/// The text from the first `open` after a mark to the next `close`.
fn between(text: &str, mark: &str, open: char, close: &str) -> String {
    let rest = text.split_once(mark).expect("the mark").1;
    let body = rest.split_once(open).expect("its beginning").1;
    body.split_once(close).expect("its end").0.to_owned()
}

/// The decimal numbers from the next line or brace after a mark to the next `close`, of any
/// nesting.
fn array(text: &str, mark: &str, close: &str) -> Vec<f32> {
    let open = if close == "//" { '\n' } else { '{' };
    let body = between(text, mark, open, close).replace(['{', '}'], " ");
    let numbers = body.split(',').map(|x| x.trim().trim_end_matches('f')).filter(|x| !x.is_empty());
    numbers.map(|x| x.parse().expect("a number")).collect()
}

/// The tables of MDL: a slice of a conductor, slices of a dielectric from outside, and from inside.
/// Each row ends with a number that is no albedo.
fn mdl(bytes: &[u8]) -> Vec<Vec<f32>> {
    let numbers: Vec<[u8; 4]> = bytes.as_chunks().0.to_vec();
    let [rough, angles, indices] = [0, 1, 2].map(|i| u32::from_le_bytes(numbers[i]) as usize);
    let rows: Vec<&[[u8; 4]]> = numbers[3..].chunks(angles + 1).collect();
    let (conductor, dielectrics) = rows.split_at(rough);
    let (outside, inside) = dielectrics.split_at(rough * indices);
    let row = |row: &&[[u8; 4]]| row[..angles].iter().map(|&x| f32::from_le_bytes(x)).collect();
    [conductor, outside, inside]
        .map(|rows| rows.iter().map(row).collect::<Vec<Vec<f32>>>().concat())
        .into()
}

/// Hexadecimal sixteen-bit floats.
fn halves(text: &str) -> Vec<f32> {
    let numbers = text.split(',').map(str::trim).filter(|x| !x.is_empty());
    let half = |x: &str| u16::from_str_radix(x.trim_start_matches("0x"), 16).expect("hexadecimal");
    numbers.map(|x| f16::from_bits(half(x)).to_f32()).collect()
}

/// Red, green, blue and opacity of any PNG, or the first N of them; `size` is then its own.
fn pixels<const N: usize>(file: &[u8], size: &mut Vec<usize>) -> Vec<[f32; N]> {
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
    *size = vec![frame.height as usize, frame.width as usize];
    bytes.chunks(samples).map(pixel).collect()
}

/// The values of a square texture; `size` is then its own.
fn square(values: Vec<f32>, channels: usize, size: &mut Vec<usize>) -> Vec<f32> {
    let side = (values.len() / channels).isqrt();
    *size = vec![side, side];
    values
}

/// The halves of KTX 2; `size` is then its own.
fn ktx2(bytes: &[u8], size: &mut Vec<usize>) -> Vec<f32> {
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
    *size = vec![header.pixel_height as usize, header.pixel_width as usize];
    data.chunks(2).map(|x| f16::from_le_bytes([x[0], x[1]]).to_f32()).collect()
}
