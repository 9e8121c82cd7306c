//! The shape axis of G1 and of visible normals: s = 1/(γ−1).

use alloc::vec::Vec;

use microfacet_core::shape::{S_END, gamma_of_s, s_of_gamma};

use super::coordinate::{Coordinate, Placement, bisect, even_nodes};

/// The coordinate s = 1/(γ−1) ∈ [0, 2) of a shape: 0 is Beckmann, 1 is GGX; it ends with γ → 3/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseShape;

impl InverseShape {
    /// s of γ.
    pub fn coordinate(&self, gamma: f64) -> f64 {
        s_of_gamma(gamma)
    }

    /// γ of s; ∞ for 0.
    pub fn quantity(&self, s: f64) -> f64 {
        gamma_of_s(s)
    }

    /// `count` nodes from `low` to `high` that crowd towards s = 2, even in `linear`·s − ln(1 −
    /// s/2).
    ///
    /// The projected area diverges there as 1/(2 − s), and what depends on it changes with the
    /// logarithm of 2 − s.
    pub fn crowded_nodes(low: f64, high: f64, count: usize, linear: f64) -> Vec<f64> {
        let warp = |s: f64| linear * s - libm::log(1.0 - s / S_END);
        let mut nodes = even_nodes(warp(low), warp(high), count);
        nodes.iter_mut().for_each(|y| *y = bisect(low, high, *y, warp));
        // The ends themselves, without the rounding of the warp and its inverse.
        (nodes[0], nodes[count - 1]) = (low, high);
        nodes
    }
}

impl Coordinate for InverseShape {
    fn formula(&self) -> &'static str {
        "s = 1/(γ−1), 0 for γ = ∞"
    }

    fn range(&self) -> [f64; 2] {
        [0.0, S_END - f64::EPSILON]
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_crowd_towards_the_end() {
        let nodes = InverseShape::crowded_nodes(1.25, 1.99, 9, 2.0);
        assert_eq!([nodes[0], nodes[8]], [1.25, 1.99]);
        assert!(nodes.windows(3).all(|w| w[1] - w[0] > w[2] - w[1] && w[2] > w[1]), "{nodes:?}");
    }
}
