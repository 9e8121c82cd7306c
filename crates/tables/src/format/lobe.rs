//! The lobes of materials and tables.

use alloc::format;
use alloc::string::String;

use microfacet_core::Skew;
use microfacet_core::shape::{gamma_of_s, s_of_gamma};
use serde::{Deserialize, Serialize};

use super::ensure;
use super::subject::joined_name;
use crate::interval::Interval;
use crate::{GAMMA_MIN, SIGMA_MAX};

/// Relative difference within which two numbers count as the same: 1/(γ−1) of the end of a range
/// may round to just outside it.
pub const SAME: f64 = 1e-9;

/// The slope roughness σ of a microfacet lobe, along the tangent (x) and the bitangent (y).
///
/// σ is dimensionless: the scale of the surface's slopes in the Student-t distribution (Ribardière
/// et al. 2017, doi:10.1111/cgf.13137, eq. 11 and 18), equal to the α of GGX (γ = 2) and of
/// Beckmann (γ = ∞). A range may start at 0, for a texture with smooth points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Roughness {
    /// σ = 0 everywhere: a mirror or a pane, with no microfacets to sample.
    Smooth,
    /// σx = σy at every point, even where σ varies.
    Isotropic(Interval),
    /// σx and σy vary independently.
    Anisotropic {
        /// σx.
        x: Interval,
        /// σy.
        y: Interval,
    },
}

impl Roughness {
    /// Every σx and σy, for tables of slopes that are divided by them.
    pub const ALL: Self = Self::Isotropic(Interval { min: 0.0, max: f64::INFINITY });

    /// The isotropic roughness of range `sigma`; [`Roughness::Smooth`] if that is 0 alone.
    pub fn isotropic(sigma: Interval) -> Self {
        if sigma.max > 0.0 { Self::Isotropic(sigma) } else { Self::Smooth }
    }

    /// A roughness with independent σx and σy; isotropic if both are the same single number.
    pub fn anisotropic(x: Interval, y: Interval) -> Self {
        if x.is_point() && x == y { Self::isotropic(x) } else { Self::Anisotropic { x, y } }
    }

    /// σx, which is 0 for a smooth surface.
    #[must_use]
    pub fn x(self) -> Interval {
        match self {
            Self::Smooth => Interval::point(0.0),
            Self::Isotropic(x) | Self::Anisotropic { x, .. } => x,
        }
    }

    /// σy, which is 0 for a smooth surface.
    #[must_use]
    pub fn y(self) -> Interval {
        match self {
            Self::Anisotropic { y, .. } => y,
            _ => self.x(),
        }
    }

    /// Whether σx = σy at every point.
    #[must_use]
    pub fn is_isotropic(self) -> bool {
        !matches!(self, Self::Anisotropic { .. })
    }

    /// Checks that ranges ascend from 0 or more; the error says what is wrong.
    pub(super) fn check(self) -> Result<(), String> {
        [self.x(), self.y()].into_iter().try_for_each(|Interval { min, max }| {
            ensure(0.0 <= min && min <= max && max < f64::INFINITY, || {
                format!("sigma = [{min}, {max}] must ascend, from 0 or more to a finite number")
            })
        })
    }
}

/// The form of a lobe, by which its tables differ in their axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LobeForm {
    /// Round lobes of the Student-t family. Tables of slopes divided by σ have this form too, and
    /// serve all lobes of the family.
    Family,
    /// A Student-t lobe, or a range of them, with σx and σy.
    StudentT,
    /// One lobe that is tilted and turned.
    Ellipsoid,
    /// An isotropic distribution outside the family.
    Distribution,
}

/// A lobe, or the range of lobes of a material whose texture drives σ or γ, or of a table.
///
/// `D` describes a distribution outside the Student-t family: by default by its label, such as
/// `gtr:0.2,1.5`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LobeSpec<D = String> {
    /// σx and σy ≥ 0. For a material outside the family it is the median slope of the normals, by
    /// which the slopes of its tables are divided.
    pub roughness: Roughness,
    /// The shape γ > 3/2; `INFINITY` is Beckmann, 2 is GGX. It has no meaning outside the family.
    pub gamma: Interval,
    /// The tilt and turn of an ellipsoid, θx, θy, θz in radians, as for
    /// [`Skew::new`](microfacet_core::Skew::new); σ and γ are then single numbers.
    pub theta: Option<[f64; 3]>,
    /// The distribution, outside the family.
    pub distribution: Option<D>,
}

impl<D> LobeSpec<D> {
    /// Every round lobe that tables of albedos cover: γ ∈ [1.501, ∞] and σ ∈ [0, 3].
    pub const GENERAL: Self = Self::family(
        Roughness::Isotropic(Interval { min: 0.0, max: SIGMA_MAX }),
        Interval { min: GAMMA_MIN, max: f64::INFINITY },
    );

    /// An upright lobe of the family.
    pub const fn family(roughness: Roughness, gamma: Interval) -> Self {
        Self { roughness, gamma, theta: None, distribution: None }
    }

    /// One upright lobe of the family.
    pub fn student_t([x, y]: [f64; 2], gamma: f64) -> Self {
        let [x, y, gamma] = [x, y, gamma].map(Interval::point);
        Self::family(Roughness::anisotropic(x, y), gamma)
    }

    /// A distribution outside the family, of every scale.
    pub fn outside(distribution: D) -> Self {
        let family = Self::family(Roughness::ALL, Interval::point(2.0));
        Self { distribution: Some(distribution), ..family }
    }

    /// Its form.
    pub fn form(&self) -> LobeForm {
        match (&self.distribution, self.theta) {
            (Some(_), _) => LobeForm::Distribution,
            (_, Some(_)) => LobeForm::Ellipsoid,
            _ if self.roughness.is_isotropic() => LobeForm::Family,
            _ => LobeForm::StudentT,
        }
    }

    /// Whether its form is [`LobeForm::Family`].
    pub fn is_family(&self) -> bool {
        self.form() == LobeForm::Family
    }

    /// The range [min, max] of s = 1/(γ−1), which is 0 at γ = ∞.
    pub fn s(&self) -> [f64; 2] {
        [self.gamma.max, self.gamma.min].map(s_of_gamma)
    }

    /// The ranges of σx and σy.
    pub fn sigmas(&self) -> [Interval; 2] {
        [self.roughness.x(), self.roughness.y()]
    }

    /// σx and σy, at the middle of their ranges.
    pub fn sigma(&self) -> [f64; 2] {
        self.sigmas().map(|Interval { min, max }| middle([min, max]))
    }

    /// γ, at the middle of the range of s.
    pub fn gamma(&self) -> f64 {
        gamma_of_s(middle(self.s()))
    }

    /// Whether it has the shape s = 1/(γ−1), within [`SAME`].
    pub fn contains_s(&self, s: f64) -> bool {
        within(self.s(), s, SAME)
    }

    /// Whether it has the shape γ.
    pub fn contains_shape(&self, gamma: f64) -> bool {
        self.contains_s(s_of_gamma(gamma))
    }

    /// σ of the isotropic lobe that stands in for an anisotropic one: √(σx σy).
    pub fn round_sigma(&self) -> f64 {
        let [x, y] = self.sigma();
        mean(x, y)
    }

    /// Whether it has no microfacets at all: σ = 0.
    pub fn is_smooth(&self) -> bool {
        self.sigmas() == [Interval::point(0.0); 2]
    }

    /// Whether it is an upright lobe of the family.
    pub fn is_upright(&self) -> bool {
        self.distribution.is_none() && self.theta.is_none()
    }

    /// Whether it is GGX, which has closed forms. A tilted one reads tables.
    pub fn is_ggx(&self) -> bool {
        self.s() == [1.0; 2] && self.is_upright() && !self.is_smooth()
    }

    /// Whether σx, σy and γ are single numbers.
    pub fn is_single(&self) -> bool {
        let [x, y] = self.sigmas();
        [x, y, self.gamma].into_iter().all(Interval::is_point)
    }

    /// The same lobe with another description of its distribution.
    pub fn map<E>(&self, distribution: impl FnOnce(&D) -> E) -> LobeSpec<E> {
        let Self { roughness, gamma, theta, .. } = *self;
        let distribution = self.distribution.as_ref().map(distribution);
        LobeSpec { roughness, gamma, theta, distribution }
    }
}

impl<D: Clone + PartialEq> LobeSpec<D> {
    /// The lobe that tables of its albedo are baked for: itself, or [`round`](Self::round) for
    /// ranges of an anisotropic lobe.
    #[must_use]
    pub fn tabulated(&self) -> Self {
        if self.form() == LobeForm::StudentT && !self.is_single() {
            self.round()
        } else {
            self.clone()
        }
    }

    /// The round lobe of σ = √(σx σy), without a tilt, that usually stands in for one that is not
    /// round.
    #[must_use]
    pub fn round(&self) -> Self {
        let [x, y] = self.sigmas();
        let sigma = Interval { min: mean(x.min, y.min), max: mean(x.max, y.max) };
        Self::family(Roughness::isotropic(sigma), self.gamma)
    }

    /// Whether a table of this lobe, or of this range of round ones, covers another: σ within the
    /// rounding of single precision, in which lobes take it, γ within [`SAME`], and equal tilts.
    pub fn contains(&self, other: &Self) -> bool {
        if self.distribution.is_some() || other.distribution.is_some() {
            return self.distribution == other.distribution;
        }
        let has = |range: Interval, sigma| within(range.into(), sigma, f32::EPSILON.into());
        (self.theta, self.is_family()) == (other.theta, other.is_family())
            && other.s().into_iter().all(|s| self.contains_s(s))
            && self
                .sigmas()
                .into_iter()
                .zip(other.sigmas())
                .all(|(range, Interval { min, max })| has(range, min) && has(range, max))
    }
}

impl LobeSpec {
    /// The part of a table's name that states the lobe; empty for all lobes that tables can cover.
    pub(super) fn label(&self) -> String {
        let part = |name: &str, Interval { min, max }: Interval| {
            if min == max { format!("{name}_{min}") } else { format!("{name}_{min}_to_{max}") }
        };
        if let Some(label) = &self.distribution {
            return label.replace([':', ',', '/', '\\', ' '], "_");
        }
        let is_all = self.roughness == Roughness::ALL;
        if self.gamma == Self::GENERAL.gamma && (is_all || *self == Self::GENERAL) {
            return String::new();
        }
        let sigma = match self.sigmas() {
            _ if is_all => String::new(),
            [x, _] if self.is_family() => part("sigma", x),
            [x, y] => format!("{}_{}", part("sigma", x), y.min),
        };
        let theta = self.theta.map(|[a, b, c]| format!("theta_{a}_{b}_{c}")).unwrap_or_default();
        joined_name(&[&part("gamma", self.gamma), &sigma, &theta])
    }

    /// Checks every number but σ; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        let ([low, high], Interval { min, max }) = (self.s(), self.gamma);
        ensure(0.0 <= low && low <= high && high < 2.0, || {
            format!("gamma = [{min}, {max}] must ascend, from more than 3/2")
        })?;
        let is_named = self.distribution.as_ref().is_none_or(|label| !label.is_empty());
        ensure(is_named, || "a distribution without a label".into())?;
        let Some(theta) = self.theta else { return Ok(()) };
        ensure(self.is_single() && self.distribution.is_none(), || {
            "theta is for a Student-t lobe with single numbers of sigma and gamma".into()
        })?;
        Skew::new(self.sigma(), theta).map(drop).map_err(|why| format!("theta = {theta:?}: {why}"))
    }
}

/// Whether a number is in a range, or beyond an end by no more than `slack` of that end.
fn within([min, max]: [f64; 2], x: f64, slack: f64) -> bool {
    x >= min - slack * min && x <= max + slack * max
}

/// √(xy); equal numbers are returned without rounding.
fn mean(x: f64, y: f64) -> f64 {
    if x == y { x } else { libm::sqrt(x * y) }
}

fn middle([min, max]: [f64; 2]) -> f64 {
    if min == max { min } else { 0.5 * (min + max) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted(sigma: [f64; 2], gamma: f64, theta: [f64; 3]) -> LobeSpec {
        LobeSpec { theta: Some(theta), ..LobeSpec::student_t(sigma, gamma) }
    }

    #[test]
    fn a_lobe_is_found_in_its_own_table_alone() {
        let [round, brushed] = [[0.3; 2], [0.1, 0.3]].map(|sigma| LobeSpec::student_t(sigma, 3.0));
        let range = LobeSpec::family(Roughness::Isotropic([0.1, 0.5].into()), [2.0, 4.0].into());
        let turned = tilted([0.1, 0.3], 3.0, [0.1, 0.2, 0.3]);
        let gtr = LobeSpec::outside(String::from("gtr:0.2,1.5"));
        let all = [&round, &brushed, &range, &turned, &gtr];
        for (i, a) in all.iter().enumerate() {
            for (j, b) in all.iter().enumerate() {
                let inside = i == j || (i, j) == (2, 0);
                assert_eq!(a.contains(b), inside, "{a:?}, {b:?}");
            }
        }
        // Lobes take sigma in single precision, and s of a gamma is rounded.
        let single = LobeSpec::student_t([f64::from(0.1_f32), f64::from(0.3_f32)], 3.0 + 1e-12);
        assert!(brushed.contains(&single));
        for (sigma, gamma) in [([0.1, 0.3001], 3.0), ([0.1, 0.3], 3.0001), ([0.3, 0.1], 3.0)] {
            assert!(!brushed.contains(&LobeSpec::student_t(sigma, gamma)), "{sigma:?} {gamma}");
        }
        assert!(!turned.contains(&tilted([0.1, 0.3], 3.0, [0.1, 0.2, 0.4])));
        assert!(!gtr.contains(&LobeSpec::outside("gtr:0.2,1.6".into())));
    }

    #[test]
    fn a_range_of_an_anisotropic_lobe_has_a_round_stand_in() {
        let x = Interval { min: 0.1, max: 0.4 };
        let range = Roughness::Anisotropic { x, y: Interval::point(0.4) };
        let lobe: LobeSpec = LobeSpec::family(range, Interval::point(3.0));
        let sigma = Interval { min: 0.2, max: 0.4 };
        let round = LobeSpec::family(Roughness::Isotropic(sigma), Interval::point(3.0));
        assert_eq!((lobe.tabulated(), lobe.form()), (round, LobeForm::StudentT));
        let single = LobeSpec::<String>::student_t([0.1, 0.4], 3.0);
        assert_eq!(single.tabulated(), single);
    }
}
