//! Burley's generalised Trowbridge–Reitz distribution.

use core::f64::consts::{FRAC_PI_2, PI};

use super::{ClassicError, Isotropic, check};
use crate::student_t::StudentT;

/// Generalised Trowbridge–Reitz, D ∝ (cos²θ (C² − 1) + 1)^(−γ): γ = 2 is Trowbridge–Reitz, γ = 1
/// the Berry distribution (Burley 2012, *Physically Based Shading at Disney*, appendix B,
/// <https://disneyanimation.com/publications/physically-based-shading-at-disney/>).
///
/// Its constant is (γ−1)(C²−1)/(π(1 − C^(2−2γ))); lists in the literature that give C²/π for every
/// γ are right at γ = 2 only. The density of its slopes falls like r⁻⁴ for every γ, unlike
/// Student-t's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gtr {
    c: f64,
    gamma: f64,
    peak: f64,
}

impl Gtr {
    /// The distribution of roughness C and exponent γ.
    ///
    /// # Errors
    /// [`ClassicError`] unless 0 < C ≤ 1 and 0 < γ < ∞.
    pub fn new(c: f64, gamma: f64) -> Result<Self, ClassicError> {
        check(c > 0.0 && c <= 1.0, "c", c, "(0, 1]")?;
        check(gamma > 0.0 && gamma < f64::INFINITY, "gamma", gamma, "(0, inf)")?;
        let gtr = Self { c, gamma, peak: 0.0 };
        Ok(Self { peak: 1.0 / (PI * gtr.integral(1.0)), ..gtr })
    }

    /// b = 1/C² − 1, so that 1 + (C² − 1) cos²θ = C² (1 + b sin²θ): no cancellation near the peak.
    fn b(&self) -> f64 {
        (1.0 - self.c) * (1.0 + self.c) / (self.c * self.c)
    }

    /// ((1 + b x)^(1−γ) − 1)/((1−γ) b) = ∫₀ˣ (1 + b t)^(−γ) dt for x ∈ [0, 1]; ln(1 + bx)/b at
    /// γ = 1 and x at b = 0.
    fn integral(&self, x: f64) -> f64 {
        let (b, g) = (self.b(), 1.0 - self.gamma);
        if b == 0.0 {
            return x;
        }
        let log = libm::log1p(b * x);
        // expm1 keeps the digits as γ → 1.
        if g == 0.0 { log / b } else { libm::expm1(g * log) / (g * b) }
    }
}

impl Isotropic for Gtr {
    fn peak(&self) -> f64 {
        self.peak
    }

    fn relative_d(&self, theta: f64) -> f64 {
        let sin = libm::sin(theta);
        libm::exp(-self.gamma * libm::log1p(self.b() * sin * sin))
    }

    fn half_angle(&self) -> Option<f64> {
        let sin2 = libm::expm1(core::f64::consts::LN_2 / self.gamma) / self.b();
        (sin2 <= 1.0).then(|| libm::asin(sin2.sqrt()))
    }

    fn cdf(&self, theta: f64) -> f64 {
        let sin = libm::sin(theta.clamp(0.0, FRAC_PI_2));
        self.integral(sin * sin) / self.integral(1.0)
    }

    fn sample_theta(&self, u: f64) -> f64 {
        let (b, g) = (self.b(), 1.0 - self.gamma);
        let whole = u * self.integral(1.0);
        let sin2 = if b == 0.0 {
            whole
        } else if g == 0.0 {
            libm::expm1(b * whole) / b
        } else {
            libm::expm1(libm::log1p(g * b * whole) / g) / b
        };
        libm::asin(sin2.clamp(0.0, 1.0).sqrt())
    }

    fn student_t(&self) -> Option<StudentT> {
        (self.gamma == 2.0).then(|| StudentT::ggx(self.c).expect("C was checked"))
    }
}
