//! The path tracer: next-event estimation and multiple importance sampling (Veach 1997, *Robust
//! Monte Carlo Methods for Light Transport Simulation*, section 9.2), roulette and splitting
//! (Arvo & Kirk 1990, *Particle Transport and Image Synthesis*,
//! <https://doi.org/10.1145/97879.97886>).

use glam::Vec3;

use crate::spheres::random::Random;
use crate::spheres::scene::{Material, Ray, Scene};

/// A diamond reflects some 83 % from inside, so that paths of this length lose 1e-8 of the light.
const MOST_BOUNCES: usize = 100;
/// From here on paths end or split at random: weights of a compensated diamond multiply to 1000.
const ROULETTE: usize = 4;

/// Follows light backwards from the camera.
pub(crate) struct Tracer<'a, M> {
    pub(crate) scene: &'a Scene<M>,
    pub(crate) random: &'a mut Random,
}

impl<M: Material> Tracer<'_, M> {
    /// An estimate of the radiance that arrives along a ray from the camera.
    pub(crate) fn radiance(&mut self, ray: &Ray) -> Vec3 {
        self.arriving(ray, f32::INFINITY, Vec3::ONE, 0)
    }

    /// The radiance along a ray that was drawn with a density per steradian, infinite after a
    /// mirror, after bounces that left a `share` of the light.
    fn arriving(&mut self, ray: &Ray, pdf: f32, share: Vec3, bounces: usize) -> Vec3 {
        let sky = &self.scene.sky;
        let Some(hit) = self.scene.hit(ray) else {
            // The balance heuristic, pdf/(pdf + density of the lamps).
            let (radiance, of_lamps) = sky.seen(ray.direction);
            return radiance / (1.0 + of_lamps / pdf);
        };
        // BSDFs take directions in the tangent frame that point away from the surface.
        let v = hit.frame.transpose() * -ray.direction;
        let mut radiance = Vec3::ZERO;

        // Next-event estimation: directions towards the lamps, which the BSDF evaluates.
        for towards in sky.sample(self.random.two()) {
            let l = hit.frame.transpose() * towards;
            let (f, of_bsdf) = hit.bsdf.eval_pdf(v, l);
            let shadow = Ray { origin: hit.point, direction: towards };
            let (seen, of_lamps) = sky.seen(towards);
            // Rounding puts some directions just outside of the rim, where no lamp has a density,
            // and far from a highlight that of the BSDF is 0 in single precision too.
            let is_lit = f != [0.0; 3] && of_lamps > 0.0;
            if is_lit && !self.scene.is_shadowed(&shadow) {
                // f next to the horizon may be the largest number: the division comes first, to
                // keep it finite.
                radiance += Vec3::from(f) * (l.z.abs() / (of_lamps + of_bsdf)) * seen;
            }
        }

        // The next ray, drawn by the BSDF.
        let (choice, u) = (self.random.one(), self.random.two());
        let Some((next, pdf)) = hit.bsdf.sample_with_pdf(v, choice, u) else {
            return radiance;
        };
        if bounces == MOST_BOUNCES {
            return radiance;
        }
        let weight = Vec3::from(next.weight);
        let pdf = if next.delta { f32::INFINITY } else { pdf };
        let ray = Ray { origin: hit.point, direction: hit.frame * Vec3::from(next.l) };

        // A refraction scales radiance by 1/η² and takes no light from it.
        let share = share * weight * next.eta * next.eta;
        if bounces < ROULETTE {
            return radiance + weight * self.arriving(&ray, pdf, share, bounces + 1);
        }
        // On average `rays` go on, each with a share of 1.
        let rays = share.max_element();
        for _ in 0..(rays + self.random.one()) as usize {
            let one = self.arriving(&ray, pdf, share / rays, bounces + 1);
            radiance += weight / rays * one;
        }
        radiance
    }
}
