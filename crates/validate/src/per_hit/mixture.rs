//! The mixture of σ and γ that is drawn.

use std::f64::consts::{FRAC_PI_2, PI};

use rand::rngs::StdRng;
use rand::{Rng, RngExt};

use microfacet_core::shape::{gamma_of_s, s_of_gamma};

/// The range of σx and of σy, which are log-uniform and independent.
pub const SIGMAS: [f64; 2] = [0.01, 3.0];

/// Polar angles of the views: straight from above, almost so, between, and down to the horizon.
pub const THETAS: [f64; 7] = [0.0, 1e-3, 0.4, 0.9, 1.3, FRAC_PI_2 - 0.01, FRAC_PI_2 - 1e-5];

/// σ and γ of one range of γ: s = 1/(γ−1) is uniform, so that no part of the tables is seldom read.
pub(super) struct Mixture {
    /// s at the largest γ and at the smallest.
    s: [f64; 2],
}

/// One hit: numbers as a renderer's textures give them.
pub(super) struct Hit {
    pub(super) sigma: [f32; 2],
    pub(super) gamma: f32,
    /// Azimuth of the view.
    pub(super) phi: f64,
    /// Where s and σx are in their ranges, uniform on [0, 1].
    pub(super) places: [f64; 2],
}

impl Mixture {
    pub(super) fn new([low, high]: [f64; 2]) -> Self {
        Self { s: [high, low].map(s_of_gamma) }
    }

    /// Random places of s and of σx.
    pub(super) fn places(&self, random: &mut StdRng) -> [f64; 2] {
        [random.random(), random.random()]
    }

    /// The hit at these places, the rest random.
    pub(super) fn hit(&self, places: [f64; 2], random: &mut impl Rng) -> Hit {
        let [low, high] = self.s;
        let sigma = |place: f64| {
            let [low, high] = SIGMAS.map(f64::ln);
            (low + place * (high - low)).exp() as f32
        };
        Hit {
            sigma: [sigma(places[1]), sigma(random.random())],
            gamma: gamma_of_s(low + places[0] * (high - low)) as f32,
            phi: random.random_range(-PI..PI),
            places,
        }
    }
}
