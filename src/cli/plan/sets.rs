//! The plan of a library that fills several sets.

use std::path::Path;
use std::time::Duration;

use rayon::current_num_threads;
use serde_json::json;

use microfacet_baker::library::Library;
use microfacet_baker::plan::Cost;
use microfacet_baker::table_set::{Need, Target, costs};

use super::{Args, Report, Request};
use crate::cli::words::{bytes, columns, count, seconds, shell};
use crate::cli::{Done, Outcome, print, print_json, write};

pub(super) fn run(args: &Args, library: &Library, [reading, planning]: [Duration; 2]) -> Outcome {
    let (quality, precision) = (args.request.quality(), args.request.precision());
    let needs = library.needs(Target::Quality(quality, precision))?;
    // What several sets share is baked once.
    let threads = current_num_threads();
    let time = needs.iter().map(|(_, need): &(String, Need)| need.seconds()).sum::<f64>();
    let time = time / threads as f64;
    let milliseconds = [reading, planning].map(|time| 1e3 * time.as_secs_f64());
    if args.json {
        let [reading, planning] = milliseconds;
        let milliseconds = json!({ "reading": reading, "planning": planning });
        let (needs, time) = (json!(needs.len()), json!(time));
        // One set at a time: all together would take more memory than the rest of the command.
        let head = format!(
            "{{\n\"needs\": {needs},\n\"seconds\": {time},\n\"milliseconds\": {milliseconds},\n\"sets\": ["
        );
        write(head.as_bytes())?;
        for (i, part) in library.parts.iter().enumerate() {
            write(if i == 0 { b"\n" } else { b",\n" })?;
            print_json(&Report::new(&args.request, part)?.json())?;
        }
        write(b"]\n}\n")?;
        return Ok(Done::Ok);
    }
    let mut rows = Vec::new();
    let mut total = Cost { bytes: 0, seconds: time };
    let mut materials = 0;
    for (i, part) in library.parts.iter().enumerate() {
        let cost: Cost = costs(&part.plan, quality, precision)?.into_iter().sum();
        total.bytes += cost.bytes;
        materials += part.plan.materials.len();
        rows.push(vec![
            format!("set {}", i + 1),
            count(part.plan.materials.len(), "material"),
            bytes(cost.bytes),
            format!("about {}", seconds(cost.seconds)),
        ]);
    }
    let mut text: String = columns(&rows).iter().map(|line| format!("{line}\n")).collect();
    text += &format!(
        "total: {} in {}, {}; {}, about {} on {}\n",
        count(materials, "material"),
        count(library.parts.len(), "numbered set"),
        bytes(total.bytes),
        count(needs.len(), "need"),
        seconds(total.seconds),
        count(threads, "thread")
    );
    text += &format!("read in {:.1} ms, planned in {:.1} ms\n", milliseconds[0], milliseconds[1]);
    text += &in_shards(&args.scene, &args.request, time * threads as f64, needs.len());
    print(&text)?;
    Ok(Done::Ok)
}

/// Core seconds of a shard: long compared with its planning, and short enough to repeat.
const SHARD: f64 = 1800.0;

/// How several processes share the work, where it is more than one shard of half an hour.
pub(super) fn in_shards(scene: &Path, request: &Request, seconds: f64, needs: usize) -> String {
    let shards = ((seconds / SHARD).ceil() as usize).min(needs);
    if shards < 2 {
        return String::new();
    }
    format!(
        "in shards of about half an hour of one core, by any number of processes:\n  \
         microfacet-bake bake {}{} --shard I/{shards} --cache DIR\n",
        shell(scene),
        request.repeated()
    )
}
