//! Tables of several sizes and precisions, for one shape.

use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::Tables;
use microfacet_tables::Precision;

use crate::settings::{GAMMA, SIGMA};

/// Slices at [`GAMMA`], and the compiled-in set for all shapes.
pub(crate) struct Slices {
    pub(crate) draft: Tables,
    pub(crate) default: Tables,
    pub(crate) high: Tables,
    pub(crate) f16: Tables,
    pub(crate) u16: Tables,
    pub(crate) whole: Tables,
}

impl Slices {
    /// Bakes them; a fraction of a second.
    pub(crate) fn bake() -> Self {
        let f32 = Precision::F32;
        Self {
            draft: slice(Quality::Draft, f32, GAMMA),
            default: slice(Quality::Default, f32, GAMMA),
            high: slice(Quality::High, f32, GAMMA),
            f16: slice(Quality::Default, Precision::F16, GAMMA),
            u16: slice(Quality::Default, Precision::U16, GAMMA),
            whole: Tables::embedded(),
        }
    }

    /// The compiled-in set.
    pub(crate) fn whole(&self) -> &Tables {
        &self.whole
    }

    /// Each with its name.
    pub(crate) fn each(&self) -> impl Iterator<Item = (&'static str, &Tables)> {
        [
            (name(Quality::Draft), &self.draft),
            (name(Quality::Default), &self.default),
            (name(Quality::High), &self.high),
            ("table, default, f16", &self.f16),
            ("table, default, u16", &self.u16),
            ("table, default, of all gamma", &self.whole),
        ]
        .into_iter()
    }
}

/// The set of one material, as any scene with that material gets it.
fn slice(quality: Quality, precision: Precision, gamma: f64) -> Tables {
    let recipe = format!("[[material]]\nname = \"it\"\nsigma = {SIGMA}\ngamma = {gamma}\n");
    let scene = Scene::from_recipe_str(&recipe).expect("a sound recipe");
    let plan = Plan::new(&scene, Options::default()).expect("gamma is covered");
    bake(&plan, Target::Quality(quality, precision)).expect("a quality is always met").set
}

/// The name of the row that the figures use.
pub(crate) const TABLE: &str = "table, default";

/// Names of the qualities.
fn name(quality: Quality) -> &'static str {
    match quality {
        Quality::Draft => "table, draft",
        Quality::Default => TABLE,
        Quality::High => "table, high",
    }
}
