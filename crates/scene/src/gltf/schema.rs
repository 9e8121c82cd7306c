//! The parts of the glTF schema that are read, under the schema's names.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::value::{Entry, list};

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    pub(super) asset: Asset,
    /// [`Material`](super::parameters::Material)s, each read in its turn: it is much larger than
    /// the text "{}".
    #[serde(borrow, default, deserialize_with = "list")]
    pub(super) materials: Vec<&'a RawValue>,
    /// [`Mesh`]es, likewise.
    #[serde(borrow, default, deserialize_with = "list")]
    pub(super) meshes: Vec<&'a RawValue>,
    /// Names, likewise.
    #[serde(borrow, default, deserialize_with = "list")]
    pub(super) extensions_required: Vec<&'a RawValue>,
    #[serde(default, deserialize_with = "list")]
    pub(super) textures: Vec<Entry<Texture>>,
    #[serde(default, deserialize_with = "list")]
    pub(super) images: Vec<Entry<Image>>,
    #[serde(default, deserialize_with = "list")]
    pub(super) buffer_views: Vec<Entry<BufferView>>,
    #[serde(default, deserialize_with = "list")]
    pub(super) buffers: Vec<Entry<Buffer>>,
}

/// A whole number, which some programs write as `1.0`.
pub(super) fn whole<'de, D: Deserializer<'de>, T: TryFrom<u64>>(input: D) -> Result<T, D::Error> {
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

/// The same, of a member that may be absent.
fn maybe_whole<'de, D: Deserializer<'de>>(input: D) -> Result<Option<usize>, D::Error> {
    whole(input).map(Some)
}

/// A list of exactly so many numbers.
pub(super) fn numbers<'de, D: Deserializer<'de>, const N: usize>(
    input: D,
) -> Result<[f64; N], D::Error> {
    let wrong = |numbers: Vec<f64>| {
        let count = numbers.len();
        D::Error::custom(format!("the list has {count} numbers; it must have {N}"))
    };
    list(input)?.try_into().map_err(wrong)
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

/// Which materials a mesh uses.
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
        Self { materials: materials.collect(), uses_default }
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
