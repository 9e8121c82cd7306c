//! Materials and views to test, spread over the domain that tables cover.

use glam::DVec3;
use rand::{Rng, RngExt, SeedableRng};
use serde::{Deserialize, Serialize};

use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::Tables;
use microfacet_tables::{LobeSpec, MaterialEntry};

/// One material seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Configuration {
    /// σx.
    pub sigma_x: f64,
    /// σy.
    pub sigma_y: f64,
    /// Shape; as JSON a text, since it may be `inf`.
    #[serde(with = "text")]
    pub gamma: f64,
    /// Polar angle of the view, radians.
    pub theta: f64,
    /// Azimuth of the view, radians.
    pub phi: f64,
    /// Seed of the random numbers drawn for it.
    pub seed: u64,
}

impl Configuration {
    /// The view, rounded as the sampler gets it.
    pub fn view(&self) -> glam::Vec3 {
        let (sin, cos) = self.theta.sin_cos();
        let v = DVec3::new(sin * self.phi.cos(), sin * self.phi.sin(), cos.max(0.0));
        v.as_vec3()
    }
}

/// A number as a text.
mod text {
    use std::borrow::Cow;

    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(x: &f64, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(x)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        let text = Cow::<str>::deserialize(from)?;
        text.parse().map_err(|_| D::Error::custom(format!("{text:?} is no number")))
    }
}

/// `count` configurations over the [shapes] of the tables, evenly in s; none if they have none. σ
/// log-uniform in [1e-4, 10] with up to tenfold anisotropy, views over the whole hemisphere, one in
/// eight within 0.01 of grazing or of the normal.
pub fn configurations(tables: &Tables, count: usize, seed: u64) -> Vec<Configuration> {
    let shapes = shapes(tables);
    let mut random = rand::rngs::StdRng::seed_from_u64(seed);
    (0..if shapes.is_empty() { 0 } else { count })
        .map(|i| {
            let s = draw_shape(&shapes, &mut random);
            let sigma_x = log_uniform(&mut random, 1e-4, 10.0);
            let ratio = if i % 3 == 0 { 1.0 } else { log_uniform(&mut random, 0.1, 10.0) };
            let quarter = std::f64::consts::FRAC_PI_2;
            let theta = match i % 16 {
                0 => quarter - log_uniform(&mut random, 1e-6, 1e-2),
                1 => log_uniform(&mut random, 1e-6, 1e-2),
                _ => random.random_range(0.0..quarter),
            };
            Configuration {
                sigma_x,
                sigma_y: (sigma_x * ratio).clamp(1e-4, 10.0),
                gamma: gamma_of_s(s),
                theta,
                phi: random.random_range(-std::f64::consts::PI..std::f64::consts::PI),
                seed: random.next_u64(),
            }
        })
        .collect()
}

pub(super) fn log_uniform(random: &mut impl Rng, low: f64, high: f64) -> f64 {
    (random.random_range(low.ln()..high.ln())).exp()
}

/// A value of s: one draw in sixteen at each end of a range, since tables fail first at Beckmann
/// and at the heaviest tails.
pub(super) fn draw_shape(shapes: &[[f64; 2]], random: &mut impl Rng) -> f64 {
    let [low, high] = shapes[random.random_range(0..shapes.len())];
    match random.random_range(0..16) {
        _ if low == high => low,
        0 => low,
        1 => high,
        _ => random.random_range(low..high),
    }
}

/// The shapes that a set can be tested at, as ranges of s: those of its tables, and GGX in closed
/// form where a material of the set uses it and the tables do not cover it, or where there is no
/// table.
pub fn shapes(tables: &Tables) -> Vec<[f64; 2]> {
    let mut shapes = tables.shapes();
    let mut lobes = tables.provenance().materials.iter().flat_map(MaterialEntry::lobes);
    let ggx = lobes.any(LobeSpec::is_ggx);
    let beside = ggx && !shapes.is_empty() && !tables.tabulates(2.0);
    if beside || tables.tables().is_empty() {
        shapes.push([1.0; 2]);
    }
    shapes
}
