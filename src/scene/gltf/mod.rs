//! glTF 2.0 scenes, `.gltf` and `.glb`.
//!
//! Conventions, from the [specification][spec] (3.9, appendix B) and its ratified extensions:
//!
//! - The specular lobe of every material is GGX (γ = 2) with σ = α = r², where r is
//!   `roughnessFactor` (default 1) times the green channel of `metallicRoughnessTexture`.
//! - `KHR_materials_anisotropy`: along the anisotropy α rises to α + (1 − α) s², where s is the
//!   strength times the texture's blue channel; across it α stays.
//! - `KHR_materials_clearcoat`: a second, isotropic GGX lobe with `clearcoatRoughnessFactor`
//!   (default 0) times the green channel of its texture, if `clearcoatFactor` is not 0.
//! - `KHR_materials_transmission` and `KHR_materials_volume` transmit through the same lobe.
//! - `KHR_materials_pbrSpecularGlossiness` (archived): r = 1 − glossiness, with the glossiness in
//!   the opacity channel of its texture.
//! - The reflectance is Schlick's, F0 = ((ior − 1)/(ior + 1))² with `KHR_materials_ior` (default
//!   1.5), and the base colour in metals; one Schlick table serves both.
//! - `KHR_materials_sheen` has a distribution of its own; `KHR_materials_unlit` has no lobe.
//! - The form of G2 is left to the renderer: appendix B and the anisotropy extension show one form
//!   each.
//!
//! [spec]: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html

mod schema;

use std::collections::HashSet;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use base64::Engine;

use self::schema::{Document, Image, Material, TextureInfo};
use super::builder::{Builder, GGX, Lobe};
use super::error::Lines;
use super::limits::Budget;
use super::texture::{self, Channel, Encoding, Textures};
use super::{Format, Fresnel, Interval, Place, Roughness, Scene, SceneError, limits};
use crate::input;

/// Reads a glTF 2.0 scene.
pub(super) fn load(path: &Path) -> Result<Scene, SceneError> {
    let place = Place::file(path);
    let (json, binary) = read(path, &place)?;
    let json = input::unmarked(&json);
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        Lines::new(path, json)
            .after_feeds(error.line(), error.column().saturating_sub(1))
            // The message has the place before it already.
            .syntax(
                error
                    .to_string()
                    .rsplit_once(" at line ")
                    .map_or("no JSON", |(message, _)| message),
            )
    })?;
    if !document.asset.version.starts_with("2.") {
        return Err(place
            .invalid(format!("this is glTF {}; only version 2 is read", document.asset.version)));
    }
    let mut importer = Importer {
        builder: Builder::new(Format::Gltf),
        folder: path.parent().unwrap_or(Path::new("")),
        place,
        document: &document,
        binary,
        embedded: Textures::default(),
    };
    importer.materials()?;
    Ok(importer.builder.finish(Vec::new()))
}

/// What helps where the JSON is too large.
const SEPARATE: &str = "export images and geometry to files of their own";

/// A range of bytes in a file.
struct Section {
    file: PathBuf,
    start: u64,
}

/// The JSON text, and where the binary chunk is if the file is a container (specification, 4).
fn read(path: &Path, place: &Place) -> Result<(Vec<u8>, Option<Section>), SceneError> {
    let io = |error| place.io(error);
    // Of a container only the JSON is read, and images as they are asked for.
    let mut file = input::open(path, u64::MAX).map_err(io)?;
    let mut head = Vec::new();
    file.by_ref().take(20).read_to_end(&mut head).map_err(io)?;
    if !head.starts_with(b"glTF") {
        let json = input::read(path, limits::JSON).map_err(|error| match error.kind() {
            io::ErrorKind::FileTooLarge => place.invalid(format!("it {error}; {SEPARATE}")),
            _ => io(error),
        });
        return Ok((json?, None));
    }
    let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    if head.len() < 20 || word(4) != 2 || word(16) != u32::from_le_bytes(*b"JSON") {
        return Err(place.syntax("this is no glTF container of version 2 that begins with JSON"));
    }
    let size = u64::from(word(12));
    if size > limits::JSON {
        return Err(place.too_large(format!(
            "the JSON of the glTF container has {size} bytes, and at most {} MiB are read; {SEPARATE}",
            limits::JSON >> 20
        )));
    }
    let mut json = Vec::new();
    file.take(size).read_to_end(&mut json).map_err(io)?;
    if json.len() as u64 != size {
        return Err(place.syntax("the glTF container ends inside its JSON"));
    }
    // The binary chunk has a header of its own: length and type.
    let binary = Section { file: path.to_owned(), start: 20 + size + 8 };
    Ok((json, Some(binary)))
}

struct Importer<'a> {
    builder: Builder,
    folder: &'a Path,
    place: Place,
    document: &'a Document,
    binary: Option<Section>,
    /// Images in the document or its buffers, by their number.
    embedded: Textures<usize>,
}

impl Importer<'_> {
    fn materials(&mut self) -> Result<(), SceneError> {
        let document = self.document;
        let used: HashSet<usize> =
            document.meshes.iter().flat_map(|mesh| &mesh.materials).copied().collect();
        if let Some(index) = used.iter().find(|&&i| i >= document.materials.len()) {
            return Err(self.place.invalid(format!(
                "a mesh refers to material {index}, but there are {} materials, counted from 0",
                document.materials.len()
            )));
        }
        for (i, material) in document.materials.iter().enumerate() {
            let name = match &material.name {
                Some(name) if !name.is_empty() => name.clone(),
                _ => format!("material {i}"),
            };
            let used = document.meshes.is_empty() || used.contains(&i);
            self.material(&name, material, used)?;
        }
        // A primitive without a material has the default one (specification, 3.7.2.1).
        if document.meshes.iter().any(|mesh| mesh.uses_default) {
            self.material("default material", &Material::default(), true)?;
        }
        Ok(())
    }

    fn material(&mut self, name: &str, material: &Material, used: bool) -> Result<(), SceneError> {
        let extensions = &material.extensions;
        let place = self.place.clone();
        if extensions.unlit.is_some() {
            return self.builder.ignore(name, "KHR_materials_unlit", &place, "unlit");
        }
        let roughness = match &extensions.specular_glossiness {
            None => {
                let pbr = &material.pbr_metallic_roughness;
                let texture = pbr.metallic_roughness_texture.as_ref();
                self.factor(name, "roughnessFactor", pbr.roughness_factor, texture, Channel::Green)?
            }
            Some(pbr) => {
                let texture = pbr.specular_glossiness_texture.as_ref();
                self.factor(
                    name,
                    "glossinessFactor",
                    pbr.glossiness_factor,
                    texture,
                    Channel::Alpha,
                )?
                .map_falling(|glossiness| 1.0 - glossiness)
            }
        };
        let alpha = roughness.map_rising(|r| r * r);
        let strength = match &extensions.anisotropy {
            None => Interval::point(0.0),
            Some(a) => {
                let texture = a.anisotropy_texture.as_ref();
                self.factor(
                    name,
                    "anisotropyStrength",
                    a.anisotropy_strength,
                    texture,
                    Channel::Blue,
                )?
            }
        };
        let roughness = if strength.max == 0.0 {
            Roughness::isotropic(alpha)
        } else {
            let along = |alpha: f64, s: f64| alpha + (1.0 - alpha) * s * s;
            let along = Interval {
                min: along(alpha.min, strength.min),
                max: along(alpha.max, strength.max),
            };
            Roughness::anisotropic(along, alpha)
        };
        let ior = extensions.ior.as_ref().map_or(1.5, |extension| extension.ior);
        // An index of 0 asks for total reflection (KHR_materials_ior); the formula gives F0 = 1
        // there.
        let amplitude = (ior - 1.0) / (ior + 1.0);
        let f0 = amplitude * amplitude;
        if !(ior >= 1.0 || ior == 0.0) {
            return Err(place.invalid(format!(
                "material \"{name}\": ior is {ior}; it must be 0, or at least 1"
            )));
        }
        let iridescent = extensions.iridescence.is_some();
        let lobe = |lobe, roughness, fresnel| Lobe {
            name: lobe,
            roughness,
            gamma: GGX,
            fresnel,
            masking: None,
        };
        let main = lobe(None, roughness, (!iridescent).then_some(Fresnel::Schlick([f0; 3])));
        self.builder.add(name, &place, used, main)?;

        if let Some(coat) = extensions.clearcoat.as_ref().filter(|coat| coat.clearcoat_factor > 0.0)
        {
            let texture = coat.clearcoat_roughness_texture.as_ref();
            let factor = coat.clearcoat_roughness_factor;
            let roughness =
                self.factor(name, "clearcoatRoughnessFactor", factor, texture, Channel::Green)?;
            let roughness = Roughness::isotropic(roughness.map_rising(|r| r * r));
            // The coat's index of refraction is fixed at 1.5 (KHR_materials_clearcoat).
            let coat = lobe(Some("clearcoat"), roughness, Some(Fresnel::Schlick([0.04; 3])));
            self.builder.add(name, &place, used, coat)?;
        }
        if extensions.sheen.is_some() {
            let name = format!("{name}.sheen");
            let reason = "a fabric's distribution (Charlie), not a Student-t one";
            self.builder.ignore(&name, "KHR_materials_sheen", &place, reason)?;
        }
        Ok(())
    }

    /// A factor in [0, 1], times a channel of a texture if there is one.
    fn factor(
        &mut self,
        material: &str,
        key: &str,
        factor: f64,
        texture: Option<&TextureInfo>,
        channel: Channel,
    ) -> Result<Interval, SceneError> {
        if !(0.0..=1.0).contains(&factor) {
            return Err(self.place.invalid(format!(
                "material \"{material}\": {key} is {factor}; it must be from 0 to 1"
            )));
        }
        let range = match texture {
            Some(texture) => self.image(texture.index, channel),
            None => Interval::point(1.0),
        };
        Ok(range.map_rising(|x| x * factor))
    }

    fn image(&mut self, texture: usize, channel: Channel) -> Interval {
        let name = format!("{texture}");
        let textures = &self.document.textures;
        let source = textures.get(texture).and_then(|texture| texture.source);
        let image = source.and_then(|i| Some((i, self.document.images.get(i)?)));
        let place = self.place.clone();
        let Some((source, image)) = image else {
            let reason = "has no PNG or JPEG image";
            return self.builder.unread(&name, reason, &place);
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

/// The bytes of an image that is in the document or in one of its buffers.
fn bytes(
    image: &Image,
    document: &Document,
    folder: &Path,
    binary: Option<&Section>,
    left: &Budget,
) -> io::Result<Vec<u8>> {
    if let Some(uri) = &image.uri {
        return data_uri(uri, left);
    }
    let missing = || io::Error::other("no such buffer");
    let view =
        image.buffer_view.and_then(|view| document.buffer_views.get(view)).ok_or_else(missing)?;
    let buffer = document.buffers.get(view.buffer).ok_or_else(missing)?;
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
