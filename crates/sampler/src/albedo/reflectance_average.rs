//! Cosine-weighted averages of reflectances over the hemisphere.

use microfacet_core::gauss_legendre;
use microfacet_core::schlick::{F82_AVERAGE, SCHLICK_AVERAGE, f82_dip};

/// Cosine-weighted average of Schlick's reflectance, 2∫₀¹ F(μ) μ dμ = F0 + (F90 − F0)/21.
///
/// Kulla & Conty 2017, slide "average Fresnel",
/// <https://blog.selfshadow.com/publications/s2017-shading-course/>.
#[must_use]
pub fn schlick_average(f0: f32, f90: f32) -> f32 {
    f0 + (f90 - f0) * SCHLICK_AVERAGE as f32
}

/// Cosine-weighted average of OpenPBR's metal: Schlick's with F90 = 1, less the tint's dip.
#[must_use]
pub fn f82_tint_average(f0: f32, tint: f32) -> f32 {
    schlick_average(f0, 1.0) - f82_dip(f0, tint) * F82_AVERAGE as f32
}

/// Cosine-weighted average 2∫₀¹ F(μ) μ dμ of any reflectance, by Gauss–Legendre quadrature with
/// eight points in each of eight panels; for conductors by Fresnel's equations to 1e-6, and to 2e-5
/// across a kink.
pub fn fresnel_average(reflectance: impl Fn(f32) -> f32) -> f32 {
    const RULE: [(f64, f64); 8] = gauss_legendre();
    const PANELS: usize = 8;
    let mut sum = 0.0;
    for panel in 0..PANELS {
        for (node, weight) in RULE {
            let mu = (panel as f64 + node) / PANELS as f64;
            sum += 2.0 * weight / PANELS as f64 * mu * f64::from(reflectance(mu as f32));
        }
    }
    sum as f32
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
