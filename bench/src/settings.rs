//! Which materials are compared, and how much is measured.

use crate::inputs::COUNT;

/// Roughness of the materials compared.
pub(crate) const SIGMA: f64 = 0.5;
/// Shape of the Student-t materials compared: an integer, so that the sums take part, and not a
/// node of the general set.
pub(crate) const GAMMA: f64 = 4.0;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Settings {
    /// Views and pairs of numbers for calls and errors; at most [`COUNT`].
    pub(crate) calls: usize,
    /// Batches; the median of their times is taken.
    pub(crate) rounds: usize,
    /// Views of the white furnace.
    pub(crate) views: usize,
    /// Draws for each view.
    pub(crate) draws: usize,
    /// Batches of a cell of the sweep, each of other inputs.
    pub(crate) sweep_batches: usize,
    /// Calls of such a batch.
    pub(crate) sweep_calls: usize,
    /// Seed of the inputs.
    pub(crate) seed: u64,
}

impl Settings {
    /// About two minutes.
    pub(crate) const FULL: Self = Self {
        calls: COUNT,
        rounds: 801,
        views: 128,
        draws: 2048,
        sweep_batches: 7,
        sweep_calls: 512,
        seed: 1,
    };
    /// Some seconds.
    pub(crate) const QUICK: Self = Self {
        rounds: 101,
        views: 32,
        draws: 1024,
        sweep_batches: 3,
        sweep_calls: 64,
        ..Self::FULL
    };

    /// The same over `calls` inputs, with no other count above that.
    pub(crate) fn with_calls(self, calls: usize) -> Self {
        let calls = calls.clamp(1, COUNT);
        let few = |n: usize| n.min(calls);
        Self {
            calls,
            rounds: few(self.rounds),
            views: few(self.views),
            draws: few(self.draws),
            sweep_calls: few(self.sweep_calls),
            ..self
        }
    }
}
