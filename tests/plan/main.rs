//! Plans, budgets, and what validation and error maps find in a set.

#[path = "../common/mod.rs"]
mod common;

mod budgets;
mod cached;
mod error_maps;
mod haze;
mod max_bytes;
mod plan;
mod ranges;
mod validate;
