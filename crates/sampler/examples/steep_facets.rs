//! The share of the light transmitted by rough glass of γ < 2 that goes through facets so steep
//! that it is only sampled, and how often the density of another sample, computed from its
//! directions, is off: `cargo run --release -p microfacet-sampler --example steep_facets`.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use microfacet_sampler::{Bsdf, BsdfSample, BsdfSettings, Dielectric, Event, Tables, Transport};

const SAMPLES: usize = 200_000;
const GAMMAS: [f64; 8] = [1.501, 1.52, 1.55, 1.6, 1.65, 1.7, 1.8, 1.9];
const ETAS: [f64; 4] = [1.5, 1.0 / 1.5, 1.05, 3.0];
const THETAS: [f32; 3] = [0.0, 50.0, 80.0];

fn main() {
    println!(
        "sigma 0.3; of the light transmitted at theta = {THETAS:?} degrees, per cent only sampled;"
    );
    println!(
        "of all other samples, those whose density is found again off by more than 1 % / 10 %"
    );
    println!("gamma   eta     only sampled           off by 1 %   10 %");
    for gamma in GAMMAS {
        let lobe = Tables::embedded().student_t(0.3, gamma).expect("a shape of the default set");
        for eta in ETAS {
            let glass = Dielectric::new(lobe.clone(), eta, BsdfSettings::new())
                .expect("an index in the range");
            let glass = glass.with_channels::<1>();
            let rows = THETAS.map(|theta| row(&glass, theta.to_radians()));
            let [one, ten] = [1, 2].map(|i| rows.iter().map(|row| row[i]).fold(0.0, f64::max));
            let [a, b, c] = rows.map(|row| 100.0 * row[0]);
            println!("{gamma:<7} {eta:<6.4} {a:6.2} {b:6.2} {c:6.2}   {one:11.1e} {ten:8.1e}");
        }
    }
}

/// The share of the transmitted light that is only sampled, and the shares of other transmitted
/// samples whose density, computed from the directions, is off by more than one and ten per cent.
fn row<B: Bsdf<1>>(glass: &B, theta: f32) -> [f64; 3] {
    let v = Vec3::new(theta.sin(), 0.0, theta.cos());
    let mut random = StdRng::seed_from_u64(1);
    let (mut light, mut counts) = ([0.0; 2], [0; 3]);
    for _ in 0..SAMPLES {
        let u = [random.random(), random.random()];
        let Some((BsdfSample { l, weight, event: Event::Transmission, delta, .. }, pdf)) =
            glass.sample_with_pdf(v, random.random(), u, Transport::Importance)
        else {
            continue;
        };
        light[usize::from(delta)] += f64::from(weight[0]);
        if !delta {
            let off = (f64::from(glass.pdf(v, l)) / f64::from(pdf) - 1.0).abs();
            counts[0] += 1;
            counts[1] += usize::from(!(off <= 0.01));
            counts[2] += usize::from(!(off <= 0.1));
        }
    }
    let share = |count: usize| count as f64 / (counts[0] as f64).max(1.0);
    [light[1] / (light[0] + light[1]), share(counts[1]), share(counts[2])]
}
