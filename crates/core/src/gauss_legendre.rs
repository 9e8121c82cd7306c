//! Gauss–Legendre rules on [0, 1], computed at run time or at compile time.

use core::f64::consts::PI;

/// The Gauss–Legendre rule of N points on [0, 1], as (node, weight) with ascending nodes.
///
/// It integrates polynomials up to degree 2N − 1 without error.
///
/// ```
/// const RULE: [(f64, f64); 4] = microfacet_core::gauss_legendre();
/// let integral: f64 = RULE.iter().map(|(x, w)| w * x.powi(7)).sum();
/// assert!((integral - 1.0 / 8.0).abs() < 1e-15);
/// ```
pub const fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let mut rule = [(0.0, 0.0); N];
    fill_gauss_legendre(&mut rule);
    rule
}

/// Fills `rule` with the rule of its length, one or more: for a number of points known at run time.
pub const fn fill_gauss_legendre(rule: &mut [(f64, f64)]) {
    let (n, order) = (rule.len(), rule.len() as f64);
    let mut i = 0;
    while i < n {
        // A root of the Legendre polynomial Pₙ by Newton's method. Six steps: Tricomi's estimate
        // has four digits, and each step doubles them.
        let mut x = -cos(PI * (i as f64 + 0.75) / (order + 0.5));
        let mut slope = 1.0;
        let mut step = 0;
        while step < 6 {
            let (mut p, mut before) = (x, 1.0);
            let mut j = 2;
            while j <= n {
                let k = j as f64;
                (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
                j += 1;
            }
            slope = order * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
            step += 1;
        }
        rule[i] = (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope));
        i += 1;
    }
}

/// cos x for x ∈ [0, π], to a few roundings, as sin(π/2 − x) by its Taylor series, because the
/// library's function is not `const`.
const fn cos(x: f64) -> f64 {
    let y = 0.5 * PI - x;
    let (mut term, mut sum, mut k) = (y, y, 1.0);
    while k < 24.0 {
        term *= -y * y / ((k + 1.0) * (k + 2.0));
        sum += term;
        k += 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power(x: f64, n: usize) -> f64 {
        (0..n).fold(1.0, |product, _| product * x)
    }

    #[test]
    fn integrates_polynomials_exactly() {
        let mut storage = [(0.0, 0.0); 80];
        for n in [1, 2, 5, 8, 12, 20, 33, 80] {
            let rule = &mut storage[..n];
            fill_gauss_legendre(rule);
            for degree in [0, 1, 7, n, 2 * n - 1] {
                if degree < 2 * n {
                    let sum: f64 = rule.iter().map(|&(x, w)| w * power(x, degree)).sum();
                    assert!(
                        (sum * (degree + 1) as f64 - 1.0).abs() < 1e-13,
                        "{n} points, x^{degree}: {sum}"
                    );
                }
            }
            assert!(rule.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
        // One degree more has an error: the check can fail.
        let sum: f64 = gauss_legendre::<2>().iter().map(|&(x, w)| w * power(x, 4)).sum();
        assert!((sum * 5.0 - 1.0).abs() > 1e-3);
    }

    #[test]
    fn nodes_are_those_of_the_literature() {
        // Abramowitz & Stegun 25.4.30, n = 4, on [−1, 1].
        let want = [
            (0.339981043584856265, 0.652145154862546143),
            (0.861136311594052575, 0.347854845137453857),
        ];
        let rule = gauss_legendre::<4>();
        for ((x, w), (got, weight)) in want.into_iter().zip([rule[2], rule[3]]) {
            assert!((2.0 * got - 1.0 - x).abs() < 1e-15 && (2.0 * weight - w).abs() < 1e-15);
        }
    }
}
