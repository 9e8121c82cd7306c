//! Energy compensation: what a single bounce off the microsurface loses to multiple scattering,
//! given back as a factor or as a lobe of its own.
//!
//! Both forms need the directional albedo E of the same lobe and form of masking that the
//! single-scattering lobe is evaluated with. With F = 1 both return just what is lost, so that a
//! white furnace shows nothing.

use core::f32::consts::PI;

use glam::Vec3;

use microfacet_common::gauss_legendre;
use microfacet_common::schlick::{F82_AVERAGE, SCHLICK_AVERAGE, f82_dip};

use crate::albedo::Albedo;
use crate::math::{sqrt, unit};

/// Cosine-weighted average of Schlick's reflectance, 2∫₀¹ F(μ) μ dμ = F0 + (F90 − F0)/21.
///
/// Kulla & Conty 2017, slide "average Fresnel",
/// <https://blog.selfshadow.com/publications/s2017-shading-course/>.
pub fn schlick_average(f0: f32, f90: f32) -> f32 {
    f0 + (f90 - f0) * SCHLICK_AVERAGE as f32
}

/// Cosine-weighted average of OpenPBR's metal: Schlick's with F90 = 1, less the tint's dip.
pub fn f82_tint_average(f0: f32, tint: f32) -> f32 {
    schlick_average(f0, 1.0) - f82_dip(f0, tint) * F82_AVERAGE as f32
}

/// Cosine-weighted average 2∫₀¹ F(μ) μ dμ of any reflectance, by sixteen-point Gauss–Legendre
/// quadrature; for conductors by Fresnel's equations to 1e-5.
pub fn fresnel_average(reflectance: impl Fn(f32) -> f32) -> f32 {
    const RULE: [(f64, f64); 16] = gauss_legendre();
    let at = |(mu, weight): (f64, f64)| (2.0 * weight * mu) as f32 * reflectance(mu as f32);
    RULE.into_iter().map(at).sum()
}

impl Albedo {
    /// Compensating factor on the single-scattering lobe, 1 + F0 (1 − E(v))/E(v), for a view and
    /// one channel of the reflectance F0 at normal incidence.
    ///
    /// Turquin 2019, *Practical multiple scattering compensation for microfacet models*, eq. 16,
    /// <https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf>. Cheap, and keeps the
    /// lobe's shape; not reciprocal. Where E is 0 (γ near 3/2 at large σ) the factor is limited to
    /// 1e6.
    #[inline]
    pub fn turquin(&self, v: Vec3, f0: f32) -> f32 {
        let lost = self.lost(v);
        1.0 + (f0 * lost / (1.0 - lost).max(1e-6)).min(1e6)
    }

    /// The lobe of all bounces after the first with F = 1, (1 − E(v))(1 − E(l))/(π(1 − E_avg)) per
    /// steradian.
    ///
    /// A BRDF without the cosine; reciprocal; 0 where v or l is at or below the horizon. Multiply
    /// by [`multiple_bounces`](Self::multiple_bounces) for coloured surfaces. Kulla & Conty 2017,
    /// *Revisiting physically based shading at Imageworks*, slide "energy compensation"; after
    /// Kelemen & Szirmay-Kalos 2001, eq. 11, <https://doi.org/10.2312/egs.20011003>.
    #[inline]
    pub fn compensation(&self, v: Vec3, l: Vec3) -> f32 {
        let average = self.lost_average();
        // σ = 0 loses nothing, and the quotient would be 0/0.
        if !(v.z > 0.0 && l.z > 0.0) || average <= f32::MIN_POSITIVE {
            return 0.0;
        }
        self.lost(v) * self.lost(l) / (PI * average)
    }

    /// Draws a light for [`compensation`](Self::compensation) from two numbers in [0, 1] (clamped
    /// to them, NaN to 0): cosine-weighted, which is close because 1 − E varies little.
    #[inline]
    pub fn sample_compensation(&self, u: [f32; 2]) -> Vec3 {
        let [u1, u2] = u.map(unit);
        // Malley's method on the polar disc; z from the radius keeps l of unit length at the
        // horizon.
        let r = sqrt(u1);
        let phi = 2.0 * PI * u2;
        Vec3::new(r * libm::cosf(phi), r * libm::sinf(phi), sqrt(1.0 - u1))
    }

    /// Density of [`sample_compensation`](Self::sample_compensation), cos θ_l/π per steradian; 0
    /// below the horizon.
    #[inline]
    pub fn compensation_pdf(&self, l: Vec3) -> f32 {
        l.z.max(0.0) * (1.0 / PI)
    }

    /// The factor of [`compensation`](Self::compensation) for one channel of average reflectance
    /// F_avg, F_avg² E_avg/(1 − F_avg(1 − E_avg)) ∈ [0, 1].
    ///
    /// Kulla & Conty 2017, with the square that counts the first bounce (Hill 2018, *A
    /// multi-faceted exploration, part 2*).
    #[inline]
    pub fn multiple_bounces(&self, fresnel_average: f32) -> f32 {
        let below = 1.0 - fresnel_average * self.lost_average();
        // F_avg = 1 and E_avg = 0: infinitely many bounces that lose nothing.
        if below > 0.0 {
            fresnel_average * fresnel_average * self.albedo_average() / below
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_agree_with_their_closed_forms() {
        for f0 in [0.0, 0.04, 0.7, 1.0] {
            let schlick = |mu: f32| f0 + (1.0 - f0) * libm::powf(1.0 - mu, 5.0);
            assert!((fresnel_average(schlick) - schlick_average(f0, 1.0)).abs() < 1e-6);
            let edge = schlick(1.0 / 7.0);
            let peak = 823543.0 / 46656.0;
            let metal = |mu: f32| schlick(mu) - 0.7 * edge * peak * mu * libm::powf(1.0 - mu, 6.0);
            assert!((fresnel_average(metal) - f82_tint_average(f0, 0.3)).abs() < 1e-6);
        }
        assert!((fresnel_average(|_| 1.0) - 1.0).abs() < 1e-6);
    }
}
