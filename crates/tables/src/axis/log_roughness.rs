//! The roughness axis of albedo tables.

use serde::{Deserialize, Serialize};

use super::coordinate::{Coordinate, Placement, bisect, positive};

/// The coordinate of a roughness, t = ln(1 + σ/offset) + slow·ln(σ/first) + linear·σ, ascending in
/// σ.
///
/// Steps are even ratios of σ near the offset, wide ratios far below it, where only the tail of a
/// small γ matters, and finer where σ is large.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogRoughness {
    /// The σ near which the first term changes from even steps to even ratios.
    pub offset: f64,
    /// Where t vanishes (but for first/offset); a surface of smaller σ is a mirror.
    pub first: f64,
    /// Weight of ln(σ/first).
    pub slow: f64,
    /// Weight of σ.
    pub linear: f64,
}

impl LogRoughness {
    /// The parameters of baked tables, found by measuring. `first` is the smallest σ that a lobe
    /// can have; the slow logarithm serves γ near 3/2, whose tail at that σ still takes most of the
    /// light of views a few σ above the horizon.
    pub const BAKED: Self = Self { offset: 0.015, first: 1e-8, slow: 0.2, linear: 1.0 };

    /// t of σ > 0.
    pub fn coordinate(&self, sigma: f64) -> f64 {
        libm::log1p(sigma / self.offset)
            + self.slow * libm::log(sigma / self.first)
            + self.linear * sigma
    }

    /// σ of t, in the range from e⁻⁴⁰ to e¹⁴.
    pub fn quantity(&self, t: f64) -> f64 {
        libm::exp(bisect(-40.0, 14.0, t, |ln| self.coordinate(libm::exp(ln))))
    }
}

impl Coordinate for LogRoughness {
    fn formula(&self) -> &'static str {
        "t = ln(1 + σ/offset) + slow·ln(σ/first) + linear·σ"
    }

    fn fault(&self) -> Option<&'static str> {
        let Self { offset, first, slow, linear } = *self;
        let sound = positive(&[offset, first, slow]) && (0.0..1e6).contains(&linear);
        (!sound).then_some("offset, first, slow or linear out of range")
    }

    fn range(&self) -> [f64; 2] {
        [0.0, f64::MAX]
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }
}
