//! The accuracy of the estimate of the time left: bakes without a cache, reads the progress
//! meanwhile, and prints by how much each estimate was off once the bake has ended.
//!
//! ```sh
//! cargo run --profile dist -p microfacet-study -- progress default
//! cargo run --profile dist -p microfacet-study -- progress high
//! cargo run --profile dist -p microfacet-study -- progress 1e-3
//! cargo run --profile dist -p microfacet-study -- progress default a-recipe.toml
//! ```
//!
//! The first argument is a quality or a largest error, the second a recipe or scene; without one
//! the general set is baked.

use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use microfacet_baker::plan::{AlbedoWish, Options, Plan};
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_tables::Precision;

use crate::Outcome;

/// Runs the study that the module describes.
pub fn run(arguments: &[String]) -> Outcome {
    let [target, recipe @ ..] = arguments else {
        return Err("which quality or error? default, high, or a number".into());
    };
    let target = match target.as_str() {
        "draft" => Target::Quality(Quality::Draft, Precision::F32),
        "default" => Target::default(),
        "high" => Target::Quality(Quality::High, Precision::F32),
        error => Target::MaxError(error.parse()?),
    };
    let plan = match recipe.first() {
        Some(path) => {
            let options = Options { albedo: AlbedoWish::Auto, ..Options::default() };
            Plan::new(&microfacet_scene::load(Path::new(path))?, options)?
        }
        None => Plan::general(),
    };
    let settings = Settings { patient: true, ..Settings::default() };
    let meter = settings.progress.clone();
    let start = Instant::now();
    let (ended, end) = channel::<()>();
    let watcher = std::thread::spawn(move || {
        let mut seen = Vec::new();
        while end.recv_timeout(Duration::from_millis(20)) == Err(RecvTimeoutError::Timeout) {
            let now = start.elapsed();
            if let Some(left) = meter.left(now) {
                seen.push((now, meter.share(), left));
            }
        }
        seen
    });
    bake_with(&plan, target, settings)?;
    let total = start.elapsed();
    drop(ended);
    let seen = watcher.join().map_err(|_| "the watcher failed")?;
    println!("{:.1} s in all", total.as_secs_f64());
    println!("{:>8} {:>8} {:>10} {:>10} {:>6}", "after s", "done", "left s", "true s", "ratio");
    for tenth in 1..40 {
        let at = total.mul_f64(f64::from(tenth) / 40.0);
        let Some((now, share, left)) = seen.iter().find(|(now, ..)| *now >= at) else { continue };
        let truly = total.saturating_sub(*now).as_secs_f64();
        let left = left.as_secs_f64();
        println!(
            "{:8.2} {:>7.1}% {left:10.2} {truly:10.2} {:6.2}",
            now.as_secs_f64(),
            100.0 * share,
            left / truly
        );
    }
    Ok(())
}
