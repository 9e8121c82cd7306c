//! Reflection off a lobe without Fresnel: sampler, evaluation and density.

use glam::Vec3;
use microfacet_core::math::sqrt;
use microfacet_core::{Masking, saturated};

use super::distribution::{Facet, MicrofacetDistribution};
use crate::vector::vec3;

/// Reflection off a lobe whose facets reflect all light: a sampler, and f with the density of what
/// it draws.
///
/// All functions are provided, by visible normals; a lobe that leaves out normals which reflect the
/// view below the horizon, as [`Bounded`](crate::lobe::Bounded) does, has the first two of its own.
/// Directions are unit vectors in the tangent frame, n = +z.
///
/// ```
/// use microfacet_sampler::lobe::Reflecting;
/// use microfacet_sampler::{Ggx, Masking};
///
/// let (ggx, v, masking) = (Ggx::new(0.3)?, [0.6, 0.0, 0.8], Masking::HeightCorrelated);
/// let (l, weight) = ggx.sample_reflected(v, [0.3, 0.7], masking).expect("above the horizon");
/// let (f, pdf) = ggx.eval_pdf(v, l, masking);
/// assert!((f * l[2] / pdf - weight).abs() < 1e-5);
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
pub trait Reflecting: MicrofacetDistribution {
    /// A visible normal for reflection alone, of any length, and the
    /// [share](Self::reflecting_share) of `v`.
    ///
    /// The light is 2 (v·m)/(m·m) m − v, which is shorter to compute than the unit normal. Where
    /// v·m is not positive, rounding has put the normal behind the silhouette, and no light is
    /// reflected. Lobes may leave out normals that reflect the view below the horizon; all others
    /// keep their density, divided by the share.
    #[must_use]
    #[inline(always)]
    fn sample_reflecting_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        (self.sample_visible_normal(v, u), 1.0)
    }

    /// The probability in (0, 1] that a visible normal is one of those that
    /// [`sample_reflecting_normal`](Self::sample_reflecting_normal) draws.
    #[must_use]
    #[inline(always)]
    fn reflecting_share(&self, _v: impl Into<[f32; 3]>) -> f32 {
        1.0
    }

    /// A light reflected off a visible normal and its weight f·cos θ_l/pdf ∈ [0, 1], from two
    /// numbers in [0, 1] (clamped to them, NaN to 0). `None` where the view is not above the
    /// horizon or the light would not be: a path ends there with weight 0.
    ///
    /// The density, which many paths never need, is [`eval_pdf`](Self::eval_pdf)'s. A reflectance
    /// is that of the cosine v·m = √(½ (1 + v·l)).
    #[must_use]
    #[inline]
    fn sample_reflected(
        &self,
        v: impl Into<[f32; 3]>,
        u: [f32; 2],
        masking: Masking,
    ) -> Option<([f32; 3], f32)> {
        let v = vec3(v);
        if !(v.z > 0.0) {
            return None;
        }
        let (l, white) = Facets { lobe: self, masking }.draw::<false>(v, u)?;
        Some((l.to_array(), white.weight))
    }

    /// f, without the cosine, D·G2/(4 (v·n) (l·n)), and the density with which
    /// [`sample_reflected`](Self::sample_reflected) draws `l`, per steradian, with one D for both.
    ///
    /// 0 where `v` or `l` is at or below the horizon, or NaN; finite everywhere, `f32::MAX` in
    /// place of what single precision cannot hold.
    #[must_use]
    #[inline]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> (f32, f32) {
        let (v, l) = (vec3(v), vec3(l));
        if !(v.z > 0.0 && l.z > 0.0) {
            return (0.0, 0.0);
        }
        let white = Facets { lobe: self, masking }.halfway(v, l);
        (white.f([1.0], l)[0], white.pdf)
    }
}

/// A part of the light that a BSDF returns: a weight f |cos θ_l|/pdf by channel and a density, both
/// of this part alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<const N: usize> {
    pub(crate) weight: [f32; N],
    pub(crate) pdf: f32,
}

impl<const N: usize> Part<N> {
    pub(crate) const NONE: Self = Self { weight: [0.0; N], pdf: 0.0 };

    /// The part of an [`f`](Self::f) and a density; [`NONE`](Self::NONE) of a light that is not
    /// drawn.
    #[inline(always)]
    pub(crate) fn of_f(f: [f32; N], pdf: f32, l: Vec3) -> Self {
        if pdf > 0.0 { Self { weight: f.map(|f| f * l.z.abs() / pdf), pdf } } else { Self::NONE }
    }

    /// f, without the cosine.
    #[inline(always)]
    pub(crate) fn f(&self, l: Vec3) -> [f32; N] {
        // The density of facets may be `f32::MAX`, and the quotient by a small cosine overflow.
        let inverse = saturated(1.0 / l.z.abs());
        self.weight.map(|weight| saturated(weight * self.pdf * inverse))
    }
}

/// The reflecting facets of a lobe.
pub(crate) struct Facets<'a, L: ?Sized> {
    pub(crate) lobe: &'a L,
    pub(crate) masking: Masking,
}

/// The reflection of light from one direction by facets of reflectance 1.
#[derive(Clone, Copy)]
pub(crate) struct White {
    /// The cosine v·m, at which facets have their reflectance.
    pub(crate) cos: f32,
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
    pub(crate) fn new(facet: Facet, share: f32, cos: f32) -> Self {
        // The density may be `f32::MAX`, and the share small.
        let pdf = saturated(0.25 * facet.density / share);
        Self { cos, weight: facet.weight * share, pdf }
    }

    /// The part of a mixture for a reflectance by channel.
    #[inline(always)]
    pub(crate) fn part<const N: usize>(&self, reflectance: [f32; N]) -> Part<N> {
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
