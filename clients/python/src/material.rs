//! Materials of one lobe, or of many: BSDFs that are made for each item. [`crate::hit`] has those
//! that materials are made of.

use std::sync::Arc;

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::lobe::FamilyLobe;
use microfacet_sampler::{
    AnyBsdf, BindError, Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric,
    DielectricAt, FamilyDielectric, Haze, Masking, Plastic, Retroreflective,
};
use pyo3::prelude::*;

use crate::arrays::Kept;
use crate::broadcast::{Argument, One, broadcast};
use crate::distribution::Kind;
use crate::hit::{Hit, HitChunks};
use crate::lobe::PyLobe;
use crate::surface::{Lobes, round_sigma};
use crate::words::{Form, refused, unbound};

/// A material.
pub(crate) enum Material {
    One(Box<AnyBsdf>),
    Conductor(
        Arc<Lobes>,
        Box<ConductorFresnel>,
        Masking,
        Option<(Arc<FamilyAlbedo>, Compensation)>,
    ),
    Dielectric(Arc<Lobes>, f64, Masking),
    Interface(Arc<Lobes>, Box<FamilyDielectric>, Compensation),
    Plastic(Arc<Lobes>, Box<FamilyDielectric>, Compensation, [f32; 3]),
    /// A core, a haze and its weight, of which one or all are of arrays.
    Haze(Arc<Material>, Arc<Material>, Arc<Kept<f64, 1>>),
    /// What sends light back, and its share.
    Retroreflective(Arc<Material>, Arc<Kept<f64, 1>>),
}

/// Calls a function of BSDFs, an argument as others.
macro_rules! of {
    ($material:expr, $all:ident => $call:expr) => {{
        use microfacet_sampler::{Conductor, Dielectric, Plastic};
        use $crate::broadcast::Made;
        use $crate::lobe::albedo_at;
        use $crate::material::{Hits, hazy, interface_at, sent_back, single};
        match $material {
            Material::One(bsdf) => {
                let $all = One(&**bsdf);
                $call
            }
            Material::Conductor(lobes, fresnel, masking, returned) => {
                let $all = lobes.surface.at(|sigma, gamma| {
                    let lobe = lobes.lobe(sigma, gamma);
                    let single = Conductor::at_hit(lobe, **fresnel, *masking);
                    match returned {
                        None => single,
                        Some((albedo, compensation)) => {
                            single.compensated_at(albedo_at(albedo, sigma, gamma), *compensation)
                        }
                    }
                });
                $call
            }
            Material::Dielectric(lobes, eta, masking) => {
                let $all = lobes
                    .surface
                    .at(|sigma, gamma| single(lobes.lobe(sigma, gamma), *eta, *masking));
                $call
            }
            Material::Interface(lobes, albedo, compensation) => {
                let $all = lobes.surface.at(|sigma, gamma| {
                    let at = interface_at(albedo, sigma, gamma);
                    Dielectric::at_hit(lobes.lobe(sigma, gamma), at, *compensation)
                });
                $call
            }
            Material::Plastic(lobes, albedo, compensation, base) => {
                let $all = lobes.surface.at(|sigma, gamma| {
                    let at = interface_at(albedo, sigma, gamma);
                    Plastic::at_hit(lobes.lobe(sigma, gamma), at, *base, *compensation)
                });
                $call
            }
            Material::Haze(core, haze, weight) => {
                let $all = Made((Hits(core), Hits(haze), &**weight), hazy);
                $call
            }
            Material::Retroreflective(bsdf, share) => {
                let $all = Made((Hits(bsdf), &**share), sent_back);
                $call
            }
        }
    }};
}

pub(crate) use of;

impl Material {
    pub(crate) fn of(bsdf: impl Into<AnyBsdf>) -> Self {
        Self::One(Box::new(bsdf.into()))
    }

    pub(crate) fn conductor(
        lobe: &PyLobe,
        fresnel: ConductorFresnel,
        form: &Form,
    ) -> PyResult<Self> {
        let Kind::Family(lobes) = &lobe.kind else {
            let bsdf = Conductor::new(lobe.one()?.clone(), fresnel, form.settings(&lobe.set));
            return bsdf.map(Self::of).map_err(unbound);
        };
        let returned = match form.compensation {
            Compensation::None => None,
            compensation => {
                Some((lobes.albedo(&lobe.set, form.masking, form.may_stand_in)?, compensation))
            }
        };
        Ok(Self::Conductor(Arc::clone(lobes), Box::new(fresnel), form.masking, returned))
    }

    pub(crate) fn dielectric(lobe: &PyLobe, eta: f64, form: &Form) -> PyResult<Self> {
        let Kind::Family(lobes) = &lobe.kind else {
            let bsdf = Dielectric::new(lobe.one()?.clone(), eta, form.settings(&lobe.set));
            return bsdf.map(Self::of).map_err(unbound);
        };
        if form.compensation == Compensation::None {
            // Of any lobe, since it is the index that may be refused.
            let any = lobes.lobe([1.0; 2], 2.0);
            Dielectric::new(any, eta, BsdfSettings::new()).map_err(unbound)?;
            return Ok(Self::Dielectric(Arc::clone(lobes), eta, form.masking));
        }
        let interface = Box::new(lobes.interface(&lobe.set, eta, form)?);
        Ok(Self::Interface(Arc::clone(lobes), interface, form.compensation))
    }

    pub(crate) fn plastic(lobe: &PyLobe, eta: f64, base: [f32; 3], form: &Form) -> PyResult<Self> {
        let Kind::Family(lobes) = &lobe.kind else {
            let bsdf = Plastic::new(lobe.one()?.clone(), eta, base, form.settings(&lobe.set));
            return bsdf.map(Self::of).map_err(unbound);
        };
        // What is made at a hit is clamped.
        if base.iter().any(|base| !(0.0..=1.0).contains(base)) {
            return Err(refused(format!("base = {base:?} must lie in [0, 1]")));
        }
        let interface = Box::new(lobes.interface(&lobe.set, eta, form)?);
        Ok(Self::Plastic(Arc::clone(lobes), interface, form.compensation, base))
    }

    pub(crate) fn haze(
        core: &Arc<Self>,
        haze: &Arc<Self>,
        weight: &Arc<Kept<f64, 1>>,
    ) -> PyResult<Self> {
        if let (Self::One(core), Self::One(haze), Some(weight)) = (&**core, &**haze, weight.one()) {
            let bsdf = Haze::new(AnyBsdf::clone(core), AnyBsdf::clone(haze), weight as f32);
            return bsdf.map(Self::of).map_err(unbound);
        }
        broadcast(&(Hits(core), Hits(haze), &**weight))?;
        Ok(Self::Haze(Arc::clone(core), Arc::clone(haze), Arc::clone(weight)))
    }

    pub(crate) fn retroreflective(bsdf: &Arc<Self>, share: &Arc<Kept<f64, 1>>) -> PyResult<Self> {
        // What is made at a hit would keep its light.
        if let Some(transmits) = bsdf.sends_none_back() {
            return Err(unbound(BindError::NoRetroreflection { transmits }));
        }
        if let (Self::One(bsdf), Some(share)) = (&**bsdf, share.one()) {
            let bsdf = Retroreflective::new(AnyBsdf::clone(bsdf), share as f32);
            return bsdf.map(Self::of).map_err(unbound);
        }
        broadcast(&(Hits(bsdf), &**share))?;
        Ok(Self::Retroreflective(Arc::clone(bsdf), Arc::clone(share)))
    }

    /// Whether it transmits light, of a material that cannot send light back; else its lobe is
    /// tilted.
    fn sends_none_back(&self) -> Option<bool> {
        match self {
            Self::One(bsdf) => {
                let transmits = bsdf.transmits();
                (transmits || !bsdf.is_symmetric()).then_some(transmits)
            }
            Self::Dielectric(..) | Self::Interface(..) => Some(true),
            // Lobes of arrays are upright.
            Self::Conductor(..) | Self::Plastic(..) | Self::Retroreflective(..) => None,
            Self::Haze(core, haze, _) => core.sends_none_back().or_else(|| haze.sends_none_back()),
        }
    }
}

/// A core, a haze and its weight at one hit.
pub(crate) fn hazy<'a>((core, haze, [weight]): (Hit<'a>, Hit<'a>, [f64; 1])) -> Haze<Hit<'a>> {
    Haze::at_hit(core, haze, weight as f32)
}

/// What sends a share of the light back at one hit.
pub(crate) fn sent_back<'a>((bsdf, [share]): (Hit<'a>, [f64; 1])) -> Retroreflective<Hit<'a>> {
    Retroreflective::at_hit(bsdf, share as f32)
}

/// A material as an argument whose items are of one type, whatever it is made of.
#[derive(Clone, Copy)]
pub(crate) struct Hits<'a>(pub(crate) &'a Material);

impl<'a> Argument for Hits<'a> {
    type Chunks = HitChunks<'a>;

    fn shapes(&self, all: &mut Vec<(&'static str, Vec<usize>)>) {
        of!(self.0, hits => hits.shapes(all));
    }

    fn chunks(&self, batch: &[usize]) -> HitChunks<'a> {
        of!(self.0, hits => HitChunks::of(hits.chunks(batch)))
    }
}

/// A dielectric of one bounce, of an index that was checked.
pub(crate) fn single(
    lobe: FamilyLobe<'_>,
    eta: f64,
    masking: Masking,
) -> Dielectric<FamilyLobe<'_>> {
    let settings = BsdfSettings::new().with_masking(masking);
    Dielectric::new(lobe, eta, settings).expect("the index was checked")
}

/// The albedos of an interface at one roughness and shape.
pub(crate) fn interface_at(
    albedo: &FamilyDielectric,
    sigma: [f64; 2],
    gamma: f64,
) -> DielectricAt<'_> {
    albedo.at(round_sigma(sigma) as f32, gamma as f32)
}
