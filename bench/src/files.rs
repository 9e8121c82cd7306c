//! The output files: tables as CSV, and everything as JSON.

use std::path::Path;

use serde::{Serialize, Serializer};

use microfacet_baker::store::replace;

use crate::Failure;

/// Writes files into an existing folder.
pub(crate) fn write(folder: &Path, files: &[(&str, Vec<u8>)]) -> Result<(), Failure> {
    for (name, bytes) in files {
        let path = folder.join(name);
        replace(&path, bytes)
            .map_err(|why| Failure(format!("writing {}: {why}", path.display())))?;
    }
    Ok(())
}

/// Records as CSV with these names of columns, or with the names of fields if there are none;
/// records with arrays need names.
pub(crate) fn csv<T: Serialize>(
    header: &[&str],
    records: impl IntoIterator<Item = T>,
) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::WriterBuilder::new().has_headers(header.is_empty()).from_writer(vec![]);
    if !header.is_empty() {
        writer.write_record(header)?;
    }
    for record in records {
        writer.serialize(record)?;
    }
    Ok(writer.into_inner()?)
}

/// A shape: JSON has no infinity, and no number stands for one that varies.
pub(crate) fn shape<S: Serializer>(gamma: &f64, to: S) -> Result<S::Ok, S::Error> {
    match gamma {
        varying if varying.is_nan() => to.serialize_str("varies"),
        finite if finite.is_finite() => to.serialize_f64(*finite),
        _ => to.serialize_str("inf"),
    }
}
