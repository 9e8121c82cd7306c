//! Elementary functions over the ranges that rivals need, in single precision and without branches;
//! the platform's functions cover every range.
//!
//! The polynomials are interpolations at Chebyshev's points.

use std::f32::consts::FRAC_1_PI;
use std::ops::{Add, Mul};

/// c₀ + c₁x + c₂x² + … by Horner's rule.
#[inline(always)]
pub(crate) fn polynomial<T: Copy + Add<Output = T> + Mul<Output = T>, const N: usize>(
    x: T,
    c: &[T; N],
) -> T {
    // Not a fold from 0: the compiler would keep its first step.
    let mut sum = c[N - 1];
    for i in (0..N - 1).rev() {
        sum = sum * x + c[i];
    }
    sum
}

/// The same for nine coefficients, as two chains that a processor runs in parallel: half the
/// latency.
#[inline(always)]
pub(crate) fn nine(x: f32, c: &[f32; 9]) -> f32 {
    let square = x * x;
    polynomial(square, &[c[0], c[2], c[4], c[6], c[8]])
        + x * polynomial(square, &[c[1], c[3], c[5], c[7]])
}

/// The sine from −¼ to ¼ of a turn, to 7e-9: the turn times a polynomial in its square.
pub(crate) const SINE: [f32; 5] =
    [6.283_185_28, -41.341_680_6, 81.602_476_4, -76.581_172_6, 39.759_827_1];

/// The sine and the cosine of 2πu, u ∈ [0, 1], to 1e-7.
#[inline(always)]
pub(crate) fn turn(u: f32) -> [f32; 2] {
    let sine = |x: f32| x * polynomial(x * x, &SINE);
    let x = 0.5 - u;
    let quarter = x.abs() - 0.25;
    [sine((0.25 - quarter.abs()).copysign(x)), sine(quarter)]
}

/// The angle in [−π/2, π/2] of a sine and a cosine, over π, to 1.5e-7: twice the arc tangent of the
/// half angle's tangent.
#[inline(always)]
pub(crate) fn arc(sin: f32, cos: f32) -> f32 {
    // The arc tangent from −1 to 1, to 1e-8.
    const ARC: [f32; 9] = [
        0.999_999_982,
        -0.333_330_367,
        0.199_918_720,
        -0.141_977_978,
        0.106_183_706,
        -0.074_568_548,
        0.042_137_624,
        -0.015_731_249,
        0.002_766_284,
    ];
    let t = sin / (1.0 + cos);
    2.0 * FRAC_1_PI * t * nine(t * t, &ARC)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    #[test]
    fn are_those_of_the_library() {
        for i in 0..=1000 {
            let u = i as f32 / 1000.0;
            let (sin, cos) = (TAU * f64::from(u)).sin_cos();
            let [s, c] = turn(u).map(f64::from);
            assert!((s - sin).abs() < 2e-7 && (c - cos).abs() < 2e-7, "{u}: {s}, {c}");
            let angle = PI * (f64::from(u) - 0.5);
            let got = f64::from(arc(angle.sin() as f32, angle.cos() as f32));
            assert!((got - angle / PI).abs() < 1.5e-7, "{angle}: {got}");
        }
    }
}
