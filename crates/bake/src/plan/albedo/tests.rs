//! Compares plans with those of an exhaustive comparison of all materials.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::*;
use crate::plan::part::parts;
use crate::scene::Scene;

/// The required albedos by comparison of all with all.
fn by_comparison(
    lobes: &[Part<'_>],
    options: Options,
) -> Result<(Vec<RequiredAlbedo>, Vec<AlbedoVerdict>), NotCovered> {
    let wants: Vec<Result<Vec<Want>, AlbedoVerdict>> =
        lobes.iter().map(|part| wants(part, options)).collect::<Result<_, _>>()?;
    let all: Vec<&Want> = wants.iter().flatten().flatten().collect();
    let mut reflectances: Vec<Reflectance> = Vec::new();
    for want in &all {
        if !reflectances.contains(&want.reflectance) {
            reflectances.push(want.reflectance);
        }
    }
    reflectances.sort_by_key(|reflectance| *reflectance != Reflectance::Mirror);
    let mut needs: Vec<RequiredAlbedo> = Vec::new();
    for reflectance in reflectances {
        for masking in Masking::ALL {
            let same = |want: &&&Want| want.reflectance == reflectance && want.masking == masking;
            let lobes: Vec<&AlbedoLobe> = all.iter().filter(same).map(|want| &want.lobe).collect();
            let (round, own): (Vec<_>, Vec<_>) =
                lobes.into_iter().partition(|lobe| lobe.is_family());
            let round = joined_by_comparison(round.into_iter().cloned().collect());
            for lobe in round.into_iter().chain(own.into_iter().cloned()) {
                let same = |need: &&mut RequiredAlbedo| {
                    need.lobe == lobe && need.reflectance == reflectance
                };
                match needs.iter_mut().find(same) {
                    Some(need) if need.maskings.contains(&masking) => {}
                    Some(need) => need.maskings.push(masking),
                    None => {
                        let maskings = vec![masking];
                        needs.push(RequiredAlbedo { lobe, reflectance, maskings, coarse: false });
                    }
                }
            }
        }
    }
    let covers = |need: &RequiredAlbedo, want: &Want| {
        need.lobe.contains(&want.lobe)
            && need.reflectance == want.reflectance
            && need.maskings.contains(&want.masking)
    };
    let serving = |want: &Want| needs.iter().position(|need| covers(need, want)).unwrap();
    let verdicts = wants.iter().map(|wants| match wants {
        Ok(wants) => AlbedoVerdict::Bake(wants.iter().map(serving).collect()),
        Err(verdict) => verdict.clone(),
    });
    let verdicts = verdicts.collect();
    Ok((needs, verdicts))
}

/// `joined`, by comparison of all with all.
fn joined_by_comparison(wants: Vec<AlbedoLobe>) -> Vec<AlbedoLobe> {
    let mut groups: Vec<Vec<AlbedoLobe>> = Vec::new();
    for want in wants {
        match groups.iter_mut().find(|group| group[0].gamma == want.gamma) {
            Some(group) if group.contains(&want) => {}
            Some(group) => group.push(want),
            None => groups.push(vec![want]),
        }
    }
    least(groups)
}

/// A recipe of materials with some equal and some different values.
fn recipe(rng: &mut StdRng, materials: usize) -> String {
    let mut pick = |all: &[&str]| all[rng.random_range(0..all.len())].to_owned();
    let numbers: Vec<String> = (2..40).map(|i| format!("0.{i:02}")).collect();
    let numbers: Vec<&str> = numbers.iter().map(String::as_str).collect();
    let mut text = String::new();
    for i in 0..materials {
        text += &format!("[[material]]\nname = \"{i}\"\n");
        let (number, gamma) = (pick(&numbers), pick(&["1.6", "2", "3", "4.5", "7", "\"inf\""]));
        let sigma = match &pick(&["one", "one", "range", "two", "tilted", "other"])[..] {
            "one" => number.clone(),
            "range" => format!("{{ min = {number}, max = 0.{} }}", pick(&["4", "5"])),
            "two" => format!("[{number}, {}]", pick(&["0.1", "0.2"])),
            "tilted" => format!("[{number}, 0.2]\ntheta = [{}, -0.0, 0.5]", pick(&["0", "0.1"])),
            _ => String::new(),
        };
        text += &if sigma.is_empty() {
            let own = pick(&["gauss\"\nm = 0.2", "gauss\"\nm = 0.3", "schlick\"\nm = 0.2"]);
            format!("distribution = \"{own}\n")
        } else {
            format!("sigma = {sigma}\ngamma = {gamma}\n")
        };
        text += &pick(&[
            "",
            "fresnel = \"mirror\"\n",
            "fresnel = \"mirror\"\n",
            "fresnel = { metal = \"gold\" }\n",
            "fresnel = { metal = \"silver\" }\n",
            "fresnel = { dielectric = 1.5 }\n",
            "fresnel = { dielectric = { min = 1.3, max = 1.6 } }\n",
        ]);
        text += &pick(&["", "masking = \"uncorrelated\"\n"]);
        let haze = "haze = { weight = 0.3, ";
        text += &match &pick(&["", "", "round", "two"])[..] {
            "round" => format!("{haze}sigma = {number}, gamma = {gamma} }}\n"),
            "two" => format!("{haze}sigma = [0.4, 0.7], gamma = 3 }}\n"),
            _ => String::new(),
        };
    }
    text
}

#[test]
fn what_is_planned_is_what_a_comparison_of_all_finds() {
    let mut rng = StdRng::seed_from_u64(1);
    let mut groups = 0;
    for round in 0..60 {
        let recipe = recipe(&mut rng, 1 + 3 * round);
        let scene = Scene::from_recipe_str(&recipe).unwrap_or_else(|why| panic!("{why}\n{recipe}"));
        for albedo in [AlbedoWish::Auto, AlbedoWish::All] {
            let options = Options { albedo, embedded_albedo: round % 3 == 0, ..Options::default() };
            let lobes = parts(&scene);
            let planned = wanted(&lobes, options).unwrap();
            assert_eq!(planned, by_comparison(&lobes, options).unwrap(), "{recipe}");
            groups = groups.max(planned.0.len());
        }
    }
    assert!(groups > 100, "{groups}");
}

/// A set of a scene carries the tables that its materials ask for, glass or not, and none of those
/// that the default set has for renderers that bake nothing.
#[test]
fn no_scene_has_the_tables_of_common_glass() {
    let glass =
        "[[material]]\nname = \"a\"\nsigma = 0.3\ngamma = 3\nfresnel = { dielectric = 1.5 }\n";
    for (recipe, sides) in [(glass, 2), (&glass.replace("{ dielectric = 1.5 }", "\"mirror\""), 0)] {
        let scene = Scene::from_recipe_str(recipe).unwrap();
        for embedded_albedo in [false, true] {
            let options = Options { embedded_albedo, ..Options::default() };
            let (planned, _) = wanted(&parts(&scene), options).unwrap();
            let of_glass = planned.iter().filter(|need| need.reflectance.side().is_some());
            assert_eq!(of_glass.count(), sides, "{recipe}");
            assert!(planned.iter().all(|need| !need.coarse));
        }
    }
    let all =
        RequiredAlbedo::common_glass().map(|need| need.spec(Quality::Default, Precision::F32));
    assert!(all.into_iter().all(|spec| spec.unwrap().precision == Precision::U16));
}
