//! One table as an OpenEXR image: the last axis along x, the others stacked along y, table channels
//! as image channels.
//!
//! A table interpolated by Hermite cubics has its values in the luminance channel `Y`, which every
//! viewer shows, and its derivatives in `slope`. The string attribute `microfacet` holds the
//! description of the set.

use std::io::{BufReader, Cursor, Read};
use std::path::Path;

use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::*;
use half::f16;
use serde::Deserialize;

use microfacet_sampler::Tables;
use microfacet_tables::{
    LoadError, Precision, Provenance, Table, describe, reassemble, seal_document,
};

use super::image::table_of;
use crate::input::{self, MAX_TABLES, MAX_TEXT};

/// The attribute that holds the description.
const ATTRIBUTE: &str = "microfacet";

/// How pixels are stored; nothing else is read.
const ENCODING: Encoding = Encoding::SMALL_LOSSLESS;

/// EXR channel name of a table's channel.
fn channel_name(channel: &str) -> &str {
    if channel == "value" { "Y" } else { channel }
}

/// Encodes a table as an image, compressed without loss; half-precision tables give half channels,
/// all others f32.
///
/// # Errors
/// A message if the table is invalid or cannot be written.
pub fn encode(provenance: &Provenance, table: &Table) -> std::result::Result<Vec<u8>, String> {
    let document =
        describe(provenance, std::slice::from_ref(table)).map_err(|why| why.to_string())?;
    let document = seal_document(&ascii(&document), &table.values)
        .ok_or("the description has no place for a checksum")?;
    let bytes = if table.precision == Precision::F16 { 2 } else { 4 };
    check_samples(bytes * table.values.len() as u64)?;
    let width = table.axes.last().map_or(1, microfacet_tables::Axis::len);
    let count = table.channels.len();
    let height = table.values.len() / count / width;
    let channels = table.channels.iter().enumerate().map(|(i, channel)| {
        let samples = table.values.iter().skip(i).step_by(count).copied();
        channel_of(channel_name(channel), flat(table.precision == Precision::F16, samples))
    });
    let mut attributes = named(&table.name);
    describe_with(&mut attributes, &document)?;
    write_layer((width, height), attributes, AnyChannels::sort(channels.collect()))
}

/// Encodes channels in 32 bits, or in 16, as an image, compressed without loss. A description is
/// the string attribute `microfacet`.
///
/// # Errors
/// A message if it cannot be written.
///
/// # Panics
/// If a channel has another number of samples than the image, or a name that is not ASCII.
pub fn encode_channels(
    name: &str,
    size: [usize; 2],
    channels: impl IntoIterator<Item = (&'static str, Vec<f32>)>,
    half: bool,
    description: Option<&str>,
) -> std::result::Result<Vec<u8>, String> {
    let channels = channels
        .into_iter()
        .map(|(channel, samples)| channel_of(channel, flat(half, samples.into_iter())))
        .collect();
    let mut attributes = named(name);
    if let Some(text) = description {
        describe_with(&mut attributes, text)?;
    }
    write_layer((size[0], size[1]), attributes, AnyChannels::sort(channels))
}

fn flat(half: bool, samples: impl Iterator<Item = f32>) -> FlatSamples {
    if half {
        FlatSamples::F16(samples.map(f16::from_f32).collect())
    } else {
        FlatSamples::F32(samples.collect())
    }
}

/// The attributes of a layer of this name: what follows a measured file may be named in any script.
fn named(name: &str) -> LayerAttributes {
    LayerAttributes::named(Text::new_or_panic(ascii(name)))
}

fn describe_with(attributes: &mut LayerAttributes, text: &str) -> std::result::Result<(), String> {
    let text = Text::new_or_none(text).ok_or("the description cannot be stored in EXR")?;
    // Only one custom attribute: the library writes them in the order of a hash map.
    attributes.other.insert(Text::new_or_panic(ATTRIBUTE), AttributeValue::Text(text));
    Ok(())
}

/// Samples that are no intensities of light: a lossy compressor should quantise them evenly.
fn channel_of(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel {
        name: Text::new_or_panic(name),
        sample_data: samples,
        quantize_linearly: true,
        sampling: Vec2(1, 1),
    }
}

fn write_layer(
    size: (usize, usize),
    attributes: LayerAttributes,
    channels: AnyChannels<FlatSamples>,
) -> std::result::Result<Vec<u8>, String> {
    let layer = Layer::new(size, attributes, ENCODING, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|why| why.to_string())?;
    Ok(bytes.into_inner())
}

/// Reads an image back into a set of one table.
///
/// # Errors
/// [`LoadError`] for an image that is damaged or was not written by [`encode`].
pub fn decode(bytes: &[u8]) -> std::result::Result<Tables, LoadError> {
    let invalid = |why: String| LoadError::Invalid(why);
    check_header(bytes).map_err(invalid)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|why| invalid(format!("OpenEXR: {why}")))?;
    let layer = image.layer_data;
    let document = document(&layer.attributes).ok_or_else(|| {
        invalid(format!("an OpenEXR image, but without the `{ATTRIBUTE}` attribute of a table"))
    })?;
    let channels = only_table(&document).map_err(invalid)?.channels;
    // Every channel is one of the table: a list that repeats one could ask for any memory.
    if channels.len() != layer.channel_data.list.len() {
        return Err(invalid("the channels are not those of the description".into()));
    }
    let mut columns = Vec::new();
    for channel in &channels {
        let name = channel_name(channel);
        let found = layer.channel_data.list.iter().find(|stored| stored.name == *name);
        let found = found.ok_or_else(|| invalid(format!("no channel `{name}`")))?;
        columns.push(found.sample_data.values_as_f32());
    }
    let pixels = layer.size.area();
    let mut values = Vec::with_capacity(pixels * columns.len());
    for _ in 0..pixels {
        values.extend(columns.iter_mut().filter_map(Iterator::next));
    }
    if seal_document(&document, &values).is_none_or(|sealed| sealed != document) {
        return Err(invalid(
            "checksum does not match: the file is damaged or was edited; bake again".into(),
        ));
    }
    let mut values = Some(values);
    let (provenance, tables) =
        reassemble(&document, |_| values.take().ok_or("more than one table".to_string()))?;
    Tables::from_tables(provenance, tables)
}

/// Largest image, in bytes of its samples; the values made of them take up to twice as much again.
const MAX_SAMPLES: u64 = MAX_TABLES / 4;

/// Refuses an image that would take too much memory to read.
fn check_samples(bytes: u64) -> std::result::Result<(), String> {
    if bytes <= MAX_SAMPLES {
        return Ok(());
    }
    Err(format!(
        "OpenEXR: samples of {bytes} bytes, and at most {} MiB are read: bake safetensors instead, or a lower quality or precision",
        MAX_SAMPLES >> 20
    ))
}

/// Largest allowed ratio of image size to file size. Tables compress by less than four; DEFLATE
/// alone could reach a thousand.
const EXPANSION: usize = 64;

/// Refuses what [`encode`] does not write, before any pixel is decoded.
fn check_header(bytes: &[u8]) -> std::result::Result<(), String> {
    let meta =
        MetaData::read_from_buffered(bytes, false).map_err(|why| format!("OpenEXR: {why}"))?;
    if let [header] = &meta.headers[..] {
        check_encoding(header)?;
        check_size(header, bytes.len())
    } else {
        Err(format!("OpenEXR: {} parts, and a table is an image of one", meta.headers.len()))
    }
}

/// No table needs decoders of other compressions, and on hostile blocks that of B44 overflows
/// (`exr` 1.74.2, `unpack14`).
fn check_encoding(header: &Header) -> std::result::Result<(), String> {
    let known = |channel: &ChannelDescription| {
        channel.sample_type != SampleType::U32 && channel.sampling == Vec2(1, 1)
    };
    let found = if header.compression != ENCODING.compression {
        header.compression.to_string()
    } else if header.deep || header.blocks != BlockDescription::ScanLines {
        "tiles or deep pixels".into()
    } else if !header.channels.list.iter().all(known) {
        "integers, or channels of fewer pixels".into()
    } else {
        return Ok(());
    };
    Err(format!(
        "OpenEXR: {found}, and tables are lines of floats under {}: another program wrote this \
         image; bake it again",
        ENCODING.compression
    ))
}

/// Refuses a header that declares more pixels than the file can hold, before the library allocates
/// them.
fn check_size(header: &Header, file: usize) -> std::result::Result<(), String> {
    let Vec2(width, height) = header.layer_size;
    let total = width
        .checked_mul(height)
        .and_then(|area| area.checked_mul(header.channels.bytes_per_pixel));
    match total.filter(|total| *total <= EXPANSION * file) {
        Some(total) => check_samples(total as u64),
        None => Err(format!(
            "OpenEXR: {width} x {height} pixels in a file of {file} bytes: the header is damaged"
        )),
    }
}

/// The description in an image's attributes.
fn document(attributes: &LayerAttributes) -> Option<String> {
    match attributes.other.get(&Text::new_or_panic(ATTRIBUTE)) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    }
}

/// What has to be known of a table before its values are read.
#[derive(Deserialize)]
struct Head {
    name: String,
    channels: Vec<String>,
}

/// The one table that a document describes.
fn only_table(document: &str) -> std::result::Result<Head, String> {
    #[derive(Deserialize)]
    struct Document {
        tables: Vec<Head>,
    }
    let mut document: Document = serde_json::from_str(document).map_err(|why| why.to_string())?;
    let table = document.tables.pop().filter(|_| document.tables.is_empty());
    let table = table.ok_or("the description is not that of one table")?;
    if table.channels.is_empty() { Err("no channels".into()) } else { Ok(table) }
}

/// Whether a file NAME.exr says that it holds the table NAME, which copies under other names and
/// other images do not. Only the header is read.
///
/// # Errors
/// A message if the file cannot be read, or is damaged.
pub(super) fn is_table(path: &Path) -> std::result::Result<bool, String> {
    let Some(name) = path.file_name().and_then(|name| table_of(name.to_str()?)) else {
        return Ok(false);
    };
    if !std::fs::metadata(path).map_err(|why| why.to_string())?.is_file() {
        return Ok(false);
    }
    let input = input::open(path, u64::MAX).map_err(|why| why.to_string())?;
    let meta = match MetaData::read_from_buffered(BufReader::new(input).take(MAX_TEXT), false) {
        // Images of other programs.
        Err(Error::NotSupported(_)) => return Ok(false),
        meta => meta.map_err(|why| {
            format!("OpenEXR: {why}; if it is no table of the set, move it elsewhere")
        })?,
    };
    let document = meta.headers.first().and_then(|header| document(&header.own_attributes));
    Ok(document.is_some_and(|document| only_table(&document).is_ok_and(|table| table.name == name)))
}

/// A description or a name in ASCII, since EXR text has no Unicode.
fn ascii(text: &str) -> String {
    let mut ascii = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii() {
            ascii.push(c);
        } else {
            // In JSON such characters occur in strings only, which allow the escape.
            let mut units = [0; 2];
            c.encode_utf16(&mut units)
                .iter()
                .for_each(|unit| ascii.push_str(&format!("\\u{unit:04x}")));
        }
    }
    ascii
}
