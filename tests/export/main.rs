//! What is exported holds what the set does.

#[path = "../common/mod.rs"]
mod common;

mod export;
mod export_lut;
