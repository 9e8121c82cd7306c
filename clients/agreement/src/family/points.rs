//! Hits at which a family is compared: random ones, and corners.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::Hit;

/// Whether a number of a hit is NaN.
pub(super) fn has_nan(hit: &Hit) -> bool {
    bytemuck::cast_slice::<_, f32>(std::slice::from_ref(hit)).iter().any(|x| x.is_nan())
}

pub(super) fn random(count: usize) -> Vec<Hit> {
    let mut rng = StdRng::seed_from_u64(7);
    let mut between = move |low: f32, high: f32| low + (high - low) * rng.random::<f32>();
    let one = |i: usize| {
        let ends = if i.is_multiple_of(4) { [-8.0, 6.0] } else { [-3.0, 0.5] };
        let x = 10.0_f32.powf(between(ends[0], ends[1]));
        let y = if i.is_multiple_of(2) { x } else { 10.0_f32.powf(between(ends[0], ends[1])) };
        let gamma = match i % 8 {
            0 => f32::INFINITY,
            1 => between(1.501, 1.8),
            _ => 1.5 + 0.001 * 10.0_f32.powf(between(0.0, 5.0)),
        };
        let mut direction = |k: usize| {
            let near = 10.0_f32.powf(between(-7.0, -1.0));
            let z = [between(0.0, 1.0), near, between(0.0, 1.0), 1.0 - near][k % 4];
            let (sin, cos) = between(0.0, std::f32::consts::TAU).sin_cos();
            let r = ((1.0 - z) * (1.0 + z)).sqrt();
            [r * cos, r * sin, z]
        };
        let (v, l) = (direction(i / 8), direction(i / 32));
        let m = if i.is_multiple_of(3) {
            direction(i)
        } else {
            let sum = [0, 1, 2].map(|k| v[k] + l[k]);
            let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
            sum.map(|x| x / length)
        };
        let mut number = |k: usize| match k % 10 {
            0 => 10.0_f32.powf(between(-9.0, -1.0)),
            5 => 1.0 - 10.0_f32.powf(between(-7.0, -1.0)),
            _ => between(0.0, 1.0),
        };
        Hit { gamma, sigma: [x, y], v, l, m, u: [number(i), number(i / 10)] }
    };
    (0..count).map(one).collect()
}

pub(super) fn corners() -> Vec<Hit> {
    const NAN: f32 = f32::NAN;
    let (inf, huge) = (f32::INFINITY, f32::MAX);
    let gammas = [
        1.501,
        1.500_999,
        1.55,
        1.799_999_9,
        1.8,
        1.800_000_1,
        2.0,
        3.0,
        15.0,
        1e9,
        1e19,
        huge,
        inf,
        1.5,
        1.0,
        0.0,
        -1.0,
        -inf,
        NAN,
    ];
    let sigmas = [
        [1e-8, 1e-8],
        [1e6, 1e6],
        [1e-8, 1e6],
        [0.3, 0.3],
        [0.1, 2.0],
        [1e-3, 1e-3],
        [0.0, 0.3],
        [-1.0, 0.2],
        [1e-30, 1e-30],
        [1e9, inf],
        [NAN, 0.3],
    ];
    let r = |z: f32| (1.0 - z * z).sqrt();
    let directions = [
        [0.0, 0.0, 1.0],
        [1e-7, 1e-9, 1.0],
        [0.6 * r(0.5), -0.8 * r(0.5), 0.5],
        [0.6, -0.8, 1e-8],
        [0.6, -0.8, 1e-30],
        [1.0, 0.0, 0.0],
        [0.6, 0.0, -0.8],
        [0.0, 0.0, -1.0],
        [0.0; 3],
        [NAN, 0.0, 1.0],
        [0.6, 0.0, NAN],
        [NAN; 3],
    ];
    let numbers = [0.0, 1e-30, 0.25, 0.5, 1.0 - f32::EPSILON / 2.0, 1.0, -1.0, 2.0, NAN];
    let mut hits = Vec::new();
    for gamma in gammas {
        for sigma in sigmas {
            for (i, v) in directions.into_iter().enumerate() {
                for (j, a) in numbers.into_iter().enumerate() {
                    let l = directions[(i + j) % directions.len()];
                    let mut m = directions[(i + 2 * j + 1) % directions.len()];
                    if m[2] > 0.0 {
                        m[2] = m[2].max(1e-18);
                    }
                    let u = [a, numbers[(i + j) % numbers.len()]];
                    hits.push(Hit { gamma, sigma, v, l, m, u });
                }
            }
        }
    }
    hits
}
