//! The two ways to write the shape: γ ∈ (3/2, ∞], as the Student-t paper does (Ribardière et al.
//! 2017, <https://doi.org/10.1111/cgf.13137>), and s = 1/(γ−1) ∈ [0, 2), which is always finite
//! (Beckmann is s = 0, GGX s = 1) and in which tabulated quantities are smooth.

/// The end of s, which is excluded: as γ → 3/2 the projected area diverges.
pub const S_END: f64 = 2.0;

/// The shape s = 1/(γ−1) of γ; 0 for γ = ∞.
pub fn s_of_gamma(gamma: f64) -> f64 {
    1.0 / (gamma - 1.0)
}

/// The shape γ = 1 + 1/s of s; ∞ for s = 0.
pub fn gamma_of_s(s: f64) -> f64 {
    1.0 + 1.0 / s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_and_the_ends() {
        for gamma in [1.501, 1.8, 2.0, 3.0, 1e6, 1e12] {
            let s = s_of_gamma(gamma);
            assert!(s > 0.0 && s < S_END);
            // An ulp of s is γ s ulps of γ − 1.
            assert!((gamma_of_s(s) / gamma - 1.0).abs() < 4.0 * f64::EPSILON, "{gamma}");
        }
        assert_eq!((s_of_gamma(f64::INFINITY), gamma_of_s(0.0)), (0.0, f64::INFINITY));
        assert_eq!((s_of_gamma(2.0), gamma_of_s(S_END)), (1.0, 1.5));
    }
}
