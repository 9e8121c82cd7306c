//! The normal distribution function of a Student-t lobe, D, in closed form.
//!
//! With r/z the slope of a normal over σ, b = z² + s r² and γ = (1+s)/s, πσxσy D = z^(2γ−4) b^(−γ),
//! which is computed as (b/z²)^(2−γ)/b²: the power is small for γ near 2 and 0 for γ = 2, and
//! towards Beckmann the logarithm of b/z² = 1 + s r²/z² keeps the digits of a small s.
//!
//! [`PowerLaw`] computes the power for any γ. [`Normals`] reads it from a table of one γ, in half
//! the time, unless γ is large: there a rounding of b/z² by ½ ulp is one of D by γ/2 ulp.

use alloc::boxed::Box;

use microfacet_core::saturated;

use super::power_table::PowerTable;
use crate::elementary::{log2_growth, scaled_power_of_growth};

/// The constants of D of one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PowerLaw {
    pub(crate) s: f32,
    /// 1 − γ/2.
    pub(crate) power: f32,
}

/// D of one shape, which may be of any roughness.
#[derive(Clone, Debug)]
pub(crate) struct Normals {
    pub(crate) law: PowerLaw,
    /// Powers of b/z², for γ ≤ 16.
    table: Option<Box<PowerTable>>,
}

/// Stands for s = 0: the D of Beckmann to rounding, as far as D is not 0. A much smaller value
/// would make squares subnormal, and slow. A power of two, so that it and its reciprocal are not
/// rounded.
const LEAST_S: f64 = 1.0 / 1_099_511_627_776.0;

/// 1 − γ/2.
fn power(s: f64) -> f64 {
    0.5 - 0.5 / s
}

impl PowerLaw {
    pub(crate) fn new(s: f64) -> Self {
        let s = s.max(LEAST_S);
        Self { s: s as f32, power: power(s) as f32 }
    }

    /// Of s and γ, of which neither is 0 or ∞.
    #[inline(always)]
    pub(crate) fn of_shape(s: f32, gamma: f32) -> Self {
        const LARGEST: f32 = (1.0 / LEAST_S) as f32;
        Self { s: s.max(LEAST_S as f32), power: 0.5 - 0.5 * (gamma - 1.0).min(LARGEST) }
    }

    /// D of a normal above the horizon from the squares of [`root`](Self::root) and 1/(πσxσy).
    #[inline(always)]
    pub(crate) fn d(&self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32 {
        of_root(self.root(r2, z2, length2), scale)
    }

    /// √(πσxσy D) of a normal above the horizon from the squares of its horizontal component over
    /// σ, of its vertical component, and of its length, which need not be 1.
    #[inline(always)]
    pub(crate) fn root(&self, r2: f32, z2: f32, length2: f32) -> f32 {
        let part = self.s * r2;
        let scale = length2 / (z2 + part).max(f32::MIN_POSITIVE);
        scaled_power_of_growth(z2, part, self.power, scale)
    }

    /// log₂(1 + s x²)/s of a squared unit slope, x² log₂ e in the limit s = 0.
    #[inline(always)]
    pub(crate) fn log2_growth(&self, x2: f32) -> f32 {
        log2_growth(1.0, self.s * x2) / self.s
    }
}

/// D from √(πσxσy D) and 1/(πσxσy): by the root, since D/(σxσy) may be in range where its factors
/// are not.
#[inline(always)]
fn of_root(root: f32, scale: f32) -> f32 {
    saturated((scale * root) * root)
}

impl Normals {
    pub(crate) fn new(s: f64) -> Self {
        let exact = power(s.max(LEAST_S));
        let table = (exact.abs() <= PowerTable::STEEPEST).then(|| PowerTable::new(exact));
        Self { table, ..Self::untabulated(s) }
    }

    /// The same D, without the table.
    pub(crate) fn untabulated(s: f64) -> Self {
        Self { law: PowerLaw::new(s), table: None }
    }

    /// [`PowerLaw::d`], from the table where it holds the power.
    #[inline(always)]
    pub(crate) fn d(&self, r2: f32, z2: f32, length2: f32, scale: f32) -> f32 {
        of_root(self.root(r2, z2, length2), scale)
    }

    /// [`PowerLaw::root`], from the table where it holds the power.
    #[inline(always)]
    fn root(&self, r2: f32, z2: f32, length2: f32) -> f32 {
        // A subnormal z² counts as about the least normal number in the power law. It counts as
        // itself here: D would jump to that of the law where b/z² becomes infinite.
        if let Some(table) = &self.table
            && z2 >= f32::MIN_POSITIVE
        {
            // Two divisions, which do not wait for each other, take less time than one with the
            // products that both quotients then need, and round less.
            let b = z2 + self.law.s * r2;
            if let Some(root) = table.scaled(b / z2, length2 / b) {
                return root;
            }
        }
        self.law.root(r2, z2, length2)
    }

    pub(crate) fn bytes(&self) -> usize {
        self.table.as_deref().map_or(0, size_of_val)
    }
}

#[cfg(test)]
mod tests {
    use microfacet_core::shape::s_of_gamma;

    use super::*;

    /// γ, and the relative error of D that the table has up to 16, and the power law beyond.
    const ERRORS: [(f64, f64); 14] = [
        (1.501, 7e-7),
        (1.55, 8e-7),
        (1.6, 7e-7),
        (1.9, 8e-7),
        (2.0, 2e-7),
        (2.5, 7e-7),
        (4.0, 8e-7),
        (7.3, 1.4e-6),
        (15.0, 2.7e-6),
        (16.0, 2.8e-6),
        (16.001, 1.4e-5),
        (40.0, 8e-6),
        (1e4, 1.4e-5),
        (f64::INFINITY, 1e-5),
    ];

    /// r² and z² of normals of the lobe, and of others down to the horizon, for a σ.
    fn squares(s: f64, sigma: f64) -> impl Iterator<Item = [f32; 2]> {
        let of_lobe = (0..3000).map(move |i| {
            // P(slope > x) = (1 + s x²)^(−1/s), which falls to 1e-12.
            let log = -27.6 * (f64::from(i) * 0.618_034).fract();
            let x2 = if s == 0.0 { -log } else { libm::expm1(-s * log) / s };
            let length2 = 1.0 + sigma * sigma * x2;
            [x2 / length2, 1.0 / length2]
        });
        let low = (0..400).map(move |i| {
            let z2 = libm::exp2(-0.31 * f64::from(i));
            [(1.0 - z2) / (sigma * sigma), z2]
        });
        of_lobe.chain(low).map(|squares| squares.map(|x| x as f32))
    }

    /// b/z² less 1, the power of b/z², and √(πσxσy D), in double precision.
    fn exact(gamma: f64, [r2, z2]: [f32; 2]) -> [f64; 3] {
        let [r2, z2] = [r2, z2].map(f64::from);
        if gamma == f64::INFINITY {
            let power = libm::exp(-0.5 * r2 / z2);
            return [0.0, power, power / z2];
        }
        let part = r2 * s_of_gamma(gamma);
        let power = libm::exp(libm::log1p(part / z2) * (1.0 - 0.5 * gamma));
        [part / z2, power, power / (z2 + part)]
    }

    #[test]
    fn d_has_the_error_of_its_shape() {
        let least = f64::from(f32::MIN_POSITIVE);
        for (gamma, limit) in ERRORS {
            let normals = Normals::new(s_of_gamma(gamma));
            assert_eq!(normals.bytes() > 0, gamma <= 16.0, "{gamma}");
            // From the table, where b/z² overflows, and from the power law.
            let mut worst = [0.0_f64; 3];
            for sigma in [1e-8, 1e-3, 0.05, 0.5, 2.0, 1e3, 1e6] {
                for [r2, z2] in squares(s_of_gamma(gamma), sigma) {
                    let [growth, power, root] = exact(gamma, [r2, z2]);
                    // Smaller powers are 0, and what is subnormal has lost its digits.
                    if power.min(root).min(z2.into()) < 1.01 * least || root > 3.4e38 {
                        continue;
                    }
                    let error = |got| 2.0 * (f64::from(got) / root - 1.0).abs();
                    let of = usize::from(growth > 3.4e38);
                    worst[of] = worst[of].max(error(normals.root(r2, z2, 1.0)));
                    worst[2] = worst[2].max(error(normals.law.root(r2, z2, 1.0)));
                }
            }
            for (worst, limit) in worst.into_iter().zip([limit, 6.2e-6, 1.6e-5]) {
                assert!(worst < limit, "{gamma}: {worst:e}");
            }
            assert!(worst[0] > 0.8 * limit, "{gamma}: {worst:?}");
        }
    }

    /// Both forms of D, at squares r², z² and length² that only odd vectors or matrices have.
    #[test]
    fn corners_are_those_of_the_power_law() {
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        let corners = [
            ("straight up", [0.0, 1.0, 1.0]),
            ("the null vector", [0.0, 0.0, 0.0]),
            ("on the horizon", [1.0, 0.0, 1.0]),
            ("on the horizon of a mirror", [1e16, 0.0, 1.0]),
            ("z² on the edge of what is subnormal", [1.0, 1.2e-38, 1.0]),
            ("b/z² on the edge of infinity", [1.0, 2.95e-39, 1.0]),
            ("b/z² beyond it", [1e16, 1e-30, 1.0]),
            ("a matrix of 1e18", [1e-36, 1e-30, 1.0]),
            ("a matrix of 1e-18", [1e36, 0.3, 1.0]),
            ("a matrix of 1e-18, low", [1e36, 1e-12, 1.0]),
            ("a short normal", [3e-20, 2e-20, 4e-20]),
            ("a long normal", [3e20, 2e20, 4e20]),
            ("a length out of range", [1e28, 1.0, inf]),
            ("a tangent out of range", [inf, 1.0, inf]),
            ("a height out of range", [1.0, inf, inf]),
            ("both out of range", [inf, inf, inf]),
            ("a tangent that is no number", [nan, 1.0, nan]),
            ("a height that is no number", [1.0, nan, nan]),
        ];
        for (gamma, _) in ERRORS {
            let normals = Normals::new(s_of_gamma(gamma));
            let law = Normals::untabulated(s_of_gamma(gamma));
            for (name, [r2, z2, length2]) in corners {
                // 1/(πσxσy) of σ from 1e-8 to 1e6, and of matrices.
                for scale in [3e15, 0.3, 3e-13, 3e35, 3e-37] {
                    let [got, want] = [&normals, &law].map(|of| of.d(r2, z2, length2, scale));
                    let close = (got - want).abs() <= 1.6e-5 * want;
                    // Digits are lost below the least normal number.
                    let lost = got.max(want) < f32::MIN_POSITIVE;
                    assert!(close || lost, "{name}, gamma {gamma}: {got:e} for {want:e}");
                }
            }
        }
        // Towards the horizon D grows without limit for γ < 2 and vanishes for γ > 2.
        let low = |gamma| Normals::new(s_of_gamma(gamma)).d(1.0, 1e-37, 1.0, 3e21);
        assert_eq!(low(1.501), f32::MAX);
        assert!(low(4.0) < 1e-30);
    }
}
