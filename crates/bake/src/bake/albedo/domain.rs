//! The range of materials that albedo tables are baked for.

use microfacet_tables::{Covered, GAMMA_MIN, Interval, SIGMA_MAX};

/// The isotropic materials that tables are baked for; certificates hold for these only.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Domain {
    /// Range of shapes.
    pub gamma: Interval,
    /// Range of roughnesses, σx = σy.
    pub sigma: Interval,
}

impl Domain {
    /// γ ∈ [1.501, ∞] and σ ∈ [0, 3].
    pub const GENERAL: Self = Self {
        gamma: Interval { min: GAMMA_MIN, max: f64::INFINITY },
        sigma: Interval { min: 0.0, max: SIGMA_MAX },
    };

    /// Whether every material of `other` lies in this domain.
    pub fn contains(&self, other: &Self) -> bool {
        let within = |a: Interval, b: Interval| a.contains(b.min) && a.contains(b.max);
        within(self.gamma, other.gamma) && within(self.sigma, other.sigma)
    }

    /// The smallest domain that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { gamma: self.gamma.union(other.gamma), sigma: self.sigma.union(other.sigma) }
    }

    /// The domain as a table's description states it.
    pub fn covered(&self) -> Covered {
        Covered::of(self.gamma, Some(self.sigma))
    }

    /// The domain that a table states to cover.
    pub(super) fn of_covered(covered: &Covered) -> Option<Self> {
        Some(Self { gamma: covered.gamma(), sigma: covered.sigma?.into() })
    }
}
