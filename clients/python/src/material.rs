//! Materials of one lobe, or of many: BSDFs that are made for each item.

use std::sync::Arc;

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::lobe::FamilyLobe;
use microfacet_sampler::{
    AnyBsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric, DielectricAt,
    FamilyDielectric, Masking, Plastic,
};
use pyo3::prelude::*;

use crate::distribution::Kind;
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
}

/// Calls a function of BSDFs, an argument as others.
macro_rules! of {
    ($material:expr, $all:ident => $call:expr) => {{
        use microfacet_sampler::{Conductor, Dielectric, Plastic};
        use $crate::lobe::albedo_at;
        use $crate::material::{interface_at, single};
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
