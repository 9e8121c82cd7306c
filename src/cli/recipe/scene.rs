//! The materials of a scene as a recipe, to change and bake.

use std::collections::BTreeSet;
use std::path::Path;

use microfacet_baker::distribution::Distribution;
use microfacet_baker::plan::{AlbedoVerdict, AlbedoWish, NotCovered, Options, Plan, Verdict};
use microfacet_baker::scene::{Format, Ignored, Material, Scene};

use crate::cli::plan::warn;
use crate::cli::words::{count, wrapped};
use crate::cli::{Result, ensure, escape};

/// The recipe of a scene: the materials that its [`plan`] lists, after comments on all others.
///
/// [`plan`]: Plan
pub(super) fn recipe(path: &Path) -> Result<String> {
    let scene = microfacet_scene::load(path)?;
    let plan = plan(&scene)?;
    let written = written(path, &scene, &plan);
    warn(std::iter::once((&scene, &plan)));
    written
}

/// The plan with the albedos that the recipe will ask for, or if those are too many, without any.
fn plan(scene: &Scene) -> Result<Plan, NotCovered> {
    let of = |albedo| Plan::new(scene, Options { albedo, ..Options::default() });
    let imported = |material: &Material| material.origin.format != Format::Recipe;
    if scene.materials.iter().any(imported)
        && let Ok(plan) = of(AlbedoWish::All)
    {
        return Ok(plan);
    }
    of(AlbedoWish::Auto)
}

fn written(path: &Path, scene: &Scene, plan: &Plan) -> Result<String> {
    let (mut kept, mut comments) = (Scene::default(), String::new());
    let mut comment = |what: &str, name: &str, why: &str| {
        let text = format!("{what} {name}: {why}");
        comments += &wrapped("# ", &escape::line(&text), 2).replace("\n  ", "\n# ");
    };
    let quoted = |name: &str| format!("\"{name}\"");
    let (mut lost, mut without) = (BTreeSet::new(), BTreeSet::new());
    for judged in plan.judged(scene) {
        let name = &judged.material.name[..];
        if let Verdict::NotCovered(why) = judged.verdict
            && lost.insert(name)
        {
            comment("left out", &quoted(name), &why.reason());
        }
        if let AlbedoVerdict::NotCovered(why) = judged.albedo
            && judged.material.fresnel.is_some()
            && without.insert(name)
        {
            comment("without the `fresnel` of", &quoted(name), &why.reason());
        }
    }
    for material in &scene.materials {
        let name = &material.name[..];
        if !material.used {
            comment("left out", &quoted(name), "no geometry uses it");
        } else if !lost.contains(name) {
            let mut material = material.clone();
            material.fresnel = material.fresnel.filter(|_| !without.contains(name));
            kept.materials.push(material);
        }
    }
    for Ignored { name, kind, reason, understood, .. } in &scene.ignored {
        let what = if *understood { "nothing to bake for" } else { "not understood:" };
        comment(what, &format!("\"{name}\" ({kind})"), reason);
    }
    let others = scene.materials.len() - kept.materials.len() + scene.ignored.len();
    ensure!(
        !kept.materials.is_empty(),
        "{}: no material that a recipe can have among {}; `plan` says why",
        path.display(),
        count(others, "material")
    );
    if !comments.is_empty() {
        comments.insert_str(0, "#\n");
    }
    Ok(format!("{}{comments}\n{}", head(path, &kept), kept.to_recipe()))
}

/// The first lines: where the recipe is from, and what may be changed.
fn head(path: &Path, kept: &Scene) -> String {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let format = Format::of(path).map_or(String::new(), |format| format!(" ({format})"));
    let version = env!("CARGO_PKG_VERSION");
    let file = escape::line(&file);
    let mut text = format!(
        "# The materials of {file}{format}, by microfacet-bake {version}.\n\
         # gamma = 2 is GGX and \"inf\" is Beckmann; any other from 1.501 on may take its place.\n"
    );
    if kept.materials.iter().any(|material| material.fresnel.is_some()) {
        text += "# Each `fresnel` asks for albedos, which take most of the time of a bake; `bake\n\
                 # --no-albedo` bakes none.\n";
    }
    let measured = kept.materials.iter().flat_map(Material::lobes);
    if measured
        .filter_map(|lobe| lobe.distribution.as_ref())
        .any(|it| matches!(it, Distribution::Measured { .. }))
    {
        text += "# Names of measured files are relative to the folder of this one.\n";
    }
    text
}
