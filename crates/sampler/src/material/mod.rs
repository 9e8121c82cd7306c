//! The lobes of materials: distributions of normals with fixed parameters.
//!
//! [`distribution`] is the trait of all lobes; [`reflecting`], [`tabulated`] and [`batch`] are what
//! BSDFs, tables and slices of views ask beyond it. [`student_t`] reads slices of the tables
//! ([`slices`]) for masking and visible normals, for the shapes that all of them cover
//! ([`coverage`]); [`lanes`] are its lookups in SIMD, with the part that no table holds from
//! [`heavy`], and [`horizon`] corrects normals that rounding has moved out of their domain.
//! [`normals`] is D in closed form, with a [`power_table`] for its power. [`table_pdf`] is the
//! density of what is drawn; [`bounded`] leaves out normals that cannot reflect a view [`upward`].
//! [`ellipsoid`]
//! transforms directions by a [`matrix`] to a Student-t, and draws by rejection for views
//! [`below_horizon`]; [`radial`] has tables of its own, and [`ggx`], the [`smooth`] surface and
//! [`pseudo`]-visible normals need none. [`key`] identifies a lobe to albedo tables, and [`shape`]
//! is what exports write of one.

mod batch;
mod below_horizon;
mod bounded;
pub(crate) mod coverage;
mod delegate;
mod distribution;
mod ellipsoid;
mod family;
mod family_part;
pub(crate) mod family_tables;
mod ggx;
mod heavy;
mod horizon;
mod key;
mod lanes;
mod lobe;
mod matrix;
mod normals;
mod power_table;
mod pseudo;
mod radial;
mod reflecting;
mod roughness;
pub(crate) mod shape;
pub(crate) mod slices;
mod smooth;
mod student_t;
mod surface;
mod table_pdf;
mod tabulated;
mod upward;
mod windows;

pub use batch::Batch;
pub use bounded::{Bounded, BoundedRef, BoundedView};
pub use distribution::{Facet, MicrofacetDistribution};
pub use ellipsoid::{Ellipsoid, EllipsoidRef};
pub use family::{BoundedFamilyLobe, Family, FamilyLobe};
pub use ggx::Ggx;
pub use key::LobeKey;
pub use lobe::Lobe;
pub use pseudo::PseudoVisible;
pub use radial::Radial;
pub(crate) use radial::RadialError;
pub use reflecting::Reflecting;
pub(crate) use reflecting::{Facets, Part, White};
pub use smooth::Smooth;
pub use student_t::{StudentT, StudentTRef};
pub use tabulated::Tabulated;
