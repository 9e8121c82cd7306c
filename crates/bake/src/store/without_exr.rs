//! What stands in for images in a build without the feature `exr`.

use std::path::Path;

use microfacet_sampler::Tables;
use microfacet_tables::{LoadError, Provenance, Table};

const REMEDY: &str = "OpenEXR needs the feature `exr` of microfacet-baker; use safetensors";

pub(super) fn encode(_: &Provenance, _: &Table) -> Result<Vec<u8>, String> {
    Err(REMEDY.into())
}

pub(super) fn decode(_: &[u8]) -> Result<Tables, LoadError> {
    Err(LoadError::Unsupported(REMEDY.into()))
}

/// No image is known to be one of ours, so none is read, replaced or removed.
pub(super) fn is_table(_: &Path) -> Result<bool, String> {
    Ok(false)
}
