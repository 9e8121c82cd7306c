//! What each kind of table looks like: its axes, how they may be mapped and read, its channels, and the range of its values.
//!
//! One description for all who need it: those who bake, those who check a file, those who read it.

use alloc::format;
use alloc::string::String;

use microfacet_common::Masking;
use serde::{Deserialize, Serialize};

use crate::axis::Interpolation::{self, Hermite, Lagrange4, Lagrange6, Linear, Nodes};

/// Names of the channels of a table, fastest in its values.
pub type Channels = &'static [&'static str];

/// What a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Kind {
    /// G1/q over γ × view, q being the view coordinate.
    Shadowing,
    /// In-plane slope of visible normals over γ × view × u₁, for γ where the whole distribution is tabulated.
    VisibleSlope,
    /// The same without its heavy part, for γ near 3/2 (see `docs/format.md`).
    VisibleSlopePeeled,
    /// Slope across the plane given the in-plane one, over γ × u₂.
    VisibleSlopeConditional,
    /// As `Shadowing` for one distribution that is no member of the family, over view.
    RadialShadowing,
    /// As `VisibleSlope` for one such distribution, over view × u₁.
    RadialSlope,
    /// Slope across over the in-plane slope x × u₂, in units of √(1 + x²), or of √(1 − x²/R²) where no slope exceeds R.
    RadialConditional,
    /// Fourth root of D, over the slope of the normal.
    RadialDensity,
    /// Directional albedo over γ × σ × view: E − 1, and moments of the Fresnel weights less E times those of a mirror.
    Albedo,
    /// Its cosine-weighted average over γ × σ.
    AlbedoAverage,
    /// Directional albedo over γ × σ × view under an exact Fresnel term, which its name holds.
    FresnelAlbedo,
    /// The same of a dielectric, reflected and transmitted, over γ × σ × η × view, seen from one of its sides.
    DielectricAlbedo,
    /// As `Albedo` for one material whose albedo depends on more than γ, σ and cos θ, over the azimuth of the view × view.
    ViewAlbedo,
}

/// One axis of a kind: its name, and the kinds of mapping and the interpolations that readers know for it.
pub(super) struct AxisRule {
    pub(super) name: &'static str,
    pub(super) mappings: &'static [&'static str],
    pub(super) interpolations: &'static [Interpolation],
}

/// One form that tables of a kind may have.
pub(super) struct Layout {
    pub(super) axes: &'static [AxisRule],
    pub(super) channels: Channels,
    /// How many of the channels, from the first on, have their values in `range`, ends included.
    pub(super) checked: usize,
    pub(super) range: [f32; 2],
}

const fn axis(
    name: &'static str,
    mappings: &'static [&'static str],
    interpolations: &'static [Interpolation],
) -> AxisRule {
    AxisRule { name, mappings, interpolations }
}

const SHAPE: AxisRule = axis("gamma", &["inverse_shape"], &[Lagrange4, Nodes]);
const U1: AxisRule = axis("u1", &["mirrored_root"], &[Hermite]);
const U2: AxisRule = axis("u2", &["odd_root"], &[Hermite]);
const VIEW_OF_G1: AxisRule = axis("view", &["rational"], &[Hermite]);
const VIEW_OF_SLOPES: AxisRule = axis("view", &["half_tangent"], &[Linear]);
const ALBEDO_SHAPE: AxisRule = axis("gamma", &["log_shape"], &[Lagrange6]);
const SIGMA: AxisRule = axis("sigma", &["log_roughness"], &[Lagrange6]);
const ETA: AxisRule = axis("eta", &["reflectance_root"], &[Lagrange6]);
const VIEW: AxisRule = axis("view", &["view_blend"], &[Lagrange6]);
const INNER_VIEW: AxisRule = axis("view", &["critical_blend"], &[Lagrange6]);
const AZIMUTH: AxisRule = axis("azimuth", &["azimuth"], &[Lagrange6]);

/// Read by Hermite cells; the values in a range.
const fn lookup(axes: &'static [AxisRule], range: [f32; 2]) -> Layout {
    Layout { axes, channels: Kind::VALUE_AND_SLOPE, checked: 1, range }
}

/// Moments less a mirror's, each of which is in [0, 1], or shares of light.
const fn moments(axes: &'static [AxisRule], channels: Channels) -> Layout {
    Layout { axes, channels, checked: channels.len(), range: [-1.0, 1.0] }
}

/// G1/q is positive, and bounded as the ratio of κ to the projected area is.
const RATIOS: [f32; 2] = [f32::MIN_POSITIVE, 1e3];
/// Distances of a half tangent in [−1, 1] from its end.
const DISTANCES: [f32; 2] = [0.0, 2.0];
/// The fourth power of a root of D must be a number.
const ROOTS: [f32; 2] = [0.0, 1e9];

impl Kind {
    /// All of them.
    pub const ALL: [Self; 13] = [
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
        Self::FresnelAlbedo,
        Self::DielectricAlbedo,
        Self::ViewAlbedo,
    ];

    /// Channels of tables that are read by Hermite cells: the value, and its derivative by the node index of the last axis.
    pub const VALUE_AND_SLOPE: Channels = &["value", "slope"];
    /// Channels of albedos with F = 1: E − 1, and what the other moments have over a mirror's times E, in which form they are
    /// smooth.
    pub const MOMENTS: Channels = &["e", "bias", "f82"];
    /// Channels of albedos of lobes that may be tilted: moments without the clamp of G1(v) at one, and μ/(μ + A) with A the
    /// area of the microsurface seen, by which it is clamped. The clamp is a kink in E; both of these are smooth.
    pub const CLAMPED_MOMENTS: Channels = &["e", "bias", "f82", "clamp"];
    /// Channels of a conductor's albedo.
    pub const RGB: Channels = &["red", "green", "blue"];
    /// Channels of a dielectric's albedo, seen from the thin side.
    pub const ENTERING: Channels = &["reflection", "transmission"];
    /// The same, seen from the dense side.
    pub const LEAVING: Channels = &["reflection_leaving", "transmission_leaving"];

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
            Self::FresnelAlbedo => "fresnel_albedo",
            Self::DielectricAlbedo => "dielectric_albedo",
            Self::ViewAlbedo => "view_albedo",
        }
    }

    /// The forms that its tables may have; they differ in their channels.
    pub(super) const fn layouts(self) -> &'static [Layout] {
        match self {
            Self::Shadowing => const { &[lookup(&[SHAPE, VIEW_OF_G1], RATIOS)] },
            Self::VisibleSlope | Self::VisibleSlopePeeled => {
                const { &[lookup(&[SHAPE, VIEW_OF_SLOPES, U1], DISTANCES)] }
            }
            Self::VisibleSlopeConditional => const { &[lookup(&[SHAPE, U2], DISTANCES)] },
            Self::RadialShadowing => const { &[lookup(&[VIEW_OF_G1], RATIOS)] },
            Self::RadialSlope => const { &[lookup(&[VIEW_OF_SLOPES, U1], DISTANCES)] },
            Self::RadialConditional => {
                // κ of `rational` is the largest slope of a distribution that has one.
                const SLOPE: AxisRule = axis("slope", &["half_tangent", "rational"], &[Linear]);
                const { &[lookup(&[SLOPE, U2], DISTANCES)] }
            }
            Self::RadialDensity => {
                const SLOPE: AxisRule = axis("slope", &["half_tangent"], &[Hermite]);
                const { &[lookup(&[SLOPE], ROOTS)] }
            }
            Self::Albedo => const { &[moments(&[ALBEDO_SHAPE, SIGMA, VIEW], Self::MOMENTS)] },
            Self::AlbedoAverage => const { &[moments(&[ALBEDO_SHAPE, SIGMA], Self::MOMENTS)] },
            Self::FresnelAlbedo => const { &[moments(&[ALBEDO_SHAPE, SIGMA, VIEW], Self::RGB)] },
            Self::DielectricAlbedo => {
                const {
                    &[
                        moments(&[ALBEDO_SHAPE, SIGMA, ETA, VIEW], Self::ENTERING),
                        moments(&[ALBEDO_SHAPE, SIGMA, ETA, INNER_VIEW], Self::LEAVING),
                    ]
                }
            }
            Self::ViewAlbedo => {
                const {
                    &[
                        moments(&[AZIMUTH, VIEW], Self::MOMENTS),
                        moments(&[AZIMUTH, VIEW], Self::CLAMPED_MOMENTS),
                    ]
                }
            }
        }
    }

    /// Whether it is a directional albedo or the average of one: what depends on light and view, not on the view alone, so
    /// that its tables are for one form of masking.
    pub const fn is_albedo(self) -> bool {
        matches!(
            self,
            Self::Albedo
                | Self::AlbedoAverage
                | Self::FresnelAlbedo
                | Self::DielectricAlbedo
                | Self::ViewAlbedo
        )
    }

    /// Names of the axes, slowest first.
    pub fn axes(self) -> impl Iterator<Item = &'static str> {
        self.layouts()[0].axes.iter().map(|axis| axis.name)
    }

    /// What a table of this kind is called: the kind, the form of masking it is for, and a suffix of its own.
    pub fn table_name(self, masking: Option<Masking>, suffix: &str) -> String {
        let form =
            masking.map_or_else(String::new, |masking| format!("_{}", masking.name().replace('-', "_")));
        let separator = if suffix.is_empty() || suffix.starts_with('_') { "" } else { "_" };
        format!("{}{form}{separator}{suffix}", self.name())
    }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;

    use super::*;
    use crate::axis::Mapping;

    #[test]
    fn rules_name_mappings_that_exist_and_no_mapping_is_without_a_kind() {
        let layouts = Kind::ALL.into_iter().flat_map(Kind::layouts);
        let ruled: BTreeSet<_> =
            layouts.flat_map(|layout| layout.axes).flat_map(|axis| axis.mappings).collect();
        let known = Mapping::EVERY.map(|mapping| mapping.name());
        assert_eq!(ruled, known.iter().collect());
    }

    #[test]
    fn names_are_those_of_files() {
        for kind in Kind::ALL {
            assert_eq!(serde_json::to_string(&kind).unwrap(), format!("\"{}\"", kind.name()));
        }
    }

    #[test]
    fn forms_of_a_kind_differ_in_channels_and_share_axes() {
        for kind in [Kind::DielectricAlbedo, Kind::ViewAlbedo] {
            let [a, b] = kind.layouts() else { panic!("two forms") };
            assert!(a.channels != b.channels && a.axes.len() == b.axes.len());
        }
        assert_eq!(Kind::VisibleSlope.axes().collect::<alloc::vec::Vec<_>>(), ["gamma", "view", "u1"]);
    }

    #[test]
    fn names_are_made_of_parts() {
        let form = Some(Masking::HeightCorrelated);
        assert_eq!(Kind::Shadowing.table_name(None, ""), "shadowing");
        assert_eq!(Kind::Albedo.table_name(form, "_gamma_3"), "albedo_height_correlated_gamma_3");
        assert_eq!(Kind::ViewAlbedo.table_name(form, "gtr_1"), "view_albedo_height_correlated_gtr_1");
    }
}
