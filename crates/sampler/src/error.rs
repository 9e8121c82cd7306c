//! Errors of requests to the tables of a set, by numbers.

use core::fmt;

use microfacet_core::{Masking, SkewError};
use microfacet_tables::{GAMMA_MIN, Range};

/// Why a set cannot give a lobe or an albedo, in numbers: what was asked for, and what comes
/// nearest.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum MaterialError {
    /// A roughness, or an entry of an ellipsoid's matrix, out of the range of single precision, or
    /// NaN.
    Sigma {
        /// The roughness asked for.
        sigma: f64,
        /// The smallest and the largest that are allowed: [1e-8, 1e6], for an ellipsoid's matrix
        /// [1e-18, 1e18].
        range: [f64; 2],
    },
    /// γ ≤ 3/2 or NaN: no member of the family.
    Gamma(f64),
    /// A matrix, or a roughness and angles, that describe no ellipsoid.
    Skew(SkewError),
    /// γ is legal but no tables of this set serve it; [`Tables::shapes`](crate::Tables::shapes)
    /// lists all that they serve.
    NotCovered {
        /// The γ asked for.
        gamma: f64,
        /// The nearest below and above that are covered.
        nearest: [Option<f64>; 2],
    },
    /// The set has no tables over a range of γ, as [`Tables::family`](crate::Tables::family) reads.
    NoRange,
    /// The set has albedos of single materials alone, none over a range of σ, as
    /// [`Tables::family_albedo`](crate::Tables::family_albedo) and
    /// [`Tables::shape_albedo`](crate::Tables::shape_albedo) read.
    NoAlbedoRange,
    /// The set has no albedos of dielectrics of this index over a range of σ, as
    /// [`Tables::family_dielectric`](crate::Tables::family_dielectric) reads.
    NoDielectricRange {
        /// The index of refraction, inside over outside.
        eta: f64,
        /// The form of masking asked for.
        masking: Masking,
        /// What the nearest table of dielectrics covers, if there is any.
        nearest: Option<Covered>,
    },
    /// The set has no albedo tables for this form of masking.
    MaskingNotCovered {
        /// The form asked for.
        masking: Masking,
        /// The form that the set has tables for, if any.
        other: Option<Masking>,
    },
    /// The albedo tables that hold γ do not hold σ.
    SigmaNotCovered {
        /// The σ asked for.
        sigma: f64,
        /// The smallest and the largest σ that the tables hold, apart from 0, a mirror.
        range: [f64; 2],
    },
    /// No albedo table of this set covers the pair of σ and γ.
    AlbedoNotCovered {
        /// The σ asked for.
        sigma: f64,
        /// The γ asked for.
        gamma: f64,
        /// What the nearest table covers, if there is any.
        nearest: Option<Covered>,
    },
    /// No table of the set holds the albedo of this dielectric.
    DielectricNotCovered {
        /// The index of refraction, inside over outside.
        eta: f64,
        /// Its σ.
        sigma: f64,
        /// Its γ.
        gamma: f64,
        /// The form of masking asked for.
        masking: Masking,
        /// What the nearest table covers, if there is any.
        nearest: Option<Covered>,
    },
    /// A given table is of another kind than asked for, or does not hold the material.
    OtherTable {
        /// The σ asked for.
        sigma: f64,
        /// The γ asked for.
        gamma: f64,
    },
}

/// The materials whose albedos a table holds: each range from the smallest to the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Covered {
    /// Shapes.
    pub gamma: [f64; 2],
    /// Roughnesses.
    pub sigma: [f64; 2],
    /// Whether σ = 0, a mirror, is among them.
    pub mirror: bool,
    /// Indices of refraction, of a table of dielectrics.
    pub eta: Option<[f64; 2]>,
    /// The form of masking.
    pub masking: Masking,
}

impl fmt::Display for Covered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { gamma, sigma, mirror, eta, masking } = self;
        if let Some(eta) = eta {
            write!(f, "index {} with ", Range(*eta))?;
        }
        let zero = if *mirror { "0 or " } else { "" };
        write!(f, "gamma {} with sigma {zero}{}", Range(*gamma), Range(*sigma))?;
        if eta.is_some() { write!(f, " and {masking} masking") } else { Ok(()) }
    }
}

/// What the nearest table covers, at the end of a sentence.
struct Nearest<'a>(&'a Option<Covered>);

impl fmt::Display for Nearest<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(covered) => write!(f, "; the nearest that it holds is {covered}"),
            None => write!(f, "; it holds none"),
        }
    }
}

/// The nearest shapes that a set serves, in a sentence.
struct Served<'a>(&'a [Option<f64>; 2]);

impl fmt::Display for Served<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |gamma: f64| Range([gamma; 2]);
        match *self.0 {
            [Some(low), Some(high)] => {
                write!(f, "the nearest that this set serves are {} and {}", at(low), at(high))
            }
            [Some(one), None] | [None, Some(one)] => {
                write!(f, "the nearest that this set serves is {}", at(one))
            }
            [None, None] => write!(f, "this set serves none"),
        }
    }
}

impl fmt::Display for MaterialError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sigma { sigma, range } => write!(
                f,
                "sigma = {sigma:?}: a roughness must lie in {}; below, treat the surface as smooth",
                Range(*range)
            ),
            Self::Gamma(x) => write!(
                f,
                "gamma = {x}: the shape must lie in (1.5, inf]; 2 is GGX, inf is Beckmann"
            ),
            Self::Skew(why) => why.fmt(f),
            Self::NotCovered { gamma, nearest } if *gamma < GAMMA_MIN => write!(
                f,
                "gamma = {gamma} is not covered by any tables, which begin at {GAMMA_MIN}: below, almost every visible normal \
                 lies within rounding of the horizon; {}; take gamma = {GAMMA_MIN} or more",
                Served(nearest)
            ),
            Self::NotCovered { gamma, nearest } => write!(
                f,
                "gamma = {gamma} is not covered by the tables of this set; {}",
                Served(nearest)
            ),
            Self::NoRange => f.write_str(
                "the set has no tables over a range of gamma, from which lobes of any gamma are \
                 read: bake a material whose gamma is a range, such as \
                 gamma = { min = 1.6, max = \"inf\" }, or use `student_t` for the shapes that it has",
            ),
            Self::NoAlbedoRange => f.write_str(
                "the set has no albedos over a range of sigma, from which those of any sigma are \
                 read: bake a material whose sigma is a range and that has a fresnel, such as \
                 sigma = { min = 0.05, max = 1 }, fresnel = \"mirror\", or use `albedo` for the \
                 materials that it has",
            ),
            Self::NoDielectricRange { eta, masking, nearest } => write!(
                f,
                "the set has no albedos of dielectrics of index {eta} over a range of sigma, with {masking} masking{}: bake a \
                 material whose sigma is a range, such as sigma = {{ min = 0.05, max = 1 }}, \
                 fresnel = {{ dielectric = {eta} }}, masking = \"{masking}\"",
                Nearest(nearest)
            ),
            Self::MaskingNotCovered { masking, other: Some(other) } => {
                write!(f, "this set has no albedo tables for {masking} masking, only for {other}")
            }
            Self::MaskingNotCovered { masking, other: None } => {
                write!(f, "this set has no albedo tables for {masking} masking, nor for any other")
            }
            Self::SigmaNotCovered { sigma, range } => write!(
                f,
                "sigma = {sigma:?} is not covered by the albedo tables of this set, which hold {} and 0, a mirror; clamp it, or \
                 bake a set whose recipe holds it",
                Range(*range)
            ),
            Self::AlbedoNotCovered { sigma, gamma, nearest } => write!(
                f,
                "sigma = {sigma:?} with gamma = {gamma} is not covered by the albedo tables of this set{}",
                Nearest(nearest)
            ),
            Self::DielectricNotCovered { eta, sigma, gamma, masking, nearest } => write!(
                f,
                "no table of this set holds the albedo of a dielectric of index {eta} (in [0, inf]) with sigma {sigma}, gamma {gamma} \
                 and {masking} masking{}",
                Nearest(nearest)
            ),
            Self::OtherTable { sigma, gamma } => write!(
                f,
                "the table does not hold the albedo of sigma = {sigma} and gamma = {gamma}"
            ),
        }
    }
}

microfacet_core::debug_in_words!(MaterialError);

impl core::error::Error for MaterialError {}

impl From<SkewError> for MaterialError {
    fn from(why: SkewError) -> Self {
        Self::Skew(why)
    }
}

/// The slices of a batch differ in length.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct BatchError {
    /// Names of two parameters that differ.
    pub slices: [&'static str; 2],
    /// Their lengths.
    pub lengths: [usize; 2],
}

impl fmt::Display for BatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([a, b], [n, m]) = (self.slices, self.lengths);
        write!(
            f,
            "a batch of {n} `{a}` and {m} `{b}`: all slices must have the same length; cut the longer one"
        )
    }
}

microfacet_core::debug_in_words!(BatchError);

impl core::error::Error for BatchError {}

pub(crate) fn same_lengths(slices: &[(&'static str, usize)]) -> Result<(), BatchError> {
    let (first, expected) = slices[0];
    match slices.iter().find(|(_, length)| *length != expected) {
        None => Ok(()),
        Some(&(other, length)) => {
            Err(BatchError { slices: [first, other], lengths: [expected, length] })
        }
    }
}
