//! Gauss–Legendre quadrature over one interval.

use microfacet_core::gauss_legendre;

/// The ten-point rule on [0, 1].
const RULE: [(f64, f64); 10] = gauss_legendre();

/// ∫ₐᵇ f by the ten-point rule: without error for polynomials up to degree 19.
pub(crate) fn panel(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let length = b - a;
    length * RULE.iter().map(|&(x, weight)| weight * f(a + length * x)).sum::<f64>()
}
