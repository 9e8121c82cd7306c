//! A sphere of a material in the studio, as the page draws it, by the sampler's BSDFs. Random
//! numbers and estimators are those of `sphere.frag`.

use glam::{Mat3, Vec3};
use microfacet_sampler::lobe::Reflecting;
use microfacet_sampler::{
    BindError, Bsdf, BsdfSettings, Compensation, Conductor, ConductorFresnel, Lobe, Masking,
    StandIn, Tables, Transport,
};
use rayon::prelude::*;

use super::random::{COUNT, numbers};
use super::studio::{Studio, by_cosine, cosine_pdf};
use super::tone::display;

/// How a sphere looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Shape γ.
    pub gamma: f64,
    /// The shape that normals are drawn from, of the same or heavier tails.
    pub drawn: f64,
    /// σx along the parallels, σy along the meridians.
    pub sigma: [f64; 2],
    /// The reflectance of its facets.
    pub fresnel: ConductorFresnel,
    /// Whether the light of further bounces is added (Kulla–Conty); for a lobe that is not round,
    /// that of the round lobe of √(σx σy).
    pub compensated: bool,
}

/// Size and sampling of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Pixels along its edges.
    pub size: u32,
    /// Samples of a pixel.
    pub samples: u32,
    /// Seed of the random numbers.
    pub seed: u32,
}

/// A material in the studio, with the lobe that normals are drawn from.
pub(super) struct Scene {
    studio: Studio,
    bsdf: Conductor<Lobe>,
    drawn: Lobe,
    compensated: bool,
}

impl Scene {
    /// `tables` are those of a set, and of the default set where the set lacks them.
    ///
    /// # Errors
    /// [`BindError`] for a shape that the tables do not cover.
    pub(super) fn new(tables: &Tables, look: &Look) -> Result<Self, BindError> {
        let lobe = tables.lobe(look.sigma, look.gamma)?;
        let compensation =
            if look.compensated { Compensation::KullaConty } else { Compensation::None };
        let settings =
            BsdfSettings::new().compensated(compensation, tables).with_stand_in(StandIn::Round);
        let bsdf = Conductor::new(lobe, look.fresnel, settings)?;
        let drawn = tables.lobe(look.sigma, look.drawn)?;
        Ok(Self { studio: Studio::new(), bsdf, drawn, compensated: look.compensated })
    }

    fn pixel(&self, at: [u32; 2], film: Film) -> Vec3 {
        let sum: Vec3 = (0..film.samples).map(|i| self.sample(at, i, film)).sum();
        sum / film.samples as f32
    }

    fn sample(&self, [x, y]: [u32; 2], index: u32, film: Film) -> Vec3 {
        let u = numbers([x, y], film.seed, index);
        let at = |pixel: u32, u: f32| 2.0 * (pixel as f32 + 0.5 + tent(u)) / film.size as f32 - 1.0;
        let (origin, d) = self.studio.ray(at(x, u[0]), at(y, u[1]));
        let half = origin.dot(d);
        let nearest = origin - half * d;
        let square = 1.0 - nearest.dot(nearest);
        if !(square > 0.0) {
            return self.studio.radiance(origin, d, false);
        }
        let n = (nearest - square.sqrt() * d).normalize();
        self.shade(n, d, &u)
    }

    /// The light reflected towards the camera at a point of the sphere with normal `n`, seen along
    /// `d`. Lights are drawn by visible normals, by each lamp and, with compensation, by the
    /// cosine, one each, and combined by the balance heuristic (Veach 1997, section 9.2).
    fn shade(&self, n: Vec3, d: Vec3, u: &[f32; COUNT]) -> Vec3 {
        let frame = tangent_frame(n);
        let to_tangent = frame.transpose();
        let v = to_tangent * -d;
        let drawn = self.drawn.sample_reflected(v, [u[2], u[3]], Masking::HeightCorrelated);
        let mut lights = Vec::from_iter(drawn.map(|(l, _)| Vec3::from(l)));
        lights.extend(self.studio.sample([u[4], u[5]]).map(|towards| to_tangent * towards));
        if self.compensated {
            lights.push(by_cosine([u[6], u[7]]));
        }
        lights.into_iter().map(|l| self.share(n, &frame, v, l)).sum()
    }

    /// The contribution of a light, however it was drawn: f cos L over the sum of all densities.
    fn share(&self, n: Vec3, frame: &Mat3, v: Vec3, l: Vec3) -> Vec3 {
        if !(v.z > 0.0 && l.z > 0.0) {
            return Vec3::ZERO;
        }
        let towards = *frame * l;
        let (_, drawn) = self.drawn.eval_pdf(v, l, Masking::HeightCorrelated);
        let mut pdf = drawn + self.studio.pdf(towards);
        if self.compensated {
            pdf += cosine_pdf(l);
        }
        if !(pdf > 0.0) {
            return Vec3::ZERO;
        }
        let f = self.bsdf.eval(v, l, Transport::Radiance);
        Vec3::from(f) * (l.z / pdf) * self.studio.radiance(n, towards, true)
    }

    pub(super) fn picture(&self, film: Film) -> Vec<[u8; 3]> {
        let size = film.size;
        let pixel = |i: u32| display(self.pixel([i % size, size - 1 - i / size], film));
        (0..size * size).into_par_iter().map(pixel).collect()
    }
}

/// The tangent frame at a normal of a sphere, as columns: x along the parallels, y along the
/// meridians, z the normal.
pub fn tangent_frame(n: Vec3) -> Mat3 {
    let x = Vec3::Y.cross(n).normalize_or(Vec3::X);
    Mat3::from_cols(x, n.cross(x), n)
}

/// An offset from the middle of a pixel, distributed as a tent two pixels wide.
fn tent(u: f32) -> f32 {
    let t = 2.0 * u - 1.0;
    (1.0 - (1.0 - t.abs()).sqrt()).copysign(t)
}
