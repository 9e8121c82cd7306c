//! The materials that a furnace runs: those named, and else what the set covers of a grid.

use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Interval, Kind};
use microfacet_validate::furnace::domains;

use crate::cli::{Failure, report};

const SIGMAS: [f64; 7] = [0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 3.0];
const GAMMAS: [f64; 8] = [1.501, 1.6, 2.0, 3.0, 5.0, 10.0, 40.0, f64::INFINITY];

/// Pairs of σ and γ, by γ. Where a list is empty, the grid stands for it, as far as the set covers
/// it.
///
/// # Errors
/// A named σ or γ that the set does not cover.
pub(super) fn materials(
    set: &Tables,
    masking: Masking,
    sigmas: &[f64],
    gammas: &[f64],
) -> Result<Vec<(f64, f64)>, Failure> {
    let product = |sigmas: &[f64], gammas: &[f64]| -> Vec<(f64, f64)> {
        gammas.iter().flat_map(|&g| sigmas.iter().map(move |&s| (s, g))).collect()
    };
    if !sigmas.is_empty() && !gammas.is_empty() {
        return Ok(product(sigmas, gammas));
    }
    let is_covered = |&(s, g): &(f64, f64)| set.albedo(s, g, masking).is_ok();
    let mut all: Vec<(f64, f64)> = Vec::new();
    for domain in domains(set, masking) {
        let sigmas =
            if sigmas.is_empty() { &within(&SIGMAS, domain.roughness.x()) } else { sigmas };
        let gammas = if gammas.is_empty() { &within(&GAMMAS, domain.gamma) } else { gammas };
        for pair in product(sigmas, gammas).into_iter().filter(is_covered) {
            if !all.contains(&pair) {
                all.push(pair);
            }
        }
    }
    // Stable: several tables of one γ keep their order.
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    // What is named and not covered is an error, and so is a set without albedos.
    let lost_sigma = sigmas.iter().find(|&&sigma| all.iter().all(|pair| pair.0 != sigma));
    let lost_gamma = gammas.iter().find(|&&gamma| all.iter().all(|pair| pair.1 != gamma));
    if all.is_empty() || lost_sigma.or(lost_gamma).is_some() {
        let sigma = *lost_sigma.or(sigmas.first()).unwrap_or(&SIGMAS[2]);
        let gamma = *lost_gamma.or(gammas.first()).unwrap_or(&GAMMAS[3]);
        let others = || set.tables().iter().any(|table| table.kind == Kind::Albedo);
        return Err(match set.albedo(sigma, gamma, masking) {
            Err(_) if domains(set, masking).is_empty() && others() => Failure(format!(
                "this set has no {masking} albedos of isotropic materials, which a furnace reads; `microfacet-bake inspect` shows those \
                 it has and their errors"
            )),
            Err(why) => why.into(),
            Ok(_) => Failure("no material of the grid is covered: give --sigma and --gamma".into()),
        });
    }
    if sigmas.is_empty() && gammas.is_empty() && all != product(&SIGMAS, &GAMMAS) {
        report(
            "note",
            format!(
                "these tables cover a part of the grid, or none: {} materials are run; name others with --sigma and --gamma",
                all.len()
            ),
        );
    }
    Ok(all)
}

/// The values of a grid in a range, or else its ends.
fn within(grid: &[f64], range: Interval) -> Vec<f64> {
    let inside: Vec<f64> = grid.iter().copied().filter(|&x| range.contains(x)).collect();
    if !inside.is_empty() {
        return inside;
    }
    if range.is_point() { vec![range.min] } else { vec![range.min, range.max] }
}
