//! Plastic: a rough dielectric coat over a diffuse base.

use alloc::boxed::Box;

use glam::Vec3;
use microfacet_core::Masking;

use super::broad::Broad;
use super::coat::CoatAlbedo;
use super::compensation::Compensation;
use super::energy::{Energy, OUTSIDE, Shares};
use super::interface::{Interface, checked};
use super::mixture::{Mixture, are_finite, choice, chosen};
use super::reflectance::reflectances;
use super::settings::BsdfSettings;
use super::{Bsdf, BsdfSample, Transport};
use crate::albedo::DielectricAlbedo;
use crate::bind_error::BindError;
use crate::material::{Facets, Part, Reflecting, Tabulated, White};
use crate::vector::vec3;

/// A rough dielectric coat over a Lambert base, which receives exactly the light that the coat
/// transmits.
///
/// Conventions are those of [`Bsdf`]; black from below. The coat reflects as [`Dielectric`] does.
/// Of the light T(v) that it transmits from the direction of v the base of albedo ρ returns
///
/// ```text
/// f = T(v) T(l) ρ / (π η² (1 − ρ R))
/// ```
///
/// with R the share of diffuse light from inside that the coat reflects, so that light reflected
/// between base and coat any number of times is included. T and R are albedos of the coat, those of
/// tables where there is a compensation; a white base then returns all light. With a
/// [`Bounded`](crate::lobe::Bounded) lobe fewer samples are lost.
///
/// Single scattering needs no table: T and R are integrated when the plastic is made, to 1e-3, and
/// to 6e-3 for η < 1; to 0.04 and 0.2 where σx is a tenth of σy, or the lobe is tilted. A white
/// base returns at most 1.003 of the light all the same. The default set has no albedos of rough
/// coats, so that compensation needs a set baked from a recipe that names the coat, for round lobes
/// of the family; [`StandIn::Round`] uses them for anisotropic and tilted lobes.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{BsdfSettings, Compensation, Plastic, Tables};
///
/// let tables = Tables::embedded();
/// let (coat, green) = (tables.student_t(0.3, 2.5)?, [0.1, 0.4, 0.2]);
/// let single = Plastic::new(coat.clone(), 1.5, green, BsdfSettings::new())?;
/// // With compensation the error has the lines to bake: then `Tables::from_bytes(&file)`.
/// let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
/// let why = Plastic::new(coat, 1.5, green, settings).unwrap_err();
/// assert!(why.to_string().contains("gamma = 2.5\nfresnel = { dielectric = 1.5 }"));
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
///
/// [`StandIn::Round`]: crate::StandIn::Round
/// [`Dielectric`]: crate::Dielectric
#[derive(Clone, Debug)]
pub struct Plastic<L, const N: usize = 3> {
    lobe: L,
    /// The index as it was given, and in single precision.
    index: f64,
    eta: f32,
    base: [f32; N],
    masking: Masking,
    smooth: bool,
    energy: Box<Energy>,
    /// ρ/(η² (1 − ρ R)), and the mean of that times the average of T.
    diffuse: [f32; N],
    mean: f32,
    /// The density from which light of the base and of the coat's further bounces is drawn.
    broad: Box<Broad>,
}

impl<L: Reflecting + Tabulated, const N: usize> Plastic<L, N> {
    /// Plastic with a coat of a lobe and an index η, inside over outside, over a base of albedo ρ.
    ///
    /// For single scattering the albedo of a rough coat is integrated here, by 120,000 to 220,000
    /// samples of a round lobe, which take some 20 milliseconds, and up to 1.6 million of another.
    ///
    /// # Errors
    /// [`BindError`] for an η outside [1e-3, 1e3], a ρ outside [0, 1], or where a compensation was
    /// asked for and its tables hold no albedo of the coat, with the lines of a recipe that add it.
    pub fn new(
        lobe: L,
        eta: f64,
        base: [f32; N],
        settings: BsdfSettings<'_>,
    ) -> Result<Self, BindError> {
        let (index, eta) = (eta, checked(eta)?);
        reflectances("base", &base)?;
        let (smooth, masking) = (lobe.is_effectively_smooth() || eta == 1.0, settings.masking);
        let energy = match settings.compensation() {
            _ if smooth => Energy::smooth(eta),
            None => Energy::coat(CoatAlbedo::new(&lobe, masking, eta), eta),
            Some((compensation, tables)) => {
                let albedo =
                    tables.dielectric_albedo_of(&lobe, index, masking, settings.stand_in)?;
                Energy::rough(albedo, compensation, eta)
            }
        };
        Ok(Self::made(lobe, [index, eta.into()], base, masking, smooth, energy))
    }
}

impl<L: Reflecting, const N: usize> Plastic<L, N> {
    /// [`new`](Self::new) by given albedos, which must be of the same lobe and index; their form of
    /// masking becomes that of the plastic.
    ///
    /// # Errors
    /// [`BindError`] for an η outside [1e-3, 1e3] or a ρ outside [0, 1].
    pub fn with_albedo(
        lobe: L,
        eta: f64,
        base: [f32; N],
        albedo: DielectricAlbedo,
        compensation: Compensation,
    ) -> Result<Self, BindError> {
        let (index, eta) = (eta, checked(eta)?);
        reflectances("base", &base)?;
        let (smooth, masking) = (lobe.is_effectively_smooth() || eta == 1.0, albedo.masking);
        let energy = match smooth {
            true => Energy::smooth(eta),
            false => Energy::rough(albedo, compensation, eta),
        };
        Ok(Self::made(lobe, [index, eta.into()], base, masking, smooth, energy))
    }

    fn made(
        lobe: L,
        [index, eta]: [f64; 2],
        base: [f32; N],
        masking: Masking,
        smooth: bool,
        energy: Energy,
    ) -> Self {
        let (eta, energy) = (eta as f32, Box::new(energy));
        let diffuse = base.map(|base| {
            let left = energy.left(base);
            // 1 − ρ R = 0 only where the coat transmits nothing.
            if left > 0.0 { base / left } else { 0.0 }
        });
        let mean = diffuse.iter().sum::<f32>() / N as f32;
        // Base and coat in proportion, on average over views.
        let broad = Box::new(Broad::new(|l| {
            let shares = energy.shares(OUTSIDE, l);
            energy.transmitted(&shares) * mean
                + energy.reflected(OUTSIDE) * energy.returned(&shares)
        }));
        let mean = mean * energy.transmitted_average();
        Self { lobe, index, eta, base, masking, smooth, energy, diffuse, mean, broad }
    }

    /// The lobe of the coat.
    #[must_use]
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// The index of refraction of the coat, inside over outside.
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.index
    }

    /// The albedo of the base.
    #[must_use]
    pub fn base(&self) -> [f32; N] {
        self.base
    }

    /// The form of masking and shadowing.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// The probability of facets: their share of the light that returns.
    #[inline(always)]
    fn facets_share(&self, shares: &Shares) -> f32 {
        let energy = &self.energy;
        let facets = shares.reflection * energy.factor(shares);
        let diffuse = energy.transmitted(shares) * self.mean
            + energy.reflected(OUTSIDE) * energy.returned(shares);
        if diffuse > 0.0 { facets / (facets + diffuse) } else { 1.0 }
    }

    #[inline(always)]
    fn facets(&self) -> Facets<'_, L> {
        Facets { lobe: &self.lobe, masking: self.masking }
    }

    /// The part of the coat's facets, compensation included.
    #[inline(always)]
    fn coat(&self, shares: &Shares, white: White) -> Part<N> {
        let reflectance = Interface::new(self.eta, true).reflectance(white.cos);
        white.part([reflectance * self.energy.factor(shares); N])
    }

    #[inline(always)]
    fn halfway(&self, shares: &Shares, v: Vec3, l: Vec3) -> Part<N> {
        // The reflection of a smooth coat is a delta.
        if self.smooth { Part::NONE } else { self.coat(shares, self.facets().halfway(v, l)) }
    }

    /// The part of the base, with the further bounces that the coat reflects.
    #[inline(always)]
    fn diffuse(&self, shares: &Shares, l: Vec3) -> Part<N> {
        let energy = &self.energy;
        let there = energy.shares(OUTSIDE, l);
        let (entering, leaving) = (energy.transmitted(shares), energy.transmitted(&there));
        let coat =
            energy.reflected(OUTSIDE) * energy.lobe(energy.returned(shares), OUTSIDE, &there);
        let lobe = self.diffuse.map(|diffuse| entering * leaving * diffuse + coat);
        Part::broad(l, self.broad.factor(l), 1.0, lobe)
    }
}

impl<L: Reflecting, const N: usize> Bsdf<N> for Plastic<L, N> {
    #[inline]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        number: f32,
        u: [f32; 2],
        _transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        let v = vec3(v);
        if !(v.z > 0.0 && are_finite(v, v)) {
            return None;
        }
        let shares = self.energy.shares(OUTSIDE, v);
        let p = self.facets_share(&shares);
        let (is_facet, _) = chosen(choice(number), p);
        let (l, facets) = if !is_facet {
            let l = self.broad.sample_above(u)?;
            (l, self.halfway(&shares, v, l))
        } else if self.smooth {
            return Some((BsdfSample::mirrored(v, [shares.reflection / p; N]), 0.0));
        } else {
            let (l, white) = self.facets().draw::<true>(v, u)?;
            (l, self.coat(&shares, white))
        };
        let mixture = Mixture { p, facets, broad: self.diffuse(&shares, l) };
        Some((BsdfSample::reflected(l, mixture.weight()), mixture.pdf()))
    }

    #[inline]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        _transport: Transport,
    ) -> ([f32; N], f32) {
        let (v, l) = (vec3(v), vec3(l));
        if !(v.z > 0.0 && l.z > 0.0 && are_finite(v, l)) {
            return ([0.0; N], 0.0);
        }
        let shares = self.energy.shares(OUTSIDE, v);
        let facets = self.halfway(&shares, v, l);
        let p = self.facets_share(&shares);
        Mixture { p, facets, broad: self.diffuse(&shares, l) }.f_pdf(l)
    }

    /// Never: the base scatters.
    fn is_delta(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        false
    }
}
