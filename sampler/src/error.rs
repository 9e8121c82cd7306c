//! Errors of a table file, and of requests to the tables it holds.

use alloc::string::String;
use core::fmt;

use microfacet_common::SkewError;

/// Why bytes are not a table set that this crate can use.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadError {
    /// The bytes contradict the format: truncated, damaged, or describing something impossible.
    Invalid(String),
    /// A file that may be valid but that this version cannot read: another version of the format,
    /// or nodes at places that no reader here expects.
    Unsupported(String),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(why) => write!(f, "not a valid table set: {why}"),
            Self::Unsupported(why) => write!(f, "table set not supported: {why}"),
        }
    }
}

impl core::error::Error for LoadError {}

/// Why a set cannot give what was asked for: a lobe or an albedo.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialError {
    /// `sigma` outside [1e-8, 1e6] or NaN.
    Sigma(f64),
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
    /// No table of the set holds the albedo of this dielectric: its index, σ and γ.
    Dielectric([f64; 3]),
    /// A matrix, or a roughness and angles, of no ellipsoid.
    Skew(SkewError),
    /// γ is legal but no table of `kind` covers it; `covered` lists what the set holds.
    NotCovered {
        /// The table kind that was looked for.
        kind: &'static str,
        /// The γ asked for.
        gamma: f64,
        /// The ranges or values that are covered.
        covered: String,
    },
    /// σ is legal but beyond the albedo tables, which reach to `max`.
    SigmaNotCovered {
        /// The σ asked for.
        sigma: f64,
        /// The largest that is covered.
        max: f64,
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
    /// A material that has no albedo of its own in this set.
    NoAlbedo {
        /// The material.
        name: String,
        /// Why, and what helps.
        remedy: &'static str,
    },
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
            Self::Sigma(x) => write!(
                f,
                "sigma = {x}: a roughness must lie in [1e-8, 1e6]; below, treat the surface as smooth"
            ),
            Self::Gamma(x) => {
                write!(
                    f,
                    "gamma = {x}: the shape must lie in (1.5, inf]; 2 is GGX, inf is Beckmann"
                )
            }
            Self::OtherDistribution { name, distribution } => write!(
                f,
                "material \"{name}\" is of the kind {distribution}, which has no dielectric albedo of \
                 its own; only round Student-t lobes refract"
            ),
            Self::NoTable(name) => {
                write!(f, "table `{name}` is missing from this set; bake it again")
            }
            Self::Dielectric([eta, sigma, gamma]) => write!(
                f,
                "no table of this set holds the albedo of a dielectric of index {eta} (more than 0) with sigma {sigma} and gamma {gamma}; add \
                 `fresnel = {{ dielectric = {eta} }}` to the recipe's material, or a range of indices, and bake it again"
            ),
            Self::Skew(why) => why.fmt(f),
            Self::NotCovered { kind, gamma, covered } => write!(
                f,
                "gamma = {gamma} is not covered by the `{kind}` tables of this set, which hold {covered}; bake a set that \
                 does: a recipe line `gamma = {gamma}`, or `microfacet-bake bake` without a recipe for all of [1.501, inf]"
            ),
            Self::SigmaNotCovered { sigma, max } => write!(
                f,
                "sigma = {sigma} is not covered by the albedo tables of this set, which hold [0, {max}]; clamp it, or \
                 bake a set whose recipe holds it"
            ),
            Self::AlbedoNotCovered { sigma, gamma, covered } => write!(
                f,
                "sigma = {sigma} with gamma = {gamma} is not covered by the albedo tables of this set, which hold {covered}; bake a \
                 set that does: a recipe's material with `fresnel`, or `microfacet-bake bake` without a recipe for all"
            ),
            Self::NoAlbedo { name, remedy } => {
                write!(f, "material \"{name}\" has no such albedo in this set: {remedy}")
            }
            Self::NoSuchMaterial { name, known } => write!(
                f,
                "no material \"{name}\" in this set, which holds {known} (smooth materials have no microfacets and are not \
                 listed); to add it, append to its recipe, with its own roughness and shape, and bake again:\n\
                 [[material]]\nname = \"{name}\"\nsigma = 0.3\ngamma = 3.0"
            ),
        }
    }
}

impl core::error::Error for MaterialError {}

impl From<SkewError> for MaterialError {
    fn from(why: SkewError) -> Self {
        Self::Skew(why)
    }
}

/// The slices of a batch differ in length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

impl core::error::Error for BatchError {}
