//! The classic distributions that are members of the Student-t family.

use core::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{Isotropic, search_half};
use crate::distribution::MicrofacetDistribution;
use crate::error::ParameterError;
use crate::student_t::StudentT;

/// An isotropic Student-t under one of its classic names; masking and visible normals are the
/// family's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member(StudentT);

impl Member {
    /// Beckmann with root-mean-square slope parameter m: D = exp(−tan²θ/m²)/(π m² cos⁴θ).
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < m < ∞.
    pub fn beckmann(m: f64) -> Result<Self, ParameterError> {
        StudentT::beckmann(m).map(Self)
    }

    /// Trowbridge–Reitz (GGX) with C: D = C²/(π (cos²θ (C² − 1) + 1)²).
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < C < ∞.
    pub fn trowbridge_reitz(c: f64) -> Result<Self, ParameterError> {
        StudentT::ggx(c).map(Self)
    }

    /// Blinn–Phong with exponent N: D = (N+2)/(2π) cosᴺθ.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 ≤ N < ∞.
    pub fn blinn_phong(n: f64) -> Result<Self, ParameterError> {
        StudentT::blinn_phong(n).map(Self)
    }

    /// Hyper-Cauchy with D ∝ (1 + tan²θ/σ₀²)^(−γ)/cos⁴θ.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < σ₀ < ∞ and 3/2 < γ < ∞.
    pub fn hyper_cauchy(sigma_0: f64, gamma: f64) -> Result<Self, ParameterError> {
        StudentT::hyper_cauchy(sigma_0, gamma).map(Self)
    }

    /// Student-t with roughness σ and shape γ.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 < σ < ∞ and γ > 3/2.
    pub fn student_t(sigma: f64, gamma: f64) -> Result<Self, ParameterError> {
        StudentT::new(sigma, gamma).map(Self)
    }
}

impl Isotropic for Member {
    fn peak(&self) -> f64 {
        self.0.d(DVec3::Z)
    }

    fn relative_d(&self, theta: f64) -> f64 {
        self.0.d(DVec3::new(libm::sin(theta), 0.0, libm::cos(theta))) / self.peak()
    }

    /// In closed form for Trowbridge–Reitz (γ = 2), else by search.
    fn half_angle(&self) -> Option<f64> {
        let (sigma, shape) = (self.0.sigma_x(), self.0.shape());
        if shape.gamma() == 2.0 {
            // (1 + (1/C² − 1) sin²θ)² = 2.
            let sin2 = (2.0_f64.sqrt() - 1.0) / (1.0 / (sigma * sigma) - 1.0);
            return (sin2 > 0.0 && sin2 <= 1.0).then(|| libm::asin(sin2.sqrt()));
        }
        search_half(|theta| self.relative_d(theta), FRAC_PI_2)
    }

    fn cdf(&self, theta: f64) -> f64 {
        // 1 − (1 + s r²)^(1−γ), r = tan θ/σ: the inverse of the slope radius.
        if theta >= FRAC_PI_2 {
            return 1.0;
        }
        let r = libm::tan(theta.max(0.0)) / self.0.sigma_x();
        let s = self.0.shape().s();
        let e = if self.0.shape().is_beckmann() { r * r } else { libm::log1p(s * r * r) / s };
        -libm::expm1(-e)
    }

    fn sample_theta(&self, u: f64) -> f64 {
        libm::atan(self.0.sigma_x() * self.0.shape().slope_radius(u))
    }

    fn student_t(&self) -> Option<StudentT> {
        Some(self.0)
    }
}
