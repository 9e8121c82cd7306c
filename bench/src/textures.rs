//! σ and γ of every hit, as textures give them: drawn beforehand, like views and random numbers.

use std::f32::consts::TAU;
use std::ops::Range;

use glam::Vec3;
use microfacet_sampler::Family;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::inputs::Inputs;
use crate::settings::{GAMMA, SIGMA};

/// σ and γ of hits, in the order of the calls.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    pub(crate) sigma: Vec<f32>,
    pub(crate) gamma: Vec<f32>,
}

/// The range of a random σ; one of a random γ from 1.8 on, and the γ below that sets cover.
const SIGMAS: [f32; 2] = [0.05, 1.0];
const WHOLE: [f32; 2] = [1.8, 7.8];
const PEELED: [f32; 2] = [1.501, 1.799_99];

impl Texture {
    /// The material of the other rivals, [`SIGMA`] and [`GAMMA`], at every hit. A compiler does not
    /// know that.
    pub(crate) fn constant(count: usize) -> Self {
        Self { sigma: vec![SIGMA as f32; count], gamma: vec![GAMMA as f32; count] }
    }

    /// Random σ and one γ.
    pub(crate) fn of_sigma(seed: u64, count: usize, gamma: f64) -> Self {
        Self { gamma: vec![gamma as f32; count], ..Self::whole(seed, count) }
    }

    /// Both change slowly from hit to hit, σ from 0.1 to 0.9 and γ from 1.9 to 7.7, to and fro in
    /// some hundreds of hits, as where the lines of a picture cross a texture.
    pub(crate) fn smooth(count: usize) -> Self {
        let wave = |middle: f32, height: f32, hits: f32| -> Vec<f32> {
            let place = |i: usize| TAU * (i as f32 / hits).fract();
            (0..count).map(|i| middle + height * place(i).sin()).collect()
        };
        Self { sigma: wave(0.5, 0.4, 700.0), gamma: wave(4.8, 2.9, 512.0) }
    }

    /// Random σ, and random γ of distributions that are tabulated as a whole.
    pub(crate) fn whole(seed: u64, count: usize) -> Self {
        Self::random(seed, count, WHOLE)
    }

    /// Random σ, and random γ below 1.8, where a heavy part is in closed form.
    pub(crate) fn peeled(seed: u64, count: usize) -> Self {
        Self::random(seed, count, PEELED)
    }

    fn random(seed: u64, count: usize, gammas: [f32; 2]) -> Self {
        let mut random = StdRng::seed_from_u64(seed.wrapping_add(2));
        let mut within = |[low, high]: [f32; 2]| -> Vec<f32> {
            (0..count).map(|_| low + (high - low) * random.random::<f32>()).collect()
        };
        Self { sigma: within(SIGMAS), gamma: within(gammas) }
    }

    /// σ and γ of each hit.
    pub(crate) fn each(&self) -> impl Iterator<Item = [f32; 2]> {
        self.sigma.iter().zip(&self.gamma).map(|(sigma, gamma)| [*sigma, *gamma])
    }
}

/// What a hit has beside its view: two random numbers, a light that next-event estimation has
/// chosen, and σ and γ of its textures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub(crate) v: Vec3,
    pub(crate) u: [f32; 2],
    pub(crate) l: Vec3,
    /// A normal that is seen from there.
    pub(crate) m: Vec3,
    pub(crate) sigma: f32,
    pub(crate) gamma: f32,
}

/// Hits on a surface with textures.
pub(crate) struct Surface<'a> {
    inputs: &'a Inputs,
    lights: &'a Inputs,
    normals: Vec<Vec3>,
    texture: Texture,
}

impl<'a> Surface<'a> {
    /// Normals are those that the lobe of each hit draws.
    pub(crate) fn new(
        family: &Family,
        inputs: &'a Inputs,
        lights: &'a Inputs,
        texture: Texture,
    ) -> Self {
        let sigma: Vec<[f32; 2]> = texture.sigma.iter().map(|sigma| [*sigma; 2]).collect();
        let mut normals = vec![Vec3::ZERO; sigma.len()];
        family
            .sample_batch(&sigma, &texture.gamma, &inputs.views, &inputs.numbers, &mut normals)
            .expect("of one length");
        Self { inputs, lights, normals, texture }
    }

    pub(crate) fn len(&self) -> usize {
        self.normals.len()
    }

    #[inline(always)]
    pub(crate) fn hits(&self, at: Range<usize>) -> impl Iterator<Item = Hit> {
        let Inputs { views, numbers } = self.inputs;
        let Texture { sigma, gamma } = &self.texture;
        let directions = views[at.clone()]
            .iter()
            .zip(&self.lights.views[at.clone()])
            .zip(&self.normals[at.clone()]);
        let values = numbers[at.clone()].iter().zip(&sigma[at.clone()]).zip(&gamma[at]);
        directions.zip(values).map(|(((v, l), m), ((u, sigma), gamma))| Hit {
            v: *v,
            u: *u,
            l: *l,
            m: *m,
            sigma: *sigma,
            gamma: *gamma,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_are_of_their_ranges() {
        let range = |values: &[f32]| {
            let low = values.iter().copied().fold(f32::INFINITY, f32::min);
            [low, values.iter().copied().fold(0.0, f32::max)]
        };
        let inside = |values: &[f32], [low, high]: [f32; 2]| {
            let [a, b] = range(values);
            // Most of the range is met.
            low <= a && b <= high && b - a > 0.9 * (high - low)
        };
        let (whole, peeled) = (Texture::whole(1, 5000), Texture::peeled(1, 5000));
        assert!(inside(&whole.gamma, WHOLE) && inside(&peeled.gamma, PEELED));
        assert!(inside(&whole.sigma, SIGMAS) && inside(&peeled.sigma, SIGMAS));
        let smooth = Texture::smooth(5000);
        assert!(inside(&smooth.gamma, [1.899, 7.701]) && inside(&smooth.sigma, [0.099, 0.901]));
        let step = |values: &[f32]| {
            values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max)
        };
        assert!(step(&smooth.gamma) < 0.04 && step(&smooth.sigma) < 4e-3);
        let of_sigma = Texture::of_sigma(1, 100, 2.0);
        assert!(of_sigma.gamma.iter().all(|gamma| *gamma == 2.0));
        assert_eq!(of_sigma.sigma, Texture::whole(1, 100).sigma);
        let own = [SIGMA as f32, GAMMA as f32];
        assert!(Texture::constant(3).each().all(|hit| hit == own));
    }
}
