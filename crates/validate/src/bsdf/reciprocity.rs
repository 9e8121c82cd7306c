//! Helmholtz reciprocity: f(v, l)/n_v² = f(l, v)/n_l², of reflected and of transmitted radiance.

use glam::{DVec3, Vec3};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

use microfacet_sampler::{Bsdf, Compensation, MicrofacetDistribution, Tables, Transport};

use super::configuration::Configuration;
use super::specimen::{LobeOf, Specimen, Surface, Unmade};

/// Allowed difference of the two, relative to the larger.
pub const TOLERANCE: f64 = 1e-4;
/// An f below this fraction of 1/σxσy, about that of its peak, is not compared: the exponent of a
/// tail turns rounding of the slope into a relative error.
const LEAST: f32 = 1e-4;

/// The half vector n_v v + n_l l must have this length, times σ, and this z: below, rounding of
/// directions to single precision moves the facet's slope by more than 1e-5 of σ or of itself.
const RESOLVED: f64 = 4e-3;
const STEEP: f64 = 0.01;
/// Below this cosine of a refracting facet, too, rounding moves its slope.
const EDGE_ON: f64 = 0.01;
/// The square of a facet's cosine must be this far from that of the critical angle, where F rises
/// like a square root, which magnifies rounding.
const CRITICAL: f64 = 1e-3;

/// The largest difference, and where it was found.
#[derive(Clone, Copy, Debug)]
pub struct Worst {
    /// Relative difference.
    pub difference: f64,
    /// The BSDF.
    pub specimen: Specimen,
    /// One direction.
    pub v: Vec3,
    /// The other.
    pub l: Vec3,
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Pairs of directions that were compared, reflected and transmitted.
    pub pairs: [usize; 2],
    /// The worst of all lobes, except tilted ones where a G1 is 1.
    pub worst: Option<Worst>,
    /// The worst of tilted lobes where a G1 is 1: the lobe's projected area exceeds that of the
    /// surface, its G1 is clamped, and f is not reciprocal.
    pub clamped: Option<Worst>,
}

impl Outcome {
    /// Whether pairs were compared, and all agree that should.
    pub fn passed(&self) -> bool {
        // Written so that a NaN fails.
        self.pairs != [0; 2] && self.worst.is_none_or(|worst| worst.difference <= TOLERANCE)
    }
}

/// Compares f for `count` random pairs of directions of each configuration, except those with
/// Turquin's factor, which is not reciprocal.
///
/// # Errors
/// [`Unmade`] for a configuration whose BSDF cannot be made.
pub fn run(
    tables: &Tables,
    configurations: &[Configuration],
    count: usize,
) -> Result<Outcome, Unmade> {
    let reciprocal = configurations
        .par_iter()
        .filter(|one| one.specimen.compensation != Compensation::Turquin)
        .map(|one| compare(tables, &one.specimen, one.seed, count))
        .collect::<Result<Vec<_>, Unmade>>()?;
    let mut all = Outcome { pairs: [0; 2], worst: None, clamped: None };
    for one in reciprocal {
        all.pairs = [0, 1].map(|i| all.pairs[i] + one.pairs[i]);
        all.worst = larger(all.worst, one.worst);
        all.clamped = larger(all.clamped, one.clamped);
    }
    Ok(all)
}

fn larger(a: Option<Worst>, b: Option<Worst>) -> Option<Worst> {
    match (a, b) {
        // A NaN is kept, whichever it is.
        (Some(a), Some(b)) if a.difference.is_nan() || a.difference > b.difference => Some(a),
        (a, b) => b.or(a),
    }
}

/// A direction, uniformly distributed over the sphere.
fn direction(random: &mut StdRng) -> Vec3 {
    let (z, turn) = (random.random_range(-1.0..1.0_f64), random.random_range(0.0..1.0_f64));
    let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos, r * sin, z).as_vec3()
}

/// The index of refraction on the side of a direction.
fn index_at(specimen: &Specimen, d: Vec3) -> f64 {
    match specimen.surface {
        Surface::Dielectric(eta) if d.z < 0.0 => f64::from(eta as f32),
        _ => 1.0,
    }
}

/// Whether rounding of the directions decides the facet between them, or its reflectance.
fn is_rounding(specimen: &Specimen, v: Vec3, l: Vec3) -> bool {
    let half = v.as_dvec3() * index_at(specimen, v) + l.as_dvec3() * index_at(specimen, l);
    let narrow = f64::from(specimen.sigma[0].min(specimen.sigma[1]));
    let critical = match specimen.surface {
        Surface::Dielectric(eta) | Surface::Plastic(eta, _) if v.z * l.z > 0.0 => {
            let eta = f64::from(eta as f32);
            let relative = if v.z > 0.0 { eta } else { 1.0 / eta };
            let square = 0.5 * (1.0 + v.as_dvec3().dot(l.as_dvec3()));
            (square - (1.0 - relative * relative)).abs() < CRITICAL
        }
        _ => false,
    };
    let facing = |d: Vec3| half.dot(d.as_dvec3()).abs() / half.length();
    let edge_on = v.z * l.z < 0.0 && facing(v).min(facing(l)) < EDGE_ON;
    critical || edge_on || half.length() * narrow < RESOLVED || half.z.abs() < STEEP
}

/// Compares f for `count` random pairs of directions of one BSDF.
///
/// # Errors
/// [`Unmade`] if it cannot be made.
pub fn compare(
    tables: &Tables,
    specimen: &Specimen,
    seed: u64,
    count: usize,
) -> Result<Outcome, Unmade> {
    let (bsdf, lobe) = (specimen.bsdf(tables)?, specimen.lobe_of_tables()?);
    let mut random = StdRng::seed_from_u64(seed);
    let mut all = Outcome { pairs: [0; 2], worst: None, clamped: None };
    let least = LEAST / (specimen.sigma[0] * specimen.sigma[1]);
    for _ in 0..count {
        let v = direction(&mut random);
        // Half of the lights are drawn, so that peaks are compared.
        let (choice, u) = (random.random(), [random.random(), random.random()]);
        let l = match random.random::<bool>() {
            true => direction(&mut random),
            false => match bsdf.sample(v, choice, u, Transport::Radiance) {
                Some(sample) => sample.l.into(),
                None => continue,
            },
        };
        // Light that goes back is that of the view after half a turn.
        let turned = Vec3::new(-v.x, -v.y, v.z);
        if is_rounding(specimen, v, l) || specimen.back > 0.0 && is_rounding(specimen, turned, l) {
            continue;
        }
        let f = |v, l| {
            let [f, ..] = bsdf.eval(v, l, Transport::Radiance);
            let index = index_at(specimen, v);
            (f, f64::from(f) / (index * index))
        };
        let ((there, a), (back, b)) = (f(v, l), f(l, v));
        // Both conditions are false for a NaN, which is therefore compared.
        if there <= least && back <= least || there == f32::MAX || back == f32::MAX {
            continue;
        }
        all.pairs[usize::from(v.z * l.z < 0.0)] += 1;
        let above = |d: Vec3| lobe.g1(if d.z < 0.0 { -d } else { d });
        let tilted = matches!(specimen.lobe, LobeOf::Ellipsoid(_));
        let clamped = tilted && (above(v) == 1.0 || above(l) == 1.0);
        let difference = (a - b).abs() / a.max(b);
        let worst = if clamped { &mut all.clamped } else { &mut all.worst };
        *worst = larger(*worst, Some(Worst { difference, specimen: *specimen, v, l }));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::configuration::configurations;

    #[test]
    fn the_largest_difference_is_kept_and_so_is_one_that_is_not_a_number() {
        let Configuration { specimen, .. } = configurations(1, 1)[0];
        let of = |difference| Some(Worst { difference, specimen, v: Vec3::Z, l: Vec3::Z });
        let kept = |a, b| larger(of(a), of(b)).unwrap().difference;
        assert_eq!((kept(0.1, 0.2), kept(0.2, 0.1)), (0.2, 0.2));
        assert!(kept(0.1, f64::NAN).is_nan() && kept(f64::NAN, 0.1).is_nan());
        assert!(!Outcome { pairs: [1; 2], worst: of(f64::NAN), clamped: None }.passed());
    }
}
