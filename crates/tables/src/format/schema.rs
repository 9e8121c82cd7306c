//! The layout of each kind of table: its axes, how they may be mapped and interpolated, its
//! channels, and the range of its values.
//!
//! Baking, checking a file and reading it all use this one description.

use alloc::vec;
use alloc::vec::Vec;

use super::kind::Kind;
use super::lobe::LobeForm;
use super::reflectance::Reflectance;
use super::subject::{Side, Subject};
use crate::axis::Interpolation::{self, Hermite, Lagrange4, Lagrange6, Linear, Nodes};

/// One axis of a kind: its name, and the mappings and interpolations that readers know for it.
#[derive(Clone, Copy)]
pub(super) struct AxisRule {
    pub(super) name: &'static str,
    pub(super) mappings: &'static [&'static str],
    pub(super) interpolations: &'static [Interpolation],
}

pub(super) struct Layout {
    pub(super) axes: Vec<AxisRule>,
    pub(super) channels: Vec<&'static str>,
    /// How many of the channels, from the first on, have values in `range`, ends included.
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
const ETA: AxisRule = axis("eta", &["reflectance_root", "crossing_root"], &[Lagrange6]);
const VIEW: AxisRule = axis("view", &["view_blend"], &[Lagrange6]);
const INNER_VIEW: AxisRule = axis("view", &["critical_blend"], &[Lagrange6]);
const AZIMUTH: AxisRule = axis("azimuth", &["azimuth"], &[Lagrange6]);
const SLOPE: AxisRule = axis("slope", &["half_tangent"], &[Hermite]);
/// κ of `rational` is the largest slope of a distribution that has one.
const SLOPE_OR_LARGEST: AxisRule = axis("slope", &["half_tangent", "rational"], &[Linear]);

/// G1/q is positive, and as limited as the ratio of κ to the projected area.
const RATIOS: [f32; 2] = [f32::MIN_POSITIVE, 1e3];
/// Distances of a half tangent in [−1, 1] from its end.
const DISTANCES: [f32; 2] = [0.0, 2.0];
/// The fourth power of a root of D must be finite.
const ROOTS: [f32; 2] = [0.0, 1e9];

impl Kind {
    /// The layout of a table of this kind and subject.
    pub(super) fn layout(self, subject: &Subject) -> Layout {
        // Read by Hermite cells, with values in a range.
        let lookup = |axes: &[AxisRule], range| Layout {
            axes: axes.into(),
            channels: Self::VALUE_AND_SLOPE.into(),
            checked: 1,
            range,
        };
        match self {
            Self::Shadowing => lookup(&[SHAPE, VIEW_OF_G1], RATIOS),
            Self::VisibleSlope | Self::VisibleSlopePeeled => {
                lookup(&[SHAPE, VIEW_OF_SLOPES, U1], DISTANCES)
            }
            Self::VisibleSlopeConditional => lookup(&[SHAPE, U2], DISTANCES),
            Self::RadialShadowing => lookup(&[VIEW_OF_G1], RATIOS),
            Self::RadialSlope => lookup(&[VIEW_OF_SLOPES, U1], DISTANCES),
            Self::RadialConditional => lookup(&[SLOPE_OR_LARGEST, U2], DISTANCES),
            Self::RadialDensity => lookup(&[SLOPE], ROOTS),
            Self::Albedo => albedo(subject),
            Self::AlbedoAverage => moments(vec![ALBEDO_SHAPE, SIGMA], Self::MOMENTS.into()),
        }
    }

    /// Whether tables of this kind are of one distribution outside the family.
    pub(super) const fn is_radial(self) -> bool {
        matches!(
            self,
            Self::RadialShadowing
                | Self::RadialSlope
                | Self::RadialConditional
                | Self::RadialDensity
        )
    }

    /// Whether tables of this kind hold directional albedos or averages of them. Albedos depend on
    /// light and view, not on the view alone, so each table is for one form of masking and one
    /// reflectance.
    pub const fn is_albedo(self) -> bool {
        matches!(self, Self::Albedo | Self::AlbedoAverage)
    }
}

/// The axes of the material, then those of the view.
fn albedo(subject: &Subject) -> Layout {
    let reflectance = subject.reflectance.unwrap_or(Reflectance::Mirror);
    let form = subject.lobe.form();
    let index = reflectance.indices().map(|_| ETA);
    let mut axes: Vec<AxisRule> = match form {
        LobeForm::Family => [ALBEDO_SHAPE, SIGMA].into_iter().chain(index).collect(),
        _ => index.into_iter().chain([AZIMUTH]).collect(),
    };
    axes.push(if reflectance.side() == Some(Side::Dense) { INNER_VIEW } else { VIEW });
    // G1 of a tilted lobe is clamped at one, since the visible area of the microsurface may be less
    // than that of the macrosurface.
    let clamp = (form == LobeForm::Ellipsoid).then_some(Kind::CLAMP);
    moments(axes, reflectance.channels().iter().copied().chain(clamp).collect())
}

/// The layout of moments less those of a mirror, which are all in [0, 1], or of shares of light.
fn moments(axes: Vec<AxisRule>, channels: Vec<&'static str>) -> Layout {
    Layout { axes, checked: channels.len(), channels, range: [-1.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;
    use alloc::format;

    use super::*;
    use crate::axis::Mapping;
    use crate::format::LobeSpec;
    use crate::interval::Interval;

    /// Subjects whose albedos have every axis that there is.
    fn subjects() -> [Subject; 3] {
        let of =
            |lobe, reflectance| Subject { reflectance: Some(reflectance), ..Subject::of(lobe) };
        let tilted = LobeSpec { theta: Some([0.1; 3]), ..LobeSpec::student_t([0.1, 0.2], 2.0) };
        let index = Interval { min: 1.5, max: f64::INFINITY };
        let pane = |side| Reflectance::Interface { side, index };
        [
            of(LobeSpec::GENERAL, pane(Side::Thin)),
            of(LobeSpec::GENERAL, pane(Side::Dense)),
            of(tilted, Reflectance::Mirror),
        ]
    }

    #[test]
    fn rules_name_mappings_that_exist_and_no_mapping_is_without_a_kind() {
        let subjects = subjects();
        let layouts = Kind::ALL.iter().flat_map(|kind| subjects.iter().map(|of| kind.layout(of)));
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
    fn an_albedo_looks_as_what_it_is_of() {
        let shape = |subject: &Subject| {
            let layout = Kind::Albedo.layout(subject);
            let axes: Vec<_> =
                layout.axes.iter().map(|axis| (axis.name, axis.mappings[0])).collect();
            (axes, layout.channels)
        };
        let [thin, dense, tilted] = subjects();
        let front =
            vec![("gamma", "log_shape"), ("sigma", "log_roughness"), ("eta", "reflectance_root")];
        let with = |view| [front.clone(), vec![("view", view)]].concat();
        assert_eq!(shape(&thin), (with("view_blend"), Kind::SHARES.to_vec()));
        assert_eq!(shape(&dense), (with("critical_blend"), Kind::SHARES.to_vec()));
        let around = vec![("azimuth", "azimuth"), ("view", "view_blend")];
        assert_eq!(shape(&tilted), (around, vec!["e", "bias", "f82", "clamp"]));
    }
}
