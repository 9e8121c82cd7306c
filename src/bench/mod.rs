//! Run time against error: this crate's tables and their rivals, timed in one process, on one thread, with the same inputs.
//!
//! A time is a throughput: of independent calls in a row, each of which the compiler may inline, with views and random numbers
//! drawn beforehand ([`Inputs`]). Everything is in single precision unless its name says otherwise.

mod clock;
mod figures;
mod inputs;
mod judge;
mod masking;
mod paper;
mod plot;
mod rivals;
mod sampler;
mod tables;

use glam::Vec3;

pub use figures::{Figure, figures};
pub use inputs::{COUNT, Inputs};
pub use judge::Error;
pub use masking::{Evaluate, Masking, maskings};
pub use paper::{Approximation, Timing, approximation, approximation_svg, times, times_svg};
pub use plot::svg;
pub use sampler::{Draw, Sampler, samplers};
pub use tables::Slices;

/// Roughness of the materials compared.
pub const SIGMA: f64 = 0.5;
/// Shape of the Student-t materials compared: an integer, so that the sums take part, and no node of the general set.
pub const GAMMA: f64 = 4.0;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Views and pairs of numbers that calls and errors are taken over; at most [`COUNT`].
    pub calls: usize,
    /// Batches, of whose times the median is taken.
    pub rounds: usize,
    /// Views of the white furnace.
    pub views: usize,
    /// Draws for each.
    pub draws: usize,
    /// Seed of the inputs.
    pub seed: u64,
}

impl Settings {
    /// A minute or so.
    pub const FULL: Self = Self { calls: COUNT, rounds: 801, views: 128, draws: 2048, seed: 1 };
    /// Some seconds.
    pub const QUICK: Self = Self { rounds: 101, views: 32, draws: 1024, ..Self::FULL };

    /// The same over `calls` inputs, and no more than that of anything else.
    pub fn with_calls(self, calls: usize) -> Self {
        let calls = calls.clamp(1, COUNT);
        let few = |n: usize| n.min(calls);
        Self { calls, rounds: few(self.rounds), views: few(self.views), draws: few(self.draws), ..self }
    }
}

/// What a row is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A sampled normal.
    Normal,
    /// Smith's G1.
    G1,
}

impl Quantity {
    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::G1 => "g1",
        }
    }
}

/// One rival, measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it computes.
    pub quantity: Quantity,
    /// Its name.
    pub name: String,
    /// Its shape; ∞ is Beckmann.
    pub gamma: f64,
    /// Whether it draws visible normals, all of them, or evaluates G1: what can be compared by its error.
    pub complete: bool,
    /// Nanoseconds a call.
    pub ns: f64,
    /// Bytes of table that a bound material's lookups touch; 0 for closed forms.
    pub bytes: usize,
    /// Bytes of those tables as stored in a file.
    pub stored: usize,
    /// Error of the CDFs, or of G1, absolute; `None` for a sampler whose random numbers have no CDF of their own.
    pub error: Option<Error>,
    /// Variance of a white-furnace estimator; `None` for G1.
    pub variance: Option<f64>,
}

impl Row {
    /// Variance times nanoseconds: what a given noise costs.
    pub fn cost(&self) -> Option<f64> {
        self.variance.map(|variance| variance * self.ns)
    }
}

/// Times and judges all rivals.
pub fn rows(slices: &Slices, settings: &Settings) -> Vec<Row> {
    let inputs = Inputs::new(settings.seed, settings.calls);
    let (samplers, maskings) = (samplers(slices, settings.seed), maskings(slices));
    let mut runs: Vec<clock::Calls> =
        samplers.iter().map(|sampler| normals(&sampler.draw, &inputs)).collect();
    runs.extend(maskings.iter().map(|masking| values(&masking.evaluate, &inputs)));
    let times = clock::medians(&mut runs, settings.rounds, settings.calls);
    let of_sampler = |(sampler, &ns): (&Sampler, &f64)| Row {
        quantity: Quantity::Normal,
        name: sampler.name.clone(),
        gamma: sampler.gamma,
        complete: sampler.draws_visible_normals(),
        ns,
        bytes: sampler.bytes,
        stored: sampler.stored,
        error: judge::sampler_error(sampler, &inputs),
        variance: Some(judge::furnace_variance(sampler, &inputs, settings.views, settings.draws)),
    };
    let of_masking = |(masking, &ns): (&Masking, &f64)| Row {
        quantity: Quantity::G1,
        name: masking.name.clone(),
        gamma: masking.gamma,
        complete: true,
        ns,
        bytes: masking.bytes,
        stored: masking.stored,
        error: Some(judge::masking_error(&masking.evaluate, masking.gamma, &inputs)),
        variance: None,
    };
    let (first, second) = times.split_at(samplers.len());
    samplers.iter().zip(first).map(of_sampler).chain(maskings.iter().zip(second).map(of_masking)).collect()
}

/// A sampler as what the clock runs.
fn normals<'a>(draw: &'a Draw<'a>, inputs: &'a Inputs) -> clock::Calls<'a> {
    let mut normals = vec![Vec3::ZERO; inputs.views.len()];
    Box::new(move |at| {
        draw(&inputs.views[at.clone()], &inputs.numbers[at.clone()], &mut normals[at]);
        std::hint::black_box(&mut normals);
    })
}

/// A form of G1 likewise.
fn values<'a>(evaluate: &'a Evaluate<'a>, inputs: &'a Inputs) -> clock::Calls<'a> {
    let mut values = vec![0.0; inputs.views.len()];
    Box::new(move |at| {
        evaluate(&inputs.views[at.clone()], &mut values[at]);
        std::hint::black_box(&mut values);
    })
}
