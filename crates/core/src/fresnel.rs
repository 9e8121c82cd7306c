//! Fresnel's reflectance of unpolarised light, of dielectrics and conductors.
//!
//! Cosines are between a direction and the microfacet normal, in [0, 1].

use crate::Real;

/// Cosine of the refracted direction, in (0, 1], by Snell's law; `None` where all light is
/// reflected.
///
/// `eta` > 0 is the index of refraction beyond the interface over that on the side of the light.
#[inline(always)]
pub fn refracted_cos<T: Real>(eta: T, cos_theta: T) -> Option<T> {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    // η² cos²θ_t = η² − 1 + cos²θ, which keeps a small cosine where η is near 1.
    let square = (eta - one) * (eta + one) + cos_theta * cos_theta;
    if square > zero { Some(square.sqrt() / eta) } else { None }
}

/// Reflectance of a dielectric from the cosines on both sides of it; `eta` as for
/// [`refracted_cos`].
///
/// Both sides reflect the same, to rounding: exchanging the cosines and inverting `eta` changes
/// only signs. 0 at η = 1, where both cosines are equal; 0/0 where both are 0.
#[inline(always)]
pub fn dielectric_of_cosines<T: Real>(eta: T, cos_theta: T, refracted: T) -> T {
    let parallel = (eta * cos_theta - refracted) / (eta * cos_theta + refracted);
    let perpendicular = (cos_theta - eta * refracted) / (cos_theta + eta * refracted);
    T::constant(0.5) * (parallel * parallel + perpendicular * perpendicular)
}

/// Exact reflectance of a dielectric ∈ [0, 1]: 1 beyond the critical angle and at grazing, 0
/// everywhere if η = 1. Transmittance is 1 − reflectance.
#[inline(always)]
pub fn dielectric<T: Real>(eta: T, cos_theta: T) -> T {
    let one = T::constant(1.0);
    if eta == one {
        return T::constant(0.0); // also at grazing, where the formula is 0/0
    }
    let refracted = refracted_cos(eta, cos_theta);
    refracted.map_or(one, |refracted| dielectric_of_cosines(eta, cos_theta, refracted))
}

/// Exact reflectance ∈ [0, 1] of a conductor of index η + ik relative to the outside, η > 0 and
/// k ≥ 0 (Born & Wolf 1999, §14.4); 1 at grazing.
///
/// Neither a nor b of the refracted wave's a + ib suffers cancellation: the smaller of them comes
/// from the product ab = ηk. With k = 0 the result is the dielectric's reflectance.
#[inline(always)]
pub fn conductor<T: Real>(eta: T, k: T, cos_theta: T) -> T {
    let (zero, half, one) = (T::constant(0.0), T::constant(0.5), T::constant(1.0));
    let (cos, sin2) = (cos_theta, one - cos_theta * cos_theta);
    // (a + ib)² = η² − k² − sin²θ + 2iηk; evaluated as it stands, 1 − sin²θ would lose a small
    // cosine where η is near 1.
    let real = (eta - one) * (eta + one) - k * k + cos * cos;
    let product = eta * k;
    let modulus = real.hypot(product + product);
    let positive = real >= zero;
    let large = (half * (modulus + if positive { real } else { zero - real })).sqrt();
    if large == zero {
        return one; // exactly at the critical angle without absorption
    }
    let small = product / large;
    let (a, b) = if positive { (large, small) } else { (small, large) };
    let ratio = |x: T, y: T| (x * x + b * b) / (y * y + b * b);
    let perpendicular = ratio(a - cos, a + cos);
    // Parallel over perpendicular: |(a + ib) cos − sin²|² / |(a + ib) cos + sin²|². Divided by the
    // cosine, sin² would overflow at grazing.
    let (along, across) = (a * cos, b * cos);
    let (less, more) = (along - sin2, along + sin2);
    let parallel = (less * less + across * across) / (more * more + across * across);
    half * perpendicular * (one + parallel)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COSINES: [f64; 9] = [0.0, 1e-9, 0.01, 1.0 / 7.0, 0.4, 0.6, 0.75, 0.99, 1.0];

    #[test]
    fn conductor_without_absorption_is_the_dielectric() {
        for eta in [0.3, 0.75, 1.0, 1.33, 1.5, 2.4, 50.0] {
            for cos in COSINES {
                // At η = 1 and grazing the conductor's limit is 1, the dielectric's is 0 by
                // definition.
                if eta == 1.0 && cos == 0.0 {
                    continue;
                }
                let (a, b) = (conductor(eta, 0.0, cos), dielectric(eta, cos));
                assert!((a - b).abs() < 1e-13, "eta {eta}, cos {cos}: {a} against {b}");
            }
        }
    }

    #[test]
    fn conductor_matches_complex_arithmetic() {
        // r_s = (cos − w)/(cos + w), r_p = (ñ² cos − w)/(ñ² cos + w), w = √(ñ² − sin²) in complex
        // numbers.
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        for (eta, k) in [(0.143, 3.98), (1.1, 7.6), (2.9, 3.05), (0.05, 1e-3), (4.0, 0.2)] {
            for cos in COSINES {
                let n2 = mul((eta, k), (eta, k));
                let d = (n2.0 - (1.0 - cos * cos), n2.1);
                let m = Real::sqrt(norm(d));
                let w = (Real::sqrt(0.5 * (m + d.0)), Real::sqrt(0.5 * (m - d.0)));
                let nc = (n2.0 * cos, n2.1 * cos);
                let s = norm((cos - w.0, -w.1)) / norm((cos + w.0, w.1));
                let p = norm((nc.0 - w.0, nc.1 - w.1)) / norm((nc.0 + w.0, nc.1 + w.1));
                let got = conductor(eta, k, cos);
                assert!((got - 0.5 * (s + p)).abs() < 1e-12, "({eta}, {k}) at {cos}: {got}");
            }
        }
    }

    #[test]
    fn both_sides_of_an_interface_reflect_alike() {
        for cos in [0.05_f64, 0.3, 0.8, 1.0] {
            let inside = refracted_cos(1.5, cos).unwrap();
            let (out, back) = (dielectric(1.5, cos), dielectric(1.0 / 1.5, inside));
            assert!((out - back).abs() < 1e-14);
            assert!((dielectric_of_cosines(1.0 / 1.5, inside, cos) - out).abs() < 1e-15);
        }
        assert_eq!(dielectric(1.0 / 1.5, 0.5), 1.0);
        assert_eq!([dielectric(1.0, 0.0), dielectric(1.0, 0.4)], [0.0; 2]);
        assert!((dielectric(1.5_f64, 1.0) - 0.04).abs() < 1e-16);
    }

    #[test]
    fn single_precision_agrees_also_where_squares_overflow_it() {
        for (eta, k) in [(0.143, 3.98), (1.5, 0.0), (0.01, 0.01), (1e8, 1e8), (1.0, 1e12)] {
            let grazing = [6e-20, 5e-20, 1e-30, f64::from(f32::MIN_POSITIVE), 1e-40];
            for cos in COSINES.into_iter().chain(grazing) {
                let exact = conductor(eta, k, cos);
                let got = f64::from(conductor(eta as f32, k as f32, cos as f32));
                assert!((got - exact).abs() < 2e-6, "({eta}, {k}) at {cos}: {got} for {exact}");
            }
        }
    }
}
