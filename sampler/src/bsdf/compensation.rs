//! Multiple scattering, put back: what a single bounce off the microsurface loses, as a scaling or as a lobe of its own.
//!
//! Both need the directional albedo E of the same lobe and masking that the single-scattering lobe is evaluated with. With F = 1 both return
//! exactly what is lost, so that a white furnace shows nothing.

use core::f32::consts::PI;

use glam::Vec3;

use microfacet_common::gauss_legendre;
use microfacet_common::schlick::{F82_AVERAGE, SCHLICK_AVERAGE, f82_dip};

use crate::albedo::Albedo;
use crate::math::sqrt;

/// Average of Schlick's reflectance, 2∫₀¹ F(μ) μ dμ = F0 + (F90 − F0)/21 (Kulla & Conty 2017, slide "average Fresnel").
pub fn schlick_average(f0: f32, f90: f32) -> f32 {
    f0 + (f90 - f0) * SCHLICK_AVERAGE as f32
}

/// Average of OpenPBR's metal, Schlick with F90 = 1 less the tint's dip.
pub fn f82_tint_average(f0: f32, tint: f32) -> f32 {
    schlick_average(f0, 1.0) - f82_dip(f0, tint) * F82_AVERAGE as f32
}

/// Average 2∫₀¹ F(μ) μ dμ of any reflectance, by sixteen-point Gauss–Legendre quadrature; exact conductors to 1e-5.
pub fn fresnel_average(reflectance: impl Fn(f32) -> f32) -> f32 {
    const RULE: [(f64, f64); 16] = gauss_legendre();
    let at = |(mu, weight): (f64, f64)| (2.0 * weight * mu) as f32 * reflectance(mu as f32);
    RULE.into_iter().map(at).sum()
}

impl Albedo {
    /// Factor on the single-scattering lobe, 1 + F0 (1 − E(v))/E(v) (Turquin 2019, *Practical multiple scattering compensation for
    /// microfacet models*, eq. 16), for a view and a reflectance F0 at normal incidence (one channel).
    ///
    /// Cheap, and keeps the lobe's shape; not reciprocal. Where E is 0 (γ near 3/2 at large σ) the factor is limited to 1e6.
    #[inline]
    pub fn turquin(&self, v: Vec3, f0: f32) -> f32 {
        let lost = self.lost(v);
        1.0 + (f0 * lost / (1.0 - lost).max(1e-6)).min(1e6)
    }

    /// The lobe of all bounces after the first with F = 1, (1 − E(v))(1 − E(l))/(π(1 − E_avg)) (Kulla & Conty 2017, *Revisiting
    /// physically based shading at Imageworks*, slide "energy compensation"; after Kelemen & Szirmay-Kalos 2001, eq. 11), per steradian.
    ///
    /// A BRDF without the cosine; reciprocal; 0 where v or l is at or below the horizon. Multiply by
    /// [`multiple_bounces`](Self::multiple_bounces) for coloured surfaces.
    #[inline]
    pub fn compensation(&self, v: Vec3, l: Vec3) -> f32 {
        let average = self.lost_average();
        // σ = 0 loses nothing, and the quotient would be 0/0.
        if !(v.z > 0.0 && l.z > 0.0) || average <= f32::MIN_POSITIVE {
            return 0.0;
        }
        self.lost(v) * self.lost(l) / (PI * average)
    }

    /// Draws a light for [`compensation`](Self::compensation) from u ∈ [0, 1)²: cosine-weighted, which is close since 1 − E varies little.
    #[inline]
    pub fn sample_compensation(&self, u: [f32; 2]) -> Vec3 {
        // Malley's method on the polar disc; z from the radius keeps l of unit length at the horizon.
        let r = sqrt(u[0]);
        let phi = 2.0 * PI * u[1];
        Vec3::new(r * libm::cosf(phi), r * libm::sinf(phi), sqrt((1.0 - u[0]).max(0.0)))
    }

    /// Density of [`sample_compensation`](Self::sample_compensation), cos θ_l/π per steradian; 0 below the horizon.
    #[inline]
    pub fn compensation_pdf(&self, l: Vec3) -> f32 {
        l.z.max(0.0) * (1.0 / PI)
    }

    /// What the light keeps of one channel in all bounces after the first: F_avg² E_avg/(1 − F_avg(1 − E_avg)) (Kulla & Conty 2017, with
    /// the square that counts the first bounce; Hill 2018, *A multi-faceted exploration, part 2*), in [0, 1].
    #[inline]
    pub fn multiple_bounces(&self, fresnel_average: f32) -> f32 {
        let below = 1.0 - fresnel_average * self.lost_average();
        // F_avg = 1 and E_avg = 0: an endless number of bounces that lose nothing.
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
