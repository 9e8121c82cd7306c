//! The equations of Ribardière et al. 2017 (doi:10.1111/cgf.13137) that define the distribution and
//! sample it, in numbers. Those of masking, eq. 13–15 and 21–23, are in the study
//! `printed_formulas`.
//!
//! `cargo run --release -p microfacet-study -- student_t_paper` prints them.

use std::error::Error;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use microfacet_model::statistics::chi_square;
use microfacet_model::{MicrofacetDistribution, StudentT};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::Outcome;

/// σx, σy and γ: round and not, light and heavy tails.
const MATERIALS: [([f64; 2], f64); 6] = [
    ([0.5, 0.5], 1.55),
    ([0.1, 0.1], 2.0),
    ([1.0, 1.0], 3.0),
    ([0.05, 0.4], 1.8),
    ([0.7, 0.3], 8.0),
    ([0.3, 0.3], f64::INFINITY),
];

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    println!(
        "Integral of D (m·n) over the hemisphere (eq. 11; eq. 18 where sigma differs), and p of"
    );
    println!(
        "chi-square of 10^6 normals by eq. 16-17 and 19-20: with the azimuth of the slopes in"
    );
    println!("the quadrant of 2 pi u, and as the principal value of the arctangent in eq. 19.");
    println!(
        "{:<12}{:>6}{:>14}{:>14}{:>12}{:>18}{:>12}",
        "sigma", "gamma", "integral - 1", "p, quadrant", "x < 0", "p, principal", "x < 0"
    );
    for (seed, (sigma, gamma)) in (0..).zip(MATERIALS) {
        let material = StudentT::new(sigma, gamma)?;
        let (p, leaning) = draws(&material, false, seed);
        let name = format!("{}, {}", sigma[0], sigma[1]);
        let error = integral(&material) - 1.0;
        print!("{name:<12}{gamma:>6}{error:>14.1e}{p:>14.3}{leaning:>12.4}");
        if sigma[0] == sigma[1] {
            println!("{:>18}{:>12}", "-", "-");
        } else {
            let (p, leaning) = draws(&material, true, seed);
            println!("{p:>18.3}{leaning:>12.4}");
        }
    }
    println!("\nMembers: largest difference of D relative to D(0), sigma = 0.3, theta by degrees");
    let ggx = |cos: f64, a: f64| a * a / (PI * (cos * cos * (a * a - 1.0) + 1.0).powi(2));
    let beckmann = |cos: f64, a: f64| {
        let tan2 = (1.0 - cos * cos) / (cos * cos);
        (-tan2 / (a * a)).exp() / (PI * a * a * cos.powi(4))
    };
    println!("GGX, gamma = 2{:>26.1e}", difference(2.0, ggx)?);
    for gamma in [40.0, 1e2, 1e4, 1e6, f64::INFINITY] {
        println!("{:<18}{:>22.1e}", format!("Beckmann, {gamma}"), difference(gamma, beckmann)?);
    }
    Ok(())
}

/// The largest difference of D from another formula in cos θ and roughness, relative to D(0).
fn difference(gamma: f64, other: impl Fn(f64, f64) -> f64) -> Result<f64, Box<dyn Error>> {
    let sigma = 0.3;
    let material = StudentT::new(sigma, gamma)?;
    let at = |degrees: u32| {
        let (sin, cos) = libm::sincos(f64::from(degrees).to_radians());
        (material.d(DVec3::new(sin, 0.0, cos)) - other(cos, sigma)).abs()
    };
    Ok((0..90).map(at).fold(0.0, f64::max) / material.d(DVec3::Z))
}

/// ∫ D(m) (m·n) dm by the trapezoidal rule over the azimuth and ln tan θ, where it converges fast.
fn integral(material: &StudentT) -> f64 {
    const AZIMUTHS: u32 = 256;
    const STEP: f64 = 1.0 / 16.0;
    let along = |azimuth: u32| {
        let (sin, cos) = libm::sincos(TAU * f64::from(azimuth) / f64::from(AZIMUTHS));
        let at = |i: i32| {
            let tan = libm::exp(STEP * f64::from(i));
            let z = 1.0 / libm::hypot(1.0, tan);
            let m = DVec3::new(tan * z * cos, tan * z * sin, z);
            // dm = sin θ dθ dφ, and dθ = cos²θ · tan θ d(ln tan θ).
            material.d(m) * z * (tan * z) * (z * z * tan)
        };
        (-400..=800).map(at).sum::<f64>()
    };
    (0..AZIMUTHS).map(along).sum::<f64>() * STEP * TAU / f64::from(AZIMUTHS)
}

/// p of chi-square of a million normals drawn from D (m·n), and the share of them that lean towards
/// −x; by the principal value of the arctangent of eq. 19, or in the quadrant of 2πu.
fn draws(material: &StudentT, principal: bool, seed: u64) -> (f64, f64) {
    const BINS: usize = 16;
    const DRAWS: usize = 1_000_000;
    let mut rng = StdRng::seed_from_u64(seed);
    let mut counts = vec![0; BINS * BINS];
    let mut leaning = 0;
    for _ in 0..DRAWS {
        let mut m = material.sample_ndf([rng.random(), rng.random()]);
        if principal && m.x < 0.0 {
            // arctan(y/x) is the same for (−x, −y).
            (m.x, m.y) = (-m.x, -m.y);
        }
        leaning += usize::from(m.x < 0.0);
        // The unit slope, of which r² has the distribution of eq. 16 and the azimuth is uniform.
        let (x, y) = (m.x / (m.z * material.sigma_x()), m.y / (m.z * material.sigma_y()));
        let (shape, r2) = (material.shape(), x * x + y * y);
        let beyond = match shape.is_beckmann() {
            true => libm::exp(-r2),
            false => libm::exp(-libm::log1p(shape.s() * r2) / shape.s()),
        };
        let around = 0.5 + libm::atan2(y, x) / TAU;
        let bin = |u: f64| ((u * BINS as f64) as usize).min(BINS - 1);
        counts[bin(beyond) * BINS + bin(around)] += 1;
    }
    let expected = vec![DRAWS as f64 / (BINS * BINS) as f64; BINS * BINS];
    (chi_square(&counts, &expected).p, leaning as f64 / DRAWS as f64)
}
