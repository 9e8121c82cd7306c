//! The paper's rational approximation of masking (Ribardière et al. 2017, eq. 22–23), with all that depends on γ bound beforehand.

use glam::Vec3;

/// G1 of one material.
pub(crate) struct Rational {
    sigma: f32,
    /// 1/(γ−1) and γ − 3/2.
    s: f32,
    k: f32,
    /// Factors of the first term and of F₂₁, and F₂₂ and F₂₃ of γ.
    first: f32,
    second: f32,
    f22: f32,
    f23: f32,
}

fn polynomial<T: Copy + std::ops::Add<Output = T> + std::ops::Mul<Output = T>>(x: T, c: [T; 4]) -> T {
    c[0] + x * (c[1] + x * (c[2] + x * c[3]))
}

impl Rational {
    pub(crate) fn new(sigma: f64, gamma: f64) -> Self {
        let g1 = gamma - 1.0;
        let prefactor = (libm::lgamma(gamma - 0.5) - libm::lgamma(gamma)).exp() / std::f64::consts::PI.sqrt();
        let f22 = polynomial(gamma, [14.402, -27.145, 20.574, -2.745])
            / polynomial(gamma, [-30.612, 86.567, -84.341, 29.938]);
        let f23 = polynomial(gamma, [-129.404, 324.987, -299.305, 93.268])
            / polynomial(gamma, [-92.609, 256.006, -245.663, 86.064]);
        Self {
            sigma: sigma as f32,
            s: (1.0 / g1) as f32,
            k: (gamma - 1.5) as f32,
            first: (prefactor * g1 * g1.sqrt() / (2.0 * gamma - 3.0)) as f32,
            second: (prefactor * g1.sqrt()) as f32,
            f22: f22 as f32,
            f23: f23 as f32,
        }
    }

    /// As printed: above 1 in places. At normal incidence, where its argument is infinite, 1.
    #[inline(always)]
    pub(crate) fn g1(&self, w: Vec3) -> f32 {
        let z = w.z / (self.sigma * (w.x * w.x + w.y * w.y).sqrt());
        if z > 1e9 {
            return 1.0;
        }
        let first = self.first / z * (1.0 / (1.0 + z * z * self.s)).powf(self.k);
        let f21 = polynomial(z, [0.0, 1.066, 2.655, 4.892]) / polynomial(z, [1.038, 2.969, 4.305, 4.418]);
        let f24 = polynomial(z, [6.537, 6.074, -0.623, 5.223]) / polynomial(z, [6.538, 6.103, -3.218, 6.347]);
        1.0 / (0.5 + first + self.second * f21 * (self.f22 + self.f23 * f24))
    }
}

#[cfg(test)]
mod tests {
    use microfacet_model::printed::lambda_rational;

    use super::*;

    #[test]
    fn is_the_printed_formula() {
        for gamma in [1.6, 2.0, 4.0, 11.3, 40.0] {
            let bound = Rational::new(0.5, gamma);
            for degrees in [5.0_f32, 30.0, 60.0, 80.0, 89.0] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let want = 1.0 / (1.0 + lambda_rational(gamma, f64::from(cos) / (0.5 * f64::from(sin))));
                let got = f64::from(bound.g1(Vec3::new(sin, 0.0, cos)));
                assert!((got - want).abs() < 1e-6, "gamma {gamma}, {degrees} degrees: {got} against {want}");
            }
        }
    }
}
