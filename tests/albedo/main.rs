//! Albedos and certificates of baked sets, against the model.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/sets.rs"]
mod sets;

mod albedo;
mod certificates;
mod furnace;
mod points;
mod view_albedo;
