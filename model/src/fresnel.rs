//! Fresnel reflectance of conductors and dielectrics, and Schlick's approximation
//! (1994, <https://doi.org/10.1111/1467-8659.1330233>) with its F82 tint.
//!
//! `cos_theta` is the cosine between the view and the microfacet normal, in [0, 1]. Light is
//! unpolarised. Constructors check their arguments, so that evaluation cannot fail.

use microfacet_common::schlick::{f82_dip, schlick};

use crate::error::ParameterError;

pub use microfacet_common::schlick::{F82_COS, f82_weight, schlick_weight};

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

    /// Exact reflectance ∈ [0, 1] (Born & Wolf 1999, §14.4); 1 at grazing.
    ///
    /// The refracted wave's a + ib is formed so that neither part cancels: the smaller part comes
    /// from the product ab = ηk. With k = 0 it is the dielectric's reflectance.
    pub fn reflectance(&self, cos_theta: f64) -> f64 {
        let (cos, sin2) = (cos_theta, 1.0 - cos_theta * cos_theta);
        // (a + ib)² = η² − k² − sin²θ + 2iηk; evaluated as it stands, 1 − sin²θ would lose a small
        // cosine where η is near 1.
        let real = (self.eta - 1.0) * (self.eta + 1.0) - self.k * self.k + cos * cos;
        let product = self.eta * self.k;
        let modulus = libm::hypot(real, 2.0 * product);
        let large = (0.5 * (modulus + real.abs())).sqrt();
        if large == 0.0 {
            return 1.0; // exactly at the critical angle without absorption
        }
        let (a, b) = if real >= 0.0 { (large, product / large) } else { (product / large, large) };
        let ratio = |x: f64, y: f64| (x * x + b * b) / (y * y + b * b);
        let s = ratio(a - cos, a + cos);
        if cos == 0.0 {
            return 1.0;
        }
        // Parallel over perpendicular: |a + ib − sin²/cos|² / |a + ib + sin²/cos|².
        let t = sin2 / cos;
        0.5 * s * (1.0 + ratio(a - t, a + t))
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

    /// The same interface seen from its other side, index 1/η.
    pub fn reversed(&self) -> Self {
        Self { eta: 1.0 / self.eta }
    }

    /// Cosine between the refracted ray and the normal, in (0, 1], by Snell's law; `None` where all
    /// light is reflected.
    pub fn refracted_cos(&self, cos_theta: f64) -> Option<f64> {
        // η² cos²θ_t = η² − 1 + cos²θ, which keeps a small cosine where η is near 1.
        let square = (self.eta - 1.0) * (self.eta + 1.0) + cos_theta * cos_theta;
        if square > 0.0 { Some(square.sqrt() / self.eta) } else { None }
    }

    /// Exact reflectance ∈ [0, 1] (Fresnel): 1 beyond the critical angle and at grazing, 0
    /// everywhere if η = 1. Transmittance is 1 − reflectance.
    pub fn reflectance(&self, cos_theta: f64) -> f64 {
        if self.eta == 1.0 {
            return 0.0; // also at grazing, where the formula is 0/0
        }
        let Some(t) = self.refracted_cos(cos_theta) else { return 1.0 };
        let parallel = (self.eta * cos_theta - t) / (self.eta * cos_theta + t);
        let perpendicular = (cos_theta - self.eta * t) / (cos_theta + self.eta * t);
        0.5 * (parallel * parallel + perpendicular * perpendicular)
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

    const COSINES: [f64; 9] = [0.0, 1e-9, 0.01, 1.0 / 7.0, 0.4, 0.6, 0.75, 0.99, 1.0];

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
    fn conductor_without_absorption_is_the_dielectric() {
        for eta in [0.3, 0.75, 1.0, 1.33, 1.5, 2.4, 50.0] {
            let (conductor, dielectric) =
                (Conductor::new(eta, 0.0).unwrap(), Dielectric::new(eta).unwrap());
            for cos in COSINES {
                // At η = 1 and grazing the conductor's limit is 1, the dielectric's is 0 by
                // definition.
                if eta == 1.0 && cos == 0.0 {
                    continue;
                }
                let (a, b) = (conductor.reflectance(cos), dielectric.reflectance(cos));
                assert!((a - b).abs() < 1e-13, "eta {eta}, cos {cos}: {a} against {b}");
            }
        }
    }

    #[test]
    fn conductor_matches_complex_arithmetic() {
        // r_s = (cos − w)/(cos + w), r_p = (ñ² cos − w)/(ñ² cos + w), w = √(ñ² − sin²) in complex
        // numbers.
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        for (eta, k) in [(0.143, 3.98), (1.1, 7.6), (2.9, 3.05), (0.05, 1e-3), (4.0, 0.2)] {
            for cos in COSINES {
                let n2 = mul((eta, k), (eta, k));
                let d = (n2.0 - (1.0 - cos * cos), n2.1);
                let m = norm(d).sqrt();
                let w = ((0.5 * (m + d.0)).sqrt(), (0.5 * (m - d.0)).sqrt());
                let nc = (n2.0 * cos, n2.1 * cos);
                let s = norm((cos - w.0, -w.1)) / norm((cos + w.0, w.1));
                let p = norm((nc.0 - w.0, nc.1 - w.1)) / norm((nc.0 + w.0, nc.1 + w.1));
                let got = Conductor::new(eta, k).unwrap().reflectance(cos);
                assert!((got - 0.5 * (s + p)).abs() < 1e-12, "({eta}, {k}) at {cos}: {got}");
            }
        }
    }

    #[test]
    fn both_sides_of_an_interface_reflect_alike() {
        let glass = Dielectric::new(1.5).unwrap();
        for cos in [0.05, 0.3, 0.8, 1.0] {
            let inside = glass.refracted_cos(cos).unwrap();
            let (out, back) = (glass.reflectance(cos), glass.reversed().reflectance(inside));
            assert!((out - back).abs() < 1e-14);
        }
        assert_eq!(glass.reversed().reflectance(0.5), 1.0);
        assert!(
            (glass.reflectance(1.0) - glass.f0()).abs() < 1e-16
                && (glass.f0() - 0.04).abs() < 1e-16
        );
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
