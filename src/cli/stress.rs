//! `validate --stress`: prints the report as a table by region.

use serde_json::{Value, json};

use microfacet_report::words::command::query;
use microfacet_sampler::Tables;
use microfacet_validate::stress::{
    ERRORS, LOBES, ROUGHNESSES, Region, Report, SHAPES, VIEWS, Violation, Worst, run, seconds,
};

use super::{Done, Outcome, print_json, summarize, verdict, watched};

/// Runs the test; `source` is the option that gives the set to the queries that are printed.
pub(super) fn stress(
    tables: &Tables,
    points: u64,
    seed: u64,
    as_json: bool,
    source: &str,
) -> Outcome {
    let work = seconds(tables, points);
    let report = watched("testing", work, |meter| run(tables, points, seed, &meter.stage(work)))?;
    let passed = report.total().violations.is_empty();
    if as_json {
        print_json(&document(&report, source))?;
        return Ok(Done::judged(passed));
    }
    summarize(&summary(&report, source))?;
    verdict(passed)
}

/// Regions with at least one point, and their names.
fn regions(report: &Report) -> impl Iterator<Item = ([&'static str; 4], &Region)> {
    let all = report.regions.as_flattened().as_flattened().as_flattened().iter().enumerate();
    let named = all.map(|(i, region)| {
        let (i, rough) = (i / ROUGHNESSES.len(), ROUGHNESSES[i % ROUGHNESSES.len()]);
        let (i, view) = (i / VIEWS.len(), VIEWS[i % VIEWS.len()]);
        ([LOBES[i / SHAPES.len()], SHAPES[i % SHAPES.len()], view, rough], region)
    });
    named.filter(|(_, region)| region.points > 0)
}

fn summary(report: &Report, source: &str) -> String {
    let mut text = format!(
        "{:14} {:12} {:14} {:9} {:>11} {:>10}",
        "lobe", "shape", "view", "sigma", "points", "violations"
    );
    ERRORS.iter().for_each(|error| text += &format!(" {error:>10}"));
    text.push('\n');
    for ([lobe, shape, view, rough], region) in regions(report) {
        let broken: u64 = region.violations.values().map(|violation| violation.count).sum();
        text +=
            &format!("{lobe:14} {shape:12} {view:14} {rough:9} {:>11} {broken:>10}", region.points);
        region.errors.iter().for_each(|worst| text += &format!(" {:>10.2e}", worst.value));
        text.push('\n');
    }
    text += "\nsigma: ordinary is [1e-4, 10], extreme [1e-8, 1e6]\nlargest errors among ordinary sigma:\n";
    for (i, error) in ERRORS.iter().enumerate() {
        let ordinary = regions(report).filter(|(name, _)| name[3] == ROUGHNESSES[0]);
        let worst =
            ordinary.map(|(_, region)| region.errors[i]).max_by(|a, b| a.value.total_cmp(&b.value));
        // Nothing was measured where no tilt can be compared, as below gamma = 1.8.
        if let Some(worst) = worst.filter(|worst| worst.value != 0.0) {
            text += &format!("  {error} {:.2e}: {}{source}\n", worst.value, query(&worst.at));
        }
    }
    let total = report.total();
    for (rule, Violation { count, worst }) in &total.violations {
        text += &format!("BROKEN {count} times: {rule}, at worst {:e}\n", worst.value);
        text += &format!("  {}{source}\n", query(&worst.at));
    }
    text + &format!("{} points\n", total.points)
}

fn document(report: &Report, source: &str) -> Value {
    let query = |worst: &Worst| query(&worst.at) + source;
    let error = |(name, worst): (&&str, &Worst)| json!({ "quantity": name, "max": worst.value, "query": query(worst) });
    let violation = |(rule, Violation { count, worst }): (&&str, &Violation)| json!({ "rule": rule, "count": count, "worst": worst.value, "query": query(worst) });
    let region = |([lobe, shape, view, sigma], region): ([&str; 4], &Region)| {
        json!({
            "lobe": lobe, "shape": shape, "view": view, "sigma": sigma, "points": region.points,
            "errors": ERRORS.iter().zip(&region.errors).map(error).collect::<Value>(),
            "violations": region.violations.iter().map(violation).collect::<Value>(),
        })
    };
    let Region { points, violations, .. } = report.total();
    let regions: Value = regions(report).map(region).collect();
    json!({ "passed": violations.is_empty(), "points": points, "regions": regions })
}
