//! The inputs of every rival: the same views and random numbers, drawn once and resident in the
//! caches.

use std::f32::consts::TAU;

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Views spread evenly over the solid angle above the surface (cos θ uniform in (0, 1], φ in [0,
/// 2π)), and pairs of random numbers uniform in [0, 1)².
///
/// Enough that a branch predictor cannot learn them: 16 384 of each, 320 KiB, read in order.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    /// Unit vectors, n = +z.
    pub(crate) views: Vec<Vec3>,
    /// u₁ and u₂.
    pub(crate) numbers: Vec<[f32; 2]>,
}

/// Number of views, and of pairs of numbers.
pub(crate) const COUNT: usize = 16_384;

impl Inputs {
    pub(crate) fn new(seed: u64, count: usize) -> Self {
        let mut random = StdRng::seed_from_u64(seed);
        let mut pairs =
            || (0..count).map(|_| [random.random(), random.random()]).collect::<Vec<[f32; 2]>>();
        let views = pairs().into_iter().map(|u| direction(1.0 - u[0], u[1])).collect();
        Self { views, numbers: pairs() }
    }
}

/// The unit vector with this cosine to n and an azimuth in turns.
pub(crate) fn direction(cos: f32, turn: f32) -> Vec3 {
    let (y, x) = (TAU * turn).sin_cos();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(sin * x, sin * y, cos)
}

/// How many numbers a [`Stream`] repeats.
const STREAM: usize = 1 << 16;

/// Random numbers uniform in [0, 1) for rivals that need a varying number of them: drawn
/// beforehand, so that no time includes a generator.
#[derive(Clone, Debug)]
pub(crate) struct Stream {
    numbers: Box<[f32; STREAM]>,
    at: u16,
}

impl Stream {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = StdRng::seed_from_u64(seed);
        let numbers: Vec<f32> = (0..STREAM).map(|_| random.random()).collect();
        Self { numbers: numbers.try_into().expect("so many were made"), at: 0 }
    }

    #[inline(always)]
    pub(crate) fn next(&mut self) -> f32 {
        // The index wraps around by itself, so no bounds check is needed.
        self.at = self.at.wrapping_add(1);
        self.numbers[usize::from(self.at)]
    }
}
