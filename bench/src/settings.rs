//! Which materials are compared, and how much is measured.

use crate::inputs::COUNT;

/// Roughness of the materials compared.
pub(crate) const SIGMA: f64 = 0.5;
/// Shape of the Student-t materials compared: an integer, so that the sums take part, and not a
/// node of the general set.
pub(crate) const GAMMA: f64 = 4.0;

/// How finely a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Film {
    /// Pixels along an edge.
    pub(crate) edge: usize,
    /// Camera rays of a pixel.
    pub(crate) samples: usize,
}

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
    /// Calls of a batch of the sweep.
    pub(crate) sweep_calls: usize,
    /// How finely a picture is made that is timed.
    pub(crate) timed: Film,
    /// How often the timed picture is made; the median is taken.
    pub(crate) picture_rounds: usize,
    /// How finely a picture is made that is compared.
    pub(crate) shown: Film,
    /// Seed of the inputs.
    pub(crate) seed: u64,
}

impl Settings {
    /// About three minutes.
    pub(crate) const FULL: Self = Self {
        calls: COUNT,
        rounds: 801,
        views: 128,
        draws: 2048,
        sweep_batches: 7,
        sweep_calls: 512,
        timed: Film { edge: 48, samples: 4 },
        picture_rounds: 11,
        shown: Film { edge: 160, samples: 64 },
        seed: 1,
    };
    /// Some seconds.
    pub(crate) const QUICK: Self = Self {
        rounds: 101,
        views: 32,
        draws: 1024,
        sweep_batches: 3,
        sweep_calls: 64,
        timed: Film { edge: 16, samples: 1 },
        picture_rounds: 3,
        shown: Film { edge: 64, samples: 16 },
        ..Self::FULL
    };

    /// The seed of pictures, which both halves of [`seed`](Self::seed) change.
    pub(crate) fn picture_seed(&self) -> u32 {
        (self.seed ^ (self.seed >> 32)) as u32
    }

    /// These settings over `calls` inputs, with no other count above `calls`.
    pub(crate) fn with_calls(self, calls: usize) -> Self {
        let calls = calls.clamp(1, COUNT);
        let few = |n: usize| n.min(calls);
        Self {
            calls,
            rounds: few(self.rounds),
            views: few(self.views),
            draws: few(self.draws),
            sweep_calls: few(self.sweep_calls),
            picture_rounds: few(self.picture_rounds),
            ..self
        }
    }
}
