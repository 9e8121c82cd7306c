//! From what a scene asks for to what is to be baked: pure, and as little as possible.

use microfacet_sampler::{Interpolation, MaterialEntry, Precision};

use crate::scene::{Interval, Material, Roughness, Scene};
use crate::spec::{GAMMA_MIN, GAMMA_WHOLE, Quality, ShapeAxis, TableSpec, general_set};

/// s = 1/(γ−1) of a shape.
fn s_of(gamma: f64) -> f64 {
    1.0 / (gamma - 1.0)
}

/// The materials in use that have a microfacet lobe.
fn rough(scene: &Scene) -> impl Iterator<Item = &Material> {
    let is_rough = |roughness: Roughness| roughness.x().max > 0.0 && roughness.y().max > 0.0;
    scene.materials.iter().filter(move |material| material.used && is_rough(material.roughness))
}

/// A shape that tables cannot cover: γ below [`GAMMA_MIN`].
#[derive(Clone, Debug, PartialEq)]
pub struct TooHeavy {
    /// Name of the material.
    pub material: String,
    /// Its γ.
    pub gamma: f64,
}

impl std::fmt::Display for TooHeavy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { material, gamma } = self;
        write!(
            f,
            "material \"{material}\": gamma = {gamma} is below {GAMMA_MIN}, the smallest shape that tables cover; raise it, or \
             sample it with the model's exact sampler"
        )
    }
}

impl std::error::Error for TooHeavy {}

/// The specifications of the tables that the scene's materials need: single shapes as single nodes, ranges as sub-ranges of the
/// general set with its spacing.
///
/// # Errors
/// [`TooHeavy`] for a γ that no table covers.
pub fn specs(scene: &Scene, quality: Quality, precision: Precision) -> Result<Vec<TableSpec>, TooHeavy> {
    let mut points = Vec::new();
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    for material in rough(scene) {
        let Interval { min, max } = material.gamma;
        if min < GAMMA_MIN {
            return Err(TooHeavy { material: material.name.clone(), gamma: min });
        }
        if min == max {
            points.push(s_of(min));
        } else {
            ranges.push([s_of(max), s_of(min)]);
        }
    }
    points.retain(|s| !ranges.iter().any(|[low, high]| (low..=high).contains(&s)));
    let general = general_set(quality, precision);
    let mut specs = Vec::new();
    for spec in &general {
        let [low, high] = [spec.shapes.nodes[0], spec.shapes.nodes[spec.shapes.nodes.len() - 1]];
        // The shapes that belong to this table: at the seam γ = 1.8 the whole distribution is preferred.
        let heavy = low >= s_of(GAMMA_WHOLE);
        let here = |s: f64| if heavy { s > low && s <= high } else { (low..=high).contains(&s) };
        let list = ShapeAxis::points(points.iter().copied().filter(|&s| here(s)));
        if !list.nodes.is_empty() {
            specs.push(TableSpec { shapes: list, name: format!("{}_nodes", spec.name), ..spec.clone() });
        }
        // One sub-range a table, spanning all that is asked of it.
        let wanted = ranges.iter().filter(|range| range[1] > low && range[0] < high);
        let hull = wanted.fold(None, |hull: Option<[f64; 2]>, range| {
            let [a, b] = hull.unwrap_or(*range);
            Some([a.min(range[0]), b.max(range[1])])
        });
        if let Some([from, to]) = hull {
            let (from, to) = (from.max(low), to.min(high));
            specs.push(TableSpec { shapes: sub_range(&spec.shapes.nodes, from, to), ..spec.clone() });
        }
    }
    Ok(specs)
}

/// The nodes of a range that cover [from, to], with its ends and enough neighbours for the interpolation.
fn sub_range(nodes: &[f64], from: f64, to: f64) -> ShapeAxis {
    let first = nodes.partition_point(|&s| s <= from).saturating_sub(2);
    let last = (nodes.partition_point(|&s| s < to) + 2).min(nodes.len());
    ShapeAxis { nodes: nodes[first..last].to_vec(), interpolation: Interpolation::Lagrange4 }
}

/// The named materials of a scene as a set records them.
pub fn entries(scene: &Scene) -> Vec<MaterialEntry> {
    let pair = |interval: Interval| [interval.min, interval.max];
    let entry = |material: &Material| {
        let Interval { min, max } = material.gamma;
        MaterialEntry {
            name: material.name.clone(),
            sigma: [pair(material.roughness.x()), pair(material.roughness.y())],
            s: [s_of(max), s_of(min)],
            distribution: String::new(),
        }
    };
    rough(scene).map(entry).collect()
}
