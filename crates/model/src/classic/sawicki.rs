//! Sawicki's rational distribution.

use core::f64::consts::PI;

use super::{ClassicError, Isotropic, check};

/// Sawicki's rational distribution, D = 96 (N+3) t/(π ((1−N) t + N+3)⁴) with t = cos θ (Sawicki
/// 2021, *Microfacet Distribution Function: To Change or Not to Change, That Is the Question*,
/// table 1, <https://doi.org/10.5220/0010252702090220>, where its parameter is `N_DS`).
///
/// ∫ D (m·n) dm = 1 holds as it stands, and the share of the projected area within θ is
/// 1 − (4t/((1−N) t + N+3))³, which is inverted in closed form. Near its peak it falls like
/// Blinn–Phong with the same N, 1 − N θ²/2, and further out more slowly; at the horizon like cos θ,
/// so the density of its slopes falls like r⁻⁵.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sawicki {
    n: f64,
}

impl Sawicki {
    /// The distribution of exponent N. At N = 0 its top is flat; it would have a dip there for
    /// smaller N.
    ///
    /// # Errors
    /// [`ClassicError`] unless 0 ≤ N < ∞.
    pub fn new(n: f64) -> Result<Self, ClassicError> {
        check((0.0..f64::INFINITY).contains(&n), "n", n, "[0, inf)")?;
        Ok(Self { n })
    }

    /// 1 − t for t = cos θ, without cancellation at small θ; at most 1, the value at the horizon.
    fn rest(theta: f64) -> f64 {
        let half = libm::sin(0.5 * theta);
        (2.0 * half * half).min(1.0)
    }
}

impl Isotropic for Sawicki {
    fn peak(&self) -> f64 {
        0.375 / PI * (self.n + 3.0)
    }

    fn relative_d(&self, theta: f64) -> f64 {
        // (1−N) t + N+3 = 4 (1 + (N−1)(1 − t)/4).
        let q = 1.0 + 0.25 * (self.n - 1.0) * Self::rest(theta);
        let q2 = q * q;
        libm::cos(theta).max(0.0) / (q2 * q2)
    }

    fn cdf(&self, theta: f64) -> f64 {
        let rest = Self::rest(theta.max(0.0));
        // x = 1 − 4t/((1−N) t + N+3), and 1 − (1 − x)³ multiplied out: digits as θ → 0.
        let x = (self.n + 3.0) * rest / (4.0 + (self.n - 1.0) * rest);
        x * (3.0 - x * (3.0 - x))
    }

    fn sample_theta(&self, u: f64) -> f64 {
        // w = ∛(1 − u), and 1 − w with its digits as u → 0; w = 4t/((1−N) t + N+3) solved for t.
        let log = libm::log1p(-u) / 3.0;
        let (w, down) = (libm::exp(log), -libm::expm1(log));
        let below = 4.0 + (self.n - 1.0) * w;
        let (t, rest) = ((self.n + 3.0) * w / below, 4.0 * down / below);
        // sin²θ = (1 − t)(1 + t); both sine and cosine keep their digits.
        libm::atan2((rest * (1.0 + t)).sqrt(), t)
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn it_is_the_printed_formula() {
        for n in [0.0, 1.0, 12.04, 300.0] {
            let d = Sawicki::new(n).unwrap();
            for theta in [0.0, 0.1, 0.8, 1.5, 1.57] {
                let t = libm::cos(theta);
                let printed = 96.0 * (3.0 + n) * t / (PI * libm::pow((1.0 - n) * t + n + 3.0, 4.0));
                assert!((d.d(theta) / printed - 1.0).abs() < 1e-12, "{n} at {theta}");
                let share = 1.0 - libm::pow(4.0 * t / ((1.0 - n) * t + n + 3.0), 3.0);
                assert!((d.cdf(theta) - share).abs() < 1e-14, "{n} at {theta}");
            }
            assert_eq!(d.d(FRAC_PI_2), 0.0);
        }
    }

    #[test]
    fn the_ends_of_random_numbers_and_of_its_range_have_angles() {
        for n in [0.0, 1.0, 50.0, 1e6, 1e12, 1e300, f64::MAX] {
            let d = Sawicki::new(n).unwrap();
            assert_eq!((d.sample_theta(0.0), d.sample_theta(1.0)), (0.0, FRAC_PI_2), "{n}");
            assert!(d.cdf(0.0) == 0.0 && (d.cdf(FRAC_PI_2) - 1.0).abs() < 1e-15, "{n}");
            assert!(d.d(0.0) > 0.0 && (0.0..=1.0).contains(&d.relative_d(1.5)), "{n}");
        }
        for n in [0.0, 1.0, 50.0, 1e6, 1e12, 1e200] {
            let d = Sawicki::new(n).unwrap();
            let mut last = 0.0;
            for u in [1e-100, 1e-30, 1e-9, 0.01, 0.5, 0.99] {
                let theta = d.sample_theta(u);
                assert!(theta > last && theta < FRAC_PI_2, "{n}: {u} gives {theta}");
                assert!((d.cdf(theta) / u - 1.0).abs() < 1e-12, "{n}: {u} gives {theta}");
                last = theta;
            }
        }
    }

    #[test]
    fn it_nowhere_exceeds_its_peak() {
        for n in [0.0, 0.1, 0.9, 1.0, 1.1, 30.0] {
            let d = Sawicki::new(n).unwrap();
            let mut last = 1.0;
            for i in 0..=9000 {
                let relative = d.relative_d(f64::from(i) * FRAC_PI_2 / 9000.0);
                assert!((0.0..=last).contains(&relative), "{n}, step {i}");
                last = relative;
            }
        }
        // N → 0 is flat at the top: what is left there is of the fourth order.
        let drop = 1.0 - Sawicki::new(0.0).unwrap().relative_d(1e-2);
        assert!((0.0..2e-9).contains(&drop), "{drop}");
    }

    #[test]
    fn the_half_angle_is_that_of_equation_10() {
        for h in [1e-7, 1e-4, 0.03, 0.4, 0.9] {
            // N = (cos h + 3 − 4 ∜(2 cos h))/(cos h − 1) with 1 − cos h and ∜(2 cos h) formed
            // without cancellation.
            let rest = Sawicki::rest(h);
            let root = libm::exp(0.25 * (core::f64::consts::LN_2 + libm::log1p(-rest)));
            let n = (4.0 * (root - 1.0) + rest) / rest;
            let found = Sawicki::new(n).unwrap().half_angle().unwrap();
            assert!((found / h - 1.0).abs() < 1e-12, "N = {n}: {found} for {h}");
        }
    }
}
