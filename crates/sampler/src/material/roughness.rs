//! The range of roughness that single precision can hold.

use microfacet_core::Roughness;
use microfacet_core::math::within;
use microfacet_tables::axis::LogRoughness;

use crate::error::MaterialError;

/// Outside this range the squares of stretched directions, and of normals made from them, leave
/// single precision. Albedo tables begin at its lower end.
pub(super) const SIGMAS: [f64; 2] = [LogRoughness::BAKED.first, 1e6];

pub(crate) fn checked(sigma: Roughness) -> Result<[f32; 2], MaterialError> {
    let [low, high] = SIGMAS.map(|end| end as f32);
    match sigma.0.into_iter().find(|sigma| !(low..=high).contains(&(*sigma as f32))) {
        Some(sigma) => Err(MaterialError::Sigma { sigma, range: SIGMAS }),
        None => Ok(sigma.0.map(|sigma| sigma as f32)),
    }
}

/// Both σ in [`SIGMAS`], NaN at its lower end.
#[inline(always)]
pub(crate) fn clamped(sigma: Roughness) -> [f32; 2] {
    sigma.0.map(|sigma| within(sigma as f32, SIGMAS.map(|end| end as f32)))
}
