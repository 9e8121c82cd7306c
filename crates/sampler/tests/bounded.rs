//! Normals bounded for reflection: nothing that reflects upwards is lost, and estimates agree.

use std::f32::consts::TAU;

use glam::Vec3;
use microfacet_model::statistics::{chi_square, sidak};
use microfacet_sampler::lobe::{Reflecting, Tabulated};
use microfacet_sampler::{Ggx, Lobe, Masking, MicrofacetDistribution, StudentT, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

fn materials() -> impl Iterator<Item = StudentT> {
    let tables = Tables::embedded();
    [1.501, 1.55, 1.7, 1.9, 3.0, f64::INFINITY].into_iter().flat_map(move |gamma| {
        let tables = tables.clone();
        [[0.4, 0.4], [1.5, 1.5], [0.2, 0.9]].map(|sigma| tables.student_t(sigma, gamma).unwrap())
    })
}

fn views() -> impl Iterator<Item = Vec3> {
    [0.0, 0.1, 0.6, 1.1, 1.45, 1.57].into_iter().flat_map(|theta: f32| {
        [0.3, 2.0].map(|phi: f32| {
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        })
    })
}

fn reflect(v: Vec3, m: [f32; 3]) -> Vec3 {
    let m = Vec3::from(m).normalize();
    2.0 * v.dot(m) * m - v
}

/// White-furnace weight of a reflection.
fn weight(material: &StudentT, v: Vec3, m: [f32; 3]) -> f64 {
    let l = reflect(v, m);
    if l.z > 0.0 {
        f64::from(material.g2(v, l, Masking::HeightCorrelated) / material.g1(v))
    } else {
        0.0
    }
}

fn grid(n: u32) -> impl Iterator<Item = [f32; 2]> {
    let at = move |i: u32| (i as f32 + 0.5) / n as f32;
    (0..n).flat_map(move |i| (0..n).map(move |j| [at(i), at(j)]))
}

#[test]
fn bounding_changes_no_mean_and_lowers_the_variance() {
    let (mut best, n) = (1.0_f64, 200);
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            let share = f64::from(bounded.share());
            assert!(share > 0.0 && share <= 1.0, "{v}: {share}");
            let (mut means, mut squares) = ([0.0; 2], [0.0; 2]);
            for u in grid(n) {
                let both = [
                    weight(&material, v, material.sample_visible_normal(v, u)),
                    weight(&material, v, bounded.sample(u)) * share,
                ];
                for i in 0..2 {
                    means[i] += both[i] / f64::from(n * n);
                    squares[i] += both[i] * both[i] / f64::from(n * n);
                }
            }
            let what = format!("{:?} {} {v}: {means:?}", material.sigma(), material.gamma());
            // The midpoint rule errs at a jump along a curve by a fraction of the cells that the
            // curve crosses.
            assert!((means[0] - means[1]).abs() < 2.0 / f64::from(n), "{what}");
            let variance = |i: usize| squares[i] - means[i] * means[i];
            assert!(variance(1) <= variance(0) + 0.01, "{what} {} {}", variance(0), variance(1));
            best = best.min(variance(1) / variance(0).max(1e-3));
        }
    }
    assert!(best < 0.5, "the variance never falls below {best} of the unbounded");
}

#[test]
fn nothing_that_reflects_upwards_is_lost() {
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            // The ends of the interval are its first and last normal: upward reflections lie
            // between them.
            let tilt = |[x, y, z]: [f32; 3]| {
                // In unit space, along the stretched azimuth.
                let [sx, sy] = material.sigma();
                let (ax, ay) = (sx * v.x, sy * v.y);
                let rho = ax.hypot(ay);
                let (ax, ay) = if rho > 0.0 { (ax / rho, ay / rho) } else { (1.0, 0.0) };
                (x / sx * ax + y / sy * ay) / z
            };
            let [first, last] = [0.0, 1.0].map(|u| tilt(bounded.sample([u, 0.5])));
            for u in grid(100) {
                let m = material.sample_visible_normal(v, u);
                if reflect(v, m).z > 1e-5 {
                    let x = tilt(m);
                    let slack = 1e-4 * (1.0 + x.abs());
                    assert!(
                        x >= first - slack && (x <= last + slack || bounded.share() > 0.999),
                        "{v} {u:?}: {x} {first} {last}"
                    );
                }
            }
        }
    }
}

#[test]
fn densities_are_those_of_visible_normals_over_the_share() {
    for material in materials() {
        let lobe = material.clone().bounded();
        for v in views() {
            let bounded = lobe.at(v);
            let m = bounded.sample([0.4, 0.3]);
            let ratio =
                bounded.visible_normal_pdf(m) * bounded.share() / material.visible_normal_pdf(v, m);
            assert!((ratio - 1.0).abs() < 1e-6);
            let ratio = bounded.table_pdf(m) * bounded.share() / material.table_pdf(v, m);
            assert!((ratio - 1.0).abs() < 1e-6, "{v}");
        }
    }
}

/// Cells of lights by the root of their cosine, so that those next to the horizon are small, and by
/// their azimuth.
const RINGS: usize = 16;
const AZIMUTHS: usize = 8;

/// None below the horizon.
fn cell(l: Vec3) -> Option<usize> {
    let at = |x: f32, count: usize| ((x * count as f32) as usize).min(count - 1);
    let turn = l.y.atan2(l.x) / TAU + 0.5;
    (l.z > 0.0).then(|| at(l.z.sqrt(), RINGS) * AZIMUTHS + at(turn, AZIMUTHS))
}

/// p of the lights that are drawn, by their density.
fn p_of_lights(drawn: &impl Reflecting, v: Vec3, random: &mut StdRng) -> f64 {
    const DRAWS: usize = 50_000;
    /// Points in a cell, each way. Of grazing views densities are narrow in azimuth.
    const POINTS: [usize; 2] = [12, 64];
    let mut expected = vec![0.0; RINGS * AZIMUTHS + 1];
    let [rings, azimuths] = [RINGS * POINTS[0], AZIMUTHS * POINTS[1]];
    for i in 0..rings {
        let root = (i as f32 + 0.5) / rings as f32;
        let z = root * root;
        // dz dφ.
        let patch = (2.0 * root / rings as f32) * (TAU / azimuths as f32);
        for j in 0..azimuths {
            let (sin, cos) = ((j as f32 + 0.5) / azimuths as f32 * TAU).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let l = Vec3::new(r * cos, r * sin, z);
            let (_, pdf) = drawn.eval_pdf(v, l, Masking::HeightCorrelated);
            expected[cell(l).unwrap()] += DRAWS as f64 * f64::from(pdf * patch);
        }
    }
    let (share, mut observed) = (drawn.reflecting_share(v), vec![0; expected.len()]);
    for _ in 0..DRAWS {
        let (m, of_draw) = drawn.sample_reflecting_normal(v, random.random());
        assert_eq!(of_draw.to_bits(), share.to_bits());
        observed[cell(reflect(v, m)).unwrap_or(expected.len() - 1)] += 1;
    }
    // All others are below the horizon; none where every normal reflects upwards.
    let above: f64 = expected.iter().sum();
    assert!(above < 1.002 * DRAWS as f64, "{v}: {above} of {DRAWS}");
    *expected.last_mut().unwrap() = (DRAWS as f64 - above).max(1e-3);
    chi_square(&observed, &expected).p
}

#[test]
fn lights_are_drawn_by_their_density() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    let mut random = StdRng::seed_from_u64(3);
    let gammas = [1.501, 1.55, 1.6, 1.7, 1.79, 1.9, 3.0];
    let level = sidak(1e-3, gammas.len() * 2 * 10 * 2);
    for gamma in gammas {
        for sigma in [[0.3, 0.3], [0.2, 0.9]] {
            let bounded = tables.student_t(sigma, gamma).unwrap().bounded();
            let per_hit = family.at(sigma, gamma as f32).bounded();
            for v in views().filter(|v| v.z > 0.1) {
                let p =
                    [p_of_lights(&bounded, v, &mut random), p_of_lights(&per_hit, v, &mut random)];
                assert!(p.iter().all(|&p| p > level), "{gamma} {sigma:?} {v}: {p:?}");
            }
        }
    }
}

/// At views and numbers of all ends, of every lobe that is bounded.
#[test]
fn ends_give_normals_and_shares() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    let check = |lobe: &dyn Fn(Vec3, [f32; 2]) -> ([f32; 3], f32), what: &str| {
        for z in [1.0, 1.0 - 1e-7, 0.5, 1e-3, 1e-10, 1e-20, 1e-38, 0.0, -0.5_f32] {
            let r = (1.0 - z * z).sqrt();
            for v in [Vec3::new(r, 0.0, z), Vec3::new(-0.6 * r, 0.8 * r, z)] {
                for u in [0.0, 1e-9, 0.5, 1.0_f32.next_down(), 1.0] {
                    let (m, share) = lobe(v, [u, 1.0 - u]);
                    assert!(share > 0.0 && share <= 1.0, "{what} {v} {u}: {share}");
                    let m = Vec3::from(m).normalize();
                    let faces = z < 0.0 || v.dot(m) > -5e-7;
                    assert!(m.is_finite() && m.z > 0.0 && faces, "{what} {v} {u}: {m}");
                }
            }
        }
        let (m, share) = lobe(Vec3::NAN, [0.5, f32::NAN]);
        assert!(m.iter().all(|x| !x.is_infinite()) && !share.is_infinite(), "{what}");
    };
    for gamma in [1.501, 1.6, 1.79, 1.9, 4.0] {
        for sigma in [1e-8, 1e-3, 0.5, 1e6] {
            let what = format!("{gamma} {sigma}");
            let bounded = tables.student_t(sigma, gamma).unwrap().bounded();
            check(&|v, u| bounded.sample_reflecting_normal(v, u), &what);
            let per_hit = family.at(sigma, gamma as f32).bounded();
            check(&|v, u| per_hit.sample_reflecting_normal(v, u), &what);
        }
    }
}

/// The mean over views of the variance of a weight in a white furnace.
fn furnace(lobe: &StudentT, draw: impl Fn(Vec3, [f32; 2]) -> ([f32; 3], f64)) -> f64 {
    const VIEWS: u16 = 12;
    let of_view = |i: u16| {
        let z = (f32::from(i) + 0.5) / f32::from(VIEWS);
        let v = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let n = 64;
        let (mut mean, mut square) = (0.0, 0.0);
        for u in grid(n) {
            let (m, factor) = draw(v, u);
            let w = weight(lobe, v, m) * factor;
            (mean, square) = (mean + w / f64::from(n * n), square + w * w / f64::from(n * n));
        }
        square - mean * mean
    };
    (0..VIEWS).map(of_view).sum::<f64>() / f64::from(VIEWS)
}

#[test]
fn below_two_bounded_normals_vary_less_than_those_of_ggx_with_weights() {
    let tables = Tables::embedded();
    let family = tables.family().unwrap();
    for gamma in [1.51, 1.6, 1.7, 1.79, 1.9] {
        for sigma in [0.1_f32, 0.3, 0.5] {
            let lobe = tables.student_t(sigma, gamma).unwrap();
            let of = |drawn: &dyn Fn(Vec3, [f32; 2]) -> ([f32; 3], f32)| {
                furnace(&lobe, |v, u| {
                    let (m, share) = drawn(v, u);
                    (m, share.into())
                })
            };
            let visible = of(&|v, u| lobe.sample_reflecting_normal(v, u));
            let chosen = Lobe::from(lobe.clone()).for_reflection();
            let bounded = of(&|v, u| chosen.sample_reflecting_normal(v, u));
            let per_hit = family.at(sigma, gamma as f32).bounded();
            let per_hit = of(&|v, u| per_hit.sample_reflecting_normal(v, u));
            let weighted = [0.9, 1.0, 1.2].map(|wider| {
                let ggx = Ggx::new(sigma * wider).unwrap();
                furnace(&lobe, |v, u| {
                    let m = ggx.sample_visible_normal(v, u);
                    let ratio = lobe.visible_normal_pdf(v, m) / ggx.visible_normal_pdf(v, m);
                    (m, ratio.into())
                })
            });
            let all = format!("{gamma} {sigma}: {visible} {bounded} {per_hit} {weighted:?}");
            assert!(weighted.iter().all(|&weighted| bounded < 0.9 * weighted), "{all}");
            let most = if gamma < 1.75 { 0.6 } else { 0.75 };
            assert!(bounded < 0.6 * visible && (per_hit < most * visible || gamma > 1.8), "{all}");
        }
    }
}
