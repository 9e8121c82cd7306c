//! Textures as images that engines load.

use png::ColorType;

use super::Texture;
use crate::ExportFile;
use crate::texture::file::ktx2;

/// The exponent with which Babylon.js decodes colours.
const GAMMA: f32 = 2.2;

/// Bevy: KTX 2 with two halves a texel.
pub(super) fn bevy(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let (texture, _) = textures[0].rounded();
    Ok(vec![ExportFile::new("dfg.ktx2", ktx2::encode(&texture, None))])
}

/// glTF: eight bits a channel, linear.
pub(super) fn gltf(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let bytes: Vec<u8> = textures[0].values.iter().map(|&x| eight_bits(x)).collect();
    png("lut_ggx.png", &textures[0], ColorType::Rgb, &bytes)
}

/// Babylon.js: colours over a divisor, which is opacity, in the gamma of displays. Of numbers up to
/// 1 the divisor 1 has the finest steps.
pub(super) fn babylon(textures: &[Texture]) -> Result<Vec<ExportFile>, String> {
    let texel = |rgb: &[f32]| {
        let colour = |x: f32| eight_bits(x.max(0.0).powf(1.0 / GAMMA));
        [colour(rgb[0]), colour(rgb[1]), colour(rgb[2]), 255]
    };
    let bytes: Vec<u8> = textures[0].values.chunks(3).flat_map(texel).collect();
    png("environmentBRDF.png", &textures[0], ColorType::Rgba, &bytes)
}

fn eight_bits(x: f32) -> u8 {
    (255.0 * x).round() as u8
}

fn png(
    name: &str,
    texture: &Texture,
    color: ColorType,
    bytes: &[u8],
) -> Result<Vec<ExportFile>, String> {
    let size = texture.size();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[1] as u32, size[0] as u32);
    encoder.set_color(color);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes));
    written.map_err(|why| why.to_string())?;
    Ok(vec![ExportFile::new(name, file)])
}
