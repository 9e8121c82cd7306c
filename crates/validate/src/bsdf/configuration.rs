//! BSDFs and views to test, drawn over all that a renderer can make.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{Rng, RngExt, SeedableRng};

use microfacet_sampler::port::steep_cosine;
use microfacet_sampler::{Compensation, Masking, Metal};

use super::specimen::{HazeOf, LobeOf, Specimen, Surface};
use crate::configuration::log_uniform;
use crate::stress::direction;

/// One BSDF seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// The BSDF.
    pub specimen: Specimen,
    /// Polar angle of the view, radians; beyond π/2 it is below the surface.
    pub theta: f64,
    /// Azimuth of the view, radians.
    pub phi: f64,
    /// Seed of the random numbers drawn for it.
    pub seed: u64,
}

impl Configuration {
    /// The view, rounded as a renderer has it.
    pub fn view(&self) -> Vec3 {
        direction(self.theta, self.phi)
    }

    /// Elevations at which the density may jump: the ends of the range about the cone l·n =
    /// −(v·n)/η where it would have a pole for γ < 2, and where most lights are only sampled.
    pub fn edges(&self) -> Vec<f64> {
        let Surface::Dielectric(eta) = self.specimen.surface else { return Vec::new() };
        if self.specimen.gamma >= 2.0 {
            return Vec::new();
        }
        let cos = f64::from(self.view().z);
        let (steep, eta) = (f64::from(steep_cosine(eta as f32)), f64::from(eta as f32));
        let eta = if cos > 0.0 { eta } else { 1.0 / eta };
        // A facet's |m·n| is |cos θ_v + η l·n| / |v + η l|, and |v + η l| ≤ 1 + η.
        let (at, width) = (-cos / eta, steep * (1.0 + eta) / eta);
        [at - width, at, at + width]
            .into_iter()
            .filter(|sin| sin.abs() < 1.0)
            .map(f64::asin)
            .collect()
    }
}

impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { specimen, theta, phi, seed } = self;
        write!(f, "{specimen}; view theta {theta:.6}, phi {phi:.6}; seed {seed}")
    }
}

/// Corners of γ, and of η inside over outside.
const GAMMAS: [f64; 6] = [1.501, 1.6, 2.0, 3.0, 8.0, f64::INFINITY];
const ETAS: [f64; 8] = [1.05, 1.33, 1.5, 2.4, 3.0, 1.0 / 1.5, 1.0 / 1.05, 0.4];
const COMPENSATIONS: [Compensation; 3] =
    [Compensation::None, Compensation::Turquin, Compensation::KullaConty];

/// Number of interfaces whose albedos are baked, shared by dielectrics and plastics.
const INTERFACES: usize = 32;

/// `count` configurations: conductors, dielectrics from both sides and plastics in turn, with every
/// kind of lobe, both forms of masking and every compensation. σ is log-uniform in [0.01, 3], since
/// single precision places the light of narrower lobes too coarsely for a test of this kind; one
/// view in eight is within 0.01 of grazing or of the normal. One BSDF in five has haze, and one in
/// six sends light back.
pub fn configurations(count: usize, seed: u64) -> Vec<Configuration> {
    let mut random = StdRng::seed_from_u64(seed);
    let interfaces: Vec<Specimen> = (0..INTERFACES.min(count.div_ceil(5)))
        .map(|i| specimen(Surface::Dielectric(any(&mut random, ETAS)), i % 8 == 0, &mut random))
        .collect();
    let mut apart = StdRng::seed_from_u64(!seed);
    (0..count)
        .map(|i| {
            let one = configuration(i, &interfaces, &mut random);
            Configuration { specimen: paired(i, one.specimen, &mut apart), ..one }
        })
        .collect()
}

/// A specimen with haze, with light that goes back, with both, or as it is.
fn paired(i: usize, specimen: Specimen, random: &mut StdRng) -> Specimen {
    let share = |random: &mut StdRng| match random.random_range(0..4) {
        0 => 0.5,
        1 => 1.0,
        _ => random.random_range(0.01..0.99),
    };
    let (weight, back) = (share(random), share(random));
    let factor = log_uniform(random, 1.2, 8.0) as f32;
    let sigma = specimen.sigma.map(|sigma| (sigma * factor).min(3.0));
    // Haze of a dielectric needs albedos of its own, so that few have it.
    let hazy = matches!(i % 16, 1 | 5 | 9) || i % 32 == 15;
    let tilted = matches!(specimen.lobe, LobeOf::Ellipsoid(_));
    let turns = matches!(i % 16, 7 | 8) || i % 32 == 9;
    Specimen {
        haze: hazy.then_some(HazeOf { weight, sigma }),
        back: if turns && !tilted { back } else { 0.0 },
        ..specimen
    }
}

fn any<T: Copy, const N: usize>(random: &mut impl Rng, all: [T; N]) -> T {
    all[random.random_range(0..N)]
}

/// A specimen with a random lobe.
fn specimen(surface: Surface, tilted: bool, random: &mut StdRng) -> Specimen {
    let lobe = match random.random_range(0..8) {
        _ if tilted => LobeOf::Ellipsoid([
            random.random_range(-0.5..0.5),
            random.random_range(-0.5..0.5),
            random.random_range(-PI..PI),
        ]),
        0..=4 => LobeOf::StudentT,
        5 | 6 => LobeOf::Bounded,
        _ => LobeOf::Ggx,
    };
    let gamma = match random.random() {
        _ if lobe == LobeOf::Ggx => 2.0,
        true => any(random, GAMMAS),
        false => 1.5 + log_uniform(random, 0.02, 30.0),
    };
    let x = log_uniform(random, 0.01, 3.0);
    let ratio = if random.random() { 1.0 } else { log_uniform(random, 0.2, 5.0) };
    let sigma = [x, (x * ratio).clamp(0.01, 3.0)].map(|x| x as f32);
    let (masking, compensation) = (any(random, Masking::ALL), Compensation::None);
    Specimen { lobe, sigma, gamma, surface, masking, compensation, haze: None, back: 0.0 }
}

fn configuration(i: usize, interfaces: &[Specimen], random: &mut StdRng) -> Configuration {
    let reflectances = [0; 3].map(|_| random.random());
    let interface = interfaces[random.random_range(0..interfaces.len())];
    let Surface::Dielectric(eta) = interface.surface else { unreachable!("it was made of one") };
    let conductor =
        |surface, random: &mut StdRng| specimen(surface, random.random_range(0..8) == 0, random);
    let smooth = Specimen { lobe: LobeOf::Smooth, ..interface };
    let plastic = |of: Specimen| Specimen { surface: Surface::Plastic(eta, reflectances), ..of };
    let specimen = match i % 8 {
        0 => conductor(Surface::Mirror, random),
        1 => conductor(Surface::Schlick(reflectances), random),
        2 => {
            let metal = any(random, Metal::ALL);
            conductor(Surface::Metal(metal), random)
        }
        3..=5 => interface,
        6 if i % 32 == 6 => plastic(smooth),
        _ => plastic(interface),
    };
    let theta = match i % 16 {
        0 | 13 => FRAC_PI_2 - log_uniform(random, 1e-4, 1e-2),
        3 | 14 => log_uniform(random, 1e-6, 1e-2),
        // Along the normal.
        4 => 0.0,
        _ => random.random_range(0.0..FRAC_PI_2),
    };
    let below = matches!(specimen.surface, Surface::Dielectric(_)) && random.random();
    Configuration {
        specimen: Specimen { compensation: any(random, COMPENSATIONS), ..specimen },
        theta: if below { PI - theta } else { theta },
        phi: random.random_range(-PI..PI),
        seed: random.next_u64(),
    }
}
