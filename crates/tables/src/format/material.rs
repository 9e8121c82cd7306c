//! The materials of a recipe, as a set lists them.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use microfacet_core::Masking;
use serde::{Deserialize, Serialize};

use super::lobe::LobeSpec;
use super::stored::{Range, Sigma};
use super::subject::{Reflectance, Side, check_conductor, check_indices};
use crate::axis::ReflectanceRoot;

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
    pub fresnel: Option<FresnelEntry>,
}

/// A material as files have it.
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
    fresnel: Option<FresnelEntry>,
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

/// The reflectance of a material's facets, as in its recipe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FresnelEntry {
    /// F = 1.
    Mirror,
    /// Schlick's approximation with this reflectance at normal incidence for red, green and blue,
    /// in [0, 1]; the moments of `albedo` tables serve every value. In files it is one number where
    /// the three are equal.
    Schlick(#[serde(with = "grey_or_rgb")] [f64; 3]),
    /// A conductor of complex index of refraction η + ik, relative to the outside, for red, green
    /// and blue.
    Conductor {
        /// η > 0.
        eta: [f64; 3],
        /// k ≥ 0.
        k: [f64; 3],
    },
    /// A dielectric with this index of refraction, > 0, relative to the outside.
    Dielectric(f64),
    /// Dielectrics of all indices of refraction from `min` ≥ 1 to `max`, relative to the outside.
    Dielectrics {
        /// Smallest.
        min: f64,
        /// Largest; `None` is ∞.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<f64>,
    },
}

/// Three numbers for red, green and blue, written as one number where they are equal.
mod grey_or_rgb {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged, expecting = "a number, or three for red, green and blue")]
    enum Form {
        Grey(f64),
        Rgb([f64; 3]),
    }

    pub(super) fn serialize<S: Serializer>(rgb: &[f64; 3], output: S) -> Result<S::Ok, S::Error> {
        let [r, g, b] = *rgb;
        if r == g && g == b { Form::Grey(r) } else { Form::Rgb(*rgb) }.serialize(output)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(input: D) -> Result<[f64; 3], D::Error> {
        Ok(match Form::deserialize(input)? {
            Form::Grey(grey) => [grey; 3],
            Form::Rgb(rgb) => rgb,
        })
    }
}

impl FresnelEntry {
    /// The reflectances of the tables that hold its albedo: one, or for a dielectric one per side,
    /// unless both sides are the same.
    pub fn tabulated(&self) -> Vec<Reflectance> {
        let Some([min, max]) = self.indices() else {
            return vec![match *self {
                Self::Conductor { eta, k } => Reflectance::Conductor { eta, k },
                // Every Schlick reflectance is made of the moments.
                _ => Reflectance::Moments,
            }];
        };
        let of =
            |side| Reflectance::Dielectric { side, min, max: (max < f64::INFINITY).then_some(max) };
        if max == 1.0 { vec![of(Side::Thin)] } else { Side::ALL.map(of).into() }
    }

    /// The indices [min, max] ⊂ [1, ∞] of the dense side over the thin one; `None` unless it is a
    /// dielectric.
    pub fn indices(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Dielectric(eta) => Some([eta.max(1.0 / eta); 2]),
            Self::Dielectrics { min, max } => Some([min, max.unwrap_or(f64::INFINITY)]),
            _ => None,
        }
    }

    /// The index of a dielectric, inside over outside; of a range, the middle in the coordinate
    /// [`ReflectanceRoot`]; `None` unless it is a dielectric.
    pub fn middle_index(&self) -> Option<f64> {
        if let Self::Dielectric(eta) = self {
            return Some(*eta);
        }
        let [a, b] = self.indices()?.map(|eta| ReflectanceRoot.coordinate(eta));
        Some(ReflectanceRoot.quantity(0.5 * (a + b)))
    }

    /// Checks the numbers; the error says what is wrong.
    fn check(&self) -> Result<(), String> {
        match self {
            Self::Mirror => Ok(()),
            Self::Schlick(f0) => match f0.iter().find(|f0| !(0.0..=1.0).contains(*f0)) {
                Some(f0) => Err(format!("schlick = {f0} must be from 0 to 1")),
                None => Ok(()),
            },
            Self::Conductor { eta, k } => check_conductor(eta, k),
            Self::Dielectric(eta) if *eta > 0.0 && *eta < f64::INFINITY => Ok(()),
            Self::Dielectric(eta) => {
                Err(format!("dielectric = {eta} must be finite and more than 0"))
            }
            Self::Dielectrics { min, max } => check_indices(*min, *max),
        }
    }
}

impl MaterialEntry {
    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        self.lobe.check()?;
        self.fresnel.iter().try_for_each(FresnelEntry::check)
    }

    /// The form of masking that it states; height-correlated if it states none.
    pub fn masking(&self) -> Masking {
        self.masking.unwrap_or_default()
    }
}
