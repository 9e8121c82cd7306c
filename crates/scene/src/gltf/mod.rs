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
//! - The reflectance is Schlick's with F90 = 1, for red, green and blue: F0 goes from the
//!   dielectric's to the base colour with `metallicFactor` (B.2). The dielectric's F0 is
//!   ((ior − 1)/(ior + 1))² with `KHR_materials_ior` (default 1.5), times `specularColorFactor` of
//!   `KHR_materials_specular`, and at most 1. With specular and glossiness it is `specularFactor`.
//! - Where a texture varies F0 the Fresnel term is left open, and so it is where `specularFactor`
//!   of `KHR_materials_specular`, which is F90, is not 1, and with a film, where
//!   `iridescenceFactor` of `KHR_materials_iridescence` is not 0. A dielectric whose
//!   `specularFactor` is 0 reflects nothing; unless it transmits, it has no lobe.
//! - `KHR_materials_sheen` has a distribution of its own; `KHR_materials_unlit` has no lobe.
//! - A factor out of its range costs its lobe, or its Fresnel term, alone; a value of a wrong kind
//!   costs the material, the texture or the mesh that it is in. A member that is null is absent.
//!   Indices may be written as `1.0`.
//! - `extensionsRequired` lists what a reader has to know (3.12): a material with one of those that
//!   is not known here is not understood. Others of a material are warned of, unless they leave its
//!   lobes as they are, and so is a member that glTF does not have. `extras` may hold anything.
//! - The form of G2 is left to the renderer: appendix B and the anisotropy extension show one form
//!   each.
//!
//! [spec]: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html

mod fresnel;
mod ignored;
mod image;
mod material;
mod parameters;
mod schema;
mod value;

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use microfacet_baker::input;
use microfacet_baker::scene::{Format, Lines, Place, Scene, SceneError};

use self::parameters::{Material, Named};
use self::schema::{Document, Mesh};
use self::value::{Unknown, VERSION_1, Value, message};
use super::builder::Builder;
use super::texture::Textures;
use crate::limits;

/// Reads a glTF 2.0 scene.
pub(super) fn load(path: &Path) -> Result<Scene, SceneError> {
    let place = Place::file(path);
    let (json, binary) = read(path, &place)?;
    // Programs write names in encodings of their own; they have no say in what is read.
    let json = String::from_utf8_lossy(input::unmarked(&json));
    let document: Document<'_> = serde_json::from_str(&json).map_err(|error| {
        Lines::new(path, json.as_bytes())
            .after_feeds(error.line(), error.column().saturating_sub(1))
            .syntax(message(&error))
    })?;
    let version = &document.asset.version;
    match version.split('.').next() {
        Some("2") => {}
        Some("1") => return Err(place.invalid(format!("this is {VERSION_1}"))),
        _ => return Err(place.invalid(format!("this is glTF {version}; only version 2 is read"))),
    }
    let mut importer = Importer {
        builder: Builder::new(Format::Gltf),
        folder: path.parent().unwrap_or(Path::new("")),
        place,
        document: &document,
        binary,
        embedded: Textures::default(),
    };
    if matches!(json, Cow::Owned(_)) {
        let warning = "the JSON is not UTF-8; what is not has a \u{fffd} in its place";
        importer.builder.warn(&importer.place, warning);
    }
    importer.materials()?;
    Ok(importer.builder.finish(Vec::new()))
}

/// What the names of Khronos' extensions of materials begin with.
const KHRONOS: &str = "KHR_materials_";

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
    if head.len() >= 8 && word(4) == 1 {
        return Err(place.invalid(format!("this is a container of {VERSION_1}")));
    }
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
    document: &'a Document<'a>,
    binary: Option<Section>,
    /// Images in the document or its buffers, by their number.
    embedded: Textures<usize>,
}

/// What meshes use.
struct Used {
    materials: BTreeSet<usize>,
    /// Whether any material may be used: there are no meshes, or one cannot be read.
    any: bool,
    /// Whether a primitive has no material.
    default: bool,
}

impl Importer<'_> {
    fn materials(&mut self) -> Result<(), SceneError> {
        let document = self.document;
        let used = self.used();
        let required = document.extensions_required.iter();
        let required = required.filter_map(|text| Value::of(text).read().ok()).collect();
        for (i, text) in document.materials.iter().enumerate() {
            let named = Value::of(text).read::<Named>().ok().and_then(|named| named.name);
            let name = match named {
                Some(name) if !name.is_empty() => name,
                _ => format!("material {i}"),
            };
            let used = used.any || used.materials.contains(&i);
            let unknown = RefCell::default();
            match Value::of(text).requiring(&required).noting(&unknown).read() {
                Ok(material) => {
                    self.check_names(&name, unknown.into_inner());
                    self.material(&name, &material, used)?;
                }
                Err(why) => self.builder.not_understood(&name, "material", &self.place, why)?,
            }
        }
        // A primitive without a material has the default one (specification, 3.7.2.1).
        if used.default {
            self.material("default material", &Material::default(), true)?;
        }
        Ok(())
    }

    /// Warns of what is not known in a material.
    fn check_names(&mut self, material: &str, unknown: Vec<Unknown>) {
        for Unknown { object, name, known } in unknown {
            if object == "extensions" {
                // The beginning would make all of them alike.
                let stem = |name: &'static str| name.strip_prefix(KHRONOS).unwrap_or(name);
                let own = name.strip_prefix(KHRONOS).unwrap_or(&name);
                let hint = self.builder.did_you_mean(own, known.into_iter().map(stem));
                let extension = format!("the extension {name} of material \"{material}\"");
                let warning = format!("{extension} is not read{hint}; its lobes are without it");
                self.builder.warn(&self.place, warning);
            } else {
                let of = if object.is_empty() { "" } else { " of " };
                let owner = format!("{object}{of}material \"{material}\"");
                self.builder.check_name(&owner, &name, &known, &self.place);
            }
        }
    }

    fn used(&mut self) -> Used {
        let Document { meshes, materials, .. } = self.document;
        let mut used = Used { materials: BTreeSet::new(), any: meshes.is_empty(), default: false };
        for (i, text) in meshes.iter().enumerate() {
            match Value::of(text).read::<Mesh>() {
                Ok(mesh) => {
                    used.materials.extend(mesh.materials);
                    used.default |= mesh.uses_default;
                }
                Err(why) => {
                    used.any = true;
                    let warning =
                        format!("mesh {i} cannot be read ({why}); all materials count as used");
                    self.builder.warn(&self.place, warning);
                }
            }
        }
        let count = materials.len();
        for index in used.materials.range(count..) {
            let warning = format!(
                "a mesh refers to material {index}, but there are {count} materials, counted from 0"
            );
            self.builder.warn(&self.place, warning);
        }
        used
    }
}
