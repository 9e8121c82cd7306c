//! The round lobes that stand in where an anisotropic one has no table of albedos.

use microfacet_tables::Interval;

use super::albedo;
use crate::scene::Material;

/// The round lobes whose albedos a material gets in place of those of its own lobes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StandIn {
    /// σ of the round lobes, √(σx σy).
    pub sigma: Interval,
    /// How far E, the albedo with F = 1, may be off where cos θ ≥ 0.02.
    pub error: f64,
}

impl StandIn {
    /// Ratios of the larger σ to the smaller up to which the error is known.
    pub const RATIOS: [f64; 7] = [1.25, 1.5, 2.0, 4.0, 10.0, 30.0, f64::INFINITY];
    /// The larger σ up to which the error is known.
    pub const SIGMAS: [f64; 6] = [0.03, 0.1, 0.3, 1.0, 3.0, f64::INFINITY];
    /// The largest difference of E by ratio and by larger σ, over all shapes, both forms of
    /// masking, views and azimuths (`cargo run --profile dist -p microfacet-study -- stand_in`).
    const ERRORS: [[f64; 6]; 7] = [
        [0.04, 0.04, 0.04, 0.06, 0.06, 0.06],
        [0.07, 0.07, 0.07, 0.10, 0.12, 0.12],
        [0.12, 0.12, 0.12, 0.16, 0.22, 0.22],
        [0.23, 0.23, 0.23, 0.27, 0.47, 0.47],
        [0.36, 0.36, 0.36, 0.39, 0.69, 0.69],
        [0.52, 0.52, 0.53, 0.56, 0.80, 0.91],
        [0.86, 0.86, 0.91, 0.92, 0.97, 1.00],
    ];

    /// The stand-in of a material whose albedos are baked; `None` if all its tables are of its own
    /// lobe.
    ///
    /// The axes may vary independently, so that any σx may meet any σy.
    pub fn of(material: &Material) -> Option<Self> {
        let (lobe, sigmas) = (&material.lobe, material.lobe.sigmas());
        let is_own = |tabulated| tabulated == *lobe;
        if albedo::reflectances(material).all(|of| is_own(albedo::tabulated(lobe, &of))) {
            return None;
        }
        let [x, y] = sigmas;
        let ratio = (x.max / y.min).max(y.max / x.min);
        Some(Self { sigma: lobe.round().roughness.x(), error: error(ratio, x.max.max(y.max)) })
    }
}

/// How far E may be off for this ratio of the larger σ to the smaller.
fn error(ratio: f64, sigma: f64) -> f64 {
    let first = |upto: &[f64], x: f64| upto.iter().position(|&end| x <= end);
    let known = first(&StandIn::RATIOS, ratio).zip(first(&StandIn::SIGMAS, sigma));
    known.map_or(1.0, |(ratio, sigma)| StandIn::ERRORS[ratio][sigma])
}

#[cfg(test)]
mod tests {
    use microfacet_model::{AlbedoIntegrator, Shape};
    use microfacet_sampler::Masking;
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::scene::Scene;

    fn stand_in(sigma: &str, fresnel: &str) -> Option<StandIn> {
        let recipe = format!(
            "[[material]]\nname = \"m\"\nsigma = {sigma}\ngamma = 3\nfresnel = {fresnel}\n"
        );
        StandIn::of(&Scene::from_recipe_str(&recipe).unwrap().materials[0])
    }

    #[test]
    fn only_lobes_without_a_table_of_their_own_have_a_stand_in() {
        let (mirror, glass) = ("\"mirror\"", "{ dielectric = 1.5 }");
        for round in ["0.3", "{ min = 0.1, max = 0.4 }"] {
            assert_eq!([mirror, glass].map(|of| stand_in(round, of)), [None; 2], "{round}");
        }
        assert_eq!(stand_in("[0.1, 0.4]", mirror), None);
        assert_eq!(stand_in("[0.1, 0.4]", glass), None);
        // A range of indices has tables of round lobes alone.
        let glasses = "{ dielectric = { min = 1.3, max = 1.6 } }";
        let brushed = stand_in("[0.1, 0.4]", glasses).unwrap();
        assert_eq!(brushed, StandIn { sigma: Interval::point(0.2), error: 0.27 });
        let range =
            stand_in("[{ min = 0.1, max = 0.4 }, { min = 0.4, max = 0.9 }]", mirror).unwrap();
        // 0.1 may meet 0.9.
        let sigma = Interval { min: 0.1f64.sqrt() * 0.4f64.sqrt(), max: 0.6 };
        assert!((range.sigma.min - sigma.min).abs() + (range.sigma.max - sigma.max).abs() < 1e-12);
        assert_eq!(range.error, 0.39);
        let smooth = stand_in("[{ min = 0, max = 0.4 }, 0.3]", mirror).unwrap();
        assert_eq!((smooth.sigma.min, smooth.error), (0.0, 0.92));
        // Equal ranges are independent.
        let equal = stand_in("[{ min = 0.2, max = 0.25 }, { min = 0.2, max = 0.25 }]", mirror);
        assert_eq!(equal.unwrap().error, 0.04);
    }

    #[test]
    fn no_lobe_is_further_off_than_stated() {
        // The certificates of docs/albedo.md.
        for (sigma, ratio, off) in [
            (0.6, 2.0, 0.067),
            (0.6, 4.0, 0.154),
            (1.0, 10.0, 0.351),
            (0.1, 10.0, 0.079),
            (3.0, 10.0, 0.607),
        ] {
            assert!(error(ratio, sigma) >= off, "{sigma} {ratio}");
        }
        let mut rng = StdRng::seed_from_u64(1);
        let mut nearest = 0.0_f64;
        for gamma in [1.53, 1.7, 2.2, 6.0, f64::INFINITY] {
            let model = AlbedoIntegrator::new(Shape::new(gamma).unwrap(), 1e-3);
            for _ in 0..200 {
                let ratio = libm::exp(rng.random_range(0.0..4.0));
                let sigma = libm::exp(rng.random_range(-4.0..1.5));
                let (cos, phi) = (rng.random_range(0.02..1.0), rng.random_range(0.0..1.6));
                let lobe = [sigma, sigma / ratio];
                let exact = model.reflection_anisotropic(lobe, cos, phi, |_| [1.0]).unwrap();
                let round = model.reflection(sigma / ratio.sqrt(), cos, |_| [1.0]).unwrap();
                for form in Masking::ALL {
                    let off = (exact.of(form)[0] - round.of(form)[0]).abs();
                    let stated = error(ratio, sigma);
                    assert!(
                        off <= stated,
                        "gamma {gamma}, {lobe:?}, {cos} {phi}: {off} > {stated}"
                    );
                    nearest = nearest.max(off / stated);
                }
            }
        }
        assert!(nearest > 0.6, "the bound is far from what is found: {nearest}");
    }
}
