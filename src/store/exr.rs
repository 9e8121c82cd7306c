//! One table as an OpenEXR image: the last axis along x, the others stacked along y, table channels
//! as image channels.
//!
//! A table interpolated by Hermite cubics has its values in the luminance channel `Y`, which every
//! viewer shows, and its derivatives in `slope`. The string attribute `microfacet` holds the
//! description of the set.

use std::io::Cursor;

use exr::prelude::*;
use half::f16;

use microfacet_sampler::internals::{describe, reassemble, seal_document};
use microfacet_sampler::{LoadError, Precision, Provenance, Table, Tables};

/// The first bytes of every OpenEXR file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// The attribute that holds the description.
const ATTRIBUTE: &str = "microfacet";

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
    let width = table.axes.last().map_or(1, microfacet_sampler::Axis::len);
    let count = table.channels.len();
    let height = table.values.len() / count / width;
    let channels = table.channels.iter().enumerate().map(|(i, channel)| {
        let samples = table.values.iter().skip(i).step_by(count);
        let samples = match table.precision {
            Precision::F16 => FlatSamples::F16(samples.map(|&x| f16::from_f32(x)).collect()),
            _ => FlatSamples::F32(samples.copied().collect()),
        };
        // The samples are not light intensities: a lossy compressor should quantise them evenly.
        AnyChannel {
            name: Text::new_or_panic(channel_name(channel)),
            sample_data: samples,
            quantize_linearly: true,
            sampling: Vec2(1, 1),
        }
    });
    let mut attributes = LayerAttributes::named(Text::new_or_panic(&table.name));
    let text = Text::new_or_none(&document).ok_or("the description cannot be stored in EXR")?;
    // Only one custom attribute: the library writes them in the order of a hash map.
    attributes.other.insert(Text::new_or_panic(ATTRIBUTE), AttributeValue::Text(text));
    let layer = Layer::new(
        (width, height),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    );
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
    check_size(bytes).map_err(invalid)?;
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
    let document = match layer.attributes.other.get(&Text::new_or_panic(ATTRIBUTE)) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        _ => {
            return Err(invalid(format!(
                "an OpenEXR image, but without the `{ATTRIBUTE}` attribute of a table"
            )));
        }
    };
    let channels = document_channels(&document).map_err(invalid)?;
    let mut columns = Vec::new();
    for channel in &channels {
        let name = channel_name(channel);
        let found = layer.channel_data.list.iter().find(|stored| stored.name == *name);
        let found = found.ok_or_else(|| invalid(format!("no channel `{name}`")))?;
        columns.push(found.sample_data.values_as_f32().collect::<Vec<f32>>());
    }
    let pixels = layer.size.area();
    let values: Vec<f32> =
        (0..pixels).flat_map(|i| columns.iter().map(move |column| column[i])).collect();
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

/// Largest allowed ratio of image size to file size. Tables compress by less than four; DEFLATE
/// alone could reach a thousand.
const EXPANSION: usize = 64;

/// Refuses a header that declares more pixels than the file can hold, before the library allocates
/// them.
fn check_size(bytes: &[u8]) -> std::result::Result<(), String> {
    let meta = exr::meta::MetaData::read_from_buffered(bytes, false)
        .map_err(|why| format!("OpenEXR: {why}"))?;
    let promised = |header: &exr::meta::header::Header| {
        let Vec2(width, height) = header.layer_size;
        width.checked_mul(height)?.checked_mul(header.channels.bytes_per_pixel)
    };
    let total =
        meta.headers.iter().map(promised).try_fold(0_usize, |sum, bytes| sum.checked_add(bytes?));
    if total.is_some_and(|total| total <= EXPANSION * bytes.len()) {
        return Ok(());
    }
    let size = meta.headers.first().map_or(Vec2(0, 0), |header| header.layer_size);
    Err(format!(
        "OpenEXR: {} x {} pixels in a file of {} bytes: the header is damaged",
        size.0,
        size.1,
        bytes.len()
    ))
}

/// Channel names of the one table that a document describes.
fn document_channels(document: &str) -> std::result::Result<Vec<String>, String> {
    let document: serde_json::Value =
        serde_json::from_str(document).map_err(|why| why.to_string())?;
    let channels = document.pointer("/tables/0/channels").and_then(|list| list.as_array());
    let names = channels
        .map(|list| list.iter().filter_map(|name| name.as_str().map(String::from)).collect());
    names
        .filter(|names: &Vec<String>| !names.is_empty())
        .ok_or_else(|| "the description names no channels".into())
}

/// The description in ASCII, since EXR text has no Unicode.
fn ascii(document: &str) -> String {
    let mut ascii = String::with_capacity(document.len());
    for c in document.chars() {
        if c.is_ascii() {
            ascii.push(c);
        } else {
            // Such characters occur in strings only, where JSON allows the escape.
            let mut units = [0; 2];
            c.encode_utf16(&mut units)
                .iter()
                .for_each(|unit| ascii.push_str(&format!("\\u{unit:04x}")));
        }
    }
    ascii
}
