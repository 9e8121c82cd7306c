//! The materials that a furnace runs: those named, and else what the set covers of a grid.

use microfacet_sampler::{Masking, Tables};
use microfacet_tables::{Interval, Kind, LobeSpec};
use microfacet_validate::furnace::domains;

use crate::cli::words::distinct;
use crate::cli::{Result, anyhow, note};

const SIGMAS: [f64; 7] = [0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 3.0];
const GAMMAS: [f64; 8] = [1.501, 1.6, 2.0, 3.0, 5.0, 10.0, 40.0, f64::INFINITY];

/// Pairs of σ and γ, by γ. An empty list stands for the values of the grid that the set covers.
///
/// # Errors
/// A named σ or γ that the set does not cover.
pub(super) fn materials(
    set: &Tables,
    masking: Masking,
    sigmas: &[f64],
    gammas: &[f64],
) -> Result<Vec<(f64, f64)>> {
    let product = |sigmas: &[f64], gammas: &[f64]| -> Vec<(f64, f64)> {
        gammas.iter().flat_map(|&g| sigmas.iter().map(move |&s| (s, g))).collect()
    };
    if !sigmas.is_empty() && !gammas.is_empty() {
        return Ok(product(sigmas, gammas));
    }
    let is_covered = |&(s, g): &(f64, f64)| set.albedo(s, g, masking).is_ok();
    let domains = domains(set, masking);
    let of_domain = |domain: &LobeSpec| {
        let or = |named: &[f64], grid: &[f64], range| match named {
            [] => within(grid, range),
            named => named.to_vec(),
        };
        let sigmas = or(sigmas, &SIGMAS, domain.roughness.x());
        product(&sigmas, &or(gammas, &GAMMAS, domain.gamma))
    };
    let mut all = distinct(domains.iter().flat_map(of_domain).filter(is_covered));
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
            Err(_) if domains.is_empty() && others() => anyhow!(
                "this set has no {masking} albedos of isotropic materials, which a furnace reads; \
                 `microfacet-bake inspect` shows those it has and their errors"
            ),
            Err(why) => why.into(),
            Ok(_) => anyhow!("no material of the grid is covered: give --sigma and --gamma"),
        });
    }
    if sigmas.is_empty() && gammas.is_empty() && all != product(&SIGMAS, &GAMMAS) {
        let count = all.len();
        note(format!(
            "these tables cover a part of the grid, or none: {count} materials are run; name \
             others with --sigma and --gamma"
        ));
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
