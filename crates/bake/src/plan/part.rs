//! The lobes of a scene's materials, on each of which a plan decides by itself.

use std::borrow::Cow;

use super::{NotCovered, is_rough, not_covered};
use crate::scene::{Material, Scene};

/// A lobe of a material.
pub(super) struct Part<'a> {
    /// The index of the material in its scene.
    pub(super) material: usize,
    /// The material with this lobe alone.
    pub(super) of: Cow<'a, Material>,
    /// Whether it is the haze of the material.
    pub(super) is_haze: bool,
    /// Why no table covers some lobe of the material, so that it gets none at all.
    pub(super) uncovered: Option<NotCovered>,
}

impl Part<'_> {
    /// Whether a set lists the material: if it is in use, and each of its lobes is covered by
    /// tables or closed forms, or smooth.
    pub(super) fn is_listed(&self) -> bool {
        self.of.used && self.uncovered.is_none()
    }

    /// Whether this lobe needs tables or closed forms.
    pub(super) fn is_tabulated(&self) -> bool {
        self.is_listed() && is_rough(&self.of.lobe)
    }
}

/// The lobes of a scene, in the order of its materials; of each the core, then the haze.
pub(super) fn parts(scene: &Scene) -> Vec<Part<'_>> {
    let mut all = Vec::with_capacity(scene.materials.len());
    for (material, it) in scene.materials.iter().enumerate() {
        let mut rough = it.lobes().filter(|lobe| is_rough(lobe));
        let uncovered = rough.find_map(|lobe| not_covered(lobe, &it.name));
        all.extend(it.parts().enumerate().map(|(i, of)| Part {
            material,
            of,
            is_haze: i > 0,
            uncovered: uncovered.clone(),
        }));
    }
    all
}
