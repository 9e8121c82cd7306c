//! Materials of one lobe, or of many: BSDFs that are made for each item.

use std::sync::Arc;

use microfacet_sampler::albedo::FamilyAlbedo;
use microfacet_sampler::lobe::FamilyLobe;
use microfacet_sampler::{
    AnyBsdf, BsdfSettings, Compensation, ConductorFresnel, Dielectric, DielectricAt,
    FamilyDielectric, Masking,
};
use pyo3::prelude::*;

use crate::lobe::round_sigma;
use crate::set::Set;
use crate::surface::Lobes;
use crate::words::{refused, unbound};

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
    Interface(Arc<Lobes>, Arc<FamilyDielectric>, Compensation),
    Plastic(Arc<Lobes>, Arc<FamilyDielectric>, Compensation, [f32; 3]),
}

/// Calls a function of BSDFs, an argument as others.
macro_rules! of {
    ($material:expr, $all:ident => $call:expr) => {{
        use microfacet_sampler::{Conductor, Dielectric, Plastic};

        use crate::lobe::albedo_at;
        use crate::material::{interface_at, single};
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
        lobes: &Arc<Lobes>,
        set: &Set,
        fresnel: ConductorFresnel,
        masking: Masking,
        compensation: Compensation,
        may_stand_in: bool,
    ) -> PyResult<Self> {
        let returned = match compensation {
            Compensation::None => None,
            _ => Some((lobes.albedo(set, masking, may_stand_in)?, compensation)),
        };
        Ok(Self::Conductor(Arc::clone(lobes), Box::new(fresnel), masking, returned))
    }

    pub(crate) fn dielectric(
        lobes: &Arc<Lobes>,
        set: &Set,
        eta: f64,
        masking: Masking,
        compensation: Compensation,
        may_stand_in: bool,
    ) -> PyResult<Self> {
        if compensation == Compensation::None {
            let probe = Dielectric::new(lobes.lobe([1.0; 2], 2.0), eta, BsdfSettings::new());
            probe.map_err(unbound)?;
            return Ok(Self::Dielectric(Arc::clone(lobes), eta, masking));
        }
        let interface = interface(lobes, set, eta, masking, may_stand_in)?;
        Ok(Self::Interface(Arc::clone(lobes), interface, compensation))
    }

    pub(crate) fn plastic(
        lobes: &Arc<Lobes>,
        set: &Set,
        eta: f64,
        base: [f32; 3],
        masking: Masking,
        compensation: Compensation,
        may_stand_in: bool,
    ) -> PyResult<Self> {
        if base.iter().any(|base| !(0.0..=1.0).contains(base)) {
            return Err(refused(format!("base = {base:?} must lie in [0, 1]")));
        }
        let interface = interface(lobes, set, eta, masking, may_stand_in)?;
        Ok(Self::Plastic(Arc::clone(lobes), interface, compensation, base))
    }
}

/// The albedos of interfaces of an index, where the tables have them for all lobes.
fn interface(
    lobes: &Lobes,
    set: &Set,
    eta: f64,
    masking: Masking,
    may_stand_in: bool,
) -> PyResult<Arc<FamilyDielectric>> {
    if !(may_stand_in || lobes.surface.is_round()) {
        return Err(refused(
            "tables have albedos of round dielectrics alone: stand_in=True takes those of \
             sqrt(sigma_x sigma_y)",
        ));
    }
    set.family_dielectric(eta, masking).map(Arc::new).map_err(unbound)
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
    albedo.at(round_sigma(sigma), gamma as f32)
}
