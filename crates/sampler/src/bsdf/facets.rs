//! Reflection off single facets, which conductors and coats share.

use glam::Vec3;
use microfacet_core::math::sqrt;
use microfacet_core::{Masking, saturated};

use super::mixture::Part;
use crate::material::{Facet, Reflecting};

/// The reflecting facets of a lobe.
pub(crate) struct Facets<'a, L: ?Sized> {
    pub(crate) lobe: &'a L,
    pub(crate) masking: Masking,
}

/// The reflection of light from one direction by facets of reflectance 1.
#[derive(Clone, Copy)]
pub(crate) struct White {
    /// The cosine v·m, at which facets have their reflectance.
    pub(super) cos: f32,
    /// f cos θ_l/pdf.
    pub(crate) weight: f32,
    /// The density; 0 where it was not asked for.
    pub(crate) pdf: f32,
}

// Without closures and in scalars: an array returned by a closure or in an `Option` goes through
// memory, written by one width and read by another, and the read stalls until earlier writes are
// done. That took longer than the arithmetic.
impl<L: Reflecting + ?Sized> Facets<'_, L> {
    /// A light off a facet drawn for the view, with its density if `PDF`, which takes a D; `None`
    /// where the light is not above the horizon.
    #[inline(always)]
    pub(crate) fn draw<const PDF: bool>(&self, v: Vec3, u: [f32; 2]) -> Option<(Vec3, White)> {
        let (m, share) = self.lobe.sample_reflecting_normal(v, u);
        let m = Vec3::from_array(m);
        let (facing, length2) = (v.dot(m), m.dot(m));
        let l = (2.0 * facing / length2) * m - v;
        if !(facing > 0.0 && l.z > 0.0) {
            return None;
        }
        let cos = facing / sqrt(length2);
        if PDF {
            return Some((l, White::new(self.lobe.facet(v, m, l, self.masking), share, cos)));
        }
        let weight = self.lobe.reflection_weight(v, l, self.masking) * share;
        Some((l, White { cos, weight, pdf: 0.0 }))
    }

    #[inline(always)]
    pub(crate) fn halfway(&self, v: Vec3, l: Vec3) -> White {
        let m = v + l;
        // The cosine is half the length: v·m = 1 + v·l = |m|²/2.
        let length2 = m.dot(m);
        // NaN or infinite directions reflect nothing.
        if !(length2 > 0.0 && length2 <= f32::MAX) {
            return White { cos: 0.0, weight: 0.0, pdf: 0.0 };
        }
        let facet = self.lobe.facet(v, m, l, self.masking);
        White::new(facet, self.lobe.reflecting_share(v), 0.5 * sqrt(length2))
    }
}

impl White {
    /// From a facet drawn from a `share` of the normals that the view sees.
    #[inline(always)]
    pub(super) fn new(facet: Facet, share: f32, cos: f32) -> Self {
        // The density may be `f32::MAX`, and the share small.
        let pdf = saturated(0.25 * facet.density / share);
        Self { cos, weight: facet.weight * share, pdf }
    }

    /// The part of a mixture for a reflectance by channel.
    #[inline(always)]
    pub(super) fn part<const N: usize>(&self, reflectance: [f32; N]) -> Part<N> {
        Part { weight: reflectance.map(|reflectance| reflectance * self.weight), pdf: self.pdf }
    }

    /// f, without the cosine.
    #[inline(always)]
    pub(crate) fn f<const N: usize>(&self, reflectance: [f32; N], l: Vec3) -> [f32; N] {
        // Reflectances are at most 1: only f of reflectance 1 can overflow.
        let white = self.part([1.0]).f(l)[0];
        reflectance.map(|reflectance| reflectance * white)
    }
}
