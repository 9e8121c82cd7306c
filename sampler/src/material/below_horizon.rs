//! In-plane slopes seen from below the lobe's horizon, as only a skewed lobe can be: x > a with
//! density ∝ (x − a) p(x).
//!
//! No table holds them; they are drawn by rejection in double precision. With (1 + s x²)^(−k) =
//! (1 + s a²)^(−k) e^(−y) the density is e^(−y) (1 − a/x(y)), whose second factor is concave, so
//! that either an exponential or a gamma variate bounds it tightly.

use super::student_t::{Stretched, StudentT};
use crate::axis::half_tangent::Slope;
use crate::math::{sqrt64, unit};

/// Up to this a the excess is a difference from the shadowing table; for larger a that difference
/// loses digits, and the continued fraction is short.
const NEAR: f64 = 0.8;

/// The slopes greater than a, of a lobe.
pub(crate) struct SlopeBelowHorizon<'a> {
    lobe: &'a StudentT,
    a: f64,
    s: f64,
}

impl<'a> SlopeBelowHorizon<'a> {
    /// For a view `rho` across and `depth` ≥ 0 below the horizon of the lobe.
    pub(crate) fn new(lobe: &'a StudentT, rho: f32, depth: f32) -> Self {
        Self { lobe, a: f64::from(depth) / f64::from(rho), s: f64::from(lobe.s) }
    }

    /// ∫ (x − a)⁺ p(x) dx.
    pub(crate) fn excess(&self) -> f32 {
        let Self { lobe, a, s } = *self;
        if a > NEAR {
            // ∫ₐ^∞ x p(x) dx = M₀ (1 + s a²)^(−k).
            let moment = f64::from(lobe.slices.first_moment()) * decay(s, a * a);
            return (moment * excess_share(s, a)) as f32;
        }
        // E[(X−a)⁺] = E[(X+a)⁺] − a.
        let above = Stretched { x: 1.0, y: 0.0, frame: 1.0, rho: 1.0, z: a as f32 };
        (1.0 / f64::from(lobe.inverse_area(&above)) - a) as f32
    }

    /// A slope, from a first random number in [0, 1) and as many more as needed.
    pub(crate) fn sample(&self, u: f32, more: &mut Numbers) -> Slope {
        let Self { a, s, .. } = *self;
        let base = 1.0 + s * a * a;
        // (1/s + a²)(e^(y/k) − 1) with 1/k = 2s/(2−s); y·2/(2−s) in the limit s = 0.
        let rate = 2.0 / (2.0 - s);
        let grow = |y: f64| if s == 0.0 { y } else { base * libm::expm1(s * rate * y) / s };
        // 1 − a/x ≤ min(1, b y).
        let b = 0.5 * rate * base / (a * a);
        let mut first = f64::from(unit(u));
        loop {
            let mut y = -libm::log1p(-first);
            if b < 1.0 {
                y -= libm::log1p(-more.next());
            }
            let bound = if b < 1.0 { b * y } else { 1.0 };
            // u = 1 is an infinite slope.
            let added = grow(y);
            if !(added < 1e60) {
                return Slope { x: 1.0, z: 0.0 };
            }
            let x = sqrt64(a * a + added);
            // x − a without cancellation.
            if more.next() * bound * x <= added / (x + a) {
                let r = 1.0 / (1.0 + x);
                return Slope { x: (x * r) as f32, z: r as f32 };
            }
            first = more.next();
        }
    }
}

/// (1 + s x²)^(−k) given x²; exp(−x²) for s = 0.
fn decay(s: f64, x2: f64) -> f64 {
    // k = 1/s − ½.
    libm::exp(if s == 0.0 { -x2 } else { (0.5 - 1.0 / s) * libm::log1p(s * x2) })
}

/// E[(X−a)⁺]/E[X; X>a] = (1 + s a²)/(2a²)·₂F₁(1, 3/2; 1+1/s; −1/(s a²)), by Gauss's continued
/// fraction, written so that s = 0 is regular.
///
/// All terms are positive; it takes about 100 of them at a = 0.8, and few for large a.
fn excess_share(s: f64, a: f64) -> f64 {
    let w = 1.0 / (a * a);
    let (mut f, mut c, mut d, mut n) = (1.0, 1.0, 0.0, 0.0);
    for _ in 0..500 {
        let odd = (1.5 + n) * (1.0 + n * s) / ((1.0 + 2.0 * n * s) * (1.0 + s + 2.0 * n * s)) * w;
        n += 1.0;
        let even =
            n * (1.0 + s * (n - 1.5)) / ((1.0 + s * (2.0 * n - 1.0)) * (1.0 + 2.0 * n * s)) * w;
        let mut change = 1.0;
        for term in [odd, even] {
            d = 1.0 / (1.0 + term * d);
            c = 1.0 + term / c;
            f *= c * d;
            change *= c * d;
        }
        if change > 1.0 - 1e-12 && change < 1.0 + 1e-12 {
            break;
        }
    }
    0.5 * (1.0 + s * a * a) * w / f
}

/// Further random numbers in [0, 1), a function of the two that the caller gave (splitmix64).
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(u: [f32; 2]) -> Self {
        // Clamped first, so that numbers outside [0, 1] and NaN give the sequence of the end.
        let [a, b] = u.map(|u| u64::from(unit(u).to_bits()));
        Self(a << 32 | b)
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}
