//! Albedos and certificates of baked sets, against the model.

#[path = "../common/mod.rs"]
mod common;

mod albedo;
mod certificates;
mod furnace;
mod points;
mod view_albedo;
