//! The second lobe of a material, beside its core.

use alloc::format;
use alloc::string::String;

use serde::{Deserialize, Serialize};

use super::ensure;
use super::lobe::LobeSpec;
use super::stored::{Range, Sigma};
use crate::interval::Interval;

/// The second lobe of a material, and its weight w: what the material scatters is w times what this
/// lobe scatters, and 1 − w times what its core does.
///
/// Both lobes have the reflectance and the form of masking of the material, so that its albedo is
/// that mixture of the two albedos. The haze is usually the wider lobe; nothing depends on that.
///
/// `D` describes a distribution outside the Student-t family, as in [`LobeSpec`].
#[derive(Clone, Debug, PartialEq)]
pub struct Haze<D = String> {
    /// The weight in [0, 1]; a range if a texture drives it.
    pub weight: Interval,
    /// The lobe.
    pub lobe: LobeSpec<D>,
}

impl<D> Haze<D> {
    /// The same haze with another description of its distribution.
    pub fn map<E>(&self, distribution: impl FnOnce(&D) -> E) -> Haze<E> {
        Haze { weight: self.weight, lobe: self.lobe.map(distribution) }
    }
}

impl Haze {
    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        check_share("weight", self.weight)?;
        self.lobe.roughness.check()?;
        self.lobe.check()
    }
}

/// Checks that a share ascends within [0, 1]; NaN does not.
pub(super) fn check_share(name: &str, Interval { min, max }: Interval) -> Result<(), String> {
    ensure(0.0 <= min && min <= max && max <= 1.0, || {
        format!("{name} = [{min}, {max}] must ascend, within 0 and 1")
    })
}

/// A haze as files state it, with the keys of a material's lobe.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object of `weight`, `sigma` and `gamma`")]
pub(super) struct InFile {
    weight: Range,
    sigma: Sigma,
    gamma: Range,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distribution: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    theta: Option<[f64; 3]>,
}

impl From<Haze> for InFile {
    fn from(Haze { weight, lobe }: Haze) -> Self {
        let LobeSpec { roughness, gamma, theta, distribution } = lobe;
        let (weight, sigma, gamma) = (weight.into(), roughness.into(), gamma.into());
        Self { weight, sigma, gamma, distribution, theta }
    }
}

impl From<InFile> for Haze {
    fn from(InFile { weight, sigma, gamma, distribution, theta }: InFile) -> Self {
        let (roughness, gamma) = (sigma.into(), gamma.into());
        Self { weight: weight.into(), lobe: LobeSpec { roughness, gamma, theta, distribution } }
    }
}
