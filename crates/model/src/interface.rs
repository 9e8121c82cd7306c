//! Both shares of the light at a rough dielectric: reflected and transmitted.

use core::f64::consts::FRAC_PI_2;

use crate::albedo::AlbedoIntegrator;
use crate::converge::{Albedo, Both};
use crate::error::ParameterError;
use crate::fresnel::Dielectric;

/// One albedo of reflection and one of transmission, together.
fn both(reflected: &Albedo<1>, transmitted: &Albedo<1>) -> Albedo<2> {
    let (r, t): (Both<1>, Both<1>) = (reflected.both(), transmitted.both());
    let shares = [0, 1].map(|form| [r[form][0], t[form][0]]);
    Albedo::new(shares, reflected.error.max(transmitted.error))
}

impl AlbedoIntegrator {
    /// The shares [reflected, transmitted] of the light from a direction at cos θ ∈ [0, 1] by one
    /// event at a rough interface, for roughness σ ≥ 0 along both axes. As
    /// [`reflection`](Self::reflection) and [`transmission`](Self::transmission).
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 ≤ σ < ∞ and cos θ ∈ [0, 1].
    pub fn interface(
        &self,
        sigma: f64,
        cos_theta: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<2>, ParameterError> {
        let reflected = self.reflected_to(self.tolerance, sigma, cos_theta, dielectric)?;
        Ok(both(&reflected, &self.transmission(sigma, cos_theta, dielectric)?))
    }

    /// [`interface`](Self::interface) for roughness σx, σy and a view at azimuth φ (radians from the
    /// x axis). Where σx ≠ σy, both must be positive.
    ///
    /// # Errors
    /// As [`reflection_anisotropic`](Self::reflection_anisotropic).
    pub fn interface_anisotropic(
        &self,
        sigma: [f64; 2],
        cos_theta: f64,
        phi: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<2>, ParameterError> {
        let [x, y] = sigma;
        if x == y {
            return self.interface(x, cos_theta, dielectric);
        }
        let weight = |cos: f64| [dielectric.reflectance(cos)];
        let kink = dielectric.kink();
        let reflected =
            self.reflection_anisotropic_with_kink(sigma, cos_theta, phi, kink, weight)?;
        let transmitted = self.transmission_anisotropic(sigma, cos_theta, phi, dielectric)?;
        Ok(both(&reflected, &transmitted))
    }

    /// Cosine-weighted averages 2∫₀¹ … μ dμ of both shares of [`interface`](Self::interface).
    ///
    /// What leaves the denser side follows from what enters it, by reciprocity: the averages of
    /// transmission from both sides differ by η², since the solid angles of refracted light do.
    ///
    /// # Errors
    /// [`ParameterError::Sigma`] unless 0 ≤ σ < ∞.
    pub fn interface_average(
        &self,
        sigma: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<2>, ParameterError> {
        let eta = dielectric.eta();
        // Total reflection sets in there, within the roughness.
        let critical = libm::asin(eta.min(1.0));
        let reflected = self.over_views(&[0.0, critical, FRAC_PI_2], |tolerance, cos| {
            self.reflected_to(tolerance, sigma, cos, dielectric)
        })?;
        let entering = if eta < 1.0 { dielectric.reversed() } else { dielectric };
        let transmitted = self.over_views(&[0.0, FRAC_PI_2], |tolerance, cos| {
            self.transmission_to(tolerance, sigma, cos, entering)
        })?;
        let scale = if eta < 1.0 { eta * eta } else { 1.0 };
        let scaled = transmitted.both().map(|form| form.map(|t| t * scale));
        Ok(both(&reflected, &Albedo::new(scaled, transmitted.error * scale)))
    }

    fn reflected_to(
        &self,
        tolerance: f64,
        sigma: f64,
        cos_theta: f64,
        dielectric: Dielectric,
    ) -> Result<Albedo<1>, ParameterError> {
        let weight = |cos: f64| [dielectric.reflectance(cos)];
        match dielectric.kink() {
            0.0 => self.reflection_to(tolerance, sigma, cos_theta, weight),
            kink => self.reflection_with_kink_to(tolerance, sigma, cos_theta, kink, weight),
        }
    }
}
