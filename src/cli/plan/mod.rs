//! `plan`: shows what a bake of a scene would do, and why.

mod doubts;
mod folder;
mod json;
mod sets;
mod words;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use microfacet_baker::library::Part;
use microfacet_baker::plan::Cost;
use microfacet_baker::table_set::costs;

use super::request::Request;
use super::words::{bytes, compared, count, exact_bytes, seconds, wrapped};
use super::{Done, Failure, Outcome, print, print_json};

pub(super) use doubts::{remind, warn};
pub(super) use words::Outline;

/// Show what must be baked for a scene and what not, with bytes and seconds; for a folder, a
/// summary over all scenes in it.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  microfacet-bake recipe --out mine.toml\n  microfacet-bake plan mine.toml\n  microfacet-bake plan library/materials"
)]
pub(super) struct Args {
    /// A recipe (.toml) or scene (.pbrt, .xml, .gltf, .glb, .mtlx), or a folder of them.
    scene: PathBuf,
    #[command(flatten)]
    request: Request,
    /// Print the plan as JSON.
    #[arg(long)]
    json: bool,
}

/// A plan with the figures that are reported on it.
struct Report<'a> {
    outline: Outline<'a>,
    general: Cost,
    /// Of reading and planning.
    milliseconds: [f64; 2],
}

pub(super) fn run(args: Args) -> Outcome {
    if args.scene.is_dir() {
        return folder::run(&args);
    }
    let start = Instant::now();
    let scene = args.request.scene(&args.scene)?;
    let reading = start.elapsed();
    let start = Instant::now();
    let library = args.request.library(scene, None)?;
    let planning = start.elapsed();
    let [part] = &library.parts[..] else {
        sets::run(&args, &library, [reading, planning])?;
        warn(library.plans());
        return Ok(Done::Ok);
    };
    let start = Instant::now();
    let mut report = Report::new(&args.request, part)?;
    let planning = planning + start.elapsed();
    report.milliseconds = [reading, planning].map(|time: Duration| 1e3 * time.as_secs_f64());
    if args.json {
        print_json(&report.json())?
    } else {
        let Outline { parts, total, .. } = &report.outline;
        let core_seconds = total.seconds * rayon::current_num_threads() as f64;
        let shards = sets::in_shards(&args.scene, &args.request, core_seconds, parts.len());
        print(&(report.text() + &shards))?
    }
    warn(library.plans());
    Ok(Done::Ok)
}

impl<'a> Report<'a> {
    /// The figures of one set.
    fn new(request: &Request, part: &'a Part) -> Result<Self, Failure> {
        let Part { scene, plan } = part;
        let (quality, precision) = (request.quality(), request.precision());
        let outline = Outline::new(scene, plan, quality, precision)?;
        let general = costs(&request.general_plan(false), quality, precision)?.into_iter().sum();
        Ok(Self { outline, general, milliseconds: [0.0; 2] })
    }
}

impl Report<'_> {
    fn text(&self) -> String {
        let Self { outline, general, milliseconds: [reading, planning] } = self;
        let total = &outline.total;
        let mut text = outline.lines(["bake", "skip"], |part| part.cost());

        let smaller = compared(total.bytes as f64, general.bytes as f64, ["smaller", "larger"]);
        let than_general = |compared: String| {
            let cost = format!("{}, about {}", bytes(general.bytes), seconds(general.seconds));
            format!("{compared} than the general set ({cost})")
        };
        let figures = if !outline.plan.is_empty() {
            let faster = compared(total.seconds, general.seconds, ["faster", "slower"]);
            let time = seconds(total.seconds);
            than_general(format!("about {time}; {smaller} and {faster}"))
        } else if outline.is_doubtful() {
            "no tables to bake for what was read".into()
        } else if outline.scene.materials.is_empty() {
            "no tables to bake".into()
        } else {
            than_general(format!("no tables to bake; {smaller}"))
        };
        text += &wrapped("total: ", &format!("{}, {figures}", exact_bytes(total.bytes)), 7);

        let materials = outline.scene.materials.len() + outline.scene.ignored.len();
        text + &format!(
            "{}, read in {reading:.1} ms, planned in {planning:.1} ms\n",
            count(materials, "material")
        )
    }
}
