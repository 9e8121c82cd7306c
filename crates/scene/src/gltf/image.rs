//! Images: files, `data:` URIs, and parts of buffers.

use std::io::{self, Read, Seek, SeekFrom};
use std::path::PathBuf;

use base64::Engine;
use serde_json::value::RawValue;

use microfacet_baker::input;
use microfacet_baker::scene::{Place, SceneError};
use microfacet_tables::Interval;

use super::Importer;
use super::object::Object;
use crate::Result;
use crate::builder::Builder;
use crate::limits::Budget;
use crate::texture::{Channel, Encoding};
use crate::{limits, texture};

/// Where the images of a document are.
pub(super) struct Images<'a> {
    pub(super) place: &'a Place,
    pub(super) folder: PathBuf,
    /// Where the binary chunk of a container begins in the file.
    pub(super) chunk: Option<u64>,
    pub(super) textures: Vec<&'a RawValue>,
    pub(super) images: Vec<&'a RawValue>,
    pub(super) views: Vec<&'a RawValue>,
    pub(super) buffers: Vec<&'a RawValue>,
}

impl Importer<'_> {
    /// The range of a channel of a texture, computed once.
    pub(super) fn image(&mut self, texture: u64, channel: Channel) -> Interval {
        if let Some(&known) = self.ranges.get(&(texture, channel)) {
            return known;
        }
        let Self { builder, images, place, read, .. } = self;
        let range = images.source(texture).and_then(|source| {
            // Many textures may share one image as large as the document.
            let read = read.entry((source, channel));
            read.or_insert_with(|| images.range(source, channel, builder)).clone()
        });
        let unread = |reason: String| builder.unread(&texture.to_string(), &reason, place);
        let range = range.unwrap_or_else(unread);
        self.ranges.insert((texture, channel), range);
        range
    }
}

/// What completes the sentence "texture x ..." where something of it is wrong.
fn unread(why: SceneError) -> String {
    format!("cannot be read ({})", why.kind)
}

impl<'a> Images<'a> {
    /// The number of the image of a texture.
    fn source(&self, texture: u64) -> Result<u64, String> {
        let read = || {
            let texture = self.entry(&self.textures, texture, "texture")?;
            // Images of other kinds are in extensions.
            let none = || texture.invalid("it has no PNG or JPEG image");
            texture.index("source")?.ok_or_else(none)
        };
        read().map_err(unread)
    }

    /// The range of a channel of an image. An error is for the caller to report for each texture; a
    /// file that cannot be read is warned of here.
    fn range(
        &self,
        source: u64,
        channel: Channel,
        builder: &mut Builder,
    ) -> Result<Interval, String> {
        let image = self.entry(&self.images, source, "image").map_err(unread)?;
        match image.text("uri").map_err(unread)? {
            Some(uri) if !uri.starts_with("data:") => {
                Ok(builder.image(&self.file(&uri), channel, Encoding::Linear, self.place))
            }
            uri => {
                // No file has this path, which is inside the document's own file.
                let key = self.place.file.join(source.to_string());
                let read = |left: &Budget| self.bytes(&image, uri, left);
                builder.textures.range(&key, channel, Encoding::Linear, read)
            }
        }
    }

    fn entry(&self, list: &[&'a RawValue], index: u64, what: &str) -> Result<Object<'a>> {
        Object::new(self.place, String::new(), self.text(list, index, what)?)
    }

    fn text(&self, list: &[&'a RawValue], index: u64, what: &str) -> Result<&'a RawValue> {
        let text = usize::try_from(index).ok().and_then(|index| list.get(index).copied());
        text.ok_or_else(|| self.place.invalid(format!("there is no such {what}")))
    }

    /// The bytes of an image that is in the document, by its URI, or in one of its buffers.
    fn bytes(&self, image: &Object<'a>, uri: Option<String>, left: &Budget) -> io::Result<Vec<u8>> {
        let said = |why: SceneError| io::Error::other(why.kind.to_string());
        if let Some(uri) = uri {
            texture::charge(left, uri.len() as u64)?;
            return data_uri(&uri);
        }
        // Images may share a buffer as large as the document, so every use is counted.
        let charged = |list: &[&'a RawValue], index: u64, what: &str| {
            let text = self.text(list, index, what).map_err(said)?;
            texture::charge(left, text.get().len() as u64)?;
            Object::new(self.place, String::new(), text).map_err(said)
        };
        let view = image.required_index("bufferView").map_err(said)?;
        let view = charged(&self.views, view, "buffer view")?;
        let buffer = view.required_index("buffer").map_err(said)?;
        let buffer = charged(&self.buffers, buffer, "buffer")?;
        let offset = view.index("byteOffset").map_err(said)?.unwrap_or(0);
        let length = view.required_index("byteLength").map_err(said)?;
        let (file, start) = match (buffer.text("uri").map_err(said)?, self.chunk) {
            (Some(uri), _) if uri.starts_with("data:") => {
                let bytes = data_uri(&uri)?.into_iter();
                return Ok(bytes.skip(offset as usize).take(length as usize).collect());
            }
            (Some(uri), _) => (self.file(&uri), 0),
            (None, Some(start)) => (self.place.file.to_path_buf(), start),
            (None, None) => return Err(io::Error::other("its buffer has no bytes")),
        };
        if length > limits::IMAGE {
            let most = limits::IMAGE >> 20;
            let why = format!("has {length} bytes, and at most {most} MiB are read");
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
        }
        let mut file = input::open(&file, u64::MAX)?;
        file.seek(SeekFrom::Start(start.saturating_add(offset)))?;
        let mut bytes = Vec::new();
        file.take(length).read_to_end(&mut bytes)?;
        texture::charge(left, bytes.len() as u64)?;
        Ok(bytes)
    }

    /// The file of a URI, without percent encoding; invalid sequences stay as they are.
    fn file(&self, uri: &str) -> PathBuf {
        let mut bytes = Vec::with_capacity(uri.len());
        let mut rest = uri.as_bytes();
        while let [first, tail @ ..] = rest {
            let hex = tail.get(..2).filter(|_| *first == b'%');
            let hex = hex.and_then(|hex| str::from_utf8(hex).ok());
            let hex = hex.and_then(|hex| u8::from_str_radix(hex, 16).ok());
            bytes.push(hex.unwrap_or(*first));
            rest = if hex.is_some() { &tail[2..] } else { tail };
        }
        self.folder.join(&*String::from_utf8_lossy(&bytes))
    }
}

/// The content of a `data:` URI, which glTF requires to be in base64.
fn data_uri(uri: &str) -> io::Result<Vec<u8>> {
    let (_, text) = uri
        .split_once(";base64,")
        .ok_or_else(|| io::Error::other("the data URI is not in base64"))?;
    base64::engine::general_purpose::STANDARD.decode(text).map_err(io::Error::other)
}
