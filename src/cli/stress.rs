//! `validate --stress`: prints the report as a table by region.

use serde_json::json;

use microfacet_baker::progress::Meter;
use microfacet_report::words::command::query;
use microfacet_sampler::Tables;
use microfacet_validate::stress::{
    ERRORS, ROUGHNESSES, Region, Report, SHAPES, VIEWS, run, seconds,
};

use super::{Done, Outcome, print_json, progress, summarize, verdict};

/// Runs the test; `source` is the option that gives the set to the queries that are printed.
pub(super) fn stress(
    tables: &Tables,
    points: u64,
    seed: u64,
    as_json: bool,
    source: &str,
) -> Outcome {
    let meter = Meter::default();
    let work = seconds(tables, points);
    meter.expect(work);
    let bar = progress::show(&meter, "testing");
    let report = run(tables, points, seed, &meter.stage(work))?;
    drop(bar);
    let passed = report.total().violations.is_empty();
    if as_json {
        print_json(&document(&report, source))?;
        return Ok(Done::judged(passed));
    }
    summarize(&summary(&report, source))?;
    verdict(passed)
}

/// Regions with at least one point, and their names.
fn regions(report: &Report) -> impl Iterator<Item = ([&'static str; 3], &Region)> {
    let of_view = |shape: usize, view: usize| {
        let row = &report.regions[shape][view];
        row.iter()
            .zip(ROUGHNESSES)
            .map(move |(region, rough)| ([SHAPES[shape], VIEWS[view], rough], region))
    };
    let all = (0..SHAPES.len())
        .flat_map(move |shape| (0..VIEWS.len()).flat_map(move |view| of_view(shape, view)));
    all.filter(|(_, region)| region.points > 0)
}

fn summary(report: &Report, source: &str) -> String {
    let mut text =
        format!("{:12} {:14} {:9} {:>11} {:>10}", "shape", "view", "sigma", "points", "violations");
    ERRORS.iter().for_each(|error| text += &format!(" {error:>10}"));
    text.push('\n');
    for ([shape, view, rough], region) in regions(report) {
        let broken: u64 = region.violations.values().map(|violation| violation.count).sum();
        text += &format!("{shape:12} {view:14} {rough:9} {:>11} {broken:>10}", region.points);
        region.errors.iter().for_each(|worst| text += &format!(" {:>10.2e}", worst.value));
        text.push('\n');
    }
    text += "\nsigma: ordinary is [1e-4, 10], extreme [1e-8, 1e6]\nlargest errors among ordinary sigma:\n";
    for (i, error) in ERRORS.iter().enumerate() {
        let ordinary = regions(report).filter(|(name, _)| name[2] == ROUGHNESSES[0]);
        let worst =
            ordinary.map(|(_, region)| region.errors[i]).max_by(|a, b| a.value.total_cmp(&b.value));
        // Nothing was measured where no tilt can be compared, as below gamma = 1.8.
        if let Some(worst) = worst.filter(|worst| worst.value != 0.0) {
            text += &format!("  {error} {:.2e}: {}{source}\n", worst.value, query(&worst.at));
        }
    }
    let total = report.total();
    for (rule, violation) in &total.violations {
        text += &format!(
            "BROKEN {} times: {rule}, at worst {:e}",
            violation.count, violation.worst.value
        );
        text += &format!("\n  {}{source}\n", query(&violation.worst.at));
    }
    text + &format!("{} points\n", total.points)
}

fn document(report: &Report, source: &str) -> serde_json::Value {
    let regions: Vec<_> = regions(report)
        .map(|([shape, view, sigma], region)| {
            let errors: Vec<_> = ERRORS
                .iter()
                .zip(&region.errors)
                .map(|(name, worst)| json!({ "quantity": name, "max": worst.value, "query": format!("{}{source}", query(&worst.at)) }))
                .collect();
            let violations: Vec<_> = region
                .violations
                .iter()
                .map(|(rule, found)| json!({ "rule": rule, "count": found.count, "worst": found.worst.value, "query": format!("{}{source}", query(&found.worst.at)) }))
                .collect();
            json!({
                "shape": shape, "view": view, "sigma": sigma, "points": region.points,
                "errors": errors, "violations": violations,
            })
        })
        .collect();
    let total = report.total();
    json!({ "passed": total.violations.is_empty(), "points": total.points, "regions": regions })
}
