//! Reflection off single facets, which conductors and coats share.

use glam::Vec3;
use microfacet_core::math::sqrt;
use microfacet_core::{Masking, saturated};

use super::mixture::Part;
use crate::material::{Facet, MicrofacetDistribution};

/// Facets of a lobe that reflect.
#[derive(Clone, Copy)]
pub(super) struct Facets<'a, L> {
    pub(super) lobe: &'a L,
    pub(super) masking: Masking,
}

/// What facets of reflectance 1 do with the light of one direction.
#[derive(Clone, Copy)]
pub(super) struct White {
    /// The cosine v·m, at which facets have their reflectance.
    pub(super) cos: f32,
    /// f cos θ_l/pdf.
    weight: f32,
    /// The density of that light.
    pub(super) pdf: f32,
}

// Without closures and in scalars: an array that a closure returns, or that an `Option` carries,
// goes through memory, written by one width and read by another, and waits there for all that was
// written before. It took longer than the arithmetic.
impl<L: MicrofacetDistribution> Facets<'_, L> {
    /// A light off a facet drawn for the view; `None` where it is not above the horizon.
    #[inline(always)]
    pub(super) fn draw(&self, v: Vec3, u: [f32; 2]) -> Option<(Vec3, White)> {
        let (m, share) = self.lobe.sample_reflecting_normal(v, u);
        let (facing, length2) = (v.dot(m), m.dot(m));
        let l = (2.0 * facing / length2) * m - v;
        if !(facing > 0.0 && l.z > 0.0) {
            return None;
        }
        Some((l, White::new(self.lobe.facet(v, m, l, self.masking), share, facing / sqrt(length2))))
    }

    /// The facet halfway between a view and a light.
    #[inline(always)]
    pub(super) fn halfway(&self, v: Vec3, l: Vec3) -> White {
        let m = v + l;
        // The cosine is half the length: v·m = 1 + v·l = |m|²/2.
        let length2 = m.dot(m);
        // Not of what is NaN or infinite.
        if !(length2 > 0.0 && length2 <= f32::MAX) {
            return White { cos: 0.0, weight: 0.0, pdf: 0.0 };
        }
        let facet = self.lobe.facet(v, m, l, self.masking);
        White::new(facet, self.lobe.reflecting_share(v), 0.5 * sqrt(length2))
    }
}

impl White {
    /// Of a facet that is drawn from a share of the normals that the view sees.
    #[inline(always)]
    pub(super) fn new(facet: Facet, share: f32, cos: f32) -> Self {
        // The density may be `f32::MAX`, and the share small.
        let pdf = saturated(0.25 * facet.density / share);
        Self { cos, weight: facet.weight * share, pdf }
    }

    /// The same of a reflectance, in channels.
    #[inline(always)]
    pub(super) fn part<const N: usize>(&self, reflectance: [f32; N]) -> Part<N> {
        Part { weight: reflectance.map(|reflectance| reflectance * self.weight), pdf: self.pdf }
    }

    /// f, without the cosine.
    #[inline(always)]
    pub(super) fn f<const N: usize>(&self, reflectance: [f32; N], l: Vec3) -> [f32; N] {
        // Reflectances are at most 1: nothing else can pass the largest number.
        let white = self.part([1.0]).f(l)[0];
        reflectance.map(|reflectance| reflectance * white)
    }
}
