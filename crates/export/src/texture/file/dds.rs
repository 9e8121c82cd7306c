//! DirectDraw Surface, with the header of Direct3D 10.

use ddsfile::{AlphaMode, Caps2, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};

use super::{bytes, extent, is_volume};
use crate::texture::Texture;

pub(super) fn encode(texture: &Texture) -> Result<Vec<u8>, String> {
    let format = match (texture.half, texture.spec.channels.len()) {
        (false, 1) => DxgiFormat::R32_Float,
        (false, _) => DxgiFormat::R32G32_Float,
        (true, 1) => DxgiFormat::R16_Float,
        (true, _) => DxgiFormat::R16G16_Float,
    };
    let [width, height, depth] = extent(texture).map(|n| n as u32);
    let volume = is_volume(texture);
    let params = NewDxgiParams {
        height,
        width,
        depth: volume.then_some(depth),
        format,
        mipmap_levels: None,
        array_layers: None,
        caps2: volume.then_some(Caps2::VOLUME),
        is_cubemap: false,
        resource_dimension: if volume {
            D3D10ResourceDimension::Texture3D
        } else {
            D3D10ResourceDimension::Texture2D
        },
        // None of the channels is an opacity.
        alpha_mode: AlphaMode::Unknown,
    };
    let mut dds = Dds::new_dxgi(params).map_err(|why| why.to_string())?;
    dds.data = bytes(texture);
    let mut out = Vec::new();
    dds.write(&mut out).map_err(|why| why.to_string())?;
    Ok(out)
}
