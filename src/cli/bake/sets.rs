//! A library too large for one set: numbered sets and their index.

use std::time::Instant;

use serde_json::json;

use microfacet_baker::cache::Cache;
use microfacet_baker::library::{Library, Part};
use microfacet_baker::store::{Format, OutputFolder};
use microfacet_baker::table_set::bake_with;

use super::{Args, files, warn_of_cache};
use crate::cli::words::{count, exact_bytes, seconds, shell};
use crate::cli::{Result, ensure, escape, print_json, progress, summarize};

pub(super) fn run(
    args: &Args,
    library: &Library,
    out: OutputFolder,
    cache: Cache,
    start: Instant,
) -> Result<()> {
    let sets = library.parts.len();
    ensure!(
        args.format == Format::Safetensors,
        "--format exr: the materials fill {sets} numbered sets, and an image is of one; leave the \
         option out"
    );
    ensure!(
        args.max_bytes.is_none(),
        "--max-bytes is for one set, and the materials fill {sets}; choose --max-error or \
         --quality instead"
    );
    library.parts.iter().try_for_each(|part| args.check_bytes(&part.plan))?;
    let settings = args.settings(cache);
    let bar = progress::show(&settings.progress, "baking");
    let mut writer = out.sets();
    let (mut materials, mut tables, mut baked) = (0, 0, 0);
    for Part { plan, .. } in &library.parts {
        let result = bake_with(plan, args.target(), settings.clone())?;
        warn_of_cache(&result);
        materials += plan.materials.len();
        tables += result.set.tables().len();
        baked += result.baked;
        writer.add(result.set)?;
    }
    let written = writer.finish()?;
    drop(bar);
    let time = start.elapsed().as_secs_f64();
    if args.json {
        return print_json(&json!({
            "sets": sets, "materials": materials, "tables": tables, "baked": baked,
            "files": files(&written), "seconds": time,
        }));
    }
    let bytes = written.iter().map(|file| file.bytes).sum();
    let first = written.first().map_or(String::new(), |file| shell(&file.path));
    let last = written.last().map_or(String::new(), |file| file.path.display().to_string());
    summarize(&format!(
        "{} in {}: {}, {baked} baked, {} from the cache, in {}\nwrote {}, {}\nindex {}\nnext:\n  \
         microfacet-bake inspect {first}\n  microfacet-bake report {first}\n",
        count(materials, "material"),
        count(sets, "numbered set"),
        count(tables, "table"),
        tables - baked,
        seconds(time),
        count(written.len(), "file"),
        exact_bytes(bytes),
        escape::line(&last),
    ))
}
