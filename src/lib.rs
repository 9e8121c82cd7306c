//! Bakes, certifies and validates tables for Student-t microfacet materials; the library behind the
//! command `microfacet-bake`.
//!
//! Data flows one way. A [`scene`] or recipe says what its materials are, a [`plan`] what they need
//! tabulated, and [`table_set::bake`] makes the certified set: it takes nodes from [`table_spec`],
//! values from [`mod@bake`] and errors from [`validate`]. [`store`] writes the set, or a renderer
//! keeps it in memory and reads it with [`microfacet_sampler`].
//!
//! # Bake for a scene, and keep the set in memory
//!
//! ```
//! use microfacet_bake::plan::{Options, Plan};
//! use microfacet_bake::scene::Scene;
//! use microfacet_bake::table_set::{Target, bake};
//! use microfacet_bake::table_spec::Quality;
//! use microfacet_sampler::{MicrofacetDistribution, Precision};
//!
//! let recipe = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";
//! let scene = Scene::from_recipe_str(recipe)?; // or scene::load of a pbrt, Mitsuba, glTF… file
//! let plan = Plan::new(&scene, Options::default())?;
//! let baked = bake(&plan, Target::Quality(Quality::Draft, Precision::F32))?;
//! let glass = baked.set.material("glass")?;
//! assert!(glass.g1(glam::Vec3::new(0.6, 0.0, 0.8)) > 0.9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`table_set::Target`] is a quality, a largest error or a number of bytes.
//! A [`library`] of many materials is baked by several processes; a [`survey`] plans all scenes of
//! a folder.
//! [`table_set::bake_with`] adds a cache, a limit of memory and progress. [`store::write`] puts the
//! set into a folder in one step, and [`store::read`] reads it back.
//!
//! # Test a set
//!
//! Every table carries the errors measured when it was baked ([`certify::certificate`] and, for
//! albedos, [`certify::albedo`]).
//! [`validate::run`] draws normals and tests them by chi-square, [`validate::stress`] visits
//! corners, and [`validate::furnace`] is a white furnace.
//!
//! # Write a shape for other languages
//!
//! [`export`] writes one shape γ with its lookups as source text, or its albedos as textures.
//!
//! # Study the model
//!
//! [`distribution`] has the distributions by name, [`mod@convert`] replaces one by another, [`fit`]
//! fits them to measurements, [`plot`] draws them, and [`microfacet_model`] has every formula.

pub mod bake;
pub mod cache;
pub mod certify;
pub mod convert;
pub mod distribution;
pub mod export;
pub mod fit;
pub mod input;
pub mod interval;
pub mod library;
pub mod memory;
mod minimise;
pub mod plan;
pub mod plot;
pub mod progress;
mod quality;
pub mod report;
pub mod scene;
pub mod store;
pub mod survey;
pub mod table_set;
pub mod table_spec;
pub mod validate;
pub mod words;

/// The examples of the README, so that they keep compiling.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
