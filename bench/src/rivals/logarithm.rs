//! D of Student-t as this project computed it before: a logarithm and an exponential by
//! polynomials, for every γ alike. What reads the bits of the float instead is compared with it.
//!
//! With r/z the slope of a normal over σ and b = z² + s r², πσ²D = (b/z²)^(2−γ)/b², whose root is
//! computed: D/σ² may be in range where its factors are not.

use std::f32::consts::{FRAC_1_PI, LN_2};

use glam::Vec3;

/// D of one material.
pub(crate) struct Logarithm {
    inverse_sigma: f32,
    /// 1/(πσ²).
    scale: f32,
    s: f32,
    /// 1 − γ/2.
    power: f32,
}

/// Stands for s = 0, Beckmann.
const LEAST_S: f64 = 1.0 / 1_099_511_627_776.0;

impl Logarithm {
    pub(crate) fn new(sigma: f64, gamma: f64) -> Self {
        let s = (1.0 / (gamma - 1.0)).max(LEAST_S);
        let scale = f64::from(FRAC_1_PI) / (sigma * sigma);
        Self {
            inverse_sigma: (1.0 / sigma) as f32,
            scale: scale as f32,
            s: s as f32,
            power: (0.5 - 0.5 / s) as f32,
        }
    }

    #[inline(always)]
    pub(crate) fn d(&self, m: Vec3) -> f32 {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let (x, y) = (m.x * self.inverse_sigma, m.y * self.inverse_sigma);
        let (z2, part) = (m.z * m.z, self.s * (x * x + y * y));
        let scale = 1.0 / (z2 + part).max(f32::MIN_POSITIVE);
        let root = scaled_power_of_growth(z2, part, self.power, scale);
        ((self.scale * root) * root).min(f32::MAX)
    }
}

const LEAST_EXPONENT: f32 = -126.0;

/// scale·(1 + part/whole)ᵖ, 0 where the power is below 2⁻¹²⁶.
#[inline(always)]
fn scaled_power_of_growth(whole: f32, part: f32, power: f32, scale: f32) -> f32 {
    /// log₂ of (1+t)/(1−t) over t, by powers of t².
    const HALF_TANGENT: [f32; 4] = [2.885_390_07, 0.961_802_25, 0.576_390_26, 0.439_189_35];
    let [exponent, t] = growth(whole, part);
    let y = t * t;
    // A smaller square would be subnormal, and slow.
    let high = y.max(1e-16);
    let [a, b, c, d] = HALF_TANGENT;
    let series = (a + y * b) + (high * high) * (c + y * d);
    let x = exponent * power + (t * power) * series;
    let inside = x >= LEAST_EXPONENT;
    let [fraction, shifted] = whole_and_fraction(if inside { x } else { LEAST_EXPONENT });
    let whole = f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23));
    if inside { fraction * (whole * scale) } else { 0.0 }
}

/// The whole number e and the half tangent t, |t| ≤ 0.2, of 1 + part/whole = 2ᵉ (1+t)/(1−t).
#[inline(always)]
fn growth(whole: f32, part: f32) -> [f32; 2] {
    const HALF: i32 = 1 << 22;
    let sum = whole + part;
    let [low, high] = [whole, sum].map(|x| x.to_bits() as i32);
    let exponent = high.wrapping_sub(low).wrapping_add(HALF) >> 23;
    let scaled = f32::from_bits(low.wrapping_add(exponent << 23) as u32);
    let excess = (sum - scaled) + (part - (sum - whole));
    [exponent as f32, excess / (sum + scaled)]
}

/// 2ʷ, and a number whose last bits are the whole number x − w; w ∈ [−½, ½].
#[inline(always)]
fn whole_and_fraction(x: f32) -> [f32; 2] {
    // A sum with `shift` is rounded to a whole number.
    let shift = 12_582_912.0;
    let shifted = x + shift;
    let w = x - (shifted - shift);
    let square = w * w;
    let low = 1.0 + w * LN_2;
    let middle = 0.240_226_51 + w * 0.055_503_27;
    let high = (0.009_618_057 + w * 0.001_340_042_8) + square * 0.000_154_614_45;
    [(low + square * middle) + (square * square) * high, shifted]
}
