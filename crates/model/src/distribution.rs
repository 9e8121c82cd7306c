//! The trait of distributions of microfacet normals.

use glam::DVec3;
use microfacet_core::Masking;

/// A distribution of microfacet normals under Smith's model, in double precision.
///
/// The trait of the same name in `microfacet-sampler` has the same functions in single precision,
/// with the same arguments in the same order. Directions are unit vectors in the tangent frame,
/// n = +z; densities are per steradian. Smith's model: Heitz 2014, *Understanding the
/// masking-shadowing function in microfacet-based BRDFs*,
/// <https://jcgt.org/published/0003/02/03/>.
pub trait MicrofacetDistribution {
    /// Normal distribution function D(m), with ∫ D(m) (m·n) dm = 1; 0 for m at and below the
    /// horizon.
    fn d(&self, m: DVec3) -> f64;

    /// Smith's Λ(v) ≥ 0: 0 at normal incidence, ∞ at and below the horizon.
    fn lambda(&self, v: DVec3) -> f64;

    /// Smith masking G1(v) = 1/(1 + Λ(v)) ∈ [0, 1]; 0 at and below the horizon.
    fn g1(&self, v: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(v))
    }

    /// Masking and shadowing of view and light; 0 when either is at or below the horizon.
    fn g2(&self, v: DVec3, l: DVec3, masking: Masking) -> f64 {
        masking.g2(self.g1(v), self.g1(l))
    }

    /// The weight f·cos θ_l/pdf of a light reflected off a sampled visible normal, without Fresnel:
    /// G2(v, l)/G1(v) ∈ [0, 1]. 0 when v or l is at or below the horizon.
    fn reflection_weight(&self, v: DVec3, l: DVec3, masking: Masking) -> f64 {
        if v.z > 0.0 { masking.g2_over_g1(self.g1(v), self.g1(l)) } else { 0.0 }
    }

    /// The normal visible from `v` at u ∈ [0, 1]². `u[0]` inverts the CDF of the slope in the plane
    /// of incidence, which rises towards the viewer, and `u[1]` that of the slope across. A view
    /// below the horizon is moved to the horizon.
    fn sample_visible_normal(&self, v: DVec3, u: [f64; 2]) -> DVec3;

    /// Density of visible normals, G1(v) (v·m)⁺ D(m)/(v·n) (Heitz & d'Eon 2014, eq. 2,
    /// <https://doi.org/10.1111/cgf.12417>). 0 for views at or below the horizon and for normals
    /// that face away.
    fn visible_normal_pdf(&self, v: DVec3, m: DVec3) -> f64;

    /// A visible normal and its density.
    fn sample_with_pdf(&self, v: DVec3, u: [f64; 2]) -> (DVec3, f64) {
        let m = self.sample_visible_normal(v, u);
        (m, self.visible_normal_pdf(v, m))
    }
}
