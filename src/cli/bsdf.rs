//! `bsdf`: tests complete BSDFs, as renderers call them.

use std::path::PathBuf;

use clap::ValueEnum;
use serde_json::{Value, json};

use microfacet_baker::table_set::Settings;
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{Masking, Tables};
use microfacet_validate::bsdf::configuration::{Configuration, configurations};
use microfacet_validate::bsdf::furnace::{PAIRS, Row};
use microfacet_validate::bsdf::reciprocity::Worst;
use microfacet_validate::bsdf::{chi_square, furnace, reciprocity, specimen};
use microfacet_validate::furnace::TOLERANCE as FURNACE_TOLERANCE;
use microfacet_validate::{LEVEL, Options};

use super::bake::cache;
use super::values::{self, number};
use super::{Done, Outcome, Result, print_json, progress, summarize, verdict, watched};

/// Test complete BSDFs: their samples by chi-square, white furnaces, and reciprocity.
///
/// Conductors, dielectrics from both sides and plastics, with every kind of lobe, masking and
/// compensation. Lobes and the albedos of conductors are those of the default set; those of
/// dielectrics are baked first.
#[derive(clap::Args)]
#[command(after_help = "\
Exit status 1 if samples differ from their density, if a white furnace differs from 1 by more than
2e-3 or exceeds what certificates allow, or if exchanging view and light changes f by more than
1e-4.
Examples:
  microfacet-bake bsdf
  microfacet-bake bsdf --only chi-square --configurations 40 --samples 2e5
  microfacet-bake bsdf --only furnace --gamma 2,inf --eta 1.5
  microfacet-bake bsdf --only chi-square --perturb-gamma 1.05")]
pub(super) struct Args {
    /// Run one of the tests, or several, comma separated; all by default.
    #[arg(long, value_name = "TEST,...", value_delimiter = ',', value_enum)]
    only: Vec<Test>,
    /// Number of configurations (BSDFs and views).
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = values::count::<usize>(1..=1_000_000))]
    configurations: usize,
    /// Lights drawn for each configuration.
    #[arg(long, value_name = "N", default_value = "1e6", value_parser = values::count::<usize>(10_000..=10_000_000_000))]
    samples: usize,
    /// Seed of everything random.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = values::seed)]
    seed: u64,
    /// Multiply the gamma of the lobes that are drawn from by this; 1.05 shows that the tests
    /// reject.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = values::factor)]
    perturb_gamma: f64,
    /// Shapes of the furnaces, comma separated, with each of --eta; by default seven pairs.
    #[arg(long, value_name = "G,...", value_delimiter = ',', value_parser = values::gamma, requires = "eta")]
    gamma: Vec<f64>,
    /// Indices of refraction of the furnaces, inside over outside, comma separated.
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = number(|eta| (0.1..=10.0).contains(eta), "a number in [0.1, 10]; 1.5 is glass in air"), requires = "gamma")]
    eta: Vec<f64>,
    /// Form of masking of the furnaces.
    #[arg(long, value_parser = values::masking(), default_value = Masking::HeightCorrelated.name())]
    masking: Masking,
    /// Folder of finished tables.
    #[arg(long, value_name = "FOLDER")]
    cache: Option<PathBuf>,
    /// Bake the albedos of dielectrics again, and do not keep them.
    #[arg(long, conflicts_with = "cache")]
    no_cache: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Test {
    /// Samples against the density.
    ChiSquare,
    /// White surfaces return all light.
    Furnace,
    /// View and light may be exchanged.
    Reciprocity,
}

/// Sampled lights of a furnace, and pairs of directions of each BSDF.
const FURNACE_SAMPLES: usize = 100_000;
const PAIRS_OF_DIRECTIONS: usize = 10_000;

impl Args {
    fn runs(&self, test: Test) -> bool {
        self.only.is_empty() || self.only.contains(&test)
    }

    fn bake(
        &self,
        of: impl FnOnce(Settings) -> Result<Tables, specimen::Unmade>,
    ) -> Result<Tables> {
        let cache = cache(self.cache.as_deref(), self.no_cache);
        let settings = Settings { cache, ..Settings::default() };
        let _bar = progress::show(&settings.progress, "baking albedos of dielectrics");
        Ok(of(settings)?)
    }
}

/// The text of a test, its JSON, and whether it passed.
struct Judged(String, Value, bool);

pub(super) fn run(args: &Args) -> Outcome {
    values::tabulated(&args.gamma, "")?;
    let mut document = json!({});
    let mut passed = true;
    let mut add = |name: &str, Judged(text, value, sound): Judged| {
        passed &= sound;
        document[name] = value;
        if args.json { Ok(()) } else { summarize(&text) }
    };
    let (chi, pairs) = (args.runs(Test::ChiSquare), args.runs(Test::Reciprocity));
    if chi || pairs {
        let all = configurations(args.configurations, args.seed);
        // Compensation needs the albedos of what is drawn, too.
        let reshaped = |one: &Configuration| one.specimen.reshaped(args.perturb_gamma);
        let drawn = all.iter().filter(|_| args.perturb_gamma != 1.0).map(reshaped);
        let specimens: Vec<_> = all.iter().map(|one| one.specimen).chain(drawn).collect();
        // Densities do not depend on how accurate the albedos are.
        let set = args.bake(|settings| specimen::tables(&specimens, Quality::Draft, settings))?;
        if chi {
            add("chi_square", judge_samples(args, &set, &all)?)?;
        }
        if pairs {
            add("reciprocity", judge_exchange(&set, &all)?)?;
        }
    }
    if args.runs(Test::Furnace) {
        add("furnace", judge_furnaces(args)?)?;
    }
    if !args.json {
        return verdict(passed);
    }
    document["passed"] = passed.into();
    print_json(&document)?;
    Ok(Done::judged(passed))
}

fn judge_samples(args: &Args, set: &Tables, all: &[Configuration]) -> Result<Judged> {
    let options = Options { samples: args.samples, gamma_factor: args.perturb_gamma };
    let work = chi_square::seconds(all.len(), options);
    let result = watched("drawing samples", work, |meter| {
        chi_square::run(set, all, options, &meter.stage(work))
    })?;
    let smallest = result.reports.first().map_or(1.0, |report| report.test.p);
    let mut text = format!(
        "chi-square: {} configurations x {} samples; a test rejects below p = {:.3e}\n\
         smallest p {smallest:.3e}, {} rejected; smallest:\n",
        all.len(),
        args.samples,
        result.level,
        result.rejected(),
    );
    for report in result.reports.iter().take(result.rejected().max(5)) {
        text += &format!("  p {:.3e}: {}\n", report.test.p, report.configuration);
    }
    let reports = result.reports.iter().map(|report| {
        json!({
            "p": report.test.p, "degrees": report.test.degrees, "statistic": report.test.statistic,
            "configuration": report.configuration.to_string(),
        })
    });
    let value = json!({
        "samples": args.samples, "level": LEVEL, "level_of_one_test": result.level,
        "rejected": result.rejected(), "configurations": reports.collect::<Vec<_>>(),
    });
    Ok(Judged(text, value, result.passed()))
}

fn judge_exchange(set: &Tables, all: &[Configuration]) -> Result<Judged> {
    let result = reciprocity::run(set, all, PAIRS_OF_DIRECTIONS)?;
    let [reflected, transmitted] = result.pairs;
    let mut text = format!(
        "reciprocity: {reflected} pairs of directions on one side, {transmitted} on both; {:e} allowed\n",
        reciprocity::TOLERANCE
    );
    let mut line = |name: &str, worst: Option<Worst>| {
        if let Some(Worst { difference, specimen, v, l }) = worst {
            text += &format!("  {name} {difference:.2e}: {specimen}; v {v}, l {l}\n");
        }
    };
    line("largest difference", result.worst);
    line("tilted lobes whose G1 is clamped to 1, not judged:", result.clamped);
    let value = |worst: Option<Worst>| worst.map(|worst| worst.difference);
    let value = json!({
        "reflected": reflected, "transmitted": transmitted, "tolerance": reciprocity::TOLERANCE,
        "difference": value(result.worst), "difference_where_clamped": value(result.clamped),
    });
    Ok(Judged(text, value, result.passed()))
}

fn judge_furnaces(args: &Args) -> Result<Judged> {
    let product = args.gamma.iter().flat_map(|&g| args.eta.iter().map(move |&eta| [g, eta]));
    let named: Vec<[f64; 2]> = product.collect();
    let pairs = if named.is_empty() { &PAIRS[..] } else { &named[..] };
    let set = args.bake(|settings| furnace::tables(pairs, args.masking, settings))?;
    let rows = furnace::rows(pairs, args.masking);
    let work = furnace::seconds(rows.len(), FURNACE_SAMPLES);
    let rows = watched("in the furnace", work, |meter| {
        furnace::run(&set, &rows, FURNACE_SAMPLES, args.seed, &meter.stage(work))
    })?;
    let mut text = format!(
        "white furnace, {}, Kulla-Conty; 1 +- {FURNACE_TOLERANCE:e} allowed\n",
        args.masking
    );
    let mut surfaces = Vec::new();
    for name in furnace::NAMES {
        let of: Vec<&Row> = rows.iter().filter(|row| row.name() == name).collect();
        let order = |a: &&&Row, b: &&&Row| a.returned.total_cmp(&b.returned);
        let (Some(low), Some(high)) = (of.iter().min_by(order), of.iter().max_by(order)) else {
            continue;
        };
        let sampled = of.iter().filter_map(|row| row.standard_errors());
        let (count, off) =
            sampled.fold((0, 0.0_f64), |(count, off), errors| (count + 1, off.max(errors.abs())));
        text += &format!(
            "  {name}: {} views, {:.5} to {:.5}; {count} sampled, at most {off:.1} standard errors off\n",
            of.len(),
            low.returned,
            high.returned
        );
        surfaces.push(json!({
            "surface": name, "views": of.len(), "lowest": low.returned, "highest": high.returned,
            "sampled": count, "standard_errors": off,
        }));
    }
    let failed: Vec<&Row> = rows.iter().filter(|row| !row.passed()).collect();
    for row in &failed {
        text += &format!("  off: {row}\n");
    }
    let failures: Vec<_> = failed.iter().map(|row| row.to_string()).collect();
    let value =
        json!({ "tolerance": FURNACE_TOLERANCE, "surfaces": surfaces, "failures": failures });
    Ok(Judged(text, value, failed.is_empty()))
}
