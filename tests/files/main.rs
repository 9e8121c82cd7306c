//! Files: what is read is whole or refused, and the default set is what a bake gives.

#[path = "../common/mod.rs"]
mod common;

mod corpus;
mod default_set;
mod files;
mod hostile_files;
