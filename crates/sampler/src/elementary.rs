//! Elementary functions over the ranges that samplers need, in a few multiplications.
//!
//! They consist of operations that every system rounds alike, so a sampled normal has the same bits
//! everywhere. They take a fraction of the time of library functions, which serve every argument.
//! The polynomials interpolate at Chebyshev points.

use core::f32::consts::{LN_2, TAU};
use core::ops::{Add, Mul};

use microfacet_lanes::{Ints, Lanes};

/// The sine and the cosine of 2πu for u ∈ [0, 1], to 2e-7 absolute, exact where they are 0.
#[inline(always)]
pub(crate) fn turn(u: f32) -> [f32; 2] {
    let x = 0.5 - u;
    let quarter = x.abs() - 0.25;
    [sine_of_turns((0.25 - quarter.abs()).copysign(x)), sine_of_turns(quarter)]
}

/// [`turn`] in lanes.
#[inline(always)]
pub(crate) fn turns<L: Lanes>(u: L) -> [L; 2] {
    let sign = L::splat(-0.0);
    let x = L::splat(0.5) - u;
    let quarter = (x & !sign) - 0.25;
    let from_half = L::splat(0.25) - (quarter & !sign);
    [sine_of_turns((from_half & !sign) ^ (x & sign)), sine_of_turns(quarter)]
}

/// The sine of 2πx for x ∈ [−¼, ¼], to 7e-9.
#[inline(always)]
fn sine_of_turns<T>(x: T) -> T
where
    T: Copy + Mul<Output = T> + Mul<f32, Output = T> + Add<f32, Output = T>,
{
    let y = x * x;
    x * (y * (y * (y * (y * 39.759_827 + -76.581_17) + 81.602_475) + -41.341_68) + TAU)
}

/// The same of u ∈ [0, ¼], with the digits of small sines.
#[inline(always)]
pub(crate) fn quarter_turn(u: f32) -> [f32; 2] {
    [sine(u), sine(0.25 - u)]
}

/// The sine of 2πx for x ∈ [−¼, ¼]; the polynomial errs by 7e-9.
#[inline(always)]
fn sine(x: f32) -> f32 {
    let y = x * x;
    x * (TAU + y * (-41.341_68 + y * (81.602_475 + y * (-76.581_17 + y * 39.759_827))))
}

/// scale·(eˢʸ − 1)/s for s, y ≥ 0; scale·y in the limit s = 0.
#[inline(always)]
pub(crate) fn scaled_expm1_over(s: f32, y: f32, scale: f32) -> f32 {
    if s * y < 1e-4 { scale * y * (1.0 + 0.5 * s * y) } else { scale * libm::expm1f(s * y) / s }
}

/// log₂ of positive normal numbers, to 1e-7 of the logarithm (so also next to 1) and 1 ulp of its
/// integer part; −∞ for 0 and below.
#[inline(always)]
pub(crate) fn log2<L: Lanes>(x: L) -> L {
    // x = 2ᵉ m with m ∈ [√½, √2], and log₂ m = 2 artanh((m−1)/(m+1))/ln 2.
    const ROOT_HALF: i32 = 0x3f35_04f3;
    let bits = x.to_bits();
    let exponent = (bits - L::Ints::splat(ROOT_HALF)).down::<23>();
    let m = L::from_bits(bits - exponent.up::<23>());
    let log = L::from_ints(exponent) + log2_of_half_tangent((m - 1.0) / (m + 1.0));
    x.simd_gt(L::splat(0.0)).select(log, L::splat(f32::NEG_INFINITY))
}

/// log₂(1 + part/whole) of part ≥ 0 and whole > 0, to 3e-7 of the logarithm: it keeps the digits of
/// a `part` that is small compared with `whole`.
///
/// The quotient itself is not formed, and may be out of range. A `whole` below the least normal
/// number counts as about that number.
#[inline(always)]
pub(crate) fn log2_growth(whole: f32, part: f32) -> f32 {
    let [exponent, t] = growth(whole, part);
    exponent + log2_of_half_tangent(t)
}

/// scale·(1 + part/whole)ᵖ, to a relative error of 4e-7 times one plus its logarithm, arguments as
/// for [`log2_growth`]; 0 where the power is below 2⁻¹²⁶ or NaN. The power must not exceed 2¹²⁶.
///
/// The fraction of the exponential comes from a table: of two polynomials this one was the longer.
#[inline(always)]
pub(crate) fn scaled_power_of_growth(whole: f32, part: f32, power: f32, scale: f32) -> f32 {
    // A sum with this number is rounded to a multiple of 1/FRACTIONS, and its last bits are that.
    const SHIFT: f32 = 12_582_912.0 / FRACTIONS as f32;
    const WHOLE: u32 = FRACTIONS.trailing_zeros();
    let [exponent, t] = growth(whole, part);
    let x = exponent * power + (t * power) * series_of_half_tangent(t * t);
    let inside = x >= LEAST_EXPONENT;
    let x = if inside { x } else { LEAST_EXPONENT };
    let shifted = x + SHIFT;
    let w = x - (shifted - SHIFT);
    let bits = shifted.to_bits();
    // The whole part of x is added to the exponent of the fraction's power.
    let fraction = FRACTION_POWERS[bits as usize % FRACTIONS].to_bits();
    let nearest =
        f32::from_bits(fraction.wrapping_add(bits >> WHOLE << (f32::MANTISSA_DIGITS - 1)));
    // 2ʷ − 1 to 3e-8. Added to 1 instead of `nearest`, it would be rounded once more.
    let excess = w * (LN_2 + w * 0.240_226_51);
    if inside { (nearest + nearest * excess) * scale } else { 0.0 }
}

/// 2^(i/FRACTIONS).
static FRACTION_POWERS: [f32; FRACTIONS] = {
    /// 2^(1/64).
    const STEP: f64 = 1.010_889_286_051_700_5;
    let mut powers = [0.0; FRACTIONS];
    let (mut i, mut power) = (0, 1.0);
    while i < FRACTIONS {
        powers[i] = power as f32;
        power *= STEP;
        i += 1;
    }
    powers
};
const FRACTIONS: usize = 64;

/// The whole number e and the half tangent t, |t| ≤ 0.2, of 1 + part/whole = 2ᵉ (1+t)/(1−t).
///
/// Of one number, not of lanes: compilers leave arbitrary numbers in lanes that are not read, and a
/// subnormal one takes as long as five calls.
#[inline(always)]
fn growth(whole: f32, part: f32) -> [f32; 2] {
    const HALF: i32 = 1 << 22;
    let sum = whole + part;
    let [low, high] = [whole, sum].map(|x| x.to_bits() as i32);
    // sum/whole is 2ᵉ m with |log₂ m| ≤ 0.59, since bits are linear between powers of 2.
    let exponent = high.wrapping_sub(low).wrapping_add(HALF) >> 23;
    let scaled = f32::from_bits(low.wrapping_add(exponent << 23) as u32);
    // The first difference is exact; the second is the rounding error of the sum.
    let excess = (sum - scaled) + (part - (sum - whole));
    [exponent as f32, excess / (sum + scaled)]
}

/// 2ˣ for x ≤ 126, to 2e-7; below −126 the least normal number.
#[inline(always)]
pub(crate) fn exp2<L: Lanes>(x: L) -> L {
    let [power, shifted] = whole_and_fraction(x.fast_max(L::splat(LEAST_EXPONENT)));
    let scale = shifted.to_bits().up::<23>() + L::Ints::splat(127 << 23);
    power * L::from_bits(scale)
}

const LEAST_EXPONENT: f32 = -126.0;

/// log₂ of (1+t)/(1−t), 2 artanh(t)/ln 2, by powers of t².
#[inline(always)]
fn log2_of_half_tangent<T>(t: T) -> T
where
    T: Copy + Mul<Output = T> + Mul<f32, Output = T> + Add<f32, Output = T>,
{
    t * series_of_half_tangent(t * t)
}

/// [`log2_of_half_tangent`] over t, from y = t²: for |t| ≤ 0.2, to 3e-9.
#[inline(always)]
fn series_of_half_tangent<T>(y: T) -> T
where
    T: Copy + Mul<Output = T> + Mul<f32, Output = T> + Add<f32, Output = T>,
{
    // Horner's scheme: in the split into halves y² may be subnormal, and slow.
    y * (y * (y * 0.439_189_35 + 0.576_390_26) + 0.961_802_25) + 2.885_390_07
}

/// 2ʷ, and a number whose last bits are the whole number x − w; w ∈ [−½, ½].
#[inline(always)]
fn whole_and_fraction<L: Lanes>(x: L) -> [L; 2] {
    // A sum with this is rounded to a whole number.
    const SHIFT: f32 = 12_582_912.0;
    let shifted = x + SHIFT;
    let w = x - (shifted - SHIFT);
    // To 2e-9.
    let square = w * w;
    let low = w * LN_2 + 1.0;
    let middle = w * 0.055_503_27 + 0.240_226_51;
    let high = (w * 0.001_340_042_8 + 0.009_618_057) + square * 0.000_154_614_45;
    [(low + square * middle) + (square * square) * high, shifted]
}

#[cfg(test)]
mod tests {
    use microfacet_lanes::f32x4;

    use super::*;

    #[test]
    fn turns_are_those_of_the_library() {
        for i in 0..=4096 {
            let u = i as f32 / 4096.0;
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(u));
            let [s, c] = turn(u).map(f64::from);
            assert!((s - sin).abs() < 2e-7 && (c - cos).abs() < 2e-7, "{u}: {s}, {c}");
            assert_eq!(turns(f32x4::splat(u)).map(|x| x.to_array()[2]), turn(u), "{u}");
        }
        for i in 0..=1000 {
            let u = 0.25 * libm::exp2f(-0.1 * i as f32);
            let [s, c] = quarter_turn(u).map(f64::from);
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(u));
            assert!((s / sin - 1.0).abs() < 3e-7 && (c - cos).abs() < 2e-7, "{u}: {s}, {c}");
        }
        assert_eq!([0.0, 0.5, 1.0].map(|u| turn(u)[0]), [0.0; 3]);
        assert_eq!([0.25, 0.75].map(|u| turn(u)[1]), [0.0; 2]);
    }

    #[test]
    fn logarithms_and_powers_are_those_of_the_library() {
        let one = |f: fn(f32x4) -> f32x4, x: f32| f64::from(f(f32x4::splat(x)).to_array()[1]);
        for i in 0..=2000 {
            // From the least normal number to 1, and closer to 1 than an ulp of ½.
            for x in [libm::exp2f(-0.063 * i as f32), 1.0 - i as f32 * 2.0_f32.powi(-24)] {
                let (got, want) = (one(log2, x), libm::log2(f64::from(x)));
                assert!((got - want).abs() <= 2e-7 * want.abs(), "{x}: {got} for {want}");
            }
            let x = -0.063 * i as f32;
            let (got, want) = (one(exp2, x), libm::exp2(f64::from(x)));
            assert!((got / want - 1.0).abs() < 2e-7, "{x}: {got} for {want}");
        }
        for x in [126.0, 0.5, 1.5, 33.49999, 64.0] {
            let (got, want) = (one(exp2, x), libm::exp2(f64::from(x)));
            assert!((got / want - 1.0).abs() < 2e-7, "{x}: {got} for {want}");
        }
        assert_eq!([one(log2, 1.0), one(log2, 0.0)], [0.0, f64::NEG_INFINITY]);
        assert_eq!(one(exp2, 0.0), 1.0);
        let least = f64::from(f32::MIN_POSITIVE);
        assert_eq!([one(exp2, -130.0), one(exp2, f32::NEG_INFINITY)], [least; 2]);
    }

    #[test]
    fn growths_keep_the_digits_of_small_parts() {
        // Parts from far below an ulp of the whole to far above it, in steps that meet every
        // fraction of a power of 2.
        for whole in [1.0_f32, 1.999_999_9, 0.731, 3e-9, 2e-38] {
            for i in -3000..=3000 {
                let part = whole * libm::exp2f(0.0101 * i as f32);
                if !(f32::MIN_POSITIVE..1e38).contains(&part) {
                    continue;
                }
                let got = log2_growth(whole, part);
                let quotient = f64::from(part) / f64::from(whole);
                let (got, want) = (f64::from(got), libm::log1p(quotient) / core::f64::consts::LN_2);
                assert!((got - want).abs() <= 3e-7 * want, "{whole} {part}: {got} for {want}");
            }
        }
        assert_eq!(log2_growth(0.3, 0.0), 0.0);
        // A `whole` of 0 counts as the least normal number.
        let all = log2_growth(0.0, 1.0);
        assert!((126.0..=128.0).contains(&all), "{all}");
    }

    #[test]
    fn powers_of_growths_are_those_of_the_library() {
        for power in [0.25, 0.499, 0.0, -0.5, -1.0, -20.0, -1e4, -5e11] {
            for i in -3000..=3000 {
                let part = libm::exp2(0.0101 * f64::from(i) - 20.0) as f32;
                let want = libm::exp(libm::log1p(part.into()) * f64::from(power));
                let got = f64::from(scaled_power_of_growth(1.0, part, power, 0.5));
                if want < 2.4e-38 {
                    // Powers below 2⁻¹²⁶ = 1.2e-38 are 0.
                    assert!(got <= want, "{part} {power}: {got}");
                    continue;
                }
                let tolerance = 4e-7 * (1.0 + libm::log(want).abs());
                assert!((2.0 * got / want - 1.0).abs() < tolerance, "{part} {power}: {got}");
            }
        }
        let ends = [(0.0, 1.0, -1.0), (1.0, f32::INFINITY, -1.0), (1.0, f32::NAN, 1.0)];
        for (whole, part, power) in ends {
            let got = scaled_power_of_growth(whole, part, power, 1.0);
            assert!((0.0..1e-37).contains(&got), "{whole} {part}: {got}");
        }
    }
}
