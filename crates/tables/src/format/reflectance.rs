//! Reflectances of the facets of a material, or that a table of albedos is for.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use super::ensure;
use super::kind::{Channels, Kind};
use super::subject::Side;
use crate::axis::ReflectanceRoot;
use crate::interval::Interval;

/// The reflectance of the facets of a material, or that a table of albedos is for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reflectance {
    /// F = 1. Its table holds the moments, of which the albedos of every Schlick reflectance and of
    /// OpenPBR's metals are made.
    Mirror,
    /// Of a material: Schlick's approximation with this reflectance at normal incidence for red,
    /// green and blue, in [0, 1]. In files it is one number where the three are equal.
    Schlick(#[serde(with = "grey_or_rgb")] [f64; 3]),
    /// A conductor of complex index of refraction η + ik, relative to the outside, for red, green
    /// and blue.
    Conductor {
        /// η > 0.
        eta: [f64; 3],
        /// k ≥ 0.
        k: [f64; 3],
    },
    /// Of a material: a dielectric with this index of refraction, > 0, relative to the outside, or
    /// all those of a range from 1 or more.
    Dielectric(#[serde(with = "super::stored::range")] Interval),
    /// Of a table: a dielectric, or a range of them, from one side.
    Interface {
        /// The side from which it is seen.
        side: Side,
        /// The index ≥ 1 of the dense side over the thin one, up to ∞.
        index: Interval,
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

impl Reflectance {
    /// A dielectric of this index of refraction.
    pub const fn dielectric(eta: f64) -> Self {
        Self::Dielectric(Interval::point(eta))
    }

    /// Channels of albedo tables under this reflectance.
    pub const fn channels(&self) -> Channels {
        match self {
            Self::Mirror | Self::Schlick(_) => Kind::MOMENTS,
            Self::Conductor { .. } => Kind::RGB,
            Self::Dielectric(_) | Self::Interface { .. } => Kind::SHARES,
        }
    }

    /// The reflectances of the tables that hold its albedo: one, or for a dielectric one per side,
    /// unless both sides are the same.
    pub fn tabulated(&self) -> Vec<Self> {
        let Some(index) = self.indices() else {
            // Every Schlick reflectance is made of the moments.
            return vec![if let Self::Conductor { .. } = self { *self } else { Self::Mirror }];
        };
        let of = |side| Self::Interface { side, index };
        if index.max == 1.0 { vec![of(Side::Thin)] } else { Side::ALL.map(of).into() }
    }

    /// The part of a table's name that states the reflectance; empty for the moments, which nearly
    /// all tables of albedos hold.
    pub(super) fn label(&self) -> String {
        let list = |[r, g, b]: &[f64; 3]| format!("{r}_{g}_{b}");
        match self {
            Self::Conductor { eta, k } => format!("conductor_{}_k_{}", list(eta), list(k)),
            Self::Interface { side, index: Interval { min, max } } if min == max => {
                format!("dielectric_{min}_{}", side.name())
            }
            Self::Interface { side, index: Interval { min, max } } => {
                format!("dielectric_{min}_to_{max}_{}", side.name())
            }
            Self::Mirror | Self::Schlick(_) | Self::Dielectric(_) => String::new(),
        }
    }

    /// The indices in [1, ∞] of the dense side over the thin one; `None` unless it is a dielectric.
    pub fn indices(&self) -> Option<Interval> {
        match *self {
            Self::Dielectric(eta) if eta.is_point() => {
                Some(Interval::point(eta.min.max(1.0 / eta.min)))
            }
            Self::Dielectric(index) | Self::Interface { index, .. } => Some(index),
            _ => None,
        }
    }

    /// The side from which a table of a dielectric is seen; `None` of any other.
    pub const fn side(&self) -> Option<Side> {
        if let Self::Interface { side, .. } = *self { Some(side) } else { None }
    }

    /// The index of a dielectric, inside over outside; of a range, the middle in the coordinate
    /// [`ReflectanceRoot`]; `None` unless it is a dielectric.
    pub fn middle_index(&self) -> Option<f64> {
        let Self::Dielectric(eta) = self else { return None };
        if eta.is_point() {
            return Some(eta.min);
        }
        let [a, b] = [eta.min, eta.max].map(|eta| ReflectanceRoot.coordinate(eta));
        Some(ReflectanceRoot.quantity(0.5 * (a + b)))
    }

    /// Whether a table of this reflectance covers another.
    pub fn contains(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Interface { side, index }, Self::Interface { side: seen, index: within }) => {
                side == seen && index.contains(within.min) && index.contains(within.max)
            }
            _ => self == other,
        }
    }

    /// Checks that a table can be of this reflectance, and its numbers.
    ///
    /// # Errors
    /// A message that says what is wrong.
    pub fn check_of_table(&self) -> Result<(), String> {
        match self {
            Self::Schlick(_) | Self::Dielectric(_) => Err(format!(
                "an albedo is of the moments, a conductor or an interface, not {self:?}"
            )),
            _ => self.check(),
        }
    }

    /// Checks that a material can have this reflectance, and its numbers.
    pub(super) fn check_of_material(&self) -> Result<(), String> {
        match self {
            Self::Interface { .. } => Err("an interface is of a table, not of a material".into()),
            _ => self.check(),
        }
    }

    fn check(&self) -> Result<(), String> {
        match self {
            Self::Mirror => Ok(()),
            Self::Schlick(f0) => match f0.iter().find(|f0| !(0.0..=1.0).contains(*f0)) {
                Some(f0) => Err(format!("schlick = {f0} must be from 0 to 1")),
                None => Ok(()),
            },
            Self::Conductor { eta, k } => {
                let finite = eta.iter().chain(k).all(|x| x.is_finite());
                let sound = finite && eta.iter().all(|&x| x > 0.0) && k.iter().all(|&x| x >= 0.0);
                ensure(sound, || {
                    format!(
                        "a conductor of eta = {eta:?} and k = {k:?}; eta must be more than 0 and k \
                         at least 0"
                    )
                })
            }
            Self::Dielectric(eta) if eta.is_point() => {
                let eta = eta.min;
                ensure(eta > 0.0 && eta < f64::INFINITY, || {
                    format!("dielectric = {eta} must be finite and more than 0")
                })
            }
            Self::Dielectric(Interval { min, max })
            | Self::Interface { index: Interval { min, max }, .. } => {
                ensure(1.0 <= *min && *min < f64::INFINITY && min <= max, || {
                    format!("indices of refraction [{min}, {max}] must ascend, from 1 or more")
                })
            }
        }
    }
}
