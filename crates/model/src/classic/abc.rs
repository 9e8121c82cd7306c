//! The ABC distribution of Löw and others.

use core::f64::consts::{FRAC_PI_2, LN_2, PI};

use super::{ClassicError, Isotropic, check};
use crate::student_t::StudentT;

/// The largest B and C: powers of them stay numbers.
const LARGEST: f64 = 1e150;

/// The microfacet distribution of Löw, Kronander, Ynnerman and Unger 2012, *BRDF Models for
/// Accurate and Efficient Rendering of Glossy Surfaces*
/// (<https://doi.org/10.1145/2077341.2077350>), D ∝ (1 + B (1 − m·n))^(−C).
///
/// It is called after its parameters: A is a scale of the reflectance there, and here the constant
/// that makes ∫ D (m·n) dm = 1. B is a width, D having fallen where 1 − cos θ ≈ 1/B, and C is how
/// steeply D falls beyond. D does not vanish at the horizon: the density of slopes falls like r⁻⁴
/// for every C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abc {
    b: f64,
    c: f64,
    /// ∫ (1 − x)(1 + B x)^(−C) dx over x = 1 − cos θ ∈ [0, 1]; 1/(2π) of it is D(0).
    whole: f64,
}

impl Abc {
    /// The distribution of B and C; at B = 0 or C = 0 all normals have the same D, as those of a
    /// Blinn–Phong of exponent 0.
    ///
    /// # Errors
    /// [`ClassicError`] unless both lie in [0, 1e150].
    pub fn new(b: f64, c: f64) -> Result<Self, ClassicError> {
        check((0.0..=LARGEST).contains(&b), "b", b, "[0, 1e150]")?;
        check((0.0..=LARGEST).contains(&c), "c", c, "[0, 1e150]")?;
        Ok(Self { b, c, whole: falling(b, c) })
    }
}

/// ∫₀¹ (1 + b x)^(−c) dx = (ℓ/b) exp[0, (1−c) ℓ] with ℓ = ln(1 + b), and exp[·] a divided
/// difference.
fn constant(b: f64, c: f64) -> f64 {
    let log = libm::log1p(b);
    per(log, b) * difference(0.0, (1.0 - c) * log)
}

/// ∫₀¹ (1 − x)(1 + b x)^(−c) dx = (ℓ/b)² exp[0, ℓ, (2−c) ℓ]: where b → 0, c = 1 or c = 2, of which
/// two arguments are equal, the difference is a derivative, and nothing is divided by zero.
fn falling(b: f64, c: f64) -> f64 {
    let log = libm::log1p(b);
    let scale = per(log, b);
    let mut at = [0.0, log, (2.0 - c) * log];
    at.sort_by(f64::total_cmp);
    scale * (scale * second_difference(at))
}

/// ln(1 + b)/b, 1 at b = 0.
fn per(log: f64, b: f64) -> f64 {
    if b > 0.0 { log / b } else { 1.0 }
}

/// exp[a, b], the divided difference (eᵇ − eᵃ)/(b − a), symmetric.
fn difference(a: f64, b: f64) -> f64 {
    // From the larger, whose power is a number wherever the difference is.
    let step = (a - b).abs();
    libm::exp(a.max(b)) * if step == 0.0 { 1.0 } else { -libm::expm1(-step) / step }
}

/// exp[a, b, c] for ascending arguments.
fn second_difference([a, b, c]: [f64; 3]) -> f64 {
    let (near, far) = (b - a, c - a);
    if far > 1.0 {
        // The two first differences are on different sides of eᵇ: at least a third is left.
        return (difference(b, c) - difference(a, b)) / far;
    }
    // Σ hₖ/(k+2)! with hₖ the sum of all products of k factors near or far, each at most 1: what is
    // left out is below (k+1)/(k+2)! = 1e-18 at k = 18.
    let (mut power, mut products, mut factorial, mut sum) = (1.0, 1.0, 2.0, 0.5);
    for k in 1..=18 {
        power *= near;
        products = power + far * products;
        factorial *= f64::from(k + 2);
        sum += products / factorial;
    }
    libm::exp(a) * sum
}

/// x = 1 − cos θ ∈ [0, 1], without cancellation.
fn rest(theta: f64) -> f64 {
    let half = libm::sin(0.5 * theta);
    (2.0 * half * half).min(1.0)
}

impl Isotropic for Abc {
    fn peak(&self) -> f64 {
        1.0 / (2.0 * PI * self.whole)
    }

    fn relative_d(&self, theta: f64) -> f64 {
        libm::exp(-self.c * libm::log1p(self.b * rest(theta)))
    }

    fn half_angle(&self) -> Option<f64> {
        let x = libm::expm1(LN_2 / self.c) / self.b;
        (x <= 1.0).then(|| 2.0 * libm::asin((0.5 * x).sqrt()))
    }

    /// In closed form: up to x the integral is x ((1−x) ∫ (1 + b x t)^(−c) dt + x ∫ (1−t) …) over
    /// t ∈ [0, 1].
    fn cdf(&self, theta: f64) -> f64 {
        let x = rest(theta.clamp(0.0, FRAC_PI_2));
        let b = self.b * x;
        let below = x * ((1.0 - x) * constant(b, self.c) + x * falling(b, self.c));
        (below / self.whole).min(1.0)
    }

    fn student_t(&self) -> Option<StudentT> {
        (self.b == 0.0 || self.c == 0.0).then(|| StudentT::ggx(1.0).expect("1 is a roughness"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classic::{Member, projected};
    use crate::quadrature;

    fn abc(b: f64, c: f64) -> Abc {
        Abc::new(b, c).unwrap()
    }

    #[test]
    fn the_constant_is_that_of_quadrature_at_every_corner() {
        for b in [1e-200, 1e-12, 1e-5, 0.3, 1.7, 40.0, 1e4, 1e9] {
            for c in [0.0, 1e-9, 0.5, 1.0 - 1e-9, 1.0, 1.0 + 1e-12, 1.5, 2.0, 2.0 + 1e-9, 3.0, 40.0]
            {
                // Panels in equal steps of ln(1 + b x), in which the integrand is a sum of
                // exponentials.
                let log = libm::log1p(b);
                let panels = (8.0 * log * (2.0 + c)).ceil().max(1.0) as u32;
                let at = |i: u32| libm::expm1(log * f64::from(i) / f64::from(panels)) / b;
                let integrand = |x: f64| (1.0 - x) * libm::exp(-c * libm::log1p(b * x));
                let sum: f64 =
                    (0..panels).map(|i| quadrature::panel(at(i), at(i + 1), integrand)).sum();
                let got = falling(b, c);
                assert!((got / sum - 1.0).abs() < 1e-12, "B {b}, C {c}: {got}, not {sum}");
            }
        }
        assert_eq!(falling(0.0, 3.0), 0.5);
        assert!((falling(5.0, 0.0) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_wide_one_is_flat() {
        let flat = Member::blinn_phong(0.0).unwrap();
        for d in [abc(0.0, 3.0), abc(30.0, 0.0), abc(1e-300, 2.0), abc(1e-14, 1.0)] {
            for theta in [0.0, 0.4, 1.5] {
                assert!((d.d(theta) / flat.d(theta) - 1.0).abs() < 1e-12, "{d:?}");
                assert!((d.cdf(theta) - flat.cdf(theta)).abs() < 1e-12, "{d:?}");
            }
            assert_eq!(d.half_angle(), None);
        }
        assert_eq!(abc(0.0, 3.0).student_t(), flat.student_t());
        assert!(abc(1e-300, 2.0).student_t().is_none());
    }

    #[test]
    fn shares_are_those_of_d() {
        for (b, c) in [(10.0, 1.0), (400.0, 2.0), (1e5, 0.7), (1e3, 1.6), (1e-3, 1e5), (0.5, 30.0)]
        {
            let d = abc(b, c);
            let mut last = 0.0;
            for theta in [1e-9, 1e-4, 0.01, 0.1, 0.7, 1.2, 1.5, FRAC_PI_2] {
                let share = d.cdf(theta);
                let want = projected(|t| d.d(t), d.half_angle().unwrap_or(1.0), theta);
                assert!(
                    (share - want).abs() < 1e-10 * want,
                    "{d:?} at {theta}: {share}, not {want}"
                );
                assert!(share >= last, "{d:?} at {theta}");
                last = share;
            }
            assert!((last - 1.0).abs() < 1e-14, "{d:?}: {last}");
        }
    }

    #[test]
    fn the_ends_of_its_range_have_a_density() {
        for b in [0.0, 5e-324, 1e-20, 1.0, 1e20, LARGEST] {
            for c in [0.0, 5e-324, 0.5, 1.0, 2.0, 20.0, LARGEST] {
                let d = abc(b, c);
                assert!(d.peak() > 0.1 && d.peak() < f64::INFINITY, "{d:?}: {}", d.peak());
                assert!((0.0..=1.0).contains(&d.relative_d(1.0)), "{d:?}");
                let theta = d.sample_theta(0.5);
                assert!((0.0..FRAC_PI_2).contains(&theta), "{d:?}: {theta}");
                assert!((d.cdf(FRAC_PI_2) - 1.0).abs() < 1e-14 && d.cdf(0.0) == 0.0, "{d:?}");
            }
        }
        for (b, c, name) in
            [(-1e-9, 1.0, "b = -"), (f64::NAN, 1.0, "b = NaN"), (1.0, 1e151, "c = ")]
        {
            let message = Abc::new(b, c).unwrap_err().to_string();
            assert!(message.starts_with(name) && message.contains("[0, 1e150]"), "{message}");
        }
    }
}
