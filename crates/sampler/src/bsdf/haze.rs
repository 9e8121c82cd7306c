//! Haze: a core and a wider lobe around it.

use microfacet_core::math::unit;

use super::pair::{Pair, by_pair};
use super::{Bsdf, BsdfSample, Transport};
use crate::bind_error::BindError;

/// A core with haze around it: any two BSDFs, f = (1 − w) f_core + w f_haze.
///
/// This is the haze of engines: of OpenPBR 1.2 (`specular_haze`, two GGX, of roughness r and
/// r + (1 − r) `specular_haze_spread`,
/// <https://academysoftwarefoundation.github.io/OpenPBR/>), of Arnold and of Unreal's Substrate.
/// The parts are a wide and a narrow [`Conductor`](crate::Conductor) as a rule; they may be of any
/// kind, bound or made at a hit, with a compensation or without. Conventions are those of [`Bsdf`].
///
/// As light is shared between two materials side by side, too small to be seen apart, so is what
/// the pair returns: its albedo is (1 − w) E_core + w E_haze, exactly, and where each part is
/// compensated by its own albedo, the pair is compensated. It is reciprocal where the parts are.
/// Each sample is drawn from one part, chosen by w, and weighted by both. A smooth core remains a
/// delta beside haze that is none. Two parts that transmit should have the same index of
/// refraction: a sample's `eta` is that of the part that drew it.
///
/// *Another* haze is a mixture of normals on one surface (d'Eon, Bitterli, Weidlich & Zeltner 2023,
/// <https://doi.org/10.1145/3588432.3591486>): D = (1 − w) D_core + w D_haze, with one masking of
/// both, Λ = (1 − w) Λ_core + w Λ_haze, since Λ is linear in D. There facets of the one kind mask
/// those of the other. That one is a lobe, `distribution = "haze"` of a recipe, of which a BSDF is
/// made as of any other. `docs/bsdf.md` has how much the two differ.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{Bsdf, BsdfSettings, Conductor, Haze, Metal, Tables, Transport};
///
/// let tables = Tables::embedded();
/// let gold = |sigma| -> Result<Conductor<_>, microfacet_sampler::BindError> {
///     Conductor::new(tables.student_t(sigma, 2.0)?, Metal::Gold, BsdfSettings::new())
/// };
/// let hazy = Haze::new(gold(0.1)?, gold(0.45)?, 0.3)?; // core, haze, weight of the haze
/// let sample = hazy.sample([0.6, 0.0, 0.8], 0.2, [0.3, 0.7], Transport::Radiance);
/// assert!(sample.is_some_and(|sample| sample.weight[0] <= 1.0));
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Haze<A, B = A> {
    core: A,
    haze: B,
    weight: f32,
}

impl<A, B> Haze<A, B> {
    /// A core with haze of a weight w.
    ///
    /// For w = 0 it is the core alone, and for w = 1 the haze, to the bit and at no cost.
    ///
    /// # Errors
    /// [`BindError::Share`] unless the weight lies in [0, 1].
    pub fn new(core: A, haze: B, weight: f32) -> Result<Self, BindError> {
        Ok(Self { core, haze, weight: share("weight", weight)? })
    }

    /// [`new`](Self::new) at a hit, where the weight comes from a texture: it is clamped to [0, 1],
    /// NaN to 0.
    ///
    /// ```
    /// # #[cfg(feature = "embedded")] {
    /// use microfacet_sampler::{Conductor, ConductorFresnel, Haze, Masking, Metal, Tables};
    ///
    /// let (tables, masking) = (Tables::embedded(), Masking::HeightCorrelated);
    /// let (family, gold) = (tables.family()?, ConductorFresnel::from(Metal::Gold)); // once
    /// let (sigma, gamma, spread, weight) = (0.1, 2.0, 0.5, 0.3); // at every hit
    /// let wide = sigma + (1.0 - sigma) * spread;
    /// let of = |sigma: f32| Conductor::at_hit(family.at(sigma, gamma), gold, masking);
    /// let hit = Haze::at_hit(of(sigma), of(wide), weight);
    /// # }
    /// # Ok::<(), microfacet_sampler::MaterialError>(())
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn at_hit(core: A, haze: B, weight: f32) -> Self {
        Self { core, haze, weight: unit(weight) }
    }

    /// The core.
    #[must_use]
    pub fn core(&self) -> &A {
        &self.core
    }

    /// The haze around it.
    #[must_use]
    pub fn haze(&self) -> &B {
        &self.haze
    }

    /// The weight of the haze, in [0, 1].
    #[must_use]
    pub fn weight(&self) -> f32 {
        self.weight
    }

    /// The same of parts in another form.
    pub(super) fn map<C, D>(self, core: fn(A) -> C, haze: fn(B) -> D) -> Haze<C, D> {
        Haze { core: core(self.core), haze: haze(self.haze), weight: self.weight }
    }

    #[inline(always)]
    fn pair(&self) -> Pair<'_, A, B> {
        Pair { first: &self.core, second: &self.haze, w: self.weight }
    }
}

/// A share that lies in [0, 1], or the error that names it.
pub(super) fn share(name: &'static str, value: f32) -> Result<f32, BindError> {
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err(BindError::Share { name, value }) }
}

by_pair!(Haze<A, B>);
