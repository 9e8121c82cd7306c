//! Reflection off single facets, which conductors and coats share.

use glam::Vec3;
use microfacet_common::Masking;

use super::mixture::Part;
use crate::material::MicrofacetDistribution;
use crate::math::sqrt;

/// Facets of a lobe that reflect, by a reflectance that is a function of v·m.
#[derive(Clone, Copy)]
pub(super) struct Facets<'a, L, F> {
    pub(super) lobe: &'a L,
    pub(super) masking: Masking,
    pub(super) reflectance: F,
}

impl<L: MicrofacetDistribution, F: Fn(f32) -> [f32; N], const N: usize> Facets<'_, L, F> {
    /// A light that is reflected off a facet drawn for the view; `None` where it is not above the
    /// horizon.
    #[inline(always)]
    pub(super) fn draw(&self, v: Vec3, u: [f32; 2]) -> Option<(Vec3, Part<N>)> {
        let (m, share) = self.lobe.sample_reflecting_normal(v, u);
        let facing = v.dot(m);
        let l = 2.0 * facing * m - v;
        (facing > 0.0 && l.z > 0.0).then(|| (l, self.part(v, m, facing, l, share)))
    }

    /// The facet halfway between a view and a light.
    #[inline(always)]
    pub(super) fn halfway(&self, v: Vec3, l: Vec3) -> Part<N> {
        let m = v + l;
        // The cosine is half the length: v·m = 1 + v·l = |m|²/2.
        let length2 = m.dot(m);
        // Not of what is NaN.
        if !(length2 > 0.0) {
            return Part::NONE;
        }
        self.part(v, m, 0.5 * sqrt(length2), l, self.lobe.reflecting_share(v))
    }

    /// The facet `m`, of any length, at the cosine v·m, drawn from a share of the normals that `v`
    /// sees.
    #[inline(always)]
    fn part(&self, v: Vec3, m: Vec3, cos: f32, l: Vec3, share: f32) -> Part<N> {
        let facet = self.lobe.facet(v, m, l, self.masking);
        Part::reflected(facet, share, (self.reflectance)(cos))
    }
}
