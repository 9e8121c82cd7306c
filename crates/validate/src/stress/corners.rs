//! Values at which functions are likely to fail: ends of every axis, one ulp to either side, powers
//! of ten, subnormals, cell borders.

use std::f64::consts::{FRAC_PI_2, PI};

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_baker::table_spec::{GAMMA_MIN, GAMMA_WHOLE};
use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::Tables;

use super::Point;
use crate::configuration::{draw_shape, log_uniform, shapes};

/// Roughnesses, among them both ends of the allowed range.
const SIGMAS: [[f32; 2]; 16] = [
    [1e-8, 1e-8],
    [1e-6, 1e-6],
    [1e-4, 1e-4],
    [1e-3, 1e-3],
    [1e-2, 1e-2],
    [0.3, 0.3],
    [1.0, 1.0],
    [10.0, 10.0],
    [1e3, 1e3],
    [1e6, 1e6],
    [1e-4, 10.0],
    [10.0, 1e-4],
    [1e-8, 1e6],
    [1e6, 1e-8],
    [0.1, 0.2],
    [3.0, 0.01],
];

/// Every material at a corner of the tables' domain.
pub(super) fn corner_materials(tables: &Tables) -> Vec<([f32; 2], f64)> {
    let joints = [GAMMA_MIN, 1.6, GAMMA_WHOLE, 2.0, 4.0];
    let around = joints.into_iter().flat_map(|gamma| [gamma.next_down(), gamma, gamma.next_up()]);
    let single = [
        1.50101, 1.51, 1.9, 2.5, 3.0, 10.0, 60.0, 1e3, 1e4, 1e6, 1e8, 1e10, 1e14, 1e16, 1e17, 1e300,
    ];
    let near_two = [2.0 - 1e-9, 2.0 + 1e-9, 2.0 - 1e-7, 2.0 + 1e-7];
    // The ends of what the set covers, whatever they are.
    let ends = shapes(tables).into_iter().flatten().map(gamma_of_s);
    let ends = ends.flat_map(|gamma| [gamma.next_down(), gamma, gamma.next_up()]);
    let all = around.chain(single).chain(near_two).chain([f64::INFINITY]).chain(ends);
    let mut gammas: Vec<f64> = all.filter(|&gamma| is_tested(tables, gamma)).collect();
    gammas.sort_by(f64::total_cmp);
    gammas.dedup();
    gammas.into_iter().flat_map(|gamma| SIGMAS.map(|sigma| (sigma, gamma))).collect()
}

/// Whether a shape is tested: one of the tables, or GGX in closed form where [`shapes`] has it.
fn is_tested(tables: &Tables, gamma: f64) -> bool {
    tables.tabulates(gamma) || gamma == 2.0 && shapes(tables).contains(&[1.0; 2])
}

fn corner_thetas() -> Vec<f64> {
    let mut thetas = vec![0.0, 5e-324, 1e-300, 0.1, 0.5, PI / 4.0, 1.0, 1.3, 1.5];
    thetas.extend([FRAC_PI_2, FRAC_PI_2.next_down(), FRAC_PI_2.next_up()]);
    for exponent in [-38, -30, -20, -19, -18, -17, -15, -12, -10, -8, -7, -6, -5, -4, -3, -2] {
        let small = 10.0_f64.powi(exponent);
        thetas.push(small);
        // The horizon from above, and from below by at most the error of a rounded π/2.
        thetas.push(FRAC_PI_2 - small);
        if exponent <= -6 {
            thetas.push(FRAC_PI_2 + small);
        }
    }
    thetas.sort_by(f64::total_cmp);
    thetas.dedup();
    thetas
}

/// Numbers in [0, 1] where a lookup changes cells (17 and 33 nodes, t = (2 min(u, 1−u))^¼), halves
/// or exponents.
fn corner_numbers() -> Vec<f32> {
    let mut u = vec![0.0, 1.0, 0.5, 1e-45, f32::MIN_POSITIVE, 0.25, 0.1, 0.9];
    u.extend([1e-30, 1e-20, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3]);
    for cells in [16, 32] {
        for cell in [1, 2, cells / 2, cells - 1] {
            let border = 0.5 * (cell as f32 / cells as f32).powi(4);
            u.extend([border, 1.0 - border]);
        }
    }
    let neighbours: Vec<f32> = u.iter().flat_map(|u| [u.next_down(), u.next_up()]).collect();
    u.extend(neighbours);
    u.retain(|u| (0.0..=1.0).contains(u));
    u.sort_by(f32::total_cmp);
    u.dedup();
    u
}

/// Corner views of a material, each with some of the corner pairs of random numbers; `turn` rotates
/// which.
///
/// At each view `u[0]` ascends, as the check of monotonicity requires.
pub(super) fn corner_points(sigma: [f32; 2], gamma: f64, turn: usize) -> Vec<Vec<Point>> {
    let (thetas, numbers) = (corner_thetas(), corner_numbers());
    let azimuths = [0.0, FRAC_PI_2, PI / 4.0, -2.0, 1e-10];
    let views = thetas.iter().flat_map(|&theta| azimuths.map(|phi| (theta, phi)));
    views
        .enumerate()
        .map(|(i, (theta, phi))| {
            let turn = turn * 5 + i;
            let u2 = numbers[turn % numbers.len()];
            let u1 = numbers.iter().skip(turn % 9).step_by(9);
            u1.map(|&u1| Point { sigma, gamma, theta, phi, u: [u1, u2] }).collect()
        })
        .collect()
}

/// The random number generator of the `i`th random material.
pub(super) fn numbers(seed: u64, i: u64) -> StdRng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&i.to_le_bytes());
    StdRng::from_seed(key)
}

/// A material that the tables cover: s evenly over `shapes`, or γ close to 3/2, to 2 or to ∞ where
/// they cover that; σ over the whole allowed range.
pub(super) fn random_material(
    tables: &Tables,
    shapes: &[[f64; 2]],
    random: &mut StdRng,
) -> ([f32; 2], f64) {
    let gamma = match random.random_range(0..8) {
        0 => 1.5 + log_uniform(random, 1e-3, 0.3),
        1 => 2.0 + log_uniform(random, 1e-12, 0.1) * if random.random() { 1.0 } else { -1.0 },
        2 => log_uniform(random, 4.0, 1e18),
        3 => [2.0, f64::INFINITY][random.random_range(0..2)],
        _ => f64::NAN,
    };
    let drawn = gamma_of_s(draw_shape(shapes, random));
    let gamma = if is_tested(tables, gamma) { gamma } else { drawn };
    let wide = random.random_range(0..4) == 0;
    let mut sigma =
        || if wide { log_uniform(random, 1e-8, 1e6) } else { log_uniform(random, 1e-4, 10.0) } as f32;
    let x = sigma();
    ([x, if gamma.to_bits() & 1 == 0 { x } else { sigma() }], gamma)
}

/// Random views, each with ascending `u[0]`, one number in four within 1e-9 … 1e-2 of an end.
pub(super) fn random_points(
    sigma: [f32; 2],
    gamma: f64,
    count: u64,
    random: &mut StdRng,
) -> Vec<Vec<Point>> {
    const PER_VIEW: u64 = 16;
    let number = |random: &mut StdRng| match random.random_range(0..8) {
        0 => log_uniform(random, 1e-12, 1e-2) as f32,
        1 => 1.0 - log_uniform(random, 1e-8, 1e-2) as f32,
        _ => random.random(),
    };
    (0..count.div_ceil(PER_VIEW))
        .map(|_| {
            let theta = match random.random_range(0..8) {
                0 => log_uniform(random, 1e-12, 1e-1),
                1 => FRAC_PI_2 - log_uniform(random, 1e-12, 1e-1),
                2 => FRAC_PI_2 - random.random_range(-1e-6..1e-6),
                _ => random.random_range(0.0..FRAC_PI_2),
            };
            let phi = random.random_range(-PI..PI);
            let mut u1: Vec<f32> = (0..PER_VIEW).map(|_| number(random)).collect();
            u1.sort_by(f32::total_cmp);
            let u2 = number(random);
            u1.into_iter().map(|u1| Point { sigma, gamma, theta, phi, u: [u1, u2] }).collect()
        })
        .collect()
}
