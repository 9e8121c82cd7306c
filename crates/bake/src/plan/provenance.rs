//! The provenance of a set: origin, licence, and conventions.

use microfacet_tables::Provenance;

use super::{Plan, RequiredAlbedo};
use crate::bake::NUMERICS;
use crate::table_spec::GAMMA_WHOLE;

/// The condition under which a set states a convention.
#[derive(Clone, Copy, PartialEq)]
enum If {
    Always,
    /// Masking and visible normals.
    Normals,
    Peeled,
    Albedos,
    Averages,
    /// Albedos of single lobes.
    Lobes,
    /// Materials that no table covers, but closed forms do.
    ClosedForms,
}

/// Conventions that readers need, in short; `docs/format.md` has them at length.
const CONVENTIONS: [(If, &str, &str); 14] = [
    (If::Always, "placement", "values sit at the nodes of the axes, not at cell centres"),
    (
        If::Always,
        "gamma",
        "Student-t shape gamma > 3/2; the axis coordinate is s = 1/(gamma-1), 0 is Beckmann, 1 is GGX",
    ),
    (If::Always, "sigma", "roughness alpha; a lookup divides slopes by it and by nothing else"),
    (
        If::Always,
        "frame",
        "tangent space, n = +z; angles in radians; slopes positive towards the viewer",
    ),
    (If::Normals, "masking", "shadowing tables hold Smith's G1 of one direction"),
    (If::Normals, "slope_channel", "derivative of `value` by the node index of the last axis"),
    (
        If::Normals,
        "shadowing",
        "G1/q, q = z/(z+kappa) whether or not the axis is crowded, z = cot(theta)/sigma",
    ),
    (
        If::Normals,
        "visible_slope",
        "distance of h = x/(1+sqrt(1+x^2)) from the end of its half: 1+h for u <= 1/2, 1-h above",
    ),
    (
        If::Peeled,
        "visible_slope_peeled",
        "as visible_slope, for the density without its term x sin(theta) p(x), x > 0",
    ),
    (
        If::Normals,
        "visible_slope_conditional",
        "1-h of t = y/sqrt(1+s x^2) for u > 1/2; odd about u = 1/2",
    ),
    (
        If::Albedos,
        "albedo",
        "share of light that one bounce returns, for the masking that the table names. Of `moments` e = \
         E-1, E for F = 1; bias and f82 are E weighted with (1-v.m)^5 and 7^7/6^6 v.m (1-v.m)^6, less E \
         times that weight at v.n. A sigma below the first node is a mirror. eta is the index of the dense \
         side over the other's",
    ),
    (
        If::Averages,
        "albedo_average",
        "2 int_0^1 x mu dmu of what is read from the albedo table, less E_avg times that of a mirror for bias and f82",
    ),
    (
        If::Lobes,
        "albedo_azimuth",
        "of one lobe, over the azimuth of the view from the x axis; sigma in the view's coordinate is the \
         roughness seen from there. `clamp` c = mu/(mu+A) above 1/2 scales the others' shares, 1+e for e, \
         by (1-c)/c",
    ),
    (
        If::ClosedForms,
        "ggx",
        "a material with gamma = 2 that no table covers has closed forms: G1 = 2/(1 + sqrt(1 + (sigma/cot theta)^2)), \
         visible normals by spherical caps (Dupuy and Benyoub 2023)",
    ),
];

impl Plan {
    /// Origin, licence and conventions of the set that a bake of this plan makes.
    pub fn provenance(&self) -> Provenance {
        let holds = |condition: &If| match condition {
            If::Always => true,
            If::Normals => !(self.shapes.is_empty() && self.distributions.is_empty()),
            If::Peeled => self.shapes.iter().any(|need| need.gamma().min < GAMMA_WHOLE),
            If::Albedos => !self.albedos.is_empty(),
            If::Averages => self.albedos.iter().any(RequiredAlbedo::has_averages),
            If::Lobes => self.albedos.iter().any(|need| !need.lobe.is_family()),
            If::ClosedForms => self.has_closed_forms(),
        };
        let conventions = CONVENTIONS.iter().filter(|(condition, ..)| holds(condition));
        Provenance {
            generator: concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")).into(),
            numerics: NUMERICS,
            license: "CC0-1.0".into(),
            conventions: conventions.map(|&(_, key, text)| (key.into(), text.into())).collect(),
            materials: self.materials.clone(),
            key: String::new(),
        }
    }
}
