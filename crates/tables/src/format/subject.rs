//! The subject of a table, as data in its description: whose normals, under which masking and
//! reflectance, for which materials. Readers find tables by it; names are for people.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Masking, Skew};
use serde::{Deserialize, Serialize};

use super::kind::{Channels, Kind};
use super::stored::{Single, gamma_of};
use crate::interval::Interval;
use crate::{GAMMA_MIN, SIGMA_MAX};

/// Whose normals a table is of.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
        /// θx, θy, θz in radians, as for [`Skew::new`](microfacet_core::Skew::new).
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

    /// Checks the numbers; the error says what is wrong.
    fn check(&self) -> Result<(), String> {
        let (sigma, s) = match self {
            Self::Family => return Ok(()),
            Self::Distribution(label) if label.is_empty() => {
                return Err("a distribution without a label".into());
            }
            Self::Distribution(_) => return Ok(()),
            Self::StudentT { sigma, s } => (sigma, *s),
            Self::Ellipsoid { sigma, theta, s } => {
                Skew::new(*sigma, *theta).map_err(|why| format!("an ellipsoid: {why}"))?;
                (sigma, *s)
            }
        };
        check_shapes([s, s])?;
        if sigma.iter().all(|&sigma| sigma > 0.0 && sigma < f64::INFINITY) {
            Ok(())
        } else {
            Err(format!("sigma = {sigma:?} of its lobe must be finite and more than 0"))
        }
    }

    /// Whether G1 is clamped at one, as for a tilted lobe, of which less may be seen than of the
    /// macrosurface.
    pub const fn is_clamped(&self) -> bool {
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

    /// Checks the numbers; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        match self {
            Self::Moments => Ok(()),
            Self::Conductor { eta, k } => check_conductor(eta, k),
            Self::Dielectric { min, max, .. } => check_indices(*min, *max),
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Covered {
    /// Shapes, as [min, max] of 1/(γ−1).
    pub s: [f64; 2],
    /// Roughnesses, for tables that have an axis of σ.
    pub sigma: Option<[f64; 2]>,
}

/// Two numbers are the same within this after a coordinate and its inverse: 1/(γ−1) of the end of a
/// range may round to just outside it.
pub const SAME: f64 = 1e-9;

impl Covered {
    /// All of these γ, and of these σ for tables that have an axis of σ.
    pub fn of(gamma: Interval, sigma: Option<Interval>) -> Self {
        Self { s: [gamma.max, gamma.min].map(s_of_gamma), sigma: sigma.map(Into::into) }
    }

    /// The range of γ, with as few digits as s allows.
    pub fn gamma(&self) -> Interval {
        let [max, min] = self.s.map(gamma_of);
        Interval { min, max }
    }

    /// The range as part of names; empty for all that tables can cover.
    fn label(&self) -> String {
        let part = |name: &str, Interval { min, max }: Interval| {
            if min == max { format!("{name}_{min}") } else { format!("{name}_{min}_to_{max}") }
        };
        let (gamma, sigma) = (self.gamma(), self.sigma.map(Interval::from));
        let all = Interval { min: GAMMA_MIN, max: f64::INFINITY };
        if gamma == all && sigma.is_none_or(|sigma| sigma == Interval { min: 0.0, max: SIGMA_MAX })
        {
            return String::new();
        }
        let sigma = sigma.map(|sigma| part("sigma", sigma)).unwrap_or_default();
        joined_name(&[&part("gamma", gamma), &sigma])
    }

    /// Whether the shape s = 1/(γ−1) is among them.
    pub fn contains_shape(&self, s: f64) -> bool {
        within(self.s, s)
    }

    /// Whether the roughness σ is; false of tables without an axis of σ.
    pub fn contains_sigma(&self, sigma: f64) -> bool {
        self.sigma.is_some_and(|range| within(range, sigma))
    }
}

/// Checks a range of 1/(γ−1), which is 0 at γ = ∞ and stays under 2, for γ > 3/2.
pub(super) fn check_shapes([min, max]: [f64; 2]) -> Result<(), String> {
    if 0.0 <= min && min <= max && max < 2.0 {
        return Ok(());
    }
    let [min, max] = [max, min].map(gamma_of);
    Err(format!("gamma = [{min}, {max}] must ascend, from more than 3/2"))
}

/// Checks a range of σ, which may start at 0 where a texture has smooth points.
pub(super) fn check_roughness([min, max]: [f64; 2]) -> Result<(), String> {
    if 0.0 <= min && min <= max && max < f64::INFINITY {
        Ok(())
    } else {
        Err(format!("sigma = [{min}, {max}] must ascend, from 0 or more to a finite number"))
    }
}

/// Checks the complex index of refraction of a conductor.
pub(super) fn check_conductor(eta: &[f64; 3], k: &[f64; 3]) -> Result<(), String> {
    let finite = eta.iter().chain(k).all(|x| x.is_finite());
    if finite && eta.iter().all(|&eta| eta > 0.0) && k.iter().all(|&k| k >= 0.0) {
        Ok(())
    } else {
        Err(format!(
            "a conductor of eta = {eta:?} and k = {k:?}; eta must be more than 0 and k at least 0"
        ))
    }
}

/// Checks a range of indices of refraction of the dense side over the thin one.
pub(super) fn check_indices(min: f64, max: Option<f64>) -> Result<(), String> {
    let finite = (1.0..f64::INFINITY).contains(&min);
    if finite && max.is_none_or(|max| min <= max && max < f64::INFINITY) {
        Ok(())
    } else {
        let max = max.unwrap_or(f64::INFINITY);
        Err(format!("indices of refraction [{min}, {max}] must ascend, from 1 or more"))
    }
}

/// A name from its parts, without the empty ones.
pub fn joined_name(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
    parts.join("_")
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

    /// The name of a table of this kind: made of what it is of, with characters that file names can
    /// have. The moments, which nearly all albedos have, are left out.
    pub fn name(&self, kind: Kind) -> String {
        let reflectance = match self.reflectance {
            None | Some(Reflectance::Moments) => String::new(),
            Some(other) => other.label(),
        };
        let lobe = match &self.lobe {
            LobeEntry::Family => self.covers.map(|covers| covers.label()).unwrap_or_default(),
            LobeEntry::StudentT { sigma: [x, y], s } => {
                format!("gamma_{}_sigma_{x}_{y}", gamma_of(*s))
            }
            LobeEntry::Ellipsoid { sigma: [x, y], theta: [a, b, c], s } => {
                format!("gamma_{}_sigma_{x}_{y}_theta_{a}_{b}_{c}", gamma_of(*s))
            }
            LobeEntry::Distribution(label) => label.replace([':', ',', '/', '\\', ' '], "_"),
        };
        let masking = self.masking.map_or("", Masking::name);
        joined_name(&[kind.name(), masking, &reflectance, &lobe])
    }

    /// γ and σ, where they are single numbers.
    pub(super) fn single(&self) -> Single {
        let point = |[min, max]: [f64; 2]| (min == max).then_some(min);
        let covers = self.covers.as_ref();
        let (s, sigmas) = match self.lobe {
            LobeEntry::Family => (covers.and_then(|covers| point(covers.s)), None),
            LobeEntry::StudentT { sigma, s } => (Some(s), Some(sigma)),
            LobeEntry::Ellipsoid { s, .. } => (Some(s), None),
            LobeEntry::Distribution(_) => (None, None),
        };
        Single {
            gamma: s.map(gamma_of),
            sigma: covers.and_then(|covers| point(covers.sigma?)),
            is_lobe: self.lobe != LobeEntry::Family,
            sigmas,
        }
    }

    /// Checks the subject, and that it fits a kind of table; the error says what is wrong.
    pub(super) fn check(&self, kind: Kind) -> Result<(), String> {
        let albedo = kind.is_albedo();
        if albedo != self.masking.is_some() || albedo != self.reflectance.is_some() {
            return Err(
                "an albedo names the masking and the reflectance it is for, and no other table does"
                    .into(),
            );
        }
        let fits = match (kind, &self.lobe) {
            (Kind::Albedo, _) => true,
            (_, LobeEntry::Distribution(_)) => kind.is_radial(),
            (_, lobe) => *lobe == LobeEntry::Family && !kind.is_radial(),
        };
        if !fits {
            return Err(format!("{} tables are not of the lobe {:?}", kind.name(), self.lobe));
        }
        self.lobe.check()?;
        self.reflectance.iter().try_for_each(Reflectance::check)?;
        let Some(Covered { s, sigma }) = self.covers else { return Ok(()) };
        if self.lobe != LobeEntry::Family {
            return Err("only tables of the family cover a range".into());
        }
        check_shapes(s)
            .and(sigma.map_or(Ok(()), check_roughness))
            .map_err(|why| format!("the range that it covers: {why}"))
    }
}
