//! The classic distributions of microfacet normals, normalised alike: ∫ D(m) (m·n) dm = 1.
//!
//! Those that are members of the Student-t family (Beckmann, Trowbridge–Reitz, Blinn–Phong,
//! Hyper-Cauchy) are a [`Member`]; the others have a type each. The isotropic ones implement
//! [`Isotropic`].

mod abc;
mod albedo;
mod ashikhmin_shirley;
mod gauss;
mod gtr;
mod haze;
mod marginal;
mod member;
mod radial;
mod sawicki;
mod schlick;
mod tabulated;

use core::f64::consts::{FRAC_PI_2, PI};

use crate::quadrature;
use crate::student_t::StudentT;

pub use abc::Abc;
pub use albedo::RadialAlbedo;
pub use ashikhmin_shirley::AshikhminShirley;
pub use gauss::Gauss;
pub use gtr::Gtr;
pub use haze::Haze;
pub use marginal::{Across, Beyond, Marginal, MarginalView, Shares, resolved};
pub use member::Member;
pub use radial::Radial;
pub use sawicki::Sawicki;
pub use schlick::Schlick;
pub use tabulated::{Tabulated, TabulatedError};

/// A distribution's parameter outside its range.
#[derive(Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} = {value}: must lie in {range}")]
pub struct ClassicError {
    /// Name of the parameter.
    pub name: &'static str,
    /// Value that was given.
    pub value: f64,
    /// The allowed range, in words.
    pub range: &'static str,
}

microfacet_core::debug_in_words!(ClassicError);

/// An isotropic distribution of normals, a function of the polar angle θ ∈ [0, π/2] of the normal
/// (radians).
pub trait Isotropic: Sync {
    /// D(0), per steradian.
    fn peak(&self) -> f64;

    /// D relative to its peak, D(θ)/D(0): 1 at θ = 0; it may exceed 1 elsewhere for rough surfaces.
    fn relative_d(&self, theta: f64) -> f64;

    /// D(θ) per steradian; 0 outside [0, π/2).
    fn d(&self, theta: f64) -> f64 {
        if (0.0..FRAC_PI_2).contains(&theta) { self.peak() * self.relative_d(theta) } else { 0.0 }
    }

    /// The largest θ at which D is not zero.
    fn support(&self) -> f64 {
        FRAC_PI_2
    }

    /// The angles at which D has a corner or a jump, ascending; none for smooth distributions.
    fn corners(&self) -> Vec<f64> {
        Vec::new()
    }

    /// β_half: the smallest angle (radians) at which D has fallen to half of D(0); `None` if it
    /// never does.
    ///
    /// Relative error 1e-15. By search, unless an implementation has a closed form.
    fn half_angle(&self) -> Option<f64> {
        search_half(|theta| self.relative_d(theta), self.support())
    }

    /// The share of the projected area with normals within θ of n: ∫₀^θ 2π D(t) cos t sin t dt.
    fn cdf(&self, theta: f64) -> f64 {
        let theta = theta.clamp(0.0, self.support());
        projected(|t| self.d(t), self.half_angle().unwrap_or(1.0), theta)
    }

    /// θ of a normal distributed as D(m)(m·n): the inverse of [`cdf`](Self::cdf) at u ∈ [0, 1].
    fn sample_theta(&self, u: f64) -> f64 {
        bisect(0.0, self.support(), |theta| self.cdf(theta) - u)
    }

    /// The member of the Student-t family that equals this distribution; `None` if none does.
    fn student_t(&self) -> Option<StudentT> {
        None
    }
}

/// ∫₀^θ 2π d(t) cos t sin t dt in panels that grow by half, from a quarter of `scale` up to 0.5; d
/// changes over `scale`, and more slowly further out.
fn projected(d: impl Fn(f64) -> f64, scale: f64, theta: f64) -> f64 {
    let integrand = |t: f64| 2.0 * PI * d(t) * libm::cos(t) * libm::sin(t);
    let (mut sum, mut a, mut width) = (0.0, 0.0, 0.25 * scale);
    while a < theta {
        let b = f64::min(a + width, theta);
        sum += quadrature::panel(a, b, integrand);
        (a, width) = (b, f64::min(1.5 * width, 0.5));
    }
    sum
}

/// The first root of unit(θ) = ½ seen on a grid of steps that grow from 1e-6, refined by bisection.
fn search_half(unit: impl Fn(f64) -> f64, support: f64) -> Option<f64> {
    let (mut low, mut high) = (0.0, 1e-6_f64);
    loop {
        high = high.min(support);
        if unit(high) <= 0.5 {
            return Some(bisect(low, high, |theta| 0.5 - unit(theta)));
        }
        if high >= support {
            return None;
        }
        (low, high) = (high, f64::min(1.1 * high, high + 0.01));
    }
}

fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Refuses `value` unless `ok`; `range` says in words what is allowed.
fn check(
    ok: bool,
    name: &'static str,
    value: f64,
    range: &'static str,
) -> Result<(), ClassicError> {
    if ok { Ok(()) } else { Err(ClassicError { name, value, range }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<(&'static str, Box<dyn Isotropic>)> {
        let mut all: Vec<(&'static str, Box<dyn Isotropic>)> = Vec::new();
        for m in [0.01, 0.1, 0.35, 0.6] {
            all.push(("beckmann", Box::new(Member::beckmann(m).unwrap())));
            all.push(("gauss", Box::new(Gauss::new(m).unwrap())));
            all.push(("trowbridge-reitz", Box::new(Member::trowbridge_reitz(m).unwrap())));
            all.push(("schlick", Box::new(Schlick::new(m).unwrap())));
            all.push(("student-t", Box::new(Member::student_t(m, 3.3).unwrap())));
            for gamma in [0.5, 1.0, 1.5, 2.0, 3.0, 8.0] {
                all.push(("gtr", Box::new(Gtr::new(m, gamma).unwrap())));
            }
        }
        for (core, haze, weight) in [(0.1, 0.4, 0.3), (0.02, 0.8, 0.7), (0.5, 0.1, 0.2)] {
            all.push(("haze", Box::new(Haze::new(core, haze, weight).unwrap())));
        }
        for (b, c) in [(0.5, 30.0), (10.0, 0.5), (50.0, 1.0), (300.0, 2.0), (1e4, 1.4)] {
            all.push(("abc", Box::new(Abc::new(b, c).unwrap())));
        }
        for n in [0.5, 1.0, 50.0, 1e4] {
            all.push(("blinn-phong", Box::new(Member::blinn_phong(n).unwrap())));
        }
        for n in [0.0, 0.5, 1.0, 12.0, 1e4] {
            all.push(("sawicki", Box::new(Sawicki::new(n).unwrap())));
        }
        all
    }

    #[test]
    fn all_are_normalised() {
        for (name, d) in all() {
            // Independent of the distribution's own CDF: double-exponential quadrature over
            // θ = support/(1 + e).
            let support = d.support();
            let h = 1.0 / 256.0;
            let mut sum = 0.0;
            for i in -1200..=1200 {
                let t = f64::from(i) * h;
                let e = libm::exp(-PI * libm::sinh(t));
                let theta = support / (1.0 + e);
                let weight = support * e / ((1.0 + e) * (1.0 + e)) * PI * libm::cosh(t) * h;
                if weight > 0.0 {
                    sum += weight * 2.0 * PI * d.d(theta) * libm::sin(theta) * libm::cos(theta);
                }
            }
            assert!((sum - 1.0).abs() < 1e-10, "{name}: integrates to {sum}");
            assert!((d.relative_d(0.0) - 1.0).abs() < 1e-15, "{name}: unit form");
        }
    }

    #[test]
    fn sampling_inverts_the_cdf() {
        for (name, d) in all() {
            for u in [1e-6, 0.2, 0.5, 0.9, 0.999] {
                let theta = d.sample_theta(u);
                let back = projected(|t| d.d(t), d.half_angle().unwrap_or(1.0), theta);
                assert!((back - u).abs() < 1e-8, "{name}: {u} gives {theta}, of share {back}");
            }
        }
    }

    #[test]
    fn half_angles() {
        for (name, d) in all() {
            let searched = search_half(|theta| d.relative_d(theta), d.support());
            match (d.half_angle(), searched) {
                (Some(a), Some(b)) => {
                    assert!((a / b - 1.0).abs() < 1e-7, "{name}: {a} against {b}");
                    assert!((d.relative_d(a) - 0.5).abs() < 1e-9, "{name}");
                }
                (a, b) => assert!(a.is_none() && b.is_none(), "{name}: {a:?} {b:?}"),
            }
        }
    }

    #[test]
    fn members_are_recognised() {
        let gtr = Gtr::new(0.3, 2.0).unwrap().student_t().unwrap();
        assert!((gtr.sigma_x() - 0.3).abs() < 1e-15 && gtr.shape().gamma() == 2.0);
        assert!(Gtr::new(0.3, 2.5).unwrap().student_t().is_none());
        let t = Member::blinn_phong(50.0).unwrap();
        for theta in [0.0, 0.1, 0.7, 1.5] {
            let want = 52.0 / (2.0 * PI) * libm::pow(libm::cos(theta), 50.0);
            assert!((t.d(theta) - want).abs() < 1e-12 * want);
        }
        let same = AshikhminShirley::new(50.0, 50.0).unwrap().student_t().unwrap();
        assert_eq!(same.shape().gamma(), 27.0);
    }

    #[test]
    fn refusals_name_the_range() {
        for e in [
            Gauss::new(0.0).unwrap_err(),
            Schlick::new(1.5).unwrap_err(),
            Sawicki::new(-1e-9).unwrap_err(),
            Sawicki::new(f64::INFINITY).unwrap_err(),
            Sawicki::new(f64::NAN).unwrap_err(),
            Gtr::new(-0.1, 2.0).unwrap_err(),
            Haze::new(0.1, 0.4, -0.1).unwrap_err(),
            Abc::new(-0.1, 2.0).unwrap_err(),
            Gtr::new(0.1, f64::NAN).unwrap_err(),
            AshikhminShirley::new(-1.0, 1.0).unwrap_err(),
        ] {
            assert!(e.to_string().contains(&format!("must lie in {}", e.range)), "{e}");
        }
        assert!(Sawicki::new(-0.0).is_ok());
    }
}
