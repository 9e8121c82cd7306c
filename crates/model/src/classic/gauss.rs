//! The Gaussian of the polar angle (Torrance & Sparrow 1967,
//! <https://doi.org/10.1364/JOSA.57.001105>), with its constant by quadrature.

use core::f64::consts::FRAC_PI_2;

use super::{ClassicError, Isotropic, check, projected};

/// Gaussian of the polar angle, D ∝ exp(−(θ/m)²), with m in radians.
///
/// The usual constant 1/(π m²) is the small-angle limit: it is too low for ∫ D (m·n) dm = 1, by
/// about ⅔ m² (0.7% at m = 0.1). The constant used here is found by quadrature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauss {
    m: f64,
    peak: f64,
}

impl Gauss {
    /// The distribution of width m: D falls to 1/e at θ = m radians.
    ///
    /// # Errors
    /// [`ClassicError`] unless 0 < m < ∞.
    pub fn new(m: f64) -> Result<Self, ClassicError> {
        check(m > 0.0 && m < f64::INFINITY, "m", m, "(0, inf) radians")?;
        let unit = |t: f64| libm::exp(-(t / m) * (t / m));
        // Beyond 7 m the tail is less than 1e-21.
        let whole = projected(unit, m, FRAC_PI_2.min(7.0 * m));
        Ok(Self { m, peak: 1.0 / whole })
    }
}

impl Isotropic for Gauss {
    fn peak(&self) -> f64 {
        self.peak
    }

    fn relative_d(&self, theta: f64) -> f64 {
        libm::exp(-(theta / self.m) * (theta / self.m))
    }

    fn half_angle(&self) -> Option<f64> {
        let theta = self.m * core::f64::consts::LN_2.sqrt();
        (theta <= FRAC_PI_2).then_some(theta)
    }
}
