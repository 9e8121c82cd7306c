//! The shape axis of albedo tables: the logarithm of the distance of γ from 3/2.

use serde::{Deserialize, Serialize};

use super::coordinate::{Coordinate, Placement, positive};

/// The coordinate of a shape, t = ln(1 + scale/(2γ−3)) ≥ 0.
///
/// 0 is Beckmann; γ → 3/2, where the projected area diverges, is reached slowly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogShape {
    /// Factor of 1/(2γ−3).
    pub scale: f64,
}

impl LogShape {
    /// The parameters of baked tables, found by measuring.
    pub const BAKED: Self = Self { scale: 17.0 };

    /// t of γ ∈ (3/2, ∞].
    pub fn coordinate(&self, gamma: f64) -> f64 {
        libm::log1p(self.scale / (2.0 * gamma - 3.0))
    }

    /// γ of t; ∞ for 0.
    pub fn quantity(&self, t: f64) -> f64 {
        1.5 + 0.5 * self.scale / libm::expm1(t)
    }
}

impl Coordinate for LogShape {
    fn formula(&self) -> &'static str {
        "t = ln(1 + scale/(2γ−3))"
    }

    fn check(&self) -> Result<(), &'static str> {
        if positive(&[self.scale]) { Ok(()) } else { Err("scale out of range") }
    }

    fn range(&self) -> [f64; 2] {
        [0.0, f64::MAX]
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for gamma in [1.5 + 1e-6, 1.501, 2.0, 40.0, 1e9, f64::INFINITY] {
            let t = LogShape::BAKED.coordinate(gamma);
            let back = LogShape::BAKED.quantity(t);
            assert!(back == gamma || (back / gamma - 1.0).abs() < 1e-14, "{gamma}: {back}");
        }
        assert_eq!(LogShape::BAKED.coordinate(f64::INFINITY), 0.0);
    }
}
