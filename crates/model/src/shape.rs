//! The shape parameter γ and the one-dimensional slope marginal that belongs to it.

use core::f64::consts::{FRAC_2_SQRT_PI, PI};

use microfacet_core::saturated;
use microfacet_core::shape::{gamma_of_s, s_of_gamma};

use crate::error::ParameterError;
use crate::slope_integrals::{self, Place};

/// Above this γ the Beckmann limit is used: the two differ by O(1/γ), less than a double's
/// rounding.
const BECKMANN_FROM: f64 = 1e16;

/// A validated shape γ ∈ (3/2, ∞] and the in-plane marginal of its *unit slopes*.
///
/// Unit slopes are slopes divided by σ, without the further √(γ−1) of canonical space, so that
/// the whole range of γ is regular, Beckmann included. Their marginal along any direction is
///
/// ```text
/// p(x) = p(0) (1 + s x²)^(−k−1),   s = 1/(γ−1) ∈ [0, 2),   k = γ − 3/2,
/// ```
///
/// which for s = 0 is exp(−x²)/√π: eq. 11 of Ribardière et al. 2017
/// (<https://doi.org/10.1111/cgf.13137>) integrated over one slope. All that Smith's model needs
/// are integrals of p. Slopes enter as [`AsinhSlope`], which stays finite in tails where a
/// floating-point slope overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    gamma: f64,
    /// s = 1/(γ−1); 0 selects the Beckmann formulas.
    s: f64,
    sqrt_s: f64,
    k: f64,
    /// Normalisation of the in-plane slope's marginal in canonical space (exponent −k−1).
    c: f64,
    /// Normalisation of the slope across, given the in-plane slope (exponent −k−3/2).
    c_across: f64,
}

/// A unit slope x ≥ 0 written as w with x = sinh(√s w)/√s (x = w for Beckmann).
///
/// w is finite wherever there is probability; near γ = 3/2 a slope x of 10³⁰⁰ is not rare.
pub type AsinhSlope = f64;

impl Shape {
    /// The shape γ; γ = ∞ is Beckmann.
    ///
    /// # Errors
    /// [`ParameterError::Gamma`] unless γ > 3/2 (NaN included).
    pub fn new(gamma: f64) -> Result<Self, ParameterError> {
        if !(gamma > 1.5) {
            return Err(ParameterError::Gamma(gamma));
        }
        if gamma > BECKMANN_FROM {
            let inf = f64::INFINITY;
            return Ok(Self { gamma, s: 0.0, sqrt_s: 0.0, k: inf, c: inf, c_across: inf });
        }
        let (k, s) = (gamma - 1.5, s_of_gamma(gamma));
        Ok(Self {
            gamma,
            s,
            sqrt_s: s.sqrt(),
            k,
            c: slope_integrals::norm(k),
            c_across: slope_integrals::norm(k + 0.5),
        })
    }

    /// The shape with the given s = 1/(γ−1) ∈ [0, 2); s = 0 is Beckmann. Tables have s as an axis.
    ///
    /// # Errors
    /// [`ParameterError::Gamma`] outside that interval.
    pub fn from_s(s: f64) -> Result<Self, ParameterError> {
        if !(s >= 0.0) {
            return Err(ParameterError::Gamma(gamma_of_s(s)));
        }
        Self::new(gamma_of_s(s))
    }

    /// γ as given.
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// s = 1/(γ−1) ∈ [0, 2); 0 for Beckmann.
    pub fn s(&self) -> f64 {
        self.s
    }

    /// Whether the Beckmann limit is used.
    pub fn is_beckmann(&self) -> bool {
        self.s == 0.0
    }

    /// The asinh slope w of a unit slope x ≥ 0; ∞ for ∞.
    pub fn asinh_slope(&self, x: f64) -> AsinhSlope {
        if self.is_beckmann() { x } else { libm::asinh(self.sqrt_s * x) / self.sqrt_s }
    }

    /// The unit slope x of an asinh slope w ≥ 0; ∞ where x overflows.
    pub fn slope(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() { w } else { libm::sinh(self.sqrt_s * w) / self.sqrt_s }
    }

    /// Sine and cosine of the angle whose tangent is the unit slope of w; accurate where the slope
    /// overflows.
    pub fn unit_sin_cos(&self, w: AsinhSlope) -> (f64, f64) {
        if self.is_beckmann() {
            let r = 1.0 / (1.0 + w * w).sqrt();
            return if w.is_infinite() { (1.0, 0.0) } else { (w * r, r) };
        }
        // In canonical space sin α = tanh v and cos α = 1/cosh v; unit slopes are 1/√s times
        // larger.
        let v = self.sqrt_s * w;
        let (sin, cos) = (libm::tanh(v) / self.sqrt_s, libm::exp(-slope_integrals::ln_cosh(v)));
        let r = 1.0 / (sin * sin + cos * cos).sqrt();
        (sin * r, cos * r)
    }

    /// ln(1 + s x²) = 2 ln cosh(√s w).
    fn ln_kernel(&self, w: AsinhSlope) -> f64 {
        2.0 * slope_integrals::ln_cosh(self.sqrt_s * w)
    }

    /// D at a normal ∝ (x, y, z), z > 0, in unit space, whose length need not be 1: (1 + s
    /// r²/z²)^(−γ)/(π z⁴ a b) with r² = x² + y² and the roughnesses [a, b].
    ///
    /// Finite: for γ < 2 and z → 0, where D has no limit, at most `f64::MAX`. z enters as itself,
    /// since z² underflows for every fourth visible normal at γ = 1.501 and would give 0/0.
    pub(crate) fn d_in_unit_space(&self, r: f64, z: f64, [a, b]: [f64; 2]) -> f64 {
        let (steep, log_z) = (self.sqrt_s * r, libm::log(z));
        let log = if self.is_beckmann() {
            let slope = r / z;
            -slope * slope - 4.0 * log_z
        } else if steep > z {
            // z^(2γ−4) (z² + s r²)^(−γ), so that nothing overflows near the horizon.
            let q = z / steep;
            2.0 * (self.gamma - 2.0) * log_z
                - self.gamma * (2.0 * libm::log(steep) + libm::log1p(q * q))
        } else {
            let q = steep / z;
            -4.0 * log_z - self.gamma * libm::log1p(q * q)
        };
        // Two factors, because the power may underflow where 1/(a b) brings D back, and 0/0 would
        // be NaN.
        let root = libm::exp(0.5 * log);
        saturated((root / a) * (root / b) / PI)
    }

    /// Density of the in-plane unit slope with respect to w: p(x) dx/dw.
    pub fn density(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            return 0.5 * FRAC_2_SQRT_PI * libm::exp(-w * w);
        }
        self.c * self.sqrt_s * libm::exp(-(self.k + 0.5) * self.ln_kernel(w))
    }

    /// Upper tail Q(x) = P(X > x) of the in-plane unit slope for x ≥ 0.
    pub fn tail(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            0.5 * libm::erfc(w)
        } else {
            slope_integrals::tail(self.k, self.c, self.sqrt_s * w)
        }
    }

    /// First moment beyond x ≥ 0: ∫ₓ^∞ ξ p(ξ) dξ = M₀ (1 + s x²)^(−k), in closed form.
    pub fn first_moment(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            return 0.25 * FRAC_2_SQRT_PI * libm::exp(-w * w);
        }
        self.c / (2.0 * self.k * self.sqrt_s) * libm::exp(-self.k * self.ln_kernel(w))
    }

    /// x p(x) dx/dw for x ≥ 0: minus the derivative of [`first_moment`](Self::first_moment), finite
    /// where x overflows.
    pub fn first_moment_density(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            return w * self.density(w);
        }
        self.c * libm::tanh(self.sqrt_s * w) * libm::exp(-self.k * self.ln_kernel(w))
    }

    /// Smith's Λ for a view whose unit cotangent is z = cot θ_v / σ_v ≥ 0.
    ///
    /// `w` is [`asinh_slope(z)`](Self::asinh_slope). Λ = E[(X − z)⁺]/z; ∞ at z = 0 and 0 at z = ∞.
    /// Relative accuracy 1e-12 wherever Λ is a normal double (measured 8e-16 against 200-digit
    /// values where no power is large); of Beckmann 5e-13 up to z = 8, where Λ is 4e-32, and 8e-11
    /// at z = 26, the end of the normal doubles.
    pub fn lambda(&self, w: AsinhSlope) -> f64 {
        if w == 0.0 {
            return f64::INFINITY;
        }
        if self.is_beckmann() {
            return self.beckmann_lambda(w);
        }
        slope_integrals::lambda(self.k, self.c, self.sqrt_s * w)
    }

    /// (exp(−z²)/(z√π) − erfc z)/2. The difference cancels to one part in 2z² for large z, where Λ
    /// itself is of the order of exp(−z²): at z = 8 Λ is 4e-32, with twelve digits.
    fn beckmann_lambda(&self, z: f64) -> f64 {
        if z > 27.5 {
            return 0.0; // below the smallest subnormal
        }
        (0.5 * (libm::exp(-z * z) / (z * PI.sqrt()) - libm::erfc(z))).max(0.0)
    }

    /// Mean excess over the unit slope z of w: E[(X − z)⁺] = z Λ(z), finite down to z = 0.
    pub fn excess(&self, w: AsinhSlope) -> f64 {
        if w == 0.0 {
            return self.first_moment(0.0);
        }
        let z = self.slope(w);
        if z.is_infinite() { 0.0 } else { z * self.lambda(w) }
    }

    /// [`excess`](Self::excess) at the unit slope z, whose square must not overflow: faster than
    /// from w.
    pub(crate) fn excess_at(&self, z: f64) -> f64 {
        if self.is_beckmann() || z == 0.0 {
            return self.excess(z);
        }
        z * slope_integrals::lambda_at(self.k, self.c, self.sqrt_s * z)
    }

    /// [`tail`](Self::tail), [`excess`](Self::excess) and [`density`](Self::density) of one slope,
    /// which share most of their work.
    pub(crate) fn tail_excess_density(&self, w: AsinhSlope) -> [f64; 3] {
        let v = self.sqrt_s * w;
        // Where the slope overflows or vanishes the excess has formulas of its own.
        if self.is_beckmann() || w == 0.0 || v > 700.0 {
            return [self.tail(w), self.excess(w), self.density(w)];
        }
        let place = Place::new(self.k, self.c, v);
        let excess = self.slope(w) * place.lambda();
        [place.tail(), excess, self.c * self.sqrt_s * place.power]
    }

    /// [`tail`](Self::tail), [`first_moment`](Self::first_moment) and the densities of both.
    pub(crate) fn tail_moment_densities(&self, w: AsinhSlope) -> [f64; 4] {
        if self.is_beckmann() {
            let [moment, rate] = [self.first_moment(w), self.first_moment_density(w)];
            return [self.tail(w), moment, self.density(w), rate];
        }
        let place = Place::new(self.k, self.c, self.sqrt_s * w);
        let power = place.flatter_power();
        [
            place.tail(),
            self.c / (2.0 * self.k * self.sqrt_s) * power,
            self.c * self.sqrt_s * place.power,
            self.c * place.tanh * power,
        ]
    }

    /// Upper tail of the slope across, in units of √(1 + s x²): P(T > t), t ≥ 0, for a
    /// density ∝ (1 + s t²)^(−γ).
    pub fn across_tail(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            0.5 * libm::erfc(w)
        } else {
            slope_integrals::tail(self.k + 0.5, self.c_across, self.sqrt_s * w)
        }
    }

    /// Density with respect to w of the slope across, in units of √(1 + s x²).
    pub fn across_density(&self, w: AsinhSlope) -> f64 {
        if self.is_beckmann() {
            return 0.5 * FRAC_2_SQRT_PI * libm::exp(-w * w);
        }
        self.c_across * self.sqrt_s * libm::exp(-(self.k + 1.0) * self.ln_kernel(w))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_has_no_projected_area() {
        for gamma in [1.5, 1.0, 0.0, -2.0, f64::NAN, f64::NEG_INFINITY] {
            assert!(Shape::new(gamma).is_err());
        }
        for s in [2.0, -0.1, f64::NAN] {
            assert!(Shape::from_s(s).is_err());
        }
        assert!(Shape::from_s(0.0).unwrap().is_beckmann());
        assert!(Shape::new(f64::INFINITY).unwrap().is_beckmann());
    }

    #[test]
    fn large_gamma_meets_beckmann() {
        let (near, limit) = (Shape::new(1e9).unwrap(), Shape::new(f64::INFINITY).unwrap());
        for x in [0.0, 0.1, 0.9, 1.1, 2.0, 4.0] {
            for of in [Shape::density, Shape::tail, Shape::first_moment, Shape::excess] {
                let (a, b) = (of(&near, near.asinh_slope(x)), of(&limit, x));
                assert!((a / b - 1.0).abs() < 1e-6, "x = {x}: {a} against {b}");
            }
        }
    }

    #[test]
    fn ggx_lambda_is_the_closed_form() {
        let ggx = Shape::new(2.0).unwrap();
        for z in [1e-8, 1e-3, 0.3, 1.0, 3.0, 1e3] {
            let want = 0.5 * (libm::sqrt(1.0 + 1.0 / (z * z)) - 1.0);
            let got = ggx.lambda(ggx.asinh_slope(z));
            assert!((got - want).abs() < 1e-15 + 2e-15 * want, "z = {z}: {got} against {want}");
        }
    }
}
