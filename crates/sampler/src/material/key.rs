//! What tables of albedos know a lobe by.

use alloc::format;
use alloc::string::{String, ToString};
use core::fmt;

use microfacet_core::shape::s_of_gamma;
use microfacet_core::{Masking, Skew};
use microfacet_tables::{LobeEntry, SAME};

use super::matrix::Matrix;

/// What tables of albedos know a lobe by: its parameters, as data.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LobeKey {
    /// A round member of the Student-t family.
    Round {
        /// σ, 0 for a smooth surface.
        sigma: f64,
        /// γ.
        gamma: f64,
    },
    /// An anisotropic one.
    Anisotropic {
        /// σx and σy.
        sigma: [f64; 2],
        /// γ.
        gamma: f64,
    },
    /// An ellipsoid, by the entries p, q, r, x and y of its [`Skew`](crate::Skew).
    Tilted {
        /// The entries.
        matrix: [f32; 5],
        /// γ.
        gamma: f64,
    },
    /// A distribution outside the family, by its label, such as `gtr:0.2,1.5`.
    Distribution(String),
    /// A lobe that no table is of.
    Unknown,
}

impl LobeKey {
    pub(crate) fn of_family(sigma: [f32; 2], gamma: f64) -> Self {
        let [x, y] = sigma.map(written);
        if x == y {
            Self::Round { sigma: x, gamma }
        } else {
            Self::Anisotropic { sigma: [x, y], gamma }
        }
    }

    /// Whether a table that names its own lobe is of this one; roughness is compared in single
    /// precision, in which lobes take it.
    pub(crate) fn is(&self, entry: &LobeEntry) -> bool {
        let same = |gamma: f64, s: f64| (s_of_gamma(gamma) - s).abs() <= SAME * s;
        match (self, entry) {
            (Self::Anisotropic { sigma, gamma }, LobeEntry::StudentT { sigma: of, s }) => {
                same(*gamma, *s) && sigma.map(|x| x as f32) == of.map(|x| x as f32)
            }
            (Self::Tilted { matrix, gamma }, LobeEntry::Ellipsoid { sigma, theta, s }) => {
                let skew = Skew::new(*sigma, *theta).ok();
                let of = skew.and_then(|skew| Matrix::try_from(skew).ok());
                same(*gamma, *s) && of.is_some_and(|of| of.entries() == *matrix)
            }
            (Self::Distribution(label), LobeEntry::Distribution(of)) => label == of,
            _ => false,
        }
    }

    /// σ and γ of the round lobe that stands in where there is no table of this one: for an
    /// anisotropic or tilted lobe that of the same area in slopes, √(σx σy).
    pub(crate) fn round(&self) -> Option<[f64; 2]> {
        match self {
            Self::Round { sigma, gamma } => Some([*sigma, *gamma]),
            Self::Anisotropic { sigma: [x, y], gamma } => Some([libm::sqrt(x * y), *gamma]),
            Self::Tilted { matrix: [p, _, r, ..], gamma } => {
                Some([libm::sqrt(f64::from(*p) * f64::from(*r)), *gamma])
            }
            Self::Distribution(_) | Self::Unknown => None,
        }
    }

    /// Whether D grows without limit towards the horizon, as that of γ < 2 does.
    pub(crate) fn has_pole(&self) -> bool {
        match self {
            Self::Round { gamma, .. }
            | Self::Anisotropic { gamma, .. }
            | Self::Tilted { gamma, .. } => *gamma < 2.0,
            Self::Distribution(_) | Self::Unknown => false,
        }
    }

    /// A recipe's material of this lobe, as far as it knows it, with a reflectance.
    pub(crate) fn recipe(&self, fresnel: &str, masking: Masking) -> String {
        let lobe = match self {
            Self::Round { sigma, gamma } => format!("sigma = {sigma}\ngamma = {gamma}"),
            Self::Anisotropic { sigma: [x, y], gamma } => {
                format!("sigma = [{x}, {y}]\ngamma = {gamma}")
            }
            Self::Tilted { gamma, .. } => {
                format!("gamma = {gamma}\n# and the sigma and theta of its Skew")
            }
            Self::Distribution(label) => format!("# and the distribution {label}"),
            Self::Unknown => "# and the sigma and gamma of a lobe of the family".into(),
        };
        format!(
            "[[material]]\nname = \"another name\"\n{lobe}\nfresnel = {fresnel}\nmasking = \"{masking}\""
        )
    }
}

impl fmt::Display for LobeKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Round { sigma, gamma } => write!(f, "sigma = {sigma}, gamma = {gamma}"),
            Self::Anisotropic { sigma: [x, y], gamma } => {
                write!(f, "sigma = [{x}, {y}], gamma = {gamma}")
            }
            Self::Tilted { gamma, .. } => write!(f, "tilted, gamma = {gamma}"),
            Self::Distribution(label) => write!(f, "{label}"),
            Self::Unknown => write!(f, "of no known distribution"),
        }
    }
}

/// The number that was written where single precision has this one: 0.3, not 0.30000001192….
fn written(x: f32) -> f64 {
    x.to_string().parse().unwrap_or_else(|_| x.into())
}
