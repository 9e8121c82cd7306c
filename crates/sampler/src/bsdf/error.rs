//! Errors of making a BSDF.

use alloc::boxed::Box;
use alloc::format;
use alloc::string::String;
use core::fmt;

use microfacet_core::Masking;
use microfacet_tables::Range;

use crate::error::MaterialError;
use crate::material::LobeKey;

/// Why a BSDF cannot be made: a number outside its domain, or an albedo that the tables lack.
#[derive(Clone, PartialEq)]
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
    /// The tables have no albedo of a lobe for the compensation that was asked for.
    NoAlbedo {
        /// The lobe.
        lobe: Box<LobeKey>,
        /// The index of refraction of a dielectric.
        eta: Option<f64>,
        /// The form of masking.
        masking: Masking,
        /// Whether the round lobe of √(σx σy) could stand in.
        stand_in: bool,
    },
    /// A dielectric or plastic whose lobe is not round: albedos of dielectrics are tabulated for
    /// round lobes of the family alone.
    RoundOnly {
        /// Whether the round lobe of √(σx σy) could stand in.
        stand_in: bool,
    },
    /// The tables' error: a lobe, γ, σ, index or form of masking that they do not cover, or a name
    /// that they do not have.
    Material(MaterialError),
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
            Self::NoAlbedo { lobe, eta, masking, stand_in } => {
                write!(f, "the tables hold no albedo of this lobe, {lobe}")?;
                if let Some(eta) = eta {
                    write!(f, ", of a dielectric of index {eta}")?;
                }
                write!(f, " with {masking} masking, which compensation needs; bake it")?;
                if *stand_in {
                    write!(f, ", or let the round lobe stand in with `StandIn::Round`")?;
                }
                Ok(())
            }
            Self::RoundOnly { stand_in } => {
                let cure = match stand_in {
                    true => "let the round lobe stand in with `StandIn::Round`",
                    false => "take a lobe of the family, or a dielectric without compensation",
                };
                write!(
                    f,
                    "tables hold albedos of dielectrics for round lobes of the family alone; {cure}"
                )
            }
            Self::Material(why) => why.fmt(f),
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
    pub fn recipe(&self) -> Option<String> {
        let Self::NoAlbedo { lobe, eta, masking, .. } = self else { return None };
        let fresnel = match eta {
            Some(eta) => format!("{{ dielectric = {eta} }}"),
            None => "\"mirror\"".into(),
        };
        Some(lobe.recipe(&fresnel, *masking))
    }
}

impl From<MaterialError> for BindError {
    fn from(why: MaterialError) -> Self {
        Self::Material(why)
    }
}
