//! Quadrature of albedos at rising orders until two successive ones agree.

use std::sync::LazyLock;

use microfacet_core::Masking;

use crate::panels::Gauss;

/// Points per panel at successive orders; the error of an order is estimated from the one before.
const LEVELS: [usize; 7] = [5, 7, 10, 14, 20, 28, 40];

/// Share of the visible slopes that is left out, relative to the tolerance.
pub(crate) const CUT: f64 = 1e-3;

/// Albedos of one view under N Fresnel weights, for both forms of masking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo<const N: usize> {
    /// With G2 = G1(v) G1(l).
    pub uncorrelated: [f64; N],
    /// With G2 = 1/(1 + Λ(v) + Λ(l)).
    pub height_correlated: [f64; N],
    /// Upper estimate of the largest error: from the differences between the last orders of
    /// quadrature, plus what is cut off.
    pub error: f64,
}

/// Integrals under N weights for both forms of masking, in the order of [`Masking::ALL`].
pub(crate) type Both<const N: usize> = [[f64; N]; 2];

impl<const N: usize> Albedo<N> {
    pub(crate) fn new([uncorrelated, height_correlated]: Both<N>, error: f64) -> Self {
        Self { uncorrelated, height_correlated, error }
    }

    /// The albedos for one form of masking.
    pub fn of(&self, masking: Masking) -> [f64; N] {
        match masking {
            Masking::Uncorrelated => self.uncorrelated,
            Masking::HeightCorrelated => self.height_correlated,
        }
    }

    pub(crate) fn both(&self) -> Both<N> {
        Masking::ALL.map(|masking| self.of(masking))
    }
}

#[inline]
pub(crate) fn add<const N: usize>(sum: &mut Both<N>, factor: f64, part: &Both<N>) {
    for (sum, part) in sum.iter_mut().flatten().zip(part.iter().flatten()) {
        *sum += factor * part;
    }
}

/// Adds the weights at one quadrature point, times its share under each form of masking.
#[inline]
pub(crate) fn add_place<const N: usize>(sum: &mut Both<N>, shares: [f64; 2], weights: [f64; N]) {
    for i in 0..N {
        sum[0][i] += shares[0] * weights[i];
        sum[1][i] += shares[1] * weights[i];
    }
}

pub(crate) fn differences<const N: usize>(a: &Both<N>, b: &Both<N>) -> Both<N> {
    [0, 1].map(|form| core::array::from_fn(|i| (a[form][i] - b[form][i]).abs()))
}

pub(crate) fn largest<const N: usize>(values: &Both<N>) -> f64 {
    values.iter().flatten().copied().fold(0.0, f64::max)
}

/// The rules at successive orders.
pub(crate) static RULES: LazyLock<[Gauss; LEVELS.len()]> = LazyLock::new(|| LEVELS.map(Gauss::new));

/// The albedos at the first order that is accurate enough, or else at the last.
///
/// The estimate of their error is `factor` times the largest difference between the last two
/// orders, plus what the cut leaves out, which no order includes.
pub(crate) fn converge<const N: usize>(
    rules: &[Gauss],
    tolerance: f64,
    factor: f64,
    integrate: impl Fn(&Gauss) -> Both<N>,
) -> Albedo<N> {
    // The lowest two orders were seen to agree to 5e-8 by chance, both off by three times that.
    let rules = if tolerance < 1e-6 { &rules[1..] } else { rules };
    let mut albedo = Albedo::new(integrate(&rules[0]), f64::INFINITY);
    for rule in &rules[1..] {
        let now = integrate(rule);
        let change = largest(&differences(&now, &albedo.both()));
        albedo = Albedo::new(now, factor * change + 10.0 * CUT * tolerance);
        if albedo.error < tolerance {
            break;
        }
    }
    albedo
}
