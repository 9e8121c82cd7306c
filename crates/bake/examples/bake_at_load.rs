//! A renderer that bakes when it loads a scene, without a file of tables.
//!
//! `cargo run --release -p microfacet-baker --example bake_at_load` bakes what the embedded set
//! lacks, albedos of brushed gold and of frosted glass, joins them with the embedded set, and
//! samples the BSDFs.

use std::time::Instant;

use microfacet_baker::cache::Cache;
use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_sampler::{Bsdf, Compensation, StandIn, Tables, Transport};

/// The renderer's materials, written as a recipe; `microfacet_scene::load` reads scene files
/// as well.
const MATERIALS: &str = r#"
[[material]]
name = "brushed gold"
sigma = [0.1, 0.4]
gamma = 2.5
fresnel = { metal = "gold" }

[[material]]
name = "frosted glass"
sigma = 0.454
gamma = 3.0
fresnel = { dielectric = 1.5 }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = Instant::now();
    let scene = Scene::from_recipe_str(MATERIALS)?;
    // The embedded tables of the sampler crate serve every sigma and gamma; only what they lack is
    // baked.
    let options = Options { embedded: true, embedded_albedo: true, ..Options::default() };
    let plan = Plan::new(&scene, options)?;
    // Kept in the user's cache folder, so the next run finds it there.
    let settings = Settings { cache: Cache::user(), ..Settings::default() };
    let baked = bake_with(&plan, Target::MaxError(1e-3), settings)?;
    println!(
        "{} tables, {} of them baked now, in {:.3} s",
        baked.set.tables().len(),
        baked.baked,
        start.elapsed().as_secs_f64()
    );

    let tables = baked.set.with_fallback(&Tables::embedded());
    let v = [0.6, 0.0, 0.8];
    for name in ["brushed gold", "frosted glass"] {
        let bsdf = tables.bsdf(name, Compensation::KullaConty, StandIn::Refused)?;
        let sample = bsdf.sample(v, 0.5, [0.3, 0.7], Transport::Radiance);
        println!("{name}: {sample:?}");
        let (f, pdf) = bsdf.eval_pdf(v, [0.0, 0.0, 1.0], Transport::Radiance);
        println!("towards the normal f = {f:?}, density {pdf}");
    }
    Ok(())
}
