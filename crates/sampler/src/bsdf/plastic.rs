//! Plastic: a rough dielectric coat over a diffuse base.

use glam::Vec3;
use microfacet_core::Masking;
use microfacet_core::math::unit;

use super::broad::Broad;
use super::coat::CoatAlbedo;
use super::compensation::Compensation;
use super::energy::{BoundInterface, Energy, InterfaceAlbedo, OUTSIDE, Shares};
use super::family_dielectric::DielectricAt;
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
/// base returns at most 1.003 of the light all the same. Compensation needs albedos of the coat:
/// the [default set](crate::Tables::embedded) has those of common round coats, and a set baked from
/// a recipe has those that it names, of upright lobes of the family; [`StandIn::Round`] uses those
/// of round lobes for others that have none.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{BsdfSettings, Compensation, Plastic, Tables};
///
/// let tables = Tables::embedded();
/// let (coat, green) = (tables.student_t(0.3, 2.5)?, [0.1, 0.4, 0.2]);
/// let single = Plastic::new(coat.clone(), 1.5, green, BsdfSettings::new())?;
/// let settings = BsdfSettings::new().compensated(Compensation::KullaConty, &tables);
/// let all = Plastic::new(coat.clone(), 1.5, green, settings)?;
/// // Where a set lacks the coat, the error has the lines to bake: `Tables::from_bytes(&file)`.
/// let why = Plastic::new(coat, 2.4, green, settings).unwrap_err();
/// assert!(why.to_string().contains("gamma = 2.5\nfresnel = { dielectric = 2.4 }"));
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
///
/// [`StandIn::Round`]: crate::StandIn::Round
/// [`Dielectric`]: crate::Dielectric
#[derive(Clone, Debug)]
pub struct Plastic<L, const N: usize = 3, A = BoundInterface> {
    lobe: L,
    /// The index as it was given, and in single precision.
    index: f64,
    eta: f32,
    base: [f32; N],
    masking: Masking,
    smooth: bool,
    energy: Energy<A>,
    /// ρ/(η² (1 − ρ R)), and the mean of that times the average of T.
    diffuse: [f32; N],
    mean: f32,
    /// The share of the plain cosine in the density of light of the base and of the coat's further
    /// bounces; the rest is the interface's.
    plain: f32,
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
        index: [f64; 2],
        base: [f32; N],
        masking: Masking,
        smooth: bool,
        energy: Energy,
    ) -> Self {
        let mut plastic = Self::of(lobe, index, base, masking, smooth, energy);
        // Base and coat in proportion, on average over views.
        let mean = mean(&plastic.diffuse);
        plastic.energy = plastic.energy.drawn_by(|energy, l| {
            let shares = energy.shares(OUTSIDE, l);
            energy.transmitted(&shares) * mean
                + energy.reflected(OUTSIDE) * energy.returned(&shares)
        });
        Self { plain: 0.0, ..plastic }
    }
}

impl<'a, L: Reflecting, const N: usize> Plastic<L, N, DielectricAt<'a>> {
    /// Plastic made at a hit, for coats whose σ, or σ and γ, and bases whose albedo come from
    /// textures.
    ///
    /// `at` is what [`FamilyDielectric`](crate::FamilyDielectric) has at the σ and γ of the lobe;
    /// of a lobe that is not round, at √(σx σy), whose albedos stand in with the errors of
    /// [`StandIn`](crate::StandIn). Index and form of masking are its own. The albedo of the base
    /// is clamped to [0, 1], NaN to 0.
    ///
    /// ```no_run
    /// use microfacet_sampler::{Bsdf, Compensation, Masking, Plastic, Tables, Transport};
    ///
    /// let tables = Tables::from_bytes(&std::fs::read("coat/tables.safetensors")?)?;
    /// let (family, coat) =
    ///     (tables.family()?, tables.family_dielectric(1.5, Masking::HeightCorrelated)?); // once
    /// let (sigma, gamma, base) = (0.3, 2.5, [0.1, 0.4, 0.2]); // at every hit
    /// let hit = Plastic::at_hit(
    ///     family.at(sigma, gamma),
    ///     coat.at(sigma, gamma),
    ///     base,
    ///     Compensation::KullaConty,
    /// );
    /// let sample = hit.sample([0.6, 0.0, 0.8], 0.3, [0.4, 0.7], Transport::Radiance);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn at_hit(
        lobe: L,
        at: DielectricAt<'a>,
        base: [f32; N],
        compensation: Compensation,
    ) -> Self {
        let (index, eta, masking) = (at.eta(), at.index(), at.masking());
        let smooth = lobe.is_effectively_smooth() || eta == 1.0;
        let energy = at.energy(compensation, smooth);
        Self::of(lobe, [index, eta.into()], base.map(unit), masking, smooth, energy)
    }
}

impl<L: Reflecting, const N: usize, A: InterfaceAlbedo> Plastic<L, N, A> {
    fn of(
        lobe: L,
        [index, eta]: [f64; 2],
        base: [f32; N],
        masking: Masking,
        smooth: bool,
        energy: Energy<A>,
    ) -> Self {
        let diffuse = base.map(|base| {
            let left = energy.left(base);
            // 1 − ρ R = 0 only where the coat transmits nothing.
            if left > 0.0 { base / left } else { 0.0 }
        });
        let mean = mean(&diffuse) * energy.transmitted_average();
        let coat = energy.reflected_average();
        let plain = if coat > 0.0 { mean / (mean + coat) } else { 1.0 };
        Self { lobe, index, eta: eta as f32, base, masking, smooth, energy, diffuse, mean, plain }
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

    /// The shares of the light of a view that one bounce off the coat reflects and transmits, each
    /// in [0, 1]; what is missing to 1 is lost to further bounces.
    ///
    /// `v` is of unit length in the tangent frame; a view from below, or with NaN, has the shares
    /// of one on the horizon. They err as [`Plastic`] says, or as the tables of a compensation do.
    ///
    /// ```
    /// # #[cfg(feature = "embedded")] {
    /// use microfacet_sampler::{BsdfSettings, Plastic, Tables};
    ///
    /// let coat = Tables::embedded().student_t(0.1, 2.0)?;
    /// let plastic = Plastic::new(coat, 1.5, [0.5; 3], BsdfSettings::new())?;
    /// let [reflected, transmitted] = plastic.coat_shares([0.0, 0.0, 1.0]);
    /// assert!((reflected - 0.04).abs() < 1e-3 && (transmitted - 0.96).abs() < 5e-3);
    /// # }
    /// # Ok::<(), microfacet_sampler::BindError>(())
    /// ```
    #[must_use]
    pub fn coat_shares(&self, v: impl Into<[f32; 3]>) -> [f32; 2] {
        let v = vec3(v);
        let shares = self.energy.shares(OUTSIDE, Vec3::new(v.x, v.y, unit(v.z)));
        [shares.reflection, shares.transmission]
    }

    /// The share 1 − R of diffuse light from inside that the coat does not reflect, in (0, 1]: it
    /// leaves, or is lost to further bounces where there is no compensation.
    ///
    /// With its digits where a dense coat lets out little, and within the errors of
    /// [`coat_shares`](Self::coat_shares).
    #[must_use]
    pub fn leaving(&self) -> f32 {
        self.energy.left(1.0) / (self.eta * self.eta)
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

    /// A light of the base or of the coat's further bounces; `None` on the horizon.
    #[inline(always)]
    fn sample_above(&self, [u, azimuth]: [f32; 2]) -> Option<Vec3> {
        let (is_plain, u) = chosen(unit(u), self.plain);
        let broad = if is_plain { &Broad::COSINE } else { self.energy.broad(OUTSIDE) };
        broad.sample_above([u, azimuth])
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
        let factor = self.plain + (1.0 - self.plain) * energy.broad(OUTSIDE).factor(l);
        Part::broad(l, factor, 1.0, lobe)
    }
}

/// The mean over the channels.
fn mean<const N: usize>(all: &[f32; N]) -> f32 {
    all.iter().sum::<f32>() / N as f32
}

impl<L: Reflecting, const N: usize, A: InterfaceAlbedo> Bsdf<N> for Plastic<L, N, A> {
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
            let l = self.sample_above(u)?;
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

    fn is_symmetric(&self) -> bool {
        self.smooth || self.lobe.is_symmetric()
    }
}
