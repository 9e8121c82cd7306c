//! The normal distribution functions that are compared. D of Student-t has a closed form for every
//! γ, with a power where GGX has a square.

use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_sampler::MicrofacetDistribution as _;

use crate::error::{Error, truth};
use crate::inputs::Inputs;
use crate::masking::{Masking, each, form};
use crate::rivals::ggx;
use crate::sampler::lobe;
use crate::settings::{GAMMA, SIGMA};
use crate::tables::Slices;

/// Shapes besides [`GAMMA`]: below 1.8, and Beckmann.
const SHAPES: [f64; 3] = [1.6, GAMMA, f64::INFINITY];

/// All of them, as functions of a normal.
pub(crate) fn densities<'a>(slices: &'a Slices) -> Vec<Masking<'a>> {
    let sigma = SIGMA as f32;
    let power = model::StudentT::new(SIGMA, GAMMA).expect("constants");
    let mut all = vec![
        form("GGX, closed form", 2.0, each(move |m| ggx::d(sigma, m))),
        form("closed form in f64", GAMMA, each(move |m| power.d(m.as_dvec3()) as f32)),
    ];
    all.extend(SHAPES.map(|gamma| {
        let lobe = lobe(slices.whole(), gamma);
        form("closed form of the sampler crate", gamma, each(move |m| lobe.d(m)))
    }));
    all
}

/// The normals to evaluate them for: those that the views of some inputs see.
pub(crate) fn seen(slices: &Slices, inputs: &Inputs) -> Inputs {
    let lobe = lobe(slices.whole(), GAMMA);
    let mut views = inputs.views.clone();
    lobe.sample_batch(&inputs.views, &inputs.numbers, &mut views).expect("of one length");
    Inputs { views, ..inputs.clone() }
}

/// The error of one, relative.
pub(crate) fn error(density: &Masking, normals: &Inputs) -> Error {
    let truth = truth(density.gamma);
    let mut got = vec![0.0; normals.views.len()];
    (density.evaluate)(&normals.views, &mut got);
    Error::of(normals.views.iter().zip(got).filter_map(|(m, d)| {
        let exact = truth.d(m.as_dvec3());
        // Less is subnormal in single precision.
        (exact > 1e-37).then(|| (f64::from(d) / exact - 1.0).abs())
    }))
}
