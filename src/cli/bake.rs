//! `bake`: bakes a recipe or scene into a certified set of tables.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use serde_json::json;

use microfacet_bake::cache::Cache;
use microfacet_bake::input::MAX_TABLES;
use microfacet_bake::plan::{Plan, set_cost};
use microfacet_bake::progress::Meter;
use microfacet_bake::scene::{self, Scene};
use microfacet_bake::store::{Format, OutputFolder, Written};
use microfacet_bake::table_set::{Baked, Settings, Target, bake_with};
use microfacet_bake::validate::certificate::worst_error;
use microfacet_sampler::Table;

use super::request::{Request, nothing_to_bake};
use super::{
    Done, Failure, Outcome, escape, interrupt, print, print_json, progress, report, values,
};

/// Bake tables for a recipe or scene, or without one for every sigma and gamma.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  microfacet-bake bake tables/recipes/frosted-glass.toml --out glass",
    group = clap::ArgGroup::new("budget").args(["max_error", "max_bytes"])
)]
pub(super) struct Args {
    /// A recipe (.toml) or scene (.pbrt, .xml, .gltf, .glb, .mtlx); without one, the general set:
    /// all sigma, gamma in [1.501, inf].
    #[arg(id = "scene", value_name = "SCENE")]
    recipe: Option<PathBuf>,
    /// Folder to write into; created if missing.
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Container formats, comma separated.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "safetensors")]
    format: Vec<FormatArg>,
    #[command(flatten)]
    request: Request,
    /// Choose each table's nodes and precision instead: small tables whose measured error (of G1,
    /// the CDFs of slopes, and albedos) is at most this.
    #[arg(long, value_name = "E", value_parser = parse_error, conflicts_with_all = ["quality", "precision"])]
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
    /// Limit of the memory for baking, such as 512MB or 4GiB; a larger bake is refused at the
    /// start.
    #[arg(long, value_name = "BYTES", value_parser = values::size, default_value = "4GiB")]
    max_memory: u64,
    /// Print the summary as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FormatArg {
    /// One file with all tables.
    Safetensors,
    /// One OpenEXR image a table.
    Exr,
}

fn parse_error(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(error) if error > 0.0 && error <= 0.1 => Ok(error),
        _ => Err(format!("\"{text}\" must be a number in (0, 0.1], such as 1e-4")),
    }
}

/// Parses the largest size of a set: what is read back.
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

    /// What a bake leaves that is interrupted before it writes.
    fn leaves(&self, cache: &Cache) -> String {
        let out = format!("{} is as it was", self.out.display());
        let kept = "; finished tables are kept, and the same command goes on from there";
        out + if cache.folder().is_some() { kept } else { "" }
    }

    fn cache(&self) -> Cache {
        match &self.cache {
            _ if self.no_cache => Cache::none(),
            Some(folder) => Cache::new(folder.clone()),
            None => Cache::user(),
        }
    }
}

pub(super) fn run(args: Args) -> Outcome {
    let start = Instant::now();
    let out = OutputFolder::open(&args.out)?;
    let scene = args.recipe.as_deref().map(scene::load).transpose()?;
    let plan = match &scene {
        Some(scene) => {
            scene.warnings.iter().for_each(|warning| report("warning", warning));
            report_ignored(scene);
            args.request.plan(scene, args.max_error)?
        }
        None => args.request.general_plan(),
    };
    if let Some(scene) = scene.as_ref().filter(|_| plan.is_empty()) {
        print(nothing_to_bake(scene))?;
        return Ok(Done::Ok);
    }
    if let Target::Quality(quality, precision) = args.target() {
        let bytes = set_cost(&plan, quality, precision)?.bytes as u64;
        if bytes > MAX_TABLES {
            return Err(Failure(format!(
                "the set would have about {} MiB, and at most {} MiB are read back: bake fewer materials, or with a lower quality or \
                 precision",
                bytes >> 20,
                MAX_TABLES >> 20
            )));
        }
    }
    let settings = Settings {
        cache: args.cache(),
        max_memory: args.max_memory,
        patient: args.patient,
        progress: Meter::default(),
    };
    interrupt::leaves(args.leaves(&settings.cache));
    let bar = progress::show(&settings.progress, "baking");
    let result = bake_with(&plan, args.target(), settings)?;
    drop(bar);
    if let Some(why) = &result.cache_error {
        report(
            "warning",
            format!(
                "finished tables are not kept: {why}; name a folder with --cache, or use --no-cache"
            ),
        );
    }
    let formats: Vec<Format> = args
        .format
        .iter()
        .map(|format| match format {
            FormatArg::Safetensors => Format::Safetensors,
            FormatArg::Exr => Format::Exr,
        })
        .collect();
    let written = out.write(&result.set, &formats)?;
    interrupt::leaves(format!("the set in {} is complete", args.out.display()));
    let seconds = start.elapsed().as_secs_f64();
    if args.json {
        print_json(&as_json(&result, &written, seconds))?
    } else {
        print(&summary(&result, &plan, &written, seconds))?
    }
    Ok(Done::Ok)
}

fn report_ignored(scene: &Scene) {
    for ignored in &scene.ignored {
        report("note", ignored);
    }
}

/// The largest error that a table's certificate states.
pub(super) fn largest_error(table: &Table) -> String {
    let figure = |key: &str| table.certificate.get(key);
    for (quantity, name) in [("g1", "G1"), ("cdf", "CDF"), ("d", "D/D(0)"), ("e", "E")] {
        if let Some(max) = figure(&format!("{quantity}_max_error")) {
            let rms = figure(&format!("{quantity}_rms_error"));
            let rms = rms.map_or(String::new(), |rms| format!(", rms {rms:.2e}"));
            return format!("{name} error max {max:.2e}{rms}");
        }
    }
    match worst_error(table) {
        worst if worst.is_finite() => format!("albedo error max {worst:.2e}"),
        _ => "not certified".into(),
    }
}

/// The two parts that [`Baked::seconds`] are of.
const FAMILIES: [&str; 2] = ["visible normals", "albedo"];

fn summary(result: &Baked, plan: &Plan, written: &[Written], seconds: f64) -> String {
    let mut text = String::new();
    let tables = result.set.tables();
    let width = tables.iter().map(|table| table.name.len()).max().unwrap_or(0);
    for table in tables {
        let axes: Vec<String> =
            table.axes.iter().map(|axis| format!("{} {}", axis.name, axis.len())).collect();
        let (axes, precision) = (axes.join(" x "), format!("{:?}", table.precision).to_lowercase());
        text += &format!(
            "{:width$}  {axes:34} {precision}  {}\n",
            escape::line(&table.name),
            largest_error(table)
        );
    }
    for file in written {
        text += &format!("{} ({} bytes)\n", file.path.display(), file.bytes);
    }
    if tables.is_empty() && plan.has_closed_forms() {
        text += "no tables: every rough material has closed forms, which the sampler uses\n";
    }
    let baked = match (tables.len(), result.baked) {
        (all, 0) if all > 0 => format!("nothing to bake: all {all} tables were finished before"),
        (all, baked) if baked < all => {
            format!("{baked} tables baked, {} finished before,", all - baked)
        }
        (all, _) => format!("{all} tables"),
    };
    text += &format!("{baked} in {seconds:.3} s");
    if !plan.albedos.is_empty() {
        let parts = FAMILIES
            .iter()
            .zip(result.seconds)
            .map(|(name, seconds)| format!("{name} {seconds:.3} s"));
        text += &format!(" ({})", parts.collect::<Vec<_>>().join(", "));
    }
    text + "\n"
}

fn as_json(result: &Baked, written: &[Written], seconds: f64) -> serde_json::Value {
    let tables: Vec<_> = result
        .set
        .tables()
        .iter()
        .map(|table| {
            let axes: Vec<_> =
                table.axes.iter().map(|axis| json!({ "name": axis.name, "length": axis.len() })).collect();
            json!({
                "name": table.name, "kind": table.kind.name(), "axes": axes, "precision": table.precision,
                "certificate": table.certificate,
            })
        })
        .collect();
    let files: Vec<_> = written
        .iter()
        .map(|file| json!({ "path": file.path.display().to_string(), "bytes": file.bytes }))
        .collect();
    let families: serde_json::Map<_, _> = FAMILIES
        .iter()
        .zip(result.seconds)
        .map(|(&name, seconds)| (name.into(), json!(seconds)))
        .collect();
    json!({ "tables": tables, "baked": result.baked, "files": files, "seconds": seconds, "seconds_of": families })
}
