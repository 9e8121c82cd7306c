//! The run-time Ellipsoid against the model: values, chi-square of draws, weights, and refusals.
//!
//! `cargo test --release --test lobes ellipsoid:: -- --ignored --nocapture` runs the large counts
//! and prints the figures.

use std::f64::consts::PI;

use glam::Vec3;
use microfacet_baker::plan::Options;
use microfacet_baker::table_set::{Target, bake};
use microfacet_model as model;
use microfacet_model::MicrofacetDistribution as _;
use microfacet_model::statistics::{chi_square, sidak};
use microfacet_sampler::{Masking, MaterialError, MicrofacetDistribution as _, Skew, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use crate::sets::{direction, plan, recipe};

/// A set with the single shape γ.
fn tables(gamma: f64) -> Tables {
    let recipe = recipe(&[["it", "0.3", &format!("{gamma:?}"), ""]]);
    let plan = plan(&recipe, Options { tabulate_ggx: true, ..Options::default() });
    bake(&plan, Target::default()).unwrap().set
}

/// A moderately tilted ellipsoid, for the model and for the run time.
fn random(rng: &mut StdRng, gamma: f64) -> (model::Ellipsoid, Skew) {
    loop {
        let sigma = [(); 2].map(|()| 10.0_f64.powf(rng.random_range(-1.5..0.3)));
        let theta =
            [rng.random_range(-0.6..0.6), rng.random_range(-0.6..0.6), rng.random_range(-PI..PI)];
        let skew = Skew::new(sigma, theta).unwrap();
        if skew.x.hypot(skew.y) < 2.0 {
            return (model::Ellipsoid::new(skew, gamma).unwrap(), skew);
        }
    }
}

fn above(rng: &mut StdRng) -> Vec3 {
    direction(rng.random_range(0.02..1.0), rng.random_range(0.0..2.0 * PI))
}

/// A view above the surface; below the lobe's horizon where `below` asks for it and one is found.
fn view(rng: &mut StdRng, e: &model::Ellipsoid, below: bool) -> Vec3 {
    let views: Vec<Vec3> = (0..300).map(|_| above(rng)).collect();
    let is_below = |v: &&Vec3| e.skew().direction(v.as_dvec3().to_array())[2] < 0.0;
    *if below { views.iter().find(is_below).unwrap_or(&views[0]) } else { &views[0] }
}

const GAMMAS: [f64; 6] = [2.0, 1.6, 2.7, 2.0, 8.0, f64::INFINITY];

#[test]
fn values_follow_the_model() {
    let mut rng = StdRng::seed_from_u64(5);
    let mut below = 0;
    for gamma in GAMMAS {
        let set = tables(gamma);
        for i in 0..60 {
            let (truth, skew) = random(&mut rng, gamma);
            let e = set.ellipsoid(skew, gamma).unwrap();
            let v = view(&mut rng, &truth, i % 2 == 0);
            let v64 = v.as_dvec3();
            below += usize::from(truth.skew().direction(v64.to_array())[2] < 0.0);
            let (got, want) = (f64::from(e.g1(v)), truth.g1(v64));
            assert!((got - want).abs() < 2e-5, "gamma {gamma}, {v}: {got} against {want}");
            for _ in 0..20 {
                let m = Vec3::from(e.sample_visible_normal(v, [rng.random(), rng.random()]));
                let unit = (m.length() - 1.0).abs() < 1e-6;
                assert!(unit && m.z > 0.0 && m.dot(v) > -1e-6, "{m} from {v}");
                let (got, want) =
                    (e.visible_normal_pdf(v, m), truth.visible_normal_pdf(v64, m.as_dvec3()));
                // The relative error of D in f32 is its exponent times an ulp; grazing facets lose
                // digits of v·m.
                if m.z > 1e-3 && m.dot(v) > 1e-3 && (1e-30..1e30).contains(&want) {
                    let error = (f64::from(got) / want - 1.0).abs();
                    assert!(error < 3e-3, "gamma {gamma}, {v}, {m}: {got} against {want}");
                }
            }
        }
    }
    assert!(below > 60, "only {below} views below the lobe's horizon");
}

/// Without tilt and turn the matrix is the roughness of an untilted lobe, and the normals are the
/// same.
#[test]
fn plain_matrices_give_plain_normals() {
    let mut rng = StdRng::seed_from_u64(9);
    for gamma in GAMMAS {
        let set = tables(gamma);
        let sigma = [0.2, 0.7];
        let (plain, e) = (
            set.student_t(sigma, gamma).unwrap(),
            set.ellipsoid(Skew::new(sigma, [0.0; 3]).unwrap(), gamma).unwrap(),
        );
        for _ in 0..10_000 {
            let (v, u) = (above(&mut rng), [rng.random(), rng.random()]);
            let m = Vec3::from(e.sample_visible_normal(v, u));
            let want = Vec3::from(plain.sample_visible_normal(v, u));
            assert!((m - want).length() < 2e-6, "gamma {gamma}, {v}, {u:?}: {m} against {want}");
        }
    }
}

/// Matrices with entries from 1e-7 to 9e7, whose squares leave single precision, still give unit
/// normals above the horizon.
#[test]
fn matrices_almost_singular_give_normals() {
    let mut rng = StdRng::seed_from_u64(10);
    let ends = [0.0, 1e-11, 0.3, 0.999_999_94, 1.0_f32];
    for gamma in [2.0, f64::INFINITY] {
        let set = tables(gamma);
        for sigma in [[9e7, 9e7], [1e-7, 1.0], [1.0, 9e7]] {
            for theta in [[0.0; 3], [0.3, 0.2, 0.1]] {
                let e = set.ellipsoid(Skew::new(sigma, theta).unwrap(), gamma).unwrap();
                for i in 0..2500 {
                    let (v, u) = (above(&mut rng), [ends[i % 5], ends[i / 5 % 5]]);
                    let m = Vec3::from(e.sample_visible_normal(v, u));
                    let unit = (m.length() - 1.0).abs() < 1e-6 && m.z > 0.0;
                    assert!(unit, "gamma {gamma}, {sigma:?}, {theta:?}, {v}, {u:?}: {m}");
                }
            }
        }
    }
}

/// Smallest p-value of `count` ellipsoids, binned 16 × 16 by the random numbers to which the exact
/// map inverts the normals.
fn smallest_p(count: usize, draws: usize, gammas: &[f64]) -> f64 {
    const BINS: usize = 16;
    let sets: Vec<Tables> = gammas.iter().map(|&gamma| tables(gamma)).collect();
    let p_of = |i: usize| {
        let mut rng = StdRng::seed_from_u64(i as u64);
        let gamma = gammas[i % gammas.len()];
        let (truth, skew) = random(&mut rng, gamma);
        let e = sets[i % gammas.len()].ellipsoid(skew, gamma).unwrap();
        let v = view(&mut rng, &truth, i % 4 == 1);
        let v64 = v.as_dvec3();
        let lune = truth.lune();
        let mut counts = vec![0; BINS * BINS];
        for _ in 0..draws {
            let m = e.sample_visible_normal(v, [rng.random(), rng.random()]);
            let m = Vec3::from(m).as_dvec3();
            let [a, b] = match &lune {
                Some(lune) => lune.invert_lune(v64, m),
                None => truth.invert_visible_normal(v64, m),
            };
            let bin = |u: f64| ((u * BINS as f64) as usize).min(BINS - 1);
            counts[bin(a) * BINS + bin(b)] += 1;
        }
        let expected = vec![draws as f64 / (BINS * BINS) as f64; BINS * BINS];
        let p = chi_square(&counts, &expected).p;
        (p, format!("gamma {gamma}, v {v}, {:?}", truth.skew()))
    };
    let (p, at) = (0..count).into_par_iter().map(p_of).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    // One false alarm in a hundred runs.
    let level = sidak(0.01, count);
    assert!(p > level, "p = {p:e}, level {level:e}: {at}");
    p
}

#[test]
fn draws_pass_chi_square() {
    smallest_p(24, 20_000, &GAMMAS);
}

#[test]
#[ignore = "minutes in a release build"]
fn draws_pass_chi_square_200() {
    let p = smallest_p(200, 1_000_000, &[2.0]);
    println!("200 ellipsoids at gamma 2 x 1e6: smallest p {p:.4}");
    let p = smallest_p(200, 100_000, &GAMMAS);
    println!("200 ellipsoids at gamma {GAMMAS:?} x 1e5: smallest p {p:.4}");
}

/// The largest reflection weight seen, and the mean over all (the albedo averaged over the lobes
/// and views drawn).
fn weights(draws: usize) -> (f32, f64) {
    let of_gamma = |&gamma: &f64| {
        let set = tables(gamma);
        let mut rng = StdRng::seed_from_u64(gamma.to_bits());
        let (mut largest, mut sum) = (0.0_f32, 0.0);
        let each = 1000;
        for _ in 0..draws / GAMMAS.len() / each {
            let (truth, skew) = random(&mut rng, gamma);
            let e = set.ellipsoid(skew, gamma).unwrap();
            let below = rng.random();
            let v = view(&mut rng, &truth, below);
            for _ in 0..each {
                let m = Vec3::from(e.sample_visible_normal(v, [rng.random(), rng.random()]));
                let l = 2.0 * v.dot(m) * m - v;
                for masking in Masking::ALL {
                    let weight = if l.z > 0.0 { e.reflection_weight(v, l, masking) } else { 0.0 };
                    assert!(weight >= 0.0, "gamma {gamma}: {weight}");
                    largest = largest.max(weight);
                    sum += f64::from(weight);
                }
            }
        }
        (largest, sum)
    };
    let all: Vec<_> = GAMMAS.par_iter().map(of_gamma).collect();
    let largest = all.iter().fold(0.0, |a: f32, b| a.max(b.0));
    (largest, all.iter().map(|x| x.1).sum::<f64>() / (2 * draws) as f64)
}

#[test]
fn weights_never_exceed_one() {
    let (largest, mean) = weights(120_000);
    // One ulp is the rounding of G2's quotient.
    assert!(largest <= 1.0 + 2.0 * f32::EPSILON && mean > 0.2, "largest {largest}, mean {mean}");
}

#[test]
#[ignore = "a minute in a release build"]
fn weights_never_exceed_one_10_million() {
    let (largest, mean) = weights(10_000_000);
    println!("1e7 draws: largest weight 1 + {:e}, mean {mean:.4}", f64::from(largest) - 1.0);
    assert!(largest <= 1.0 + 2.0 * f32::EPSILON);
}

#[test]
fn matrices_beyond_single_precision_are_refused() {
    let set = tables(3.0);
    let skew = Skew::new(1e-20, [0.0; 3]).unwrap();
    assert!(matches!(set.ellipsoid(skew, 3.0), Err(MaterialError::Sigma { sigma: 1e-20, .. })));
}
