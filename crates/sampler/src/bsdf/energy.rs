//! The energy of a dielectric interface for light from either side: the shares that one bounce
//! reflects and transmits, and the distribution of the light of further bounces.

use alloc::boxed::Box;

use microfacet_core::fresnel::dielectric;

use super::broad::Broad;
use super::coat::CoatAlbedo;
use super::compensation::{Compensation, kulla_conty, turquin};
use super::interface::Interface;
use crate::albedo::{DielectricAlbedo, fresnel_average};
use glam::Vec3;

/// The albedos of one bounce off an interface, however they are looked up, and the densities of the
/// lights of further bounces: [`BoundInterface`] is of one material, and
/// [`DielectricAt`](crate::DielectricAt) of the σ and γ of a hit.
pub trait InterfaceAlbedo {
    /// The shares reflected and transmitted of a view, given above the surface; from outside for
    /// side 0.
    #[doc(hidden)]
    fn shares(&self, side: usize, v: Vec3) -> [f32; 2];

    /// The density of lights of further bounces on a side.
    #[doc(hidden)]
    fn broad(&self, side: usize) -> &Broad;
}

/// The albedos of an interface that is bound to one material.
#[derive(Clone, Debug)]
pub struct BoundInterface {
    albedo: OneBounce,
    broad: Box<[Broad; 2]>,
}

/// The albedos of one bounce.
#[derive(Clone, Debug)]
enum OneBounce {
    /// Of a smooth interface, which loses nothing, by its index.
    Smooth(f32),
    /// From tables.
    Tables(Box<DielectricAlbedo>),
    /// Of a lobe, from outside alone.
    Coat(Box<CoatAlbedo>),
}

impl From<OneBounce> for BoundInterface {
    fn from(albedo: OneBounce) -> Self {
        Self { albedo, broad: Box::new([Broad::COSINE; 2]) }
    }
}

impl InterfaceAlbedo for BoundInterface {
    #[inline]
    fn shares(&self, side: usize, v: Vec3) -> [f32; 2] {
        match &self.albedo {
            OneBounce::Smooth(eta) => smooth_shares(*eta, side, v),
            OneBounce::Tables(albedo) => {
                let curve = if side == OUTSIDE { &albedo.outside } else { &albedo.inside };
                curve.eval(Vec3::new(v.x, v.y, v.z.abs()))
            }
            OneBounce::Coat(albedo) => albedo.shares(v),
        }
    }

    #[inline(always)]
    fn broad(&self, side: usize) -> &Broad {
        &self.broad[side]
    }
}

/// The shares of a smooth interface of index η, inside over outside.
#[inline]
pub(super) fn smooth_shares(eta: f32, side: usize, v: Vec3) -> [f32; 2] {
    let reflection = Interface::new(eta, side == OUTSIDE).reflectance(v.z.abs());
    [reflection, 1.0 - reflection]
}

/// The energy of an interface whose albedos are A.
#[derive(Clone, Copy, Debug)]
pub(super) struct Energy<A = BoundInterface> {
    albedo: A,
    compensation: Compensation,
    eta: f32,
    totals: Totals,
}

/// What an interface does with diffuse light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Totals {
    /// The average that is lost to further bounces, from outside and from inside, and the share of
    /// it that further bounces reflect.
    lost: [f32; 2],
    reflected: [f32; 2],
    /// The average that is transmitted from outside, compensation included.
    transmitted: f32,
}

/// The shares of the light of one view: reflected, transmitted and lost in one bounce.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    pub(super) reflection: f32,
    pub(super) transmission: f32,
    pub(super) lost: f32,
}

impl Shares {
    pub(super) fn of([reflection, transmission]: [f32; 2]) -> Self {
        // Interpolation may make the sum exceed 1 by the tables' error.
        Self { reflection, transmission, lost: (1.0 - reflection - transmission).max(0.0) }
    }
}

/// The index of the side above the surface; the side below has 1.
pub(super) const OUTSIDE: usize = 0;

#[inline(always)]
pub(super) fn side(above: bool) -> usize {
    if above { OUTSIDE } else { 1 - OUTSIDE }
}

/// Averages over the views of one side: the shares reflected, transmitted and lost, and what is
/// transmitted with Turquin's factor.
pub(super) type Averages = [f64; 4];

/// The averages of either side.
pub(super) fn averages(albedo: &DielectricAlbedo) -> [Averages; 2] {
    // By the same formulas as single views, so that a white furnace closes.
    [&albedo.outside, &albedo.inside].map(|curve| {
        curve.average_of(|shares| {
            let Shares { reflection, transmission, lost } = Shares::of(shares);
            let whole = (transmission * turquin(lost, 1.0)).into();
            [reflection.into(), transmission.into(), lost.into(), whole]
        })
    })
}

impl Totals {
    /// Of a smooth interface of index η, inside over outside.
    pub(super) fn smooth(eta: f32) -> Self {
        // Averages are taken on the thin side, whose reflectance has no kink; the averages
        // transmitted from the two sides differ by η².
        let dense = eta.max(1.0 / eta);
        let thin = 1.0 - fresnel_average(|cos| dielectric(dense, cos));
        let transmitted = if eta >= 1.0 { thin } else { thin / (dense * dense) };
        Self { lost: [0.0; 2], reflected: [1.0; 2], transmitted }
    }

    /// The average that is transmitted from outside.
    pub(super) fn transmitted(&self) -> f32 {
        self.transmitted
    }

    /// Of a rough interface, from its averages.
    pub(super) fn rough(averages: [Averages; 2], compensation: Compensation, eta: f32) -> Self {
        let lost = averages.map(|[_, _, lost, _]| lost);
        // By reciprocity the lost flux that changes sides is the same in both directions. It is
        // split as one bounce splits its light, and the smaller of the two results is taken.
        let squared = f64::from(eta) * f64::from(eta);
        let [outside, inside] = averages.map(|[reflection, transmission, lost, _]| {
            let sum = reflection + transmission;
            if sum > 0.0 { lost * transmission / sum } else { 0.0 }
        });
        let flux = outside.min(squared * inside);
        let crossing = |lost: f64, flux: f64| if lost > 0.0 { (flux / lost).min(1.0) } else { 0.0 };
        let crossing = [crossing(lost[0], flux), crossing(lost[1], flux / squared)];
        let [[_, single, _, whole], _] = averages;
        let transmitted = match compensation {
            Compensation::None => single,
            Compensation::Turquin => whole,
            Compensation::KullaConty => single + crossing[0] * lost[0],
        };
        Self {
            lost: lost.map(|x| x as f32),
            reflected: crossing.map(|x| (1.0 - x) as f32),
            transmitted: transmitted as f32,
        }
    }
}

impl Energy {
    /// The energy of a smooth interface of index η, inside over outside.
    pub(super) fn smooth(eta: f32) -> Self {
        let albedo = OneBounce::Smooth(eta).into();
        Self { albedo, compensation: Compensation::None, eta, totals: Totals::smooth(eta) }
    }

    /// The energy of one bounce off a rough coat, seen from outside.
    pub(super) fn coat(albedo: CoatAlbedo, eta: f32) -> Self {
        let totals = Totals {
            lost: [0.0, albedo.lost_inside],
            reflected: [1.0; 2],
            transmitted: albedo.transmitted(),
        };
        let albedo = OneBounce::Coat(Box::new(albedo)).into();
        Self { albedo, compensation: Compensation::None, eta, totals }
    }

    /// The energy of a rough interface; the albedos must be those of its lobe, index and form of
    /// masking.
    pub(super) fn rough(albedo: DielectricAlbedo, compensation: Compensation, eta: f32) -> Self {
        let totals = Totals::rough(averages(&albedo), compensation, eta);
        Self { albedo: OneBounce::Tables(Box::new(albedo)).into(), compensation, eta, totals }
    }

    /// With the densities of the lobes of further bounces on either side.
    pub(super) fn with_lobes(mut self) -> Self {
        if self.compensation == Compensation::KullaConty {
            *self.albedo.broad = [0, 1].map(|side| Broad::new(|l| self.shares(side, l).lost));
        }
        self
    }

    /// With a density in proportion to a function of the light, outside.
    pub(super) fn drawn_by(mut self, of: impl Fn(&Self, Vec3) -> f32) -> Self {
        self.albedo.broad[OUTSIDE] = Broad::new(|l| of(&self, l));
        self
    }
}

impl<A: InterfaceAlbedo> Energy<A> {
    pub(super) fn new(albedo: A, totals: Totals, compensation: Compensation, eta: f32) -> Self {
        Self { albedo, compensation, eta, totals }
    }

    /// The shares of a view, given above the surface on either side.
    #[inline]
    pub(super) fn shares(&self, side: usize, v: Vec3) -> Shares {
        Shares::of(self.albedo.shares(side, v))
    }

    /// The density of the lobe of further bounces on a side.
    #[inline(always)]
    pub(super) fn broad(&self, side: usize) -> &Broad {
        self.albedo.broad(side)
    }

    /// The factor on facets: Turquin's, or 1.
    #[inline(always)]
    pub(super) fn factor(&self, shares: &Shares) -> f32 {
        if self.compensation == Compensation::Turquin { turquin(shares.lost, 1.0) } else { 1.0 }
    }

    /// The share of a view's light that a lobe of further bounces returns: all that is lost, or 0.
    #[inline(always)]
    pub(super) fn returned(&self, shares: &Shares) -> f32 {
        if self.compensation == Compensation::KullaConty { shares.lost } else { 0.0 }
    }

    /// The share of what is lost that further bounces reflect.
    #[inline(always)]
    pub(super) fn reflected(&self, side: usize) -> f32 {
        self.totals.reflected[side]
    }

    /// π times the lobe of further bounces between a view and a light on a given side, over the
    /// share of the lost light that goes to that side: for a view it integrates to `lost`.
    #[inline(always)]
    pub(super) fn lobe(&self, lost: f32, side: usize, there: &Shares) -> f32 {
        kulla_conty(lost, there.lost, self.totals.lost[side])
    }

    /// The share of a view's light from outside that all bounces together transmit.
    #[inline(always)]
    pub(super) fn transmitted(&self, shares: &Shares) -> f32 {
        shares.transmission * self.factor(shares)
            + (1.0 - self.totals.reflected[OUTSIDE]) * self.returned(shares)
    }

    /// The cosine-weighted average of [`transmitted`](Self::transmitted) over views.
    pub(super) fn transmitted_average(&self) -> f32 {
        self.totals.transmitted
    }

    /// The average over views of what further bounces reflect.
    pub(super) fn reflected_average(&self) -> f32 {
        match self.compensation {
            Compensation::KullaConty => self.totals.reflected[OUTSIDE] * self.totals.lost[OUTSIDE],
            _ => 0.0,
        }
    }

    /// η² (1 − ρ R) for a base of albedo ρ, with R the share of diffuse light from inside that the
    /// coat reflects.
    ///
    /// By reciprocity the share that it transmits is T/η², and without compensation some is lost.
    /// So 1 − R is computed as their sum: a dense coat lets so little out that it would be all
    /// rounding of 1 − R, and the light that enters a white base leaves it again.
    pub(super) fn left(&self, base: f32) -> f32 {
        let squared = self.eta * self.eta;
        let lost = if self.compensation == Compensation::None { self.totals.lost[1] } else { 0.0 };
        squared * (1.0 - base) + base * (self.totals.transmitted + squared * lost)
    }
}
