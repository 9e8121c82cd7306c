//! What a set states about itself: origin, licence, and the meaning of its tables.

use microfacet_tables::Provenance;

use super::Plan;
use crate::bake::NUMERICS;

/// Conventions of every set.
const CONVENTIONS: [(&str, &str); 10] = [
    ("placement", "values sit at the nodes of the axes, not at cell centres"),
    (
        "gamma",
        "Student-t shape gamma > 3/2; the axis coordinate is s = 1/(gamma-1), 0 is Beckmann, 1 is GGX",
    ),
    (
        "sigma",
        "GGX and Beckmann roughness alpha; slopes are divided by sigma, nothing else, before a lookup",
    ),
    ("frame", "tangent space, n = +z; angles in radians; slopes positive towards the viewer"),
    (
        "masking",
        "shadowing tables hold Smith's G1 of one direction; how two are combined is the reader's choice",
    ),
    ("slope_channel", "derivative of `value` with respect to the node index of the last axis"),
    (
        "shadowing",
        "value = G1/q, q = z/(z+kappa) whether or not the axis is crowded, z = cot(theta)/sigma",
    ),
    (
        "visible_slope",
        "value = distance of h = x/(1+sqrt(1+x^2)) from the end of its half: 1+h for u <= 1/2, 1-h above",
    ),
    (
        "visible_slope_peeled",
        "as visible_slope, for the density without its term x sin(theta) p(x), x > 0",
    ),
    (
        "visible_slope_conditional",
        "value = 1-h of t = y/sqrt(1+s x^2) for u > 1/2; odd about u = 1/2",
    ),
];

/// Conventions of a set with albedo tables.
const ALBEDO: [(&str, &str); 4] = [
    (
        "albedo",
        "share of light that one bounce returns. Of reflectance `moments` E is that with F = 1, the integral of G2/G1(v) over visible normals \
         that reflect upwards. Channels: e = E-1; bias and f82, the same integral weighted with (1-v.m)^5 and 7^7/6^6 v.m (1-v.m)^6, less E times \
         that weight at v.n. The weight 1-(1-v.m)^5 has E less the whole of bias. A sigma below the first node is a mirror. Other \
         reflectances have the shares themselves; eta is the index of the dense side over the other's",
    ),
    (
        "albedo_average",
        "2 int_0^1 x mu dmu of what is read from the albedo table, less E_avg times that of a mirror for bias and f82",
    ),
    (
        "albedo_masking",
        "each albedo table names its form of G2: uncorrelated G1(v) G1(l), height-correlated 1/(1+lambda(v)+lambda(l))",
    ),
    (
        "albedo_azimuth",
        "of a lobe that is one material, over the azimuth of the view (radians, from the x axis) and the view; sigma in the view's coordinate is \
         the roughness seen from the azimuth. A channel `clamp` c = mu/(mu+A) above 1/2 scales the others' shares, 1+e for e, by (1-c)/c",
    ),
];

/// The convention of a set that leaves a material to closed forms.
const GGX: (&str, &str) = (
    "ggx",
    "a material with gamma = 2 that no table covers has closed forms: G1 = 2/(1 + sqrt(1 + (sigma/cot theta)^2)), \
     visible normals by spherical caps (Dupuy and Benyoub 2023)",
);

impl Plan {
    /// Origin, licence and conventions of the set that a bake of this plan makes.
    pub fn provenance(&self) -> Provenance {
        let albedo = ALBEDO.iter().filter(|_| !self.albedos.is_empty());
        let ggx = self.has_closed_forms().then_some(&GGX);
        let conventions = CONVENTIONS.iter().chain(albedo).chain(ggx);
        Provenance {
            generator: concat!("microfacet-bake ", env!("CARGO_PKG_VERSION")).into(),
            numerics: NUMERICS,
            license: "CC0-1.0".into(),
            conventions: conventions.map(|&(key, text)| (key.into(), text.into())).collect(),
            recipe: self.recipe.clone(),
            materials: self.materials.clone(),
        }
    }
}
