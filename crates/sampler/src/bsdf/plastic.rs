//! Plastic: a rough dielectric coat over a diffuse base.

use alloc::boxed::Box;

use glam::Vec3;
use microfacet_core::Masking;

use super::bind::StandIn;
use super::broad::Broad;
use super::compensation::Compensation;
use super::energy::{Energy, OUTSIDE, Shares};
use super::error::BindError;
use super::facets::{Facets, White};
use super::interface::{Interface, checked};
use super::mixture::{Mixture, Part, are_finite, choice, chosen};
use super::reflectance::reflectances;
use super::{Bsdf, BsdfSample, Transport};
use crate::albedo::DielectricAlbedo;
use crate::material::MicrofacetDistribution;
use crate::tables::Tables;

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
/// between base and coat any number of times is included. T and R are from the tables' albedos,
/// compensation included; a smooth coat needs no tables. With a compensation a white base returns
/// all light. With a [`Bounded`](crate::lobe::Bounded) lobe fewer samples are lost.
///
/// The default set has no albedos of rough coats. They are baked for a recipe that names the coat,
/// for round lobes of the family; [`StandIn::Round`] uses them for anisotropic and tilted lobes.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::lobe::Smooth;
/// use microfacet_sampler::{Compensation, Plastic, StandIn, Tables};
///
/// let tables = Tables::embedded();
/// let coat = tables.student_t(0.3, 2.5)?;
/// let (none, green) = (Compensation::None, [0.1, 0.4, 0.2]);
/// let rough = Plastic::new(coat, 1.5, green, &tables, none, StandIn::Refused);
/// let recipe = rough.err().and_then(|why| why.recipe()).expect("refused for want of an albedo");
/// // Bake these lines, and load the set: Tables::from_bytes(&file).
/// assert!(recipe.contains("gamma = 2.5\nfresnel = { dielectric = 1.5 }"));
/// // A smooth coat needs no albedo.
/// assert!(Plastic::new(Smooth, 1.5, green, &tables, none, StandIn::Refused).is_ok());
/// # }
/// # Ok::<(), microfacet_sampler::MaterialError>(())
/// ```
///
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

impl<L: MicrofacetDistribution, const N: usize> Plastic<L, N> {
    /// Plastic with a coat of index η, inside over outside, over a base of albedo ρ, with
    /// height-correlated masking, and albedos of the coat from tables.
    ///
    /// # Errors
    /// [`BindError`] for an η outside [1e-3, 1e3], a ρ outside [0, 1], or a rough coat whose albedo
    /// the tables do not hold, which is needed without compensation too; the error has the lines of
    /// a recipe that add it.
    pub fn new(
        lobe: L,
        eta: f64,
        base: [f32; N],
        tables: &Tables,
        compensation: Compensation,
        stand_in: StandIn,
    ) -> Result<Self, BindError> {
        let masking = Masking::default();
        Self::new_masked(lobe, eta, base, masking, tables, compensation, stand_in)
    }

    /// [`new`](Self::new) with a form of masking and shadowing.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn new_masked(
        lobe: L,
        eta: f64,
        base: [f32; N],
        masking: Masking,
        tables: &Tables,
        compensation: Compensation,
        stand_in: StandIn,
    ) -> Result<Self, BindError> {
        Self::made(lobe, eta, base, masking, compensation, |lobe| {
            tables.dielectric_albedo_of(lobe, eta, masking, stand_in)
        })
    }

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
        let masking = albedo.masking;
        Self::made(lobe, eta, base, masking, compensation, |_| Ok(albedo))
    }

    fn made(
        lobe: L,
        eta: f64,
        base: [f32; N],
        masking: Masking,
        compensation: Compensation,
        albedo: impl FnOnce(&L) -> Result<DielectricAlbedo, BindError>,
    ) -> Result<Self, BindError> {
        let (index, eta) = (eta, checked(eta)?);
        reflectances("base", &base)?;
        let smooth = lobe.is_effectively_smooth() || eta == 1.0;
        let energy = Box::new(if smooth {
            Energy::smooth(eta)
        } else {
            Energy::rough(albedo(&lobe)?, compensation, eta)
        });
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
        Ok(Self { lobe, index, eta, base, masking, smooth, energy, diffuse, mean, broad })
    }

    /// The lobe of the coat.
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// The index of refraction of the coat, inside over outside.
    pub fn eta(&self) -> f64 {
        self.index
    }

    /// The albedo of the base.
    pub fn base(&self) -> [f32; N] {
        self.base
    }

    /// The form of masking and shadowing.
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
        Part::broad(l, &self.broad, 1.0, lobe)
    }
}

impl<L: MicrofacetDistribution, const N: usize> Bsdf<N> for Plastic<L, N> {
    #[inline]
    fn sample(
        &self,
        v: Vec3,
        number: f32,
        u: [f32; 2],
        _transport: Transport,
    ) -> Option<BsdfSample<N>> {
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
            return Some(BsdfSample::mirrored(v, [shares.reflection / p; N]));
        } else {
            let (l, white) = self.facets().draw(v, u)?;
            (l, self.coat(&shares, white))
        };
        let mixture = Mixture { p, facets, broad: self.diffuse(&shares, l) };
        Some(BsdfSample::reflected(l, mixture.weight(), mixture.pdf()))
    }

    #[inline]
    fn eval_pdf(&self, v: Vec3, l: Vec3, _transport: Transport) -> ([f32; N], f32) {
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
