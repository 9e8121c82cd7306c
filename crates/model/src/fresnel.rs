//! Checked parameters for the reflectances of `microfacet-core`: conductors, dielectrics, and
//! Schlick's approximation (1994, <https://doi.org/10.1111/1467-8659.1330233>) with its F82 tint.
//!
//! `cos_theta` is the cosine between the view and the microfacet normal, in [0, 1]. Light is
//! unpolarised. Constructors check their arguments, so that evaluation cannot fail.

use microfacet_core::fresnel::{conductor, dielectric, refracted_cos};
use microfacet_core::schlick::{f82_dip, schlick};

use crate::error::ParameterError;

pub use microfacet_core::schlick::{F82_COS, f82_weight, schlick_weight};

/// A conductor with complex refractive index η + ik relative to the medium outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    eta: f64,
    k: f64,
}

impl Conductor {
    /// A conductor of index η > 0 and extinction k ≥ 0, both relative to the outer medium's (real)
    /// index.
    ///
    /// # Errors
    /// [`ParameterError::Eta`] and [`ParameterError::Extinction`] outside these domains.
    pub fn new(eta: f64, k: f64) -> Result<Self, ParameterError> {
        check_eta(eta)?;
        if !(0.0..f64::INFINITY).contains(&k) {
            return Err(ParameterError::Extinction(k));
        }
        Ok(Self { eta, k })
    }

    /// Exact reflectance ∈ [0, 1]; 1 at grazing.
    pub fn reflectance(&self, cos_theta: f64) -> f64 {
        conductor(self.eta, self.k, cos_theta)
    }
}

/// A smooth interface between two transparent media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    eta: f64,
}

impl Dielectric {
    /// An interface of relative index η, the index beyond it over that on the viewer's side: η > 1
    /// when entering glass from air, η < 1 when leaving it. At η = 1 nothing is reflected or bent.
    ///
    /// # Errors
    /// [`ParameterError::Eta`] unless 0 < η < ∞.
    pub fn new(eta: f64) -> Result<Self, ParameterError> {
        check_eta(eta)?;
        Ok(Self { eta })
    }

    /// η as given.
    pub fn eta(&self) -> f64 {
        self.eta
    }

    /// The cosine at which total reflection begins, √(1 − η²); 0 if η ≥ 1, where it never does.
    pub fn kink(&self) -> f64 {
        ((1.0 - self.eta) * (1.0 + self.eta)).max(0.0).sqrt()
    }

    /// The same interface seen from its other side, index 1/η.
    pub fn reversed(&self) -> Self {
        Self { eta: 1.0 / self.eta }
    }

    /// Cosine between the refracted ray and the normal, in (0, 1], by Snell's law; `None` where all
    /// light is reflected.
    pub fn refracted_cos(&self, cos_theta: f64) -> Option<f64> {
        refracted_cos(self.eta, cos_theta)
    }

    /// Exact reflectance ∈ [0, 1] (Fresnel): 1 beyond the critical angle and at grazing, 0
    /// everywhere if η = 1. Transmittance is 1 − reflectance.
    pub fn reflectance(&self, cos_theta: f64) -> f64 {
        dielectric(self.eta, cos_theta)
    }

    /// Reflectance at normal incidence, ((η−1)/(η+1))²; the same from both sides.
    pub fn f0(&self) -> f64 {
        let r = (self.eta - 1.0) / (self.eta + 1.0);
        r * r
    }
}

/// A metal in OpenPBR's terms: reflectance F0 at normal incidence and a tint at 82°.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct F82Tint {
    f0: f64,
    tint: f64,
}

impl F82Tint {
    /// A metal of the given F0 and tint, both in [0, 1]; tint = 1 is Schlick's approximation.
    ///
    /// # Errors
    /// [`ParameterError::Reflectance`] outside [0, 1].
    pub fn new(f0: f64, tint: f64) -> Result<Self, ParameterError> {
        for x in [f0, tint] {
            if !(0.0..=1.0).contains(&x) {
                return Err(ParameterError::Reflectance(x));
            }
        }
        Ok(Self { f0, tint })
    }

    /// Reflectance ∈ [0, 1].
    pub fn reflectance(&self, cos_theta: f64) -> f64 {
        schlick(self.f0, 1.0, cos_theta) - f82_dip(self.f0, self.tint) * f82_weight(cos_theta)
    }
}

fn check_eta(eta: f64) -> Result<(), ParameterError> {
    if eta > 0.0 && eta < f64::INFINITY { Ok(()) } else { Err(ParameterError::Eta(eta)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_unphysical_indices() {
        for eta in [0.0, -1.5, f64::NAN, f64::INFINITY] {
            assert!(Dielectric::new(eta).is_err(), "{eta}");
            assert!(Conductor::new(eta, 1.0).is_err());
        }
        let message = Conductor::new(1.0, -0.5).unwrap_err().to_string();
        assert!(message.contains("-0.5") && message.contains("[0, inf)"), "{message}");
        assert!(F82Tint::new(1.1, 1.0).is_err() && F82Tint::new(0.5, f64::NAN).is_err());
    }

    #[test]
    fn f82_tint_has_its_value_at_the_peak() {
        let metal = F82Tint::new(0.7, 0.5).unwrap();
        let schlick = F82Tint::new(0.7, 1.0).unwrap();
        assert!((f82_weight(F82_COS) - 1.0).abs() < 1e-15);
        assert!((metal.reflectance(F82_COS) - 0.5 * schlick.reflectance(F82_COS)).abs() < 1e-15);
        assert_eq!((metal.reflectance(1.0), metal.reflectance(0.0)), (0.7, 1.0));
        for i in 0..=100 {
            let cos = f64::from(i) / 100.0;
            assert!((0.0..=1.0).contains(&f82_weight(cos)));
            assert!((0.0..=1.0).contains(&metal.reflectance(cos)));
        }
    }
}
