//! The kinds of tables.

use serde::{Deserialize, Serialize};

/// Names of a table's channels, which run fastest in its values.
pub type Channels = &'static [&'static str];

/// What a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Kind {
    /// G1/q over γ × view, where q is the view coordinate.
    Shadowing,
    /// In-plane slope of visible normals over γ × view × u₁, for γ where the whole distribution is
    /// tabulated.
    VisibleSlope,
    /// `VisibleSlope` without its heavy part, for γ near 3/2 (see `docs/format.md`).
    VisibleSlopePeeled,
    /// Slope across, given the in-plane slope, over γ × u₂.
    VisibleSlopeConditional,
    /// As `Shadowing` for one distribution outside the family, over view.
    RadialShadowing,
    /// As `VisibleSlope` for one distribution outside the family, over view × u₁.
    RadialSlope,
    /// Slope across over the in-plane slope x × u₂, in units of √(1 + x²), or of √(1 − x²/R²) where
    /// no slope exceeds R.
    RadialConditional,
    /// Fourth root of D, over the slope of the normal.
    RadialDensity,
    /// Directional albedo over material × view.
    ///
    /// It is over γ × σ × view for round members of the family, over azimuth × view for one
    /// material of another lobe, and has an axis of η before the view for dielectrics. The table's
    /// description says what it is of, masking and reflectance included.
    Albedo,
    /// Cosine-weighted averages of albedos over γ × σ.
    AlbedoAverage,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::Shadowing,
        Self::VisibleSlope,
        Self::VisibleSlopePeeled,
        Self::VisibleSlopeConditional,
        Self::RadialShadowing,
        Self::RadialSlope,
        Self::RadialConditional,
        Self::RadialDensity,
        Self::Albedo,
        Self::AlbedoAverage,
    ];

    /// Channels of tables of Hermite cells: the value, and its derivative with respect to the node
    /// index of the last axis.
    pub const VALUE_AND_SLOPE: Channels = &["value", "slope"];
    /// Channels of albedos with F = 1: E − 1, and the excess of the other moments over E times a
    /// mirror's, which are smooth.
    pub const MOMENTS: Channels = &["e", "bias", "f82"];
    /// Channels of a conductor's albedo.
    pub const RGB: Channels = &["red", "green", "blue"];
    /// Channels of a dielectric's albedo: the shares of light.
    pub const SHARES: Channels = &["reflection", "transmission"];
    /// One more channel, for albedos of ellipsoids: μ/(μ + A), where A is the visible area of the
    /// microsurface. Where A < μ, G1(v) is clamped at one.
    ///
    /// The clamp is a kink of E, so the other channels leave it out: apart, both are smooth.
    pub const CLAMP: &'static str = "clamp";

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shadowing => "shadowing",
            Self::VisibleSlope => "visible_slope",
            Self::VisibleSlopePeeled => "visible_slope_peeled",
            Self::VisibleSlopeConditional => "visible_slope_conditional",
            Self::RadialShadowing => "radial_shadowing",
            Self::RadialSlope => "radial_slope",
            Self::RadialConditional => "radial_conditional",
            Self::RadialDensity => "radial_density",
            Self::Albedo => "albedo",
            Self::AlbedoAverage => "albedo_average",
        }
    }
}
