//! Times of the exported functions in relation to the crate's, measured in turns.

use std::f32::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use microfacet_sampler::{Ggx, Masking, MicrofacetDistribution, Tables};

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::foreign;

/// Prints the ratios of one shape, at σ = 0.5: of normals, of G1 and of the compensating
/// lobe, for which the crate prepares σ once.
pub fn print(tables: &Tables, shape: usize, gamma: f64) {
    if gamma == 2.0 {
        ratios(&Ggx::new(0.5).unwrap(), tables, shape, gamma);
    } else {
        ratios(&tables.student_t(0.5, gamma).unwrap(), tables, shape, gamma);
    }
}

/// Calls in a batch, and batches that each side gets, in turns.
const CALLS: usize = 4096;
const BATCHES: usize = 400;

fn ratios(lobe: &impl MicrofacetDistribution, tables: &Tables, shape: usize, gamma: f64) {
    let mut rng = StdRng::seed_from_u64(1);
    let mut uniform = || rng.random::<f32>();
    let view = |z: f32, turn: f32| {
        let (r, (sin, cos)) = ((1.0 - z * z).sqrt(), (TAU * turn).sin_cos());
        [r * cos, r * sin, z]
    };
    // Views evenly over the hemisphere.
    let v: Vec<[f32; 3]> = (0..CALLS).map(|_| view(uniform(), uniform())).collect();
    let u: Vec<[f32; 2]> = (0..CALLS).map(|_| [uniform(), uniform()]).collect();
    let (mut m, mut g1) = (vec![[0.0; 3]; CALLS], vec![0.0; CALLS]);
    let sigma = [0.5; 2];
    let albedo = tables.albedo(0.5, gamma, Masking::HeightCorrelated).unwrap();
    let l: Vec<[f32; 3]> = v.iter().rev().copied().collect();
    let mut times = [const { Vec::new() }; 6];
    for _ in 0..BATCHES {
        times[0].push(timed(|| foreign::sample(shape, sigma, &v, &u, black_box(&mut m))));
        times[1].push(timed(|| {
            for ((v, u), m) in v.iter().zip(&u).zip(black_box(&mut m)) {
                *m = lobe.sample_visible_normal(*v, *u);
            }
        }));
        times[2].push(timed(|| foreign::g1(shape, sigma, &v, black_box(&mut g1))));
        times[3].push(timed(|| {
            for (v, g1) in v.iter().zip(black_box(&mut g1)) {
                *g1 = lobe.g1(*v);
            }
        }));
        times[4].push(timed(|| foreign::compensation(shape, sigma, &v, &l, black_box(&mut g1))));
        times[5].push(timed(|| {
            for ((v, l), lobe) in v.iter().zip(&l).zip(black_box(&mut g1)) {
                *lobe = albedo.compensation(*v, *l);
            }
        }));
    }
    // The least time of each, which other programs disturb least.
    let least = |times: Vec<f64>| times.into_iter().fold(f64::INFINITY, f64::min);
    let [c, rust, c_g1, rust_g1, c_lobe, rust_lobe] = times.map(least);
    let (normal, masking, lobe) = (c / rust, c_g1 / rust_g1, c_lobe / rust_lobe);
    println!(
        "  gamma {gamma}: a normal {normal:.2} of the crate's time ({c:.1} to {rust:.1} ns), \
         G1 {masking:.2} ({c_g1:.1} to {rust_g1:.1} ns), \
         the compensating lobe {lobe:.2} ({c_lobe:.0} to {rust_lobe:.0} ns)",
    );
}

/// Nanoseconds a call.
fn timed(calls: impl FnOnce()) -> f64 {
    let start = Instant::now();
    calls();
    start.elapsed().as_secs_f64() * 1e9 / CALLS as f64
}
