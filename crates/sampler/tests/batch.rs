//! The functions over slices against the functions for one direction.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_sampler::lobe::{Batch, BatchError};
use microfacet_sampler::{Ggx, MicrofacetDistribution, StudentT, Tables};

/// Views of the whole hemisphere and a little below it, the axes, and vectors that are not
/// directions; random numbers with both ends and beyond.
fn inputs(count: usize) -> (Vec<Vec3>, Vec<[f32; 2]>) {
    let mut rng = StdRng::seed_from_u64(5);
    let odd = [
        Vec3::Z,
        Vec3::X,
        -Vec3::Z,
        Vec3::new(1e-20, 0.0, 1.0),
        Vec3::new(0.6, 0.0, -0.8),
        Vec3::NAN,
    ];
    let ends = [0.0, 1.0, 0.5, 1e-12, 1.0 - f32::EPSILON / 2.0, -0.5, 1.5, 0.25];
    let views = (0..count).map(|i| match odd.get(i % 23) {
        Some(v) => *v,
        None => {
            let (z, phi) = (rng.random_range(-0.1_f32..1.0), rng.random_range(0.0_f32..6.3));
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), z)
        }
    });
    let views = views.collect();
    let mut number = |i: usize| ends.get(i).copied().unwrap_or_else(|| rng.random());
    (views, (0..count).map(|i| [number(i % 29), number(i % 31)]).collect())
}

fn materials() -> impl Iterator<Item = StudentT> {
    let tables = Tables::embedded();
    [1.51, 1.8, 2.0, 3.3, f64::INFINITY].into_iter().flat_map(move |gamma| {
        let tables = tables.clone();
        [[0.3, 0.3], [0.02, 4.0]].map(|sigma| tables.student_t(sigma, gamma).unwrap())
    })
}

/// Lengths that leave every remainder, and one that fills several blocks.
const LENGTHS: [usize; 6] = [0, 1, 3, 6, 37, 4000];

#[test]
fn a_batch_of_normals_is_those_normals() {
    for material in materials() {
        for count in LENGTHS {
            let (v, u) = inputs(count);
            let mut m = vec![Vec3::ZERO; count];
            material.sample_batch(&v, &u, &mut m).unwrap();
            for i in 0..count {
                let one = Vec3::from(material.sample_visible_normal(v[i], u[i]));
                let same = one.is_nan() && m[i].is_nan();
                // 2 ulp of their unit length.
                assert!(
                    same || one.abs_diff_eq(m[i], 2.0 * f32::EPSILON),
                    "{} {:?}: {} {:?}: {one} {}",
                    material.gamma(),
                    material.sigma(),
                    v[i],
                    u[i],
                    m[i]
                );
            }
        }
    }
}

#[test]
fn a_batch_of_g1_is_those_numbers() {
    for material in materials() {
        for count in LENGTHS {
            let (v, _) = inputs(count);
            let mut g1 = vec![0.0; count];
            material.g1_batch(&v, &mut g1).unwrap();
            for (v, g1) in v.iter().zip(g1) {
                let one = material.g1(*v);
                assert!(one == g1 || one.is_nan() && g1.is_nan(), "{v}: {one} {g1}");
            }
        }
    }
}

/// Lengths next to those that fill lanes, and one that fills several blocks.
const WHOLE_AND_REST: [usize; 9] = [3, 4, 5, 8, 11, 12, 16, 29, 2000];

/// Fours never fill more than four lanes, so that this compares as many as the processor has with
/// four, and these with single calls where they are too few.
#[test]
fn results_have_the_same_bits_in_any_number_of_lanes() {
    const LANES: usize = 4;
    let bits =
        |m: &[[f32; 3]]| -> Vec<[u32; 3]> { m.iter().map(|m| m.map(f32::to_bits)).collect() };
    let same_g1 =
        |a: &[f32], b: &[f32]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
    let lobe = |sigma: [f32; 2], gamma| Tables::embedded().student_t(sigma, gamma).unwrap();
    let near_the_end = [lobe([0.3; 2], 1.501), lobe([1e-8, 1e6], 1.6), lobe([1e6; 2], 40.0)];
    for material in materials().chain(near_the_end) {
        let bounded = material.clone().bounded();
        for count in WHOLE_AND_REST {
            let (v, u) = inputs(count);
            let (mut m, mut g1, mut share) = (
                [vec![[0.0; 3]; count], vec![[0.0; 3]; count]],
                vec![0.0; count],
                vec![0.0; count],
            );
            material.sample_batch(&v, &u, &mut m[0]).unwrap();
            material.g1_batch(&v, &mut g1).unwrap();
            bounded.sample_reflecting_batch(&v, &u, &mut m[1], &mut share).unwrap();
            for from in (0..count).step_by(LANES) {
                let part = from..count.min(from + LANES);
                let (v, u, n) = (&v[part.clone()], &u[part.clone()], part.len());
                let what =
                    format!("{} {:?} {count} {v:?} {u:?}", material.gamma(), material.sigma());
                let (mut four, mut numbers) = ([[0.0; 3]; LANES], [0.0; LANES]);
                material.sample_batch(v, u, &mut four[..n]).unwrap();
                assert_eq!(bits(&four[..n]), bits(&m[0][part.clone()]), "{what}");
                material.g1_batch(v, &mut numbers[..n]).unwrap();
                assert!(same_g1(&numbers[..n], &g1[part.clone()]), "{what}");
                bounded.sample_reflecting_batch(v, u, &mut four[..n], &mut numbers[..n]).unwrap();
                assert_eq!(bits(&four[..n]), bits(&m[1][part.clone()]), "{what}");
                assert!(same_g1(&numbers[..n], &share[part]), "{what}");
            }
        }
    }
}

#[test]
fn batches_of_ggx_are_those_normals_in_any_number_of_lanes() {
    for alpha in [[0.3, 0.3], [0.02, 4.0], [1e-8, 1e6]] {
        let lobe = Ggx::new(alpha).unwrap();
        for count in WHOLE_AND_REST {
            let (v, u) = inputs(count);
            let mut m = vec![[0.0; 3]; count];
            lobe.sample_batch(&v, &u, &mut m).unwrap();
            for (i, m) in m.iter().enumerate() {
                // Extreme anisotropy magnifies the last bit of a hidden normal.
                if alpha[0] < 1e-3 {
                    break;
                }
                let one = Vec3::from(lobe.sample_visible_normal(v[i], u[i]));
                let same = one.abs_diff_eq(Vec3::from(*m), 2.0 * f32::EPSILON);
                assert!(same, "{alpha:?}: {} {:?}: {one} {m:?}", v[i], u[i]);
            }
            for from in (0..count).step_by(4) {
                let i = from..count.min(from + 4);
                let mut few = vec![[0.0; 3]; i.len()];
                lobe.sample_batch(&v[i.clone()], &u[i.clone()], &mut few).unwrap();
                let bits =
                    |m: &[[f32; 3]]| m.iter().map(|m| m.map(f32::to_bits)).collect::<Vec<_>>();
                assert_eq!(bits(&few), bits(&m[i]), "{alpha:?} {count}");
            }
        }
    }
}

#[test]
fn slices_of_unequal_length_are_refused_and_nothing_is_written() {
    let material = materials().next().unwrap();
    let (v, u) = inputs(8);
    let mut m = [Vec3::ONE; 8];
    assert_eq!(
        material.sample_batch(&v, &u[..7], &mut m),
        Err(BatchError { slices: ["v", "u"], lengths: [8, 7] })
    );
    let error = material.sample_batch(&v, &u, &mut m[..5]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a batch of 8 `v` and 5 `m`: all slices must have the same length; cut the longer one"
    );
    assert_eq!(m, [Vec3::ONE; 8]);
    assert!(material.g1_batch(&v, &mut [0.0; 9]).is_err());
}
