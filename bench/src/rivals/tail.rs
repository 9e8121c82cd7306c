//! Upper tails ∫ₓ¹ (1−t²)ᵖ dt over the whole ∫₋₁¹, in single precision: what every closed form of Student-t is made of.
//!
//! x is the sine of the tilt in the lobe's own space. Along the plane of incidence p = γ−2, across it p = γ−3/2.

/// One way to evaluate the tail.
pub(crate) trait Tail {
    /// The tail at x = `sin` ∈ [−1, 1], given cos = √(1−x²) and `power` = cos^(2p+1).
    fn upper(&self, sin: f32, cos: f32, power: f32) -> f32;
}

/// ∫₋₁¹ (1−t²)ᵖ dt = √π Γ(p+1)/Γ(p+3/2).
pub(crate) fn whole(p: f64) -> f64 {
    std::f64::consts::PI.sqrt() * (libm::lgamma(p + 1.0) - libm::lgamma(p + 1.5)).exp()
}

/// Any p: half the regularised incomplete beta function I(p+1, ½) of cos², by its continued fraction to 3e-7.
pub(crate) struct Beta {
    a: f32,
    /// Γ(a+½)/(Γ(a) Γ(½)), a = p+1.
    scale: f32,
}

impl Beta {
    pub(crate) fn new(p: f64) -> Self {
        Self { a: (p + 1.0) as f32, scale: (1.0 / whole(p)) as f32 }
    }
}

impl Tail for Beta {
    #[inline(always)]
    fn upper(&self, sin: f32, cos: f32, power: f32) -> f32 {
        let (a, y) = (self.a, cos * cos);
        let front = self.scale * power * cos * sin.abs();
        let tail = 0.5
            * if y < (a + 1.0) / (a + 2.5) {
                front * fraction(a, 0.5, y) / a
            } else {
                // Not 1 − y, which has lost its digits where γ is large and the tail is within.
                1.0 - 2.0 * front * fraction(0.5, a, sin * sin)
            };
        if sin < 0.0 { 1.0 - tail } else { tail }
    }
}

/// The continued fraction of the incomplete beta function (DLMF 8.17.22) by the modified Lentz recurrence.
#[inline(always)]
fn fraction(a: f32, b: f32, x: f32) -> f32 {
    let (mut c, mut d) = (1.0, 1.0 / (1.0 - (a + b) * x / (a + 1.0)));
    let mut h = d;
    for m in 1..100 {
        let m = m as f32;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / (1.0 + even * d);
        c = 1.0 + even / c;
        h *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / (1.0 + odd * d);
        c = 1.0 + odd / c;
        h *= d * c;
        if (d * c - 1.0).abs() < 3e-7 {
            break;
        }
    }
    h
}

/// Whole p = N − 1: a polynomial in the sine (the sum of Ribardière et al. 2017, eq. 21, for integer γ).
pub(crate) struct Sum<const N: usize> {
    c: [f32; N],
}

impl<const N: usize> Sum<N> {
    pub(crate) fn new() -> Self {
        let (mut binomial, p) = (1.0, (N - 1) as f64);
        let norm = whole(p);
        let c = std::array::from_fn(|j| {
            let j = j as f64;
            let term = binomial / (2.0 * j + 1.0) / norm;
            binomial *= -(p - j) / (j + 1.0);
            term as f32
        });
        Self { c }
    }
}

impl<const N: usize> Tail for Sum<N> {
    #[inline(always)]
    fn upper(&self, sin: f32, _: f32, _: f32) -> f32 {
        let y = sin * sin;
        0.5 - sin * self.c.iter().rev().fold(0.0, |sum, c| sum * y + c)
    }
}

/// p = N − ½: an arc and a polynomial in the cosine (eq. 21 for half-integer γ).
pub(crate) struct ArcSum<const N: usize> {
    c: [f32; N],
}

impl<const N: usize> ArcSum<N> {
    pub(crate) fn new() -> Self {
        // ∫₀^φ cos^(2N) = whole/π · (φ + sin φ cos φ Σ (2j)!!/(2j+1)!! cos^(2j) φ).
        let mut term = std::f64::consts::FRAC_1_PI;
        let c = std::array::from_fn(|j| {
            let now = term;
            term *= (2.0 * j as f64 + 2.0) / (2.0 * j as f64 + 3.0);
            now as f32
        });
        Self { c }
    }
}

impl<const N: usize> Tail for ArcSum<N> {
    #[inline(always)]
    fn upper(&self, sin: f32, cos: f32, _: f32) -> f32 {
        let y = cos * cos;
        let sum = self.c.iter().rev().fold(0.0, |sum, c| sum * y + c);
        0.5 - (sin.clamp(-1.0, 1.0).asin() * std::f32::consts::FRAC_1_PI + sin * cos * sum)
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
                let w = shape.unit(sin.abs() / cos / shape.s().sqrt());
                let one = if across { shape.across_tail(w) } else { shape.tail(w) };
                let want = if sin < 0.0 { 1.0 - one } else { one };
                let power = cos.powf(2.0 * p + 1.0) as f32;
                let got = tail.upper(sin as f32, cos as f32, power);
                assert!((f64::from(got) - want).abs() < 1e-6, "p {p}, sine {sin}: {got} against {want}");
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
