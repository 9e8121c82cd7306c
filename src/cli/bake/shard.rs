//! `bake --shard`: one of many processes that bake a library together.

use std::path::Path;
use std::time::Instant;

use serde_json::json;

use microfacet_bake::cache::Cache;
use microfacet_bake::library::{Library, Receipt, Receipts, Shard};
use microfacet_bake::store::check_folder;
use microfacet_bake::table_set::Target;

use super::Args;
use crate::cli::plan::nothing;
use crate::cli::words::{count, seconds, shell};
use crate::cli::{Done, Failure, Outcome, interrupt, print_json, progress, report, summarize};

pub(super) fn run(args: &Args, shard: Shard, scene: &Path, folder: &Path) -> Outcome {
    let start = Instant::now();
    // Fail now rather than after an hour of baking.
    check_folder(folder).map_err(|why| Failure(format!("{}: {why}", folder.display())))?;
    let cache = Cache::new(folder.to_path_buf());
    let kept = folder.display().to_string();
    interrupt::leaves(move || {
        format!("finished tables are in {kept}, and the same command goes on from there")
    });
    let library = args.library(scene)?;
    for part in &library.parts {
        args.check_bytes(&part.plan)?;
    }
    let needs = library.needs(args.target())?;
    let receipt = Receipt::new(scene, shard, &needs);
    // Whoever reads the messages of the first shard should hear of it, not of those under way.
    for doubt in Receipts::read(folder, scene).strangers(&receipt) {
        report("warning", format!("{}: {doubt}", folder.display()));
    }
    let all = needs.len();
    let mine = shard.take(needs);
    let settings = args.settings(cache);
    let bar = progress::show(&settings.progress, "baking");
    let baked = Library::bake(&mine, &settings)?;
    drop(bar);
    receipt.leave(folder).map_err(|why| Failure(format!("{}: {why}", folder.display())))?;
    let (time, count_of) = (start.elapsed().as_secs_f64(), mine.len());
    if args.json {
        print_json(&json!({
            "shard": shard.number, "of": shard.of, "needs": count_of, "needs_of_all": all,
            "baked": baked, "seconds": time,
        }))?;
        return Ok(Done::Ok);
    }
    let mut text = format!(
        "shard {shard}: {} of {all}; {baked} baked, {} from the cache, in {}\n",
        count(count_of, "need"),
        count_of - baked,
        seconds(time)
    );
    if all == 0 {
        text += library.parts.first().map_or("", |part| nothing(&part.scene));
    }
    text += &format!(
        "when all {} are done:\n  microfacet-bake bake {} --cache {} --out DIR\n",
        count(shard.of, "shard"),
        shell(scene),
        shell(folder)
    );
    summarize(&text)?;
    Ok(Done::Ok)
}

/// Warns if shards left receipts in a cache that are not those of this library.
pub(super) fn doubt(
    library: &Library,
    target: Target,
    scene: &Path,
    cache: &Path,
) -> Result<(), Failure> {
    let receipts = Receipts::read(cache, scene);
    if receipts.is_empty() {
        return Ok(());
    }
    // A budget of bytes has no shards, which is what is to be said then.
    let needs = library.needs(target).unwrap_or_default();
    let ours = Receipt::new(scene, Shard { number: 1, of: 1 }, &needs);
    for doubt in receipts.doubts(&ours) {
        let rest = "what is missing is baked now";
        report("warning", format!("{}: {doubt}; {rest}", cache.display()));
    }
    Ok(())
}
