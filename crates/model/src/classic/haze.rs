//! A core and a haze: the normals of two GGX in one distribution.

use core::f64::consts::FRAC_PI_2;

use super::{ClassicError, Isotropic, Member, check};
use crate::student_t::StudentT;

/// The normals of two GGX, D = (1−w) D_core + w D_haze.
///
/// Renderers widen the tail of GGX by a second one, most of them as a sum of two reflections, each
/// with a masking of its own (OpenPBR 1.2, *Specular haze*). Here the normals are mixed, on one
/// surface: every light and view sees both, so that Λ, which is linear in the density of slopes, is
/// (1−w) Λ_core + w Λ_haze for all of them. That is the symmetric blend of d'Eon, Bitterli,
/// Weidlich and Zeltner 2023, *Microfacet Theory for Non-Uniform Heightfields*
/// (<https://doi.org/10.1145/3588432.3591486>).
///
/// Its slope density falls like r⁻⁴ at any weight, as that of GGX: the tail is lifted, and not made
/// longer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Haze {
    core: Member,
    haze: Member,
    /// σ of the core and of the haze.
    sigma: [f64; 2],
    weight: f64,
}

impl Haze {
    /// The mix of a GGX of roughness `sigma_core` and, with the share `weight` of the projected
    /// area, one of `sigma_haze`. The haze may be the narrower.
    ///
    /// # Errors
    /// [`ClassicError`] unless both roughnesses are in [1e-75, 1e75], so that D is a number, and
    /// the weight is in [0, 1].
    pub fn new(sigma_core: f64, sigma_haze: f64, weight: f64) -> Result<Self, ClassicError> {
        let member = |name, sigma: f64| {
            check((1e-75..=1e75).contains(&sigma), name, sigma, "[1e-75, 1e75]")?;
            Ok(Member::trowbridge_reitz(sigma).expect("the roughness was checked"))
        };
        let core = member("sigma_core", sigma_core)?;
        let haze = member("sigma_haze", sigma_haze)?;
        check((0.0..=1.0).contains(&weight), "weight", weight, "[0, 1]")?;
        Ok(Self { core, haze, sigma: [sigma_core, sigma_haze], weight })
    }

    /// A number of the mix from those of the core and the haze.
    fn mix(&self, of: impl Fn(&Member) -> f64) -> f64 {
        (1.0 - self.weight) * of(&self.core) + self.weight * of(&self.haze)
    }
}

impl Isotropic for Haze {
    fn peak(&self) -> f64 {
        self.mix(Member::peak)
    }

    fn relative_d(&self, theta: f64) -> f64 {
        self.mix(|one| one.peak() * one.relative_d(theta)) / self.peak()
    }

    fn cdf(&self, theta: f64) -> f64 {
        self.mix(|one| one.cdf(theta))
    }

    /// In closed form: the share 1 − u beyond θ is Σ wᵢ σᵢ²/(σᵢ² + tan²θ), of second degree in
    /// tan²θ.
    fn sample_theta(&self, u: f64) -> f64 {
        let (scale, w) = (self.sigma[0].max(self.sigma[1]), self.weight);
        let [a, b] = self.sigma.map(|sigma| (sigma / scale) * (sigma / scale));
        // (1−u) t² + p t − u a b = 0 for t = tan²θ, with one root that is not negative.
        let rest = 1.0 - u;
        let p = if u < 0.5 {
            w * a + (1.0 - w) * b - u * (a + b)
        } else {
            rest * (a + b) - ((1.0 - w) * a + w * b)
        };
        let root = (p * p + 4.0 * rest * u * a * b).sqrt();
        // The form without cancellation.
        let t = if p > 0.0 { 2.0 * u * a * b / (p + root) } else { (root - p) / (2.0 * rest) };
        if t.is_finite() { libm::atan(scale * t.sqrt()) } else { FRAC_PI_2 }
    }

    fn student_t(&self) -> Option<StudentT> {
        let [core, haze] = self.sigma;
        if self.weight == 0.0 || core == haze {
            return self.core.student_t();
        }
        if self.weight == 1.0 { self.haze.student_t() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::classic::Radial;
    use crate::distribution::MicrofacetDistribution;

    fn haze(sigma_core: f64, sigma_haze: f64, weight: f64) -> Haze {
        Haze::new(sigma_core, sigma_haze, weight).unwrap()
    }

    #[test]
    fn without_a_second_lobe_it_is_a_ggx() {
        for (mix, sigma) in [
            (haze(0.2, 0.7, 0.0), 0.2),
            (haze(0.2, 0.7, 1.0), 0.7),
            (haze(0.3, 0.3, 0.4), 0.3),
            (haze(1e-6, 1e-6, 0.5), 1e-6),
        ] {
            let ggx = Member::trowbridge_reitz(sigma).unwrap();
            assert_eq!(mix.student_t(), ggx.student_t());
            for theta in [0.0, 1e-6, 0.1, 0.8, 1.57] {
                assert!((mix.d(theta) / ggx.d(theta) - 1.0).abs() < 1e-14, "{sigma} at {theta}");
            }
            for u in [0.0, 1e-12, 0.3, 0.999_999, 1.0] {
                let (got, want) = (mix.sample_theta(u), ggx.sample_theta(u));
                assert!((got - want).abs() <= 1e-9 * want, "{sigma}: {u} gives {got}, not {want}");
            }
        }
        assert!(haze(0.2, 0.7, 1e-9).student_t().is_none());
    }

    #[test]
    fn angles_are_those_of_their_shares() {
        for mix in [
            haze(0.1, 0.4, 0.3),
            haze(0.4, 0.1, 0.3),
            haze(1e-4, 1.0, 0.5),
            haze(1e-60, 1e60, 0.2),
            haze(1e-75, 1e-70, 0.9),
        ] {
            assert_eq!((mix.sample_theta(0.0), mix.sample_theta(1.0)), (0.0, FRAC_PI_2));
            let mut last = 0.0;
            for u in [1e-12, 1e-3, 0.2, 0.499, 0.5, 0.501, 0.9, 0.999] {
                let theta = mix.sample_theta(u);
                assert!(theta >= last, "{mix:?}: {u}");
                // Within rounding of the horizon the angle has no digits of its tangent left.
                if theta < FRAC_PI_2 - 1e-6 {
                    assert!((mix.cdf(theta) / u - 1.0).abs() < 1e-9, "{mix:?}: {u} gives {theta}");
                }
                last = theta;
            }
        }
    }

    #[test]
    fn masking_is_the_mix_of_the_two() {
        for (core, wide, weight) in [(0.1, 0.4, 0.3), (0.02, 0.8, 0.5), (1e-3, 1.0, 0.1)] {
            let mix = haze(core, wide, weight);
            let radial = Radial::new(&mix);
            let [a, b] = [core, wide].map(|sigma| StudentT::ggx(sigma).unwrap());
            for theta in [0.1, 0.8, 1.4, 1.55] {
                let v = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                let want = (1.0 - weight) * a.lambda(v) + weight * b.lambda(v);
                let got = radial.lambda(v);
                assert!((got - want).abs() < 1e-9 * (1.0 + want), "{mix:?}: {got}, not {want}");
            }
        }
    }

    #[test]
    fn refusals_name_the_parameter() {
        let refused = |core, haze, weight| Haze::new(core, haze, weight).unwrap_err().to_string();
        assert!(refused(0.0, 0.1, 0.5).starts_with("sigma_core = 0: must lie in [1e-75"));
        assert!(refused(0.1, f64::INFINITY, 0.5).starts_with("sigma_haze = inf"));
        assert!(refused(f64::NAN, 0.2, 0.5).starts_with("sigma_core = NaN"));
        assert!(refused(0.1, 0.2, 1.1).starts_with("weight = 1.1: must lie in [0, 1]"));
        assert!(refused(0.1, 0.2, f64::NAN).starts_with("weight = NaN"));
    }
}
