//! What is the same arithmetic gives the same bits: a σ given at a hit and one that is bound, and
//! batches of a family and its single calls.

use microfacet_sampler::lobe::{Batch, BatchError, Bounded, Reflecting, Tabulated};
use microfacet_sampler::{Masking, MaterialError, MicrofacetDistribution as _, Skew};

use super::*;

const SHAPES: [f64; 6] = [1.501, 1.65, 1.8, 2.0, 5.5, f64::INFINITY];

fn views(random: &mut StdRng) -> Vec<Vec3> {
    let mut views: Vec<Vec3> = COSINES.iter().map(|&z| view(z, random.random())).collect();
    views.extend([-Vec3::Z, view(-0.4, 1.0)]);
    views
}

/// All that a lobe computes at one view, by its bits.
fn bits(lobe: &(impl Reflecting + Tabulated), v: Vec3, l: Vec3, u: [f32; 2]) -> Vec<u32> {
    let m = lobe.sample_visible_normal(v, u);
    let (n, share) = lobe.sample_reflecting_normal(v, u);
    let mut all = [m, n].as_flattened().to_vec();
    all.extend([share, lobe.reflecting_share(v), lobe.g1(v), lobe.d(m), lobe.lambda(v)]);
    all.extend([lobe.visible_normal_pdf(v, m), lobe.table_pdf(v, m)]);
    for form in Masking::ALL {
        let facet = lobe.facet(v, m, l, form);
        all.extend([lobe.reflection_weight(v, l, form), facet.density, facet.weight]);
    }
    let mut bits: Vec<u32> = all.into_iter().map(f32::to_bits).collect();
    bits.extend([u32::from(lobe.is_effectively_smooth()), lobe.bytes() as u32]);
    bits
}

/// Single calls and batches of two lobes.
fn same(a: &(impl Reflecting + Tabulated + Batch), b: &(impl Reflecting + Tabulated + Batch)) {
    let mut random = random();
    let views = views(&mut random);
    let l = view(0.4, -1.2);
    let u: Vec<_> = views.iter().map(|_| numbers(&mut random)).collect();
    for (&v, &u) in views.iter().zip(&u) {
        assert_eq!(bits(a, v, l, u), bits(b, v, l, u), "{v} {u:?}");
    }
    let bits = |m: Vec<[f32; 3]>, g1: Vec<f32>| {
        [m.as_flattened(), &g1].concat().into_iter().map(f32::to_bits).collect::<Vec<_>>()
    };
    let none = || (vec![[0.0; 3]; u.len()], vec![0.0; u.len()]);
    let ((mut m, mut g1), (mut n, mut h1)) = (none(), none());
    a.sample_batch(&views, &u, &mut m).unwrap();
    b.sample_batch(&views, &u, &mut n).unwrap();
    a.g1_batch(&views, &mut g1).unwrap();
    b.g1_batch(&views, &mut h1).unwrap();
    assert_eq!(bits(m, g1), bits(n, h1));
}

#[test]
fn a_roughness_of_a_hit_is_that_of_a_bound_lobe() {
    let tables = Tables::embedded();
    for gamma in SHAPES {
        let shape = tables.student_t(0.7, gamma).unwrap();
        for sigma in SIGMAS {
            let lobe = shape.with_roughness(sigma);
            assert_eq!((lobe.sigma(), lobe.gamma()), (sigma, gamma));
            same(&lobe, &tables.student_t(sigma, gamma).unwrap());
        }
    }
}

#[test]
fn a_roughness_of_a_hit_is_that_of_a_bounded_lobe() {
    let (tables, mut random) = (Tables::embedded(), random());
    for gamma in SHAPES {
        let shape = tables.student_t(0.7, gamma).unwrap().bounded();
        for sigma in SIGMAS {
            let bound: Bounded = tables.student_t(sigma, gamma).unwrap().bounded();
            let lobe = shape.with_roughness(sigma);
            same(&lobe, &bound);
            for v in views(&mut random) {
                let ([a, b], u) = ([lobe.at(v), bound.at(v)], numbers(&mut random));
                let m = a.sample(u);
                assert_eq!((m, a.share()), (b.sample(u), b.share()));
                assert_eq!(a.visible_normal_pdf(m), b.visible_normal_pdf(m));
                assert_eq!(a.table_pdf(m).to_bits(), b.table_pdf(m).to_bits());
            }
        }
    }
}

#[test]
fn a_skew_of_a_hit_is_that_of_an_ellipsoid() {
    let tables = Tables::embedded();
    let any = Skew::new([1.0, 1.0], [0.0; 3]).unwrap();
    for gamma in SHAPES {
        let shape = tables.ellipsoid(any, gamma).unwrap();
        for (sigma, theta) in [([0.3, 0.3], [0.4, 0.0, 0.0]), ([0.05, 0.9], [-0.2, 0.6, 1.0])] {
            let skew = Skew::new(sigma, theta).unwrap();
            same(&shape.with_skew(skew).unwrap(), &tables.ellipsoid(skew, gamma).unwrap());
        }
    }
}

/// σ, γ, views and numbers of many hits, odd ones among them.
type Hits = (Vec<[f32; 2]>, Vec<f32>, Vec<Vec3>, Vec<[f32; 2]>);

fn hits(count: usize) -> Hits {
    let mut random = random();
    let (odd, all) = (views(&mut random), gammas());
    let sigma =
        |i: usize| if i.is_multiple_of(5) { [f32::NAN, 0.0] } else { SIGMAS[i % SIGMAS.len()] };
    let gamma = |i: usize| if i.is_multiple_of(31) { f32::NAN } else { all[i % all.len()] };
    (
        (0..count).map(sigma).collect(),
        (0..count).map(gamma).collect(),
        (0..count).map(|i| odd[i * 7 % odd.len()]).collect(),
        (0..count).map(|_| numbers(&mut random)).collect(),
    )
}

#[test]
fn batches_of_a_family_are_its_single_calls() {
    let family = family();
    for count in [0, 1, 3, 37, 4000] {
        let (sigma, gamma, v, u) = hits(count);
        let (mut m, mut g1) = (vec![[0.0_f32; 3]; count], vec![0.0_f32; count]);
        family.sample_batch(&sigma, &gamma, &v, &u, &mut m).unwrap();
        family.g1_batch(&sigma, &gamma, &v, &mut g1).unwrap();
        for i in 0..count {
            let lobe = family.at(sigma[i], gamma[i]);
            let one = lobe.sample_visible_normal(v[i], u[i]);
            for (m, one) in m[i].into_iter().zip(one) {
                // 2 ulp of their unit length.
                let same = m.is_nan() && one.is_nan();
                assert!(same || (m - one).abs() <= 2.0 * f32::EPSILON, "{i}: {m} {one}");
            }
            assert_eq!(g1[i].to_bits(), lobe.g1(v[i]).to_bits(), "{i}");
        }
    }
}

/// As `results_have_the_same_bits_in_any_number_of_lanes` of bound lobes, in `tests/batch.rs`.
#[test]
fn hits_have_the_same_bits_in_any_number_of_lanes() {
    const LANES: usize = 4;
    let family = family();
    for count in [3, 4, 5, 8, 11, 12, 16, 29, 2000] {
        let (sigma, gamma, v, u) = hits(count);
        let mut m = vec![[0.0_f32; 3]; count];
        family.sample_batch(&sigma, &gamma, &v, &u, &mut m).unwrap();
        for from in (0..count).step_by(LANES) {
            let i = from..count.min(from + LANES);
            let mut few = vec![[0.0_f32; 3]; i.len()];
            let hits = (&sigma[i.clone()], &gamma[i.clone()], &v[i.clone()], &u[i.clone()]);
            family.sample_batch(hits.0, hits.1, hits.2, hits.3, &mut few).unwrap();
            let bits = |m: &[[f32; 3]]| m.iter().map(|m| m.map(f32::to_bits)).collect::<Vec<_>>();
            assert_eq!(bits(&few), bits(&m[i]), "{count}, {hits:?}");
        }
    }
}

#[test]
fn slices_of_unequal_length_are_refused_and_nothing_is_written() {
    let family = family();
    let (sigma, gamma, v, u) = hits(8);
    let (mut m, mut g1) = ([[1.0_f32; 3]; 8], [1.0_f32; 8]);
    let differ = |other, length| Err(BatchError { slices: ["sigma", other], lengths: [8, length] });
    assert_eq!(family.sample_batch(&sigma, &gamma[1..], &v, &u, &mut m), differ("gamma", 7));
    assert_eq!(family.sample_batch(&sigma, &gamma, &v[2..], &u, &mut m), differ("v", 6));
    assert_eq!(family.sample_batch(&sigma, &gamma, &v, &u[3..], &mut m), differ("u", 5));
    assert_eq!(family.sample_batch(&sigma, &gamma, &v, &u, &mut m[4..]), differ("m", 4));
    assert_eq!(family.g1_batch(&sigma, &gamma[1..], &v, &mut g1), differ("gamma", 7));
    assert_eq!(family.g1_batch(&sigma, &gamma, &v[2..], &mut g1), differ("v", 6));
    assert_eq!(family.g1_batch(&sigma, &gamma, &v, &mut g1[3..]), differ("g1", 5));
    assert_eq!((m, g1), ([[1.0; 3]; 8], [1.0; 8]));
}

#[test]
fn a_set_of_single_shapes_has_no_family() {
    let set = Tables::embedded();
    let none = Tables::from_tables(set.provenance().clone(), Vec::new()).unwrap();
    assert_eq!(none.family().unwrap_err(), MaterialError::NoRange);
}
