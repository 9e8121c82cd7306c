//! The forms of Smith's G1 that are compared.

use std::hint::black_box;

use glam::Vec3;
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;

use crate::rivals::lobe::Lobe;
use crate::rivals::rational::Rational;
use crate::rivals::{beckmann, ggx};
use crate::sampler::{lobe, stored};
use crate::settings::{GAMMA, SIGMA};
use crate::tables::Slices;

/// G1 of directions, as many as the output slice holds.
pub(crate) type Evaluate<'a> = Box<dyn Fn(&[Vec3], &mut [f32]) + 'a>;

/// One form of G1, or of D as a function of a normal.
pub(crate) struct Masking<'a> {
    /// Its name.
    pub(crate) name: String,
    /// The shape; roughness is [`SIGMA`].
    pub(crate) gamma: f64,
    /// Bytes of table that lookups touch.
    pub(crate) bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub(crate) stored: usize,
    /// Evaluates.
    pub(crate) evaluate: Evaluate<'a>,
}

/// One call after the other, as for samplers.
pub(crate) fn each<'a>(one: impl Fn(Vec3) -> f32 + 'a) -> Evaluate<'a> {
    Box::new(move |w, g1| {
        for (w, g1) in w.iter().zip(g1) {
            *g1 = black_box(one(*w));
        }
    })
}

/// A form without tables.
pub(crate) fn form<'a>(name: &str, gamma: f64, evaluate: Evaluate<'a>) -> Masking<'a> {
    Masking { name: name.into(), gamma, bytes: 0, stored: 0, evaluate }
}

/// Names that figures refer to.
pub(crate) const GGX: &str = "GGX, closed form";

/// All forms, over the given tables.
pub(crate) fn maskings<'a>(slices: &'a Slices) -> Vec<Masking<'a>> {
    let sigma = SIGMA as f32;
    let (any, four, half) =
        (Lobe::any(SIGMA, GAMMA), Lobe::four(SIGMA), Lobe::three_and_a_half(SIGMA));
    let rational = Rational::new(SIGMA, GAMMA);
    let truth = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let mut all = vec![
        form(GGX, 2.0, each(move |w| ggx::g1(sigma, w))),
        form("Beckmann, closed form", f64::INFINITY, each(move |w| beckmann::g1(sigma, w))),
        form(
            "Beckmann, rational fit",
            f64::INFINITY,
            each(move |w| beckmann::g1_rational(sigma, w)),
        ),
        form("beta function, any gamma", GAMMA, each(move |w| any.g1(w))),
        form(
            "beta function, to rounding in f64",
            GAMMA,
            each(move |w| truth.g1(w.as_dvec3()) as f32),
        ),
        form("sum for integer gamma", GAMMA, each(move |w| four.g1(w))),
        form("sum for half-integer gamma", 3.5, each(move |w| half.g1(w))),
        form("rational approximation (eq. 22-23)", GAMMA, each(move |w| rational.g1(w))),
    ];
    let batch = lobe(&slices.default, GAMMA);
    let (bytes, stored_bytes) = (batch.bytes(), stored(&slices.default));
    let evaluate: Evaluate = Box::new(move |w, g1| batch.g1_batch(w, g1).expect("of one length"));
    all.push(Masking {
        bytes,
        stored: stored_bytes,
        ..form("table, default, batch", GAMMA, evaluate)
    });
    for (name, set) in slices.each() {
        let table = lobe(set, GAMMA);
        let (bytes, stored) = (table.bytes(), stored(set));
        all.push(Masking { bytes, stored, ..form(name, GAMMA, each(move |w| table.g1(w))) });
    }
    all
}
