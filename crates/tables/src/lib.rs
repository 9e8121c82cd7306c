//! Tables of microfacet materials: their coordinates, their values with the errors measured at
//! baking, interpolation along their axes, and the file of a set of tables.
//!
//! | | |
//! | --- | --- |
//! | [`Table`] | values over [`Axis`]es, with their quantity ([`Kind`], [`Subject`]) and errors |
//! | [`axis`] | one file for each coordinate: formula, inverse, nodes, and fast evaluation in f32 |
//! | [`encode`], [`decode`] | a set to and from the bytes of a safetensors file; `docs/format.md` specifies it |
//! | [`describe`], [`reassemble`] | the description of one table, for another container |
//! | [`Provenance`], [`MaterialEntry`] | the origin of a set, and its materials |
//! | [`LobeSpec`], [`Haze`] | a lobe, and a second one with its weight, as recipes, plans and files state them |
//! | [`Index`] | which of the numbered sets of a library holds a material |
//!
//! `microfacet-baker`, which bakes sets, and `microfacet-sampler`, which looks them up, share this
//! crate, so that both use the same formula for a coordinate. A renderer needs it only to write
//! sets, or to read one table by itself:
//!
//! ```
//! # fn main() -> Result<(), microfacet_tables::LoadError> {
//! use microfacet_tables::{Kind, Precision, Provenance, Quantity, Table, decode, encode};
//! # let file = include_bytes!("../../sampler/data/default.safetensors");
//! let (provenance, tables) = decode(file, true)?;
//! let g1 = tables.iter().find(|table| table.kind == Kind::Shadowing).unwrap();
//! assert!(g1.certificate.error(Quantity::G1).unwrap() < 1e-5);
//!
//! let again = encode(&provenance, &tables)?;
//! assert_eq!(again, file);
//! # Ok(())
//! # }
//! ```
//!
//! `no_std` with `alloc` without the feature `std`, which brings hardware square roots.

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

pub mod axis;

mod error;
mod format;
mod interval;

pub use axis::{Axis, Interpolation, Mapping, Weights};
pub use error::{LoadError, Range};
pub use format::{
    Certificate, Channels, Coordinate, Errors, FORMAT, Haze, Index, IndexedSet, Kind, LobeForm,
    LobeSpec, MaterialEntry, OLDEST_VERSION, Precision, Provenance, Quantity, Reflectance,
    Roughness, SAME, Side, Subject, Table, VERSION, crc32, decode, describe, encode, joined_name,
    reassemble, seal, seal_document, stated_axes, stated_tables,
};
pub use interval::Interval;

/// The smallest γ of tables. The distribution exists for γ > 3/2, but below this γ almost every
/// visible normal has a slope too large for a floating-point number.
pub const GAMMA_MIN: f64 = 1.501;

/// The largest σ of albedo tables of the family.
pub const SIGMA_MAX: f64 = 3.0;
