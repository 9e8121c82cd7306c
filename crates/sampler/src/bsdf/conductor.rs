//! A rough conductor: reflection alone.

use glam::Vec3;
use microfacet_core::Masking;

use super::compensation::{Compensation, Density, Returned};
use super::mixture::{Mixture, are_finite, choice, chosen};
use super::reflectance::ConductorFresnel;
use super::settings::BsdfSettings;
use super::{Bsdf, BsdfSample, Transport};
use crate::albedo::{Albedo, AlbedoAt, DirectionalAlbedo};
use crate::bind_error::BindError;
use crate::material::{Facets, Part, Reflecting, Tabulated, White};
use crate::vector::vec3;

/// A rough conductor: every facet reflects F of the light and absorbs the rest.
///
/// Conventions are those of [`Bsdf`]. Single scattering is D F G2/(4 cos θ_v cos θ_l) (Cook &
/// Torrance 1982, <https://doi.org/10.1145/357290.357293>), sampled by visible normals: its weight
/// F·G2/G1 is at most 1. A compensation adds the light of further bounces. Black from below.
/// It draws by the lobe that it is given: with a [`Bounded`](crate::lobe::Bounded) one fewer samples
/// are lost, many fewer for γ < 2, where [`Lobe::for_reflection`](crate::Lobe::for_reflection)
/// chooses it, and at a hit [`FamilyLobe::bounded`](crate::lobe::FamilyLobe::bounded).
#[derive(Clone, Debug)]
pub struct Conductor<L, const N: usize = 3, A = Albedo> {
    lobe: L,
    fresnel: ConductorFresnel<N>,
    masking: Masking,
    smooth: bool,
    returned: Option<Returned<N, A>>,
}

impl<L: Reflecting + Tabulated, const N: usize> Conductor<L, N> {
    /// A conductor of a lobe and the reflectance of its facets.
    ///
    /// # Errors
    /// [`BindError`] if a compensation was asked for and its tables hold no albedo of the lobe for
    /// the form of masking; the error has the lines of a recipe that add one.
    pub fn new(
        lobe: L,
        fresnel: impl Into<ConductorFresnel<N>>,
        settings: BsdfSettings<'_>,
    ) -> Result<Self, BindError> {
        let (smooth, masking) = (lobe.is_effectively_smooth(), settings.masking);
        let single = Self { lobe, fresnel: fresnel.into(), masking, smooth, returned: None };
        match settings.compensation().filter(|_| !smooth) {
            None => Ok(single),
            Some((compensation, tables)) => {
                let albedo = tables.albedo_of(&single.lobe, masking, settings.stand_in)?;
                Ok(single.compensated_by(albedo, compensation))
            }
        }
    }
}

impl<L: Reflecting, const N: usize> Conductor<L, N, AlbedoAt<'_>> {
    /// A conductor of one bounce, made at a hit in a few operations: what [`new`](Conductor::new)
    /// makes without a compensation, for lobes whose σ, or σ and γ, come from textures.
    ///
    /// [`compensated_at`](Conductor::compensated_at) adds the light of further bounces.
    ///
    /// ```
    /// # #[cfg(feature = "embedded")] {
    /// use microfacet_sampler::{Compensation, Conductor, ConductorFresnel, Masking, Metal, Tables};
    ///
    /// let (tables, masking) = (Tables::embedded(), Masking::HeightCorrelated);
    /// let (family, albedo) = (tables.family()?, tables.family_albedo(masking)?); // once
    /// let gold = ConductorFresnel::from(Metal::Gold);
    /// for (sigma, gamma) in [(0.3, 2.5), (0.31, 2.4)] {
    ///     let hit = Conductor::at_hit(family.at(sigma, gamma), gold, masking);
    ///     let hit = hit.compensated_at(albedo.at(sigma, gamma), Compensation::KullaConty);
    /// }
    /// # }
    /// # Ok::<(), microfacet_sampler::BindError>(())
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn at_hit(lobe: L, fresnel: ConductorFresnel<N>, masking: Masking) -> Self {
        let smooth = lobe.is_effectively_smooth();
        Self { lobe, fresnel, masking, smooth, returned: None }
    }
}

impl<L: Reflecting, const N: usize> Conductor<L, N> {
    /// This conductor with a compensation by a given albedo, which must be of the same lobe; its
    /// form of masking becomes that of the conductor.
    #[must_use]
    pub fn compensated_by(self, albedo: Albedo, compensation: Compensation) -> Self {
        self.with(albedo, compensation, Density::of_albedo)
    }
}

impl<L: Reflecting, const N: usize, B> Conductor<L, N, B> {
    /// This conductor with a compensation by the albedo at a hit, which must be that of the lobe's
    /// σ and γ; its form of masking becomes that of the conductor. Nothing is tabulated, and it
    /// takes some lookups.
    #[inline]
    #[must_use]
    pub fn compensated_at<'a>(
        self,
        albedo: AlbedoAt<'a>,
        compensation: Compensation,
    ) -> Conductor<L, N, AlbedoAt<'a>> {
        self.with(albedo, compensation, Density::at)
    }

    #[inline]
    fn with<A: DirectionalAlbedo>(
        self,
        albedo: A,
        compensation: Compensation,
        density: fn(&A) -> Density,
    ) -> Conductor<L, N, A> {
        let Self { lobe, fresnel, smooth, .. } = self;
        let masking = albedo.masking();
        let returned =
            (!smooth).then(|| Returned::new(albedo, compensation, &fresnel, density)).flatten();
        Conductor { lobe, fresnel, masking, smooth, returned }
    }
}

impl<L: Reflecting, const N: usize, A: DirectionalAlbedo> Conductor<L, N, A> {
    /// The lobe.
    #[must_use]
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// The facets' reflectance.
    #[must_use]
    pub fn fresnel(&self) -> &ConductorFresnel<N> {
        &self.fresnel
    }

    /// The form of masking and shadowing.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    #[inline(always)]
    fn facets(&self) -> Facets<'_, L> {
        Facets { lobe: &self.lobe, masking: self.masking }
    }

    /// One bounce and the compensation of the light that it loses, at a light from above.
    #[inline(always)]
    fn mixture(&self, returned: &Returned<N, A>, lost: f32, l: Vec3, white: White) -> Mixture<N> {
        let single = white.part(self.fresnel.at(white.cos));
        let factor = returned.factor(lost);
        let facets =
            Part { weight: core::array::from_fn(|i| single.weight[i] * factor[i]), ..single };
        Mixture { p: returned.facets(lost), facets, broad: returned.part(lost, l) }
    }

    /// A sample with compensation; out of line, so that one without it is short.
    #[inline(never)]
    fn sample_mixture(
        &self,
        returned: &Returned<N, A>,
        v: Vec3,
        number: f32,
        u: [f32; 2],
    ) -> Option<(BsdfSample<N>, f32)> {
        if !are_finite(v, v) {
            return None;
        }
        let lost = returned.lost(v);
        let (is_facet, _) = chosen(choice(number), returned.facets(lost));
        let (l, white) = if is_facet {
            self.facets().draw::<true>(v, u)?
        } else {
            let l = returned.sample_above(u)?;
            (l, self.facets().halfway(v, l))
        };
        let mixture = self.mixture(returned, lost, l, white);
        Some((BsdfSample::reflected(l, mixture.weight()), mixture.pdf()))
    }

    #[inline(never)]
    fn eval_mixture(&self, returned: &Returned<N, A>, v: Vec3, l: Vec3) -> ([f32; N], f32) {
        if !are_finite(v, l) {
            return ([0.0; N], 0.0);
        }
        self.mixture(returned, returned.lost(v), l, self.facets().halfway(v, l)).f_pdf(l)
    }

    /// Out of line, as a sample with compensation is.
    #[inline(never)]
    fn sample_mirror(&self, v: Vec3) -> Option<(BsdfSample<N>, f32)> {
        let mirror = || (BsdfSample::mirrored(v, self.fresnel.at(v.z)), 0.0);
        are_finite(v, v).then(mirror)
    }

    /// A sample, with its density if `PDF`.
    #[inline(always)]
    fn draw<const PDF: bool>(
        &self,
        v: Vec3,
        choice: f32,
        u: [f32; 2],
    ) -> Option<(BsdfSample<N>, f32)> {
        if !(v.z > 0.0) {
            return None;
        }
        if self.smooth {
            return self.sample_mirror(v);
        }
        if let Some(returned) = &self.returned {
            return self.sample_mixture(returned, v, choice, u);
        }
        let (l, white) = self.facets().draw::<PDF>(v, u)?;
        let Part { weight, pdf } = white.part(self.fresnel.at(white.cos));
        Some((BsdfSample::reflected(l, weight), pdf))
    }
}

impl<L: Reflecting, const N: usize, A: DirectionalAlbedo> Bsdf<N> for Conductor<L, N, A> {
    #[inline(always)]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        _transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        self.draw::<true>(vec3(v), choice, u)
    }

    #[inline(always)]
    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        _transport: Transport,
    ) -> Option<BsdfSample<N>> {
        Some(self.draw::<false>(vec3(v), choice, u)?.0)
    }

    #[inline(always)]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        _transport: Transport,
    ) -> ([f32; N], f32) {
        let (v, l) = (vec3(v), vec3(l));
        if self.smooth || !(v.z > 0.0 && l.z > 0.0) {
            return ([0.0; N], 0.0);
        }
        if let Some(returned) = &self.returned {
            return self.eval_mixture(returned, v, l);
        }
        let white = self.facets().halfway(v, l);
        (white.f(self.fresnel.at(white.cos), l), white.pdf)
    }

    fn is_delta(&self) -> bool {
        self.smooth
    }

    fn transmits(&self) -> bool {
        false
    }

    fn is_symmetric(&self) -> bool {
        self.smooth || self.lobe.is_symmetric()
    }
}
