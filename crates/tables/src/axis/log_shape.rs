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

    fn fault(&self) -> Option<&'static str> {
        (!positive(&[self.scale])).then_some("scale out of range")
    }

    fn range(&self) -> [f64; 2] {
        [0.0, f64::MAX]
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }
}
