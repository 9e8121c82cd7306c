//! The random walk of light on the Smith microsurface: multiple scattering without a table, as a
//! reference.
//!
//! A ray at height h travels by Smith's Λ until it leaves or meets the surface, where it is
//! reflected off a normal visible from where it came. Heights enter only as C = P(height below h),
//! so that their distribution need not be chosen (Heitz, Hanika, d'Eon & Dachsbacher 2016,
//! eq. 14–16).

use glam::DVec3;

use crate::distribution::MicrofacetDistribution;
use crate::student_t::StudentT;

impl StudentT {
    /// Follows light back from a view above the horizon by a random walk: the direction in which it
    /// leaves and the number of bounces, or `None` if it has not left after `limit` bounces.
    /// `uniform` gives uniform numbers in [0, 1).
    ///
    /// Heitz, Hanika, d'Eon & Dachsbacher 2016, *Multiple-scattering microfacet BSDFs with the
    /// Smith model*, <https://doi.org/10.1145/2897824.2925943>, with F = 1. The directions are
    /// distributed as the multiple-scattering BRDF times the cosine: the share that leaves after
    /// one bounce is the height-correlated albedo E(v), and all light leaves.
    pub fn walk(
        &self,
        v: DVec3,
        limit: usize,
        uniform: &mut impl FnMut() -> f64,
    ) -> Option<(DVec3, usize)> {
        let mut w = -v;
        // The ray starts above the whole surface.
        let mut below = 1.0;
        for bounce in 0..=limit {
            let u = 1.0 - uniform();
            if w.z > 0.0 {
                let lambda = self.lambda(w);
                let escape = libm::pow(below, lambda);
                if u <= escape {
                    return Some((w, bounce));
                }
                // u > C^Λ here, so the height found is above the present one and Λ is positive.
                below = (below * libm::pow(u, -1.0 / lambda)).min(1.0);
            } else {
                // Λ(w) = −1 − Λ(−w) downwards: the ray meets the surface for certain.
                below *= libm::pow(u, 1.0 / (1.0 + self.lambda(-w)));
            }
            let m = self.sample_visible_by_rejection(-w, uniform);
            w = (2.0 * w.dot(m) * -m + w).normalize();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AlbedoIntegrator, Masking};
    use rand::{RngExt, SeedableRng};

    #[test]
    fn conserves_energy_and_has_the_albedo_as_its_first_bounce() {
        let mut random = rand::rngs::StdRng::seed_from_u64(5);
        for (sigma, gamma, cos) in
            [(0.5, 2.0, 0.9), (1.5, 3.0, 0.3), (0.8, f64::INFINITY, 0.05), (0.4, 1.7, 0.6)]
        {
            let material = StudentT::new(sigma, gamma).unwrap();
            let v = DVec3::new(f64::sqrt(1.0 - cos * cos), 0.0, cos);
            let integrator = AlbedoIntegrator::new(*material.shape(), 1e-6);
            let albedo = integrator.reflection(sigma, cos, |_| [1.0]).unwrap();
            let [e] = albedo.of(Masking::HeightCorrelated);
            let walks = 100_000;
            let (mut out, mut first) = (0, 0);
            for _ in 0..walks {
                if let Some((l, bounces)) = material.walk(v, 100_000, &mut || random.random()) {
                    assert!(l.z > 0.0 && (l.length() - 1.0).abs() < 1e-12 && bounces >= 1);
                    out += 1;
                    first += i32::from(bounces == 1);
                }
            }
            assert_eq!(out, walks, "sigma {sigma}, gamma {gamma}");
            let share = f64::from(first) / f64::from(walks);
            let off = (share - e) / (e * (1.0 - e) / f64::from(walks)).sqrt();
            assert!(off.abs() < 4.0, "sigma {sigma}, gamma {gamma}: {share} against {e}");
        }
    }
}
