//! Tables as CSV.

use crate::Failure;

/// A table with a header.
pub(crate) fn csv<const N: usize>(
    header: &[&str; N],
    records: impl Iterator<Item = [String; N]>,
) -> Result<Vec<u8>, Failure> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for record in records {
        writer.write_record(&record)?;
    }
    Ok(writer.into_inner()?)
}

/// With every digit.
pub(crate) fn number(x: f64) -> String {
    format!("{x:e}")
}
