//! Images: files, `data:` URIs, and parts of buffers.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use base64::Engine;

use microfacet_baker::input;
use microfacet_tables::Interval;

use super::schema::{Document, Image};
use super::value::Entry;
use super::{Importer, Section};
use crate::limits::Budget;
use crate::texture::{Channel, Encoding};
use crate::{limits, texture};

impl Importer<'_> {
    /// The range of a channel of a texture.
    pub(super) fn image(&mut self, texture: usize, channel: Channel) -> Interval {
        let name = format!("{texture}");
        let place = self.place.clone();
        let (source, image) = match source(self.document, texture) {
            Ok(source) => source,
            Err(error) => {
                let reason = format!("cannot be read ({error})");
                return self.builder.unread(&name, &reason, &place);
            }
        };
        if let Some(uri) = image.uri.as_deref().filter(|uri| !uri.starts_with("data:")) {
            let file = self.folder.join(decode_uri(uri));
            return self.builder.image(&file, channel, Encoding::Linear, &place);
        }
        let Self { embedded, document, folder, binary, .. } = self;
        let range = embedded.range(source, channel, Encoding::Linear, |_, left| {
            bytes(image, document, folder, binary.as_ref(), left)
        });
        range.unwrap_or_else(|reason| self.builder.unread(&name, &reason, &place))
    }
}

/// The image of a texture, with its number.
fn source<'a>(document: &'a Document<'_>, texture: usize) -> io::Result<(usize, &'a Image)> {
    let texture = entry(&document.textures, Some(texture), "there is no such texture")?;
    // Images of other kinds are in extensions.
    let none = || io::Error::other("it has no PNG or JPEG image");
    let source = texture.source.ok_or_else(none)?;
    let image = entry(&document.images, Some(source), "there is no such image")?;
    Ok((source, image))
}

/// An entry of a list by its number; the error says what is wrong in it, or that it is missing.
fn entry<'a, T>(
    list: &'a [Entry<T>],
    index: Option<usize>,
    missing: &'static str,
) -> io::Result<&'a T> {
    let entry = index.and_then(|index| list.get(index));
    let Entry(entry) = entry.ok_or_else(|| io::Error::other(missing))?;
    entry.as_ref().map_err(|why| io::Error::other(why.clone()))
}

/// The bytes of an image that is in the document or in one of its buffers.
fn bytes(
    image: &Image,
    document: &Document<'_>,
    folder: &Path,
    binary: Option<&Section>,
    left: &Budget,
) -> io::Result<Vec<u8>> {
    if let Some(uri) = &image.uri {
        return data_uri(uri, left);
    }
    const MISSING: &str = "no such buffer";
    let missing = || io::Error::other(MISSING);
    let view = entry(&document.buffer_views, image.buffer_view, MISSING)?;
    let buffer = entry(&document.buffers, Some(view.buffer), MISSING)?;
    let (file, start) = match (&buffer.uri, binary) {
        (Some(uri), _) if uri.starts_with("data:") => {
            let bytes = data_uri(uri, left)?;
            let range =
                usize::try_from(view.byte_offset).ok().zip(usize::try_from(view.byte_length).ok());
            let bytes =
                range.and_then(|(start, length)| bytes.get(start..start.checked_add(length)?));
            return bytes.map(<[u8]>::to_vec).ok_or_else(missing);
        }
        (Some(uri), _) => (folder.join(decode_uri(uri)), 0),
        (None, Some(binary)) => (binary.file.clone(), binary.start),
        (None, None) => return Err(missing()),
    };
    if view.byte_length > limits::IMAGE_FILE {
        let why = format!(
            "has {} bytes, and at most {} MiB are read",
            view.byte_length,
            limits::IMAGE_FILE >> 20
        );
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
    }
    let mut file = input::open(&file, u64::MAX)?;
    file.seek(SeekFrom::Start(start.saturating_add(view.byte_offset)))?;
    let mut bytes = Vec::new();
    file.take(view.byte_length).read_to_end(&mut bytes)?;
    texture::charge(left, bytes.len() as u64)?;
    Ok(bytes)
}

/// The content of a `data:` URI, which glTF requires to be in base64.
fn data_uri(uri: &str, left: &Budget) -> io::Result<Vec<u8>> {
    texture::charge(left, uri.len() as u64)?;
    let (_, text) = uri
        .split_once(";base64,")
        .ok_or_else(|| io::Error::other("the data URI is not in base64"))?;
    base64::engine::general_purpose::STANDARD.decode(text).map_err(io::Error::other)
}

/// Undoes percent encoding; invalid sequences stay as they are.
fn decode_uri(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let hex = (*first == b'%')
            .then(|| tail.get(..2).and_then(|hex| std::str::from_utf8(hex).ok()))
            .flatten()
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        bytes.push(hex.unwrap_or(*first));
        rest = if hex.is_some() { &tail[2..] } else { tail };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
