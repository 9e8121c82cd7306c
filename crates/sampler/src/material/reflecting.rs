//! Reflection off a lobe without Fresnel: sampler, evaluation and density.

use microfacet_core::Masking;

use super::distribution::MicrofacetDistribution;
use crate::bsdf::Facets;
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
