//! The trait of all lobes: D, masking, visible normals and their density.

use glam::Vec3;
use microfacet_core::{Masking, saturated};

use crate::vector::vec3;

/// Below this mean absolute slope a surface counts as a mirror. For GGX the mean slope is α, which
/// pbrt's `EffectivelySmooth` compares with the same number; for γ near 3/2 it is much larger than
/// σ, because of a few steep normals.
pub(crate) const SMOOTH: f32 = 1e-3;

/// The largest masking 1 − G1 of a smooth surface at [`GRAZING`]: that of GGX with α = 1e-3. Longer
/// tails mask more at grazing views than GGX of the same mean slope, and the surface would brighten
/// there as it becomes a mirror.
pub(crate) const SMOOTH_MASKED: f32 = 2.5e-3;

/// The cosine of the view at which the masking of a smooth surface is limited.
pub(crate) const GRAZING: f32 = 0.01;

/// Whether a normal faces away from the view by more than rounding does to a drawn one.
#[inline(always)]
pub(crate) fn is_hidden(v: Vec3, m: Vec3) -> bool {
    v.dot(m) < -5e-7
}

/// The density of visible normals, (v·m)⁺ D(m)/A(v), from `facing` = v·m and 1/A.
///
/// Products are kept finite one by one: for vectors far from unit length one factor may overflow
/// and another vanish, and 0·∞ is NaN.
#[inline(always)]
pub(crate) fn visible_density(facing: f32, d: f32, inverse_area: f32) -> f32 {
    let finite = |x: f32| if x < f32::MAX { x } else { f32::MAX };
    saturated(finite(finite(facing.max(0.0)) * d) * inverse_area)
}

/// What a BSDF needs of one facet, see [`MicrofacetDistribution::facet`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facet {
    /// D(m)/A(v) per steradian, with A the projected area of the microsurface: the density of
    /// visible normals over v·m.
    pub density: f32,
    /// G2(v, l)/G1(v) ∈ [0, 1].
    pub weight: f32,
}

impl Facet {
    /// The facet of a lobe whose projected area is (v·n)/G1, from D and the G1 of view and light.
    ///
    /// Both fields use the same G1, so that a BRDF made of them is reciprocal to rounding.
    #[inline(always)]
    pub(crate) fn of_g1(d: f32, v: Vec3, [g1_v, g1_l]: [f32; 2], masking: Masking) -> Self {
        if !(v.z > 0.0) {
            return Self::default();
        }
        let density = saturated(d * (g1_v / v.z));
        Self { density, weight: masking.g2_over_g1(g1_v, g1_l) }
    }
}

/// A lobe: a distribution of microfacet normals whose parameters are fixed, under Smith's model.
///
/// Renderers call it `TrowbridgeReitzDistribution` (pbrt) or `MicrofacetDistribution` (Mitsuba); σ
/// is their α. The trait of the same name in `microfacet-model` has D, G1, Λ, G2, weights, visible
/// normals and densities in double precision, with the same arguments in the same order. Smith's
/// model: Heitz 2014, *Understanding the masking-shadowing function in microfacet-based BRDFs*,
/// <https://jcgt.org/published/0003/02/03/>.
///
/// Directions are unit vectors in the tangent frame, n = +z, of any type that converts to three
/// `f32`; results are `[f32; 3]`. `v` is the view, `l` the light, `m` a microfacet normal;
/// densities are per steradian. Everything is one-sided: views and lights at or below the horizon
/// have G1 = 0 and Λ = ∞. So negate a direction on the other side of a transmitting surface first,
/// v ↦ −v and l ↦ −l: facets stay where they are, and m above the horizon. The mirror image of a
/// direction in the plane z = 0 sees other facets: there the density of visible normals differs,
/// and for a tilted lobe masking too. Sampling moves a view below the horizon to the horizon;
/// densities are for views above it.
///
/// A lobe of your own needs D, G1, a sampler and its density. With an empty
/// [`Reflecting`](crate::lobe::Reflecting) and [`Tabulated`](crate::lobe::Tabulated) it serves
/// every [`Bsdf`](crate::Bsdf) of this crate. [`Lobe`](crate::Lobe) is any lobe of the crate in one
/// type, in place of a trait object.
pub trait MicrofacetDistribution {
    /// Normal distribution function D(m), with ∫ D(m) (m·n) dm = 1; 0 for m at or below the
    /// horizon.
    #[must_use]
    fn d(&self, m: impl Into<[f32; 3]>) -> f32;

    /// Smith masking G1(v) ∈ [0, 1]: the visible share of the microsurface projected along `v`.
    #[must_use]
    fn g1(&self, v: impl Into<[f32; 3]>) -> f32;

    /// A normal visible from `v`, from two numbers in [0, 1] (clamped to them, NaN to 0).
    ///
    /// From tables `u[0]` chooses the slope along the azimuth of the view and `u[1]` that across,
    /// both rising, so that stratified numbers give stratified normals. The normal has unit length
    /// to 4 ulp, lies above the horizon, and faces the view to rounding (v·m > −5e-7).
    #[must_use]
    fn sample_visible_normal(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> [f32; 3];

    /// Density of visible normals, (v·m)⁺ D(m)/A(v), with A the projected area of the microsurface
    /// (Heitz & d'Eon 2014, eq. 2, <https://doi.org/10.1111/cgf.12417>). 1/A is G1(v)/(v·n), but
    /// for a tilted lobe where its G1 is clamped to 1. The density of reflected lights is this
    /// density over 4 v·m.
    ///
    /// 0 where `m` faces away or lies below the horizon; finite at grazing views. Analytic, with
    /// the area from the tables.
    #[must_use]
    fn visible_normal_pdf(&self, v: impl Into<[f32; 3]>, m: impl Into<[f32; 3]>) -> f32;

    /// A visible normal and its analytic density, [`visible_normal_pdf`](Self::visible_normal_pdf).
    ///
    /// The samples differ from this density by the errors of the tables, some 1e-4 of the CDF;
    /// where that bias matters divide by the density of
    /// [`sample_with_table_pdf`](crate::lobe::Tabulated::sample_with_table_pdf).
    #[must_use]
    #[inline]
    fn sample_with_pdf(&self, v: impl Into<[f32; 3]>, u: [f32; 2]) -> ([f32; 3], f32) {
        let v = v.into();
        let m = self.sample_visible_normal(v, u);
        (m, self.visible_normal_pdf(v, m))
    }

    /// Smith's Λ(v) = 1/G1 − 1 ≥ 0. Its absolute accuracy is that of G1: where Λ is below 1e-5 only
    /// its order of magnitude is meaningful.
    #[must_use]
    #[inline]
    fn lambda(&self, v: impl Into<[f32; 3]>) -> f32 {
        1.0 / self.g1(v) - 1.0
    }

    /// Masking and shadowing G2 of view and light; 0 when either is at or below the horizon.
    #[must_use]
    #[inline]
    fn g2(&self, v: impl Into<[f32; 3]>, l: impl Into<[f32; 3]>, masking: Masking) -> f32 {
        masking.g2(self.g1(v), self.g1(l))
    }

    /// The weight f·cos θ_l/pdf of a light reflected off a [sampled](Self::sample_visible_normal)
    /// visible normal, without Fresnel: G2(v, l)/G1(v) ∈ [0, 1].
    ///
    /// Computed as G2/G1; dividing f·cos θ_l by the density would overflow near the horizon, and
    /// has few digits, or none, where both are subnormal, as in the far tails of Beckmann. 0 when
    /// `v` or `l` is at or below the horizon.
    #[must_use]
    #[inline]
    fn reflection_weight(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> f32 {
        let v = v.into();
        if v[2] > 0.0 { masking.g2_over_g1(self.g1(v), self.g1(l)) } else { 0.0 }
    }

    /// The facet that reflects or refracts light between `v` and `l`, both above the horizon. Its
    /// normal is along `m`, of any length, so that a half vector need not be normalised. The
    /// evaluation of a BSDF calls only this and
    /// [`reflecting_share`](crate::lobe::Reflecting::reflecting_share).
    ///
    /// The microfacet BRDF without Fresnel is density·weight/(4 l·n), the density of the reflected
    /// light density/4. For light that is transmitted `l` is the direction opposite to it.
    #[must_use]
    #[inline]
    fn facet(
        &self,
        v: impl Into<[f32; 3]>,
        m: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        masking: Masking,
    ) -> Facet {
        let (v, m) = (vec3(v), vec3(m).normalize_or_zero());
        let facing = v.dot(m);
        if !(facing > 0.0) {
            return Facet::default();
        }
        let density = saturated(self.visible_normal_pdf(v, m) / facing);
        Facet { density, weight: self.reflection_weight(v, l, masking) }
    }

    /// Whether the lobe is so narrow that a renderer should treat the surface as a mirror; by
    /// default never.
    ///
    /// For the lobes of this crate: whether the mean absolute slope, in the rougher direction, is
    /// below 1e-3 (for GGX: α < 1e-3), so is the slope of the mean normal, and 1 − G1 is at most
    /// 2.5e-3 where cos θ = 0.01. A mirror returns all light; just above this limit one bounce
    /// returns it to 6e-3 at cos θ ≥ 0.01, whatever γ. The surface brightens by that where a
    /// texture of roughness crosses the limit.
    #[must_use]
    fn is_effectively_smooth(&self) -> bool {
        false
    }

    /// Whether the lobe stays as it is when turned by half a turn about n: D(Rm) = D(m) and G1(Rv)
    /// = G1(v) with R(x, y, z) = (−x, −y, z). So are all upright lobes, round or anisotropic, and
    /// no tilted one. By default no, which only [retroreflection](crate::Retroreflective) minds.
    #[must_use]
    fn is_symmetric(&self) -> bool {
        false
    }
}
