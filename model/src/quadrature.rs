//! Gauss–Legendre quadrature.

/// Positive nodes and weights of the ten-point rule on [−1, 1] (Abramowitz & Stegun 25.4.30).
pub(crate) const GAUSS_LEGENDRE_10: [(f64, f64); 5] = [
    (0.148874338981631211, 0.295524224714752870),
    (0.433395394129247191, 0.269266719309996355),
    (0.679409568299024406, 0.219086362515982044),
    (0.865063366688984511, 0.149451349150580593),
    (0.973906528517171720, 0.066671344308688138),
];

/// ∫ₐᵇ f by the ten-point rule: exact for polynomials up to degree 19.
pub(crate) fn panel(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (half, middle) = (0.5 * (b - a), 0.5 * (a + b));
    half * GAUSS_LEGENDRE_10
        .iter()
        .map(|&(x, weight)| weight * (f(middle - half * x) + f(middle + half * x)))
        .sum::<f64>()
}
