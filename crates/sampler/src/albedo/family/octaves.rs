//! A logarithm for coordinates: cheap, smooth, and near log₂.

use wide::{bytemuck, f32x4, i32x4};

/// The whole part of log₂ x from the exponent, and (10m − 4m² + m³)/7 of the mantissa 1 + m, for
/// positive normal numbers.
///
/// Two continuous derivatives pass the powers of two, so that tables may have splines along it. It
/// differs from log₂ by at most 0.0045, which only moves nodes.
#[inline(always)]
pub(super) fn octaves(x: f32x4) -> f32x4 {
    let bits: i32x4 = bytemuck::cast(x);
    let mantissa: f32x4 =
        bytemuck::cast((bits & i32x4::splat(0x7f_ffff)) | i32x4::splat(0x3f80_0000));
    let m = mantissa - 1.0;
    let exponent = f32x4::from_i32x4(bits >> 23) - 127.0;
    exponent + m * (m * (m - 4.0) + 10.0) * (1.0 / 7.0)
}

/// The x in [low, high] at which an ascending function takes a value, or the nearer end.
pub(super) fn inverse([low, high]: [f32; 2], value: f32, of: impl Fn(f32) -> f32) -> f32 {
    if of(low) >= value {
        return low;
    }
    if of(high) <= value {
        return high;
    }
    // Bits of positive numbers ascend with them.
    let [mut low, mut high] = [low, high].map(f32::to_bits);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if of(f32::from_bits(middle)) < value { low = middle } else { high = middle }
    }
    f32::from_bits(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(x: f32) -> f32 {
        octaves(f32x4::splat(x)).to_array()[2]
    }

    #[test]
    fn it_is_near_the_logarithm_and_smooth() {
        let slope = |x: f32| (one(1.01 * x) - one(0.99 * x)) / 0.02;
        for i in 0..4000 {
            let x = libm::exp2f(-30.0 + 0.01 * i as f32);
            assert!((one(x) - libm::log2f(x)).abs() < 4.5e-3, "{x}");
            // That of log₂ is 1/ln 2 = 1.4427.
            assert!((1.41..1.47).contains(&slope(x)), "{x}: {}", slope(x));
        }
        assert_eq!([0.25, 1.0, 8.0].map(one), [-2.0, 0.0, 3.0]);
    }

    #[test]
    fn inverses_are_met_and_clamped() {
        let of = |x| inverse([0.1, 50.0], x, one);
        assert!((one(of(3.3)) - 3.3).abs() < 1e-6);
        assert_eq!([of(-9.0), of(9.0)], [0.1, 50.0]);
        // From 0, which has no logarithm, on.
        assert_eq!(inverse([0.0, 1.0], 0.0, |q| one(1.0 + q)), 0.0);
    }
}
