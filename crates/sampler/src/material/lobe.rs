//! Any of the lobes.

use microfacet_core::Masking;

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

impl MicrofacetDistribution for Lobe {
    #[inline]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32 {
        each!(self, lobe => lobe.d(m))
    }

    #[inline]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32 {
        each!(self, lobe => lobe.g1(v))
    }

    #[inline]
    fn reflection_weight(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> f32 {
        each!(self, lobe => lobe.reflection_weight(v, l, masking))
    }

    #[inline]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3] {
        each!(self, lobe => lobe.sample_visible_normal(v, u))
    }

    #[inline]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        each!(self, lobe => lobe.visible_normal_pdf(v, m))
    }

    #[inline]
    fn facet(
        &self,
        v: impl Into<[f32; 3]>,
        m: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> Facet {
        each!(self, lobe => lobe.facet(v, m, l, masking))
    }

    fn is_effectively_smooth(&self) -> bool {
        each!(self, lobe => lobe.is_effectively_smooth())
    }
}

impl Reflecting for Lobe {
    #[inline]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        each!(self, lobe => lobe.sample_reflecting_normal(v, u))
    }

    #[inline]
    fn reflecting_share(&self, v: impl Into<[f32; 3]>) -> f32 {
        each!(self, lobe => lobe.reflecting_share(v))
    }
}

impl Tabulated for Lobe {
    fn table_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32 {
        each!(self, lobe => lobe.table_pdf(v, m))
    }

    fn key(&self) -> LobeKey {
        each!(self, lobe => lobe.key())
    }

    #[inline]
    fn has_pole(&self) -> bool {
        each!(self, lobe => lobe.has_pole())
    }

    fn bytes(&self) -> usize {
        each!(self, lobe => lobe.bytes())
    }
}

impl Batch for Lobe {
    fn sample_batch<V: Copy + Into<[f32; 3]>, M: From<[f32; 3]>>(
        &self,
        v: &[V],
        u: &[[f32; 2]],
        m: &mut [M],
    ) -> Result<(), BatchError> {
        each!(self, lobe => lobe.sample_batch(v, u, m))
    }

    fn g1_batch<V: Copy + Into<[f32; 3]>>(
        &self,
        v: &[V],
        g1: &mut [f32],
    ) -> Result<(), BatchError> {
        each!(self, lobe => lobe.g1_batch(v, g1))
    }
}
