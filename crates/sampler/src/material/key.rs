//! The keys of lobes in tables of albedos.

use alloc::format;
use alloc::string::{String, ToString};
use core::fmt;

use microfacet_core::{Masking, Skew};
use microfacet_tables::LobeSpec;

use super::matrix::Matrix;

/// Whether D of a shape grows without limit towards the horizon.
#[inline(always)]
pub(super) fn has_pole(gamma: f64) -> bool {
    gamma < 2.0
}

/// The key of a lobe in tables of albedos: its parameters.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LobeKey {
    /// An upright lobe of the Student-t family, σ = 0 for a smooth surface; or a distribution
    /// outside it, by its label, such as `gtr:0.2,1.5`.
    Upright(LobeSpec),
    /// An ellipsoid, by the entries p, q, r, x and y of its [`Skew`](crate::Skew).
    Tilted {
        /// The entries.
        matrix: [f32; 5],
        /// γ.
        gamma: f64,
    },
    /// A lobe of which there is no table.
    Unknown,
}

impl LobeKey {
    pub(crate) fn of_family(sigma: [f32; 2], gamma: f64) -> Self {
        Self::Upright(LobeSpec::student_t(sigma.map(written), gamma))
    }

    /// Whether the lobe is round and of the family.
    #[must_use]
    pub fn is_round(&self) -> bool {
        matches!(self, Self::Upright(lobe) if lobe.is_family())
    }

    /// Whether a table that names a lobe is of this one; a tilt is compared in single precision.
    pub(crate) fn is(&self, table: &LobeSpec) -> bool {
        match self {
            Self::Upright(lobe) => !lobe.is_family() && table.contains(lobe),
            Self::Tilted { matrix, gamma } => {
                let skew = table.theta.and_then(|theta| Skew::new(table.sigma(), theta).ok());
                let of = skew.and_then(|skew| Matrix::try_from(skew).ok());
                table.contains_shape(*gamma) && of.is_some_and(|of| of.entries() == *matrix)
            }
            Self::Unknown => false,
        }
    }

    /// σ and γ of the round lobe that may replace this one where it has no table: for an
    /// anisotropic or tilted lobe that of the same area in slopes, √(σx σy).
    pub(crate) fn round(&self) -> Option<[f64; 2]> {
        match self {
            Self::Upright(lobe) if lobe.distribution.is_none() => {
                Some([lobe.round_sigma(), lobe.gamma()])
            }
            Self::Tilted { matrix: [p, _, r, ..], gamma } => {
                Some([libm::sqrt(f64::from(*p) * f64::from(*r)), *gamma])
            }
            _ => None,
        }
    }

    /// Whether D grows without limit towards the horizon, as that of γ < 2 does.
    pub(crate) fn has_pole(&self) -> bool {
        self.round().is_some_and(|[_, gamma]| has_pole(gamma))
    }

    /// The lines of a recipe's material of this lobe, as far as the key gives them, with a
    /// reflectance.
    pub(crate) fn recipe(&self, fresnel: &str, masking: Masking) -> String {
        let lobe = match self {
            Self::Upright(LobeSpec { distribution: Some(label), .. }) => {
                format!("# and the distribution {label}")
            }
            Self::Upright(lobe) => format!("sigma = {}\ngamma = {}", sigma(lobe), lobe.gamma()),
            Self::Tilted { gamma, .. } => {
                format!("gamma = {gamma}\n# and the sigma and theta of its Skew")
            }
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
            Self::Upright(LobeSpec { distribution: Some(label), .. }) => f.write_str(label),
            Self::Upright(lobe) => write!(f, "sigma = {}, gamma = {}", sigma(lobe), lobe.gamma()),
            Self::Tilted { gamma, .. } => write!(f, "tilted, gamma = {gamma}"),
            Self::Unknown => write!(f, "of no known distribution"),
        }
    }
}

/// σ as recipes write it.
fn sigma(lobe: &LobeSpec) -> String {
    match lobe.sigma() {
        [x, y] if x == y => x.to_string(),
        [x, y] => format!("[{x}, {y}]"),
    }
}

/// The shortest decimal number that is `x` in single precision: 0.3, not 0.30000001192….
fn written(x: f32) -> f64 {
    x.to_string().parse().unwrap_or_else(|_| x.into())
}
