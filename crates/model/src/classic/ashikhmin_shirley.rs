//! The anisotropic cosine power of Ashikhmin & Shirley as a distribution of normals.

use core::f64::consts::PI;

use glam::DVec3;

use super::{ClassicError, check};
use crate::student_t::StudentT;

/// Anisotropic cosine power, D = √((Nx+2)(Ny+2))/(2π) · cos^(Nx cos²φ + Ny sin²φ) θ (Ashikhmin &
/// Shirley 2000, *An Anisotropic Phong BRDF Model*,
/// <https://doi.org/10.1080/10867651.2000.10487522>).
///
/// The constant normalises ∫ D (m·n) dm, where the paper's √((Nx+1)(Ny+1))/(2π) normalises ∫ D dm.
/// For Nx = Ny it is Blinn–Phong. Otherwise no linear map of slopes makes it isotropic, so that it
/// can be evaluated and sampled but has no tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AshikhminShirley {
    nx: f64,
    ny: f64,
}

impl AshikhminShirley {
    /// The distribution with exponents Nx along x and Ny along y.
    ///
    /// # Errors
    /// [`ClassicError`] unless both lie in [0, ∞).
    pub fn new(nx: f64, ny: f64) -> Result<Self, ClassicError> {
        for (name, n) in [("nx", nx), ("ny", ny)] {
            check((0.0..f64::INFINITY).contains(&n), name, n, "[0, inf)")?;
        }
        Ok(Self { nx, ny })
    }

    /// The exponent at the azimuth whose cosine and sine are proportional to x and y.
    fn exponent(&self, x: f64, y: f64) -> f64 {
        let r2 = x * x + y * y;
        if r2 > 0.0 { (self.nx * x * x + self.ny * y * y) / r2 } else { self.nx }
    }

    /// D(m) per steradian; 0 for m at or below the horizon.
    pub fn d(&self, m: DVec3) -> f64 {
        ((self.nx + 2.0) * (self.ny + 2.0)).sqrt() / (2.0 * PI) * self.relative_d(m)
    }

    /// D relative to its peak, D(m)/D(n) ∈ [0, 1].
    pub fn relative_d(&self, m: DVec3) -> f64 {
        if m.z > 0.0 { libm::pow(m.z, self.exponent(m.x, m.y)) } else { 0.0 }
    }

    /// Angle from n (radians), in the azimuth φ, at which D has fallen to half; `None` where the
    /// exponent is 0.
    pub fn half_angle(&self, phi: f64) -> Option<f64> {
        let n = self.exponent(libm::cos(phi), libm::sin(phi));
        // acos(2^(−1/N)) as asin √(1 − 2^(−2/N)), which keeps the digits of large N.
        (n > 0.0).then(|| libm::asin((-libm::expm1(-2.0 * core::f64::consts::LN_2 / n)).sqrt()))
    }

    /// A normal distributed as D(m)(m·n) from u ∈ [0, 1)².
    pub fn sample_ndf(&self, u: [f64; 2]) -> DVec3 {
        // tan φ = √((Nx+2)/(Ny+2)) tan 2πu₂, in the quadrant of 2πu₂.
        let angle = 2.0 * PI * u[1];
        let (x, y) =
            ((self.ny + 2.0).sqrt() * libm::cos(angle), (self.nx + 2.0).sqrt() * libm::sin(angle));
        let r = libm::hypot(x, y);
        let e = -2.0 * libm::log1p(-u[0]) / (self.exponent(x, y) + 2.0);
        // cos²θ = exp(−e).
        let (cos, sin) = (libm::exp(-0.5 * e), (-libm::expm1(-e)).sqrt());
        DVec3::new(sin * x / r, sin * y / r, cos)
    }

    /// The equal member of the Student-t family: Blinn–Phong if both exponents are equal, else
    /// `None`.
    pub fn student_t(&self) -> Option<StudentT> {
        (self.nx == self.ny)
            .then(|| StudentT::blinn_phong(self.nx).expect("exponents were checked"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::panel;

    fn composite(a: f64, b: f64, panels: usize, f: impl Fn(f64) -> f64) -> f64 {
        let step = (b - a) / panels as f64;
        (0..panels).map(|i| panel(a + i as f64 * step, a + (i + 1) as f64 * step, &f)).sum()
    }

    #[test]
    fn normalised_and_sampled_alike() {
        let d = AshikhminShirley::new(60.0, 4.0).unwrap();
        let at = |theta: f64, phi: f64| {
            let ((sin, cos), (y, x)) = (libm::sincos(theta), libm::sincos(phi));
            DVec3::new(sin * x, sin * y, cos)
        };
        let share = |theta: f64, phi: f64| {
            composite(0.0, phi, 16, |p| {
                composite(0.0, theta, 16, |t| d.d(at(t, p)) * libm::sin(t) * libm::cos(t))
            })
        };
        assert!((share(0.5 * PI, 2.0 * PI) - 1.0).abs() < 1e-11);
        // The share of azimuths up to the drawn one is u₂; at that azimuth the share of angles up
        // to the drawn one is u₁.
        for u in [[0.3, 0.1], [0.9, 0.4], [0.5, 0.8]] {
            let m = d.sample_ndf(u);
            let phi = libm::atan2(m.y, m.x).rem_euclid(2.0 * PI);
            assert!((share(0.5 * PI, phi) - u[1]).abs() < 1e-10, "{u:?}");
            let n = d.exponent(m.x, m.y);
            assert!((1.0 - libm::pow(m.z, n + 2.0) - u[0]).abs() < 1e-13, "{u:?}");
        }
        let half = d.half_angle(0.3).unwrap();
        assert!((d.relative_d(at(half, 0.3)) - 0.5).abs() < 1e-14);
    }
}
