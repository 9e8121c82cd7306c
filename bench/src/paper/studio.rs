//! A minimal renderer: a sphere of rough metal in a studio, lit directly, with any computation of
//! G1.
//!
//! At a hit it draws one light by visible normals and one towards each lamp, and combines them by
//! multiple importance sampling (Veach 1997, *Robust Monte Carlo Methods for Light Transport
//! Simulation*, section 9.2). A sphere does not shadow itself, so that only light of further
//! bounces is lost. G2 = G1(v) G1(l), as in Ribardière et al. 2017 (doi:10.1111/cgf.13137).
//!
//! World coordinates are right-handed, y up. The sphere has radius 1 about the origin.

use glam::{DVec3, Mat3, Vec3};
use microfacet_report::tangent_frame;
use microfacet_sampler::MicrofacetDistribution as _;
use microfacet_sampler::{ConductorFresnel, StudentT};
use microfacet_study::spheres::sky::Sky;

use crate::settings::Film;

/// The camera looks down by this many radians, from far away.
const ELEVATION: f32 = 0.45;
/// Half the edge of the picture.
const REACH: f32 = 1.05;

/// A rough metal whose visible normals are drawn from tables, with its own computation of G1.
pub(crate) struct Metal<G> {
    lobe: StudentT,
    g1: G,
    fresnel: ConductorFresnel,
}

impl<G: Fn(Vec3) -> f32> Metal<G> {
    pub(crate) fn new(lobe: StudentT, g1: G, fresnel: ConductorFresnel) -> Self {
        Self { lobe, g1, fresnel }
    }

    /// An estimate of the radiance that leaves a point of a frame towards a view in that frame.
    fn radiance(
        &self,
        sky: &Sky,
        frame: &Mat3,
        v: Vec3,
        [of_light, of_lamp]: [[f32; 2]; 2],
    ) -> Vec3 {
        if !(v.z > 0.0) {
            return Vec3::ZERO;
        }
        // Normals are drawn with G1 of the tables, whatever G1 the metal has.
        let drawn = self.lobe.g1(v);
        let share = (self.g1)(v) / drawn;
        // The estimate at a light and its half vector does not depend on how they were drawn.
        let estimate = |l: Vec3, m: Vec3| {
            let (radiance, of_lamps) = sky.seen(*frame * l);
            let density = self.lobe.d(m) * drawn / (4.0 * v.z);
            // D may underflow to 0, and of_lamps/density would be 0/0 without a lamp.
            if !(density > 0.0) {
                return Vec3::ZERO;
            }
            let weight = share * (self.g1)(l) / (1.0 + of_lamps / density);
            Vec3::from(self.fresnel.at(v.dot(m))) * radiance * weight
        };
        let m = Vec3::from(self.lobe.sample_visible_normal(v, of_light));
        let l = 2.0 * v.dot(m) * m - v;
        let mut sum = if l.z > 0.0 { estimate(l, m) } else { Vec3::ZERO };
        for towards in sky.sample(of_lamp) {
            let l = frame.transpose() * towards;
            if l.z > 0.0 {
                sum += estimate(l, (v + l).normalize());
            }
        }
        sum
    }
}

impl Film {
    /// Where a point of the film, in pixels from its upper left corner, meets the sphere, as
    /// coordinates to the right, up and towards the camera.
    fn hit(self, [x, y]: [f32; 2]) -> Option<Vec3> {
        let scale = 2.0 * REACH / self.edge as f32;
        let (x, y) = (scale * x - REACH, REACH - scale * y);
        let square = 1.0 - x * x - y * y;
        (square > 0.0).then(|| Vec3::new(x, y, square.sqrt()))
    }

    /// Whether the middle of a pixel shows the sphere.
    pub(crate) fn is_covered(self, [x, y]: [usize; 2]) -> bool {
        self.hit([x as f32 + 0.5, y as f32 + 0.5]).is_some()
    }

    /// The mean radiance of the pixels of a line; black outside the sphere. Random numbers depend
    /// on the pixel and the seed alone, so that two metals get the same.
    pub(crate) fn line<G: Fn(Vec3) -> f32>(
        self,
        y: usize,
        metal: &Metal<G>,
        sky: &Sky,
        seed: u32,
    ) -> impl Iterator<Item = DVec3> {
        let (sin, cos) = ELEVATION.sin_cos();
        let camera = Mat3::from_cols(Vec3::X, Vec3::new(0.0, cos, -sin), Vec3::new(0.0, sin, cos));
        (0..self.edge).map(move |x| {
            // The golden ratio spreads the seeds of neighbouring pixels.
            let pixel = (y * self.edge + x) as u32 ^ seed.rotate_left(16);
            let pixel = pixel.wrapping_mul(0x9e37_79b9);
            let sample = |index: usize| {
                let [a, b, c, d] = sobol_burley::sample_4d(index as u32, 0, pixel);
                let [e, f, ..] = sobol_burley::sample_4d(index as u32, 1, pixel);
                let Some(hit) = self.hit([x as f32 + a, y as f32 + b]) else {
                    return DVec3::ZERO;
                };
                let n = camera * hit;
                let frame = tangent_frame(n);
                let v = frame.transpose() * camera.z_axis;
                metal.radiance(sky, &frame, v, [[c, d], [e, f]]).as_dvec3()
            };
            (0..self.samples).map(sample).sum::<DVec3>() / self.samples as f64
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use microfacet_sampler::{Masking, Tables};

    use super::*;

    /// A parallel camera sees the disc of a sphere evenly, so that in a white furnace the mean over
    /// the disc is the cosine-weighted average of the albedo, whether the sky is white or a lamp.
    #[test]
    fn a_mirror_in_a_white_furnace_shows_its_average_albedo() {
        let (tables, film) = (Tables::embedded(), Film { edge: 40, samples: 64 });
        let furnaces = [Sky::white(), Sky::white_lamp()];
        for (sigma, gamma) in [(0.3, 1.51), (0.1, 1.65), (0.3, 2.0), (1.0, 50.0)] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let albedo = tables.albedo(sigma, gamma, Masking::Uncorrelated).unwrap();
            let average = f64::from(albedo.albedo_average());
            let g1 = lobe.clone();
            let mirror = Metal::new(lobe, |w| g1.g1(w), ConductorFresnel::mirror());
            for sky in &furnaces {
                let sum: f64 = (0..film.edge)
                    .flat_map(|y| film.line(y, &mirror, sky, 1))
                    .map(|radiance| radiance.x)
                    .sum();
                let area = PI / f64::from(2.0 * REACH).powi(2);
                let shown = sum / (film.edge * film.edge) as f64 / area;
                assert!((shown - average).abs() < 0.012, "{sigma} {gamma}: {shown} for {average}");
            }
        }
    }

    /// Radiance is proportional to both G1: half of each leaves a quarter, while normals are drawn
    /// as before.
    #[test]
    fn a_picture_follows_its_own_form_of_masking() {
        let (tables, film, sky) =
            (Tables::embedded(), Film { edge: 12, samples: 8 }, Sky::studio());
        let lobe = tables.student_t(0.5, 3.0).unwrap();
        let line = |share: f32| {
            let g1 = lobe.clone();
            let metal =
                Metal::new(lobe.clone(), move |w| share * g1.g1(w), ConductorFresnel::mirror());
            film.line(6, &metal, &sky, 1).collect::<Vec<_>>()
        };
        for (whole, quarter) in line(1.0).into_iter().zip(line(0.5)) {
            assert!((0.25 * whole - quarter).abs().max_element() < 1e-6, "{whole} {quarter}");
        }
        assert!(line(1.0)[6].min_element() > 0.1);
    }
}
