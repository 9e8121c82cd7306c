//! The parts of the glTF schema that are read, under the schema's names.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::scene::limits;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: Asset,
    #[serde(default, deserialize_with = "list")]
    pub(super) materials: Vec<Material>,
    #[serde(default, deserialize_with = "list")]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default, deserialize_with = "list")]
    pub(super) textures: Vec<Texture>,
    #[serde(default, deserialize_with = "list")]
    pub(super) images: Vec<Image>,
    #[serde(default, deserialize_with = "list")]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(default, deserialize_with = "list")]
    pub(super) buffers: Vec<Buffer>,
}

/// What a file of version 1 is, and what to do with it.
pub(super) const VERSION_1: &str = "glTF 1.0, and only version 2.0 is read; convert it: \
                                    `gltf-pipeline -i old.gltf -o new.gltf` (CesiumGS)";

/// A whole number, which some programs write as `1.0`.
fn whole<'de, D: Deserializer<'de>, T: TryFrom<u64>>(input: D) -> Result<T, D::Error> {
    struct Whole<T>(PhantomData<T>);

    impl<T: TryFrom<u64>> Visitor<'_> for Whole<T> {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a whole number of 0 or more")
        }

        fn visit_u64<E: Error>(self, number: u64) -> Result<T, E> {
            T::try_from(number).map_err(|_| E::custom(format!("{number} is too large")))
        }

        fn visit_f64<E: Error>(self, number: f64) -> Result<T, E> {
            // Above 2^53 not every whole number is one of these.
            const MOST: f64 = (1u64 << 53) as f64;
            if number.fract() == 0.0 && (0.0..=MOST).contains(&number) {
                return self.visit_u64(number as u64);
            }
            Err(E::custom(format!("{number:?} is not a whole number from 0 to 2^53")))
        }
    }

    input.deserialize_u64(Whole(PhantomData))
}

/// The same, which may be absent.
fn maybe_whole<'de, D: Deserializer<'de>>(input: D) -> Result<Option<usize>, D::Error> {
    #[derive(Deserialize)]
    struct One(#[serde(deserialize_with = "whole")] usize);

    Ok(Option::<One>::deserialize(input)?.map(|One(number)| number))
}

/// A list of limited length: each element takes far more memory than the text "{}".
fn list<'de, D: Deserializer<'de>, T: Deserialize<'de>>(input: D) -> Result<Vec<T>, D::Error> {
    struct List<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for List<T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a list")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut input: A) -> Result<Vec<T>, A::Error> {
            let mut list = Vec::new();
            while let Some(element) = input.next_element()? {
                if list.len() == limits::JSON_LIST {
                    let most = limits::JSON_LIST;
                    return Err(A::Error::custom(format!("a list has more than {most} elements")));
                }
                list.push(element);
            }
            Ok(list)
        }

        /// Version 1 has objects for the lists of version 2.
        fn visit_map<A: MapAccess<'de>>(self, _: A) -> Result<Vec<T>, A::Error> {
            Err(A::Error::custom(format!("an object where a list is expected, as in {VERSION_1}")))
        }
    }

    // As any value, so that an object is told from the rest.
    input.deserialize_any(List(PhantomData))
}

#[derive(Deserialize)]
pub(super) struct Asset {
    #[serde(deserialize_with = "version")]
    pub(super) version: String,
}

/// A version, for which drafts of version 1 have a number in the place of a text.
fn version<'de, D: Deserializer<'de>>(input: D) -> Result<String, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "a version, such as \"2.0\"")]
    enum Version {
        Text(String),
        Number(f64),
    }

    Ok(match Version::deserialize(input)? {
        Version::Text(text) => text,
        Version::Number(number) => format!("{number:?}"),
    })
}

/// Which materials a mesh uses, each once: a mesh may have very many primitives.
#[derive(Deserialize)]
#[serde(from = "Primitives")]
pub(super) struct Mesh {
    pub(super) materials: Vec<usize>,
    /// Whether a primitive names none.
    pub(super) uses_default: bool,
}

#[derive(Deserialize)]
struct Primitives {
    #[serde(deserialize_with = "list")]
    primitives: Vec<Primitive>,
}

impl From<Primitives> for Mesh {
    fn from(Primitives { primitives }: Primitives) -> Self {
        let uses_default = primitives.iter().any(|primitive| primitive.material.is_none());
        let variants = |p: &Primitive| {
            let mappings = p.extensions.variants.iter().flat_map(|variants| &variants.mappings);
            mappings.map(|mapping| mapping.material).collect::<Vec<_>>()
        };
        let materials = primitives.iter().flat_map(|p| p.material.into_iter().chain(variants(p)));
        let mut materials: Vec<usize> = materials.collect();
        materials.sort_unstable();
        materials.dedup();
        materials.shrink_to_fit();
        Self { materials, uses_default }
    }
}

#[derive(Deserialize)]
struct Primitive {
    #[serde(default, deserialize_with = "maybe_whole")]
    material: Option<usize>,
    #[serde(default)]
    extensions: PrimitiveExtensions,
}

#[derive(Default, Deserialize)]
struct PrimitiveExtensions {
    #[serde(rename = "KHR_materials_variants")]
    variants: Option<Variants>,
}

#[derive(Deserialize)]
struct Variants {
    #[serde(deserialize_with = "list")]
    mappings: Vec<Mapping>,
}

#[derive(Deserialize)]
struct Mapping {
    #[serde(deserialize_with = "whole")]
    material: usize,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Material {
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: MetallicRoughness,
    pub(super) extensions: MaterialExtensions,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct MetallicRoughness {
    pub(super) base_color_factor: [f64; 4],
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_factor: f64,
    pub(super) roughness_factor: f64,
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

#[derive(Default, Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_anisotropy")]
    pub(super) anisotropy: Option<Anisotropy>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub(super) clearcoat: Option<Clearcoat>,
    #[serde(rename = "KHR_materials_ior")]
    pub(super) ior: Option<Ior>,
    #[serde(rename = "KHR_materials_iridescence")]
    pub(super) iridescence: Option<Iridescence>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(super) specular_glossiness: Option<SpecularGlossiness>,
    #[serde(rename = "KHR_materials_sheen")]
    pub(super) sheen: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_specular")]
    pub(super) specular: Option<Specular>,
    #[serde(rename = "KHR_materials_transmission")]
    pub(super) transmission: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_unlit")]
    pub(super) unlit: Option<IgnoredAny>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Anisotropy {
    pub(super) anisotropy_strength: f64,
    pub(super) anisotropy_texture: Option<TextureInfo>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Clearcoat {
    pub(super) clearcoat_factor: f64,
    pub(super) clearcoat_roughness_factor: f64,
    pub(super) clearcoat_roughness_texture: Option<TextureInfo>,
}

#[derive(Deserialize)]
#[serde(default)]
pub(super) struct Ior {
    pub(super) ior: f64,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Iridescence {
    pub(super) iridescence_factor: f64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Specular {
    pub(super) specular_factor: f64,
    pub(super) specular_texture: Option<TextureInfo>,
    pub(super) specular_color_factor: [f64; 3],
    pub(super) specular_color_texture: Option<TextureInfo>,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct SpecularGlossiness {
    pub(super) specular_factor: [f64; 3],
    pub(super) glossiness_factor: f64,
    pub(super) specular_glossiness_texture: Option<TextureInfo>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self {
            specular_factor: [1.0; 3],
            glossiness_factor: 1.0,
            specular_glossiness_texture: None,
        }
    }
}

#[derive(Deserialize)]
pub(super) struct TextureInfo {
    #[serde(deserialize_with = "whole")]
    pub(super) index: usize,
}

#[derive(Deserialize)]
pub(super) struct Texture {
    #[serde(default, deserialize_with = "maybe_whole")]
    pub(super) source: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) uri: Option<String>,
    #[serde(default, deserialize_with = "maybe_whole")]
    pub(super) buffer_view: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    #[serde(deserialize_with = "whole")]
    pub(super) buffer: usize,
    #[serde(default, deserialize_with = "whole")]
    pub(super) byte_offset: u64,
    #[serde(deserialize_with = "whole")]
    pub(super) byte_length: u64,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
}
