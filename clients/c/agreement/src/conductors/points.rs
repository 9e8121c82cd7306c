//! Conductors, views and lights that are compared, and what C has for them.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub sigma: [f32; 2],
    pub v: [f32; 3],
    pub l: [f32; 3],
    pub choice: f32,
    pub u: [f32; 2],
    pub a: [f32; 3],
    pub b: [f32; 3],
    pub form: i32,
    pub masking: i32,
    pub compensation: i32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Answer {
    pub event: i32,
    pub is_delta: i32,
    pub light: [f32; 3],
    pub normal: [f32; 3],
    pub weight: [f32; 3],
    pub pdf: f32,
    pub eta: f32,
    pub f: [f32; 3],
    pub density: f32,
    pub sampled_f: [f32; 3],
    pub sampled_density: f32,
    pub average: [f32; 3],
}

/// Random points, sixty a roughness.
pub fn random(count: usize, seed: u64) -> Vec<Vec<Point>> {
    let mut rng = StdRng::seed_from_u64(1000 + seed);
    let mut between = move |low: f32, high: f32| low + (high - low) * rng.random::<f32>();
    let mut groups = Vec::new();
    for i in 0..count.div_ceil(60) {
        let ends = if i % 4 == 0 { [-8.0, 6.0] } else { [-2.5, 0.5] };
        let mut sigma = || 10.0_f32.powf(between(ends[0], ends[1]));
        let (x, y) = (sigma(), sigma());
        let sigma = if i % 3 == 0 { [x, y] } else { [x, x] };
        let points = (0..60).map(|k: usize| {
            let mut direction = |k: usize| {
                let near = 10.0_f32.powf(between(-5.0, -1.0));
                let z = [between(0.0, 1.0), near, between(0.0, 1.0), 1.0 - near][k % 4];
                let (sin, cos) = between(0.0, std::f32::consts::TAU).sin_cos();
                let r = ((1.0 - z) * (1.0 + z)).sqrt();
                [r * cos, r * sin, z]
            };
            let (v, l) = (direction(k), direction(k / 4));
            let form = k % 3;
            let mut three = |low: f32, high: f32| [0; 3].map(|_| between(low, high));
            let [a, b] =
                if form == 2 { [three(0.05, 4.0), three(0.0, 8.0)] } else { [three(0.0, 1.0); 2] };
            let b = if form == 1 { three(0.0, 1.0) } else { b };
            Point {
                sigma,
                v,
                l,
                a,
                b,
                choice: between(0.0, 1.0),
                u: [between(0.0, 1.0), between(0.0, 1.0)],
                form: form as i32,
                masking: (k / 3 % 2) as i32,
                compensation: (k / 6 % 3) as i32,
            }
        });
        groups.push(points.collect());
    }
    groups
}

/// Special roughnesses, directions and numbers.
pub fn corners() -> Vec<Vec<Point>> {
    const NAN: f32 = f32::NAN;
    let sigmas = [0.0, 1e-8, 5e-4, 0.01, 0.3, 3.0, 1e6].map(|sigma| [sigma; 2]);
    let at = |z: f32| [0.6 * (1.0 - z * z).sqrt(), -0.8 * (1.0 - z * z).sqrt(), z];
    let directions = [
        [0.0, 0.0, 1.0],
        at(1e-6),
        at(0.3),
        at(0.0),
        at(-0.3),
        [0.0, 0.0, -1.0],
        [NAN, 0.0, 0.5],
        [0.0, 0.6, NAN],
        [NAN; 3],
        [f32::INFINITY, 0.0, 0.5],
        [0.0; 3],
    ];
    let numbers = [0.0, 1.0, 0.4, NAN, -1.0, 2.0];
    let group = |sigma: [f32; 2]| {
        let mut points = Vec::new();
        for (i, v) in directions.into_iter().enumerate() {
            for (j, l) in directions.into_iter().enumerate() {
                for (k, choice) in numbers.into_iter().enumerate() {
                    for form in 0..3 {
                        let turn = i + j + k + form as usize;
                        let u = [numbers[(turn + j) % 6], numbers[(turn / 2 + k) % 6]];
                        let [a, b] = [[0.0, 0.5, 1.0], [1.0, 0.5, 0.0]];
                        let a = if form == 2 { [2e-6, 1.0, 1.5] } else { a };
                        let (masking, compensation) = (turn as i32 % 2, (i + k) as i32 % 3);
                        points.push(Point {
                            sigma,
                            v,
                            l,
                            choice,
                            u,
                            a,
                            b,
                            form,
                            masking,
                            compensation,
                        });
                    }
                }
            }
        }
        points
    };
    sigmas.map(group).into()
}
