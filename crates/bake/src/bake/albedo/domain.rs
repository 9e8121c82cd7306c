//! The range of materials that albedo tables are baked for.

use microfacet_core::shape::{gamma_of_s, s_of_gamma};
use microfacet_tables::{Covered, Interval};

use crate::table_spec::GAMMA_MIN;

/// Largest σ of the general tables.
pub const SIGMA_MAX: f64 = 3.0;

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
        let s = [s_of_gamma(self.gamma.max), s_of_gamma(self.gamma.min)];
        Covered { s, sigma: Some([self.sigma.min, self.sigma.max]) }
    }

    /// The domain that a table states to cover.
    pub(super) fn of_covered(covered: &Covered) -> Option<Self> {
        let ([low, high], [min, max]) = (covered.s, covered.sigma?);
        let [heavy, light] = [high, low].map(gamma_of_s);
        Some(Self { gamma: Interval { min: heavy, max: light }, sigma: Interval { min, max } })
    }

    /// The domain as part of table names; empty for the general domain.
    pub(super) fn label(&self) -> String {
        let part = |name: &str, Interval { min, max }: Interval| {
            if min == max { format!("{name}_{min}") } else { format!("{name}_{min}_to_{max}") }
        };
        if *self == Self::GENERAL {
            String::new()
        } else {
            format!("{}_{}", part("gamma", self.gamma), part("sigma", self.sigma))
        }
    }
}
