//! KTX 2 (<https://registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html>): the library has the parts
//! of the file, and here they are put in order.

use ktx2::dfd::Basic;
use ktx2::{Format, Header, Index, LevelIndex};

use super::{bytes, extent, is_volume};
use crate::texture::Texture;

const KEY: &str = "microfacet";

pub(in crate::texture) fn encode(texture: &Texture, description: Option<&str>) -> Vec<u8> {
    let (format, type_size) = match (texture.half, texture.spec.channels.len()) {
        (false, 1) => (Format::R32_SFLOAT, 4),
        (false, _) => (Format::R32G32_SFLOAT, 4),
        (true, 1) => (Format::R16_SFLOAT, 2),
        (true, _) => (Format::R16G16_SFLOAT, 2),
    };
    let [width, height, depth] = extent(texture);
    let depth = is_volume(texture).then_some(depth);
    let data = bytes(texture);
    encode_texels(format, type_size, [width, height], depth, &data, description).0
}

/// Texels of a plain format, with a depth if they are a volume; also where in the file they begin.
pub(crate) fn encode_texels(
    format: Format,
    type_size: u32,
    [width, height]: [usize; 2],
    depth: Option<usize>,
    data: &[u8],
    description: Option<&str>,
) -> (Vec<u8>, usize) {
    let (basic, _) = Basic::from_format(format).expect("a plain format");
    let block = ktx2::dfd::Block::Basic(basic).to_vec();
    let descriptor = [&(block.len() as u32 + 4).to_le_bytes()[..], &block].concat();
    // Keys in the order of their bytes, each entry to a multiple of four bytes.
    let writer = concat!("microfacet-bake ", env!("CARGO_PKG_VERSION"));
    let description = description.map(|text| entry(KEY, text)).unwrap_or_default();
    let entries = [entry("KTXwriter", writer), description].concat();

    let start = Header::LENGTH + LevelIndex::LENGTH;
    let at_entries = start + descriptor.len();
    let texel = data.len() / (width * height * depth.unwrap_or(1));
    // The level begins at a multiple of its texels' size and of four.
    let step = texel.max(4);
    let at_data = (at_entries + entries.len()).next_multiple_of(step);
    let header = Header {
        format: Some(format),
        type_size,
        pixel_width: width as u32,
        pixel_height: height as u32,
        pixel_depth: depth.unwrap_or(0) as u32,
        layer_count: 0,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: start as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: at_entries as u32,
            kvd_byte_length: entries.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let length = data.len() as u64;
    let level = LevelIndex {
        byte_offset: at_data as u64,
        byte_length: length,
        uncompressed_byte_length: length,
    };
    let mut out = [&header.as_bytes()[..], &level.as_bytes(), &descriptor, &entries].concat();
    out.resize(at_data, 0);
    out.extend(data);
    (out, at_data)
}

fn entry(key: &str, value: &str) -> Vec<u8> {
    let text = [key.as_bytes(), &[0], value.as_bytes(), &[0]].concat();
    let mut entry = [&(text.len() as u32).to_le_bytes()[..], &text].concat();
    entry.resize(entry.len().next_multiple_of(4), 0);
    entry
}
