//! `furnace`: the light that comes back with F = 1, without and with compensation.

use std::path::PathBuf;

use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::json;

use microfacet_bake::validate::furnace::{Furnace, TOLERANCE, Walk, furnace, walk};
use microfacet_sampler::{Masking, Tables};

use super::{Done, Failure, Outcome, print, print_json, tables, values};

/// Run a white furnace: single scattering, each compensation, and the random walk on the
/// microsurface.
#[derive(clap::Args)]
#[command(
    after_help = "Exit status 1 if the Kulla-Conty lobe differs from 1 by more than 2e-3, or a walk by more than three standard errors.\n\
    Examples:\n  microfacet-bake furnace\n  microfacet-bake furnace --sigma 1 --gamma 2 --method walk"
)]
pub(super) struct Args {
    /// A table file, or a folder with one; the embedded default if absent.
    tables: Option<PathBuf>,
    /// Roughnesses, comma separated: 0, a mirror, or in [1e-8, 3].
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true, value_parser = parse_roughness, default_value = "0.01,0.1,0.3,0.6,1,2,3")]
    sigma: Vec<f64>,
    /// Shapes in [1.501, inf], comma separated.
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true, value_parser = values::gamma, default_value = "1.501,1.6,2,3,5,10,40,inf")]
    gamma: Vec<f64>,
    /// Cosines of the view in [0, 1], comma separated.
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true, value_parser = parse_cosine, default_value = "0.02,0.3,1")]
    cos_theta: Vec<f64>,
    /// Form of masking: G1(v) G1(l) or 1/(1 + lambda(v) + lambda(l)); a walk is height-correlated.
    #[arg(long, value_parser = parse_masking(), default_value = Masking::HeightCorrelated.name())]
    masking: Masking,
    /// Method; `walk` adds the random walk (Heitz et al. 2016).
    #[arg(long, value_enum, default_value = "quadrature")]
    method: Method,
    /// Number of rays of each walk.
    #[arg(long, default_value_t = 100_000, allow_negative_numbers = true, value_parser = values::count(1_000..=10_000_000_000))]
    walks: u64,
    /// Seed of the walks.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print the average albedo by gamma and sigma instead.
    #[arg(long)]
    average: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// The forms of masking by name.
fn parse_masking() -> impl TypedValueParser<Value = Masking> {
    PossibleValuesParser::new(Masking::ALL.map(Masking::name))
        .try_map(|name| name.parse::<Masking>())
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// By quadrature.
    Quadrature,
    /// By quadrature and by the random walk.
    Walk,
}

fn parse_roughness(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        // The set says whether it holds it.
        Ok(sigma) if sigma >= 0.0 => Ok(sigma),
        _ => Err(format!("sigma \"{text}\" must be 0, a mirror, or a number in [1e-8, 3]")),
    }
}

fn parse_cosine(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(cos) if (0.0..=1.0).contains(&cos) => Ok(cos),
        _ => Err(format!("cos_theta \"{text}\" must be a number in [0, 1]; 0 is grazing")),
    }
}

pub(super) fn run(args: Args) -> Outcome {
    let set = tables(args.tables.as_deref())?;
    if args.average {
        return average(&args, &set);
    }
    args.gamma.iter().try_for_each(|&gamma| values::tabulated(gamma, ""))?;
    let walking = args.method == Method::Walk;
    let masking = args.masking;
    let mut rows = Vec::new();
    let mut passed = true;
    if !args.json {
        print(&head(walking))?;
    }
    for &gamma in &args.gamma {
        for &sigma in &args.sigma {
            for &cos in &args.cos_theta {
                let row = furnace(&set, masking, sigma, gamma, cos)?;
                // A mirror has no microsurface to walk on.
                let walked = if walking && sigma > 0.0 {
                    Some(walk(sigma, gamma, cos, usize::try_from(args.walks)?, args.seed)?)
                } else {
                    None
                };
                // Written so that a NaN fails.
                passed &= (row.kulla_conty - 1.0).abs() <= TOLERANCE;
                passed &=
                    walked.is_none_or(|walk| conserves(&walk) && agrees(&row, &walk, masking));
                if args.json {
                    rows.push(as_json(&row, walked));
                } else {
                    print(&line(&row, walked))?;
                }
            }
        }
    }
    if args.json {
        print_json(&json!({ "masking": Masking::name(masking), "passed": passed, "rows": rows }))?;
    } else {
        print(if passed { "The furnace closes.\n" } else { "The furnace does not close.\n" })?;
    }
    Ok(if passed { Done::Ok } else { Done::Rejected })
}

/// Whether all light came back, within three standard errors.
fn conserves(walk: &Walk) -> bool {
    (walk.total.mean - 1.0).abs() <= 3.0 * walk.total.error
}

/// Whether the share of light that leaves after the first bounce is E, within four standard errors,
/// since a grid has hundreds of tests.
fn agrees(row: &Furnace, walk: &Walk, masking: Masking) -> bool {
    // Where nearly all or nearly no light returns, the counts resolve less than one walk.
    masking != Masking::HeightCorrelated
        || (walk.single.mean - row.single).abs()
            <= 4.0 * walk.single.error.max((row.single / 1e5).sqrt() * 1e-2) + 1e-5
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

fn as_json(row: &Furnace, walk: Option<Walk>) -> serde_json::Value {
    let walk = walk.map(|walk| {
        json!({
            "single": walk.single.mean, "single_error": walk.single.error,
            "total": walk.total.mean, "total_error": walk.total.error, "bounces": walk.bounces,
        })
    });
    // JSON has no infinity.
    json!({
        "sigma": row.sigma, "gamma": row.gamma.to_string(), "cos_theta": row.cos_theta, "single": row.single,
        "turquin": row.turquin, "kulla_conty": row.kulla_conty, "walk": walk,
    })
}

/// The average albedo, γ down and σ across: the quantity that figure 9 of Ribardière et al. 2017
/// shows as spheres.
fn average(args: &Args, set: &Tables) -> Outcome {
    let mut text = String::from("| gamma |");
    args.sigma.iter().for_each(|sigma| text += &format!(" sigma = {sigma} |"));
    text += &format!("\n| --- |{}\n", " --- |".repeat(args.sigma.len()));
    for &gamma in &args.gamma {
        text += &format!("| {gamma} |");
        for &sigma in &args.sigma {
            let albedo = set.albedo(sigma, gamma, args.masking).map_err(Failure::from)?;
            text += &format!(" {:.3} |", albedo.albedo_average());
        }
        text += "\n";
    }
    print(&text)?;
    Ok(Done::Ok)
}
