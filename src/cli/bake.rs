//! `bake`: bakes a recipe or scene into a certified set of tables.

mod sets;
mod shard;
mod summary;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use serde_json::{Value, json};

use microfacet_baker::cache::Cache;
use microfacet_baker::input::MAX_TABLES;
use microfacet_baker::library::{Library, Part, Shard};
use microfacet_baker::plan::{Cost, Plan};
use microfacet_baker::progress::Meter;
use microfacet_baker::scene::Scene;
use microfacet_baker::store::{Format, OutputFolder, Written};
use microfacet_baker::table_set::{
    BakeError, Baked, Settings, Target, bake_with, costs, smallest_bytes,
};

use super::plan::{Outline, remind};
use super::request::Request;
use super::values::{self, Named, named, number};
use super::words::shell;
use super::{
    Failure, Result, anyhow, ensure, interrupt, is_stream, print_json, progress, summarize, warn,
};
use summary::Summary;

const FORMATS: [Named<Format>; 2] = [
    ("safetensors", "tables.safetensors", Format::Safetensors),
    ("exr", "tables.exr, an OpenEXR image of one part a table", Format::Exr),
];

/// Bake tables for a recipe or scene, or without one for every sigma and gamma.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake recipe --out mine.toml\n  microfacet-bake bake mine.toml --out mine\n  microfacet-bake bake mine.toml --out small --max-error 1e-3\n  microfacet-bake bake library.toml --shard 2/16 --cache shared\n  microfacet-bake bake --out general",
    group = clap::ArgGroup::new("budget").args(["max_error", "max_bytes"])
)]
pub(super) struct Args {
    /// A recipe (.toml) or scene (.pbrt, .xml, .gltf, .glb, .mtlx); without one, the general set:
    /// all sigma, gamma in [1.501, inf].
    #[arg(id = "scene", value_name = "SCENE")]
    recipe: Option<PathBuf>,
    /// Folder to write into; created if missing.
    #[arg(long, short, value_name = "DIR", required_unless_present = "shard")]
    out: Option<PathBuf>,
    /// Bake the I-th of N shards of what the scene needs into the cache, and write no set: for one
    /// of N processes on any machines that share the folder. A bake with --out then assembles it.
    #[arg(long, value_name = "I/N", value_parser = str::parse::<Shard>, requires_all = ["scene", "cache"], conflicts_with_all = ["out", "format", "split", "max_bytes", "no_cache"])]
    shard: Option<Shard>,
    /// Container format.
    #[arg(long, value_parser = named(&FORMATS), default_value = "safetensors")]
    format: Format,
    /// With --format exr: instead of one file write an image NAME.exr for each table, for programs
    /// that open no parts. Such a folder is no set.
    #[arg(long)]
    split: bool,
    /// Bake the albedos of common glass too (eta 1.3 to 1.7, gamma 2 to inf, sigma up to 1), as
    /// the default set has them; takes several times as long.
    #[arg(long, conflicts_with_all = ["scene", "no_albedo"])]
    glass: bool,
    #[command(flatten)]
    request: Request,
    /// Choose each table's nodes and precision instead: small tables whose measured error (of G1,
    /// the CDFs of slopes, and albedos) is at most this.
    #[arg(long, value_name = "E", value_parser = number(|&error| error > 0.0 && error <= 0.1, "a number in (0, 0.1], such as 1e-4"), conflicts_with_all = ["quality", "precision"])]
    max_error: Option<f64>,
    /// Choose the most accurate tables instead whose safetensors file is at most this large.
    #[arg(long, value_name = "BYTES", value_parser = parse_size, conflicts_with_all = ["quality", "precision"])]
    max_bytes: Option<usize>,
    /// Choose tables for --max-error or --max-bytes even if that takes more than ten seconds and
    /// more than three times the bake of default quality.
    #[arg(long, requires = "budget")]
    patient: bool,
    /// Folder that caches finished tables; in the user's cache folder by default.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Bake everything, and cache nothing.
    #[arg(long, conflicts_with = "cache")]
    no_cache: bool,
    /// Make the set from the cache alone: refuse, and say what is missing, if anything would have
    /// to be baked.
    #[arg(long, requires = "scene", conflicts_with_all = ["shard", "no_cache", "max_error", "max_bytes"])]
    only_kept: bool,
    /// Limit of the memory for baking, such as 512MB or 4GiB; a larger bake is refused at the
    /// start.
    #[arg(long, value_name = "BYTES", value_parser = values::size, default_value = "4GiB")]
    max_memory: u64,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

/// Parses the largest size of a set, which must be one that can be read back.
fn parse_size(text: &str) -> Result<usize, String> {
    let bytes = values::size(text)?;
    let small = usize::try_from(bytes).ok().filter(|_| bytes <= MAX_TABLES);
    small.ok_or_else(|| {
        format!("\"{text}\" must be at most {} MiB, the largest set that is read", MAX_TABLES >> 20)
    })
}

impl Args {
    fn target(&self) -> Target {
        match (self.max_error, self.max_bytes) {
            (Some(max_error), _) => Target::MaxError(max_error),
            (_, Some(max_bytes)) => Target::MaxBytes(max_bytes),
            _ => Target::Quality(self.request.quality(), self.request.precision()),
        }
    }

    /// The options on which the tables depend, as they were typed.
    fn repeated(&self) -> String {
        let error = self.max_error.map_or(String::new(), |error| format!(" --max-error {error:e}"));
        self.request.repeated() + &error + if self.patient { " --patient" } else { "" }
    }

    fn settings(&self, cache: Cache) -> Settings {
        let Self { max_memory, patient, .. } = *self;
        Settings { cache, max_memory, patient, progress: Meter::default() }
    }

    /// Reads a scene, warns of what is doubtful in it before the long bake, and plans its sets.
    fn library(&self, path: &Path) -> Result<Library> {
        ensure!(
            !path.is_dir(),
            "{}: is a folder; name one scene, or see `microfacet-bake plan {}`",
            path.display(),
            shell(path)
        );
        let scene = self.request.scene(path)?;
        scene.warnings.iter().for_each(warn);
        self.request.library(scene, self.max_error)
    }

    /// Refuses a set that could not be read back, before it is baked.
    fn check_bytes(&self, plan: &Plan) -> Result<()> {
        let Target::Quality(quality, precision) = self.target() else { return Ok(()) };
        let cost: Cost = costs(plan, quality, precision)?.into_iter().sum();
        let bytes = cost.bytes as u64;
        ensure!(
            bytes <= MAX_TABLES,
            "the set would have about {} MiB, and at most {} MiB are read back: bake fewer \
             materials in a set (--per-set), or with a lower quality or precision",
            bytes >> 20,
            MAX_TABLES >> 20
        );
        Ok(())
    }

    /// Why a bake was refused; if its bytes are too few, with the options by which they suffice.
    fn refused(&self, scene: &Scene, why: BakeError) -> Failure {
        let BakeError::TooSmall { max_bytes, .. } = why else { return why.into() };
        let fits = self.request.without().into_iter().filter_map(|(option, options)| {
            let plan = Plan::new(scene, options).ok()?;
            let bytes = smallest_bytes(&plan).ok().filter(|bytes| *bytes <= max_bytes)?;
            Some(format!("{option} (about {bytes} bytes)"))
        });
        let fits: Vec<String> = fits.collect();
        if fits.is_empty() {
            why.into()
        } else {
            anyhow!("{why}; what fits: {}", fits.join(", or "))
        }
    }

    /// Sets the message of an interrupt: what the bake leaves.
    fn say_what_is_left(&self, folder: &Path, out: &OutputFolder, cache: &Cache) {
        let (folder, written, kept) = (folder.display().to_string(), out.written(), cache.kept());
        interrupt::leaves(move || {
            if written.load(Relaxed) {
                return format!("the set in {folder} is complete");
            }
            let kept = if kept.load(Relaxed) {
                "; finished tables are kept, and the same command goes on from there"
            } else {
                ""
            };
            format!("{folder} is as it was{kept}")
        });
    }
}

/// The cache of the options `--cache` and `--no-cache`, by default the user's.
pub(super) fn cache(folder: Option<&Path>, none: bool) -> Cache {
    match folder {
        _ if none => Cache::none(),
        Some(folder) => Cache::new(folder.to_path_buf()),
        None => Cache::user(),
    }
}

/// Files that were written, as JSON.
fn files(written: &[Written]) -> Value {
    let file =
        |file: &Written| json!({ "path": file.path.display().to_string(), "bytes": file.bytes });
    written.iter().map(file).collect()
}

pub(super) fn run(args: &Args) -> Result<()> {
    let start = Instant::now();
    if let (Some(shard), Some(scene), Some(cache)) = (args.shard, &args.recipe, &args.cache) {
        return shard::run(args, shard, scene, cache);
    }
    let folder = args.out.as_deref().unwrap_or(Path::new(""));
    ensure!(
        !is_stream(folder),
        "--out -: a set is a folder of files and does not go to standard output; name a folder, \
         such as --out tables (or --out ./- for one of that name)"
    );
    ensure!(
        !args.split || args.format == Format::Exr,
        "--split: only images are split; add --format exr"
    );
    let out = match args.split {
        true => OutputFolder::open(folder)?,
        false => OutputFolder::open_for_set(folder)?,
    };
    let cache = cache(args.cache.as_deref(), args.no_cache);
    args.say_what_is_left(folder, &out, &cache);
    let library = match args.recipe.as_deref() {
        Some(path) => args.library(path)?,
        None => Library {
            parts: vec![Part {
                scene: Scene::default(),
                plan: args.request.general_plan(args.glass),
            }],
        },
    };
    if let Some(scene) = &args.recipe {
        shard::check(args, &library, scene, &cache)?;
    }
    let [Part { scene, plan }] = &library.parts[..] else {
        sets::run(args, &library, out, cache, start)?;
        remind(library.plans());
        return Ok(());
    };
    let outline = Outline::new(scene, plan, args.request.quality(), args.request.precision())?;
    args.check_bytes(plan)?;
    let settings = args.settings(cache);
    let bar = progress::show(&settings.progress, "baking");
    let result = bake_with(plan, args.target(), settings).map_err(|why| args.refused(scene, why));
    drop(bar);
    let result = result?;
    warn_of_cache(&result);
    let written = match args.split && !result.set.tables().is_empty() {
        true => out.write_images(&result.set)?,
        false => out.write(&result.set, args.format)?,
    };
    let summary = Summary {
        outline,
        result: &result,
        written: &written,
        out: folder,
        exr: args.format == Format::Exr,
        split: args.split,
        seconds: start.elapsed().as_secs_f64(),
    };
    if args.json {
        print_json(&summary.json())?
    } else {
        summarize(&summary.text())?
    }
    remind(library.plans());
    Ok(())
}

/// Warns if finished tables could not be cached.
fn warn_of_cache(baked: &Baked) {
    if let Some(why) = &baked.cache_error {
        let fix = "name a folder with --cache, or use --no-cache";
        warn(format!("finished tables are not kept: {why}; {fix}"));
    }
}
