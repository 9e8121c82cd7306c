//! What bakes take next to what is planned: bakes sets of one kind each on one thread, without a
//! cache, and prints seconds and bytes as measured and as planned.
//!
//! ```sh
//! cargo run --profile dist -p microfacet-study -- planned
//! cargo run --profile dist -p microfacet-study -- planned a-recipe.toml
//! ```

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use microfacet_baker::plan::{Cost, Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{BakeError, Target, bake, costs};
use microfacet_baker::table_spec::Quality;
use microfacet_tables::{Precision, encode};

/// Sets by name: γ, σ and what else a recipe states of each material.
const SETS: [(&str, &str); 6] = [
    ("a glass", "sigma = 0.454\ngamma = 3\nfresnel = \"mirror\""),
    ("a dielectric", "sigma = 0.3\ngamma = 2.5\nfresnel = { dielectric = 1.5 }"),
    ("an anisotropic metal", "sigma = [0.3, 0.1]\ngamma = 2.5\nfresnel = { metal = \"gold\" }"),
    (
        "a range",
        "sigma = { min = 0.1, max = 0.5 }\ngamma = { min = 2, max = 4 }\nfresnel = \"mirror\"",
    ),
    ("a tilted lobe", "sigma = [0.3, 0.2]\ntheta = [0.2, 0.1, 0]\ngamma = 3\nfresnel = \"mirror\""),
    ("GTR", "distribution = \"gtr\"\nc = 0.2\ngamma = 1.5\nfresnel = \"mirror\""),
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

/// Prints what the module's page says.
pub fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
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
    println!("{:20} {:>8} {:>8} {:>9} {:>9}", "", "seconds", "planned", "bytes", "planned");
    pool.install(|| {
        for (name, plan) in &plans {
            let cost: Cost = costs(plan, Quality::Default, Precision::F32)?.into_iter().sum();
            let start = Instant::now();
            let set = bake(plan, Target::default())?.set;
            let (seconds, bytes) =
                (start.elapsed().as_secs_f64(), encode(set.provenance(), set.tables())?.len());
            println!("{name:20} {seconds:8.2} {:8.2} {bytes:9} {:9}", cost.seconds, cost.bytes);
        }
        Ok::<(), BakeError>(())
    })?;
    Ok(())
}
