//! Λ as Ribardière et al. 2017 (<https://doi.org/10.1111/cgf.13137>) print it, in the arrangement
//! of their equations.
//!
//! Kept to show where each formula loses digits or overflows; use
//! [`Shape::lambda`](crate::Shape::lambda) instead. Arguments: γ and the unit cotangent z = cot
//! θ/σ > 0. The study `printed_formulas` compares each with the well-conditioned form.

use core::f64::consts::PI;

/// A printed formula of Λ.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// The numbers of its equations.
    pub equation: &'static str,
    /// A short name.
    pub name: &'static str,
    /// Λ of γ and z; `None` where the formula is not defined at γ.
    pub lambda: fn(f64, f64) -> Option<f64>,
}

/// All printed formulas, by the number of their equation.
pub const FORMS: [Form; 4] = [
    form("13-15", "hypergeometric", |gamma, z| Some(lambda_hypergeometric(gamma, z))),
    form("21", "integer", lambda_integer),
    form("21", "half-integer", lambda_half_integer),
    form("22-23", "rational", |gamma, z| Some(lambda_rational(gamma, z))),
];

const fn form(
    equation: &'static str,
    name: &'static str,
    lambda: fn(f64, f64) -> Option<f64>,
) -> Form {
    Form { equation, name, lambda }
}

/// Λ by eq. 13–15: Γ(γ−½)/(√π Γ(γ)) · [ (γ−1)^γ/((2γ−3) z) · (γ−1+z²)^(3/2−γ) + √(γ−1) z·₂F₁(½,
/// γ−½; 3/2; −z²/(γ−1)) ] − ½.
///
/// Γ(γ) overflows from γ = 171.7, (γ−1)^γ from γ = 144. Wherever Λ is small, cancellation against ½
/// leaves an absolute error of about 1e-16 × the terms, so that G1 may exceed 1 by that much and no
/// digit of a small Λ is right.
pub fn lambda_hypergeometric(gamma: f64, z: f64) -> f64 {
    let g1 = gamma - 1.0;
    let s1 = libm::pow(g1, gamma) / ((2.0 * gamma - 3.0) * z) * libm::pow(g1 + z * z, 1.5 - gamma);
    let s2 = g1.sqrt() * z * hypergeometric(gamma, z * z / g1);
    prefactor(gamma) * (s1 + s2) - 0.5
}

/// Λ by eq. 22–23: eq. 13–15 with z·₂F₁ replaced by the rational functions F₂₁(z)·(F₂₂(γ) + F₂₃(γ)
/// F₂₄(z)).
///
/// Can be negative, so that G1 exceeds 1 (1.002 at γ = 3, z = 3): clamp it. The powers are arranged
/// here so that they do not overflow; Γ(γ) does from γ = 171.7.
pub fn lambda_rational(gamma: f64, z: f64) -> f64 {
    let g1 = gamma - 1.0;
    let ratio = 1.0 / (1.0 + z * z / g1);
    let s1 = g1 * g1.sqrt() / ((2.0 * gamma - 3.0) * z) * libm::pow(ratio, gamma - 1.5);
    let f21 =
        polynomial(z, [0.0, 1.066, 2.655, 4.892]) / polynomial(z, [1.038, 2.969, 4.305, 4.418]);
    let f22 = polynomial(gamma, [14.402, -27.145, 20.574, -2.745])
        / polynomial(gamma, [-30.612, 86.567, -84.341, 29.938]);
    let f23 = polynomial(gamma, [-129.404, 324.987, -299.305, 93.268])
        / polynomial(gamma, [-92.609, 256.006, -245.663, 86.064]);
    let f24 =
        polynomial(z, [6.537, 6.074, -0.623, 5.223]) / polynomial(z, [6.538, 6.103, -3.218, 6.347]);
    prefactor(gamma) * (s1 + g1.sqrt() * f21 * (f22 + f23 * f24)) - 0.5
}

/// Λ by eq. 21 for integer γ ≥ 2: the hypergeometric function becomes an alternating sum of γ−1
/// terms, with prefactor (2γ−2)!/(4^(γ−1) ((γ−1)!)²).
///
/// `None` for other γ and above 1000. The sum cancels as γ grows: at γ = 40 and z = 30 the absolute
/// error of Λ is already 2e-7.
pub fn lambda_integer(gamma: f64, z: f64) -> Option<f64> {
    if gamma < 2.0 || gamma.fract() != 0.0 || gamma > 1e3 {
        return None;
    }
    let g1 = gamma - 1.0;
    let a = z / g1.sqrt();
    let sin = a / (1.0 + a * a).sqrt();
    // (2γ−2)!/(4^(γ−1)((γ−1)!)²) by its product, which does not overflow.
    let mut prefactor = 1.0;
    let mut j = 1.0;
    while j <= g1 {
        prefactor *= (j - 0.5) / j;
        j += 1.0;
    }
    // Σ (−1)^j C(γ−2, j) sin^(2j+1)/(2j+1) = ∫ cos^(2γ−3).
    let (mut binomial, mut power, mut sum, mut j) = (1.0, sin, 0.0, 0.0);
    while j <= gamma - 2.0 {
        sum += binomial * power / (2.0 * j + 1.0);
        binomial *= -(gamma - 2.0 - j) / (j + 1.0);
        power *= sin * sin;
        j += 1.0;
    }
    let first = libm::pow(1.0 + a * a, 1.5 - gamma) / ((2.0 * gamma - 3.0) * a);
    Some(prefactor * g1 * (first + sum) - 0.5)
}

/// Λ by eq. 21 for half-integer γ ≥ 5/2: an arctangent and a sum that runs to γ − 3/2.
///
/// `None` for other γ and above 1000. All terms are positive, so that only the cancellation against
/// ½ limits the accuracy.
pub fn lambda_half_integer(gamma: f64, z: f64) -> Option<f64> {
    let order = gamma - 1.5;
    if order < 1.0 || order.fract() != 0.0 || gamma > 1e3 {
        return None;
    }
    let a = z / (gamma - 1.0).sqrt();
    let cos2 = 1.0 / (1.0 + a * a);
    // ∫₀^φ cos^(2m) = (2m−1)!!/(2m)!! · (φ + sin φ cos φ Σ_{j<m} (2j)!!/(2j+1)!! cos^(2j) φ), and
    // the normalisation is the reciprocal of twice the whole, ½π (2m−1)!!/(2m)!!.
    let (mut term, mut sum, mut j) = (1.0, 0.0, 0.0);
    let mut double_factorials = 1.0;
    while j < order {
        sum += term;
        term *= (2.0 * j + 2.0) / (2.0 * j + 3.0) * cos2;
        double_factorials *= (2.0 * j + 1.0) / (2.0 * j + 2.0);
        j += 1.0;
    }
    let central = (libm::atan(a) + a * cos2 * sum) / PI;
    let first =
        libm::pow(1.0 + a * a, 1.5 - gamma) / ((2.0 * gamma - 3.0) * a) / (PI * double_factorials);
    Some(first + central - 0.5)
}

fn polynomial(x: f64, c: [f64; 4]) -> f64 {
    c[0] + x * (c[1] + x * (c[2] + x * c[3]))
}

/// Γ(γ−½)/(√π Γ(γ)).
fn prefactor(gamma: f64) -> f64 {
    libm::tgamma(gamma - 0.5) / (PI.sqrt() * libm::tgamma(gamma))
}

/// ₂F₁(½, γ−½; 3/2; −x), x ≥ 0, by the power series that converges. All but Pfaff's have positive
/// terms only, and lose no digit.
fn hypergeometric(gamma: f64, x: f64) -> f64 {
    let (y, w) = (x / (1.0 + x), 1.0 / (1.0 + x));
    if gamma.fract() == 0.0 && gamma <= 12.0 {
        // Pfaff's transformation, (1+x)^(−½) ₂F₁(½, 2−γ; 3/2; y), ends after γ−1 terms. They
        // alternate: for larger γ that costs more than three digits.
        return w.sqrt() * series(|n| (0.5 + n) * (2.0 - gamma + n) / ((1.5 + n) * (n + 1.0)) * y);
    }
    if y <= 0.5 {
        // Euler's transformation, (1+x)^(½−γ) ₂F₁(1, γ−½; 3/2; y).
        return libm::pow(w, gamma - 0.5) * series(|n| (gamma - 0.5 + n) / (1.5 + n) * y);
    }
    // Near the branch point, by 1 − y = w (DLMF 15.8.4), the difference to the value at x = ∞.
    let whole = 0.5 * PI.sqrt() * libm::tgamma(gamma - 1.0) / libm::tgamma(gamma - 0.5);
    let missing = series(|n| (gamma - 0.5 + n) / (gamma + n) * w) / (2.0 * (gamma - 1.0));
    whole / x.sqrt() - libm::pow(w, gamma - 0.5) * missing
}

/// 1 + r(0) + r(0) r(1) + …, to rounding.
fn series(ratio: impl Fn(f64) -> f64) -> f64 {
    let (mut term, mut sum, mut n) = (1.0, 1.0, 0.0);
    while f64::abs(term) > 1e-17 * f64::abs(sum) && n < 1e4 {
        term *= ratio(n);
        sum += term;
        n += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;

    fn exact(gamma: f64, z: f64) -> f64 {
        let shape = Shape::new(gamma).unwrap();
        shape.lambda(shape.asinh_slope(z))
    }

    #[test]
    fn printed_forms_agree_where_they_are_sound() {
        let cases: [(usize, &[f64], f64); 3] = [
            (0, &[1.6, 2.0, 2.5, 3.0, 7.3, 20.0], 1e-11),
            (1, &[2.0, 3.0, 4.0, 10.0], 1e-13),
            (2, &[2.5, 3.5, 8.5, 40.5], 1e-14),
        ];
        for (i, gammas, tolerance) in cases {
            for (&gamma, z) in gammas.iter().flat_map(|g| [0.05, 0.4, 1.0, 2.5].map(|z| (g, z))) {
                let (Form { name, lambda, .. }, want) = (FORMS[i], exact(gamma, z));
                let error = (lambda(gamma, z).unwrap() - want).abs();
                assert!(error < tolerance * (1.0 + want), "{name} at {gamma}, z {z}: {error}");
            }
        }
        // Toward the branch point of the hypergeometric function only the cancellation against ½
        // is left.
        for z in [4.0, 30.0, 1e3, 1e5] {
            for gamma in [1.51, 1.6, 2.0, 2.5, 7.3, 12.0, 13.0, 40.0, 100.0] {
                let error = (lambda_hypergeometric(gamma, z) - exact(gamma, z)).abs();
                assert!(error < 1e-13, "eq. 13 at gamma {gamma}, z {z}: {error}");
            }
        }
        assert!(lambda_integer(2.5, 1.0).is_none() && lambda_half_integer(3.0, 1.0).is_none());
    }

    #[test]
    fn every_form_of_the_list_gives_g1_where_it_is_defined() {
        for (gamma, defined) in [
            (3.0, ["hypergeometric", "integer", "rational"]),
            (2.5, ["hypergeometric", "half-integer", "rational"]),
        ] {
            let checked = |Form { name, lambda, .. }: Form| {
                let [found, truth] =
                    [lambda(gamma, 1.0)?, exact(gamma, 1.0)].map(|x| 1.0 / (1.0 + x));
                let error = (found - truth).abs();
                // The error of eq. 22–23 is at most 6.9e-3 (`docs/formulas.md`).
                let tolerance = if name == "rational" { 7e-3 } else { 1e-14 };
                assert!(error < tolerance, "{name} at gamma {gamma}: {error}");
                Some(name)
            };
            assert_eq!(FORMS.into_iter().filter_map(checked).collect::<Vec<_>>(), defined);
        }
    }

    #[test]
    fn printed_forms_fail_where_their_docs_say() {
        assert!((lambda_integer(40.0, 30.0).unwrap() - exact(40.0, 30.0)).abs() > 1e-9);
        assert!(!lambda_hypergeometric(172.0, 1.0).is_finite());
        assert!(1.0 / (1.0 + lambda_rational(3.0, 3.0)) > 1.001);
    }
}
