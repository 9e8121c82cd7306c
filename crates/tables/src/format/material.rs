//! The materials of a recipe, as a set lists them.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use microfacet_core::shape::gamma_of_s;
use microfacet_core::{Masking, Skew};
use serde::{Deserialize, Serialize};

use super::subject::{
    LobeEntry, Reflectance, Side, check_conductor, check_indices, check_roughness, check_shapes,
};
use crate::axis::ReflectanceRoot;

/// A named material of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialEntry {
    /// Its name.
    pub name: String,
    /// σx and σy, as ranges [min, max] where a texture drives them.
    pub sigma: [[f64; 2]; 2],
    /// 1/(γ−1), so that γ = ∞ is the number 0; a range [min, max] likewise.
    pub s: [f64; 2],
    /// The distribution, such as `gtr:0.2,1.5`, of a material outside the Student-t family; `sigma`
    /// is then the scale of its tables, and `s` means nothing.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub distribution: String,
    /// The turn of an ellipsoid, θx, θy, θz in radians as for [`Skew::new`](microfacet_core::Skew::new); its
    /// σ and s are single numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta: Option<[f64; 3]>,
    /// The form of masking and shadowing that it states, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub masking: Option<Masking>,
    /// The reflectance of its facets, if it states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fresnel: Option<FresnelEntry>,
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

/// The middle of a range.
fn middle([min, max]: [f64; 2]) -> f64 {
    if min == max { min } else { 0.5 * (min + max) }
}

impl MaterialEntry {
    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        self.sigma.into_iter().try_for_each(check_roughness)?;
        check_shapes(self.s)?;
        self.fresnel.iter().try_for_each(FresnelEntry::check)?;
        let Some(theta) = self.theta else { return Ok(()) };
        let [[x, _], [y, _]] = self.sigma;
        let single = [self.sigma[0], self.sigma[1], self.s].iter().all(|[min, max]| min == max);
        if !single || !self.distribution.is_empty() {
            return Err("theta is for a Student-t lobe with single numbers of sigma and s".into());
        }
        Skew::new([x, y], theta).map(drop).map_err(|why| format!("theta = {theta:?}: {why}"))
    }

    /// σx and σy, at the middle of their ranges.
    pub fn sigma(&self) -> [f64; 2] {
        self.sigma.map(middle)
    }

    /// γ, at the middle of the range of s.
    pub fn gamma(&self) -> f64 {
        gamma_of_s(middle(self.s))
    }

    /// σ of the isotropic lobe that stands in for an anisotropic one: √(σx σy).
    pub fn round_sigma(&self) -> f64 {
        let [x, y] = self.sigma();
        if x == y { x } else { libm::sqrt(x * y) }
    }

    /// Whether it has no microfacets at all: σ = 0.
    pub fn is_smooth(&self) -> bool {
        self.sigma == [[0.0; 2]; 2]
    }

    /// Whether its lobe is GGX, which has closed forms.
    pub fn is_ggx(&self) -> bool {
        // Outside the family s has no meaning, and an ellipsoid reads tables.
        let family = self.distribution.is_empty() && self.theta.is_none();
        self.s == [1.0; 2] && family && !self.is_smooth()
    }

    /// The form of masking that it states; height-correlated if it states none.
    pub fn masking(&self) -> Masking {
        self.masking.unwrap_or_default()
    }

    /// The lobe of its albedo: the family's if it is round, or if it is anisotropic with a range,
    /// for which the round lobe of [`round_sigma`](Self::round_sigma) stands in.
    pub fn lobe(&self) -> LobeEntry {
        if !self.distribution.is_empty() {
            return LobeEntry::Distribution(self.distribution.clone());
        }
        let [x, y] = self.sigma;
        let (sigma, s) = ([x[0], y[0]], self.s[0]);
        let single = [x, y, self.s].into_iter().all(|[min, max]| min == max);
        match self.theta {
            Some(theta) => LobeEntry::Ellipsoid { sigma, theta, s },
            None if x != y && single => LobeEntry::StudentT { sigma, s },
            None => LobeEntry::Family,
        }
    }
}
