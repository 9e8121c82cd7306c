//! Any of the lobes.

use microfacet_core::Masking;

use super::delegate::forward;
use super::{
    Batch, Bounded, Ellipsoid, Facet, Ggx, LobeKey, MicrofacetDistribution, Radial, Reflecting,
    Smooth, StudentT, Tabulated,
};
use crate::error::BatchError;

/// Any of the lobes, as [`Tables::material`](crate::Tables::material) returns it for a name.
///
/// It implements [`MicrofacetDistribution`] by a branch in each function.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Lobe {
    /// A member of the Student-t family, from tables.
    StudentT(StudentT),
    /// GGX in closed form, where the set has no table of γ = 2.
    Ggx(Ggx),
    /// A tilted, turned member of the family.
    Ellipsoid(Ellipsoid),
    /// An isotropic distribution outside the family.
    Radial(Radial),
    /// A Student-t prepared for reflection.
    Bounded(Bounded),
    /// A smooth surface, σ = 0.
    Smooth(Smooth),
}

macro_rules! from {
    ($($lobe:ident),*) => {$(
        impl From<$lobe> for Lobe {
            fn from(lobe: $lobe) -> Self {
                Self::$lobe(lobe)
            }
        }
    )*};
}

from!(StudentT, Ggx, Ellipsoid, Radial, Bounded, Smooth);

macro_rules! each {
    ($lobe:ident, $one:ident => $call:expr) => {
        match $lobe {
            Lobe::StudentT($one) => $call,
            Lobe::Ggx($one) => $call,
            Lobe::Ellipsoid($one) => $call,
            Lobe::Radial($one) => $call,
            Lobe::Bounded($one) => $call,
            Lobe::Smooth($one) => $call,
        }
    };
}

forward!(#[inline] Lobe, each: MicrofacetDistribution, Reflecting, Tabulated, Batch);
