//! How masking and shadowing of a pair of directions are combined.

use core::fmt;
use core::str::FromStr;

use crate::Real;

/// The form of masking and shadowing, G2: the share of the microsurface that both view and light
/// reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case")
)]
pub enum Masking {
    /// G2 = G1(v) G1(l): the choice of the Student-t paper (Ribardière et al. 2017, eq. 12,
    /// <https://doi.org/10.1111/cgf.13137>).
    Uncorrelated,
    /// G2 = 1/(1 + Λ(v) + Λ(l)) (Heitz 2014, eq. 99, <https://jcgt.org/published/0003/02/03/>):
    /// what renderers use, and the default of a material that states none.
    #[default]
    HeightCorrelated,
}

impl Masking {
    /// Both forms.
    pub const ALL: [Self; 2] = [Self::Uncorrelated, Self::HeightCorrelated];

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uncorrelated => "uncorrelated",
            Self::HeightCorrelated => "height-correlated",
        }
    }

    /// G2 from the G1 ∈ [0, 1] of view and light; 0 where either is 0.
    #[inline(always)]
    pub fn g2<T: Real>(self, v: T, l: T) -> T {
        let both = v * l;
        match self {
            Self::Uncorrelated => both,
            Self::HeightCorrelated => {
                // 1/(1/a + 1/b − 1), arranged so that a = b = 0 gives 0 and not 0/0.
                let zero = T::constant(0.0);
                let sum = v + l - both;
                if sum > zero { both / sum } else { zero }
            }
        }
    }

    /// G2/G1(v) from the G1 ∈ [0, 1] of view and light: the weight of a light sampled by visible
    /// normals.
    ///
    /// It is finite at grazing views, where both vanish, and 0 where G1(l) is 0.
    #[inline(always)]
    pub fn g2_over_g1<T: Real>(self, v: T, l: T) -> T {
        match self {
            Self::Uncorrelated => l,
            Self::HeightCorrelated => {
                let zero = T::constant(0.0);
                if l > zero { l / (l + v * (T::constant(1.0) - l)) } else { zero }
            }
        }
    }
}

impl fmt::Display for Masking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for a text that names no form of masking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownMasking;

impl fmt::Display for UnknownMasking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = Masking::ALL.map(Masking::name);
        write!(f, "the form of masking must be \"{a}\" or \"{b}\"")
    }
}

impl core::error::Error for UnknownMasking {}

impl FromStr for Masking {
    type Err = UnknownMasking;

    fn from_str(name: &str) -> Result<Self, UnknownMasking> {
        Self::ALL.into_iter().find(|masking| masking.name() == name).ok_or(UnknownMasking)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn g2_is_that_of_lambda() {
        let values = [0.0, 1e-12, 0.1, 0.7, 1.0];
        for a in values {
            for b in values {
                let lambda = |g1: f64| 1.0 / g1 - 1.0;
                let want = 1.0 / (1.0 + lambda(a) + lambda(b));
                let got = Masking::HeightCorrelated.g2(a, b);
                assert!(
                    (got - want).abs() <= 4.0 * f64::EPSILON * want,
                    "{a}, {b}: {got} for {want}"
                );
                assert_eq!(Masking::Uncorrelated.g2(a, b), a * b);
            }
        }
        assert_eq!(Masking::HeightCorrelated.g2(0.0_f32, 0.0), 0.0);
    }

    #[test]
    fn the_quotient_is_that_of_g2_and_finite_at_grazing() {
        for masking in Masking::ALL {
            for v in [1e-12, 0.1, 0.7, 1.0_f64] {
                for l in [0.0, 1e-12, 0.3, 1.0] {
                    let (got, want) = (masking.g2_over_g1(v, l), masking.g2(v, l) / v);
                    assert!(
                        (got - want).abs() <= 4.0 * f64::EPSILON * want,
                        "{v}, {l}: {got} for {want}"
                    );
                }
            }
        }
        assert_eq!(Masking::HeightCorrelated.g2_over_g1(0.0, 0.5), 1.0);
        assert_eq!(Masking::HeightCorrelated.g2_over_g1(0.0, 0.0), 0.0);
    }

    #[test]
    fn names_are_read_back() {
        for masking in Masking::ALL {
            assert_eq!(masking.name().parse(), Ok(masking));
        }
        assert_eq!("smith".parse::<Masking>(), Err(UnknownMasking));
    }
}
