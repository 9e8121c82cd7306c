//! `bake`: a recipe or scene in, a certified set of tables out.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use serde_json::json;

use microfacet_bake::generate::generate;
use microfacet_bake::plan;
use microfacet_bake::scene::{self, Scene};
use microfacet_bake::spec::{Quality, general_set};
use microfacet_bake::store::{Format, OutputFolder, Written};
use microfacet_sampler::{Precision, Table, Tables};

use super::{Done, Outcome, print, print_json, progress};

/// Bake tables for a recipe or scene, or without one for every sigma and gamma.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  microfacet-bake bake tables/recipes/frosted-glass.toml --out glass")]
pub(super) struct Args {
    /// A recipe (.toml) or scene (.pbrt, .xml, .gltf, .glb, .mtlx); without one, the general set: all sigma, gamma in [1.501, inf].
    recipe: Option<PathBuf>,
    /// Folder to write into; made if it is not there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Container formats, comma separated.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "safetensors")]
    format: Vec<FormatArg>,
    /// How values are stored.
    #[arg(long, value_enum, default_value = "f32")]
    precision: PrecisionArg,
    /// How fine the tables are.
    #[arg(long, value_enum, default_value = "default")]
    quality: QualityArg,
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

#[derive(Clone, Copy, ValueEnum)]
enum PrecisionArg {
    /// Single precision.
    F32,
    /// Half precision.
    F16,
    /// Sixteen-bit fixed point.
    U16,
}

#[derive(Clone, Copy, ValueEnum)]
enum QualityArg {
    /// Small and rough.
    Draft,
    /// CDF error below 1e-4 (gamma >= 1.8), G1 error below 1e-5.
    Default,
    /// CDF error below 1e-5, G1 error below 2e-6; eight times the bytes.
    High,
}

pub(super) fn run(args: Args) -> Outcome {
    let start = Instant::now();
    let precision = match args.precision {
        PrecisionArg::F32 => Precision::F32,
        PrecisionArg::F16 => Precision::F16,
        PrecisionArg::U16 => Precision::U16,
    };
    let quality = match args.quality {
        QualityArg::Draft => Quality::Draft,
        QualityArg::Default => Quality::Default,
        QualityArg::High => Quality::High,
    };
    let out = OutputFolder::open(&args.out)?;
    let scene = args.recipe.as_deref().map(scene::load).transpose()?;
    if let Some(scene) = &scene {
        scene.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        report_ignored(scene);
    }
    let specs = match &scene {
        Some(scene) => plan::specs(scene, quality, precision)?,
        None => general_set(quality, precision),
    };
    if specs.is_empty() {
        print("Nothing to bake: no material in use is rough.\n")?;
        return Ok(Done::Ok);
    }
    let (recipe, entries) = match &scene {
        Some(scene) => (scene.to_recipe(), plan::entries(scene)),
        None => (String::new(), Vec::new()),
    };
    let bar = progress(specs.len() + 1, "baking");
    let set = generate(&specs, recipe, entries, |_| bar.inc(1))?;
    bar.finish_and_clear();
    let formats: Vec<Format> = args
        .format
        .iter()
        .map(|format| match format {
            FormatArg::Safetensors => Format::Safetensors,
            FormatArg::Exr => Format::Exr,
        })
        .collect();
    let written = out.write(&set, &formats)?;
    let seconds = start.elapsed().as_secs_f64();
    if args.json {
        print_json(&as_json(&set, &written, seconds))?
    } else {
        print(&summary(&set, &written, seconds))?
    }
    Ok(Done::Ok)
}

fn report_ignored(scene: &Scene) {
    for ignored in &scene.ignored {
        eprintln!("note: {ignored}");
    }
}

/// What a table's certificate says about its largest error.
pub(super) fn largest_error(table: &Table) -> String {
    let figure = |key: &str| table.certificate.get(key);
    for (quantity, name) in [("g1", "G1"), ("cdf", "CDF")] {
        if let Some(max) = figure(&format!("{quantity}_max_error")) {
            let rms = figure(&format!("{quantity}_rms_error")).copied().unwrap_or(f64::NAN);
            return format!("{name} error max {max:.2e}, rms {rms:.2e}");
        }
    }
    "not certified".into()
}

fn summary(set: &Tables, written: &[Written], seconds: f64) -> String {
    let mut text = String::new();
    for table in set.tables() {
        let axes: Vec<String> =
            table.axes.iter().map(|axis| format!("{} {}", axis.name, axis.len())).collect();
        text += &format!("{:26} {:34} {}\n", table.name, axes.join(" x "), largest_error(table));
    }
    for file in written {
        text += &format!("{} ({} bytes)\n", file.path.display(), file.bytes);
    }
    text + &format!("{} tables in {seconds:.2} s\n", set.tables().len())
}

fn as_json(set: &Tables, written: &[Written], seconds: f64) -> serde_json::Value {
    let tables: Vec<_> = set
        .tables()
        .iter()
        .map(|table| {
            let axes: Vec<_> =
                table.axes.iter().map(|axis| json!({ "name": axis.name, "length": axis.len() })).collect();
            json!({ "name": table.name, "kind": table.kind.name(), "axes": axes, "certificate": table.certificate })
        })
        .collect();
    let files: Vec<_> = written
        .iter()
        .map(|file| json!({ "path": file.path.display().to_string(), "bytes": file.bytes }))
        .collect();
    json!({ "tables": tables, "files": files, "seconds": seconds })
}
