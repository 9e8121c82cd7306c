//! Complete materials: what a renderer evaluates and samples, made of a lobe, a reflectance, and
//! albedos if multiple scattering is compensated.
//!
//! `conductor`, `dielectric` and `plastic` are the BSDFs, `any` any of them; `reflectance` is
//! Fresnel's or Schlick's of conductors, `metal` metals by name, and `interface` the geometry of
//! refraction. `haze` is any two of them, and `retro` one that sends light back, both by `pair`.
//! `mixture` joins single reflection with `broad`, the density of light of further
//! bounces, or `grazing`, its closed form. `energy` and `compensation` compute the shares of light
//! that one bounce returns and loses; `settings` says how BSDFs are made, `bind` finds albedos in
//! tables, and `coat` computes that of a coat without tables. `family_dielectric` has what
//! dielectrics and plastics need where σ and γ come from textures.

mod any;
mod bind;
mod broad;
mod coat;
mod compensation;
mod conductor;
mod dielectric;
mod energy;
mod family_dielectric;
mod grazing;
mod haze;
mod interface;
mod metal;
mod mixture;
mod pair;
mod plastic;
mod reflectance;
mod retro;
mod settings;

pub use any::AnyBsdf;
pub use bind::StandIn;
pub use compensation::Compensation;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use energy::{BoundInterface, InterfaceAlbedo};
pub use family_dielectric::{DielectricAt, FamilyDielectric};
pub use haze::Haze;
pub use interface::steep_cosine;
pub use metal::{Metal, UnknownMetal};
pub use plastic::Plastic;
pub use reflectance::ConductorFresnel;
pub use retro::Retroreflective;
pub use settings::BsdfSettings;

use glam::Vec3;

/// What is transported along a path: it decides the scale of refraction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Transport {
    /// Radiance, along paths that start at the camera: refraction scales it by (n_v/n_l)², since it
    /// spreads or gathers the same energy over another solid angle.
    #[default]
    Radiance,
    /// Importance, along paths that start at a light; photons and their energy.
    Importance,
}

/// Whether light was reflected or transmitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// The light is on the side of the view.
    Reflection,
    /// The light is on the other side.
    Transmission,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BsdfSample<const N: usize = 3> {
    /// The direction of the light, of unit length, away from the surface.
    pub l: [f32; 3],
    /// f |cos θ_l|/pdf in each channel; for a delta event its reflectance or transmittance over the
    /// probability with which it was chosen.
    pub weight: [f32; N],
    /// Whether the light was reflected or transmitted.
    pub event: Event,
    /// Whether the event is a delta, for which evaluation gives 0: a smooth surface sends all light
    /// in one direction, and what facets next to the horizon refract is [only sampled](Dielectric)
    /// for γ < 2.
    pub delta: bool,
    /// n_l/n_v, the index of refraction on the side of `l` over that on the side of the view: 1 for
    /// reflection. Russian roulette on radiance removes the weight's 1/η² with it.
    pub eta: f32,
}

impl<const N: usize> BsdfSample<N> {
    /// A light that is reflected, and no delta, for a BSDF of your own; another event sets its
    /// fields.
    #[inline(always)]
    #[must_use]
    pub fn reflected(l: impl Into<[f32; 3]>, weight: [f32; N]) -> Self {
        Self { l: l.into(), weight, event: Event::Reflection, delta: false, eta: 1.0 }
    }

    /// The mirror reflection of a view from above, a delta event.
    fn mirrored(v: Vec3, weight: [f32; N]) -> Self {
        Self { delta: true, ..Self::reflected(Vec3::new(-v.x, -v.y, v.z), weight) }
    }
}

/// A bidirectional scattering distribution function: what a surface does to light, in N channels.
///
/// # Conventions
/// - Directions are unit vectors in the tangent frame, n = +z, of any type that converts to three
///   `f32`. Both the view `v` and the light `l` point away from the surface. z > 0 is outside,
///   z < 0 inside.
/// - η = n_inside/n_outside, of the medium below the surface over that above it, for views of
///   either side.
/// - f excludes the cosine; the weight of a sample is f |cos θ_l|/pdf, computed without dividing,
///   so that it stays finite where f and the density do not.
/// - Densities are per steradian of `l`, of all that [`sample`](Self::sample) draws except deltas.
/// - f obeys f(v, l) = f(l, v) for reflection; for transmission f(v, l)/n_v² = f(l, v)/n_l² of
///   radiance. Only Turquin's compensation violates this.
/// - A delta event has f = pdf = 0, and its sample is flagged; the events of lobes that are
///   [effectively smooth](crate::MicrofacetDistribution::is_effectively_smooth) are deltas too.
/// - A conductor or plastic seen from below is black, and so is everything for a direction that is
///   in the surface (z = 0) or NaN.
///
/// Values are finite: an f or a density beyond the range of `f32` is `f32::MAX`.
/// [An example](crate).
pub trait Bsdf<const N: usize = 3> {
    /// Draws a light for a view, and the density with which it does, as [`pdf`](Self::pdf) returns
    /// it; 0 for a delta event. `choice` chooses among events, `u` the direction.
    ///
    /// The three numbers are in [0, 1], clamped to it and NaN to 0; they are used independently, so
    /// a stratified `u` stays stratified. `None` where the drawn facet reflects below the horizon,
    /// or refracts above it. The path then ends with a weight of 0, which counts in a mean.
    #[must_use]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)>;

    /// f, without the cosine, and the density with which [`sample`](Self::sample) draws `l`.
    #[must_use]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; N], f32);

    /// The light and weight of [`sample_with_pdf`](Self::sample_with_pdf), without the density,
    /// which [`pdf`](Self::pdf) computes later for paths that need it.
    ///
    /// Of conductors and dielectrics without compensation this leaves out D, 9 to 17 % of a
    /// conductor's instructions (`guard/`); others need it for the weight.
    #[must_use]
    #[inline]
    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample<N>> {
        Some(self.sample_with_pdf(v, choice, u, transport)?.0)
    }

    /// f, without the cosine.
    #[must_use]
    #[inline]
    fn eval(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> [f32; N] {
        self.eval_pdf(v, l, transport).0
    }

    /// The density with which [`sample`](Self::sample) draws `l`, per steradian.
    #[must_use]
    #[inline]
    fn pdf(&self, v: impl Into<[f32; 3]>, l: impl Into<[f32; 3]>) -> f32 {
        self.eval_pdf(v, l, Transport::Radiance).1
    }

    /// Whether all its events are deltas: [`eval`](Self::eval) is 0 everywhere and lights need not
    /// be sampled.
    #[must_use]
    fn is_delta(&self) -> bool;

    /// Whether light passes from one side to the other.
    #[must_use]
    fn transmits(&self) -> bool;

    /// Whether it stays as it is when turned by half a turn about n: f(Rv, Rl) = f(v, l) with
    /// R(x, y, z) = (−x, −y, z), as of all [upright lobes](crate::MicrofacetDistribution). By
    /// default no, and no [retroreflection](crate::Retroreflective) can be made of it.
    #[must_use]
    fn is_symmetric(&self) -> bool {
        false
    }
}
