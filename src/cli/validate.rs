//! `validate`: tests the sampler's normals against the analytic densities.

use std::path::PathBuf;

use microfacet_report::words::command;
use microfacet_sampler::Tables;
use microfacet_tables::Reflectance;
use microfacet_validate::configuration::{Configuration, configurations, shapes};
use microfacet_validate::furnace::{Furnace, Survey, survey, survey_seconds};
use microfacet_validate::per_hit;
use microfacet_validate::record::Record;
use microfacet_validate::{
    Options, Outcome as Found, PDF_TOLERANCE, Report, run as run_all, seconds,
};

use super::view::View;
use super::words::{count, distinct, first, number, shell};
use super::{
    Done, Outcome, Result, bail, ensure, print_json, summarize, tables, values, verdict, watched,
};

/// Test normals drawn from tables against the analytic densities by chi-square.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  microfacet-bake validate --configurations 50 --samples 1e6
  microfacet-bake validate --sigma 0.3 --gamma 3 --theta 60 --degrees
  microfacet-bake validate glass --json > glass.json    for `report glass --validation glass.json`
  microfacet-bake validate glass --per-hit
  microfacet-bake validate --stress --points 2e6")]
pub(super) struct Args {
    /// A table file, or a folder with one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// Normals drawn for each configuration.
    #[arg(long, value_name = "N", default_value = "1e5", value_parser = values::count::<usize>(1_000..=10_000_000_000))]
    samples: usize,
    /// Number of configurations (materials and views), drawn over what the tables cover.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = values::count::<usize>(1..=1_000_000))]
    configurations: usize,
    /// Seed of everything random.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::seed)]
    seed: u64,
    /// Multiply the model's gamma by this; with --samples 1e6, 1.01 shows that the tests reject.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = values::factor)]
    perturb_gamma: f64,
    /// Print the result as JSON, with the identity of the set; `report --validation` reads it.
    #[arg(long)]
    json: bool,
    /// Test one configuration: its roughness, `X` or `X,Y`.
    #[arg(long, help_heading = ONE, value_name = "X[,Y]", value_parser = values::sigma, requires_all = ["gamma", "theta"], conflicts_with = "configurations")]
    sigma: Option<[f64; 2]>,
    /// Shape.
    #[arg(long, help_heading = ONE, value_name = "G", value_parser = values::gamma, requires = "sigma")]
    gamma: Option<f64>,
    #[command(flatten, next_help_heading = ONE)]
    view: View,
    /// Test lobes of sigma and gamma that textures give, as `Tables::family` draws them, instead:
    /// both are drawn for each normal.
    #[arg(long, help_heading = PER_HIT, conflicts_with_all = ["sigma", "gamma", "theta", "phi", "degrees", "configurations", "stress"])]
    per_hit: bool,
    /// Test every public function at corners and random points instead: no NaN, nothing out of
    /// range.
    #[arg(long, help_heading = STRESS, conflicts_with_all = ["sigma", "gamma", "theta", "phi", "degrees", "perturb_gamma", "samples", "configurations"])]
    stress: bool,
    /// Points of the stress run; never fewer than its corners, about a million.
    #[arg(long, help_heading = STRESS, value_name = "N", default_value = "1e6", value_parser = values::count::<u64>(1..=1_000_000_000_000), requires = "stress")]
    points: u64,
}

const ONE: &str = "One configuration";
const PER_HIT: &str = "Sigma and gamma that differ from hit to hit";
const STRESS: &str = "Stress test";

pub(super) fn run(args: &Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    // The set as an argument of the commands that are printed.
    let source = args.tables.as_deref().map(shell);
    if args.stress {
        ensure!(!shapes(&set).is_empty(), nothing_to_judge(&set));
        let source = source.map_or(String::new(), |path| format!(" --tables {path}"));
        return super::stress::stress(&set, args.points, args.seed, args.json, &source);
    }
    if args.per_hit {
        let family = set.family()?;
        let factor = args.perturb_gamma;
        perturbed(family.gammas().map(|[low, _]| low), factor)?;
        let (samples, seed) = (args.samples, args.seed);
        let options = per_hit::Options { samples, seed, gamma_factor: factor, sigma_factor: 1.0 };
        let source = source.map_or(String::new(), |path| format!(" --tables {path}"));
        return super::per_hit::per_hit(&set, &family, options, args.json, &source);
    }
    let chosen = match (args.sigma, args.gamma, args.view.angles()?) {
        (Some([sigma_x, sigma_y]), Some(gamma), Some([theta, phi])) => {
            values::tabulated(&[gamma], "")?;
            vec![Configuration { sigma_x, sigma_y, gamma, theta, phi, seed: args.seed }]
        }
        _ => configurations(&set, args.configurations, args.seed),
    };
    let factor = args.perturb_gamma;
    perturbed(chosen.iter().map(|one| one.gamma), factor)?;
    let options = Options { samples: args.samples, gamma_factor: factor };
    // A single configuration tests its lobe only.
    let whole = args.sigma.is_none();
    let normals = seconds(chosen.len(), options);
    let furnace = if whole { survey_seconds(&set) } else { 0.0 };
    let (result, furnaces) = watched("validating", normals + furnace, |meter| -> Result<_> {
        let result = run_all(&set, &chosen, options, &meter.stage(normals))?;
        let furnaces = if whole { survey(&set, &meter.stage(furnace))? } else { Vec::new() };
        Ok((result, furnaces))
    })?;
    ensure!(!chosen.is_empty() || !furnaces.is_empty(), nothing_to_judge(&set));
    let untested = if whole { untested(&set) } else { Vec::new() };
    let passed = result.passed() && furnaces.iter().all(Survey::passed);
    if args.json {
        let record = Record::new(&set, options, &result, &furnaces, untested)?;
        print_json(&serde_json::to_value(&record)?)?;
        return Ok(Done::judged(passed));
    }
    let source = source.map_or(String::new(), |path| format!("{path} "));
    summarize(&text(&result, options, &source, &furnaces, &untested))?;
    verdict(passed)
}

/// Refuses a factor that takes one of the shapes out of the family.
fn perturbed(gammas: impl Iterator<Item = f64>, factor: f64) -> Result<()> {
    let smallest = gammas.fold(f64::INFINITY, f64::min);
    if smallest * factor <= 1.5 {
        bail!(
            "--perturb-gamma {factor} takes the gamma {} of a configuration out of (1.5, inf]: \
             give a factor above {:.4}",
            number(smallest),
            1.5 / smallest + 5e-5
        );
    }
    Ok(())
}

fn text(
    result: &Found,
    options: Options,
    source: &str,
    furnaces: &[Survey],
    untested: &[String],
) -> String {
    let mut text = String::new();
    if !result.reports.is_empty() {
        text += &summary(result, options, source);
    }
    text += &white(furnaces);
    let others = |more: &[String]| {
        format!("not tested: {} more; --json lists all\n", count(more.len(), "table"))
    };
    text += &first(untested, SHOWN, |what| format!("not tested: {what}\n"), others);
    if result.rejected() > 0 {
        text += NEXT;
    }
    // Chi-square may pass where an integral is not one. The negated comparison is true for NaN.
    let off = result.worst_integral().map_or(0.0, |worst| worst.pdf_integral - 1.0);
    if !(off.abs() <= PDF_TOLERANCE) {
        text += &format!("the integral of table_pdf may differ from 1 by {PDF_TOLERANCE:e} only\n");
    }
    text
}

/// Lines of what is not tested; a library has a table for each material.
const SHOWN: usize = 6;

/// What to do about a rejection.
const NEXT: &str = "to tell chance from a defect, repeat the worst configuration with other seeds (--seed) and more normals\n\
     (--samples): chance goes away, and the p of a defect falls\n";

/// Why a set has nothing that can be tested, and what to give instead.
fn nothing_to_judge(set: &Tables) -> String {
    let mut kinds = distinct(set.tables().iter().map(|table| table.kind.name()));
    kinds.sort_unstable();
    format!(
        "nothing to judge: visible normals need tables of the kinds shadowing, visible_slope and \
         visible_slope_conditional for the same gamma, white furnaces (without --stress) one of \
         the kind albedo, and here are only tables of the kind {}; give the folder or the \
         safetensors file of the whole set, or see `microfacet-bake inspect --details` for what \
         was measured when they were baked",
        kinds.join(", ")
    )
}

/// What a set holds that a run does not test.
fn untested(set: &Tables) -> Vec<String> {
    let mut rest: Vec<String> = Vec::new();
    if set.tables().is_empty() {
        rest.push("tables, of which the set has none; GGX in closed form was tested".into());
    } else if shapes(set).is_empty() {
        rest.push("visible normals, for which the set lacks tables".into());
    }
    for table in set.tables() {
        let subject = &table.subject;
        let exact = subject.reflectance.is_some_and(|of| of != Reflectance::Mirror);
        if !subject.lobe.is_family() || exact {
            rest.push(format!("{}; see `microfacet-bake inspect` for its certificate", table.name));
        }
    }
    rest
}

fn summary(result: &Found, options: Options, source: &str) -> String {
    let reports = &result.reports;
    let max = |f: fn(&Report) -> f64| reports.iter().map(f).fold(0.0, f64::max);
    let mut text = format!(
        "{} configurations x {} normals, two chi-square tests each; a single test rejects below p = {:.3e}\n\
         smallest p {:.3e}, {} rejected; KS distance {:.2e}; G1 error {:.2e}\n",
        reports.len(),
        options.samples,
        result.level,
        reports.first().map_or(1.0, |report| report.normals.p()),
        result.rejected(),
        max(|report| report.normals.ks),
        max(|report| report.g1_error),
    );
    if let Some(worst) = result.worst_integral() {
        let (off, gamma) = (worst.pdf_integral - 1.0, worst.configuration.gamma);
        text += &format!("integral of table_pdf: 1 {off:+.2e} at worst (gamma {gamma})\n");
    }
    text += "worst configurations:\n";
    for report in reports.iter().take(5) {
        text += &format!(
            "  p {:.3e} (lobe {:.3e}, world {:.3e}): microfacet-bake validate {source}--samples {} {}\n",
            report.normals.p(),
            report.normals.lobe.p,
            report.normals.world.p,
            options.samples,
            command::options(&report.configuration)
        );
    }
    text
}

/// The white furnaces, one line for each table of albedos.
fn white(furnaces: &[Survey]) -> String {
    let line = |survey: &Survey| {
        let row = |row: &Furnace| {
            let Furnace { sigma, gamma, cos_theta, kulla_conty, .. } = row;
            format!("{kulla_conty:.5} (sigma {sigma:.3e}, gamma {gamma:.4}, cos_theta {cos_theta})")
        };
        let (name, points, allowed) = (survey.masking.name(), survey.points, survey.allowed);
        let (low, high) = (row(&survey.lowest), row(&survey.highest));
        format!(
            "white furnace, {name}, {points} points, Kulla-Conty: {low} to {high}; 1 +- {allowed:e} allowed\n"
        )
    };
    furnaces.iter().map(line).collect()
}
