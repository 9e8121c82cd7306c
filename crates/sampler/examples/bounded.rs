//! The gain of bounded visible normals for an estimator of reflection:
//! `cargo run --release -p microfacet-sampler --example bounded`.
//!
//! Prints the variance of a white furnace's weight for bounded normals over that for all visible
//! ones. The weight is G2/G1 where the light is above the horizon and 0 elsewhere.

use glam::Vec3;
use microfacet_sampler::{Masking, MicrofacetDistribution, StudentT, Tables};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const SAMPLES: u32 = 200_000;

fn weight(material: &StudentT, v: Vec3, m: [f32; 3]) -> f64 {
    let m = Vec3::from(m);
    let l = 2.0 * v.dot(m) * m - v;
    f64::from(material.g2(v, l, Masking::HeightCorrelated) / material.g1(v))
}

fn variance(mut weight: impl FnMut() -> f64) -> f64 {
    let (sum, squares) = (0..SAMPLES).fold((0.0, 0.0), |(sum, squares), _| {
        let w = weight();
        (sum + w, squares + w * w)
    });
    let (mean, square) = (sum / f64::from(SAMPLES), squares / f64::from(SAMPLES));
    square - mean * mean
}

fn main() {
    let tables = Tables::embedded();
    let mut rng = StdRng::seed_from_u64(1);
    println!("{:>6} {:>6} {:>6} {:>8} {:>10}", "gamma", "sigma", "theta", "share", "variance");
    for gamma in [1.9, 3.0, f64::INFINITY] {
        for sigma in [0.3, 0.6, 1.0] {
            let material = tables.student_t(sigma, gamma).expect("covered by the default set");
            let bounded_lobe = material.clone().bounded();
            for theta in [40.0_f32, 70.0, 85.0] {
                let (sin, cos) = theta.to_radians().sin_cos();
                let v = Vec3::new(sin, 0.0, cos);
                let bounded = bounded_lobe.at(v);
                let share = f64::from(bounded.share());
                let all = variance(|| {
                    weight(&material, v, material.sample_visible_normal(v, rng.random()))
                });
                let fewer = variance(|| share * weight(&material, v, bounded.sample(rng.random())));
                println!("{gamma:>6} {sigma:>6} {theta:>6} {share:>8.3} {:>10.3}", fewer / all);
            }
        }
    }
}
