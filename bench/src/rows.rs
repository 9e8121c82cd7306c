//! The result: one row per rival, all timed and judged with the same inputs.

use serde::Serialize;

use crate::clock;
use crate::conductors::{Hits, conductors, evaluations};
use crate::error::{self, Error};
use crate::files::shape;
use crate::inputs::Inputs;
use crate::per_hit::{Surfaces, per_hit};
use crate::rival::{Rival, normals, values};
use crate::sampler::samplers;
use crate::settings::Settings;
use crate::tables::Slices;
use crate::values::{densities, maskings, seen};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Quantity {
    /// A sampled normal.
    Normal,
    /// Smith's G1.
    G1,
    /// The normal distribution function.
    D,
    /// A conductor: a sampled light and the evaluation of another.
    Conductor,
    /// A conductor: the evaluation of a given light alone.
    Evaluation,
    /// Any of these with parameters of each hit.
    #[serde(rename = "per hit")]
    PerHit,
    /// A picture of rough gold.
    Picture,
}

/// One rival, measured: a line of `bench.csv`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) quantity: Quantity,
    pub(crate) name: &'static str,
    /// Its shape; ∞ is Beckmann, NaN one that varies.
    #[serde(serialize_with = "shape")]
    pub(crate) gamma: f64,
    /// Nanoseconds a call.
    pub(crate) ns: f64,
    /// Bytes of table that a lobe's lookups touch; 0 for closed forms.
    pub(crate) bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub(crate) stored_bytes: usize,
    /// Error of the CDFs, or of G1, absolute, or of D, relative, at most and as root mean square;
    /// `None` for a sampler whose random numbers do not correspond to CDFs, and for conductors.
    pub(crate) error_max: Option<f64>,
    pub(crate) error_rms: Option<f64>,
    /// Variance of a white-furnace estimator; of samplers alone.
    pub(crate) furnace_variance: Option<f64>,
    /// Variance times nanoseconds: the cost of a given noise level.
    pub(crate) variance_ns: Option<f64>,
}

impl Row {
    fn new<F>(quantity: Quantity, rival: &Rival<F>, ns: f64, error: Option<Error>) -> Self {
        let &Rival { name, gamma, bytes, stored, .. } = rival;
        Self {
            quantity,
            name,
            gamma,
            ns,
            bytes,
            stored_bytes: stored,
            error_max: error.map(|error| error.max),
            error_rms: error.map(|error| error.rms),
            furnace_variance: None,
            variance_ns: None,
        }
    }
}

/// Tables of more bytes are those of all γ, too many for the first cache.
const LARGE: usize = 1 << 18;

fn bytes_of<F>(rivals: &[Rival<F>]) -> Vec<usize> {
    rivals.iter().map(|rival| rival.bytes).collect()
}

/// Times and judges all rivals.
pub(crate) fn rows(slices: &Slices, settings: &Settings) -> Vec<Row> {
    let inputs = Inputs::new(settings.seed, settings.calls);
    let seen = seen(slices, &inputs);
    let hits = Hits::new(settings.seed, settings.calls);
    let (samplers, maskings) = (samplers(slices, settings.seed), maskings(slices));
    let (densities, mut conductors) = (densities(slices), conductors(slices.default(), &hits));
    let mut evaluations = evaluations(slices.default(), &hits);
    let lights = Inputs::new(settings.seed.wrapping_add(1), settings.calls);
    let surfaces = Surfaces::new(slices, &inputs, &lights, settings);
    let per_hit = per_hit(slices, &surfaces);
    let mut bytes = bytes_of(&samplers);
    bytes.extend([bytes_of(&maskings), bytes_of(&densities)].concat());
    bytes.extend([bytes_of(&conductors), bytes_of(&evaluations), bytes_of(&per_hit)].concat());
    let large: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i] > LARGE).collect();
    let mut runs: Vec<clock::Calls> =
        samplers.iter().map(|sampler| normals(&sampler.run.draw, &inputs)).collect();
    runs.extend(maskings.iter().map(|masking| values(&masking.run, &inputs)));
    runs.extend(densities.iter().map(|density| values(&density.run, &seen)));
    let given = conductors.iter_mut().chain(&mut evaluations);
    runs.extend(given.map(|rival| -> clock::Calls { Box::new(&mut rival.run) }));
    runs.extend(per_hit.iter().map(|rival| rival.run.calls()));
    let times = clock::medians_warmed(&mut runs, &large, settings.rounds, settings.calls);
    drop(runs);
    let mut times = times.into_iter();
    let mut next = || times.next().expect("one of each run");
    let mut all = Vec::new();
    for rival in &samplers {
        let error = error::sampler_error(rival, &inputs);
        let variance = error::furnace_variance(rival, &inputs, settings.views, settings.draws);
        let row = Row::new(Quantity::Normal, rival, next(), error);
        all.push(Row {
            furnace_variance: Some(variance),
            variance_ns: Some(variance * row.ns),
            ..row
        });
    }
    for rival in &maskings {
        let error = error::masking_error(rival, &inputs);
        all.push(Row::new(Quantity::G1, rival, next(), Some(error)));
    }
    for rival in &densities {
        let error = error::density_error(rival, &seen);
        all.push(Row::new(Quantity::D, rival, next(), Some(error)));
    }
    all.extend(conductors.iter().map(|rival| Row::new(Quantity::Conductor, rival, next(), None)));
    all.extend(evaluations.iter().map(|rival| Row::new(Quantity::Evaluation, rival, next(), None)));
    all.extend(
        per_hit.iter().map(|rival| Row::new(Quantity::PerHit, rival, next(), rival.run.error())),
    );
    all
}
