//! White furnaces: materials that are white, or lose a known share of the light, in front of white.

use std::error::Error;
use std::f32::consts::PI;

use microfacet_baker::plan::{Options, Plan};
use microfacet_baker::scene::Scene as Materials;
use microfacet_baker::table_set::{Settings, Target, bake_with};
use microfacet_baker::table_spec::Quality;
use microfacet_sampler::{
    AnyBsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Dielectric, Masking, StandIn,
    Tables,
};
use microfacet_tables::Precision;

use super::{Film, Limit, REACH, pixel};
use crate::spheres::scene::{Floor, GREY, Scene};
use crate::spheres::sky::Sky;

/// The mean radiance of a sphere in a white furnace of radiance 1: by sampling the BSDF alone and,
/// from a lamp, by next-event estimation too. Its standard error is below 4e-3.
fn furnaces(material: &AnyBsdf) -> [f32; 2] {
    const CELL: usize = 40;
    let film = Film { cell: CELL, limit: Limit { samples: 64, noise: 0.0 }, is_linear: true };
    [Sky::white(), Sky::white_lamp()].map(|sky| {
        let scene = Scene { material: material.clone(), floor: None, sky };
        let each = (0..CELL * CELL).map(|i| pixel(&scene, [i % CELL, i / CELL], film).x);
        let covered = PI / (2.0 * REACH * 2.0 * REACH);
        (each.sum::<f32>() / (CELL * CELL) as f32 - (1.0 - covered)) / covered
    })
}

/// A parallel camera sees the disc of a sphere evenly, so that the mean over the disc is the
/// cosine-weighted average of the albedo.
#[test]
fn white_metal_shows_its_average_albedo() -> Result<(), Box<dyn Error>> {
    let (tables, masking) = (Tables::embedded(), Masking::Uncorrelated);
    let settings = BsdfSettings::new().with_masking(masking);
    for (sigma, gamma) in [(0.3, 1.51), (0.1, 1.65), (0.3, 2.0), (1.0, 50.0)] {
        let lobe = tables.lobe(sigma, gamma)?;
        let metal = Conductor::new(lobe, ConductorFresnel::mirror(), settings)?;
        let average = tables.albedo(sigma, gamma, masking)?.albedo_average();
        for shown in furnaces(&metal.into()) {
            assert!((shown - average).abs() < 0.012, "{sigma} {gamma}: {shown} for {average}");
        }
    }
    Ok(())
}

#[test]
fn smooth_diamond_shows_all_light() -> Result<(), Box<dyn Error>> {
    let lobe = Tables::embedded().lobe(0.0, 2.0)?;
    let diamond = Dielectric::new(lobe, 2.42, BsdfSettings::new())?;
    for shown in furnaces(&diamond.into()) {
        assert!((shown - 1.0).abs() < 1e-3, "{shown}");
    }
    Ok(())
}

/// Weights above 1 multiply inside the diamond, so that paths split.
#[test]
fn rough_diamond_shows_all_light_where_it_is_given_back() -> Result<(), Box<dyn Error>> {
    let recipe = "[[material]]\nname = \"diamond\"\nsigma = 0.3\ngamma = 2.0\n\
                  fresnel = { dielectric = 2.42 }\n";
    let options = Options { embedded: true, ..Options::default() };
    let plan = Plan::new(&Materials::from_recipe_str(recipe)?, options)?;
    let target = Target::Quality(Quality::Draft, Precision::F32);
    let baked = bake_with(&plan, target, Settings::default())?.set;
    let tables = baked.with_fallback(&Tables::embedded());
    let diamond = tables.bsdf("diamond", Compensation::KullaConty, StandIn::Refused)?;
    for shown in furnaces(&diamond) {
        assert!((shown - 1.0).abs() < 0.02, "{shown}");
    }
    Ok(())
}

/// Directions to a lamp may round to just outside of its rim, where its density is 0, and so may
/// be that of the BSDF: light from there was infinite.
#[test]
fn a_small_lamp_gives_finite_light() -> Result<(), Box<dyn Error>> {
    const CELL: usize = 120;
    let lobe = Tables::embedded().lobe(0.1, f64::INFINITY)?;
    let metal = Conductor::new(lobe, ConductorFresnel::mirror(), BsdfSettings::new())?;
    let material: AnyBsdf = metal.into();
    let scene = Scene { material, floor: Some(Floor::new(GREY)?), sky: Sky::one_lamp() };
    let film = Film { cell: CELL, limit: Limit { samples: 256, noise: 0.0 }, is_linear: true };
    for i in 0..CELL * CELL {
        let radiance = pixel(&scene, [i % CELL, i / CELL], film);
        assert!(radiance.is_finite(), "pixel {i}: {radiance}");
    }
    Ok(())
}
