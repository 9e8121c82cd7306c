//! Time of one visible normal and its density: untilted anisotropic lobe against ellipsoid, with
//! the lune sampler as the rival at γ = 2.
//!
//! `cargo run --profile dist -p microfacet-study -- ellipsoid_cost` prints nanoseconds per draw,
//! the least of many short rounds in turns. Measured: a normal of the ellipsoid takes 1.19 to 1.24
//! times as long as the untilted one for γ ≥ 2 (19 ns), and with its density 1.05 to 1.17 times;
//! for γ = 1.6, where the heavy tail's closed form takes most of the time, 0.80 and 1.04 times. The
//! lune takes 60 to 84 ns.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use glam::{DVec3, Vec3};
use microfacet_model as model;
use microfacet_sampler::{MicrofacetDistribution, Skew, Tables};

use crate::Outcome;

/// Draws of each input in a round, and rounds.
const PASSES: usize = 4;
const ROUNDS: usize = 500;

/// Views above the surface with their random numbers, the same for every sampler.
fn inputs() -> Vec<(Vec3, [f32; 2])> {
    let step = |i: usize, a: f64| (0.5 + a * i as f64).fract();
    (0..4096)
        .map(|i| {
            let z = 0.05 + 0.95 * step(i, 0.8566748838545);
            let phi = std::f64::consts::TAU * step(i, 0.733891856627);
            let r = (1.0 - z * z).sqrt();
            let v = DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3();
            (v, [step(i, 0.628706721216) as f32, step(i, 0.538597257213) as f32])
        })
        .collect()
}

/// Nanoseconds per draw of one short round.
fn round(inputs: &Inputs, mut draw: impl FnMut(Vec3, [f32; 2]) -> f32) -> f64 {
    let start = Instant::now();
    for _ in 0..PASSES {
        for &(v, u) in inputs {
            black_box(draw(black_box(v), black_box(u)));
        }
    }
    start.elapsed().as_secs_f64() * 1e9 / (PASSES * inputs.len()) as f64
}

/// The least time of each in alternating rounds, so that other load on the machine affects both.
fn least(mut a: impl FnMut() -> f64, mut b: impl FnMut() -> f64) -> [f64; 2] {
    (0..ROUNDS).fold([f64::INFINITY; 2], |[x, y], _| [x.min(a()), y.min(b())])
}

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    let (tables, inputs) = (Tables::embedded(), inputs());
    let sigma = [0.2, 0.5];
    for theta in [[0.0, 0.0, 0.3], [0.02, 0.01, 0.3], [0.1, 0.05, 0.3]] {
        let skew = Skew::new(sigma, theta)?;
        let below =
            inputs.iter().filter(|(v, _)| skew.direction(v.as_dvec3().to_array())[2] < 0.0).count();
        println!(
            "turned by {theta:?}: {:.1}% of the views below the lobe's horizon",
            below as f64 / 40.96
        );
        compare(&tables, &inputs, sigma, skew)?;
        let exact = model::Ellipsoid::new(skew, 2.0)?;
        let lune = exact.lune().expect("gamma is 2");
        let draw = |v: Vec3, u: [f32; 2]| lune.sample_lune(v.as_dvec3(), u.map(f64::from)).z as f32;
        let time = (0..ROUNDS).fold(f64::INFINITY, |least, _| least.min(round(&inputs, draw)));
        println!("lune, double precision, gamma 2: {time:.1}");
    }
    Ok(())
}

/// The density of a normal that is drawn.
fn with_density(lobe: &impl MicrofacetDistribution) -> impl Fn(Vec3, [f32; 2]) -> f32 {
    |v, u| lobe.visible_normal_pdf(v, lobe.sample_visible_normal(v, u))
}

type Inputs = [(Vec3, [f32; 2])];

fn compare(
    tables: &Tables,
    inputs: &Inputs,
    sigma: [f64; 2],
    skew: Skew,
) -> Result<(), Box<dyn Error>> {
    println!("gamma  untilted  ellipsoid  ratio   with density: untilted  ellipsoid  ratio");
    for gamma in [1.6, 2.0, 4.0, f64::INFINITY] {
        let untilted = tables.student_t(sigma, gamma)?;
        let skewed = tables.ellipsoid(skew, gamma)?;
        let [a, b] = least(
            || round(inputs, |v, u| untilted.sample_visible_normal(v, u)[2]),
            || round(inputs, |v, u| skewed.sample_visible_normal(v, u)[2]),
        );
        let (of_untilted, of_skewed) = (with_density(&untilted), with_density(&skewed));
        let [c, d] = least(|| round(inputs, &of_untilted), || round(inputs, &of_skewed));
        println!("{gamma:<8} {a:>6.1} {b:>10.1} {:>6.2} {c:>21.1} {d:>10.1} {:>6.2}", b / a, d / c);
    }
    Ok(())
}
