//! The methods that are timed: their names, and what they are in drawings.

use microfacet_report::plot::Key;
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
    const fn parts(self) -> (&'static str, plot::Method) {
        use plot::Method as Plotted;
        match self {
            Self::Hypergeometric => ("eq. 13-15, hypergeometric", Plotted::Hypergeometric),
            Self::Integer => ("eq. 21, integer", Plotted::Integer),
            Self::HalfInteger => ("eq. 21, half-integer", Plotted::HalfInteger),
            Self::Rational => ("eq. 22-23, rational", Plotted::Rational),
            Self::Beta => ("beta function, prepared", Plotted::Other),
            Self::Table => ("table", Plotted::Table),
            Self::Ggx => ("GGX, closed form", Plotted::Ggx),
            Self::Beckmann => ("Beckmann, closed form", Plotted::Beckmann),
            Self::Inversion => ("inversion of the CDF, f64", Plotted::Inversion),
            Self::Rejection => ("exact by rejection, f64", Plotted::Rejection),
        }
    }

    pub(super) const fn name(self) -> &'static str {
        self.parts().0
    }

    pub(super) fn key(self) -> Key {
        Key::Method(self.parts().1)
    }

    /// Whether it has one shape, which stands for all in a comparison.
    pub(super) const fn is_reference(self) -> bool {
        matches!(self, Self::Ggx | Self::Beckmann)
    }

    pub(super) fn key(self) -> Key {
        // In the order of the methods, as the figures of the printed formulas have them.
        const COLORS: [Key; 10] = [
            Key::Nth(1),
            Key::Nth(8),
            Key::Nth(4),
            Key::Nth(2),
            Key::OTHER,
            Key::TABLE,
            Key::Nth(5),
            Key::Nth(6),
            Key::Nth(3),
            Key::Nth(7),
        ];
        COLORS[self as usize]
    }
}

impl From<Method> for &str {
    fn from(method: Method) -> Self {
        method.name()
    }
}
