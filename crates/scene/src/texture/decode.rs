//! Pixels of PNG, JPEG and OpenEXR, within limits.

use std::fmt::Display;
use std::io::{self, Cursor};

use exr::prelude::{ReadChannels, ReadLayers, Text, Vec2};
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::charge;
use crate::limits::{self, Budget};

/// Pixels of 1 to 4 samples: grey or red, green and blue, either with opacity behind it.
pub(super) struct Pixels {
    pub(super) stride: usize,
    pub(super) samples: Samples,
}

/// Samples of all pixels.
pub(super) enum Samples {
    /// 255 stands for 1.
    Eight(Vec<u8>),
    /// 65535 stands for 1; big-endian.
    Sixteen(Vec<u8>),
    /// As they are.
    Floats(Vec<f32>),
}

/// Decodes an image of a format that its first bytes tell.
///
/// The error completes the sentence "texture x ...".
pub(super) fn decode(bytes: &[u8], left: &Budget) -> Result<Pixels, String> {
    match bytes {
        [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1A, b'\n', ..] => png(bytes, left),
        [0xFF, 0xD8, 0xFF, ..] => jpeg(bytes, left),
        [0x76, 0x2F, 0x31, 0x01, ..] => exr(bytes, left),
        _ => Err(undecoded("it is no PNG, JPEG or OpenEXR image")),
    }
}

fn undecoded(why: impl Display) -> String {
    format!("cannot be decoded ({why})")
}

fn unread(why: io::Error) -> String {
    format!("is not read ({why})")
}

/// The bytes of so many pixels; the largest number where they would overflow it.
fn memory([width, height]: [usize; 2], pixel: usize) -> u64 {
    (width as u64).saturating_mul(height as u64).saturating_mul(pixel as u64)
}

/// Refuses pixels that take more memory than one image may; `what` precedes their number.
fn limited(what: &str, size: [usize; 2], pixel: usize) -> Result<u64, String> {
    let bytes = memory(size, pixel);
    if bytes > limits::IMAGE {
        let ([width, height], limit) = (size, limits::IMAGE >> 20);
        return Err(format!(
            "has {what}{width} x {height} pixels, which take more than {limit} MiB to decode"
        ));
    }
    Ok(bytes)
}

/// The number of samples of an image, whose memory is limited and taken from the scene's.
fn samples(size: [usize; 2], stride: usize, bytes: usize, left: &Budget) -> Result<usize, String> {
    charge(left, limited("", size, stride * bytes)?).map_err(unread)?;
    Ok(size[0] * size[1] * stride)
}

/// The image itself, without colour management. Of an animation it is the first picture.
fn png(bytes: &[u8], left: &Budget) -> Result<Pixels, String> {
    let undecoded = |why| undecoded(format!("PNG: {why}"));
    let limits = png::Limits { bytes: limits::IMAGE as usize };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // Palettes become colours, a colour that is transparent an opacity, and fewer bits eight.
    decoder.set_transformations(png::Transformations::EXPAND);
    let (width, height) = decoder.read_header_info().map_err(undecoded)?.size();
    let size = [width, height].map(|edge| edge as usize);
    // The decoder's own limit, which comes next, states no size.
    limited("", size, 1)?;
    let mut reader = decoder.read_info().map_err(undecoded)?;
    let (color, depth) = reader.output_color_type();
    let (stride, deep) = (color.samples(), depth == png::BitDepth::Sixteen);
    let count = samples(size, stride, if deep { 2 } else { 1 }, left)?;
    let mut samples = vec![0; if deep { 2 * count } else { count }];
    reader.next_frame(&mut samples).map_err(undecoded)?;
    let samples = if deep { Samples::Sixteen(samples) } else { Samples::Eight(samples) };
    Ok(Pixels { stride, samples })
}

/// Grey stays grey; all else, CMYK included, becomes red, green and blue.
fn jpeg(bytes: &[u8], left: &Budget) -> Result<Pixels, String> {
    // Some messages of the codec are in quotes and end in a line break.
    let undecoded = |why: DecodeErrors| {
        undecoded(format!("JPEG: {}", why.to_string().trim_matches(['"', '\n'])))
    };
    // Neither dimension of a JPEG exceeds 65535; memory is limited below. Not strict, it takes what
    // is missing at the end of a file for grey, as viewers do.
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(undecoded)?;
    let (width, height) = decoder.dimensions().expect("a header was read");
    let grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
    let color = if grey { ColorSpace::Luma } else { ColorSpace::RGB };
    decoder.set_options(options.jpeg_set_out_colorspace(color));
    let stride = color.num_components();
    let mut pixels = vec![0; samples([width, height], stride, 1, left)?];
    decoder.decode_into(&mut pixels).map_err(undecoded)?;
    Ok(Pixels { stride, samples: Samples::Eight(pixels) })
}

/// The display window of the first part with R, G and B, and A if there is one; 0 where there is no
/// data.
fn exr(bytes: &[u8], left: &Budget) -> Result<Pixels, String> {
    let undecoded = |why: exr::error::Error| undecoded(format!("OpenEXR: {why}"));
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(undecoded)?;
    let has = |part: &exr::meta::header::Header, name| {
        part.channels.find_index_of_channel(&Text::from(name)).is_some()
    };
    let part = reader
        .headers()
        .iter()
        .find(|part| !part.deep && ["R", "G", "B"].iter().all(|&name| has(part, name)))
        .ok_or_else(|| undecoded(exr::error::Error::Invalid("no part has R, G and B".into())))?;
    let stride = if has(part, "A") { 4 } else { 3 };
    let window = part.shared_attributes.display_window;
    let Vec2(width, height) = window.size;
    let offset = part.own_attributes.layer_position - window.position;
    let count = samples([width, height], stride, 4, left)?;
    // Blocks are decoded whole: all channels of the data window, however large the display window.
    let pixel = part.channels.bytes_per_pixel;
    let [block, data] = [part.max_block_pixel_size(), part.layer_size].map(|Vec2(x, y)| [x, y]);
    limited("blocks of ", block, pixel)?;
    charge(left, memory(data, pixel)).map_err(unread)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            move |_, _| vec![0.0_f32; count],
            move |pixels, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let Vec2(x, y) = at.to_i32() + offset;
                let inside = |x, edge| usize::try_from(x).ok().filter(|&x| x < edge);
                if let (Some(x), Some(y)) = (inside(x, width), inside(y, height)) {
                    let first = (y * width + x) * stride;
                    pixels[first..first + stride].copy_from_slice(&[r, g, b, a][..stride]);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(undecoded)?;
    Ok(Pixels { stride, samples: Samples::Floats(image.layer_data.channel_data.pixels) })
}
