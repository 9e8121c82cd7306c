//! What surrounds a material: a sphere of it on a floor, under a sky.
//!
//! World coordinates are right-handed, y up. The sphere has radius 1 about the origin.

use glam::{Mat3, Vec3};

use microfacet_report::tangent_frame;
use microfacet_sampler::lobe::Smooth;
use microfacet_sampler::{AnyBsdf, BindError, Bsdf, BsdfSample, BsdfSettings, Plastic, Transport};

use crate::spheres::sky::Sky;

const FLOOR: f32 = -1.0;
/// Edge of the floor's squares: large enough to be seen through rough diamond. Four meet under the
/// sphere.
const SQUARE: f32 = 2.0;
/// The least distance of a hit: rays start on a surface, to the rounding of this scene's
/// coordinates.
const NEAREST: f32 = 1e-4;

pub(crate) struct Ray {
    pub(crate) origin: Vec3,
    /// Of unit length.
    pub(crate) direction: Vec3,
}

pub(crate) struct Hit<'a, B> {
    pub(crate) point: Vec3,
    /// Tangent, bitangent and normal as columns: from the tangent frame to the world.
    pub(crate) frame: Mat3,
    pub(crate) bsdf: HitBsdf<'a, B>,
}

/// The BSDF of a hit: one that is kept, or one that was made for it of textures.
pub(crate) enum HitBsdf<'a, B> {
    Kept(&'a AnyBsdf),
    Made(B),
}

impl<B: Bsdf> HitBsdf<'_, B> {
    pub(crate) fn eval_pdf(&self, v: Vec3, l: Vec3) -> ([f32; 3], f32) {
        match self {
            Self::Kept(bsdf) => bsdf.eval_pdf(v, l, Transport::Radiance),
            Self::Made(bsdf) => bsdf.eval_pdf(v, l, Transport::Radiance),
        }
    }

    pub(crate) fn sample_with_pdf(
        &self,
        v: Vec3,
        choice: f32,
        u: [f32; 2],
    ) -> Option<(BsdfSample, f32)> {
        match self {
            Self::Kept(bsdf) => bsdf.sample_with_pdf(v, choice, u, Transport::Radiance),
            Self::Made(bsdf) => bsdf.sample_with_pdf(v, choice, u, Transport::Radiance),
        }
    }
}

/// What a sphere is made of.
pub(crate) trait Material: Sync {
    /// A BSDF that is made at a hit.
    type Made<'a>: Bsdf
    where
        Self: 'a;

    /// The BSDF at a point of the unit sphere.
    fn at(&self, point: Vec3) -> HitBsdf<'_, Self::Made<'_>>;
}

impl Material for AnyBsdf {
    type Made<'a> = Self;

    fn at(&self, _point: Vec3) -> HitBsdf<'_, Self> {
        HitBsdf::Kept(self)
    }
}

/// A sphere of a material, and what lights it.
pub(crate) struct Scene<M = AnyBsdf> {
    pub(crate) material: M,
    /// Under the sphere, if it lies on one.
    pub(crate) floor: Option<Floor>,
    pub(crate) sky: Sky,
}

impl<M: Material> Scene<M> {
    pub(crate) fn hit(&self, ray: &Ray) -> Option<Hit<'_, M::Made<'_>>> {
        let Ray { origin, direction } = *ray;
        if let Some(t) = sphere(ray) {
            let n = (origin + t * direction).normalize();
            // Brushed round the vertical axis.
            return Some(Hit { point: n, frame: tangent_frame(n), bsdf: self.material.at(n) });
        }
        let floor = self.floor.as_ref()?;
        let t = (FLOOR - origin.y) / direction.y;
        if !(NEAREST..f32::INFINITY).contains(&t) {
            return None;
        }
        let point = origin + t * direction;
        let square = (point.x / SQUARE).floor() + (point.z / SQUARE).floor();
        let bsdf = HitBsdf::Kept(&floor.0[square.rem_euclid(2.0) as usize]);
        Some(Hit { point, frame: Mat3::from_cols(Vec3::X, -Vec3::Z, Vec3::Y), bsdf })
    }

    /// Whether the sphere is in the way of light from the sky; nothing reaches below the floor.
    pub(crate) fn is_shadowed(&self, ray: &Ray) -> bool {
        sphere(ray).is_some()
    }
}

fn sphere(ray: &Ray) -> Option<f32> {
    let half = ray.origin.dot(ray.direction);
    let discriminant = half * half - ray.origin.length_squared() + 1.0;
    let root = discriminant.max(0.0).sqrt();
    [-half - root, -half + root].into_iter().find(|t| discriminant > 0.0 && *t > NEAREST)
}

/// The squares of a floor, of two kinds.
pub(crate) struct Floor([AnyBsdf; 2]);

pub(crate) const GREY: [[f32; 3]; 2] = [[0.07, 0.075, 0.085], [0.7, 0.67, 0.62]];
/// Shows what a diamond refracts.
pub(crate) const COLOURED: [[f32; 3]; 2] = [[0.03, 0.13, 0.45], [0.85, 0.42, 0.08]];

impl Floor {
    pub(crate) fn new([one, other]: [[f32; 3]; 2]) -> Result<Self, BindError> {
        // A coat of index 1 leaves the Lambert base alone.
        let square = |base| Plastic::new(Smooth.into(), 1.0, base, BsdfSettings::new());
        Ok(Self([square(one)?.into(), square(other)?.into()]))
    }
}
