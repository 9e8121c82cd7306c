//! The result: one row per rival, all timed and judged with the same inputs.

use glam::Vec3;

use crate::clock;
use crate::conductors::{Hits, Timed, conductors};
use crate::densities::{self, densities};
use crate::error::{self, Error};
use crate::inputs::Inputs;
use crate::masking::{Evaluate, Masking, maskings};
use crate::sampler::samplers;
use crate::settings::Settings;
use crate::tables::Slices;

/// The quantity of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// A sampled normal.
    Normal,
    /// Smith's G1.
    G1,
    /// The normal distribution function.
    D,
    /// A conductor: a sampled light and the evaluation of another.
    Conductor,
    /// A picture of rough gold.
    Picture,
}

impl Quantity {
    /// The name used in files.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::G1 => "g1",
            Self::D => "d",
            Self::Conductor => "conductor",
            Self::Picture => "picture",
        }
    }
}

/// One rival, measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// What it computes.
    pub(crate) quantity: Quantity,
    /// Its name.
    pub(crate) name: String,
    /// Its shape; ∞ is Beckmann.
    pub(crate) gamma: f64,
    /// Whether it draws all visible normals or evaluates a function, so that its error can be
    /// compared.
    pub(crate) complete: bool,
    /// Nanoseconds a call.
    pub(crate) ns: f64,
    /// Bytes of table that a lobe's lookups touch; 0 for closed forms.
    pub(crate) bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub(crate) stored: usize,
    /// Error of the CDFs, or of G1, absolute, or of D, relative; `None` for a sampler whose random
    /// numbers do not correspond to CDFs, and for conductors.
    pub(crate) error: Option<Error>,
    /// Variance of a white-furnace estimator; of samplers alone.
    pub(crate) variance: Option<f64>,
}

impl Row {
    /// Variance times nanoseconds: the cost of a given noise level.
    pub(crate) fn cost(&self) -> Option<f64> {
        self.variance.map(|variance| variance * self.ns)
    }
}

/// Times and judges all rivals.
pub(crate) fn rows(slices: &Slices, settings: &Settings) -> Vec<Row> {
    let inputs = Inputs::new(settings.seed, settings.calls);
    let (samplers, maskings) = (samplers(slices, settings.seed), maskings(slices));
    let (densities, seen) = (densities(slices), densities::seen(slices, &inputs));
    let hits = Hits::new(settings.seed, settings.calls);
    let (conductors, timed): (Vec<_>, Vec<_>) = conductors(&slices.default, &hits)
        .into_iter()
        .map(|Timed { name, gamma, bytes, stored, calls }| ((name, gamma, bytes, stored), calls))
        .unzip();
    let mut runs: Vec<clock::Calls> =
        samplers.iter().map(|sampler| normals(&sampler.draw, &inputs)).collect();
    runs.extend(maskings.iter().map(|masking| values(&masking.evaluate, &inputs)));
    runs.extend(densities.iter().map(|density| values(&density.evaluate, &seen)));
    runs.extend(timed);
    let mut times = clock::medians(&mut runs, settings.rounds, settings.calls).into_iter();
    let mut next = || times.next().expect("one of each run");
    let mut all: Vec<Row> = samplers
        .iter()
        .map(|sampler| Row {
            quantity: Quantity::Normal,
            name: sampler.name.clone(),
            gamma: sampler.gamma,
            complete: sampler.draws_visible_normals(),
            ns: next(),
            bytes: sampler.bytes,
            stored: sampler.stored,
            error: error::sampler_error(sampler, &inputs),
            variance: Some(error::furnace_variance(
                sampler,
                &inputs,
                settings.views,
                settings.draws,
            )),
        })
        .collect();
    let of_function = |masking: &Masking, quantity, ns, error| Row {
        quantity,
        name: masking.name.clone(),
        gamma: masking.gamma,
        complete: true,
        ns,
        bytes: masking.bytes,
        stored: masking.stored,
        error: Some(error),
        variance: None,
    };
    all.extend(maskings.iter().map(|masking| {
        let error = error::masking_error(&masking.evaluate, masking.gamma, &inputs);
        of_function(masking, Quantity::G1, next(), error)
    }));
    all.extend(densities.iter().map(|density| {
        of_function(density, Quantity::D, next(), densities::error(density, &seen))
    }));
    all.extend(conductors.into_iter().map(|(name, gamma, bytes, stored)| Row {
        quantity: Quantity::Conductor,
        name: name.into(),
        gamma,
        complete: true,
        ns: next(),
        bytes,
        stored,
        error: None,
        variance: None,
    }));
    all
}

/// A sampler as the clock runs it.
pub(crate) fn normals<'a>(
    draw: impl Fn(&[Vec3], &[[f32; 2]], &mut [Vec3]) + 'a,
    inputs: &'a Inputs,
) -> clock::Calls<'a> {
    let mut normals = vec![Vec3::ZERO; inputs.views.len()];
    Box::new(move |at| {
        draw(&inputs.views[at.clone()], &inputs.numbers[at.clone()], &mut normals[at]);
        std::hint::black_box(&mut normals);
    })
}

/// A form of G1 as the clock runs it.
pub(crate) fn values<'a>(evaluate: &'a Evaluate<'a>, inputs: &'a Inputs) -> clock::Calls<'a> {
    let mut values = vec![0.0; inputs.views.len()];
    Box::new(move |at| {
        evaluate(&inputs.views[at.clone()], &mut values[at]);
        std::hint::black_box(&mut values);
    })
}
