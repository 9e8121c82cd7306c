//! What the generator, `microfacet-bake`, needs beyond the public interface, so that a formula or a
//! mechanism has one home. It may change in any release.

use alloc::vec::Vec;

use glam::Vec3;

use crate::material::slices;
use crate::{Albedo, MaterialError, StudentT, Table, Tables};

pub use crate::albedo::shape::ShapeAlbedo;
pub use crate::axis::hermite::limit_slopes;
pub use crate::error::GAMMA_MIN;
pub use crate::format::{describe, reassemble, seal, seal_document};
pub use crate::material::shape::{HeavyTables, ShapeTables};

/// The tables that a lobe of one shape reads: of masking, of slopes in the plane of incidence, and
/// of those across it.
///
/// # Errors
/// As [`Tables::student_t`].
pub fn tables_of_shape(tables: &Tables, gamma: f64) -> Result<[&Table; 3], MaterialError> {
    slices::tables_of_shape(tables.tables(), gamma)
}

/// The cosine m·n below which a facet that refracts is only sampled, where D has a pole at the
/// horizon (see [`Dielectric`](crate::Dielectric)).
pub fn steep_cosine(eta: f32) -> f32 {
    crate::bsdf::steep_cosine(eta)
}

/// Where the tabulated density has its joints for a view: unit slopes x in the plane of incidence,
/// ascending, and t ≥ 0 across it.
///
/// Between them the density of the samples is smooth, so a quadrature that respects them converges
/// fast. x may end at ±∞.
pub fn table_joints(lobe: &StudentT, v: Vec3) -> [Vec<f64>; 2] {
    lobe.table_joints(v)
}

/// The averages by quadrature of the interpolated albedo, in the form of the channels of
/// `albedo_average` tables.
pub fn average_channels(albedo: &Albedo) -> [f32; 3] {
    albedo.integrate()
}
