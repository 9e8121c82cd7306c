//! Materials that are made, not measured: any lobes over a Lambert term, with noise.

use std::f64::consts::PI;

use glam::DVec3;
use microfacet_baker::distribution::{DistributionError, Named};
use microfacet_fit::merl::encode;
use microfacet_model::MicrofacetDistribution;
use microfacet_model::classic::{Isotropic, Radial};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A material of one lobe, or of several that share the facets.
pub struct Material {
    /// Shares and lobes.
    pub lobes: Vec<(f64, &'static str)>,
    /// Reflectance of the facets at normal incidence.
    pub f0: [f64; 3],
    /// Albedo of the Lambert term.
    pub lambert: [f64; 3],
    /// Largest relative noise of a value, in either direction.
    pub noise: f64,
}

/// D over the angle, and G1 over the cosine of a direction in equal steps, between which it is
/// linear.
struct Lobe {
    share: f64,
    d: Box<dyn Isotropic>,
    g1: Vec<f64>,
}

impl Lobe {
    fn new((share, text): (f64, &str)) -> Result<Self, DistributionError> {
        let d = text.parse::<Named>()?.build()?;
        let g1 = match d.student_t() {
            Some(lobe) => steps(&lobe),
            None => steps(&Radial::new(&*d)),
        };
        Ok(Self { share, d, g1 })
    }

    fn g1(&self, cos: f64) -> f64 {
        let x = cos * STEPS as f64;
        let i = (x as usize).min(STEPS - 1);
        self.g1[i] + (x - i as f64) * (self.g1[i + 1] - self.g1[i])
    }
}

const STEPS: usize = 4096;

fn steps(lobe: &impl MicrofacetDistribution) -> Vec<f64> {
    let cos = (0..=STEPS).map(|i| i as f64 / STEPS as f64);
    cos.map(|cos| lobe.g1(DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos))).collect()
}

impl Material {
    /// The bytes of its file, with one value in a hundred missing. `place` is the point of a cell
    /// that its value is of: 0 is the start.
    pub fn file(&self, place: f64) -> Result<Vec<u8>, DistributionError> {
        let lobes: Result<Vec<Lobe>, _> = self.lobes.iter().map(|lobe| Lobe::new(*lobe)).collect();
        let lobes = lobes?;
        Ok(encode(place, |cell, at| {
            let mut rng = StdRng::seed_from_u64(cell as u64);
            let [v, l] = at.directions();
            if v.z.min(l.z) <= 0.0 || rng.random_bool(0.01) {
                return [-1.0; 3];
            }
            let specular: f64 = lobes
                .iter()
                .map(|lobe| {
                    let g2 = lobe.g1(v.z) * lobe.g1(l.z);
                    lobe.share * lobe.d.d(at.theta_h) * g2 / (4.0 * v.z * l.z)
                })
                .sum();
            let grazing = (1.0 - at.theta_d.cos()).powi(5);
            [0, 1, 2].map(|c| {
                let reflectance = self.f0[c] + (1.0 - self.f0[c]) * grazing;
                let noise = self.noise * rng.random_range(-1.0..=1.0);
                (self.lambert[c] / PI + reflectance * specular) * (1.0 + noise)
            })
        }))
    }
}
