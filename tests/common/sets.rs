//! Sets that are baked for tests, and estimates from their lobes as in a renderer.

#![allow(dead_code, reason = "each test binary needs a part of it")]

use glam::Vec3;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Target, bake};
use microfacet_baker::table_spec::Quality;
use microfacet_model::classic::Marginal;
use microfacet_sampler::{MicrofacetDistribution, Tables};
use microfacet_tables::{
    Interval, LobeSpec, MaterialEntry, Precision, Provenance, Roughness, Table, encode,
};

/// The target of drafts.
pub(crate) const DRAFT: Target = Target::Quality(Quality::Draft, Precision::F32);

/// A recipe of materials: name, σ, γ, and further lines.
pub(crate) fn recipe(materials: &[[&str; 4]]) -> String {
    let entry = |[name, sigma, gamma, more]: &[&str; 4]| {
        format!("[[material]]\nname = \"{name}\"\nsigma = {sigma}\ngamma = {gamma}\n{more}\n")
    };
    materials.iter().map(entry).collect()
}

pub(crate) fn plan(recipe: &str, options: Options) -> Plan {
    Plan::new(&Scene::from_recipe_str(recipe).expect(recipe), options).unwrap()
}

/// The set of a recipe, baked to a target, encoded and read back, as a renderer gets it.
pub(crate) fn baked(recipe: &str, target: Target) -> Tables {
    let set = bake(&plan(recipe, Options::default()), target).unwrap().set;
    Tables::from_bytes(&encode(set.provenance(), set.tables()).unwrap()).unwrap()
}

pub(crate) fn draft(recipe: &str) -> Tables {
    baked(recipe, DRAFT)
}

/// A material of a distribution outside the family.
pub(crate) fn outside(label: &str, marginal: &Marginal) -> MaterialEntry {
    let sigma = Roughness::Isotropic(Interval::point(marginal.sigma()));
    let family = LobeSpec::family(sigma, Interval::point(f64::INFINITY));
    let lobe = LobeSpec { distribution: Some(label.into()), ..family };
    MaterialEntry {
        name: "it".into(),
        lobe,
        haze: None,
        retroreflection: MaterialEntry::SPECULAR,
        masking: None,
        fresnel: None,
    }
}

/// A set of tables that names a material, or none.
pub(crate) fn set_of(tables: Vec<Table>, material: Option<MaterialEntry>) -> Tables {
    let provenance = Provenance { materials: Vec::from_iter(material), ..Provenance::default() };
    Tables::from_tables(provenance, tables).unwrap()
}

/// A direction at an azimuth, rounded as a renderer has it.
pub(crate) fn direction(cos: f64, phi: f64) -> Vec3 {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, cos as f32)
}

/// The mean of `worth` over a grid of visible normals, in single precision as in a renderer.
pub(crate) fn mean(
    lobe: &impl MicrofacetDistribution,
    v: Vec3,
    steps: usize,
    worth: impl Fn(Vec3) -> f64,
) -> f64 {
    let step = |i: usize| (i as f32 + 0.5) / steps as f32;
    let numbers = (0..steps).flat_map(|i| (0..steps).map(move |j| [step(i), step(j)]));
    let sum: f64 = numbers.map(|u| worth(lobe.sample_visible_normal(v, u).into())).sum();
    sum / (steps * steps) as f64
}

/// As [`mean`], over normals that reflect above the surface; `worth` takes normal and light.
pub(crate) fn mean_reflected(
    lobe: &impl MicrofacetDistribution,
    v: Vec3,
    steps: usize,
    worth: impl Fn(Vec3, Vec3) -> f64,
) -> f64 {
    mean(lobe, v, steps, |m| {
        let l = 2.0 * v.dot(m) * m - v;
        if l.z > 0.0 { worth(m, l) } else { 0.0 }
    })
}
