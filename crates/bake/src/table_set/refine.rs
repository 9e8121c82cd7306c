//! Refines albedo tables: adds nodes of the view until the error is met.

use microfacet_tables::{Precision, Table};

use crate::bake;
use crate::bake::albedo::{AlbedoError, AlbedoSpec, Nodes};
use crate::certify::albedo;
use crate::plan::AlbedoWork;
use crate::progress::Meter;

/// Where only the axis of cos θ can be refined, a doubling is kept if its error is at most this
/// share of the error before: otherwise the error has another cause, such as an axis of the
/// material. On a smooth curve six-point polynomials would reach a sixtieth; for indices near 1
/// (`docs/albedo.md`) 4.4e-4 falls by less than a fifth.
const WORTH: f64 = 0.8;

/// The certified albedo tables of a specification in several precisions.
pub(super) fn albedo_tables(
    spec: &AlbedoSpec,
    precisions: &[Precision],
    progress: &Meter,
) -> Result<Vec<Vec<Table>>, AlbedoError> {
    let work = AlbedoWork::new(spec);
    let interior = albedo::interior_references(spec, &progress.stage(work.interior))?;
    // The error in single precision, which has hardly any rounding, decides on refinement.
    let mut all = vec![Precision::F32];
    all.extend(precisions.iter().filter(|precision| **precision != Precision::F32));
    let asked = |sets: Vec<Vec<Table>>| {
        let of =
            |precision| all.iter().position(|other| other == precision).map(|i| sets[i].clone());
        precisions.iter().filter_map(of).collect()
    };
    // The work of doublings that was announced.
    let mut ahead = work.ahead(spec);
    let mut spec = spec.clone();
    let mut coarser: Option<(f64, Vec<Vec<Table>>)> = None;
    let mut kept = Nodes::default();
    let mut doubling = 0;
    let sets = loop {
        let work = AlbedoWork::new(&spec);
        if doubling > 0 {
            let known = ahead.min(work.doubling());
            ahead -= known;
            progress.expect(work.doubling() - known);
        }
        let AlbedoWork { nodes, edges, climbs, .. } = work;
        let baked = bake::albedo::bake_in(&spec, &all, &mut kept, &progress.stage(nodes))?;
        let full = baked[0].clone();
        let refinable = spec.refinable();
        // Where a table that could be refined has too large an error inside, none of its edges
        // makes it smaller. With one axis to refine, the next doubling is judged by this error.
        let is_too_coarse = doubling < spec.doublings()
            && refinable.len() > 1
            && albedo::exceeds(&spec, &full, &interior, spec.target())?;
        if is_too_coarse {
            progress.forget(edges + climbs);
        } else {
            let edges = albedo::edge_references(&spec, &full, &progress.stage(edges))?;
            let references = [&interior[..], &edges].concat();
            let climbs = climbs / all.len() as f64;
            let certify =
                |tables| albedo::certified(&spec, tables, &references, &progress.stage(climbs));
            let sets = baked.into_iter().map(certify).collect::<Result<Vec<_>, AlbedoError>>()?;
            let error = sets[0].iter().map(|table| table.certificate.worst()).fold(0.0, f64::max);
            match coarser.take() {
                Some((before, coarser)) if refinable.len() == 1 && error > WORTH * before => {
                    break coarser;
                }
                _ if error <= spec.target() || doubling == spec.doublings() => break sets,
                _ => coarser = Some((error, sets)),
            }
        }
        let mut coarsest = (0.0, spec.axes.len() - 1);
        for &axis in refinable.iter().filter(|_| refinable.len() > 1) {
            let missed = albedo::missed_by_half(&spec, &full[0], axis)?;
            if missed > coarsest.0 {
                coarsest = (missed, axis);
            }
        }
        spec = spec.refined(coarsest.1);
        doubling += 1;
    };
    progress.forget(ahead);
    Ok(asked(sets))
}
