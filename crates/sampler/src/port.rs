//! For lookups and BSDFs in another language: the data that lookups of one shape and of dielectrics
//! of one index read, laid out as in this crate. This module may change in any release.

use microfacet_tables::Table;

use crate::material::slices;
use crate::{FamilyDielectric, MaterialError, Tables};

pub use crate::albedo::family::tables::VolumeTables;
pub use crate::albedo::{InterfaceAxis, InterfaceSide, InterfaceTables, View as InterfaceView};
pub use crate::bsdf::steep_cosine;
pub use crate::material::family_tables::{ByShape, PartTables, WindowCell, WindowTables};
pub use crate::material::shape::{HeavyTables, ShapeTables};

/// The tables that a lobe of one shape reads: of masking, of slopes in the plane of incidence, and
/// of those across it.
///
/// # Errors
/// As [`Tables::student_t`].
pub fn tables_of_shape(tables: &Tables, gamma: f64) -> Result<[&Table; 3], MaterialError> {
    slices::tables_of_shape(tables.searched(), gamma)
}

/// What lookups of dielectrics of one index read.
#[must_use]
pub fn interface_tables(family: &FamilyDielectric) -> InterfaceTables {
    family.tables()
}
