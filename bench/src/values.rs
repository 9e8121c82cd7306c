//! The functions of one direction that are compared: Smith's G1, and D. D of Student-t has a closed
//! form for every γ, with a power where GGX has a square.

use std::hint::black_box;

use glam::Vec3;
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::lobe::{Batch as _, FamilyLobe};

use crate::inputs::{COUNT, Inputs};
use crate::rival::{Evaluate, Rival, each_value, lobe};
use crate::rivals::lanes::Width;
use crate::rivals::lobe::Lobe;
use crate::rivals::logarithm::Logarithm;
use crate::rivals::rational::Rational;
use crate::rivals::{beckmann, ggx, lanes};
use crate::settings::{GAMMA, SIGMA};
use crate::tables::Slices;
use crate::textures::Texture;

/// Names that figures refer to.
pub(crate) const GGX: &str = "GGX, closed form";
pub(crate) const BITS: &str = "table by the bits of the float";
pub(crate) const LOGARITHM: &str = "logarithm and exponential, as before";

/// In lanes, by width.
const LANES: [(&str, Width); 2] =
    [("GGX, closed form, 4 lanes", Width::Four), ("GGX, closed form, 8 lanes", Width::Eight)];

const BECKMANN: f64 = f64::INFINITY;

fn form<'a>(name: &'static str, gamma: f64, one: impl Fn(Vec3) -> f32 + 'a) -> Rival<Evaluate<'a>> {
    Rival::form(name, gamma, each_value(one))
}

/// The computations of G1, over the given tables.
pub(crate) fn maskings(slices: &Slices) -> Vec<Rival<Evaluate<'_>>> {
    let sigma = SIGMA as f32;
    let (any, four) = (Lobe::any(SIGMA, GAMMA), Lobe::four(SIGMA));
    let half = Lobe::three_and_a_half(SIGMA);
    let rational = Rational::new(SIGMA, GAMMA);
    let truth = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let exact = move |w: Vec3| truth.g1(w.as_dvec3()) as f32;
    let table = lobe(slices.default(), GAMMA);
    let batch: Evaluate = Box::new(move |w, g1| table.g1_batch(w, g1).expect("of one length"));
    let mut all = vec![
        form(GGX, 2.0, move |w| ggx::g1(sigma, w)),
        form("Beckmann, closed form", BECKMANN, move |w| beckmann::g1(sigma, w)),
        form("Beckmann, rational fit", BECKMANN, move |w| beckmann::g1_rational(sigma, w)),
        form("beta function, any gamma", GAMMA, move |w| any.g1(w)),
        form("beta function, to rounding in f64", GAMMA, exact),
        form("sum for integer gamma", GAMMA, move |w| four.g1(w)),
        form("sum for half-integer gamma", 3.5, move |w| half.g1(w)),
        form("rational approximation (eq. 22-23)", GAMMA, move |w| rational.g1(w)),
        Rival::form("table, default, batch", GAMMA, batch).of(slices.default()),
        Rival::form(FAMILY, GAMMA, of_family(slices, |lobe, w| lobe.g1(w))).of_family(slices),
    ];
    all.extend(
        LANES
            .into_iter()
            .filter_map(|(name, width)| Some(Rival::form(name, 2.0, lanes::g1(width, sigma)?))),
    );
    all.extend(slices.each().map(|(name, set)| {
        let table = lobe(set, GAMMA);
        form(name, GAMMA, move |w| table.g1(w)).of(set)
    }));
    all
}

const FAMILY: &str = "table, family, sigma and gamma per call";

/// The family at the σ and γ of all rivals, which it is told at every call.
fn of_family<'a>(
    slices: &'a Slices,
    one: impl Fn(FamilyLobe<'a>, Vec3) -> f32 + 'a,
) -> Evaluate<'a> {
    let (family, texture) = (slices.family(), Texture::constant(COUNT));
    Box::new(move |w, values| {
        for (([sigma, gamma], w), value) in texture.each().zip(w).zip(values) {
            *value = black_box(one(family.at(sigma, gamma), *w));
        }
    })
}

/// The computations of D: from a table of one shape, also of one below 1.8; and as a power by a
/// logarithm and an exponential, of Beckmann and where γ is free.
pub(crate) fn densities(slices: &Slices) -> Vec<Rival<Evaluate<'_>>> {
    let sigma = SIGMA as f32;
    let power = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let logarithm = Logarithm::new(SIGMA, GAMMA);
    let of_shape = |name, gamma| {
        let lobe = lobe(slices.whole(), gamma);
        form(name, gamma, move |m| lobe.d(m))
    };
    vec![
        form(GGX, 2.0, move |m| ggx::d(sigma, m)),
        form("closed form in f64", GAMMA, move |m| power.d(m.as_dvec3()) as f32),
        form(LOGARITHM, GAMMA, move |m| logarithm.d(m)),
        of_shape(BITS, GAMMA),
        of_shape(BITS, 1.6),
        of_shape("logarithm and exponential", BECKMANN),
        Rival::form("logarithm and exponential, family", GAMMA, of_family(slices, |at, m| at.d(m))),
    ]
}

/// The normals to evaluate D for: those that the views of some inputs see.
pub(crate) fn seen(slices: &Slices, inputs: &Inputs) -> Inputs {
    let lobe = lobe(slices.whole(), GAMMA);
    let mut views = inputs.views.clone();
    lobe.sample_batch(&inputs.views, &inputs.numbers, &mut views).expect("of one length");
    Inputs { views, ..inputs.clone() }
}
