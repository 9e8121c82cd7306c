//! The in-memory table: axes, channels and values, with the certificate of what was measured on it.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use serde::{Deserialize, Serialize};

use crate::axis::{Axis, Interpolation, Mapping};
use crate::container::Precision;
use crate::error::LoadError;
use crate::student_t::Masking;

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

impl Kind {
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

    /// Whether it is a directional albedo or the average of one: what depends on light and view, not on the view alone.
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
    pub const fn axes(self) -> &'static [&'static str] {
        match self {
            Self::Shadowing => &["gamma", "view"],
            Self::VisibleSlope | Self::VisibleSlopePeeled => &["gamma", "view", "u1"],
            Self::VisibleSlopeConditional => &["gamma", "u2"],
            Self::RadialShadowing => &["view"],
            Self::RadialSlope => &["view", "u1"],
            Self::RadialConditional => &["slope", "u2"],
            Self::RadialDensity => &["slope"],
            Self::Albedo | Self::FresnelAlbedo => &["gamma", "sigma", "view"],
            Self::AlbedoAverage => &["gamma", "sigma"],
            Self::DielectricAlbedo => &["gamma", "sigma", "eta", "view"],
            Self::ViewAlbedo => &["azimuth", "view"],
        }
    }
}

/// A table: values at the nodes of named axes.
///
/// `values` is row-major with the axes slowest first and the channels fastest: shape
/// `[axes[0].len(), …, axes[n−1].len(), channels.len()]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name inside its set; the kind's name, with a suffix where a set holds several of a kind.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// Axes, slowest first.
    pub axes: Vec<Axis>,
    /// Channel names, such as `value` and `slope`.
    pub channels: Vec<String>,
    /// Form of G2 that the values are for; `None` where they are of one direction only.
    pub masking: Option<Masking>,
    /// Values in f32; rounded once, from f64, when they were stored.
    pub values: Vec<f32>,
    /// How the values are stored in a file.
    pub precision: Precision,
    /// Figures measured on this table by the bake that made it, off its grid and against the f64 model.
    pub certificate: BTreeMap<String, f64>,
}

impl Table {
    /// Lengths along the axes and the channels.
    pub fn shape(&self) -> Vec<usize> {
        self.axes.iter().map(Axis::len).chain([self.channels.len()]).collect()
    }

    /// Checks everything that lookups rely on.
    ///
    /// # Errors
    /// [`LoadError`] naming the table and what is wrong.
    pub fn validate(&self) -> Result<(), LoadError> {
        let fail = |why: String| Err(LoadError::Invalid(format!("table `{}`: {why}", self.name)));
        let names: Vec<&str> = self.axes.iter().map(|axis| axis.name.as_str()).collect();
        if names != self.kind.axes() {
            return fail(format!("axes {names:?} where {:?} are expected", self.kind.axes()));
        }
        for axis in &self.axes {
            axis.validate()?;
        }
        let expected = self.axes.iter().map(Axis::len).try_fold(self.channels.len(), usize::checked_mul);
        if expected != Some(self.values.len()) {
            return fail(format!("{} values for shape {:?}", self.values.len(), self.shape()));
        }
        if self.values.iter().any(|x| !x.is_finite()) {
            return fail("a value is not finite".into());
        }
        match self.kind {
            kind if kind.is_albedo() => self.validate_albedo(),
            _ => self.validate_lookup(),
        }
    }

    /// The parts particular to albedos, which are read by polynomials on even nodes.
    fn validate_albedo(&self) -> Result<(), LoadError> {
        let fail = |why: &str| Err(LoadError::Invalid(format!("table `{}`: {why}", self.name)));
        let known: &[&[&str]] = match self.kind {
            Kind::FresnelAlbedo => &[&crate::fresnel_albedo::CHANNELS],
            Kind::DielectricAlbedo => &crate::dielectric_albedo::CHANNELS,
            Kind::ViewAlbedo => &[&crate::albedo::CHANNELS, &crate::view_albedo::CHANNELS],
            _ => &[&crate::albedo::CHANNELS],
        };
        if !known.iter().any(|known| self.channels == *known) {
            return fail("channels are not those of this kind");
        }
        if self.masking.is_none() {
            return fail("an albedo without the form of masking it is for");
        }
        let blends = |view: &Axis| matches!(view.mapping, Mapping::ViewBlend { .. });
        let splits = |view: &Axis| matches!(view.mapping, Mapping::CriticalBlend { .. });
        let mapped = match (self.kind, &self.axes[..]) {
            (Kind::ViewAlbedo, [azimuth, view]) => {
                matches!(azimuth.mapping, Mapping::Azimuth { .. }) && blends(view)
            }
            (_, [shape, roughness, rest @ ..]) => {
                matches!(shape.mapping, Mapping::LogShape { .. })
                    && matches!(roughness.mapping, Mapping::Roughness { .. })
                    && match rest {
                        [] => true,
                        [view] => blends(view),
                        [eta, view] if self.channels == crate::dielectric_albedo::CHANNELS[0] => {
                            eta.mapping == Mapping::ReflectanceRoot && blends(view)
                        }
                        [eta, view] => {
                            eta.mapping == Mapping::ReflectanceRoot && splits(view) && view.len() % 2 == 1
                        }
                        _ => false,
                    }
            }
            _ => false,
        };
        if !mapped || self.axes.iter().any(|axis| axis.interpolation != Interpolation::Lagrange6) {
            return fail(
                "an axis has a mapping, a number of nodes or an interpolation that this kind does not use",
            );
        }
        let least = |view: &Axis| if splits(view) { 11 } else { 6 };
        if self.axes.iter().any(|axis| axis.name == "view" && axis.len() < least(axis)) {
            return fail("axis `view` has fewer than six nodes, or eleven in two halves");
        }
        // Moments less a mirror's, and each of them is in [0, 1]; a share of light.
        if self.values.iter().all(|x| (-1.0..=1.0).contains(x)) {
            Ok(())
        } else {
            fail("a value is out of range")
        }
    }

    /// The parts particular to tables that are read by Hermite cells.
    fn validate_lookup(&self) -> Result<(), LoadError> {
        let fail = |why: &str| Err(LoadError::Invalid(format!("table `{}`: {why}", self.name)));
        if self.channels != ["value", "slope"] {
            return fail("channels are not `value`, `slope`");
        }
        if self.axes[0].name == "gamma" && self.axes[0].mapping != Mapping::InverseShape {
            return fail("axis `gamma` is not mapped by `inverse_shape`");
        }
        let mapped = match self.kind {
            Kind::Shadowing => {
                matches!(self.axes[1].mapping, Mapping::Rational { .. } | Mapping::RationalRoot { .. })
            }
            Kind::VisibleSlope | Kind::VisibleSlopePeeled => {
                matches!(self.axes[1].mapping, Mapping::HalfTangent | Mapping::HalfTangentRoot)
                    && matches!(self.axes[2].mapping, Mapping::MirroredPower { odd: false, .. })
            }
            Kind::VisibleSlopeConditional => {
                matches!(self.axes[1].mapping, Mapping::MirroredPower { odd: true, .. })
            }
            // With the pole at 2 and s = 1, κ is the scale itself.
            Kind::RadialShadowing => {
                matches!(self.axes[0].mapping, Mapping::Rational { pole, .. } if pole == 2.0)
            }
            Kind::RadialSlope => {
                self.axes[0].mapping == Mapping::HalfTangent
                    && matches!(self.axes[1].mapping, Mapping::MirroredPower { odd: false, .. })
            }
            // κ is the largest slope of a distribution that has one.
            Kind::RadialConditional => {
                let bounded = matches!(self.axes[0].mapping, Mapping::Rational { pole, .. } if pole == 2.0);
                (bounded || self.axes[0].mapping == Mapping::HalfTangent)
                    && matches!(self.axes[1].mapping, Mapping::MirroredPower { odd: true, .. })
            }
            Kind::RadialDensity => self.axes[0].mapping == Mapping::HalfTangent,
            Kind::Albedo
            | Kind::AlbedoAverage
            | Kind::FresnelAlbedo
            | Kind::DielectricAlbedo
            | Kind::ViewAlbedo => {
                unreachable!("validated apart")
            }
        };
        if !mapped {
            return fail("an axis has a mapping that this kind does not use");
        }
        let positive = self.values.iter().step_by(2);
        let in_range = match self.kind {
            // q ≤ G1 and G1/q ≤ (1 + κ/z)…: bounded by the projected area's limits.
            Kind::Shadowing | Kind::RadialShadowing => positive.clone().all(|&x| x > 0.0 && x < 1e3),
            // Its fourth power must be a number.
            Kind::RadialDensity => positive.clone().all(|&x| (0.0..1e9).contains(&x)),
            // Distances of a half tangent in [−1, 1] from its end.
            _ => positive.clone().all(|&x| (0.0..=2.0).contains(&x)),
        };
        if in_range { Ok(()) } else { fail("a value is out of range") }
    }
}
