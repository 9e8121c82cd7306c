//! The methods that are timed: their names, and what they are in drawings.

use microfacet_report::plot;
use microfacet_report::plot::Key;

/// A way to compute G1, or to draw visible normals, in the order of tables and legends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Method {
    /// Eq. 13–15.
    Hypergeometric,
    /// Eq. 21 for integer γ.
    Integer,
    /// Eq. 21 for half-integer γ.
    HalfInteger,
    /// Eq. 22–23.
    Rational,
    /// Eq. 13–15 rearranged, by its continued fraction, with prepared coefficients.
    Beta,
    /// Our tables: G1, or normals.
    Table,
    /// GGX, γ = 2.
    Ggx,
    /// Beckmann, γ = ∞.
    Beckmann,
    /// Normals by inversion of the CDF.
    Inversion,
    /// Normals by rejection.
    Rejection,
}

impl Method {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Hypergeometric => "eq. 13-15, hypergeometric",
            Self::Integer => "eq. 21, integer",
            Self::HalfInteger => "eq. 21, half-integer",
            Self::Rational => "eq. 22-23, rational",
            Self::Beta => "beta function, prepared",
            Self::Table => "table",
            Self::Ggx => "GGX, closed form",
            Self::Beckmann => "Beckmann, closed form",
            Self::Inversion => "inversion of the CDF, f64",
            Self::Rejection => "exact by rejection, f64",
        }
    }

    /// Whether it has one shape, which stands for all in a comparison.
    pub(super) const fn is_reference(self) -> bool {
        matches!(self, Self::Ggx | Self::Beckmann)
    }

    pub(super) fn key(self) -> Key {
        Key::Method(match self {
            Self::Hypergeometric => plot::Method::Hypergeometric,
            Self::Integer => plot::Method::Integer,
            Self::HalfInteger => plot::Method::HalfInteger,
            Self::Rational => plot::Method::Rational,
            Self::Beta => plot::Method::Other,
            Self::Table => plot::Method::Table,
            Self::Inversion => plot::Method::Inversion,
            Self::Rejection => plot::Method::Rejection,
            Self::Ggx => plot::Method::Ggx,
            Self::Beckmann => plot::Method::Beckmann,
        })
    }
}
