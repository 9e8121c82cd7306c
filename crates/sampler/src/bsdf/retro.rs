//! Retroreflection: a share of the light goes back to where it came from.

use microfacet_core::math::unit;

use super::haze::share;
use super::pair::{Pair, by_pair};
use super::{Bsdf, BsdfSample, Transport};
use crate::bind_error::BindError;

/// A BSDF of which a share r of the light goes back to where it came from:
///
/// ```text
/// f = (1 − r) f(v, l) + r f(Rv, l),    Rv = (−v.x, −v.y, v.z)
/// ```
///
/// so that the lobe about the mirror direction stands about the view instead. That is the minimal
/// retroreflective microfacet model of Portsmouth, Raab, Belcour & Liu 2026
/// (<http://jcgt.org/published/0015/01/04/>): reflect the view, then evaluate the same lobe. r is
/// `specular_retroreflectivity` of OpenPBR 1.2 and `retroreflectionFactor` of glTF's draft
/// `KHR_materials_retroreflection`. The half vector of Rv and l is the *back vector* of Belcour et
/// al. 2014 (<https://hal.science/hal-01083366>).
///
/// The lobe must be [symmetric](Bsdf::is_symmetric) under the half turn R about n, as all upright
/// lobes are, anisotropic ones too. Then f(Rv, l) = f(Rl, v), so that f is reciprocal where that of
/// the BSDF is, and E(Rv) = E(v): albedo, compensation and white furnace are those of the BSDF.
/// Conventions are those of [`Bsdf`]. The share of a mirror that goes back is a delta at l = v.
///
/// ```
/// # #[cfg(feature = "embedded")] {
/// use microfacet_sampler::{Bsdf, BsdfSettings, Conductor, Metal, Retroreflective};
/// use microfacet_sampler::{Tables, Transport};
///
/// let silver = Tables::embedded().student_t(0.1, 2.0)?;
/// let silver: Conductor<_> = Conductor::new(silver, Metal::Silver, BsdfSettings::new())?;
/// let sheet = Retroreflective::new(silver, 0.8)?;
/// let (v, mirrored) = ([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]);
/// let [back, forth] = [v, mirrored].map(|l| sheet.eval(v, l, Transport::Radiance)[0]);
/// assert!((back / forth - 4.0).abs() < 0.02);
/// # }
/// # Ok::<(), microfacet_sampler::BindError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Retroreflective<B> {
    turned: Turned<B>,
    share: f32,
}

impl<B> Retroreflective<B> {
    /// A BSDF of which a share r of the light goes back. For r = 0 it is the BSDF alone, to the
    /// bit.
    ///
    /// # Errors
    /// [`BindError::Share`] unless the share lies in [0, 1]; [`BindError::NoRetroreflection`] for a
    /// BSDF that transmits, or is not [symmetric](Bsdf::is_symmetric).
    pub fn new<const N: usize>(bsdf: B, share: f32) -> Result<Self, BindError>
    where
        B: Bsdf<N>,
    {
        let share = self::share("share", share)?;
        match turns(&bsdf) {
            true => Ok(Self { turned: Turned(bsdf), share }),
            false => Err(BindError::NoRetroreflection { transmits: bsdf.transmits() }),
        }
    }

    /// [`new`](Self::new) at a hit, where the share comes from a texture: it is clamped to [0, 1],
    /// NaN to 0, and is 0 of a BSDF that `new` refuses.
    #[inline(always)]
    #[must_use]
    pub fn at_hit<const N: usize>(bsdf: B, share: f32) -> Self
    where
        B: Bsdf<N>,
    {
        let share = if turns(&bsdf) { unit(share) } else { 0.0 };
        Self { turned: Turned(bsdf), share }
    }

    /// The BSDF.
    #[must_use]
    pub fn bsdf(&self) -> &B {
        &self.turned.0
    }

    /// The share of the light that goes back, in [0, 1].
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share
    }

    /// The same of a BSDF in another form.
    pub(super) fn map<C>(self, bsdf: fn(B) -> C) -> Retroreflective<C> {
        Retroreflective { turned: Turned(bsdf(self.turned.0)), share: self.share }
    }

    #[inline(always)]
    fn pair(&self) -> Pair<'_, B, Turned<B>> {
        Pair { first: &self.turned.0, second: &self.turned, w: self.share }
    }
}

/// Whether light may go back from a BSDF.
#[inline(always)]
fn turns<const N: usize>(bsdf: &impl Bsdf<N>) -> bool {
    !bsdf.transmits() && bsdf.is_symmetric()
}

/// A BSDF for the view after a half turn about n.
#[derive(Clone, Debug)]
struct Turned<B>(B);

#[inline(always)]
fn turned(v: impl Into<[f32; 3]>) -> [f32; 3] {
    let [x, y, z] = v.into();
    [-x, -y, z]
}

impl<const N: usize, B: Bsdf<N>> Bsdf<N> for Turned<B> {
    #[inline]
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample<N>, f32)> {
        self.0.sample_with_pdf(turned(v), choice, u, transport)
    }

    #[inline]
    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample<N>> {
        self.0.sample(turned(v), choice, u, transport)
    }

    #[inline]
    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; N], f32) {
        self.0.eval_pdf(turned(v), l, transport)
    }

    fn is_delta(&self) -> bool {
        self.0.is_delta()
    }

    fn transmits(&self) -> bool {
        self.0.transmits()
    }

    fn is_symmetric(&self) -> bool {
        self.0.is_symmetric()
    }
}

by_pair!(Retroreflective<B>);
