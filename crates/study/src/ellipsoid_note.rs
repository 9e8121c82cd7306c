//! The claims of the Ellipsoid note (Walter, Dong, Marschner, Greenberg 2015, supplemental material
//! of doi:10.1145/2815618) in numbers: weights of samples are never above one, and of its three
//! samplers of visible normals the third rejects nothing.
//!
//! `cargo run --release -p microfacet-study -- ellipsoid_note` prints them. Ellipsoids are drawn at
//! random, with roughnesses from 0.03 to 2 and tilts up to 0.6 radians, and views evenly over the
//! hemisphere of the macro normal. γ = 2 is the note's own distribution; the others are those of
//! the family.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::DVec3;
use microfacet_model::{Ellipsoid, Lune, Masking, MicrofacetDistribution, Skew};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use crate::Outcome;

/// Ellipsoids of each shape, and draws of each.
const ELLIPSOIDS: u64 = 1000;
const DRAWS: usize = 1000;

/// A tilted ellipsoid, and a view above the surface.
fn any(rng: &mut StdRng, gamma: f64) -> (Ellipsoid, DVec3) {
    let sigma = [(); 2].map(|()| libm::exp10(rng.random_range(-1.5..0.3)));
    let [x, y] = [(); 2].map(|()| rng.random_range(-0.6..0.6));
    let skew = Skew::new(sigma, [x, y, rng.random_range(-PI..PI)]);
    let ellipsoid = Ellipsoid::new(skew.expect("moderate angles"), gamma);
    let (z, phi) = (1.0 - rng.random::<f64>(), rng.random_range(-PI..PI));
    let (sin, cos) = libm::sincos(phi);
    let r = ((1.0 - z) * (1.0 + z)).sqrt();
    (ellipsoid.expect("above 3/2"), DVec3::new(r * cos, r * sin, z))
}

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    println!("Weights G2/G1 of reflected samples, {} of each shape:", ELLIPSOIDS * DRAWS as u64);
    println!("{:<8}{:>24}{:>24}", "gamma", "G1(v) G1(l): largest", "correlated: largest");
    for gamma in [1.6, 2.0, 2.7, 8.0, f64::INFINITY] {
        let [a, b] = (0..ELLIPSOIDS)
            .into_par_iter()
            .map(|seed| largest_weights(seed, gamma))
            .reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        println!("{gamma:<8}{:>24}{:>24}", beside_one(a), beside_one(b));
    }

    println!(
        "\nShare of draws that are accepted, gamma = 2, by the cosine of view and lobe in unit"
    );
    println!("space; in brackets what geometry gives, (1 + cos)/2 and pi/4 (1 + min(cos, 0)):");
    println!(
        "{:<16}{:>8}{:>22}{:>22}{:>12}",
        "cos", "views", "version 1", "version 2", "version 3"
    );
    let all: Vec<Tries> = (0..ELLIPSOIDS).into_par_iter().map(tries).collect();
    for low in [-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75] {
        let inside = |t: &&Tries| (low..low + 0.25).contains(&t.cos.min(1.0 - 1e-12));
        line(&format!("{low:>5} to {:>5}", low + 0.25), all.iter().filter(inside));
    }
    line("all", all.iter());
    Ok(())
}

/// A number close to 1, as its distance from 1.
fn beside_one(x: f64) -> String {
    match x - 1.0 {
        0.0 => "1".into(),
        more if more > 0.0 => format!("1 + {more:.1e}"),
        less => format!("1 - {:.1e}", -less),
    }
}

/// The largest weight of one ellipsoid by form of masking.
fn largest_weights(seed: u64, gamma: f64) -> [f64; 2] {
    let mut rng = StdRng::seed_from_u64(seed);
    let (e, v) = any(&mut rng, gamma);
    let mut largest = [0.0; 2];
    for _ in 0..DRAWS {
        let m = e.sample_visible_normal(v, [rng.random(), rng.random()]);
        let l = 2.0 * v.dot(m) * m - v;
        for (largest, masking) in
            largest.iter_mut().zip([Masking::Uncorrelated, Masking::HeightCorrelated])
        {
            *largest = f64::max(*largest, e.reflection_weight(v, l, masking));
        }
    }
    largest
}

/// What the samplers needed for [`DRAWS`] normals of one ellipsoid.
struct Tries {
    cos: f64,
    /// By version.
    draws: [usize; 3],
}

fn tries(seed: u64) -> Tries {
    let mut rng = StdRng::seed_from_u64(seed);
    let (e, v) = any(&mut rng, 2.0);
    let [x, y, z] = e.skew().direction(v.to_array());
    let lune = e.lune().expect("gamma is 2");
    // Every try takes two random numbers.
    let mut count = |draw: Draw| {
        let mut numbers = 0;
        for _ in 0..DRAWS {
            let m = draw(&lune, v, &mut || {
                numbers += 1;
                rng.random()
            });
            assert!(m.z >= 0.0 && m.dot(v) >= -1e-9, "{m} is not visible from {v}");
        }
        numbers / 2
    };
    let draws = [
        count(&mut |lune, v, mut uniform| lune.sample_sphere(v, &mut uniform)),
        count(&mut |lune, v, mut uniform| lune.sample_silhouette(v, &mut uniform)),
        count(&mut |lune, v, uniform| lune.sample_lune(v, [uniform(), uniform()])),
    ];
    Tries { cos: z / libm::hypot(z, libm::hypot(x, y)), draws }
}

type Draw<'a> = &'a mut dyn FnMut(&Lune<'_>, DVec3, &mut dyn FnMut() -> f64) -> DVec3;

fn line<'a>(name: &str, some: impl Iterator<Item = &'a Tries>) {
    let some: Vec<&Tries> = some.collect();
    // The accepted share of all draws; each ellipsoid accepts as many.
    let share = |version: usize| {
        let draws: usize = some.iter().map(|t| t.draws[version]).sum();
        (some.len() * DRAWS) as f64 / draws as f64
    };
    let expected =
        |of: fn(f64) -> f64| some.len() as f64 / some.iter().map(|t| 1.0 / of(t.cos)).sum::<f64>();
    println!(
        "{name:<16}{:>8}{:>12.4}  ({:.4}){:>12.4}  ({:.4}){:>12.4}",
        some.len(),
        share(0),
        expected(|cos| 0.5 * (1.0 + cos)),
        share(1),
        expected(|cos| FRAC_PI_4 * (1.0 + cos.min(0.0))),
        share(2),
    );
}
