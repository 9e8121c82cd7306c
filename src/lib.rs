//! Bakes, certifies and validates tables for Student-t microfacet materials.
//!
//! Data flows one way. A [`scene`] or recipe says what its materials are, a [`plan`] what they
//! need, and [`table_set::bake`] makes the certified set: it asks [`table_spec`] for nodes, [`mod@bake`]
//! for values and [`validate`] for their errors. [`store`] writes the set, or a renderer keeps it
//! in memory and reads it with `microfacet-sampler`.

pub mod bake;
pub mod cache;
pub mod convert;
pub mod distribution;
pub mod fit;
pub mod memory;
pub mod plan;
pub mod plot;
mod quality;
pub mod scene;
pub mod store;
pub mod table_set;
pub mod table_spec;
pub mod validate;
