//! `validate`: tests the sampler's normals against the analytic densities.

use std::path::PathBuf;

use serde_json::json;

use microfacet_bake::validate::configuration::{Configuration, configurations, shapes};
use microfacet_bake::validate::furnace::{Furnace, Survey, TOLERANCE as FURNACE_TOLERANCE, survey};
use microfacet_bake::validate::{
    LEVEL, Options, Outcome as Result, PDF_TOLERANCE, Report, run as run_all,
};

use microfacet_sampler::{LobeEntry, Reflectance, Tables};

use super::{Done, Failure, Outcome, print, print_json, progress, tables, values};

/// Test normals drawn from tables against the analytic densities by chi-square.
#[derive(clap::Args)]
#[command(
    after_help = "Example:\n  microfacet-bake validate --configurations 50 --samples 1000000"
)]
pub(super) struct Args {
    /// A table file, or a folder with one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// Normals drawn for each configuration.
    #[arg(long, value_name = "N", default_value_t = 100_000, allow_negative_numbers = true, value_parser = values::count(1_000..=10_000_000_000))]
    samples: u64,
    /// Number of materials and views, drawn over the covered domain.
    #[arg(long, value_name = "K", default_value_t = 100, allow_negative_numbers = true, value_parser = values::count(1..=1_000_000))]
    configurations: u64,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Test one configuration instead: its roughness, `X` or `X,Y`.
    #[arg(long, value_name = "X[,Y]", allow_negative_numbers = true, value_parser = values::sigma, requires_all = ["gamma", "theta"])]
    sigma: Option<[f64; 2]>,
    /// Shape of the one configuration.
    #[arg(long, value_name = "G", allow_negative_numbers = true, value_parser = values::gamma, requires = "sigma")]
    gamma: Option<f64>,
    /// Polar angle of its view.
    #[arg(long, value_name = "T", allow_negative_numbers = true, requires = "sigma")]
    theta: Option<f64>,
    /// Azimuth of its view.
    #[arg(long, value_name = "P", default_value = "0", allow_negative_numbers = true)]
    phi: f64,
    #[command(flatten)]
    unit: values::Unit,
    /// Multiply the model's gamma by this; 1.01 shows that the tests reject.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    perturb_gamma: f64,
    /// Test every public function at corners and random points instead: no NaN, nothing out of
    /// range.
    #[arg(long, conflicts_with_all = ["sigma", "gamma", "theta", "perturb_gamma"])]
    stress: bool,
    /// Points of the stress run; never fewer than its corners, about a million.
    #[arg(long, value_name = "N", default_value_t = 1_000_000, requires = "stress")]
    points: u64,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    if args.stress {
        if shapes(&set).is_empty() {
            return Err(Failure(nothing_to_judge(&set)));
        }
        return super::stress::stress(&set, args.points, args.seed, args.json);
    }
    let chosen = match (args.sigma, args.gamma, args.theta) {
        (Some([sigma_x, sigma_y]), Some(gamma), Some(theta)) => {
            values::tabulated(gamma, "")?;
            let (theta, phi) = (args.unit.theta(theta)?, args.unit.phi(args.phi)?);
            vec![Configuration { sigma_x, sigma_y, gamma, theta, phi, seed: args.seed }]
        }
        _ => configurations(&set, usize::try_from(args.configurations)?, args.seed),
    };
    let options =
        Options { samples: usize::try_from(args.samples)?, gamma_factor: args.perturb_gamma };
    let bar = progress(chosen.len(), "validating");
    let result = run_all(&set, &chosen, options, || bar.inc(1))?;
    bar.finish_and_clear();
    // A single configuration tests its lobe only.
    let furnaces = if args.sigma.is_none() { survey(&set)? } else { Vec::new() };
    if chosen.is_empty() && furnaces.is_empty() {
        return Err(Failure(nothing_to_judge(&set)));
    }
    let untested = if args.sigma.is_none() { untested(&set) } else { Vec::new() };
    let passed = result.passed() && furnaces.iter().all(Survey::passed);
    let source =
        args.tables.as_deref().map_or(String::new(), |path| format!("{} ", path.display()));
    if args.json {
        print_json(&as_json(&result, options, &furnaces, &untested, passed))?
    } else {
        if !result.reports.is_empty() {
            print(&summary(&result, options, &source))?;
        }
        print(&white(&furnaces))?;
        untested.iter().try_for_each(|what| print(&format!("not tested: {what}\n")))?;
        if result.rejected() > 0 {
            print(NEXT)?;
        }
        if let Some(why) = unsound(&result) {
            print(&why)?;
        }
        print(if passed { "PASSED\n" } else { "REJECTED\n" })?;
    }
    Ok(if passed { Done::Ok } else { Done::Rejected })
}

/// What to do about a rejection.
const NEXT: &str = "to tell chance from a defect, repeat the worst configuration with other seeds (--seed) and more normals\n\
     (--samples): chance goes away, and the p of a defect falls\n";

/// Why a run rejects where chi-square does not: an integral that is not one.
fn unsound(result: &Result) -> Option<String> {
    let off = result.worst_integral()?.pdf_integral - 1.0;
    // Written so that a NaN counts.
    let wrong = !(off.abs() <= PDF_TOLERANCE);
    wrong
        .then(|| format!("the integral of table_pdf may differ from 1 by {PDF_TOLERANCE:e} only\n"))
}

/// Why a set has nothing that can be tested, and what to give instead.
fn nothing_to_judge(set: &Tables) -> String {
    let mut kinds: Vec<&str> = set.tables().iter().map(|table| table.kind.name()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    format!(
        "nothing to judge: visible normals need tables of the kinds shadowing, visible_slope and visible_slope_conditional for the \
         same gamma, white furnaces (without --stress) one of the kind albedo, and here are only tables of the kind {}; give the folder or the \
         safetensors file of the whole set, or see `microfacet-bake inspect --details` for what was measured when they were baked",
        kinds.join(", ")
    )
}

/// What a set holds that a run does not test.
fn untested(set: &Tables) -> Vec<String> {
    let mut rest: Vec<String> = Vec::new();
    if shapes(set).is_empty() {
        rest.push("visible normals, for which the set lacks tables".into());
    }
    for table in set.tables() {
        let subject = &table.subject;
        let lobe = subject.lobe != LobeEntry::Family;
        let exact = subject.reflectance.is_some_and(|of| of != Reflectance::Moments);
        if lobe || exact {
            rest.push(format!("{}; see `microfacet-bake inspect` for its certificate", table.name));
        }
    }
    rest
}

fn summary(result: &Result, options: Options, source: &str) -> String {
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
            report.configuration
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
        let (name, points) = (survey.masking.name(), survey.points);
        let (low, high) = (row(&survey.lowest), row(&survey.highest));
        format!(
            "white furnace, {name}, {points} points, Kulla-Conty: {low} to {high}; 1 +- {FURNACE_TOLERANCE:e} allowed\n"
        )
    };
    furnaces.iter().map(line).collect()
}

fn as_json(
    result: &Result,
    options: Options,
    furnaces: &[Survey],
    untested: &[String],
    passed: bool,
) -> serde_json::Value {
    let reports: Vec<_> = result
        .reports
        .iter()
        .map(|report| {
            let Configuration { sigma_x, sigma_y, gamma, theta, phi, seed } = report.configuration;
            json!({
                "sigma_x": sigma_x, "sigma_y": sigma_y, "gamma": gamma.to_string(), "theta": theta, "phi": phi, "seed": seed,
                "p_lobe": report.normals.lobe.p, "p_world": report.normals.world.p, "ks": report.normals.ks, "g1_error": report.g1_error,
            })
        })
        .collect();
    let furnaces: Vec<_> = furnaces
        .iter()
        .map(|survey| {
            let (low, high) = (survey.lowest.kulla_conty, survey.highest.kulla_conty);
            json!({ "masking": survey.masking.name(), "points": survey.points, "lowest": low, "highest": high })
        })
        .collect();
    json!({
        "passed": passed, "not_tested": untested, "furnaces": furnaces, "samples": options.samples, "level": LEVEL, "level_of_one_test": result.level,
        "rejected": result.rejected(), "pdf_tolerance": PDF_TOLERANCE,
        "worst_pdf_integral": result.worst_integral().map(|report| report.pdf_integral), "configurations": reports,
    })
}
