//! A library of any number of materials, baked by any number of processes.
//!
//! [`Library`] divides a scene into sets of at most [`PER_SET`] materials and plans each by itself.
//! One process bakes one [`Shard`] of their needs into a cache that all processes share;
//! [`Receipt`]s in the cache state which shards are done, and of which needs.

mod receipt;
mod shard;

use std::collections::HashSet;

pub use receipt::{Receipt, Receipts};
pub use shard::{NotAShard, Shard};

use crate::plan::{NotCovered, Options, Plan};
use crate::scene::Scene;
use crate::table_set::{BakeError, Need, Settings, Target};

/// Most materials of one set. Each adds up to 4 kB to a set's header, and safetensors has none
/// above 100 MB.
pub const PER_SET: usize = 10_000;

/// The materials of one set and their plan.
#[derive(Clone, Debug)]
pub struct Part {
    /// The materials.
    pub scene: Scene,
    /// The tables that they need.
    pub plan: Plan,
}

/// A scene divided into sets.
#[derive(Clone, Debug)]
pub struct Library {
    /// The sets in order, at least one.
    pub parts: Vec<Part>,
}

impl Library {
    /// Divides a scene into sets of at most `per_set` materials in use, and plans them.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn new(scene: Scene, per_set: usize, options: Options) -> Result<Self, NotCovered> {
        let planned = |scene: Scene| Ok(Part { plan: Plan::new(&scene, options)?, scene });
        let parts = divided(scene, per_set).into_iter().map(planned);
        Ok(Self { parts: parts.collect::<Result<_, _>>()? })
    }

    /// The scene and the plan of each set.
    pub fn plans(&self) -> impl Iterator<Item = (&Scene, &Plan)> + Clone {
        self.parts.iter().map(|part| (&part.scene, &part.plan))
    }

    /// The needs of all sets, each once, with its [`Need::id`].
    ///
    /// # Errors
    /// As [`Need::of`].
    pub fn needs(&self, target: Target) -> Result<Vec<(String, Need)>, BakeError> {
        distinct(self.parts.iter().map(|part| Need::of(&part.plan, target)))
    }

    /// The needs that [`AlbedoWish::All`](crate::plan::AlbedoWish::All) would add where
    /// [`AlbedoWish::Auto`](crate::plan::AlbedoWish::Auto) leaves out albedos that take long.
    ///
    /// # Errors
    /// As [`Need::of`].
    pub fn offered(&self, target: Target) -> Result<Vec<(String, Need)>, BakeError> {
        let offered = |Part { plan, .. }: &Part| {
            let (albedos, materials) = (plan.offered.clone(), plan.materials.clone());
            Need::of(&Plan { albedos, materials, ..Plan::default() }, target)
        };
        distinct(self.parts.iter().map(offered))
    }

    /// Bakes needs into the cache of the settings, one after the other, and calls `after` with the
    /// number that is done. Returns the number of needs that the cache lacked.
    ///
    /// # Errors
    /// As [`Need::bake`]; what was baked before stays in the cache.
    pub fn bake(
        needs: &[(String, Need)],
        settings: &Settings,
        mut after: impl FnMut(usize),
    ) -> Result<usize, BakeError> {
        needs.iter().for_each(|(_, need)| need.announce(&settings.progress));
        let mut baked = 0;
        for (i, (_, need)) in needs.iter().enumerate() {
            baked += usize::from(need.bake(settings.clone())?);
            after(i + 1);
        }
        Ok(baked)
    }
}

fn distinct(
    sets: impl Iterator<Item = Result<Vec<Need>, BakeError>>,
) -> Result<Vec<(String, Need)>, BakeError> {
    let (mut known, mut needs) = (HashSet::new(), Vec::new());
    for set in sets {
        for need in set? {
            let id = need.id();
            if known.insert(id.clone()) {
                needs.push((id, need));
            }
        }
    }
    Ok(needs)
}

/// Scenes of at most `per_set` materials in use; all but the materials stays with the first scene.
fn divided(mut scene: Scene, per_set: usize) -> Vec<Scene> {
    let materials = std::mem::take(&mut scene.materials);
    let mut parts = vec![scene];
    let mut used = 0;
    for material in materials {
        if material.used {
            if used == per_set.max(1) {
                parts.push(Scene::default());
                used = 0;
            }
            used += 1;
        }
        if let Some(part) = parts.last_mut() {
            part.materials.push(material);
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table_spec::Quality;
    use microfacet_tables::Precision;

    fn scene(count: usize) -> Scene {
        let one = |i: usize| {
            format!(
                "[[material]]\nname = \"m{i}\"\nsigma = [0.{}, 0.4]\ngamma = 3.0\nfresnel = \"mirror\"\n",
                1 + i % 3
            )
        };
        Scene::from_recipe_str(&(0..count).map(one).collect::<String>()).unwrap()
    }

    fn library(scene: Scene, per_set: usize) -> Library {
        Library::new(scene, per_set, Options::default()).unwrap()
    }

    #[test]
    fn sets_hold_at_most_so_many_materials_in_use() {
        let sizes = |scene: Scene, per_set| -> Vec<usize> {
            library(scene, per_set).parts.iter().map(|part| part.plan.materials.len()).collect()
        };
        assert_eq!(sizes(scene(7), 7), [7]);
        assert_eq!(sizes(scene(7), 6), [6, 1]);
        assert_eq!(sizes(scene(7), 3), [3, 3, 1]);
        assert_eq!(sizes(scene(1), 0), [1]);
        let mut some = scene(7);
        for i in [0, 3, 6] {
            some.materials[i].used = false;
        }
        assert_eq!(sizes(some, 4), [4]);
        assert_eq!(sizes(Scene::default(), 4), [0]);
    }

    #[test]
    fn what_several_sets_need_is_needed_once() {
        let target = Target::Quality(Quality::Draft, Precision::F32);
        let one = library(scene(6), 6).needs(target).unwrap();
        let three = library(scene(6), 2).needs(target).unwrap();
        // One shape and three lobes.
        assert_eq!((one.len(), three.len()), (4, 4));
        assert!(three.iter().all(|need| one.contains(need)));
    }
}
