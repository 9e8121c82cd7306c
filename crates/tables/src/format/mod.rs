//! The file format of tables and sets, which `docs/format.md` specifies.

mod certificate;
mod checksum;
mod container;
mod document;
mod haze;
mod index;
mod kind;
mod lobe;
mod material;
mod precision;
mod reflectance;
mod schema;
mod stack;
mod stored;
mod subject;
mod table;

use alloc::string::String;

pub use certificate::{Certificate, Coordinate, Errors, Quantity};
pub use checksum::{crc32, seal, seal_document};
pub use container::{decode, encode};
pub use document::{
    FORMAT, OLDEST_VERSION, Provenance, VERSION, describe, reassemble, stated_axes, stated_tables,
};
pub use haze::Haze;
pub use index::{Index, IndexedSet};
pub use kind::{Channels, Kind};
pub use lobe::{LobeForm, LobeSpec, Roughness, SAME};
pub use material::MaterialEntry;
pub use precision::Precision;
pub use reflectance::Reflectance;
pub use subject::{Side, Subject, joined_name};
pub use table::Table;

/// The error `why` unless `sound`.
fn ensure(sound: bool, why: impl FnOnce() -> String) -> Result<(), String> {
    if sound { Ok(()) } else { Err(why()) }
}
