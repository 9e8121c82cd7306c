//! Upper tails ∫ₓ¹ (1−t²)ᵖ dt over the whole ∫₋₁¹, in single precision: every closed form of
//! Student-t contains them.
//!
//! x is the sine of the tilt in the lobe's own space. Along the plane of incidence p = γ−2, across
//! it p = γ−3/2.

use super::elementary::{arc, polynomial};

/// One way to evaluate the tail.
pub(crate) trait Tail {
    /// The tail at x = `sin` ∈ [−1, 1], given cos = √(1−x²) and `power` = cos^(2p+2).
    fn upper(&self, sin: f32, cos: f32, power: f32) -> f32;
}

/// ∫₋₁¹ (1−t²)ᵖ dt = √π Γ(p+1)/Γ(p+3/2).
pub(crate) fn whole(p: f64) -> f64 {
    std::f64::consts::PI.sqrt() * (libm::lgamma(p + 1.0) - libm::lgamma(p + 1.5)).exp()
}

/// Any p: half the regularised incomplete beta function I(p+1, ½) of cos², by its continued
/// fraction to 3e-7.
pub(crate) struct Beta {
    /// Γ(a+½)/(Γ(a) Γ(½)), a = p+1, and half of it over a.
    scale: [f32; 2],
    /// Below this the first fraction ends sooner, above it the second: (a+1)/(a+5/2).
    middle: f32,
    /// The fractions of I(a, ½) and of I(½, a).
    fractions: [Fraction; 2],
}

impl Beta {
    pub(crate) fn new(p: f64) -> Self {
        let (a, scale) = (p + 1.0, 1.0 / whole(p));
        Self {
            scale: [scale as f32, (0.5 * scale / a) as f32],
            middle: ((a + 1.0) / (a + 2.5)) as f32,
            fractions: [Fraction::new(a, 0.5), Fraction::new(0.5, a)],
        }
    }
}

impl Tail for Beta {
    #[inline(always)]
    fn upper(&self, sin: f32, cos: f32, power: f32) -> f32 {
        let (y, front) = (cos * cos, power * sin.abs());
        let tail = if y < self.middle {
            self.scale[1] * front * self.fractions[0].at(y)
        } else {
            // Not 1 − y, which has lost its digits for a tail inside the lobe at large γ.
            0.5 - self.scale[0] * front * self.fractions[1].at(sin * sin)
        };
        if sin < 0.0 { 1.0 - tail } else { tail }
    }
}

/// The continued fraction 1/(1 + d₁x/(1 + d₂x/(1 + …))) of the incomplete beta function (DLMF
/// 8.17.22).
struct Fraction {
    first: f32,
    /// d₂ₘ and d₂ₘ₊₁.
    pairs: [[f32; 2]; 32],
}

impl Fraction {
    fn new(a: f64, b: f64) -> Self {
        let pair = |i: usize| {
            let m = i as f64 + 1.0;
            let even = m * (b - m) / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
            let odd = -(a + m) * (a + b + m) / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
            [even as f32, odd as f32]
        };
        Self { first: (-(a + b) / (a + 1.0)) as f32, pairs: std::array::from_fn(pair) }
    }

    /// By the recurrence of its convergents' numerators and denominators, with a single division.
    #[inline(always)]
    fn at(&self, x: f32) -> f32 {
        let (mut old, mut new) = ([1.0, 1.0], [1.0 + self.first * x, 1.0]);
        for [even, odd] in &self.pairs {
            let next = |[old, new]: [[f32; 2]; 2], d: f32| {
                [new[0] + d * x * old[0], new[1] + d * x * old[1]]
            };
            old = next([old, new], *even);
            new = next([new, old], *odd);
            let (a, b) = (new[0] * old[1], old[0] * new[1]);
            if (a - b).abs() < 3e-7 * a {
                break;
            }
        }
        new[1] / new[0]
    }
}

/// Integer p = N − 1: a polynomial in the sine (the sum of Ribardière et al. 2017,
/// doi:10.1111/cgf.13137, eq. 21, for integer γ).
pub(crate) struct Sum<const N: usize> {
    c: [f32; N],
}

impl<const N: usize> Sum<N> {
    pub(crate) fn new() -> Self {
        Self { c: Self::coefficients().map(|c| c as f32) }
    }

    /// Coefficients of the odd powers of the sine.
    pub(crate) fn coefficients() -> [f64; N] {
        let (mut binomial, p) = (1.0, (N - 1) as f64);
        let norm = whole(p);
        std::array::from_fn(|j| {
            let j = j as f64;
            let term = binomial / (2.0 * j + 1.0) / norm;
            binomial *= -(p - j) / (j + 1.0);
            term
        })
    }
}

impl<const N: usize> Tail for Sum<N> {
    #[inline(always)]
    fn upper(&self, sin: f32, _: f32, _: f32) -> f32 {
        0.5 - sin * polynomial(sin * sin, &self.c)
    }
}

/// p = N − ½: an arc and a polynomial in the cosine (eq. 21 for half-integer γ).
pub(crate) struct ArcSum<const N: usize> {
    c: [f32; N],
}

impl<const N: usize> ArcSum<N> {
    pub(crate) fn new() -> Self {
        Self { c: Self::coefficients().map(|c| c as f32) }
    }

    /// Coefficients of the even powers of the cosine.
    pub(crate) fn coefficients() -> [f64; N] {
        // ∫₀^φ cos^(2N) = whole/π · (φ + sin φ cos φ Σ (2j)!!/(2j+1)!! cos^(2j) φ).
        let mut term = std::f64::consts::FRAC_1_PI;
        std::array::from_fn(|j| {
            let now = term;
            term *= (2.0 * j as f64 + 2.0) / (2.0 * j as f64 + 3.0);
            now
        })
    }
}

impl<const N: usize> Tail for ArcSum<N> {
    #[inline(always)]
    fn upper(&self, sin: f32, cos: f32, _: f32) -> f32 {
        0.5 - (arc(sin, cos) + sin * cos * polynomial(cos * cos, &self.c))
    }
}

#[cfg(test)]
mod tests {
    use microfacet_model::Shape;

    use super::*;

    #[test]
    fn tails_are_those_of_the_model() {
        // Along the plane of incidence p = γ−2, across it γ−3/2.
        let check = |tail: &dyn Tail, gamma: f64, across: bool| {
            let p = gamma - if across { 1.5 } else { 2.0 };
            let shape = Shape::new(gamma).unwrap();
            for i in -20..=20 {
                let sin = f64::from(i) / 20.0;
                let cos = (1.0 - sin * sin).sqrt();
                // The reduced slope is √s times the unit slope.
                let w = shape.asinh_slope(sin.abs() / cos / shape.s().sqrt());
                let one = if across { shape.across_tail(w) } else { shape.tail(w) };
                let want = if sin < 0.0 { 1.0 - one } else { one };
                let power = cos.powf(2.0 * p + 2.0) as f32;
                let got = tail.upper(sin as f32, cos as f32, power);
                assert!(
                    (f64::from(got) - want).abs() < 1e-6,
                    "p {p}, sine {sin}: {got} against {want}"
                );
            }
        };
        for gamma in [2.2, 3.0, 4.0, 9.7, 40.0] {
            check(&Beta::new(gamma - 2.0), gamma, false);
            check(&Beta::new(gamma - 1.5), gamma, true);
        }
        check(&Sum::<3>::new(), 4.0, false);
        check(&ArcSum::<3>::new(), 4.0, true);
        check(&ArcSum::<2>::new(), 3.5, false);
        check(&Sum::<3>::new(), 3.5, true);
    }
}
