//! The parts of the glTF schema that are read, under the schema's names.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
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
    }

    input.deserialize_seq(List(PhantomData))
}

#[derive(Deserialize)]
pub(super) struct Asset {
    pub(super) version: String,
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
    pub(super) roughness_factor: f64,
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self { roughness_factor: 1.0, metallic_roughness_texture: None }
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
    pub(super) iridescence: Option<IgnoredAny>,
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(super) specular_glossiness: Option<SpecularGlossiness>,
    #[serde(rename = "KHR_materials_sheen")]
    pub(super) sheen: Option<IgnoredAny>,
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

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct SpecularGlossiness {
    pub(super) glossiness_factor: f64,
    pub(super) specular_glossiness_texture: Option<TextureInfo>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self { glossiness_factor: 1.0, specular_glossiness_texture: None }
    }
}

#[derive(Deserialize)]
pub(super) struct TextureInfo {
    pub(super) index: usize,
}

#[derive(Deserialize)]
pub(super) struct Texture {
    pub(super) source: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
}
