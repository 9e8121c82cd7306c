//! Tests of complete BSDFs, as a renderer calls them.
//!
//! [`chi_square`] compares the directions drawn with the density, cell by cell of a `grid` that is
//! made for each [`configuration`] of BSDF and view. [`furnace`] tests whether white surfaces
//! return all light, and [`reciprocity`] whether f/n² stays the same when view and light are
//! exchanged. A [`specimen`] is a BSDF as data, and bakes the albedos that it needs.

pub mod chi_square;
pub mod configuration;
pub mod furnace;
mod grid;
pub mod reciprocity;
pub mod specimen;
