//! Lobes: whose normals a material has, or a table is of.

use alloc::format;
use alloc::string::String;

use microfacet_core::Skew;
use microfacet_core::shape::{gamma_of_s, s_of_gamma};

use super::subject::{LobeEntry, check_roughness, check_shapes};
use crate::interval::Interval;

/// The slope roughness σ of a microfacet lobe, along the tangent (x) and the bitangent (y).
///
/// σ is dimensionless: the scale of the surface's slopes in the Student-t distribution (Ribardière
/// et al. 2017, doi:10.1111/cgf.13137, eq. 11 and 18), equal to the α of GGX (γ = 2) and of
/// Beckmann (γ = ∞). A range may start at 0, for a texture with smooth points.
#[derive(Clone, Copy, Debug, PartialEq)]
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
}

/// The lobe of a material, with ranges where a texture drives σ or γ.
///
/// `D` is the distribution of one outside the Student-t family: its label, such as `gtr:0.2,1.5`,
/// or whatever else says it.
#[derive(Clone, Debug, PartialEq)]
pub struct LobeSpec<D = String> {
    /// σx and σy ≥ 0. Outside the family: the median slope of the normals, which is the scale of
    /// its tables.
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
    /// An upright lobe of the family.
    pub const fn family(roughness: Roughness, gamma: Interval) -> Self {
        Self { roughness, gamma, theta: None, distribution: None }
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

    /// σ of the isotropic lobe that stands in for an anisotropic one: √(σx σy).
    pub fn round_sigma(&self) -> f64 {
        let [x, y] = self.sigma();
        if x == y { x } else { libm::sqrt(x * y) }
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
    fn is_single(&self) -> bool {
        let [x, y] = self.sigmas();
        [x, y, self.gamma].into_iter().all(Interval::is_point)
    }

    /// The same lobe with its distribution in other terms.
    pub fn map<E>(&self, distribution: impl FnOnce(&D) -> E) -> LobeSpec<E> {
        let Self { roughness, gamma, theta, .. } = *self;
        LobeSpec {
            roughness,
            gamma,
            theta,
            distribution: self.distribution.as_ref().map(distribution),
        }
    }
}

impl LobeSpec {
    /// The lobe of its albedo's tables: the family's if it is round, or if it is anisotropic with a
    /// range, for which the round lobe of [`round_sigma`](Self::round_sigma) stands in.
    pub fn tabulated(&self) -> LobeEntry {
        if let Some(label) = &self.distribution {
            return LobeEntry::Distribution(label.clone());
        }
        let ([x, y], [s, _]) = (self.sigmas(), self.s());
        let sigma = [x.min, y.min];
        match self.theta {
            Some(theta) => LobeEntry::Ellipsoid { sigma, theta, s },
            None if x != y && self.is_single() => LobeEntry::StudentT { sigma, s },
            None => LobeEntry::Family,
        }
    }

    /// Checks every number; the error says what is wrong.
    pub(super) fn check(&self) -> Result<(), String> {
        self.sigmas().into_iter().try_for_each(|sigma| check_roughness(sigma.into()))?;
        check_shapes(self.s())?;
        let Some(theta) = self.theta else { return Ok(()) };
        if !self.is_single() || self.distribution.is_some() {
            return Err("theta is for a Student-t lobe with single numbers of sigma and s".into());
        }
        Skew::new(self.sigma(), theta).map(drop).map_err(|why| format!("theta = {theta:?}: {why}"))
    }
}

/// The middle of a range.
fn middle([min, max]: [f64; 2]) -> f64 {
    if min == max { min } else { 0.5 * (min + max) }
}
