//! The rules for lobes and albedos whose σ, or σ and γ, are given at a hit.

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::{Family, Masking, MaterialError, StudentT, Tables};

use super::checks::Checker;
use super::{Point, Report};

/// One view in this many is also tested with the lobes of a hit.
const EVERY: usize = 3;

/// Positions in [`LOBES`](super::LOBES).
const SIGMA: usize = 1;
const BOTH: usize = 2;

/// What is read at a hit, prepared once.
pub(super) struct Families {
    /// A set of single shapes has none.
    lobes: Option<Family>,
    /// One for each form of masking that the set has.
    albedos: Vec<FamilyAlbedo>,
}

impl Families {
    pub(super) fn of(tables: &Tables) -> Self {
        let albedos = Masking::ALL.into_iter().filter_map(|form| tables.family_albedo(form).ok());
        Self { lobes: tables.family().ok(), albedos: albedos.collect() }
    }
}

/// Tests some of the views with lobes that are given σ, or σ and γ, at a hit.
pub(super) fn per_hit(
    families: &Families,
    shape: &StudentT,
    sigma: [f32; 2],
    gamma: f64,
    rises: bool,
    views: &[Vec<Point>],
    report: &mut Report,
) -> Result<(), MaterialError> {
    let mut views: Vec<Vec<Point>> = views.iter().step_by(EVERY).cloned().collect();
    Checker::new(shape.with_roughness(sigma), SIGMA, sigma, gamma, rises, report)?.views(&views);
    let Some(family) = &families.lobes else { return Ok(()) };
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
    let mut checker = Checker::new(lobe, BOTH, sigma, taken, rises, report)?;
    checker.views(&views);
    let round = (sigma[0] * sigma[1]).sqrt();
    for points in &views {
        for albedo in &families.albedos {
            checker.albedo_at_hit(&albedo.at(round, gamma as f32), &points[points.len() / 2]);
        }
    }
    Ok(())
}
