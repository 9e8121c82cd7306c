//! Time of one visible normal and its density: plain anisotropic against ellipsoid, and the lune sampler as the rival at γ = 2.
//!
//! `cargo run --release --example ellipsoid_cost` prints nanoseconds a draw, the least of several rounds.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_sampler::{Skew, Tables};

const DRAWS: usize = 1_000_000;

/// Views above the surface with their random numbers, the same for every sampler.
fn inputs() -> Vec<(Vec3, [f32; 2])> {
    let step = |i: usize, a: f64| (0.5 + a * i as f64).fract();
    (0..4096)
        .map(|i| {
            let (z, phi) =
                (0.05 + 0.95 * step(i, 0.8566748838545), std::f64::consts::TAU * step(i, 0.733891856627));
            let r = (1.0 - z * z).sqrt();
            let v = DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3();
            (v, [step(i, 0.628706721216) as f32, step(i, 0.538597257213) as f32])
        })
        .collect()
}

fn nanoseconds(inputs: &[(Vec3, [f32; 2])], mut draw: impl FnMut(Vec3, [f32; 2]) -> f32) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..9 {
        let start = Instant::now();
        for i in 0..DRAWS {
            let (v, u) = inputs[i % inputs.len()];
            black_box(draw(black_box(v), black_box(u)));
        }
        least = least.min(start.elapsed().as_secs_f64());
    }
    least * 1e9 / DRAWS as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let (tables, inputs) = (Tables::embedded(), inputs());
    let sigma = [0.2, 0.5];
    for theta in [[0.0, 0.0, 0.3], [0.02, 0.01, 0.3], [0.1, 0.05, 0.3]] {
        let exact = model::Ellipsoid::new(sigma[0], sigma[1], theta, 2.0)?;
        let below = inputs.iter().filter(|(v, _)| (exact.unit_matrix() * v.as_dvec3()).z < 0.0).count();
        println!("turned by {theta:?}: {:.1}% of the views below the lobe's horizon", below as f64 / 40.96);
        compare(&tables, &inputs, sigma, theta)?;
        let lune = exact.lune().expect("gamma is 2");
        let time = nanoseconds(&inputs, |v, u| lune.sample_lune(v.as_dvec3(), u.map(f64::from)).z as f32);
        println!("lune, double precision, gamma 2: {time:.1}");
    }
    Ok(())
}

type Inputs = [(Vec3, [f32; 2])];

fn compare(tables: &Tables, inputs: &Inputs, sigma: [f64; 2], theta: [f64; 3]) -> Result<(), Box<dyn Error>> {
    println!("gamma     plain  ellipsoid  ratio   with density: plain  ellipsoid  ratio");
    for gamma in [1.6, 2.0, 4.0, f64::INFINITY] {
        let plain = tables.student_t(sigma, gamma)?;
        let skewed = tables.ellipsoid(Skew::new(sigma, theta)?, gamma)?;
        let a = nanoseconds(inputs, |v, u| plain.sample_visible_normal(v, u).z);
        let b = nanoseconds(inputs, |v, u| skewed.sample_visible_normal(v, u).z);
        let c = nanoseconds(inputs, |v, u| plain.visible_normal_pdf(v, plain.sample_visible_normal(v, u)));
        let d = nanoseconds(inputs, |v, u| skewed.visible_normal_pdf(v, skewed.sample_visible_normal(v, u)));
        println!("{gamma:<8} {a:>6.1} {b:>10.1} {:>6.2} {c:>21.1} {d:>10.1} {:>6.2}", b / a, d / c);
    }
    Ok(())
}
