//! The range of roughness that single precision can hold.

use microfacet_common::Roughness;

use crate::axis::LogRoughness;
use crate::error::MaterialError;

/// Outside this range the squares of stretched directions, and of normals made from them, leave
/// single precision. Albedo tables begin at its lower end.
const SIGMAS: core::ops::RangeInclusive<f32> = LogRoughness::BAKED.first as f32..=1e6;

/// σx and σy in single precision.
pub(crate) fn checked(sigma: Roughness) -> Result<[f32; 2], MaterialError> {
    match sigma.0.into_iter().find(|sigma| !SIGMAS.contains(&(*sigma as f32))) {
        Some(sigma) => Err(MaterialError::Sigma(sigma)),
        None => Ok(sigma.0.map(|sigma| sigma as f32)),
    }
}
