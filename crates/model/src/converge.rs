//! Quadrature at rising orders until two successive ones agree.

use crate::panels::Gauss;

/// Points per panel at successive orders; the error of an order is estimated from the one before.
const LEVELS: [usize; 7] = [5, 7, 10, 14, 20, 28, 40];

/// Share of the visible slopes that is left out, relative to the tolerance.
pub(crate) const CUT: f64 = 1e-3;

/// The rules of all orders.
pub(crate) fn rules() -> Vec<Gauss> {
    LEVELS.iter().map(|&n| Gauss::new(n)).collect()
}

/// The integral at the first order that is accurate enough, or else at the last, and an upper
/// estimate of its error.
///
/// The estimate is `factor` times the largest difference between the last two orders, plus what the
/// cut leaves out, which no order sees.
pub(crate) fn converge<const N: usize>(
    rules: &[Gauss],
    tolerance: f64,
    factor: f64,
    integrate: impl Fn(&Gauss) -> [[f64; N]; 2],
) -> ([[f64; N]; 2], f64) {
    // The lowest two orders were seen to agree to 5e-8 by chance, both off by three times that.
    let rules = if tolerance < 1e-6 { &rules[1..] } else { rules };
    let mut before = integrate(&rules[0]);
    let mut error = f64::INFINITY;
    for rule in &rules[1..] {
        let now = integrate(rule);
        let pairs = now.iter().flatten().zip(before.iter().flatten());
        let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        error = factor * change + 10.0 * CUT * tolerance;
        before = now;
        if error < tolerance {
            break;
        }
    }
    (before, error)
}
