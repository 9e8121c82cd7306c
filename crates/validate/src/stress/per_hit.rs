//! The rules for lobes whose σ, or σ and γ, are given at a hit.

use microfacet_sampler::{Family, MaterialError, StudentT};

use super::checks::Checker;
use super::{Point, Report};

/// One view in this many is also tested with the lobes of a hit.
const EVERY: usize = 3;

/// Positions in [`LOBES`](super::LOBES).
const SIGMA: usize = 1;
const BOTH: usize = 2;

/// Tests some of the views with lobes that are given σ, or σ and γ, at a hit.
pub(super) fn per_hit(
    family: Option<&Family>,
    shape: &StudentT,
    sigma: [f32; 2],
    gamma: f64,
    rises: bool,
    views: &[Vec<Point>],
    report: &mut Report,
) -> Result<(), MaterialError> {
    let mut views: Vec<Vec<Point>> = views.iter().step_by(EVERY).cloned().collect();
    Checker::new(shape.with_roughness(sigma), SIGMA, sigma, gamma, rises, report)?.views(&views);
    let Some(family) = family else { return Ok(()) };
    // γ as single precision has it; a range that the family does not read is not tested.
    let lobe = family.at(sigma, gamma as f32);
    let taken = lobe.gamma();
    if (taken - gamma).abs() > 1e-6 * gamma && gamma < 1e18 {
        return Ok(());
    }
    views.iter_mut().flatten().for_each(|at| at.gamma = taken);
    // Of two ranges the first is that of whole distributions.
    let [whole, peeled] = {
        let mut ranges = family.gammas();
        [ranges.next(), ranges.next()]
    };
    let rises = match (whole, peeled) {
        (Some([low, _]), Some(_)) => lobe.gamma() >= low,
        _ => rises,
    };
    Checker::new(lobe, BOTH, sigma, taken, rises, report)?.views(&views);
    Ok(())
}
