//! Normals rise with the random numbers at every γ, as those of bound lobes do: stratified numbers
//! give stratified normals.

use microfacet_core::shape::s_of_gamma;
use microfacet_sampler::MicrofacetDistribution as _;

use super::*;

/// Numbers from 0 to 1, dense everywhere and denser at 0, ½ and 1.
fn sweep() -> Vec<f32> {
    let mut u: Vec<f32> = (0..=2000).map(|i| i as f32 / 2000.0).collect();
    for exponent in 1..150 {
        let small = 0.5_f32.powi(exponent);
        u.extend([small, 1.0 - small, 0.5 - small, 0.5 + small]);
    }
    for middle in [0.5_f32, 1.0] {
        let (mut below, mut above) = (middle, middle);
        for _ in 0..64 {
            (below, above) = (below.next_down(), above.next_up());
            u.extend([below, above]);
        }
    }
    u.retain(|u| (0.0..=1.0).contains(u));
    u.sort_by(f32::total_cmp);
    u
}

/// The tangents of half the tilts of m, in the plane of incidence y = 0 and across it, in unit
/// space for σ = 1.
fn half_tangents(m: [f32; 3], s: f64) -> [f64; 2] {
    let [x, y, z] = m.map(f64::from);
    let half = |x: f64, z: f64| x / (x.hypot(z) + z);
    [half(x, z), half(y, (z * z + s * x * x).sqrt())]
}

#[test]
fn tilts_rise_with_the_numbers() {
    let (tables, family, mut random, sweep) = (Tables::embedded(), family(), random(), sweep());
    let mut gammas = GAMMAS.to_vec();
    gammas.extend((0..40).map(|i| {
        let [low, high] = [[1e-6, 1.25], [1.25, 1.996]][i % 2];
        gamma_of_s(random.random_range(low..high)) as f32
    }));
    let mut falls = [Worst::default(), Worst::default()];
    for gamma in gammas {
        let lobe = family.at(1.0, gamma);
        let (bound, _) = bound(&tables, &lobe);
        let s = s_of_gamma(lobe.gamma());
        for z in [1.0, 0.99, random.random(), random.random(), 0.02, 0.0] {
            let v = view(z, 0.0);
            let other: f32 = random.random();
            let (mut last, mut at) = ([f64::NEG_INFINITY; 2], 0.0);
            // The first numbers are those of the table, the rest those of the heavy part.
            let split = bound.tabulated_share(v);
            for &u in &sweep {
                let along = half_tangents(lobe.sample_visible_normal(v, [u, 0.5]), s)[0];
                let across = half_tangents(lobe.sample_visible_normal(v, [other, u]), s)[1];
                let parts = split < 1.0 && at <= split + 1e-5 && u >= split - 1e-5;
                for (i, now) in [along, across].into_iter().enumerate() {
                    if i == 1 || !parts {
                        falls[i].see(last[i] - now, || format!("{gamma:?} {z} {u:e} of {i}"));
                    }
                    last[i] = now;
                }
                at = u;
            }
        }
    }
    falls[0].allowed(3e-7);
    falls[1].allowed(2e-7);
}
