//! For lookups and BSDFs written in another language: all that those of one shape read,
//! in the form in which this crate's own have it. It may change in any release.

use microfacet_tables::Table;

use crate::material::slices;
use crate::{MaterialError, Tables};

pub use crate::albedo::shape::ShapeAlbedo;
pub use crate::material::shape::{HeavyTables, ShapeTables};

/// The tables that a lobe of one shape reads: of masking, of slopes in the plane of incidence, and
/// of those across it.
///
/// # Errors
/// As [`Tables::student_t`].
pub fn tables_of_shape(tables: &Tables, gamma: f64) -> Result<[&Table; 3], MaterialError> {
    slices::tables_of_shape(tables.tables(), gamma)
}
