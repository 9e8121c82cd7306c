//! The methods that are timed, with their names and colours.

use microfacet_report::plot::{Dash, Key};
use serde::Serialize;

/// A way to compute G1, or to draw visible normals, in the order of tables and legends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(into = "&'static str")]
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
    /// The name, the colour and the dash; the colour is that of the same method in the figures of
    /// the printed formulas.
    const fn parts(self) -> (&'static str, Key, Dash) {
        match self {
            Self::Hypergeometric => ("eq. 13-15, hypergeometric", Key::Nth(1), Dash::DashDotted),
            Self::Integer => ("eq. 21, integer", Key::Nth(8), Dash::LongDashed),
            Self::HalfInteger => ("eq. 21, half-integer", Key::Nth(4), Dash::LongDashed),
            Self::Rational => ("eq. 22-23, rational", Key::Nth(2), Dash::DashDotDotted),
            Self::Beta => ("beta function, prepared", Key::OTHER, Dash::LongDashed),
            Self::Table => ("table", Key::TABLE, Dash::Solid),
            Self::Ggx => ("GGX, closed form", Key::Nth(5), Dash::Dashed),
            Self::Beckmann => ("Beckmann, closed form", Key::Nth(6), Dash::Dotted),
            Self::Inversion => ("inversion of the CDF, f64", Key::Nth(3), Dash::DashDotted),
            Self::Rejection => ("exact by rejection, f64", Key::Nth(7), Dash::LongDashed),
        }
    }

    pub(super) const fn name(self) -> &'static str {
        self.parts().0
    }

    pub(super) const fn key(self) -> Key {
        self.parts().1
    }

    pub(super) const fn dash(self) -> Dash {
        self.parts().2
    }

    /// Whether the method is for one shape only, and is compared with others at all shapes.
    pub(super) const fn is_reference(self) -> bool {
        matches!(self, Self::Ggx | Self::Beckmann)
    }
}

impl From<Method> for &str {
    fn from(method: Method) -> Self {
        method.name()
    }
}
