//! Bakes, certifies and validates tables for Student-t microfacet materials: the names of a bake,
//! from a scene or recipe to a tested set.
//!
//! The command `microfacet-bake` does the same, and more. A renderer that bakes at load links
//! `microfacet-baker` alone; the documentation of each crate says what else it has:
//! [`microfacet_baker`] (recipes, plans, tables, certificates, files), [`microfacet_scene`]
//! (importers), [`microfacet_validate`], [`microfacet_export`], [`microfacet_fit`] and
//! [`microfacet_report`].
//!
//! ```
//! use microfacet_bake::{Options, Plan, Precision, Quality, Scene, Target, bake};
//! use microfacet_sampler::MicrofacetDistribution;
//!
//! let recipe = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";
//! let scene = Scene::from_recipe_str(recipe)?; // or load() a pbrt, Mitsuba, glTF… file
//! let plan = Plan::new(&scene, Options::default())?;
//! let baked = bake(&plan, Target::Quality(Quality::Draft, Precision::F32))?;
//! let glass = baked.set.material("glass")?;
//! assert!(glass.g1(glam::Vec3::new(0.6, 0.0, 0.8)) > 0.9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Target`] is a quality, a largest error or a number of bytes; [`bake_with`] adds a cache, a
//! limit of memory and progress. [`write()`] puts the set into a folder in one step, [`read`] reads
//! it back, and [`validate`] tests it.

pub use microfacet_baker::plan::{NotCovered, Options, Plan};
pub use microfacet_baker::scene::{Material, Scene, SceneError};
pub use microfacet_baker::store::{Format, StoreError, read, write};
pub use microfacet_baker::table_set::{BakeError, Baked, Settings, Target, bake, bake_with};
pub use microfacet_baker::table_spec::Quality;
pub use microfacet_sampler::Tables;
pub use microfacet_scene::load;
pub use microfacet_tables::Precision;
pub use microfacet_validate as validate;

/// The examples of the README and the program of the first renderer, so that they keep working.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/first-renderer.md")]
struct Readme;
