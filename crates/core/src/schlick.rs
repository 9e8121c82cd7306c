//! Schlick's reflectance F0 + (F90 − F0)(1−μ)⁵ (Schlick 1994,
//! <https://doi.org/10.1111/1467-8659.1330233>, eq. 15) and the F82 tint that OpenPBR's metals add
//! to it (Kutz, Hašan & Edmondson 2021, *Novel aspects of the Adobe Standard Material*, eq. 2–5):
//! F(μ) = S(μ) − (1 − tint) S(1/7) w(μ), with S Schlick's of F90 = 1 and w(μ) ∝ μ(1−μ)⁶ of peak 1.

use crate::Real;

/// Cosine at which the tint is given, about 82°, where μ(1−μ)⁶ peaks.
pub const F82_COS: f64 = 1.0 / 7.0;

/// The reciprocal of the peak of μ(1−μ)⁶, 7⁷/6⁶.
pub const F82_SCALE: f64 = 823543.0 / 46656.0;

/// Cosine-weighted average of Schlick's weight, 2∫₀¹ μ (1−μ)⁵ dμ = 2 B(2, 6).
pub const SCHLICK_AVERAGE: f64 = 1.0 / 21.0;

/// Cosine-weighted average of the tint's weight, 2∫₀¹ μ w(μ) dμ = 2·7⁷/6⁶ B(3, 7).
pub const F82_AVERAGE: f64 = 117649.0 / 839808.0;

/// Schlick's weight (1−μ)⁵.
#[inline(always)]
pub fn schlick_weight<T: Real>(cos_theta: T) -> T {
    let x = T::constant(1.0) - cos_theta;
    let x2 = x * x;
    x2 * x2 * x
}

/// The tint's weight w(μ) = 7⁷/6⁶ μ(1−μ)⁶, in [0, 1].
#[inline(always)]
pub fn f82_weight<T: Real>(cos_theta: T) -> T {
    T::constant(F82_SCALE) * cos_theta * (T::constant(1.0) - cos_theta) * schlick_weight(cos_theta)
}

/// Schlick's reflectance F0 + (F90 − F0)(1−μ)⁵.
#[inline(always)]
pub fn schlick<T: Real>(f0: T, f90: T, cos_theta: T) -> T {
    f0 + (f90 - f0) * schlick_weight(cos_theta)
}

/// The depth of the tint's dip, (1 − tint) S(1/7): the factor of w.
#[inline(always)]
pub fn f82_dip<T: Real>(f0: T, tint: T) -> T {
    let one = T::constant(1.0);
    (one - tint) * schlick(f0, one, T::constant(F82_COS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_are_what_they_say() {
        assert!((f82_weight(F82_COS) - 1.0).abs() < 1e-15);
        // The rule has no error for these degrees.
        let average = |f: fn(f64) -> f64| -> f64 {
            crate::gauss_legendre::<6>().iter().map(|&(mu, w)| 2.0 * w * mu * f(mu)).sum()
        };
        assert!((average(schlick_weight) - SCHLICK_AVERAGE).abs() < 1e-15);
        assert!((average(f82_weight) - F82_AVERAGE).abs() < 1e-15);
        assert!((f64::from(f82_weight(0.25_f32)) - f82_weight(0.25)).abs() < 1e-6);
    }

    #[test]
    fn the_dip_makes_the_tint_a_ratio() {
        let (f0, tint) = (0.7, 0.4);
        let metal = schlick(f0, 1.0, F82_COS) - f82_dip(f0, tint) * f82_weight(F82_COS);
        assert!((metal - tint * schlick(f0, 1.0, F82_COS)).abs() < 1e-15);
    }
}
