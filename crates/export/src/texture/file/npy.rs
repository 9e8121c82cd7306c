//! An array of NumPy, shaped as the texture, with an axis of channels if it has several.

use half::f16;
use npyz::{AutoSerialize, Serialize, WriterBuilder};

use crate::texture::Texture;

pub(super) fn encode(texture: &Texture) -> Result<Vec<u8>, String> {
    match texture.half {
        false => array(texture, texture.values.iter().copied()),
        true => array(texture, texture.values.iter().map(|&x| f16::from_f32(x))),
    }
}

fn array<T: AutoSerialize + Serialize>(
    texture: &Texture,
    values: impl Iterator<Item = T>,
) -> Result<Vec<u8>, String> {
    let mut shape: Vec<u64> = texture.size().iter().map(|&n| n as u64).collect();
    if texture.spec.channels.len() > 1 {
        shape.push(texture.spec.channels.len() as u64);
    }
    let mut out = Vec::new();
    let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
    let mut writer = options.writer(&mut out).begin_nd().map_err(|why| why.to_string())?;
    writer.extend(values).map_err(|why| why.to_string())?;
    writer.finish().map_err(|why| why.to_string())?;
    Ok(out)
}
