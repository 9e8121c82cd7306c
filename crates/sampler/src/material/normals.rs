//! The normal distribution function of a Student-t lobe, D, in closed form.
//!
//! With r/z the slope of a normal over σ, b = z² + s r² and γ = (1+s)/s, πσxσy D = z^(2γ−4) b^(−γ),
//! which is computed as (b/z²)^(2−γ)/b²: the power is small for γ near 2 and 0 for γ = 2, and
//! towards Beckmann the logarithm of b/z² = 1 + s r²/z² keeps the digits of a small s.

use microfacet_core::saturated;

use crate::elementary::{log2_growth, scaled_power_of_growth};

/// D of one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normals {
    pub(crate) s: f32,
    /// 1 − γ/2.
    pub(crate) power: f32,
}

/// Stands for s = 0: the D of Beckmann to rounding, as far as D is not 0. A much smaller value
/// would make squares subnormal, and slow. A power of two, so that it and its reciprocal are not
/// rounded.
const LEAST_S: f64 = 1.0 / 1_099_511_627_776.0;

impl Normals {
    pub(crate) fn new(s: f64) -> Self {
        let s = s.max(LEAST_S);
        Self { s: s as f32, power: (0.5 - 0.5 / s) as f32 }
    }

    /// Of s and γ, of which neither is 0 or ∞.
    #[inline(always)]
    pub(crate) fn of_shape(s: f32, gamma: f32) -> Self {
        const LARGEST: f32 = (1.0 / LEAST_S) as f32;
        Self { s: s.max(LEAST_S as f32), power: 0.5 - 0.5 * (gamma - 1.0).min(LARGEST) }
    }

    /// √(πσxσy D) of a normal above the horizon from the squares of its horizontal component over
    /// σ, of its vertical component, and of its length, which need not be 1.
    ///
    /// The root, since D/(σxσy) may be in range where its factors are not.
    #[inline(always)]
    pub(crate) fn root(&self, r2: f32, z2: f32, length2: f32) -> f32 {
        let part = self.s * r2;
        let scale = length2 / (z2 + part).max(f32::MIN_POSITIVE);
        scaled_power_of_growth(z2, part, self.power, scale)
    }

    /// D of a normal above the horizon, from what [`root`](Self::root) takes and 1/(πσxσy).
    #[inline(always)]
    pub(crate) fn d(&self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32 {
        let root = self.root(r2, z2, length2);
        saturated((scale * root) * root)
    }

    /// log₂(1 + s x²)/s of a squared unit slope, x² log₂ e in the limit s = 0.
    #[inline(always)]
    pub(crate) fn log2_growth(&self, x2: f32) -> f32 {
        log2_growth(1.0, self.s * x2) / self.s
    }
}
