//! `plan`: shows what a bake of a scene would do, and why.

mod doubts;
mod folder;
mod json;
mod sets;
mod words;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use microfacet_baker::bake::albedo::AlbedoSpec;
use microfacet_baker::library::Part;
use microfacet_baker::plan::{Cost, albedo_costs, bare_cost, cost, distribution_cost};
use microfacet_baker::table_spec::general_set;

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
    /// Cost of each part that is baked.
    costs: Vec<Cost>,
    total: Cost,
    general: Cost,
    /// Milliseconds.
    reading: f64,
    planning: f64,
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
    let report = Report::new(&args.request, part)?;
    let milliseconds = |time: Duration| 1e3 * time.as_secs_f64();
    let (reading, planning) = (milliseconds(reading), milliseconds(planning + start.elapsed()));
    let report = Report { reading, planning, ..report };
    if args.json {
        print_json(&report.json())?
    } else {
        let core_seconds = report.total.seconds * rayon::current_num_threads() as f64;
        let needs = report.costs.len();
        print(&(report.text() + &sets::in_shards(&args.scene, &args.request, core_seconds, needs)))?
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
        let own = plan.distributions.iter().map(|own| distribution_cost(own, quality, precision));
        let costs = outline.tables.iter().map(|specs| cost(specs));
        let costs: Vec<Cost> = costs.chain(own).chain(albedo_costs(&outline.albedos)).collect();
        let total = costs.iter().copied().chain([bare_cost(&plan.provenance())]).sum();
        let everything = request.general_plan();
        let albedos = everything.albedos.iter().map(|_| AlbedoSpec::general(quality, precision));
        let albedos = albedo_costs(&albedos.collect::<Vec<_>>());
        let general = [cost(&general_set(quality, precision)), bare_cost(&everything.provenance())]
            .into_iter()
            .chain(albedos)
            .sum();
        Ok(Self { outline, costs, total, general, reading: 0.0, planning: 0.0 })
    }
}

impl Report<'_> {
    fn text(&self) -> String {
        let Self { outline, costs, total, general, .. } = self;
        // The albedos come last.
        let first = costs.len() - outline.albedos.len();
        let detail = |i: usize| {
            let open =
                i.checked_sub(first).is_some_and(|albedo| outline.albedos[albedo].doublings() > 0);
            let size = if open {
                format!("about {}", bytes(costs[i].bytes))
            } else {
                exact_bytes(costs[i].bytes)
            };
            format!(", {size}, about {}", seconds(costs[i].seconds))
        };
        let mut text = outline.lines(["bake", "skip"], detail);

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
            "{}, read in {:.1} ms, planned in {:.1} ms\n",
            count(materials, "material"),
            self.reading,
            self.planning
        )
    }
}
