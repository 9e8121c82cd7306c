//! A rough dielectric: reflection and refraction.

use glam::Vec3;
use microfacet_core::{Masking, saturated};

use super::compensation::Compensation;
use super::energy::{BoundInterface, Energy, InterfaceAlbedo, Shares, side};
use super::family_dielectric::DielectricAt;
use super::interface::{Interface, Refraction, checked};
use super::mixture::{Mixture, are_finite, choice, chosen};
use super::settings::BsdfSettings;
use super::{Bsdf, BsdfSample, Event, Transport};
use crate::albedo::DielectricAlbedo;
use crate::bind_error::BindError;
use crate::material::{Facet, MicrofacetDistribution, Part, Tabulated, White};
use crate::vector::vec3;

/// A rough interface between two transparent media: every facet reflects F of the light and
/// refracts the rest, by Fresnel's equations and Snell's law.
///
/// Conventions are those of [`Bsdf`]; all N channels are the same. Seen from either side, the
/// microsurface is the same: a direction below is replaced by its opposite, v ↦ −v, which leaves
/// the facets as they are. Walter et al. 2007, eq. 20–21,
/// <https://doi.org/10.2312/EGWR/EGSR07/195-206>. Facets are drawn by visible normals and events by
/// F, so a sample's weight is G2/G1 ≤ 1, for refracted radiance times (n_v/n_l)². Height-correlated
/// masking of transmission is 1/(1 + Λ(v) + Λ(l)), as of reflection. An η within 1e-5 of 1 counts
/// as 1: all light goes straight on, as a delta. For |η − 1| < 1e-3 the facet between two
/// directions is known to 1e-8/|η − 1| only, so that `eval` and `pdf` of a narrow lobe err by some
/// per cent; samples do not.
///
/// For γ < 2 many of the facets that a view sees are too steep to be found from a view and a light
/// in single precision: they transmit light within rounding of the cone l·n = −(v·n)/η, where the
/// density has a pole. These facets, of m·n below 3e-6 (1 + η)/|1 − η|, are *only sampled*: their
/// light is flagged as a delta and has its whole weight, and f and density are those of the other
/// facets alone. So a renderer that weights by densities stays unbiased, as for a mirror. Of light
/// transmitted at 50° into glass (η = 1.5, σ = 0.3) that is 94 % at γ = 1.501, 12 % at 1.55, 0.65 %
/// at 1.65 and 0.02 % at 1.8, as the example `steep_facets` prints.
#[derive(Clone, Debug)]
pub struct Dielectric<L, const N: usize = 3, A = BoundInterface> {
    lobe: L,
    /// The index as it was given, and in single precision.
    index: f64,
    eta: f32,
    masking: Masking,
    smooth: bool,
    /// Whether D has a pole at the horizon, and facets next to it are only sampled.
    has_pole: bool,
    /// `None` without compensation.
    returned: Option<Energy<A>>,
}

/// The view or its opposite, whichever is above the surface, and the interface as seen from there.
#[derive(Clone, Copy)]
struct Seen {
    v: Vec3,
    side: usize,
    face: Interface,
    /// −1 for a view from below.
    sign: f32,
}

/// The compensation and the shares of a view's light; `None` without compensation.
type Account<'a, A> = Option<(&'a Energy<A>, Shares)>;

/// A facet's normal and, where the facet refracts, the quantities of the density.
type Sender = (Vec3, Option<Refraction>);

impl<L: Tabulated> Dielectric<L> {
    /// A dielectric of a lobe and an index of refraction η, inside over outside, in three channels:
    /// no argument would tell their number, which [`with_channels`](Self::with_channels) changes.
    ///
    /// # Errors
    /// [`BindError::Index`] unless η lies in [1e-3, 1e3]; [`BindError`] if a compensation was asked
    /// for and its tables hold no albedo of the lobe for the index and the form of masking, with
    /// the lines of a recipe that add one.
    pub fn new(lobe: L, eta: f64, settings: BsdfSettings<'_>) -> Result<Self, BindError> {
        let (index, eta) = (eta, checked(eta)?);
        let smooth = lobe.is_effectively_smooth() || eta == 1.0;
        let has_pole = lobe.has_pole();
        let masking = settings.masking;
        let single = Self { lobe, index, eta, masking, smooth, has_pole, returned: None };
        match settings.compensation().filter(|_| !smooth) {
            None => Ok(single),
            Some((compensation, tables)) => {
                let albedo =
                    tables.dielectric_albedo_of(&single.lobe, index, masking, settings.stand_in)?;
                Ok(single.compensated_by(albedo, compensation))
            }
        }
    }
}

impl<L: MicrofacetDistribution, const N: usize, A> Dielectric<L, N, A> {
    /// This dielectric in another number of channels.
    #[must_use]
    pub fn with_channels<const M: usize>(self) -> Dielectric<L, M, A> {
        let Self { lobe, index, eta, masking, smooth, has_pole, returned } = self;
        Dielectric { lobe, index, eta, masking, smooth, has_pole, returned }
    }
}

impl<L: MicrofacetDistribution, const N: usize> Dielectric<L, N> {
    /// This dielectric with a compensation by given albedos, which must be of the same lobe and
    /// index; their form of masking becomes that of the dielectric.
    #[must_use]
    pub fn compensated_by(self, albedo: DielectricAlbedo, compensation: Compensation) -> Self {
        let masking = albedo.masking;
        let none = compensation == Compensation::None || self.smooth;
        let energy = || Energy::rough(albedo, compensation, self.eta).with_lobes();
        Self { masking, returned: (!none).then(energy), ..self }
    }
}

impl<'a, L: Tabulated> Dielectric<L, 3, DielectricAt<'a>> {
    /// A dielectric made at a hit, for lobes whose σ, or σ and γ, come from textures, in three
    /// channels, which [`with_channels`](Self::with_channels) changes.
    ///
    /// `at` is what [`FamilyDielectric`](crate::FamilyDielectric) has at the σ and γ of the lobe;
    /// of a lobe that is not round, at √(σx σy), whose albedos stand in with the errors of
    /// [`StandIn`](crate::StandIn). Index and form of masking are its own. A single bounce needs
    /// no tables: [`new`](Dielectric::new) makes that of a hit as well.
    ///
    /// ```no_run
    /// use microfacet_sampler::{Bsdf, Compensation, Dielectric, Masking, Tables, Transport};
    ///
    /// let tables = Tables::from_bytes(&std::fs::read("glass/tables.safetensors")?)?;
    /// let (family, glass) =
    ///     (tables.family()?, tables.family_dielectric(1.5, Masking::HeightCorrelated)?); // once
    /// let (sigma, gamma, v) = (0.3, 2.5, [0.6, 0.0, 0.8]); // at every hit
    /// let hit = Dielectric::at_hit(
    ///     family.at(sigma, gamma),
    ///     glass.at(sigma, gamma),
    ///     Compensation::KullaConty,
    /// );
    /// let sample = hit.sample(v, 0.3, [0.4, 0.7], Transport::Radiance);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn at_hit(lobe: L, at: DielectricAt<'a>, compensation: Compensation) -> Self {
        let (index, eta, masking) = (at.eta(), at.index(), at.masking());
        let (smooth, has_pole) = (lobe.is_effectively_smooth() || eta == 1.0, lobe.has_pole());
        let none = compensation == Compensation::None || smooth;
        let returned = (!none).then(|| at.energy(compensation, false));
        Self { lobe, index, eta, masking, smooth, has_pole, returned }
    }
}

impl<L: MicrofacetDistribution, const N: usize, A: InterfaceAlbedo> Dielectric<L, N, A> {
    /// The lobe.
    #[must_use]
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// The index of refraction, inside over outside.
    #[must_use]
    pub fn eta(&self) -> f64 {
        self.index
    }

    /// The form of masking and shadowing.
    #[must_use]
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// `None` for a view in the surface, or NaN.
    #[inline(always)]
    fn seen(&self, v: Vec3) -> Option<Seen> {
        let above = v.z > 0.0;
        if !((above || v.z < 0.0) && are_finite(v, v)) {
            return None;
        }
        let sign = if above { 1.0 } else { -1.0 };
        let face = Interface::new(self.eta, above);
        Some(Seen { v: sign * v, side: side(above), face, sign })
    }

    #[inline(always)]
    fn account(&self, seen: &Seen) -> Account<'_, A> {
        let energy = self.returned.as_ref()?;
        Some((energy, energy.shares(seen.side, seen.v)))
    }

    /// A facet, without its density where that is not needed.
    #[inline(always)]
    fn facet(&self, v: Vec3, m: Vec3, l: Vec3, with_pdf: bool) -> Facet {
        if with_pdf {
            return self.lobe.facet(v, m, l, self.masking);
        }
        Facet { density: 0.0, weight: self.lobe.reflection_weight(v, l, self.masking) }
    }

    /// The part of the mixture that facets reflect or refract to a light.
    #[inline(always)]
    fn facets(
        &self,
        seen: &Seen,
        account: Account<'_, A>,
        l: Vec3,
        sender: Sender,
        scale: f32,
        with_pdf: bool,
    ) -> Part<N> {
        let v = seen.v;
        let factor = account.map_or(1.0, |(energy, shares)| energy.factor(&shares));
        let (m, refraction) = sender;
        match refraction {
            None => {
                let white = White::new(self.facet(v, m, l, with_pdf), 1.0, v.dot(m));
                let pdf = white.pdf * seen.face.reflectance(white.cos);
                Part { pdf, ..white.part([factor; N]) }
            }
            Some(Refraction { transmittance, jacobian, .. }) => {
                // The opposite of the light is above the surface.
                let facet = self.facet(v, m, -l, with_pdf);
                let pdf = saturated(transmittance * jacobian * facet.density);
                Part { weight: [facet.weight * factor * scale; N], pdf }
            }
        }
    }

    /// The mixture at a light, both as in [`Seen`].
    #[inline(always)]
    fn mixture(
        &self,
        seen: &Seen,
        account: Account<'_, A>,
        l: Vec3,
        sender: Option<Sender>,
        scale: f32,
        with_pdf: bool,
    ) -> Mixture<N> {
        // The weight of a mixture of two parts takes their densities.
        let lost = account.map_or(0.0, |(energy, shares)| energy.returned(&shares));
        let with_pdf = with_pdf || lost > 0.0;
        let facets = sender
            .map_or(Part::NONE, |sender| self.facets(seen, account, l, sender, scale, with_pdf));
        let Some((energy, _)) = account.filter(|_| lost > 0.0) else {
            return Mixture { p: 1.0, facets, broad: Part::NONE };
        };
        let reflected = energy.reflected(seen.side);
        let (side, share, scale) = if l.z > 0.0 {
            (seen.side, reflected, 1.0)
        } else {
            (1 - seen.side, 1.0 - reflected, scale)
        };
        let lobe = [energy.lobe(lost, side, &energy.shares(side, l)) * scale; N];
        let broad = Part::broad(l, energy.broad(side).factor(l), share, lobe);
        Mixture { p: 1.0 - lost, facets, broad }
    }

    /// The facet between view and light as in [`Seen`]; `None` if there is none, or if it is only
    /// sampled.
    #[inline(always)]
    fn between(&self, seen: &Seen, l: Vec3) -> Option<Sender> {
        if l.z > 0.0 {
            return Some(((seen.v + l).normalize_or_zero(), None));
        }
        let facet = seen.face.facet(seen.v, l)?;
        let is_known = !self.has_pole || facet.m.z >= seen.face.steep();
        is_known.then_some((facet.m, Some(facet)))
    }

    /// Whether a drawn facet may be one that is only sampled. For others the drawn facet is used as
    /// it is: the facet found between the view and the light differs by rounding alone.
    #[inline(always)]
    fn may_be_steep(&self, seen: &Seen, (m, refraction): &Sender) -> bool {
        self.has_pole && refraction.is_some() && m.z < 2.0 * seen.face.steep()
    }

    #[inline(always)]
    fn drawn(seen: &Seen, choice: f32, m: Vec3) -> Option<(Vec3, Sender)> {
        let facing = seen.v.dot(m);
        if !(facing > 0.0) {
            return None;
        }
        if choice < seen.face.reflectance(facing) {
            let l = 2.0 * facing * m - seen.v;
            return (l.z > 0.0).then_some((l, (m, None)));
        }
        let (l, refraction) = seen.face.refract(seen.v, m, facing)?;
        (l.z < 0.0).then_some((l, (m, Some(refraction))))
    }

    /// A sample, with its density if `PDF`.
    #[inline]
    fn draw<const PDF: bool>(
        &self,
        v: Vec3,
        number: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        let seen = self.seen(v)?;
        let (scale, number) = (seen.face.scale(transport), choice(number));
        let sample = |l: Vec3, weight, pdf, delta| {
            let (event, eta) = if l.z > 0.0 {
                (Event::Reflection, 1.0)
            } else {
                (Event::Transmission, seen.face.eta())
            };
            let l = (seen.sign * l).to_array();
            (BsdfSample { l, weight, event, delta, eta }, pdf)
        };
        if self.smooth {
            let (l, (_, refraction)) = Self::drawn(&seen, number, Vec3::Z)?;
            let weight = if refraction.is_some() { scale } else { 1.0 };
            return Some(sample(l, [weight; N], 0.0, true));
        }
        let account = self.account(&seen);
        let lost = account.map_or(0.0, |(energy, shares)| energy.returned(&shares));
        let (l, sender) = match (chosen(number, 1.0 - lost), account) {
            ((false, rest), Some((energy, _))) => {
                let (is_reflected, _) = chosen(rest, energy.reflected(seen.side));
                let l = if is_reflected {
                    energy.broad(seen.side).sample(u)
                } else {
                    -energy.broad(1 - seen.side).sample(u)
                };
                if l.z == 0.0 {
                    return None;
                }
                (l, self.between(&seen, l))
            }
            ((_, rest), _) => {
                let m = vec3(self.lobe.sample_visible_normal(seen.v, u));
                let (l, sender) = Self::drawn(&seen, rest, m)?;
                if self.may_be_steep(&seen, &sender) {
                    // Decided as evaluation does.
                    let found = self.between(&seen, l);
                    if found.is_none() {
                        let facets = self.facets(&seen, account, l, sender, scale, false);
                        let weight = facets.weight.map(|weight| weight / (1.0 - lost));
                        return Some(sample(l, weight, 0.0, true));
                    }
                    (l, found)
                } else {
                    (l, Some(sender))
                }
            }
        };
        let mixture = self.mixture(&seen, account, l, sender, scale, PDF);
        Some(sample(l, mixture.weight(), mixture.pdf(), false))
    }
}

impl<L: MicrofacetDistribution, const N: usize, A: InterfaceAlbedo> Bsdf<N>
    for Dielectric<L, N, A>
{
    #[inline]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        self.draw::<true>(vec3(v), choice, u, transport)
    }

    #[inline]
    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample<N>> {
        Some(self.draw::<false>(vec3(v), choice, u, transport)?.0)
    }

    #[inline]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; N], f32) {
        let nothing = ([0.0; N], 0.0);
        let Some(seen) = self.seen(vec3(v)).filter(|_| !self.smooth) else { return nothing };
        let l = seen.sign * vec3(l);
        if l.z == 0.0 || !are_finite(l, l) {
            return nothing;
        }
        let (account, sender) = (self.account(&seen), self.between(&seen, l));
        self.mixture(&seen, account, l, sender, seen.face.scale(transport), true).f_pdf(l)
    }

    fn is_delta(&self) -> bool {
        self.smooth
    }

    fn transmits(&self) -> bool {
        true
    }

    fn is_symmetric(&self) -> bool {
        self.smooth || self.lobe.is_symmetric()
    }
}
