//! Bakes, certifies and validates tables for Student-t microfacet materials.
//!
//! Data flows one way: a scene or recipe says what is needed, [`spec`] what is to be baked, [`bake`] fills
//! the tables, [`store`] writes them, and `microfacet-sampler` reads them at run time. [`validate`] stands beside it and compares what the sampler draws
//! with what `microfacet-model` says.

pub mod bake;
pub mod cache;
pub mod convert;
pub mod family;
pub mod fit;
pub mod generate;
pub mod memory;
pub mod plan;
pub mod plot;
pub mod scene;
pub mod spec;
pub mod store;
pub mod validate;
