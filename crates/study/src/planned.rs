//! Seconds and bytes of bakes, as measured and as planned: bakes sets of one kind each on one
//! thread, as drafts and in default quality, without a cache.
//!
//! ```sh
//! cargo run --profile dist -p microfacet-study -- planned
//! cargo run --profile dist -p microfacet-study -- planned a-recipe.toml
//! ```

use std::path::Path;
use std::time::Instant;

use microfacet_baker::plan::{Cost, Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{BakeError, Target, bake, costs};
use microfacet_baker::table_spec::Quality;
use microfacet_tables::{Precision, encode};

use crate::Outcome;

/// Materials by name, each a set of its own: all kinds of tables, and the extremes of what their
/// times depend on.
const SETS: [(&str, &str); 15] = [
    ("a glass", "sigma = 0.454\ngamma = 3\nfresnel = \"mirror\""),
    ("a dielectric", "sigma = 0.3\ngamma = 2.5\nfresnel = { dielectric = 1.5 }"),
    ("the same, heavy", "sigma = 0.3\ngamma = 1.52\nfresnel = { dielectric = 1.5 }"),
    ("an anisotropic metal", "sigma = [0.3, 0.1]\ngamma = 2.5\nfresnel = { metal = \"gold\" }"),
    ("an anisotropic glass", "sigma = [0.3, 0.1]\ngamma = 2.5\nfresnel = { dielectric = 1.5 }"),
    ("rough one way", "sigma = [0.6, 0.15]\ngamma = 2.7\nfresnel = \"mirror\""),
    ("elongated, 30:1", "sigma = [0.6, 0.02]\ngamma = 3\nfresnel = \"mirror\""),
    ("brushed, heavy", "sigma = [0.3, 0.1]\ngamma = 1.6\nfresnel = \"mirror\""),
    (
        "a range",
        "sigma = { min = 0.1, max = 0.5 }\ngamma = { min = 2, max = 4 }\nfresnel = \"mirror\"",
    ),
    ("GTR", "distribution = \"gtr\"\nc = 0.2\ngamma = 1.5\nfresnel = \"mirror\""),
    ("Sawicki", "distribution = \"sawicki\"\nn = 12\nfresnel = \"mirror\""),
    ("Gauss", "distribution = \"gauss\"\nm = 0.2\nfresnel = \"mirror\""),
    (
        "tilted Beckmann",
        "sigma = [0.3, 0.1]\ntheta = [0.2, 0.1, 0]\ngamma = inf\nfresnel = \"mirror\"",
    ),
    (
        "tilted, heavy",
        "sigma = [0.3, 0.1]\ntheta = [0.2, 0.1, 0]\ngamma = 1.52\nfresnel = \"mirror\"",
    ),
    ("tilted", "sigma = [0.3, 0.2]\ntheta = [0.2, 0.1, 0]\ngamma = 3\nfresnel = \"mirror\""),
];

/// Fifty metals, each with a roughness and a shape of its own.
fn metals() -> String {
    let one = |i: usize| {
        let metal = ["gold", "silver", "copper", "aluminium", "iron"][i % 5];
        let (sigma, gamma) = (0.05 + 0.015 * i as f64, 1.7 + 0.1 * i as f64);
        format!(
            "[[material]]\nname = \"{i}\"\nsigma = {sigma:.3}\ngamma = {gamma:.1}\n\
             fresnel = {{ metal = \"{metal}\" }}\n"
        )
    };
    (0..50).map(one).collect()
}

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let planned = |scene: &Scene| Plan::new(scene, Options::default());
    let mut plans: Vec<(&str, Plan)> = Vec::new();
    for path in arguments {
        plans.push((path, planned(&microfacet_scene::load(Path::new(path))?)?));
    }
    if arguments.is_empty() {
        plans.push(("the default set", Plan::general()));
        plans.push(("50 metals", planned(&Scene::from_recipe_str(&metals())?)?));
        for (name, material) in SETS {
            let recipe = format!("[[material]]\nname = \"m\"\n{material}\n");
            plans.push((name, planned(&Scene::from_recipe_str(&recipe)?)?));
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "{:20} {:>8} {:>8} {:>8} {:>9} {:>9}",
        "", "", "seconds", "planned", "bytes", "planned"
    );
    pool.install(|| {
        for (name, plan) in &plans {
            for (words, quality) in [("draft", Quality::Draft), ("default", Quality::Default)] {
                let cost: Cost = costs(plan, quality, Precision::F32)?.into_iter().sum();
                let start = Instant::now();
                let set = bake(plan, Target::Quality(quality, Precision::F32))?.set;
                let seconds = start.elapsed().as_secs_f64();
                let bytes = encode(set.provenance(), set.tables())?.len();
                let Cost { bytes: planned_bytes, seconds: planned } = cost;
                println!(
                    "{name:20} {words:>8} {seconds:8.2} {planned:8.2} {bytes:9} {planned_bytes:9}"
                );
            }
        }
        Ok::<(), BakeError>(())
    })?;
    Ok(())
}
