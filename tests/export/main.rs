//! Exported files hold the values of the set.

#[path = "../common/mod.rs"]
mod common;

mod export;
mod export_lut;
mod layouts;
mod shaders;

use std::path::Path;

/// The size of an image, and its channels by name.
fn image(path: &Path) -> ([usize; 2], Vec<(String, Vec<f32>)>) {
    let layer = exr::prelude::read_first_flat_layer_from_file(path).unwrap().layer_data;
    let channels = layer.channel_data.list.iter();
    let channels = channels
        .map(|stored| (stored.name.to_string(), stored.sample_data.values_as_f32().collect()));
    ([layer.size.x(), layer.size.y()], channels.collect())
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Pairs of numbers as the channels of an image: a blue of 0, and both.
fn colours(numbers: &[f32]) -> Vec<(String, Vec<f32>)> {
    let plane = |channel: usize| numbers.iter().skip(channel).step_by(2).copied().collect();
    let planes = [("B", vec![0.0; numbers.len() / 2]), ("G", plane(1)), ("R", plane(0))];
    planes.map(|(name, plane)| (name.into(), plane)).into()
}
