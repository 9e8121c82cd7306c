//! Pearson's χ² test of a histogram against expected counts.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Cells expected to hold fewer than this are pooled, the usual condition for the χ² approximation.
const LEAST_EXPECTED: f64 = 5.0;

/// Outcome of a χ² test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ (observed − expected)²/expected over the pooled cells.
    pub statistic: f64,
    /// Degrees of freedom: cells after pooling, less one.
    pub degrees: usize,
    /// Probability of a larger statistic if the counts do come from the expected distribution.
    pub p: f64,
}

/// Tests `observed` counts against `expected` ones, cell by cell.
///
/// Cells expected to hold fewer than 5 are pooled until they hold 5 together; a remainder joins the
/// last group. A count in a cell of expectation 0 rejects: p = 0.
///
/// # Panics
/// If the two differ in length.
pub fn chi_square(observed: &[u64], expected: &[f64]) -> ChiSquare {
    assert_eq!(observed.len(), expected.len());
    let impossible =
        observed.iter().zip(expected).any(|(&count, &mean)| count > 0 && !(mean > 0.0));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    let mut pool = (0.0, 0.0);
    for (&count, &mean) in observed.iter().zip(expected) {
        let cell = (count as f64, mean);
        if mean >= LEAST_EXPECTED {
            groups.push(cell);
            continue;
        }
        pool = (pool.0 + cell.0, pool.1 + cell.1);
        if pool.1 >= LEAST_EXPECTED {
            groups.push(pool);
            pool = (0.0, 0.0);
        }
    }
    match groups.last_mut() {
        Some(last) => *last = (last.0 + pool.0, last.1 + pool.1),
        None => groups.push(pool),
    }
    let statistic = groups.iter().map(|(count, mean)| (count - mean) * (count - mean) / mean).sum();
    let degrees = groups.len() - 1;
    let p = match ChiSquared::new(degrees as f64) {
        _ if impossible => 0.0,
        Ok(distribution) => distribution.sf(statistic),
        // A single group tests nothing.
        Err(_) => 1.0,
    };
    ChiSquare { statistic, degrees, p }
}

/// Significance level for each of `tests` tests so that all together falsely reject with
/// probability `level` (Šidák).
pub fn sidak(level: f64, tests: usize) -> f64 {
    -libm::expm1(libm::log1p(-level) / tests.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistic_and_pooling() {
        let even = chi_square(&[48, 52], &[50.0, 50.0]);
        assert!((even.statistic - 0.16).abs() < 1e-12 && even.degrees == 1);
        assert!((even.p - 0.689).abs() < 1e-3);
        // Three cells of 2 are gathered into one of 6.
        assert_eq!(chi_square(&[2, 2, 2, 50], &[2.0, 2.0, 2.0, 50.0]).degrees, 1);
        assert_eq!(chi_square(&[1, 99], &[0.0, 100.0]).p, 0.0);
        assert!(chi_square(&[100, 0], &[50.0, 50.0]).p < 1e-20);
    }

    #[test]
    fn sidak_is_nearly_bonferroni() {
        assert!((sidak(0.01, 1000) / (0.01 / 1000.0) - 1.0).abs() < 0.01);
    }
}
