//! The safetensors container: one file holds all tables of a set and, in its metadata, the document
//! that describes them.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use safetensors::{SafeTensors, tensor::TensorView};

use super::checksum;
use super::document::{Document, Provenance, check_version, invalid};
use super::precision::Codec;
use super::stack::Stack;
use super::table::Table;
use crate::error::LoadError;

/// Key of the document in the safetensors metadata.
const KEY: &str = "microfacet";

/// Writes a set as the bytes of a safetensors file; the same set always gives the same bytes.
///
/// # Errors
/// [`LoadError::Invalid`] if a material or a table would not load again.
pub fn encode(provenance: &Provenance, tables: &[Table]) -> Result<Vec<u8>, LoadError> {
    let document = Document::of(provenance, tables)?;
    let mut rest = tables;
    let mut data: Vec<(&Stack, Vec<u8>)> = Vec::new();
    for stack in &document.tables {
        let (own, others) = rest.split_at(stack.len());
        rest = others;
        let bytes = |table: &Table| {
            let codec = Codec::fit(table.precision, &table.values, table.channels.len());
            codec.encode(&table.values)
        };
        data.push((stack, own.iter().flat_map(bytes).collect()));
    }
    let views = data
        .iter()
        .map(|(stack, bytes)| {
            let shape = stack.shape(&document.axes).unwrap_or_default();
            let view = TensorView::new(stack.precision.dtype(), shape, bytes)?;
            Ok((stack.name.as_str(), view))
        })
        .collect::<Result<Vec<_>, safetensors::SafeTensorError>>()
        .map_err(invalid)?;
    // One key only: the library writes the metadata in hash-map order.
    let metadata = [(KEY.to_owned(), document.to_json()?)].into_iter().collect();
    let mut bytes = safetensors::serialize(views, Some(metadata)).map_err(invalid)?;
    if checksum::seal(&mut bytes) { Ok(bytes) } else { Err(invalid("no place for the checksum")) }
}

/// Reads a set from the bytes of a safetensors file and checks everything; without `verify`, for
/// bytes known to be good, all but the checksum.
///
/// # Errors
/// [`LoadError`] saying what is wrong; it never panics, and never allocates more than a few times
/// the input, or a kilobyte for each of 65,536 tables.
pub fn decode(bytes: &[u8], verify: bool) -> Result<(Provenance, Vec<Table>), LoadError> {
    let (_, metadata) = SafeTensors::read_metadata(bytes).map_err(|why| {
        invalid(format!("{why}; a table set is a safetensors file written by `microfacet-bake`"))
    })?;
    let json = metadata.metadata().as_ref().and_then(|map| map.get(KEY)).ok_or_else(|| {
        invalid(format!("a safetensors file, but without the `{KEY}` document of a table set"))
    })?;
    check_version(json)?;
    if verify && !checksum::is_sealed(bytes).ok_or_else(|| invalid("no checksum"))? {
        let why = "checksum does not match: the file is damaged; copy it again or bake again";
        return Err(invalid(why));
    }
    let tensors = SafeTensors::deserialize(bytes).map_err(invalid)?;
    let document = Document::from_json(json)?;
    let tables = document.tables(|stack, i| {
        let tensor =
            tensors.tensor(&stack.name).map_err(|_| "no tensor of that name".to_string())?;
        let (stored, stated) = (tensor.dtype(), stack.precision);
        if stored != stated.dtype() {
            return Err(format!("stored as {stored:?}, described as {stated:?}"));
        }
        let (got, shape) = (tensor.shape(), stack.shape(&document.axes).unwrap_or_default());
        if got != shape {
            return Err(format!("tensor of shape {got:?}, axes and channels of {shape:?}"));
        }
        let bytes = tensor.data().len() / stack.len();
        Ok(stack.codec(i)?.decode(&tensor.data()[i * bytes..][..bytes]))
    })?;
    if tensors.len() != document.tables.len() {
        let described = document.tables.len();
        return Err(invalid(format!("{} tensors, {described} described", tensors.len())));
    }
    Ok((document.provenance, tables))
}
