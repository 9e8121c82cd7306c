//! Errors of making a BSDF, and of requests to the tables of a set by name.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use core::fmt;

use microfacet_core::{Masking, SkewError};
use microfacet_tables::Range;

use crate::error::{Covered, MaterialError};
use crate::material::{LobeKey, RadialError};

/// Why a BSDF, or a named material, cannot be made: a number outside its domain, an albedo that the
/// tables lack, or a name that they do not have.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum BindError {
    /// An index of refraction η or an extinction k outside its range, or NaN.
    Index {
        /// The parameter, `eta` or `k`.
        name: &'static str,
        /// The number given.
        value: f64,
        /// The smallest and the largest that are allowed.
        range: [f64; 2],
    },
    /// A reflectance outside [0, 1], or NaN.
    Reflectance {
        /// The parameter: `f0`, `tint` or `base`.
        name: &'static str,
        /// The number given.
        value: f32,
    },
    /// A share of light outside [0, 1], or NaN.
    Share {
        /// The parameter: `weight` of haze, or `share` of retroreflection.
        name: &'static str,
        /// The number given.
        value: f32,
    },
    /// A BSDF of which no retroreflection is reciprocal.
    NoRetroreflection {
        /// Whether it transmits light; else its lobe is tilted.
        transmits: bool,
    },
    /// The tables have no albedo of a lobe for the compensation that was asked for.
    NoAlbedo {
        /// The lobe.
        lobe: Box<LobeKey>,
        /// The index of refraction of a dielectric.
        eta: Option<f64>,
        /// The form of masking.
        masking: Masking,
        /// What the nearest table of dielectrics covers, of a dielectric.
        nearest: Option<Covered>,
        /// Whether the round lobe of √(σx σy) could stand in.
        stand_in: bool,
    },
    /// A dielectric or plastic whose lobe is tilted or outside the family: albedos of dielectrics
    /// are tabulated for upright lobes of the family alone.
    RoundOnly {
        /// Whether the round lobe of √(σx σy) could stand in.
        stand_in: bool,
    },
    /// A lobe, γ, σ, index or form of masking that the tables do not cover.
    Material(MaterialError),
    /// No material of that name in the set; `known` lists those it has.
    NoSuchMaterial {
        /// The name asked for.
        name: String,
        /// Names in the set.
        known: String,
    },
    /// A named material that has no albedo of its own in this set for the reflectance asked for.
    NoAlbedoOf(String),
    /// A named material whose distribution has no albedo of the kind that was asked for.
    OtherDistribution {
        /// The material.
        name: String,
        /// Its distribution.
        distribution: String,
    },
    /// A table of a material's own distribution is missing from the set.
    NoTable(String),
    /// A named material whose recipe states no reflectance, so that no BSDF follows from it.
    NoFresnel(String),
}

impl fmt::Display for BindError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { name, value, range } => {
                let range = Range(*range);
                write!(f, "{name} = {value}: an index of refraction must lie in {range}")?;
                if *name == "eta" { write!(f, "; n inside over n outside") } else { Ok(()) }
            }
            Self::Reflectance { name, value } => {
                write!(f, "{name} = {value}: a reflectance must lie in [0, 1]")
            }
            Self::Share { name, value } => {
                write!(f, "{name} = {value}: a share of light must lie in [0, 1]")
            }
            Self::NoRetroreflection { transmits: true } => write!(
                f,
                "a BSDF that transmits light cannot be retroreflective: the view would be turned for \
                 refraction as well, which sends light to the wrong side of the normal; take a \
                 conductor or plastic"
            ),
            Self::NoRetroreflection { transmits: false } => write!(
                f,
                "a tilted lobe cannot be retroreflective: reflecting the view is reciprocal only where \
                 half a turn about the normal leaves the lobe as it is; take an upright lobe \
                 (theta = 0), or state that a lobe or BSDF of your own is one by `is_symmetric`"
            ),
            Self::NoAlbedo { lobe, eta, masking, nearest, stand_in } => {
                write!(f, "the tables hold no albedo of this lobe, {lobe}")?;
                if let Some(eta) = eta {
                    write!(f, ", of a dielectric of index {eta}")?;
                }
                write!(f, " with {masking} masking, which compensation needs")?;
                if let Some(nearest) = nearest {
                    write!(f, "; the nearest that they hold is {nearest}")?;
                }
                if *stand_in {
                    write!(f, "; let the round lobe stand in with `StandIn::Round`, or")?;
                } else {
                    write!(f, ";")?;
                }
                write!(f, " bake a set from these lines:\n{}", recipe(lobe, *eta, *masking))
            }
            Self::RoundOnly { stand_in } => {
                let cure = match stand_in {
                    true => "let the round lobe stand in with `StandIn::Round`",
                    false => "take a lobe of the family, or a dielectric without compensation",
                };
                write!(
                    f,
                    "tables hold albedos of dielectrics for upright lobes of the family alone; {cure}"
                )
            }
            Self::Material(why) => why.fmt(f),
            Self::NoSuchMaterial { name, known } => {
                write!(f, "no material \"{name}\" in this set, which holds {known}")
            }
            Self::NoAlbedoOf(name) => {
                write!(f, "material \"{name}\" has no such albedo in this set")
            }
            Self::OtherDistribution { name, distribution } => write!(
                f,
                "material \"{name}\" is of the kind {distribution}, which has no dielectric albedo of \
                 its own; only upright Student-t lobes refract"
            ),
            Self::NoTable(name) => {
                write!(f, "table `{name}` is missing from this set; bake it again")
            }
            Self::NoFresnel(name) => write!(
                f,
                "material \"{name}\" states no reflectance; add a line to it in its recipe, such as \
                 `fresnel = {{ metal = \"gold\" }}` or `fresnel = {{ dielectric = 1.5 }}`, and bake it again"
            ),
        }
    }
}

microfacet_core::debug_in_words!(BindError);

impl core::error::Error for BindError {}

impl BindError {
    /// The lines of a recipe that add the missing albedo; `None` for other errors.
    #[must_use]
    pub fn recipe(&self) -> Option<String> {
        let Self::NoAlbedo { lobe, eta, masking, .. } = self else { return None };
        Some(recipe(lobe, *eta, *masking))
    }
}

/// The lines of a recipe's material whose bake has the albedo of a lobe.
fn recipe(lobe: &LobeKey, eta: Option<f64>, masking: Masking) -> String {
    let fresnel = match eta {
        Some(eta) => format!("{{ dielectric = {eta} }}"),
        None => "\"mirror\"".into(),
    };
    lobe.recipe(&fresnel, masking)
}

impl From<MaterialError> for BindError {
    fn from(why: MaterialError) -> Self {
        Self::Material(why)
    }
}

impl From<SkewError> for BindError {
    fn from(why: SkewError) -> Self {
        Self::Material(why.into())
    }
}

impl From<RadialError> for BindError {
    fn from(why: RadialError) -> Self {
        match why {
            RadialError::Sigma(why) => why.into(),
            RadialError::NoTable(name) => Self::NoTable(name),
        }
    }
}
