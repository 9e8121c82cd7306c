//! DirectDraw Surface, with the header of Direct3D 10 (Microsoft, "Programming Guide for DDS").

use super::{bytes, extent, is_volume};
use crate::texture::Texture;

/// DDSD_CAPS, DDSD_HEIGHT, DDSD_WIDTH and DDSD_PIXELFORMAT.
const STATED: u32 = 0x1 | 0x2 | 0x4 | 0x1000;
/// DDSD_PITCH: bytes of a row.
const PITCH: u32 = 0x8;
/// DDSD_DEPTH: the number of slices.
const DEPTH: u32 = 0x80_0000;
/// DDPF_FOURCC, since the format is in the header of Direct3D 10, and DDPF_RGB, which states the
/// bits of a pixel.
const CODE: u32 = 0x4 | 0x40;
/// DDSCAPS_TEXTURE, and of a volume DDSCAPS_COMPLEX and DDSCAPS2_VOLUME.
const TEXTURE: u32 = 0x1000;
const COMPLEX: u32 = 0x8;
const VOLUME: u32 = 0x20_0000;

pub(super) fn encode(texture: &Texture) -> Vec<u8> {
    // DXGI_FORMAT_R32_FLOAT, R32G32_FLOAT, R16_FLOAT and R16G16_FLOAT; none is an opacity.
    let (format, pixel) = match (texture.half, texture.spec.channels.len()) {
        (false, 1) => (41, 4),
        (false, _) => (16, 8),
        (true, 1) => (54, 2),
        (true, _) => (34, 4),
    };
    let [width, height, depth] = extent(texture).map(|n| n as u32);
    let volume = is_volume(texture);
    let if_volume = |x| if volume { x } else { 0 };
    let surface = [
        124,
        STATED | PITCH | if_volume(DEPTH),
        height,
        width,
        width * pixel,
        if_volume(depth),
        // Levels beside the first, and eleven words without use.
        0,
    ];
    let code = [32, CODE, u32::from_le_bytes(*b"DX10"), 8 * pixel, 0, 0, 0, 0];
    let kind = [TEXTURE | if_volume(COMPLEX), if_volume(VOLUME), 0, 0, 0];
    // Dimensions as Direct3D counts resources: 3 is a texture of two, 4 of three; then an array of
    // one.
    let direct3d = [format, if volume { 4 } else { 3 }, 0, 1, 0];
    let header = [&surface[..], &[0; 11], &code, &kind, &direct3d].concat();
    let header: Vec<u8> = header.into_iter().flat_map(u32::to_le_bytes).collect();
    [b"DDS ".to_vec(), header, bytes(texture)].concat()
}
