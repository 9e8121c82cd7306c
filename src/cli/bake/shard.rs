//! `bake --shard`: one of many processes that bake a library together.

use std::io::{self, IsTerminal};
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;

use microfacet_baker::cache::Cache;
use microfacet_baker::library::{Library, Receipt, Receipts, Shard};
use microfacet_baker::store::OutputFolder;
use microfacet_baker::table_set::{Need, Target};

use super::Args;
use crate::cli::plan::remind;
use crate::cli::words::{count, seconds, shell};
use crate::cli::{Result, bail, interrupt, note, print_json, progress, summarize, warn};

/// Time between two lines in a log.
const BETWEEN: Duration = Duration::from_secs(60);

pub(super) fn run(args: &Args, shard: Shard, scene: &Path, folder: &Path) -> Result<()> {
    let start = Instant::now();
    // A folder that cannot be used fails before the bake. It is held, since other shards use it.
    let _folder = OutputFolder::open(folder)?;
    let cache = Cache::new(folder.to_path_buf());
    let kept = folder.display().to_string();
    interrupt::leaves(move || {
        format!("finished tables are in {kept}, and the same command goes on from there")
    });
    let library = args.library(scene)?;
    library.parts.iter().try_for_each(|part| args.check_bytes(&part.plan))?;
    let needs = library.needs(args.target())?;
    let receipt = Receipt::new(scene, shard, &needs);
    // Until a shard of the same needs has ended, so that not each of hundreds warns.
    let receipts = Receipts::read(folder, scene);
    if !receipts.has(&receipt) {
        for doubt in receipts.others(&receipt) {
            warn(format!("{}: {doubt}", folder.display()));
        }
    }
    let all = needs.len();
    let mine = shard.take(needs);
    let settings = args.settings(cache);
    let bar = progress::show(&settings.progress, "baking");
    let count_of = mine.len();
    let mut said = Instant::now();
    let baked = Library::bake(&mine, &settings, |done| {
        // For the log of a scheduler; a terminal has a bar.
        if said.elapsed() >= BETWEEN && !io::stderr().is_terminal() {
            note(format!("shard {shard}: {done} of {}", count(count_of, "need")));
            said = Instant::now();
        }
    })?;
    drop(bar);
    receipt.leave(folder)?;
    let time = start.elapsed().as_secs_f64();
    if args.json {
        print_json(&json!({
            "shard": shard.number, "of": shard.of, "needs": count_of, "needs_of_all": all,
            "baked": baked, "seconds": time,
        }))?;
    } else {
        let when = match shard.of {
            1 => "then".into(),
            all => format!("when all {} are done", count(all, "shard")),
        };
        summarize(&format!(
            "shard {shard}: {} of {all}; {baked} baked, {} from the cache, in {}\n{when}:\n  \
             microfacet-bake bake {}{} --cache {} --out DIR\n",
            count(count_of, "need"),
            count_of - baked,
            seconds(time),
            shell(scene),
            args.repeated(),
            shell(folder)
        ))?;
    }
    remind(library.plans());
    Ok(())
}

/// Says what a cache lacks where shards were to fill it, and why; with `--only-kept` refuses.
pub(super) fn check(args: &Args, library: &Library, scene: &Path, cache: &Cache) -> Result<()> {
    let Some(folder) = cache.folder() else { return Ok(()) };
    let receipts = Receipts::read(folder, scene);
    // A budget of bytes has no shards, and for a largest error only the search knows the needs.
    let Target::Quality(..) = args.target() else { return Ok(()) };
    if receipts.is_empty() && !args.only_kept {
        return Ok(());
    }
    let needs = library.needs(args.target())?;
    let missing: Vec<&Need> =
        needs.iter().map(|(_, need)| need).filter(|need| !need.is_kept(cache)).collect();
    let Some(first) = missing.first() else { return Ok(()) };
    let threads = rayon::current_num_threads();
    let time = missing.iter().map(|need| need.seconds()).sum::<f64>() / threads as f64;
    let lacks = format!(
        "{}: {} of {} missing, such as {}; about {} on {}",
        folder.display(),
        missing.len(),
        count(needs.len(), "need"),
        first.name(),
        seconds(time),
        count(threads, "thread")
    );
    let ours = Receipt::new(scene, Shard { number: 1, of: 1 }, &needs);
    for doubt in receipts.doubts(&ours) {
        warn(format!("{}: {doubt}", folder.display()));
    }
    if args.only_kept {
        bail!(
            "{lacks}: run the shards that bake them with the same options, or leave out --only-kept"
        );
    }
    warn(format!("{lacks}; they are baked now"));
    Ok(())
}
