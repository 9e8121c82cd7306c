//! Tables as an OpenEXR image of one part each: the last axis along x, the others stacked along y,
//! table channels as image channels.
//!
//! A table interpolated by Hermite cubics has its values in the luminance channel `Y`, which every
//! viewer shows, and its derivatives in `slope`. The string attribute `microfacet` of the first
//! part holds the description of the set.

use std::io::Cursor;
use std::result::Result;

use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::*;
use half::f16;

use microfacet_sampler::Tables;
use microfacet_tables::{
    LoadError, Precision, Provenance, Table, describe, reassemble, seal_document, stated_tables,
};

use crate::input::MAX_TABLES;

const ATTRIBUTE: &str = "microfacet";

/// The encoding of pixels; no other is read.
const ENCODING: Encoding = Encoding::SMALL_LOSSLESS;

type Part = Layer<AnyChannels<FlatSamples>>;

fn channel_name(channel: &str) -> &str {
    if channel == "value" { "Y" } else { channel }
}

/// Encodes tables as an image, compressed without loss; half-precision tables give half channels,
/// all others f32.
///
/// # Errors
/// A message if there are no tables, or one is invalid or cannot be written.
pub fn encode(provenance: &Provenance, tables: &[Table]) -> Result<Vec<u8>, String> {
    let document = describe(provenance, tables).map_err(|why| why.to_string())?;
    let values = tables.iter().flat_map(|table| &table.values);
    let document = seal_document(&ascii(&document), values)
        .ok_or("the description has no place for a checksum")?;
    let bytes = |table: &Table| {
        let bytes = if table.precision == Precision::F16 { 2 } else { 4 };
        bytes * table.values.len() as u64
    };
    check_samples(tables.iter().map(bytes).sum())?;
    let mut parts: Vec<Part> = tables.iter().map(part_of).collect();
    let first = parts.first_mut().ok_or("a set without tables has no image")?;
    describe_with(&mut first.attributes, &document)?;
    write(parts)
}

fn part_of(table: &Table) -> Part {
    let width = table.axes.last().map_or(1, microfacet_tables::Axis::len);
    let count = table.channels.len();
    let height = table.values.len() / count / width;
    let channels = table.channels.iter().enumerate().map(|(i, channel)| {
        let samples = table.values.iter().skip(i).step_by(count).copied();
        channel_of(channel_name(channel), flat(table.precision == Precision::F16, samples))
    });
    let channels = AnyChannels::sort(channels.collect());
    Layer::new((width, height), named(&table.name), ENCODING, channels)
}

/// Encodes channels in 32 bits, or in 16 if `half`, as an image of one part, compressed without
/// loss. The description is its string attribute `microfacet`.
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
) -> Result<Vec<u8>, String> {
    let channels = channels
        .into_iter()
        .map(|(channel, samples)| channel_of(channel, flat(half, samples.into_iter())))
        .collect();
    let mut attributes = named(name);
    if let Some(text) = description {
        describe_with(&mut attributes, text)?;
    }
    write(vec![Layer::new((size[0], size[1]), attributes, ENCODING, AnyChannels::sort(channels))])
}

fn flat(half: bool, samples: impl Iterator<Item = f32>) -> FlatSamples {
    if half {
        FlatSamples::F16(samples.map(f16::from_f32).collect())
    } else {
        FlatSamples::F32(samples.collect())
    }
}

/// The attributes of a part of this name. A table of a measured distribution has the name of a
/// file, which may have any characters.
fn named(name: &str) -> LayerAttributes {
    LayerAttributes::named(Text::new_or_panic(ascii(name)))
}

fn describe_with(attributes: &mut LayerAttributes, text: &str) -> Result<(), String> {
    let text = Text::new_or_none(text).ok_or("the description cannot be stored in EXR")?;
    // Only one custom attribute: the library writes them in the order of a hash map.
    attributes.other.insert(Text::new_or_panic(ATTRIBUTE), AttributeValue::Text(text));
    Ok(())
}

/// A channel whose samples are no intensities of light, which a lossy compressor should quantise
/// evenly.
fn channel_of(name: &str, samples: FlatSamples) -> AnyChannel<FlatSamples> {
    AnyChannel {
        name: Text::new_or_panic(name),
        sample_data: samples,
        quantize_linearly: true,
        sampling: Vec2(1, 1),
    }
}

/// The bytes of an image; all parts share a display window of the largest width and height.
fn write(parts: Vec<Part>) -> Result<Vec<u8>, String> {
    let largest = |side: fn(&Part) -> usize| parts.iter().map(side).max().unwrap_or_default();
    let window = (largest(|part| part.size.width()), largest(|part| part.size.height()));
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(window));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layers(attributes, parts)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|why| why.to_string())?;
    Ok(bytes.into_inner())
}

/// Reads an image back into a set.
///
/// # Errors
/// [`LoadError`] for an image that is damaged or was not written by [`encode`].
pub fn decode(bytes: &[u8]) -> Result<Tables, LoadError> {
    let invalid = |why: String| LoadError::Invalid(why);
    check_header(bytes).map_err(invalid)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|why| invalid(format!("OpenEXR: {why}")))?;
    let parts = image.layer_data;
    let document = parts.first().and_then(document).ok_or_else(|| {
        invalid(format!("an OpenEXR image, but without the `{ATTRIBUTE}` attribute of a table"))
    })?;
    let heads = stated_tables(&document)?;
    if heads.len() != parts.len() {
        let [parts, tables] = [parts.len(), heads.len()];
        return Err(invalid(format!("OpenEXR: {parts} parts of {tables} tables")));
    }
    let values: Vec<Vec<f32>> = heads
        .iter()
        .zip(&parts)
        .map(|((name, channels), part)| values(name, channels, part))
        .collect::<Result<_, _>>()
        .map_err(invalid)?;
    if seal_document(&document, values.iter().flatten()).is_none_or(|sealed| sealed != document) {
        return Err(invalid(
            "checksum does not match: the file is damaged or was edited; bake again".into(),
        ));
    }
    let mut values = values.into_iter();
    let (provenance, tables) =
        reassemble(&document, || values.next().ok_or("no part of that name".to_string()))?;
    Tables::from_tables(provenance, tables)
}

/// The values of a table, channels fastest.
fn values(name: &str, channels: &[String], part: &Part) -> Result<Vec<f32>, String> {
    let of = part.attributes.layer_name.as_ref().map(Text::to_string).unwrap_or_default();
    if of != ascii(name) {
        return Err(format!("OpenEXR: a part named `{of}` in the place of the table `{name}`"));
    }
    // A list that repeats a channel could ask for any amount of memory.
    if channels.is_empty() || channels.len() != part.channel_data.list.len() {
        return Err("the channels are not those of the description".into());
    }
    let mut columns = Vec::new();
    for channel in channels {
        let name = channel_name(channel);
        let found = part.channel_data.list.iter().find(|stored| stored.name == *name);
        let found = found.ok_or_else(|| format!("no channel `{name}`"))?;
        columns.push(found.sample_data.values_as_f32());
    }
    let pixels = part.size.area();
    let mut values = Vec::with_capacity(pixels * columns.len());
    for _ in 0..pixels {
        values.extend(columns.iter_mut().filter_map(Iterator::next));
    }
    Ok(values)
}

/// Most bytes of an image's samples. The values made of them take up to twice as much in addition.
const MAX_SAMPLES: u64 = MAX_TABLES / 4;

/// Refuses an image that would take too much memory to read.
fn check_samples(bytes: u64) -> Result<(), String> {
    if bytes <= MAX_SAMPLES {
        return Ok(());
    }
    Err(format!(
        "OpenEXR: samples of {bytes} bytes, and at most {} MiB are read: bake safetensors instead, or a lower quality or precision",
        MAX_SAMPLES >> 20
    ))
}

/// Largest allowed ratio of image size to file size: tables compress by less than four, and DEFLATE
/// could reach a thousand.
const EXPANSION: usize = 64;

/// Refuses images that [`encode`] does not write, before any pixel is decoded, and images that
/// declare more pixels than the file can hold, before the library allocates them.
fn check_header(bytes: &[u8]) -> Result<(), String> {
    let meta =
        MetaData::read_from_buffered(bytes, false).map_err(|why| format!("OpenEXR: {why}"))?;
    let mut all = 0_usize;
    for header in &meta.headers {
        check_encoding(header)?;
        let Vec2(width, height) = header.layer_size;
        let area = width.checked_mul(height);
        let total = area.and_then(|area| area.checked_mul(header.channels.bytes_per_pixel));
        let total = total.and_then(|total| all.checked_add(total));
        all = total.filter(|total| *total / EXPANSION <= bytes.len()).ok_or_else(|| {
            let file = bytes.len();
            format!(
                "OpenEXR: {width} x {height} pixels in a file of {file} bytes: the header is damaged"
            )
        })?;
    }
    check_samples(all as u64)
}

/// Refuses other encodings: tables do not need their decoders, of which that of B44 overflows on
/// hostile blocks (`exr` 1.74.2, `unpack14`).
fn check_encoding(header: &Header) -> Result<(), String> {
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

fn document(part: &Part) -> Option<String> {
    match part.attributes.other.get(&Text::new_or_panic(ATTRIBUTE)) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    }
}

/// A description or a name in ASCII, since EXR text has no Unicode.
fn ascii(text: &str) -> String {
    let mut ascii = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii() {
            ascii.push(c);
        } else {
            // In JSON other characters occur in strings only, which allow the escape.
            let mut units = [0; 2];
            c.encode_utf16(&mut units)
                .iter()
                .for_each(|unit| ascii.push_str(&format!("\\u{unit:04x}")));
        }
    }
    ascii
}
