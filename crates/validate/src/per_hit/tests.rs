//! What is right passes, and what is wrong by one or two per cent does not.

use microfacet_sampler::Tables;
use microfacet_tables::Kind;

use super::*;

fn options(samples: usize) -> Options {
    Options { samples, seed: 1, gamma_factor: 1.0, sigma_factor: 1.0 }
}

/// The result for views from some elevations.
fn judged(tables: &Tables, options: Options, thetas: impl Fn(f64) -> bool) -> Outcome<Report> {
    let family = tables.family().unwrap();
    let mut mixtures = mixtures(&family);
    mixtures.retain(|(_, theta)| thetas(*theta));
    run_some(tables, &family, &mixtures, options, &Stage::unwatched()).unwrap()
}

/// The smallest p for each range of γ.
fn least(outcome: &Outcome<Report>) -> Vec<f64> {
    let family = Tables::embedded().family().unwrap();
    let of = |gammas| outcome.reports.iter().find(|report| report.gammas == gammas).unwrap().p();
    family.gammas().map(of).collect()
}

#[test]
fn the_default_set_passes() {
    let outcome = judged(&Tables::embedded(), options(50_000), |_| true);
    assert!(outcome.passed(), "{:?}", outcome.reports);
    assert_eq!(outcome.reports.len(), 2 * THETAS.len());
}

/// By both tests: the χ² of normals alone, too.
#[test]
fn a_gamma_one_per_cent_off_is_rejected() {
    let off = Options { gamma_factor: 1.01, ..options(700_000) };
    let outcome = judged(&Tables::embedded(), off, |theta| theta > 1.5 && theta < 1.57);
    for p in least(&outcome) {
        assert!(p < 1e-3 * outcome.level, "{:?}", outcome.reports);
    }
    assert!(outcome.reports.iter().all(|report| !report.sound()));
}

#[test]
fn a_sigma_two_per_cent_off_is_rejected() {
    let off = Options { sigma_factor: 1.02, ..options(500_000) };
    let outcome = judged(&Tables::embedded(), off, |theta| theta > 0.1 && theta < 0.5);
    // Tails of a small γ are less concerned.
    assert!(least(&outcome)[0] < 1e-3 * outcome.level, "{:?}", outcome.reports);
    assert!(outcome.reports.iter().all(|report| !report.sound()));
}

/// One node of γ is wrong: most of the mixture is right.
#[test]
fn a_fault_at_one_gamma_is_found() {
    let whole = Tables::embedded();
    let mut tables = whole.tables().to_vec();
    for table in tables.iter_mut().filter(|table| table.kind == Kind::VisibleSlope) {
        let shapes = table.axes[0].nodes.len();
        let of_one = table.values.len() / shapes;
        // s around 0.3.
        table.values[5 * of_one..6 * of_one].iter_mut().for_each(|value| *value *= 0.9);
    }
    let tables = Tables::from_tables(whole.provenance().clone(), tables).unwrap();
    let outcome = judged(&tables, options(100_000), |theta| theta > 0.1 && theta < 1.0);
    let [wrong, right] = least(&outcome).try_into().unwrap();
    assert!(wrong < outcome.level && right > outcome.level, "{:?}", outcome.reports);
    // It is the mixture's parameters that show it.
    let first = &outcome.reports[0];
    assert!(first.parameters.p < 1e-3 * first.normals.p, "{first:?}");
}

#[test]
fn a_normal_that_is_none_rejects() {
    let cells = [4, 2];
    assert_eq!(cell(&cells, &[0.99, 1.0]), 7);
    assert_eq!(cell(&cells, &[0.0, 0.5]), 1);
    assert_eq!(cell(&cells, &[f64::NAN, 0.5]), 8);
}
