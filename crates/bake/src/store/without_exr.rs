//! Errors for images in a build without the feature `exr`.

use microfacet_sampler::Tables;
use microfacet_tables::{LoadError, Provenance, Table};

const REMEDY: &str = "OpenEXR needs the feature `exr` of microfacet-baker; use safetensors";

pub(super) fn encode(_: &Provenance, _: &[Table]) -> Result<Vec<u8>, String> {
    Err(REMEDY.into())
}

pub(super) fn decode(_: &[u8]) -> Result<Tables, LoadError> {
    Err(LoadError::Unsupported(REMEDY.into()))
}
