//! Any of the BSDFs, and the BSDF of a recipe's material by name.

use alloc::boxed::Box;

use microfacet_tables::Reflectance;

use super::bind::StandIn;
use super::compensation::Compensation;
use super::settings::BsdfSettings;
use super::{
    Bsdf, BsdfSample, Conductor, ConductorFresnel, Dielectric, Haze, Plastic, Retroreflective,
    Transport,
};
use crate::bind_error::BindError;
use crate::material::Lobe;
use crate::tables::{Tables, middle};

/// Any of the BSDFs in three channels, of any lobe: what a renderer keeps for each material of a
/// scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[allow(clippy::large_enum_variant, reason = "in a box each call would begin with a load")]
pub enum AnyBsdf {
    /// A conductor.
    Conductor(Conductor<Lobe>),
    /// A dielectric.
    Dielectric(Dielectric<Lobe>),
    /// A dielectric coat over a diffuse base.
    Plastic(Plastic<Lobe>),
    /// A core with haze around it.
    Haze(Box<Haze<AnyBsdf>>),
    /// A BSDF that sends a share of the light back.
    Retroreflective(Box<Retroreflective<AnyBsdf>>),
}

macro_rules! from {
    ($($bsdf:ident),*) => {$(
        impl From<$bsdf<Lobe>> for AnyBsdf {
            fn from(bsdf: $bsdf<Lobe>) -> Self {
                Self::$bsdf(bsdf)
            }
        }
    )*};
}

from!(Conductor, Dielectric, Plastic);

impl<A: Into<Self>, B: Into<Self>> From<Haze<A, B>> for AnyBsdf {
    fn from(bsdf: Haze<A, B>) -> Self {
        Self::Haze(Box::new(bsdf.map(A::into, B::into)))
    }
}

impl<B: Into<Self>> From<Retroreflective<B>> for AnyBsdf {
    fn from(bsdf: Retroreflective<B>) -> Self {
        Self::Retroreflective(Box::new(bsdf.map(B::into)))
    }
}

macro_rules! each {
    ($any:ident, $one:ident => $call:expr) => {
        match $any {
            AnyBsdf::Conductor($one) => $call,
            AnyBsdf::Dielectric($one) => $call,
            AnyBsdf::Plastic($one) => $call,
            AnyBsdf::Haze($one) => {
                let $one = &**$one;
                $call
            }
            AnyBsdf::Retroreflective($one) => {
                let $one = &**$one;
                $call
            }
        }
    };
}

/// The code of all BSDFs and lobes, compiled once, for arrays.
impl AnyBsdf {
    fn drawn_with_pdf(
        &self,
        v: [f32; 3],
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample, f32)> {
        each!(self, bsdf => bsdf.sample_with_pdf(v, choice, u, transport))
    }

    fn drawn(
        &self,
        v: [f32; 3],
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample> {
        each!(self, bsdf => bsdf.sample(v, choice, u, transport))
    }

    fn evaluated(&self, v: [f32; 3], l: [f32; 3], transport: Transport) -> ([f32; 3], f32) {
        each!(self, bsdf => bsdf.eval_pdf(v, l, transport))
    }
}

impl Bsdf for AnyBsdf {
    fn sample_with_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<(BsdfSample, f32)> {
        self.drawn_with_pdf(v.into(), choice, u, transport)
    }

    fn sample(
        &self,
        v: impl Into<[f32; 3]>,
        choice: f32,
        u: [f32; 2],
        transport: Transport,
    ) -> Option<BsdfSample> {
        self.drawn(v.into(), choice, u, transport)
    }

    fn eval_pdf(
        &self,
        v: impl Into<[f32; 3]>,
        l: impl Into<[f32; 3]>,
        transport: Transport,
    ) -> ([f32; 3], f32) {
        self.evaluated(v.into(), l.into(), transport)
    }

    fn is_delta(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::is_delta(bsdf))
    }

    fn transmits(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::transmits(bsdf))
    }

    fn is_symmetric(&self) -> bool {
        each!(self, bsdf => Bsdf::<3>::is_symmetric(bsdf))
    }
}

impl Tables {
    /// The BSDF of a named material of the set's recipe: its lobe, reflectance and form of masking,
    /// its haze, and the share of its light that goes back.
    ///
    /// `fresnel = "mirror"`, `schlick`, `conductor` and `metal` make a [`Conductor`], `dielectric`
    /// a [`Dielectric`], never a [`Plastic`], whose base no recipe states. Conductors draw what is
    /// best [for reflection](Lobe::for_reflection). Haze makes a [`Haze`] of two of these, of one
    /// reflectance, masking and compensation, and retroreflection a [`Retroreflective`] of either.
    /// Ranges are taken at their middle, see [`material`](Self::material).
    ///
    /// # Errors
    /// [`BindError::NoFresnel`] for a material that states no reflectance, [`BindError::NoAlbedo`]
    /// or [`BindError::Material`] where a compensation needs albedos that the set does not hold,
    /// [`BindError::NoRetroreflection`] for a dielectric of which a recipe asks for it, and what
    /// [`material`](Self::material) reports.
    pub fn bsdf(
        &self,
        name: &str,
        compensation: Compensation,
        stand_in: StandIn,
    ) -> Result<AnyBsdf, BindError> {
        let (core, haze) = (self.material(name)?, self.material_haze(name)?);
        let entry = self.entry(name)?;
        let settings = BsdfSettings::new()
            .with_masking(entry.masking())
            .compensated(compensation, self)
            .with_stand_in(stand_in);
        let fresnel = entry.fresnel.ok_or_else(|| BindError::NoFresnel(name.into()))?;
        let of = |lobe| of_lobe(lobe, fresnel, settings);
        let whole = match haze {
            None => of(core)?,
            Some((haze, weight)) => Haze::new(of(core)?, of(haze)?, weight)?.into(),
        };
        match entry.is_retroreflecting() {
            false => Ok(whole),
            true => Ok(Retroreflective::new(whole, middle(entry.retroreflection))?.into()),
        }
    }
}

/// The BSDF of a lobe of a recipe's material, by the reflectance of the material.
fn of_lobe(
    lobe: Lobe,
    fresnel: Reflectance,
    settings: BsdfSettings<'_>,
) -> Result<AnyBsdf, BindError> {
    let reflectance = match fresnel {
        Reflectance::Mirror => ConductorFresnel::mirror(),
        Reflectance::Schlick(f0) => ConductorFresnel::schlick(f0.map(|f0| f0 as f32))?,
        Reflectance::Conductor { eta, k } => ConductorFresnel::exact(eta, k)?,
        Reflectance::Dielectric(_) | Reflectance::Interface { .. } => {
            let eta = fresnel.middle_index().unwrap_or(f64::NAN);
            return Ok(Dielectric::new(lobe, eta, settings)?.into());
        }
    };
    Ok(Conductor::new(lobe.for_reflection(), reflectance, settings)?.into())
}
