//! `furnace`: the light that comes back with F = 1, without and with compensation.

mod grid;

use std::path::PathBuf;

use serde_json::{Value, json};

use microfacet_sampler::{Masking, Tables};
use microfacet_validate::furnace::{
    Furnace, TOLERANCE, Walk, furnace, seconds, walk, walk_seconds,
};

use super::values::{self, number};
use super::words::distinct;
use super::{Done, Outcome, Result, print, print_json, summarize, tables, watched};

/// Run a white furnace: single scattering, each compensation, and the random walk on the
/// microsurface.
#[derive(clap::Args)]
#[command(after_help = "\
Exit status 1 if the Kulla-Conty lobe differs from 1 by more than 2e-3, or a walk by more than three
standard errors.
Examples:
  microfacet-bake furnace
  microfacet-bake furnace --sigma 1 --gamma 2 --walks 1e5
  microfacet-bake furnace --average --masking uncorrelated")]
pub(super) struct Args {
    /// A table file, or a folder with one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// Roughnesses, comma separated: 0, a mirror, or in [1e-8, 3]; by default those of 0.01, 0.1,
    /// 0.3, 0.6, 1, 2 and 3 that the tables cover.
    #[arg(long, value_name = "X,...", value_delimiter = ',', value_parser = number(|&sigma| sigma >= 0.0, "0, a mirror, or a number in [1e-8, 3]"))]
    sigma: Vec<f64>,
    /// Shapes in [1.501, inf], comma separated; by default those of 1.501, 1.6, 2, 3, 5, 10, 40 and
    /// inf that the tables cover.
    #[arg(long, value_name = "G,...", value_delimiter = ',', value_parser = values::gamma)]
    gamma: Vec<f64>,
    /// Cosines of the view in [0, 1], comma separated.
    #[arg(long, value_name = "C,...", value_delimiter = ',', value_parser = number(|cos| (0.0..=1.0).contains(cos), "a number in [0, 1]; 0 is grazing"), default_value = "0.02,0.3,1")]
    cos_theta: Vec<f64>,
    /// Form of masking: G1(v) G1(l) or 1/(1 + lambda(v) + lambda(l)); a walk is height-correlated.
    #[arg(long, value_parser = values::masking(), default_value = Masking::HeightCorrelated.name())]
    masking: Masking,
    /// Add the random walk (Heitz et al. 2016) with N rays a row, such as 1e5.
    #[arg(long, value_name = "N", value_parser = values::count::<usize>(1_000..=10_000_000_000))]
    walks: Option<usize>,
    /// Seed of the walks.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::seed, requires = "walks")]
    seed: u64,
    /// Print the average albedo by gamma and sigma instead, as a table in Markdown.
    #[arg(long, conflicts_with_all = ["cos_theta", "walks", "seed", "json"])]
    average: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    values::tabulated(&args.gamma, "")?;
    let masking = args.masking;
    let materials = grid::materials(&set, masking, &args.sigma, &args.gamma)?;
    if args.average {
        print(&average(&materials, &set, masking)?)?;
        return Ok(Done::Ok);
    }
    if !args.json {
        print(&head(args.walks.is_some()))?;
    }
    // A mirror has no microsurface to walk on.
    let walks = |sigma: f64| args.walks.filter(|_| sigma > 0.0);
    let of_row = |sigma, gamma| seconds(1) + walk_seconds(sigma, gamma, walks(sigma).unwrap_or(0));
    let of_views: f64 = materials.iter().map(|&(sigma, gamma)| of_row(sigma, gamma)).sum();
    let work = of_views * args.cos_theta.len() as f64;
    let mut rows = Vec::new();
    let mut failures = String::new();
    watched("in the furnace", work, |meter| -> Result<()> {
        for &(sigma, gamma) in &materials {
            for &cos in &args.cos_theta {
                let stage = meter.stage(of_row(sigma, gamma));
                let row = furnace(&set, masking, sigma, gamma, cos)?;
                let walked = |walks| walk(sigma, gamma, cos, walks, args.seed, &stage);
                let walked = walks(sigma).map(walked).transpose()?;
                let why = deviations(&row, walked.as_ref(), masking);
                if args.json {
                    rows.push(as_json(&row, walked, &why));
                } else {
                    print(&line(&row, walked))?;
                }
                for why in why {
                    let at = format!("gamma {gamma}, sigma {sigma}, cos_theta {cos}");
                    failures += &format!("  {at}: {why}\n");
                }
            }
        }
        Ok(())
    })?;
    let passed = failures.is_empty();
    if args.json {
        print_json(&json!({ "masking": masking.name(), "passed": passed, "rows": rows }))?;
    } else if passed {
        summarize("The furnace closes.\n")?;
    } else {
        print(&format!("The furnace does not close:\n{failures}"))?;
    }
    Ok(Done::judged(passed))
}

/// What is wrong with a row, and by how much; nothing if the furnace closes.
fn deviations(row: &Furnace, walk: Option<&Walk>, masking: Masking) -> Vec<String> {
    let mut found = Vec::new();
    let off = row.kulla_conty - 1.0;
    // The negated comparison fails for NaN.
    if !(off.abs() <= TOLERANCE) {
        found.push(format!("Kulla-Conty is 1 {off:+.2e}, and 1 +- {TOLERANCE:e} is allowed"));
    }
    let Some(Walk { single, total, .. }) = walk else { return found };
    let (off, allowed) = (total.mean - 1.0, 3.0 * total.error);
    if !(off.abs() <= allowed) {
        found.push(format!(
            "all bounces bring back 1 {off:+.2e}, and 1 +- {allowed:.2e} is allowed"
        ));
    }
    // The share of light that leaves after the first bounce is E, within four standard errors,
    // since a grid has hundreds of tests. Where nearly all or nearly no light returns, the counts
    // resolve less than one walk.
    let off = single.mean - row.single;
    let allowed = 4.0 * single.error.max((row.single / 1e5).sqrt() * 1e-2) + 1e-5;
    if masking == Masking::HeightCorrelated && !(off.abs() <= allowed) {
        found.push(format!(
            "one bounce brings back E {off:+.2e}, and E +- {allowed:.2e} is allowed"
        ));
    }
    found
}

fn head(walking: bool) -> String {
    let walk = if walking { "  walk, 1 bounce         walk, all   bounces" } else { "" };
    format!(
        "{:>8} {:>6} {:>9} {:>9} {:>9} {:>11}{walk}\n",
        "gamma", "sigma", "cos_theta", "E", "Turquin", "Kulla-Conty"
    )
}

fn line(row: &Furnace, walk: Option<Walk>) -> String {
    let Furnace { sigma, gamma, cos_theta, single, turquin, kulla_conty } = row;
    let walk = walk.map_or(String::new(), |walk| {
        let Walk { single, total, bounces } = walk;
        format!(
            "  {:.5} +- {:.5}  {:.5} +- {:.5} {bounces:9.3}",
            single.mean, single.error, total.mean, total.error
        )
    });
    format!(
        "{gamma:>8} {sigma:>6} {cos_theta:>9} {single:9.5} {turquin:9.5} {kulla_conty:11.5}{walk}\n"
    )
}

fn as_json(row: &Furnace, walk: Option<Walk>, deviations: &[String]) -> Value {
    let walk = walk.map(|walk| {
        json!({
            "single": walk.single.mean, "single_error": walk.single.error,
            "total": walk.total.mean, "total_error": walk.total.error, "bounces": walk.bounces,
        })
    });
    // JSON has no infinity.
    json!({
        "sigma": row.sigma, "gamma": row.gamma.to_string(), "cos_theta": row.cos_theta, "single": row.single,
        "turquin": row.turquin, "kulla_conty": row.kulla_conty, "walk": walk, "deviations": deviations,
    })
}

/// The average albedo, γ down and σ across, the quantity that figure 9 of Ribardière et al. 2017
/// shows as spheres; a dash for a pair that the set does not cover.
fn average(materials: &[(f64, f64)], set: &Tables, masking: Masking) -> Result<String> {
    let sigmas = distinct(materials.iter().map(|material| material.0));
    let mut text = String::from("| gamma |");
    sigmas.iter().for_each(|sigma| text += &format!(" sigma = {sigma} |"));
    text += &format!("\n| --- |{}\n", " --- |".repeat(sigmas.len()));
    for gamma in distinct(materials.iter().map(|material| material.1)) {
        text += &format!("| {gamma} |");
        for &sigma in &sigmas {
            text += &match materials.contains(&(sigma, gamma)) {
                true => format!(" {:.3} |", set.albedo(sigma, gamma, masking)?.albedo_average()),
                false => " - |".into(),
            };
        }
        text += "\n";
    }
    Ok(text)
}
