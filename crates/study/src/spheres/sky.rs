//! The light of the spheres: a sky with lamps, all of it from infinity.
//!
//! The spheres of `bench/src/paper/` are lit by it too. World coordinates are right-handed, y up.

use std::f32::consts::TAU;

use glam::Vec3;

/// A lamp at infinity: a disc of the sky.
struct Lamp {
    /// Of unit length.
    towards: Vec3,
    /// 1 − cos of its radius.
    height: f32,
    radiance: Vec3,
}

impl Lamp {
    /// A disc of this radius in degrees.
    fn new(towards: Vec3, degrees: f32, radiance: Vec3) -> Self {
        let height = 1.0 - degrees.to_radians().cos();
        Self { towards: towards.normalize(), height, radiance }
    }
}

/// A smooth sky, and lamps that a renderer samples; all light comes from infinity.
pub struct Sky {
    zenith: Vec3,
    horizon: Vec3,
    lamps: Vec<Lamp>,
}

impl Sky {
    /// The same light from everywhere: a white furnace.
    pub fn white() -> Self {
        Self { zenith: Vec3::ONE, horizon: Vec3::ONE, lamps: Vec::new() }
    }

    /// A white furnace as a lamp in all directions, whose light can be sampled.
    pub fn white_lamp() -> Self {
        let lamp = Lamp { towards: Vec3::Y, height: 2.0, radiance: Vec3::ONE };
        Self { zenith: Vec3::ZERO, horizon: Vec3::ZERO, lamps: vec![lamp] }
    }

    /// A studio: a large warm lamp in front, a cold one behind.
    pub fn studio() -> Self {
        Self {
            zenith: Vec3::new(0.28, 0.3, 0.35),
            horizon: Vec3::splat(0.55),
            lamps: vec![
                Lamp::new(Vec3::new(-0.6, 0.8, 0.65), 20.0, Vec3::new(7.0, 6.6, 5.8)),
                Lamp::new(Vec3::new(0.85, 0.45, -0.55), 20.0, Vec3::new(2.9, 3.3, 4.2)),
            ],
        }
    }

    /// One small lamp in a dark room, where the tail of a lobe stands out: it lights about as much
    /// as the large one of the studio, and is thousands of times as bright as the room.
    pub fn one_lamp() -> Self {
        let lamp = Lamp::new(Vec3::new(-0.45, 0.75, 0.75), 4.0, Vec3::splat(150.0));
        Self { zenith: Vec3::splat(0.02), horizon: Vec3::splat(0.03), lamps: vec![lamp] }
    }

    /// Radiance from a direction of unit length, and the sum of the densities per steradian there
    /// of the directions of [`sample`](Self::sample).
    pub fn seen(&self, direction: Vec3) -> (Vec3, f32) {
        let sky = self.horizon.lerp(self.zenith, direction.y.abs().sqrt());
        let seen = self.lamps.iter().filter(|at| 1.0 - at.towards.dot(direction) < at.height);
        seen.fold((sky, 0.0), |(radiance, pdf), lamp| {
            (radiance + lamp.radiance, pdf + 1.0 / (TAU * lamp.height))
        })
    }

    /// A direction towards each of the lamps, uniform over its disc, from one pair of random
    /// numbers.
    pub fn sample(&self, u: [f32; 2]) -> impl Iterator<Item = Vec3> {
        let (sin, cos) = (TAU * u[1]).sin_cos();
        self.lamps.iter().map(move |lamp| {
            let z = 1.0 - u[0] * lamp.height;
            let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
            let (a, b) = lamp.towards.any_orthonormal_pair();
            a * (r * cos) + b * (r * sin) + lamp.towards * z
        })
    }
}
