//! The points of comparison: random points of every material, and corners.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::lookup::Point;

/// The smallest cosine of a sampled normal. Below it the crate's D leaves single precision.
const LOWEST: f32 = 1e-18;

/// Points of one roughness.
pub struct Group {
    pub name: &'static str,
    pub points: Vec<Point>,
}

/// `count` random points, a hundred a roughness: half of the roughnesses round, over all of their
/// range.
pub fn random(count: usize, seed: u64) -> Vec<Group> {
    const EACH: usize = 100;
    let mut rng = StdRng::seed_from_u64(seed);
    let mut between = move |low: f32, high: f32| low + (high - low) * rng.random::<f32>();
    let mut groups = Vec::new();
    for i in 0..count.div_ceil(EACH) {
        // Every fourth roughness is from the whole range, the others are of common materials.
        let ends = if i % 4 == 0 { [-8.0, 6.0] } else { [-3.0, 0.5] };
        let mut sigma = || 10.0_f32.powf(between(ends[0], ends[1]));
        let (x, y) = (sigma(), sigma());
        let sigma = if i % 2 == 0 { [x, x] } else { [x, y] };
        let points = (0..EACH).map(|k| {
            // Evenly over the hemisphere, and as many close to the horizon or the normal.
            let mut direction = |k: usize| {
                let near = 10.0_f32.powf(between(if k % 8 == 1 { -30.0 } else { -7.0 }, -1.0));
                let z = [between(0.0, 1.0), near, between(0.0, 1.0), 1.0 - near][k % 4];
                let (sin, cos) = between(0.0, std::f32::consts::TAU).sin_cos();
                let r = ((1.0 - z) * (1.0 + z)).sqrt();
                Vec3::new(r * cos, r * sin, z)
            };
            let (v, l) = (direction(k), direction(k / 4));
            let mut m = if k % 3 == 0 { direction(k) } else { (v + l).normalize() };
            m.z = m.z.max(LOWEST);
            // Every fifth number in a tail.
            let mut number = |k: usize| match k % 10 {
                0 => 10.0_f32.powf(between(-9.0, -1.0)),
                5 => 1.0 - 10.0_f32.powf(between(-7.0, -1.0)),
                _ => between(0.0, 1.0),
            };
            let u = [number(k), number(k / 10)];
            Point { sigma, v: v.into(), l: l.into(), m: m.into(), u }
        });
        groups.push(Group { name: "random", points: points.collect() });
    }
    groups
}

/// All combinations of special roughnesses, views and pairs of numbers.
pub fn corners() -> Vec<Group> {
    const NAN: f32 = f32::NAN;
    let sigmas = [
        [1e-8, 1e-8],
        [1e6, 1e6],
        [1e-8, 1e6],
        [1e6, 1e-8],
        [1e-3, 1e-3],
        [0.3, 0.3],
        [0.1, 2.0],
        [3.0, 3.0],
        // Clamped to an end of the range, or taken for a mirror.
        [0.0, 0.3],
        [-1.0, -1.0],
        [1e-30, 1e-30],
        [1e7, 1e7],
        [NAN, 0.3],
    ];
    let tilted = |z: f32| [0.6 * (1.0 - z * z).sqrt(), -0.8 * (1.0 - z * z).sqrt(), z];
    let directions = [
        [0.0, 0.0, 1.0],
        [1e-20, -1e-20, 1.0],
        [1e-7, 1e-9, 1.0],
        tilted(0.999_999_9),
        tilted(0.5),
        tilted(1e-3),
        tilted(1e-8),
        tilted(1e-30),
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        tilted(-1e-8),
        tilted(-0.5),
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1e-30],
        [NAN, 0.0, 1.0],
        [NAN, 0.98, 5e-28],
        [0.6, 0.0, NAN],
        [NAN; 3],
    ];
    let below_one = 1.0 - f32::EPSILON / 2.0;
    let numbers = [0.0, 1e-30, 1e-7, 0.25, 0.5, 0.5 + f32::EPSILON, below_one, 1.0, -1.0, 2.0, NAN];
    let mut groups = Vec::new();
    for sigma in sigmas {
        let mut points = Vec::new();
        for (i, v) in directions.into_iter().enumerate() {
            for (j, &a) in numbers.iter().enumerate() {
                for (k, &b) in numbers.iter().enumerate() {
                    let l = directions[(i + j) % directions.len()];
                    let mut m = directions[(i + j + k) % directions.len()];
                    if m[2] > 0.0 {
                        m[2] = m[2].max(LOWEST);
                    }
                    points.push(Point { sigma, v, l, m, u: [a, b] });
                }
            }
        }
        groups.push(Group { name: "corner", points });
    }
    groups
}
