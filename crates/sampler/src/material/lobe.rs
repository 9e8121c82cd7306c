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

impl Lobe {
    /// This lobe as a BSDF that only reflects should draw it: a member of the family of γ < 2
    /// [bounded](StudentT::bounded), every other lobe, and a mirror, as it is.
    ///
    /// For γ < 2 tails are so heavy that many visible normals, for γ < 1.8 most of them, reflect
    /// the view below the horizon, and their samples are lost. Bounding takes a millisecond here
    /// and about the time of another sample at each, and lowers the variance of a white furnace to
    /// 0.55 of its value at γ = 1.9 and to 0.07 at 1.51. For γ ≥ 2 it lowers it to between 0.3 and
    /// 0.65, which is for the renderer to choose. `docs/bsdf.md` has the figures.
    /// [`Tables::bsdf`](crate::Tables::bsdf) makes its conductors of it.
    ///
    /// ```
    /// # #[cfg(feature = "embedded")] {
    /// use microfacet_sampler::{Lobe, Tables};
    ///
    /// let tables = Tables::embedded();
    /// assert!(matches!(tables.lobe(0.3, 1.6)?.for_reflection(), Lobe::Bounded(_)));
    /// assert!(matches!(tables.lobe(0.3, 2.5)?.for_reflection(), Lobe::StudentT(_)));
    /// # }
    /// # Ok::<(), microfacet_sampler::MaterialError>(())
    /// ```
    #[must_use]
    pub fn for_reflection(self) -> Self {
        match self {
            Self::StudentT(lobe) if lobe.gamma() < 2.0 && !lobe.is_effectively_smooth() => {
                lobe.bounded().into()
            }
            lobe => lobe,
        }
    }
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
