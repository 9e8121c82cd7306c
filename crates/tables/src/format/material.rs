//! The materials of a recipe, as a set lists them.

use alloc::string::String;

use microfacet_core::Masking;
use serde::{Deserialize, Serialize};

use super::lobe::LobeSpec;
use super::reflectance::Reflectance;
use super::stored::{Range, Sigma};

/// A named material of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "InFile", into = "InFile")]
pub struct MaterialEntry {
    /// Its name.
    pub name: String,
    /// Its lobe.
    pub lobe: LobeSpec,
    /// The form of masking and shadowing that it states, if any.
    pub masking: Option<Masking>,
    /// The reflectance of its facets, if it states one.
    pub fresnel: Option<Reflectance>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "MaterialEntry", deny_unknown_fields)]
struct InFile {
    name: String,
    sigma: Sigma,
    gamma: Range,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distribution: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    theta: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    masking: Option<Masking>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fresnel: Option<Reflectance>,
}

impl From<MaterialEntry> for InFile {
    fn from(MaterialEntry { name, lobe, masking, fresnel }: MaterialEntry) -> Self {
        let LobeSpec { roughness, gamma, theta, distribution } = lobe;
        let (sigma, gamma) = (roughness.into(), gamma.into());
        Self { name, sigma, gamma, distribution, theta, masking, fresnel }
    }
}

impl From<InFile> for MaterialEntry {
    fn from(InFile { name, sigma, gamma, distribution, theta, masking, fresnel }: InFile) -> Self {
        let (roughness, gamma) = (sigma.into(), gamma.into());
        let lobe = LobeSpec { roughness, gamma, theta, distribution };
        Self { name, lobe, masking, fresnel }
    }
}

impl MaterialEntry {
    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        self.lobe.roughness.check()?;
        self.lobe.check()?;
        self.fresnel.iter().try_for_each(Reflectance::check_of_material)
    }

    /// The form of masking that it states; height-correlated if it states none.
    pub fn masking(&self) -> Masking {
        self.masking.unwrap_or_default()
    }
}
