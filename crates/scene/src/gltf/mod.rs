//! glTF 2.0 scenes, `.gltf` and `.glb`.
//!
//! Conventions, from the [specification][spec] (3.9, appendix B) and its extensions:
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
//! - `KHR_materials_retroreflection` ([draft][retro]): of what the base reflects the share
//!   `retroreflectionFactor` (default 0) times the red channel of its texture goes back; what is
//!   transmitted and the clearcoat are as without.
//! - The reflectance is Schlick's with F90 = 1, for red, green and blue: F0 goes from the
//!   dielectric's to the base colour with `metallicFactor` (B.2). The dielectric's F0 is
//!   ((ior − 1)/(ior + 1))² with `KHR_materials_ior` (default 1.5), times `specularColorFactor` of
//!   `KHR_materials_specular`, and at most 1. With specular and glossiness it is `specularFactor`.
//! - Where a texture varies F0 the Fresnel term is left open, and so it is where `specularFactor`
//!   of `KHR_materials_specular`, which is F90, is not 1, and with a film, where
//!   `iridescenceFactor` of `KHR_materials_iridescence` is not 0. A dielectric whose
//!   `specularFactor` is 0 reflects nothing; unless it transmits, it has no lobe.
//! - `KHR_materials_sheen` has a distribution of its own; `KHR_materials_unlit` has no lobe.
//! - A value that is out of its range or of a wrong kind leaves out only its lobe, its Fresnel
//!   term, its texture or its mesh. A member that is null is absent. Indices may be written as
//!   `1.0`.
//! - `extensionsRequired` lists what a reader has to know (3.12): a material with one of those that
//!   is not known here is not understood. Other unknown extensions give a warning, unless they
//!   leave the lobes as they are, and so do unknown members outside `extras`.
//! - G2 is left to the renderer: appendix B and the anisotropy extension show one expression each.
//!
//! [spec]: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
//! [retro]: https://github.com/KhronosGroup/glTF/pull/2610

mod image;
mod material;
mod names;
mod object;

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::io::{self, Read};
use std::path::Path;

use serde_json::value::RawValue;

use microfacet_baker::input;
use microfacet_baker::scene::{Format, Lines, Place, Scene};
use microfacet_tables::Interval;

use self::image::Images;
use self::object::{Object, message};
use crate::Result;
use crate::builder::{Builder, shortened};
use crate::limits::{self, Budget};
use crate::texture::Channel;

/// What a file of version 1 is, and what to do with it.
const VERSION_1: &str = "glTF 1.0, and only version 2.0 is read; convert it: \
                         `gltf-pipeline -i old.gltf -o new.gltf` (CesiumGS)";

pub(super) fn load(path: &Path) -> Result<Scene> {
    let place = Place::file(path);
    let (json, chunk) = read(path, &place)?;
    // Some programs write names in other encodings; no name decides what is read.
    let json = String::from_utf8_lossy(input::unmarked(&json));
    let document: &RawValue = serde_json::from_str(&json).map_err(|error| {
        Lines::new(path, json.as_bytes())
            .after_feeds(error.line(), error.column().saturating_sub(1))
            .syntax(message(&error))
    })?;
    let document = Object::new(&place, String::new(), document)?;
    let asset = document.object_or_empty("asset")?;
    // Drafts of version 1 have a number instead of a text, or nothing.
    let version = asset.members.get("version").map_or("1", |text| text.get().trim_matches('"'));
    match version.split('.').next() {
        Some("2") => {}
        Some("1") => {
            return Err(place
                .invalid(format!("by its asset.version, or the lack of it, this is {VERSION_1}")));
        }
        _ => {
            let version = shortened(version);
            return Err(place.invalid(format!("this is glTF {version}; only version 2 is read")));
        }
    }
    let mut importer = Importer {
        builder: Builder::new(Format::Gltf),
        place: &place,
        images: Images {
            place: &place,
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            chunk,
            textures: document.list("textures")?,
            images: document.list("images")?,
            views: document.list("bufferViews")?,
            buffers: document.list("buffers")?,
        },
        ranges: HashMap::new(),
        read: HashMap::new(),
    };
    if matches!(json, Cow::Owned(_)) {
        let warning = "the JSON is not UTF-8; what is not has a \u{fffd} in its place";
        importer.builder.warn(&place, warning);
    }
    importer.materials(&document)?;
    Ok(importer.builder.finish(Vec::new()))
}

/// What helps where the JSON is too large.
const SEPARATE: &str = "export images and geometry to files of their own";

/// The JSON text, and where the content of the binary chunk begins if the file is a container
/// (specification, 4).
fn read(path: &Path, place: &Place) -> Result<(Vec<u8>, Option<u64>)> {
    let io = |error| place.io(error);
    // Of a container only the JSON is read, and images as they are asked for.
    let mut file = input::open(path, u64::MAX).map_err(io)?;
    let mut head = Vec::new();
    file.by_ref().take(20).read_to_end(&mut head).map_err(io)?;
    if !head.starts_with(b"glTF") {
        let json = input::read(path, limits::TEXT).map_err(|error| match error.kind() {
            io::ErrorKind::FileTooLarge => place.too_large(format!("it {error}; {SEPARATE}")),
            _ => io(error),
        });
        return Ok((json?, None));
    }
    let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    if head.len() >= 8 && word(4) == 1 {
        return Err(place.invalid(format!("this is a container of {VERSION_1}")));
    }
    if head.len() < 20 || word(4) != 2 || word(16) != u32::from_le_bytes(*b"JSON") {
        return Err(place.syntax("this is no glTF container of version 2 that begins with JSON"));
    }
    let size = u64::from(word(12));
    if size > limits::TEXT {
        return Err(place.too_large(format!(
            "the JSON of the glTF container has {size} bytes, and at most {} MiB are read; {SEPARATE}",
            limits::TEXT >> 20
        )));
    }
    let mut json = Vec::new();
    file.take(size).read_to_end(&mut json).map_err(io)?;
    if json.len() as u64 != size {
        return Err(place.syntax("the glTF container ends inside its JSON"));
    }
    // The binary chunk has a header of its own: length and type.
    Ok((json, Some(20 + size + 8)))
}

struct Importer<'a> {
    builder: Builder,
    place: &'a Place,
    images: Images<'a>,
    /// Ranges of the textures that were read.
    ranges: HashMap<(u64, Channel), Interval>,
    /// Ranges of the images that were read, or why there is none.
    read: HashMap<(u64, Channel), Result<Interval, String>>,
}

#[derive(Default)]
struct Used {
    materials: BTreeSet<u64>,
    /// Whether any material may be used: there are no meshes, or one cannot be read.
    any: bool,
    /// Whether a primitive has no material.
    default: bool,
}

impl<'a> Importer<'a> {
    fn materials(&mut self, document: &Object<'a>) -> Result<()> {
        let materials = document.list("materials")?;
        let used = self.used(&document.list("meshes")?, materials.len() as u64);
        let required = document.list("extensionsRequired")?;
        // Entries that are no text are ignored.
        let required = required.iter().filter_map(|text| serde_json::from_str(text.get()).ok());
        let required: BTreeSet<String> = required.collect();
        for (i, text) in materials.into_iter().enumerate() {
            let used = used.any || used.materials.contains(&(i as u64));
            let number = format!("material {i}");
            let material = Object::new(self.place, String::new(), text);
            let name = material.as_ref().ok().and_then(|material| material.text("name").ok()?);
            let name = name.filter(|name| !name.is_empty()).unwrap_or(number);
            let read = material.and_then(|material| {
                check_required(&material, &required)?;
                self.check_names(&name, "", &material, &Budget::new(limits::UNKNOWN));
                self.lobes(&name, &material, used)
            });
            self.builder.degrade(&name, "material", self.place, read)?;
        }
        // A primitive without a material has the default one (specification, 3.7.2.1).
        if used.default {
            let default = serde_json::from_str("{}").map_err(|why| self.place.io(why.into()))?;
            let default = Object::new(self.place, String::new(), default)?;
            self.lobes("default material", &default, true)?;
        }
        Ok(())
    }

    fn used(&mut self, meshes: &[&'a RawValue], count: u64) -> Used {
        let mut used = Used { any: meshes.is_empty(), ..Used::default() };
        for (i, mesh) in meshes.iter().enumerate() {
            if let Err(why) = use_of(self.place, mesh, &mut used) {
                used.any = true;
                let why = why.kind;
                let warning =
                    format!("mesh {i} cannot be read ({why}); all materials count as used");
                self.builder.warn(self.place, warning);
            }
        }
        for index in used.materials.range(count..) {
            let warning = format!(
                "a mesh refers to material {index}, but there are {count} materials, counted from 0"
            );
            self.builder.warn(self.place, warning);
        }
        used
    }
}

/// Notes which materials a mesh uses.
fn use_of<'a>(place: &'a Place, mesh: &'a RawValue, used: &mut Used) -> Result<()> {
    let mesh = Object::new(place, String::new(), mesh)?;
    if !mesh.members.contains_key("primitives") {
        return Err(mesh.invalid("primitives is missing"));
    }
    for primitive in mesh.objects("primitives")? {
        let primitive = primitive?;
        let material = primitive.index("material")?;
        used.default |= material.is_none();
        used.materials.extend(material);
        let extensions = primitive.object_or_empty("extensions")?;
        let variants = extensions.object_or_empty("KHR_materials_variants")?;
        for mapping in variants.objects("mappings")? {
            used.materials.insert(mapping?.required_index("material")?);
        }
    }
    Ok(())
}

/// Checks that a material has no extension that is required and not known.
fn check_required(material: &Object<'_>, required: &BTreeSet<String>) -> Result<()> {
    let known = names::extensions();
    let extensions = material.object_or_empty("extensions")?;
    let mut own = extensions.members.keys().filter(|name| required.contains(*name));
    match own.find(|name| !known.contains(&&name[..])) {
        Some(name) => {
            let why = format!("{name} is not known here, and extensionsRequired has it");
            Err(extensions.invalid(why))
        }
        None => Ok(()),
    }
}
