//! Elementary functions over the ranges that samplers need, in a few multiplications.
//!
//! They consist of operations that every system rounds alike, so a sampled normal has the same bits
//! everywhere, and they take a fraction of a library's time, whose functions serve every argument.
//! The polynomials are interpolations at Chebyshev's points.

use core::f32::consts::{LN_2, TAU};

use wide::{bytemuck, f32x4, i32x4};

/// The sine and the cosine of 2πu for u ∈ [0, 1], to 2e-7 absolute, exact at quarters of a turn
/// where they are 0.
#[inline(always)]
pub(crate) fn turn(u: f32) -> [f32; 2] {
    // Of x ∈ [−¼, ¼]; the polynomial errs by 7e-9.
    let sine = |x: f32| {
        let y = x * x;
        x * (TAU + y * (-41.341_68 + y * (81.602_475 + y * (-76.581_17 + y * 39.759_827))))
    };
    let x = 0.5 - u;
    let quarter = x.abs() - 0.25;
    [sine((0.25 - quarter.abs()).copysign(x)), sine(quarter)]
}

/// log₂ of positive normal numbers, to 1e-7 of the logarithm (so also next to 1) and 1 ulp of its
/// integer part; −∞ for 0 and below.
#[inline(always)]
pub(crate) fn log2(x: f32x4) -> f32x4 {
    // x = 2ᵉ m with m ∈ [√½, √2], and log₂ m = 2 artanh((m−1)/(m+1))/ln 2, to 2e-9.
    const ROOT_HALF: i32 = 0x3f35_04f3;
    let bits: i32x4 = bytemuck::cast(x);
    let exponent: i32x4 = (bits - ROOT_HALF) >> 23;
    let m: f32x4 = bytemuck::cast(bits - (exponent << 23));
    let t = (m - 1.0) / (m + 1.0);
    let y = t * t;
    let log =
        t * (2.885_390_1 + y * (f32x4::splat(0.961_798_84) + y * (0.576_715_2 + y * 0.431_717_7)));
    let log = f32x4::from_i32x4(exponent) + log;
    x.simd_gt(0.0).select(log, f32x4::splat(f32::NEG_INFINITY))
}

/// 2ˣ for x ≤ 0, to 2e-7; below −126 the least normal number.
#[inline(always)]
pub(crate) fn exp2(x: f32x4) -> f32x4 {
    let x = x.fast_max(f32x4::splat(-126.0));
    // The cast truncates, and −½ makes that a rounding for x ≤ 0.
    let whole = (x - 0.5).fast_trunc_int();
    let w = x - f32x4::from_i32x4(whole);
    // 2ʷ for w ∈ [−½, ½], to 2e-9.
    let square = w * w;
    let low = 1.0 + w * LN_2;
    let high = (0.240_226_51 + w * 0.055_503_27)
        + square * ((0.009_618_057 + w * 0.001_340_042_8) + square * 0.000_154_614_45);
    let scale: f32x4 = bytemuck::cast((whole + 127) << 23);
    (low + square * high) * scale
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_the_library() {
        for i in 0..=4096 {
            let u = i as f32 / 4096.0;
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(u));
            let [s, c] = turn(u).map(f64::from);
            assert!((s - sin).abs() < 2e-7 && (c - cos).abs() < 2e-7, "{u}: {s}, {c}");
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
        assert_eq!([one(log2, 1.0), one(log2, 0.0)], [0.0, f64::NEG_INFINITY]);
        assert_eq!(one(exp2, 0.0), 1.0);
        let least = f64::from(f32::MIN_POSITIVE);
        assert_eq!([one(exp2, -130.0), one(exp2, f32::NEG_INFINITY)], [least; 2]);
    }
}
