//! Schlick's rational distribution.

use core::f64::consts::PI;

use super::{ClassicError, Isotropic, check};

/// Schlick's rational distribution, D = m³ x / (π t (m x² − x² + m²)²) with t = cos θ and
/// x = t + m − 1 ≥ 0; zero where t < 1 − m (Schlick 1994, *An Inexpensive BRDF Model for
/// Physically-based Rendering*, <https://doi.org/10.1111/1467-8659.1330233>).
///
/// On this support ∫ D (m·n) dm = 1 holds without a further constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    m: f64,
}

impl Schlick {
    /// The distribution of roughness m; normals reach as far as acos(1 − m).
    ///
    /// # Errors
    /// [`ClassicError`] unless 0 < m ≤ 1.
    pub fn new(m: f64) -> Result<Self, ClassicError> {
        check(m > 0.0 && m <= 1.0, "m", m, "(0, 1]")?;
        Ok(Self { m })
    }

    /// The share of normals with x above the given one, y = x²/m² ∈ [0, 1]: (1 − y)/(m y + 1 − y).
    fn share(&self, y: f64) -> f64 {
        let rest = 1.0 - y;
        rest / (self.m * (1.0 - rest) + rest)
    }
}

impl Isotropic for Schlick {
    fn peak(&self) -> f64 {
        1.0 / (PI * self.m * self.m)
    }

    fn relative_d(&self, theta: f64) -> f64 {
        let half = libm::sin(0.5 * theta);
        // 1 − cos θ without cancellation, and likewise q = m x² + (m² − x²).
        let rest = 2.0 * half * half;
        let (m, t, x) = (self.m, 1.0 - rest, self.m - rest);
        if x <= 0.0 {
            return 0.0;
        }
        let q = m * x * x + rest * (m + x);
        m * m * m * m * m * x / (t * q * q)
    }

    fn support(&self) -> f64 {
        2.0 * libm::asin((0.5 * self.m).sqrt())
    }

    fn cdf(&self, theta: f64) -> f64 {
        let half = libm::sin(0.5 * theta.max(0.0));
        let x = (self.m - 2.0 * half * half).max(0.0) / self.m;
        self.share(x * x)
    }

    fn sample_theta(&self, u: f64) -> f64 {
        // u = r/(m(1 − r) + r) for r = 1 − y.
        let rest = self.m * u / (1.0 - u + self.m * u);
        let x = (1.0 - rest).max(0.0).sqrt();
        // 1 − cos θ = m (1 − x) = m rest/(1 + x).
        2.0 * libm::asin((0.5 * self.m * rest / (1.0 + x)).sqrt())
    }
}
