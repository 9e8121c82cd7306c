//! The safetensors container: one file holds all tables of a set and one JSON document that
//! describes them, in its metadata.
//!
//! `docs/format.md` is the specification. One checksum covers the whole file, header included.

use alloc::borrow::ToOwned;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use microfacet_core::Masking;
use safetensors::{SafeTensors, tensor::TensorView};
use serde::{Deserialize, Serialize};

use super::certificate::Certificate;
use super::checksum;
use super::kind::Kind;
use super::material::MaterialEntry;
use super::precision::{Codec, Precision};
use super::subject::{Covered, LobeEntry, Reflectance, Subject};
use super::table::Table;
use crate::axis::Axis;
use crate::error::LoadError;

/// The `format` entry of the document.
pub const FORMAT: &str = "microfacet-tables";
/// Version of the format that this crate writes, and the only one that it reads.
pub const VERSION: u32 = 4;
/// Key of the document in the safetensors metadata.
const KEY: &str = "microfacet";

/// Where a set comes from, and how its numbers are to be read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Program and version that baked the set.
    pub generator: String,
    /// Number of the numeric method; it changes whenever the same recipe would give other bytes.
    pub numerics: u32,
    /// Licence of the data.
    pub license: String,
    /// The conventions that a reader could get wrong, in words.
    pub conventions: BTreeMap<String, String>,
    /// The recipe that the set was baked from, as TOML; empty for the general set.
    pub recipe: String,
    /// Named materials of the recipe.
    pub materials: Vec<MaterialEntry>,
}

impl Provenance {
    /// Checks every number of the materials, and that their names differ.
    pub fn check(&self) -> Result<(), LoadError> {
        let mut names = BTreeSet::new();
        for material in &self.materials {
            let named =
                if names.insert(&material.name) { Ok(()) } else { Err("named twice".into()) };
            material.check().and(named).map_err(|why: String| {
                LoadError::Invalid(format!("material `{}`: {why}", material.name))
            })?;
        }
        Ok(())
    }
}

#[derive(Serialize, Deserialize)]
struct Document {
    format: String,
    version: u32,
    checksum: String,
    #[serde(flatten)]
    provenance: Provenance,
    /// Formulas of the mappings that occur, by kind, for authors of readers.
    #[serde(default)]
    mappings: BTreeMap<String, String>,
    tables: Vec<Descriptor>,
}

#[derive(Serialize, Deserialize)]
struct Descriptor {
    name: String,
    kind: Kind,
    lobe: LobeEntry,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    masking: Option<Masking>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reflectance: Option<Reflectance>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    covers: Option<Covered>,
    axes: Vec<Axis>,
    channels: Vec<String>,
    precision: Precision,
    /// For `u16`: value = offset + scale·integer, per channel.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    scale: Vec<f32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    offset: Vec<f32>,
    certificate: Certificate,
}

fn formula(axis: &Axis) -> (String, String) {
    (axis.mapping.name().into(), axis.mapping.formula().into())
}

fn fit(table: &Table) -> Codec {
    Codec::fit(table.precision, &table.values, table.channels.len())
}

fn named_twice(table: &str) -> LoadError {
    invalid(format!("table `{table}`: named twice"))
}

fn invalid(why: impl ToString) -> LoadError {
    LoadError::Invalid(why.to_string())
}

/// The JSON document that describes a set, with zeros for its checksum.
///
/// It is what [`encode`] embeds, and what other containers may carry.
///
/// # Errors
/// [`LoadError::Invalid`] if a material or a table would not load again.
pub fn describe(provenance: &Provenance, tables: &[Table]) -> Result<String, LoadError> {
    provenance.check()?;
    let mut descriptors = Vec::new();
    let mut names = BTreeSet::new();
    for table in tables {
        table.validate()?;
        if !names.insert(&table.name) {
            return Err(named_twice(&table.name));
        }
        let (scale, offset) = fit(table).scale_offset();
        let Subject { lobe, masking, reflectance, covers } = table.subject.clone();
        descriptors.push(Descriptor {
            name: table.name.clone(),
            kind: table.kind,
            lobe,
            masking,
            reflectance,
            covers,
            axes: table.axes.clone(),
            channels: table.channels.clone(),
            precision: table.precision,
            scale,
            offset,
            certificate: table.certificate.clone(),
        });
    }
    let document = Document {
        format: FORMAT.into(),
        version: VERSION,
        checksum: checksum::NONE.into(),
        provenance: provenance.clone(),
        mappings: tables.iter().flat_map(|table| &table.axes).map(formula).collect(),
        tables: descriptors,
    };
    serde_json::to_string(&document).map_err(invalid)
}

/// Writes a set as the bytes of a safetensors file; the same set always gives the same bytes.
///
/// # Errors
/// [`LoadError::Invalid`] if a material or a table would not load again.
pub fn encode(provenance: &Provenance, tables: &[Table]) -> Result<Vec<u8>, LoadError> {
    let json = describe(provenance, tables)?;
    let data: Vec<Vec<u8>> = tables.iter().map(|table| fit(table).encode(&table.values)).collect();
    let views = data
        .iter()
        .zip(tables)
        .map(|(bytes, table)| {
            TensorView::new(table.precision.dtype(), table.shape(), bytes)
                .map(|view| (table.name.as_str(), view))
        })
        .collect::<Result<Vec<_>, _>>()
        .map_err(invalid)?;
    // One key only: the library writes the metadata in hash-map order.
    let metadata = [(KEY.to_owned(), json)].into_iter().collect();
    let mut bytes = safetensors::serialize(views, Some(metadata)).map_err(invalid)?;
    if checksum::seal(&mut bytes) { Ok(bytes) } else { Err(invalid("no place for the checksum")) }
}

/// Reads a set from the bytes of a safetensors file and checks everything; without `verify`, for
/// bytes known to be good, all but the checksum.
///
/// # Errors
/// [`LoadError`] saying what is wrong; it never panics, and never allocates more than a few times
/// the input.
pub fn decode(bytes: &[u8], verify: bool) -> Result<(Provenance, Vec<Table>), LoadError> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|why| {
        invalid(format!("{why}; a table set is a safetensors file written by `microfacet-bake`"))
    })?;
    let json = metadata.metadata().as_ref().and_then(|map| map.get(KEY)).ok_or_else(|| {
        invalid(format!("a safetensors file, but without the `{KEY}` document of a table set"))
    })?;
    check_version(json)?;
    match if verify { checksum::is_sealed(bytes) } else { Some(true) } {
        Some(true) => {}
        Some(false) => {
            return Err(invalid(
                "checksum does not match: the file is damaged; copy it again or bake again",
            ));
        }
        None => return Err(invalid("no checksum")),
    }
    let tensors = SafeTensors::deserialize(bytes).map_err(invalid)?;
    let (provenance, tables) = assemble(json, |descriptor, codec| {
        let tensor =
            tensors.tensor(&descriptor.name).map_err(|_| "no tensor of that name".to_string())?;
        if tensor.dtype() != descriptor.precision.dtype() {
            return Err(format!(
                "stored as {:?}, described as {:?}",
                tensor.dtype(),
                descriptor.precision
            ));
        }
        let shape: Vec<usize> =
            descriptor.axes.iter().map(Axis::len).chain([descriptor.channels.len()]).collect();
        if shape != tensor.shape() {
            return Err(format!(
                "tensor of shape {:?}, axes and channels of {shape:?}",
                tensor.shape()
            ));
        }
        Ok(codec.decode(tensor.data()))
    })?;
    if tensors.len() != tables.len() {
        return Err(invalid(format!("{} tensors for {} tables", tensors.len(), tables.len())));
    }
    Ok((provenance, tables))
}

/// Reassembles a set from the document of [`describe`] and the decoded values of each table.
///
/// # Errors
/// [`LoadError`] if the document is not that of a set, or a table is not valid.
pub fn reassemble(
    json: &str,
    mut values: impl FnMut(&str) -> Result<Vec<f32>, String>,
) -> Result<(Provenance, Vec<Table>), LoadError> {
    check_version(json)?;
    assemble(json, |descriptor, _| values(&descriptor.name))
}

/// Checks the format and version of a document before anything else: a newer document may not parse
/// as this version.
fn check_version(json: &str) -> Result<(), LoadError> {
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
    }
    let head: Head = serde_json::from_str(json).map_err(invalid)?;
    if head.format != FORMAT {
        return Err(invalid(format!("format \"{}\" where \"{FORMAT}\" is expected", head.format)));
    }
    if head.version != VERSION {
        return Err(LoadError::Unsupported(format!(
            "format version {} (this reader knows {VERSION}): update the reader or bake again",
            head.version
        )));
    }
    Ok(())
}

fn assemble(
    json: &str,
    mut values: impl FnMut(&Descriptor, &Codec) -> Result<Vec<f32>, String>,
) -> Result<(Provenance, Vec<Table>), LoadError> {
    let document: Document = serde_json::from_str(json).map_err(invalid)?;
    document.provenance.check()?;
    let mut tables: Vec<Table> = Vec::with_capacity(document.tables.len());
    let mut names = BTreeSet::new();
    for descriptor in document.tables {
        let fail = |why: String| invalid(format!("table `{}`: {why}", descriptor.name));
        if descriptor.channels.is_empty() {
            return Err(fail("no channels".into()));
        }
        if !names.insert(descriptor.name.clone()) {
            return Err(named_twice(&descriptor.name));
        }
        let Descriptor { precision, scale, offset, channels, .. } = &descriptor;
        let codec = Codec::described(*precision, scale, offset, channels.len());
        let codec = codec.map_err(|why| fail(why.into()))?;
        let values = values(&descriptor, &codec).map_err(fail)?;
        let Descriptor { lobe, masking, reflectance, covers, .. } = descriptor;
        let table = Table {
            values,
            name: descriptor.name,
            kind: descriptor.kind,
            subject: Subject { lobe, masking, reflectance, covers },
            axes: descriptor.axes,
            channels: descriptor.channels,
            precision: descriptor.precision,
            certificate: descriptor.certificate,
        };
        table.validate()?;
        tables.push(table);
    }
    Ok((document.provenance, tables))
}
