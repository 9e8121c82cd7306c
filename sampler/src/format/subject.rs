//! The subject of a table, as data in its description: whose normals, under which masking and
//! reflectance, for which materials. Readers find tables by it; names are for people.

use alloc::format;
use alloc::string::String;

use microfacet_common::Masking;
use serde::{Deserialize, Serialize};

use super::schema::{Channels, Kind};

/// Whose normals a table is of.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LobeEntry {
    /// The members of the Student-t family that the axes reach; for albedos, the round ones.
    #[default]
    Family,
    /// One anisotropic Student-t lobe.
    StudentT {
        /// σx and σy.
        sigma: [f64; 2],
        /// 1/(γ−1).
        s: f64,
    },
    /// One lobe that is tilted and turned.
    Ellipsoid {
        /// σx and σy.
        sigma: [f64; 2],
        /// θx, θy, θz in radians, as for [`Skew::new`](crate::Skew::new).
        theta: [f64; 3],
        /// 1/(γ−1).
        s: f64,
    },
    /// An isotropic distribution outside the family, by its label, such as `gtr:0.2,1.5`.
    Distribution(String),
}

impl LobeEntry {
    /// The kind of lobe in a word, or the label of a distribution.
    pub fn name(&self) -> &str {
        match self {
            Self::Family | Self::StudentT { .. } => "student-t",
            Self::Ellipsoid { .. } => "ellipsoid",
            Self::Distribution(label) => label,
        }
    }

    /// Whether G1 is clamped at one, as for a tilted lobe, of which less may be seen than of the
    /// macrosurface.
    pub(crate) const fn is_clamped(&self) -> bool {
        matches!(self, Self::Ellipsoid { .. })
    }
}

/// The side from which a dielectric is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The side of the smaller index of refraction; refraction enters the dense side.
    Thin,
    /// The side of the larger index, with total reflection beyond the critical angle.
    Dense,
}

impl Side {
    /// Both sides.
    pub const ALL: [Self; 2] = [Self::Thin, Self::Dense];

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Thin => "thin",
            Self::Dense => "dense",
        }
    }
}

/// The reflectance of the facets that an albedo is for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reflectance {
    /// F = 1 and its parts, which give every Schlick reflectance and OpenPBR's metals.
    Moments,
    /// A conductor of complex index of refraction η + ik, relative to the outside, for red, green
    /// and blue.
    Conductor {
        /// η > 0.
        eta: [f64; 3],
        /// k ≥ 0.
        k: [f64; 3],
    },
    /// A dielectric, or a range of them, by the index of the dense side over the thin one.
    Dielectric {
        /// The side from which it is seen.
        side: Side,
        /// Smallest index, ≥ 1.
        min: f64,
        /// Largest; `None` is ∞.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<f64>,
    },
}

impl Reflectance {
    /// Channels of albedo tables under this reflectance.
    pub const fn channels(&self) -> Channels {
        match self {
            Self::Moments => Kind::MOMENTS,
            Self::Conductor { .. } => Kind::RGB,
            Self::Dielectric { .. } => Kind::SHARES,
        }
    }

    /// A label that tells it from others, for people and in names.
    pub fn label(&self) -> String {
        let list = |[r, g, b]: &[f64; 3]| format!("{r}_{g}_{b}");
        match self {
            Self::Moments => "moments".into(),
            Self::Conductor { eta, k } => format!("conductor_{}_k_{}", list(eta), list(k)),
            Self::Dielectric { side, min, max } => match max {
                Some(max) if max == min => format!("dielectric_{min}_{}", side.name()),
                _ => {
                    format!("dielectric_{min}_to_{}_{}", max.unwrap_or(f64::INFINITY), side.name())
                }
            },
        }
    }

    /// Indices [min, max] ⊂ [1, ∞] of the dense side over the thin one; `None` unless it is a
    /// dielectric.
    pub fn indices(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Dielectric { min, max, .. } => Some([min, max.unwrap_or(f64::INFINITY)]),
            _ => None,
        }
    }

    /// The side from which it is seen; `None` unless it is a dielectric.
    pub const fn side(&self) -> Option<Side> {
        match *self {
            Self::Dielectric { side, .. } => Some(side),
            _ => None,
        }
    }
}

/// The materials that a table was baked and measured for; its axes may have nodes beyond, which
/// interpolation reads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Covered {
    /// Shapes, as [min, max] of 1/(γ−1).
    pub s: [f64; 2],
    /// Roughnesses, for tables that have an axis of σ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma: Option<[f64; 2]>,
}

/// Two numbers are the same within this after a coordinate and its inverse: 1/(γ−1) of the end of a
/// range may round to just outside it.
pub(crate) const SAME: f64 = 1e-9;

impl Covered {
    /// Whether the shape s = 1/(γ−1) is among them.
    pub(crate) fn contains_shape(&self, s: f64) -> bool {
        within(self.s, s)
    }

    /// Whether the roughness σ is; false of tables without an axis of σ.
    pub(crate) fn contains_sigma(&self, sigma: f64) -> bool {
        self.sigma.is_some_and(|range| within(range, sigma))
    }
}

fn within([min, max]: [f64; 2], x: f64) -> bool {
    x >= min - SAME * min && x <= max + SAME * max
}

/// What a table is of, besides its kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subject {
    /// Whose normals it is of.
    pub lobe: LobeEntry,
    /// The form of G2 of an albedo; `None` where values depend on one direction only.
    pub masking: Option<Masking>,
    /// The reflectance of an albedo.
    pub reflectance: Option<Reflectance>,
    /// The materials, for tables of more than one.
    pub covers: Option<Covered>,
}

impl Subject {
    /// The subject of a table of one direction over a range of shapes.
    pub fn shapes(s: [f64; 2]) -> Self {
        Self { covers: Some(Covered { s, sigma: None }), ..Self::default() }
    }

    /// Checks the subject against a kind of table; the error says what is wrong.
    pub(super) fn check(&self, kind: Kind) -> Result<(), &'static str> {
        let albedo = kind.is_albedo();
        if albedo != self.masking.is_some() || albedo != self.reflectance.is_some() {
            return Err(
                "an albedo names the masking and the reflectance it is for, and no other table does",
            );
        }
        if let Some([min, max]) = self.reflectance.and_then(|reflectance| reflectance.indices())
            && !(1.0 <= min && min <= max)
        {
            return Err("indices of refraction must ascend from 1 or more");
        }
        let ascend = |[min, max]: [f64; 2]| 0.0 <= min && min <= max && max < f64::INFINITY;
        match self.covers {
            Some(Covered { s, sigma }) if !ascend(s) || !sigma.is_none_or(ascend) => {
                Err("the range that it covers must ascend")
            }
            _ => Ok(()),
        }
    }
}
