//! `validate --per-hit`: prints how lobes of σ and γ that differ from hit to hit were judged.

use serde_json::{Value, json};

use microfacet_report::words::command::query;
use microfacet_sampler::{Family, Tables};
use microfacet_validate::per_hit::{Options, QUANTITIES, Report, SIGMAS, Values, run, seconds};
use microfacet_validate::record::identity;
use microfacet_validate::stress::Worst;
use microfacet_validate::{Judged as _, LEVEL, Outcome as Found};

use super::{Done, Outcome, Result, print_json, summarize, verdict, watched};

/// Runs the tests; `source` is the option that gives the set to the queries that are printed.
pub(super) fn per_hit(
    tables: &Tables,
    family: &Family,
    options: Options,
    as_json: bool,
    source: &str,
) -> Outcome {
    let work = seconds(family, options);
    let judge = |stage| run(tables, family, options, &stage);
    let result = watched("validating", work, |meter| judge(meter.stage(work)))?;
    if as_json {
        print_json(&document(tables, &result, options, source)?)?;
        return Ok(Done::judged(result.passed()));
    }
    summarize(&text(&result, options, source))?;
    verdict(result.passed())
}

fn text(result: &Found<Report>, options: Options, source: &str) -> String {
    let reports = &result.reports;
    let [low, high] = SIGMAS;
    let mut text = format!(
        "sigma_x and sigma_y in [{low}, {high}], gamma and the azimuth of the view drawn for each normal\n\
         {} mixtures x {} normals, two chi-square tests each; a single test rejects below p = {:.3e}\n\
         smallest p {:.3e}, {} rejected; KS distance {:.2e}\n",
        reports.len(),
        options.samples,
        result.level,
        reports.first().map_or(1.0, |report| report.p()),
        result.rejected(),
        reports.iter().map(|report| report.ks).fold(0.0, f64::max),
    );
    for report in in_order(reports) {
        text += &format!(
            "  gamma {:14} theta {:.5}: p of normals {:.3e}, with sigma and gamma {:.3e}\n",
            range(report),
            report.theta,
            report.normals.p,
            report.parameters.p
        );
    }
    text += "largest errors, and the largest shares of what is allowed, of which one above 1 rejects:\n";
    let Values { errors, shares } = values(reports);
    for ((name, Worst { value, at }), share) in QUANTITIES.iter().zip(&errors).zip(shares) {
        text += &format!("  {name} {value:.2e}, {share:.2}: {}{source}\n", query(at));
    }
    if result.rejected() > 0 {
        text += "to tell chance from a defect, repeat it with other seeds (--seed) and more normals (--samples):\n\
                 chance goes away, and the p of a defect falls\n";
    }
    text
}

/// By falling γ and from above to the horizon.
fn in_order(reports: &[Report]) -> Vec<&Report> {
    let mut all: Vec<&Report> = reports.iter().collect();
    let key = |report: &Report| (-report.gammas[0], report.theta);
    all.sort_by(|a, b| key(a).partial_cmp(&key(b)).expect("numbers"));
    all
}

/// The shapes of a mixture, in words.
fn range(report: &Report) -> String {
    let [low, high] = report.gammas;
    format!("[{low}, {high}]")
}

/// Of all mixtures.
fn values(reports: &[Report]) -> Values {
    let mut all = Values::default();
    reports.iter().for_each(|report| all.merge(&report.values));
    all
}

fn document(
    tables: &Tables,
    result: &Found<Report>,
    options: Options,
    source: &str,
) -> Result<Value> {
    let mixture = |report: &Report| {
        json!({
            "gamma": range(report), "theta": report.theta, "p_normals": report.normals.p,
            "p_parameters": report.parameters.p, "ks": report.ks,
        })
    };
    let Values { errors, shares } = values(&result.reports);
    let error = |((name, Worst { value, at }), share): ((&&str, &Worst), f64)| {
        let query = query(at) + source;
        json!({ "quantity": name, "max": value, "share_of_allowed": share, "query": query })
    };
    Ok(json!({
        "set": identity(tables)?,
        "passed": result.passed(),
        "samples": options.samples,
        "gamma_factor": options.gamma_factor,
        "sigma": SIGMAS,
        "level": LEVEL,
        "level_of_one_test": result.level,
        "rejected": result.rejected(),
        "mixtures": in_order(&result.reports).into_iter().map(mixture).collect::<Value>(),
        "errors": QUANTITIES.iter().zip(&errors).zip(shares).map(error).collect::<Value>(),
    }))
}
