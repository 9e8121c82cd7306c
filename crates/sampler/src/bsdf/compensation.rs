//! Energy compensation: the light that a single bounce off the microsurface loses to multiple
//! scattering is returned by a factor or by a lobe of its own.
//!
//! Both forms need the directional albedo E of the same lobe and form of masking that the
//! single-scattering lobe is evaluated with. With F = 1 both return all that is lost, so that a
//! white furnace closes.

use alloc::boxed::Box;
use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::broad::{Broad, cosine_pdf};
use super::grazing::Grazing;
use super::reflectance::ConductorFresnel;
use crate::albedo::{Albedo, AlbedoAt, DirectionalAlbedo};
use crate::material::Part;
use crate::vector::vec3;

/// How a BSDF returns the light that one bounce loses to further ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Compensation {
    /// Single scattering only.
    #[default]
    None,
    /// A factor on the lobe (Turquin 2019). Cheap and of the lobe's shape, but not reciprocal.
    Turquin,
    /// An additional broad lobe (Kulla & Conty 2017). Reciprocal, and exact for white surfaces.
    KullaConty,
}

/// The most that Turquin's factor adds to 1: a bound where E is 0 (γ near 3/2 at large σ).
const MOST: f32 = 1e6;

/// Turquin's factor 1 + F0 (1 − E)/E, from the loss 1 − E.
#[inline(always)]
pub(super) fn turquin(lost: f32, f0: f32) -> f32 {
    1.0 + (f0 * lost / (1.0 - lost).max(1.0 / MOST)).min(MOST)
}

/// π times the lobe of Kulla & Conty, from the losses at view and light and their average.
#[inline(always)]
pub(super) fn kulla_conty(lost_v: f32, lost_l: f32, average: f32) -> f32 {
    // σ = 0 loses nothing, and the quotient would be 0/0.
    if average > f32::MIN_POSITIVE { lost_v * lost_l / average } else { 0.0 }
}

/// The factor of the lobe of Kulla & Conty for one channel, F_avg² E_avg/(1 − F_avg(1 − E_avg)).
#[inline(always)]
fn multiple_bounces(fresnel_average: f32, lost_average: f32) -> f32 {
    let below = 1.0 - fresnel_average * lost_average;
    // F_avg = 1 and E_avg = 0: infinitely many bounces that lose nothing.
    if below > 0.0 { fresnel_average * fresnel_average * (1.0 - lost_average) / below } else { 1.0 }
}

/// A compensation by the albedo A.
#[derive(Clone, Debug)]
pub(super) struct Returned<const N: usize, A> {
    albedo: A,
    form: Form<N>,
}

#[derive(Clone, Debug)]
enum Form<const N: usize> {
    /// By the reflectance at normal incidence.
    Turquin { f0: [f32; N] },
    /// By the average loss, the factors of [`multiple_bounces`], their mean over the channels
    /// (`multiple`), and that of the average reflectance (`single`).
    KullaConty { average: f32, bounces: [f32; N], multiple: f32, single: f32, density: Density },
}

/// The density from which the broad lobe is drawn.
#[derive(Clone, Debug)]
pub(super) enum Density {
    /// Made for the albedo.
    Bands(Box<Broad>),
    /// In closed form, for an albedo at one hit.
    Grazing(Grazing),
}

impl Density {
    pub(super) fn of_albedo(albedo: &Albedo) -> Self {
        Self::Bands(Box::new(Broad::new(|l| albedo.lost(l))))
    }

    pub(super) fn at(albedo: &AlbedoAt<'_>) -> Self {
        Self::Grazing(Grazing::new(albedo.reach()))
    }
}

impl<const N: usize, A: DirectionalAlbedo> Returned<N, A> {
    /// `None` without compensation.
    pub(super) fn new(
        albedo: A,
        compensation: Compensation,
        fresnel: &ConductorFresnel<N>,
        density: fn(&A) -> Density,
    ) -> Option<Self> {
        let mean = |all: &[f32; N]| all.iter().sum::<f32>() / N as f32;
        let form = match compensation {
            Compensation::None => return None,
            Compensation::Turquin => Form::Turquin { f0: fresnel.at(1.0) },
            Compensation::KullaConty => {
                let (average, reflected) = (albedo.lost_average(), fresnel.average());
                let bounces = reflected.map(|reflected| multiple_bounces(reflected, average));
                let (multiple, single) = (mean(&bounces), mean(&reflected));
                let density = density(&albedo);
                Form::KullaConty { average, bounces, multiple, single, density }
            }
        };
        Some(Self { albedo, form })
    }

    /// The share of a view's light that one bounce loses, 1 − E(v).
    #[inline]
    pub(super) fn lost(&self, v: Vec3) -> f32 {
        self.albedo.lost(v.to_array())
    }

    #[inline]
    pub(super) fn factor(&self, lost: f32) -> [f32; N] {
        match &self.form {
            Form::Turquin { f0 } => f0.map(|f0| turquin(lost, f0)),
            Form::KullaConty { .. } => [1.0; N],
        }
    }

    /// The probability of facets: their share of the light that returns, as an estimate.
    #[inline]
    pub(super) fn facets(&self, lost: f32) -> f32 {
        match &self.form {
            Form::Turquin { .. } => 1.0,
            Form::KullaConty { multiple, single, .. } => estimate(lost, *single, *multiple),
        }
    }

    /// The broad lobe at a light.
    #[inline]
    pub(super) fn part(&self, lost: f32, l: Vec3) -> Part<N> {
        let Form::KullaConty { average, bounces, density, .. } = &self.form else {
            return Part::NONE;
        };
        let lobe = kulla_conty(lost, self.lost(l), *average);
        let factor = match density {
            Density::Bands(broad) => broad.factor(l),
            Density::Grazing(grazing) => grazing.factor(l),
        };
        Part::broad(l, factor, 1.0, bounces.map(|factor| factor * lobe))
    }

    /// A light of the broad lobe, or of the cosine where there is none; `None` on the horizon.
    #[inline]
    pub(super) fn sample_above(&self, u: [f32; 2]) -> Option<Vec3> {
        let l = match &self.form {
            Form::Turquin { .. } => Broad::COSINE.sample(u),
            Form::KullaConty { density: Density::Bands(broad), .. } => broad.sample(u),
            Form::KullaConty { density: Density::Grazing(grazing), .. } => grazing.sample(u),
        };
        Some(l).filter(|l| l.z > 0.0)
    }
}

/// The share of facets in the light that returns, from the means of their reflectance and of the
/// factor of further bounces.
#[inline(always)]
fn estimate(lost: f32, single: f32, multiple: f32) -> f32 {
    let (facets, broad) = ((1.0 - lost) * single, lost * multiple);
    if broad > 0.0 { facets / (facets + broad) } else { 1.0 }
}

/// The compensations of a BSDF of your own, alike for each form of the albedo.
macro_rules! compensations {
    ($($albedo:ty),*) => {$(
        impl $albedo {
            /// Compensating factor on the single-scattering lobe, 1 + F0 (1 − E(v))/E(v), for a
            /// view and one channel of the reflectance F0 at normal incidence.
            ///
            /// Turquin 2019, *Practical multiple scattering compensation for microfacet models*,
            /// eq. 16, <https://blog.selfshadow.com/publications/turquin/ms_comp_final.pdf>. Cheap,
            /// and keeps the lobe's shape; not reciprocal. Where E is 0 (γ near 3/2 at large σ) the
            /// factor is limited to 1e6.
            #[inline]
            #[must_use]
            pub fn turquin(&self, v: impl Into<[f32; 3]>, f0: f32) -> f32 {
                turquin(self.lost(v), f0)
            }

            /// The lobe of all bounces after the first with F = 1, (1 − E(v))(1 − E(l))/(π(1 −
            /// E_avg)) per steradian.
            ///
            /// A BRDF without the cosine; reciprocal; 0 where v or l is at or below the horizon.
            /// Multiply by [`multiple_bounces`](Self::multiple_bounces) for coloured surfaces.
            /// Kulla & Conty 2017, *Revisiting physically based shading at Imageworks*, slide
            /// "energy compensation"; after Kelemen & Szirmay-Kalos 2001, eq. 11,
            /// <https://doi.org/10.2312/egs.20011003>.
            #[inline]
            #[must_use]
            pub fn compensation(&self, v: impl Into<[f32; 3]>, l: impl Into<[f32; 3]>) -> f32 {
                let (v, l) = (vec3(v), vec3(l));
                if !(v.z > 0.0 && l.z > 0.0) {
                    return 0.0;
                }
                self.compensation_from(self.lost(v), self.lost(l))
            }

            /// [`compensation`](Self::compensation) from the losses 1 − E of view and light, for
            /// those that look up the loss of a view once.
            #[inline]
            #[must_use]
            pub fn compensation_from(&self, lost_v: f32, lost_l: f32) -> f32 {
                kulla_conty(lost_v, lost_l, self.lost_average()) * FRAC_1_PI
            }

            /// Draws a light for [`compensation`](Self::compensation) from two numbers in [0, 1]
            /// (clamped to them, NaN to 0): cosine-weighted, which is close to the lobe of rough
            /// surfaces. Smooth surfaces lose their light at grazing, where weights become large.
            #[inline]
            #[must_use]
            pub fn sample_compensation(&self, u: [f32; 2]) -> [f32; 3] {
                Broad::COSINE.sample(u).to_array()
            }

            /// Density of [`sample_compensation`](Self::sample_compensation), cos θ_l/π per
            /// steradian; 0 below the horizon.
            #[inline]
            #[must_use]
            pub fn compensation_pdf(&self, l: impl Into<[f32; 3]>) -> f32 {
                let l = vec3(l);
                if l.z > 0.0 { cosine_pdf(l) } else { 0.0 }
            }

            /// The factor of [`compensation`](Self::compensation) for one channel of average
            /// reflectance F_avg, F_avg² E_avg/(1 − F_avg(1 − E_avg)) ∈ [0, 1].
            ///
            /// Kulla & Conty 2017, with the square that counts the first bounce (Hill 2018, *A
            /// multi-faceted exploration, part 2*).
            #[inline]
            #[must_use]
            pub fn multiple_bounces(&self, fresnel_average: f32) -> f32 {
                multiple_bounces(fresnel_average, self.lost_average())
            }
        }
    )*};
}

compensations!(Albedo, AlbedoAt<'_>);
