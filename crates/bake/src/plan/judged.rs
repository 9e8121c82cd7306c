//! What a plan decides on each lobe of a scene.

use std::borrow::Cow;

use super::{AlbedoVerdict, Plan, Verdict};
use crate::scene::{Material, Scene};

/// What a plan decides on one lobe of a material.
#[derive(Clone, Debug)]
pub struct Judged<'a> {
    /// The material.
    pub material: &'a Material,
    /// The material with this lobe alone.
    pub part: Cow<'a, Material>,
    /// Whether it is the haze of the material.
    pub is_haze: bool,
    /// On its masking and visible normals.
    pub verdict: &'a Verdict,
    /// On its albedo.
    pub albedo: &'a AlbedoVerdict,
}

impl Plan {
    /// What this plan of a scene decides on each lobe, in the order of its materials; of each the
    /// core, then the haze.
    pub fn judged<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = Judged<'a>> {
        let parts = scene.materials.iter().flat_map(|material| {
            material.parts().enumerate().map(move |(i, part)| (material, part, i > 0))
        });
        let verdicts = self.verdicts.iter().zip(&self.albedo_verdicts);
        parts.zip(verdicts).map(|((material, part, is_haze), (verdict, albedo))| Judged {
            material,
            part,
            is_haze,
            verdict,
            albedo,
        })
    }
}

#[cfg(test)]
mod tests {
    use microfacet_tables::{Interval, Reflectance};

    use super::*;
    use crate::distribution::Distribution;
    use crate::plan::{NotCovered, Options, RequiredAlbedo, RequiredShapes, StandIn};

    fn scene(materials: &str) -> Scene {
        Scene::from_recipe_str(materials).unwrap()
    }

    fn plan(scene: &Scene) -> Plan {
        Plan::new(scene, Options::default()).unwrap()
    }

    const HAZY: &str = "[[material]]\nname = \"a\"\nsigma = 0.1\ngamma = 2.5\n\
        haze = { weight = 0.3, sigma = [0.5, 0.25], gamma = 4 }\nfresnel = \"mirror\"\n";

    #[test]
    fn both_lobes_of_a_material_are_covered() {
        let scene = scene(HAZY);
        let plan = plan(&scene);
        let gammas: Vec<Interval> = plan.shapes.iter().map(RequiredShapes::gamma).collect();
        assert_eq!(gammas, [4.0, 2.5].map(Interval::point));
        assert_eq!(plan.verdicts, [Verdict::Bake(1), Verdict::Bake(0)]);
        // Each lobe has its E.
        let lobes: Vec<_> = plan.albedos.iter().map(|need| need.lobe.sigmas()).collect();
        let [core, haze] = [[0.1, 0.1], [0.5, 0.25]].map(|sigma| sigma.map(Interval::point));
        assert_eq!(lobes, [core, haze]);
        assert!(plan.albedos.iter().all(|need| need.reflectance == Reflectance::Mirror));
        let bake = |i| AlbedoVerdict::Bake(vec![i]);
        assert_eq!(plan.albedo_verdicts, [bake(0), bake(1)]);
        let judged: Vec<_> = plan.judged(&scene).collect();
        let [core, haze] = &judged[..] else { panic!("{judged:?}") };
        assert_eq!((core.is_haze, haze.is_haze), (false, true));
        assert_eq!(core.part.lobe, scene.materials[0].lobe);
        assert_eq!(haze.part.lobe, scene.materials[0].haze.as_ref().unwrap().lobe);
        // One entry, with all that the recipe says.
        assert_eq!(plan.materials, [scene.materials[0].entry()]);
        assert_eq!(plan.provenance().materials, plan.materials);
    }

    #[test]
    fn a_plan_without_the_haze_would_have_less() {
        let with = scene(HAZY);
        let mut without = with.clone();
        without.materials[0].haze = None;
        let [with, without] = [with, without].map(|scene| plan(&scene));
        let needs = |plan: &Plan| (plan.shapes.len(), plan.albedos.len(), plan.verdicts.len());
        assert_eq!((needs(&with), needs(&without)), ((2, 2, 2), (1, 1, 1)));
    }

    #[test]
    fn the_lobes_of_a_material_may_share_tables_and_stand_ins() {
        let glasses = "{ dielectric = { min = 1.4, max = 1.6 } }";
        let text = HAZY.replace(", gamma = 4", "").replace("\"mirror\"", glasses);
        let hazy = scene(&text);
        let shared = plan(&hazy);
        assert_eq!(shared.verdicts[0], Verdict::Bake(0));
        assert_eq!(shared.verdicts[1], Verdict::Same { need: 0, as_material: 0 });
        // The round lobe stands in for the elongated haze of a range of glasses.
        let stand_ins: Vec<bool> =
            shared.judged(&hazy).map(|judged| StandIn::of(&judged.part).is_some()).collect();
        assert_eq!(stand_ins, [false, true]);
        let sigmas = |need: &RequiredAlbedo| need.lobe.roughness.x();
        let glass = shared.albedos.iter().filter(|need| need.reflectance.side().is_some());
        let round = Interval::point((0.5_f64 * 0.25).sqrt());
        assert!(glass.clone().any(|need| sigmas(need).contains(0.1)));
        assert!(glass.clone().any(|need| sigmas(need).contains(round.min)));
    }

    #[test]
    fn a_haze_of_another_distribution_or_without_facets_is_planned_as_such() {
        let other =
            HAZY.replace("sigma = [0.5, 0.25], gamma = 4", "distribution = \"gauss\", m = 0.3");
        let gauss = plan(&scene(&other));
        assert_eq!(gauss.verdicts, [Verdict::Bake(0), Verdict::Own]);
        let labels: Vec<String> = gauss.distributions.iter().map(Distribution::label).collect();
        assert_eq!(labels, ["gauss:0.3"]);
        // A mirror in a haze, and a lobe in a mirror.
        let coated = plan(&scene(&HAZY.replace("sigma = 0.1", "sigma = 0")));
        assert_eq!(coated.verdicts, [Verdict::NotRough, Verdict::Bake(0)]);
        let smooth = plan(&scene(&HAZY.replace("sigma = [0.5, 0.25]", "sigma = 1e-12")));
        assert_eq!(smooth.verdicts, [Verdict::Bake(0), Verdict::NotRough]);
        assert!(smooth.materials[0].haze.as_ref().unwrap().lobe.is_smooth());
        let ggx = plan(&scene(&HAZY.replace("gamma = 4", "gamma = 2")));
        assert_eq!(ggx.verdicts, [Verdict::Bake(0), Verdict::ClosedForm]);
    }

    #[test]
    fn a_material_whose_haze_is_not_covered_is_left_out_whole() {
        let text = HAZY.replace("gamma = 4", "gamma = 1.5005");
        let mut scene = scene(&text);
        let why = Plan::new(&scene, Options::default()).unwrap_err();
        assert!(matches!(&why, NotCovered::Gamma { gamma: 1.5005, .. }), "{why}");
        scene.materials[0].origin.format = crate::scene::Format::Mitsuba;
        let plan = plan(&scene);
        assert!(plan.is_empty() && plan.materials.is_empty(), "{plan:?}");
        assert_eq!(plan.verdicts, vec![Verdict::NotCovered(why.clone()); 2]);
        assert_eq!(plan.albedo_verdicts, [AlbedoVerdict::NotNeeded, AlbedoVerdict::NotNeeded]);
        // Said once.
        assert_eq!(plan.not_covered().collect::<Vec<_>>(), [&why]);
    }

    #[test]
    fn retroreflection_needs_no_tables() {
        let mut retro = scene(HAZY);
        let specular = plan(&retro);
        retro.materials[0].retroreflection = Interval::point(1.0);
        let retro = plan(&retro);
        assert_eq!((&retro.shapes, &retro.albedos), (&specular.shapes, &specular.albedos));
        assert_ne!(retro.materials, specular.materials);
    }
}
