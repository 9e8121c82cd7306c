//! Integrals of the slope marginal: Student's t without its scale.
//!
//! In canonical space (slopes divided by σ√(γ−1)) every member of the family with finite γ has
//! the in-plane slope marginal
//!
//! ```text
//! p(a) = c (1 + a²)^(−k−1),   k = γ − 3/2 > 0,   c = Γ(k+1) / (√π Γ(k+½)),
//! ```
//!
//! which is Student's t with 2k+1 degrees of freedom, without its scale. Slopes are passed as their
//! *rapidity* v, a = sinh v, because the heaviest tails (k → 0) put half of the probability beyond
//! any floating-point a: with k = 0.001 the median visible slope at grazing is 2⁵⁰⁰. The slope's
//! angle α has sin α = tanh v and cos α = 1/cosh v.
//!
//! Both tail integrals are hypergeometric functions 2F1(1, b; c; −1/a²), evaluated away from the
//! centre by Gauss's continued fraction and near the centre by a series. All terms of both are
//! positive. No step subtracts nearly equal numbers, apart from ½ − Q near the centre, where Q is
//! of the order of ½.

use core::f64::consts::PI;

/// The central series is used where (k + 3/2)·tanh²v is less than this. At 1 the series needs about
/// 25 terms, the continued fraction about 80 (large k), and T₁ − Q in [`lambda`] has lost less than
/// one decimal digit.
const CENTRE: f64 = 1.0;

/// Γ(k+1) / Γ(k+½) for k ≥ 0, to a few ulp.
///
/// Differences of log-gammas lose digits as k grows (1e-10 at 1e6), so the ratio is taken from its
/// asymptotic series in 1/(k+¼)², DLMF 5.11.15 in the symmetric form, whose odd terms vanish. The
/// recurrence first raises k to at least 16.
pub(crate) fn gamma_ratio(mut k: f64) -> f64 {
    let mut lift = 1.0;
    while k < 16.0 {
        lift *= (k + 0.5) / (k + 1.0);
        k += 1.0;
    }
    let w = k + 0.25;
    let r = 1.0 / (w * w);
    // −E₂ₘ / (m 4^(2m+1)) with the Euler numbers E₂…E₁₂; the next term is less than 1e-17 at
    // w = 16.
    let log = r
        * (1.0 / 64.0
            + r * (-5.0 / 2048.0
                + r * (61.0 / 49152.0
                    + r * (-1385.0 / 1048576.0
                        + r * (50521.0 / 20971520.0 - r * (2702765.0 / 402653184.0))))));
    lift * w.sqrt() * libm::exp(log)
}

/// c = Γ(k+1) / (√π Γ(k+½)): the marginal density at slope 0.
pub(crate) fn norm(k: f64) -> f64 {
    gamma_ratio(k) / PI.sqrt()
}

/// ln cosh v for any v, also where cosh overflows, with full relative accuracy near 0.
pub(crate) fn ln_cosh(v: f64) -> f64 {
    let v = v.abs();
    if v < 1.0 {
        let sinh = libm::sinh(v);
        0.5 * libm::log1p(sinh * sinh)
    } else {
        v - core::f64::consts::LN_2 + libm::log1p(libm::exp(-2.0 * v))
    }
}

/// acosh(exp x) for x ≥ 0: the inverse of [`ln_cosh`].
pub(crate) fn inverse_ln_cosh(x: f64) -> f64 {
    x + libm::log1p((-libm::expm1(-2.0 * x)).sqrt())
}

/// 2F1(1, b; c; −w) for w ≥ 0 and 0 < b ≤ c by Gauss's continued fraction (DLMF 15.7.5 with a = 1).
fn gauss_fraction(b: f64, c: f64, w: f64) -> f64 {
    // 1/(1 + d₁w/(1 + d₂w/(1 + …))) by the modified Lentz recurrence; no denominator vanishes
    // because all terms are positive.
    let (mut f, mut big_c, mut big_d) = (1.0_f64, 1.0_f64, 0.0_f64);
    let mut n = 0.0;
    // Towards the centre the number of terms grows like 1/a, for large k like 1/a²; it is less than
    // 150 where `CENTRE` allows the call.
    for _ in 0..1000 {
        let odd = (b + n) * (c - 1.0 + n) / ((c + 2.0 * n - 1.0) * (c + 2.0 * n)) * w;
        n += 1.0;
        let even = n * (c - b + n - 1.0) / ((c + 2.0 * n - 2.0) * (c + 2.0 * n - 1.0)) * w;
        let mut change = 1.0;
        for d in [odd, even] {
            big_d = 1.0 / (1.0 + d * big_d);
            big_c = 1.0 + d / big_c;
            let delta = big_c * big_d;
            f *= delta;
            change *= delta;
        }
        if (change - 1.0).abs() < 2e-16 {
            break;
        }
    }
    1.0 / f
}

/// ∫ p(a) da from 0 to sinh v near the centre, as c·tanh v·cosh^(−2k−1) v·2F1(k+1, 1; 3/2; tanh²v):
/// a series of positive terms. `power` is that of cosh v.
fn central(k: f64, c: f64, tanh: f64, power: f64) -> f64 {
    let y = tanh * tanh;
    let (mut term, mut sum, mut n) = (1.0, 1.0, 0.0);
    while term > 1e-17 * sum {
        term *= (k + 1.0 + n) / (1.5 + n) * y;
        sum += term;
        n += 1.0;
    }
    c * tanh * power * sum
}

/// A rapidity v ≥ 0 with the functions of it that all integrals use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    k: f64,
    c: f64,
    sinh: f64,
    pub(crate) tanh: f64,
    ln_cosh: f64,
    /// cosh^(−2k−1) v.
    pub(crate) power: f64,
}

impl Place {
    pub(crate) fn new(k: f64, c: f64, v: f64) -> Self {
        let ln_cosh = ln_cosh(v);
        let power = libm::exp(-(2.0 * k + 1.0) * ln_cosh);
        Self { k, c, sinh: libm::sinh(v), tanh: libm::tanh(v), ln_cosh, power }
    }

    /// cosh^(−2k) v.
    pub(crate) fn flatter_power(&self) -> f64 {
        libm::exp(-2.0 * self.k * self.ln_cosh)
    }

    fn is_central(&self) -> bool {
        (self.k + 1.5) * self.tanh * self.tanh < CENTRE
    }

    /// 1/sinh²v; tends to 0 for large v, where sinh²v would overflow.
    fn inverse_square(&self) -> f64 {
        let sinh = self.sinh.min(1e150);
        1.0 / (sinh * sinh)
    }

    /// The upper tail Q(v) = ∫_{sinh v}^∞ p(a) da.
    ///
    /// Relative accuracy about 1e-15 · (1 + (2k+1) ln cosh v), whose second term is the
    /// conditioning of the power.
    pub(crate) fn tail(&self) -> f64 {
        let Self { k, c, tanh, power, .. } = *self;
        if self.is_central() {
            return 0.5 - central(k, c, tanh, power);
        }
        let fraction = gauss_fraction(0.5, k + 1.5, self.inverse_square());
        c / (2.0 * k + 1.0) * power / tanh * fraction
    }

    /// Λ = ∫_a^∞ (x − a) p(x) dx / a at a = sinh v, v > 0: Smith's Λ at the cotangent a in the
    /// lobe's canonical space.
    ///
    /// Away from the centre it is c/(4k(k+½)) · t^(k+½) (1−t)^(−3/2) · 2F1(1, 3/2; k+3/2; −1/a²)
    /// with t = 1/(1+a²), which has no cancellation; the textbook form T₁ − Q, with T₁ the first
    /// moment beyond a divided by a, subtracts nearly equal numbers there.
    pub(crate) fn lambda(&self) -> f64 {
        let Self { k, c, tanh, power, .. } = *self;
        if self.is_central() {
            let first = c * self.flatter_power() / (2.0 * k * self.sinh);
            return first - (0.5 - central(k, c, tanh, power));
        }
        let fraction = gauss_fraction(1.5, k + 1.5, self.inverse_square());
        c / (4.0 * k * (k + 0.5)) * power / (tanh * tanh * tanh) * fraction
    }
}

pub(crate) fn tail(k: f64, c: f64, v: f64) -> f64 {
    Place::new(k, c, v).tail()
}

pub(crate) fn lambda(k: f64, c: f64, v: f64) -> f64 {
    Place::new(k, c, v).lambda()
}

/// [`lambda`] from the cotangent a = sinh v, whose square must not overflow: four times as fast.
pub(crate) fn lambda_at(k: f64, c: f64, a: f64) -> f64 {
    let square = a * a;
    let ln_cosh = 0.5 * libm::log1p(square);
    let power = libm::exp(-(2.0 * k + 1.0) * ln_cosh);
    Place { k, c, sinh: a, tanh: a / (1.0 + square).sqrt(), ln_cosh, power }.lambda()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_ratio_matches_closed_values() {
        // Γ(1)/Γ(½) = 1/√π, Γ(3/2)/Γ(1) = √π/2, Γ(2)/Γ(3/2) = 2/√π.
        for (k, want) in [(0.0, 1.0 / PI.sqrt()), (0.5, PI.sqrt() / 2.0), (1.0, 2.0 / PI.sqrt())] {
            assert!((gamma_ratio(k) / want - 1.0).abs() < 1e-15, "k = {k}");
        }
        // Wallis: the ratio at k times the ratio at k − ½ is k.
        for k in [0.75, 3.0, 15.9, 16.1, 40.0, 1e3, 1e6, 1e12] {
            let product = gamma_ratio(k) * gamma_ratio(k - 0.5);
            assert!((product / k - 1.0).abs() < 3e-15, "k = {k}: {}", product / k - 1.0);
        }
    }

    #[test]
    fn branches_agree_where_they_meet() {
        for k in [1e-6, 0.01, 0.3, 0.5, 1.0, 3.7, 100.0, 1e6] {
            let c = norm(k);
            let v = libm::atanh((CENTRE / (k + 1.5)).sqrt());
            let (below, above) = (v * (1.0 - 1e-15), v * (1.0 + 1e-15));
            for f in [tail, lambda] {
                let (x, y) = (f(k, c, below), f(k, c, above));
                assert!((x / y - 1.0).abs() < 2e-14, "k = {k}: {x} against {y}");
            }
        }
    }

    #[test]
    fn lambda_is_the_same_from_the_cotangent() {
        for k in [1e-3, 0.01, 0.3, 0.5, 1.0, 3.7, 100.0, 1e4] {
            for a in [1e-12, 1e-3, 0.05, 0.3, 1.0, 4.0, 50.0, 1e6] {
                let [got, want] = [lambda_at(k, norm(k), a), lambda(k, norm(k), libm::asinh(a))];
                // The conditioning of the power.
                let bound = 1e-14 * (1.0 + k * libm::log1p(a * a));
                assert!((got - want).abs() <= bound * want, "k {k}, a {a}: {got} for {want}");
            }
        }
    }

    #[test]
    fn cauchy_tail_is_exact() {
        // k = 0 is the Cauchy distribution, Q = ½ − atan(a)/π.
        for a in [0.1_f64, 0.7, 1.3, 2.0, 50.0] {
            let want = 0.5 - libm::atan(a) / PI;
            assert!((tail(0.0, norm(0.0), libm::asinh(a)) - want).abs() < 2e-16 + 1e-15 * want);
        }
    }
}
