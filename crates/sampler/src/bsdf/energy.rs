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

#[derive(Clone, Debug)]
pub(super) struct Energy {
    albedo: OneBounce,
    compensation: Compensation,
    eta: f32,
    /// The average that is lost to further bounces, from outside and from inside, and the share of
    /// it that further bounces reflect.
    lost: [f32; 2],
    reflected: [f32; 2],
    /// The average that is transmitted from outside, compensation included.
    transmitted: f32,
}

/// The albedos of one bounce.
#[derive(Clone, Debug)]
enum OneBounce {
    /// Of a smooth interface, which loses nothing.
    Smooth,
    /// From tables.
    Tables(Box<DielectricAlbedo>),
    /// Of a lobe, from outside alone.
    Coat(CoatAlbedo),
}

/// The shares of the light of one view: reflected, transmitted and lost in one bounce.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    pub(super) reflection: f32,
    pub(super) transmission: f32,
    pub(super) lost: f32,
}

impl Shares {
    fn of([reflection, transmission]: [f32; 2]) -> Self {
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

impl Energy {
    /// The energy of a smooth interface of index η, inside over outside.
    pub(super) fn smooth(eta: f32) -> Self {
        // Averages are taken on the thin side, whose reflectance has no kink; the averages
        // transmitted from the two sides differ by η².
        let dense = eta.max(1.0 / eta);
        let thin = 1.0 - fresnel_average(|cos| dielectric(dense, cos));
        let transmitted = if eta >= 1.0 { thin } else { thin / (dense * dense) };
        let (albedo, compensation) = (OneBounce::Smooth, Compensation::None);
        let (lost, reflected) = ([0.0; 2], [1.0; 2]);
        Self { albedo, compensation, eta, lost, transmitted, reflected }
    }

    /// The energy of one bounce off a rough coat, seen from outside.
    pub(super) fn coat(albedo: CoatAlbedo, eta: f32) -> Self {
        Self {
            compensation: Compensation::None,
            eta,
            lost: [0.0, albedo.lost_inside],
            reflected: [1.0; 2],
            transmitted: albedo.transmitted(),
            albedo: OneBounce::Coat(albedo),
        }
    }

    /// The energy of a rough interface; the albedos must be those of its lobe, index and form of
    /// masking.
    pub(super) fn rough(albedo: DielectricAlbedo, compensation: Compensation, eta: f32) -> Self {
        let sides = [&albedo.outside, &albedo.inside];
        // By the same formulas as single views, so that a white furnace closes.
        let averages = sides.map(|curve| {
            curve.average_of(|shares| {
                let Shares { reflection, transmission, lost } = Shares::of(shares);
                let whole = (transmission * turquin(lost, 1.0)).into();
                [reflection.into(), transmission.into(), lost.into(), whole]
            })
        });
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
            albedo: OneBounce::Tables(Box::new(albedo)),
            compensation,
            eta,
            lost: lost.map(|x| x as f32),
            transmitted: transmitted as f32,
            reflected: crossing.map(|x| (1.0 - x) as f32),
        }
    }

    /// The shares of a view, given above the surface on either side.
    #[inline]
    pub(super) fn shares(&self, side: usize, v: Vec3) -> Shares {
        match &self.albedo {
            OneBounce::Smooth => {
                let reflection = Interface::new(self.eta, side == OUTSIDE).reflectance(v.z.abs());
                Shares { reflection, transmission: 1.0 - reflection, lost: 0.0 }
            }
            OneBounce::Tables(albedo) => {
                let curve = if side == 0 { &albedo.outside } else { &albedo.inside };
                Shares::of(curve.eval(Vec3::new(v.x, v.y, v.z.abs())))
            }
            OneBounce::Coat(albedo) => Shares::of(albedo.shares(v)),
        }
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
        self.reflected[side]
    }

    /// The densities of the lobes of further bounces on either side.
    pub(super) fn broad(&self) -> [Broad; 2] {
        match self.compensation {
            Compensation::KullaConty => {
                [0, 1].map(|side| Broad::new(|l| self.shares(side, l).lost))
            }
            _ => [Broad::COSINE; 2],
        }
    }

    /// π times the lobe of further bounces between a view and a light on a given side, over the
    /// share of the lost light that goes to that side: for a view it integrates to `lost`.
    #[inline(always)]
    pub(super) fn lobe(&self, lost: f32, side: usize, there: &Shares) -> f32 {
        kulla_conty(lost, there.lost, self.lost[side])
    }

    /// The share of a view's light from outside that all bounces together transmit.
    #[inline(always)]
    pub(super) fn transmitted(&self, shares: &Shares) -> f32 {
        shares.transmission * self.factor(shares)
            + (1.0 - self.reflected[OUTSIDE]) * self.returned(shares)
    }

    /// The cosine-weighted average of [`transmitted`](Self::transmitted) over views.
    pub(super) fn transmitted_average(&self) -> f32 {
        self.transmitted
    }

    /// η² (1 − ρ R) for a base of albedo ρ, with R the share of diffuse light from inside that the
    /// coat reflects.
    ///
    /// By reciprocity the share that it transmits is T/η², and without compensation some is lost.
    /// So 1 − R is computed as their sum: a dense coat lets so little out that it would be all
    /// rounding of 1 − R, and the light that enters a white base leaves it again.
    pub(super) fn left(&self, base: f32) -> f32 {
        let squared = self.eta * self.eta;
        let lost = if self.compensation == Compensation::None { self.lost[1] } else { 0.0 };
        squared * (1.0 - base) + base * (self.transmitted + squared * lost)
    }
}
