//! Bakes certified tables of microfacet materials: for a scene, for a library of materials, or in a
//! renderer at load.
//!
//! Data flows one way. A [`scene`] or recipe lists materials, a [`plan`] the tables that they need,
//! and [`table_set::bake`] makes the certified set, with nodes from [`table_spec`], values from
//! [`mod@bake`] and errors from [`certify`]. [`store`] writes the set, or a renderer keeps it in
//! memory and reads it with [`microfacet_sampler`].
//!
//! # Bake at load
//!
//! ```
//! use microfacet_baker::plan::{Options, Plan};
//! use microfacet_baker::scene::Scene;
//! use microfacet_baker::table_set::{Target, bake};
//! use microfacet_baker::table_spec::Quality;
//! use microfacet_sampler::MicrofacetDistribution;
//! use microfacet_tables::Precision;
//!
//! let recipe = "[[material]]\nname = \"glass\"\nsigma = 0.454\ngamma = 3.0\n";
//! let scene = Scene::from_recipe_str(recipe)?; // microfacet-scene reads pbrt, Mitsuba, glTF…
//! let plan = Plan::new(&scene, Options::default())?;
//! let baked = bake(&plan, Target::Quality(Quality::Draft, Precision::F32))?;
//! let glass = baked.set.material("glass")?;
//! assert!(glass.g1(glam::Vec3::new(0.6, 0.0, 0.8)) > 0.9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | |
//! | --- | --- |
//! | [`scene`], [`distribution`] | materials, recipes, and distributions by name |
//! | [`plan`] | the tables that materials need, their cost, and what is skipped |
//! | [`table_spec`], [`mod@bake`] | the nodes of a table, and their values |
//! | [`certify`] | the errors of a table between its nodes, which its file states |
//! | [`table_set`] | from a plan and a [`Target`](table_set::Target) to a certified set |
//! | [`library`] | many materials in sets, baked by several processes |
//! | [`store`], [`cache`], [`memory`] | files of sets, tables kept from earlier bakes, the memory limit |
//! | [`input`], [`progress`] | reading of files to a limit, and the progress of long work |

pub mod bake;
pub mod cache;
pub mod certify;
pub mod distribution;
pub mod escape;
pub mod input;
pub mod library;
pub mod memory;
pub mod plan;
pub mod progress;
mod quality;
pub mod scene;
pub mod store;
pub mod table_set;
pub mod table_spec;
