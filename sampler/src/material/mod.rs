//! Materials bound to their tables: a distribution of normals with roughness and shape fixed, only directions left.

mod batch;
mod below;
mod bounded;
mod ellipsoid;
mod ggx;
mod plain;
mod radial;
mod sample;
mod slices;
mod student_t;
mod table_pdf;

pub use bounded::Bounded;
pub use ellipsoid::{Ellipsoid, Skew};
pub use radial::Radial;
pub use student_t::{Roughness, StudentT};

pub(crate) use slices::covers;
