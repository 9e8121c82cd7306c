//! The file format: what a table holds and how, and the container of a set; `docs/format.md`
//! specifies it.

mod certificate;
mod checksum;
mod container;
mod document;
mod index;
mod kind;
mod lobe;
mod material;
mod precision;
mod schema;
mod stack;
mod stored;
mod subject;
mod table;

pub use certificate::{Certificate, Coordinate, Errors, Quantity};
pub use checksum::{crc32, seal, seal_document};
pub use container::{decode, encode};
pub use document::{FORMAT, Provenance, VERSION, describe, reassemble, stated_axes, stated_tables};
pub use index::{Index, IndexedSet};
pub use kind::{Channels, Kind};
pub use lobe::{LobeSpec, Roughness};
pub use material::{FresnelEntry, MaterialEntry};
pub use precision::Precision;
pub use subject::{Covered, LobeEntry, Reflectance, SAME, Side, Subject, joined_name};
pub use table::Table;
