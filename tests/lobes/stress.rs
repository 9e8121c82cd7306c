//! The stress test at a million corners and random points, and proof that it rejects damaged
//! tables.

use microfacet_baker::progress::Stage;
use microfacet_report::words::command::query;
use microfacet_sampler::Tables;
use microfacet_tables::Kind;
use microfacet_validate::stress;
use microfacet_validate::stress::{Report, Violation};

/// Errors that the documentation promises for σ ∈ [1e-4, 10]: G1, D, visible density, CDF; see
/// `docs/reliability.md`.
const PROMISED: [f64; 4] = [1e-5, 1e-4, 1e-3, 1e-4];

#[test]
fn a_million_points_break_no_rule() {
    let report = stress::run(&Tables::embedded(), 1_000_000, 1, &Stage::unwatched()).unwrap();
    let total = report.total();
    assert!(total.points >= 1_000_000);
    if let Some((rule, Violation { count, worst })) = total.violations.iter().next() {
        panic!("{rule}: {count} times, first {:e} at\n{}", worst.value, query(&worst.at));
    }
    // Every lobe, shape, view and roughness; lobes per hit take a third of the points.
    let regions = report.regions.as_flattened().as_flattened();
    assert!(regions.iter().all(|by_sigma| by_sigma.iter().all(|region| region.points > 0)));
    for region in regions.iter().map(|by_sigma| &by_sigma[0]) {
        for ((worst, promised), name) in region.errors.iter().zip(PROMISED).zip(stress::ERRORS) {
            assert!(worst.value <= promised, "{name}: {:e} at\n{}", worst.value, query(&worst.at));
        }
    }
}

/// The report of the embedded tables after `damage` to the values of one kind.
fn damaged(kind: Kind, damage: impl Fn(usize, &mut f32)) -> Report {
    let whole = Tables::embedded();
    let mut tables = whole.tables().to_vec();
    for table in tables.iter_mut().filter(|table| table.kind == kind) {
        table.values.iter_mut().enumerate().for_each(|(i, value)| damage(i, value));
    }
    let tables = Tables::from_tables(whole.provenance().clone(), tables).unwrap();
    stress::run(&tables, 0, 1, &Stage::unwatched()).unwrap()
}

#[test]
fn damaged_tables_are_caught() {
    // Every other node of G1/q two per cent too large.
    let larger = |i, value: &mut f32| *value *= if i % 4 == 0 { 1.02 } else { 1.0 };
    let total = damaged(Kind::Shadowing, larger).total();
    assert!(total.violations.contains_key("g1 rises with theta"), "{total:?}");
    assert!(total.errors[0].value > 1e-3);
    // All tilts a thousandth closer to the end.
    let closer = |i, value: &mut f32| *value *= if i % 2 == 0 { 0.999 } else { 1.0 };
    let total = damaged(Kind::VisibleSlope, closer).total();
    assert!(total.errors[3].value > PROMISED[3], "{total:?}");
}
