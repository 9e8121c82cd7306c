//! Errors of requests to the tables of a set.

use alloc::string::String;
use core::fmt;

use microfacet_core::{Masking, SkewError};
use microfacet_tables::{GAMMA_MIN, Range};

/// Why a set cannot give what was asked for: a lobe or an albedo.
#[derive(Clone, PartialEq)]
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
    /// The material's distribution has no albedo of the kind that was asked for.
    OtherDistribution {
        /// The material.
        name: String,
        /// Its distribution.
        distribution: String,
    },
    /// A table of a material's own distribution is missing from the set.
    NoTable(String),
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
        /// The dielectrics that are covered, for that form and any other.
        covered: String,
    },
    /// A matrix, or a roughness and angles, that describe no ellipsoid.
    Skew(SkewError),
    /// γ is legal but no tables of this set serve it; `covered` lists what they serve.
    NotCovered {
        /// The γ asked for.
        gamma: f64,
        /// The ranges or values that are covered.
        covered: String,
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
    /// No albedo table of this set covers the pair of σ and γ; `covered` lists the pairs that are
    /// covered.
    AlbedoNotCovered {
        /// The σ asked for.
        sigma: f64,
        /// The γ asked for.
        gamma: f64,
        /// The pairs that are covered.
        covered: String,
    },
    /// A material that has no albedo of its own in this set for the reflectance asked for.
    NoAlbedo(String),
    /// No material of that name in the set; `known` lists those it has.
    NoSuchMaterial {
        /// The name asked for.
        name: String,
        /// Names in the set.
        known: String,
    },
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
            Self::OtherDistribution { name, distribution } => write!(
                f,
                "material \"{name}\" is of the kind {distribution}, which has no dielectric albedo of \
                 its own; only round Student-t lobes refract"
            ),
            Self::NoTable(name) => {
                write!(f, "table `{name}` is missing from this set; bake it again")
            }
            Self::DielectricNotCovered { eta, sigma, gamma, masking, covered } => write!(
                f,
                "no table of this set holds the albedo of a dielectric of index {eta} (in [0, inf]) with sigma {sigma}, gamma {gamma} \
                 and {masking} masking; it holds {covered}"
            ),
            Self::Skew(why) => why.fmt(f),
            Self::NotCovered { gamma, covered } if *gamma < GAMMA_MIN => write!(
                f,
                "gamma = {gamma} is not covered by any tables, which begin at {GAMMA_MIN}: below, almost every visible normal \
                 lies within rounding of the horizon; this set serves {covered}; take gamma = {GAMMA_MIN} or more"
            ),
            Self::NotCovered { gamma, covered } => write!(
                f,
                "gamma = {gamma} is not covered by the tables of this set, which serve {covered}"
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
            Self::AlbedoNotCovered { sigma, gamma, covered } => write!(
                f,
                "sigma = {sigma:?} with gamma = {gamma} is not covered by the albedo tables of this set, which hold {covered}"
            ),
            Self::NoAlbedo(name) => {
                write!(f, "material \"{name}\" has no such albedo in this set")
            }
            Self::NoSuchMaterial { name, known } => {
                write!(f, "no material \"{name}\" in this set, which holds {known}")
            }
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
