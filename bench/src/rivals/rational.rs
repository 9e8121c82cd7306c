//! The rational approximation of masking by Ribardière et al. 2017 (doi:10.1111/cgf.13137), eq.
//! 22–23, with everything that depends on γ prepared beforehand.

use glam::Vec3;

use super::elementary::polynomial;

/// G1 of one material.
#[derive(Clone, Copy)]
pub(crate) struct Rational {
    sigma: f32,
    /// 1/(γ−1) and 3/2 − γ.
    s: f32,
    exponent: f32,
    /// Factor of the first term.
    first: f32,
    /// Factor of the second, F₂₂ and F₂₃ in one: what multiplies F₂₁ is this polynomial over the
    /// denominator of F₂₄.
    second: [f32; 4],
}

/// Numerators and denominators of F₂₁ (its numerator over z) and F₂₄.
const F21: [f32; 3] = [1.066, 2.655, 4.892];
const OVER_F21: [f32; 4] = [1.038, 2.969, 4.305, 4.418];
const F24: [f64; 4] = [6.537, 6.074, -0.623, 5.223];
const OVER_F24: [f64; 4] = [6.538, 6.103, -3.218, 6.347];

/// At this z the approximation has its limit for normal incidence, and powers of z are still
/// finite.
pub(crate) const LARGEST: f32 = 1e5;

impl Rational {
    pub(crate) fn new(sigma: f64, gamma: f64) -> Self {
        let g1 = gamma - 1.0;
        let prefactor =
            (libm::lgamma(gamma - 0.5) - libm::lgamma(gamma)).exp() / std::f64::consts::PI.sqrt();
        let f22 = polynomial(gamma, &[14.402, -27.145, 20.574, -2.745])
            / polynomial(gamma, &[-30.612, 86.567, -84.341, 29.938]);
        let f23 = polynomial(gamma, &[-129.404, 324.987, -299.305, 93.268])
            / polynomial(gamma, &[-92.609, 256.006, -245.663, 86.064]);
        let second = prefactor * g1.sqrt();
        Self {
            sigma: sigma as f32,
            s: (1.0 / g1) as f32,
            exponent: (1.5 - gamma) as f32,
            first: (prefactor * g1 * g1.sqrt() / (2.0 * gamma - 3.0)) as f32,
            second: std::array::from_fn(|i| (second * (f22 * OVER_F24[i] + f23 * F24[i])) as f32),
        }
    }

    /// As printed, above 1 for some views, but with one denominator.
    #[inline(always)]
    pub(crate) fn g1(&self, w: Vec3) -> f32 {
        let z = (w.z / (self.sigma * (w.x * w.x + w.y * w.y).sqrt())).min(LARGEST);
        let first = self.first * (1.0 + z * z * self.s).powf(self.exponent);
        let below = polynomial(z, &OVER_F21) * polynomial(z, &OVER_F24.map(|c| c as f32));
        let second = z * polynomial(z, &F21) * polynomial(z, &self.second);
        let above = z * below;
        above / (0.5 * above + first * below + z * second)
    }
}

#[cfg(test)]
mod tests {
    use microfacet_model::printed::lambda_rational;

    use super::*;

    #[test]
    fn is_the_printed_formula() {
        for gamma in [1.6, 2.0, 4.0, 11.3, 40.0] {
            let prepared = Rational::new(0.5, gamma);
            for degrees in [5.0_f32, 30.0, 60.0, 80.0, 89.0] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let want =
                    1.0 / (1.0 + lambda_rational(gamma, f64::from(cos) / (0.5 * f64::from(sin))));
                let got = f64::from(prepared.g1(Vec3::new(sin, 0.0, cos)));
                assert!(
                    (got - want).abs() < 1e-6,
                    "gamma {gamma}, {degrees} degrees: {got} against {want}"
                );
            }
        }
    }
}
