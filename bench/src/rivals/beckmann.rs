//! Beckmann, γ = ∞: visible normals by numerical inversion, and G1 with its rational fit.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;

use super::elementary::{nine, polynomial};

/// 1/√π.
const SQRT_PI_INV: f32 = 0.564_189_6;

/// The error function of x ≥ 0 to 1.5e-7, Abramowitz and Stegun 7.1.26, and the exp(−x²) that it
/// contains.
#[inline(always)]
pub(super) fn erf(x: f32) -> [f32; 2] {
    let gauss = (-x * x).exp();
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let c = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    [1.0 - t * polynomial(t, &c) * gauss, gauss]
}

/// The inverse error function by Giles 2010, "Approximating the erfinv function", single precision.
#[inline(always)]
pub(crate) fn erf_inv(x: f32) -> f32 {
    // At ±1 itself the logarithm would be infinite.
    let x = x.clamp(-0.999_99, 0.999_99);
    let w = -((1.0 - x) * (1.0 + x)).ln();
    x * if w < 5.0 {
        let c = [
            1.501_409_4,
            2.466_407_3e-1,
            -4.177_681_6e-3,
            -1.253_725e-3,
            2.185_808_7e-4,
            -4.391_506_5e-6,
            -3.523_387_7e-6,
            3.432_739_4e-7,
            2.810_226_4e-8,
        ];
        nine(w - 2.5, &c)
    } else {
        let c = [
            2.832_976_8,
            1.001_674_1,
            9.438_870_5e-3,
            -7.622_461_3e-3,
            5.739_507_7e-3,
            -3.673_428_4e-3,
            1.349_343_2e-3,
            1.009_505_6e-4,
            -2.002_142_6e-4,
        ];
        nine(w.sqrt() - 3.0, &c)
    }
}

/// The slope away from the viewer and the slope across, in units of σ, of a view whose unit
/// cotangent is `cot` = cot θ/σ.
///
/// Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution"
/// (<http://www.mitsuba-renderer.org/~wenzel/files/visnormal.pdf>): Newton steps within a bracket,
/// over the error function of the slope, until the CDF is within 1e-5 of `u[0]`.
#[inline(always)]
pub(super) fn slopes(cot: f32, u: [f32; 2]) -> [f32; 2] {
    slopes_of(cot, erf(cot), u)
}

/// [`slopes`], given the error function of `cot`.
#[inline(always)]
pub(super) fn slopes_of(cot: f32, [erf, gauss]: [f32; 2], u: [f32; 2]) -> [f32; 2] {
    let tan = 1.0 / cot;
    let across = SQRT_PI_INV * tan;
    // The CDF is (1 + b + across exp(−slope²))/area, b = erf slope.
    let area = 1.0 + erf + across * gauss;
    let number = u[0].max(1e-6);
    let (target, tolerance) = (number * area - 1.0, 1e-5 * area);
    let (mut low, mut high) = (-1.0, erf);
    // Jakob's starting value: the inverse of a fit to the CDF.
    let theta = arc_tangent(tan, cot);
    let fit = polynomial(theta, &[1.0, -0.876, 0.4265, -0.0594]);
    let mut b = erf - (1.0 + erf) * (1.0 - number).powf(fit);
    let mut slope = 0.0;
    for _ in 1..10 {
        // Also catches NaN.
        if !(b >= low && b <= high) {
            b = 0.5 * (low + high);
        }
        slope = erf_inv(b);
        let value = b + across * (-slope * slope).exp() - target;
        if value.abs() < tolerance {
            break;
        }
        if value > 0.0 {
            high = b;
        } else {
            low = b;
        }
        b -= value / (1.0 - slope * tan);
    }
    [slope, erf_inv(2.0 * u[1].max(1e-6) - 1.0)]
}

/// The arc tangent of a tangent, given the cotangent, to 2e-5: enough for a starting value.
#[inline(always)]
fn arc_tangent(tan: f32, cot: f32) -> f32 {
    let t = tan.min(cot);
    let arc =
        t * polynomial(t * t, &[0.999_964_8, -0.331_544_6, 0.184_463_6, -0.090_752_0, 0.023_286_0]);
    if tan > cot { FRAC_PI_2 - arc } else { arc }
}

/// A visible normal from its slopes; `u[0]` rises away from the viewer.
#[inline(always)]
pub(crate) fn sample(sigma: f32, v: Vec3, u: [f32; 2]) -> Vec3 {
    let w = Vec3::new(sigma * v.x, sigma * v.y, v.z);
    let rho = (w.x * w.x + w.y * w.y).sqrt();
    let inverse = 1.0 / rho.max(1e-9);
    let [away, across] = slopes(w.z * inverse, u);
    let (cos, sin) = if rho > 0.0 { (w.x * inverse, w.y * inverse) } else { (1.0, 0.0) };
    normal(sigma, [cos, sin], [-away, across])
}

/// The unit normal of unit slopes towards the viewer and across, turned to the view's azimuth and
/// stretched.
#[inline(always)]
pub(crate) fn normal(sigma: f32, [cos, sin]: [f32; 2], [x, y]: [f32; 2]) -> Vec3 {
    let m = Vec3::new(sigma * (x * cos - y * sin), sigma * (x * sin + y * cos), 1.0);
    m * (1.0 / m.dot(m).sqrt())
}

/// ρ = σ sin θ, never 0: cot θ/σ is cos θ/ρ.
#[inline(always)]
fn radius(sigma: f32, w: Vec3) -> f32 {
    (sigma * (w.x * w.x + w.y * w.y).sqrt()).max(1e-9)
}

/// G1 = 2/(1 + erf a + exp(−a²)/(a√π)), a = cot θ/σ (Walter et al. 2007,
/// doi:10.2312/EGWR/EGSR07/195-206, eq. 26).
#[inline(always)]
pub(crate) fn g1(sigma: f32, w: Vec3) -> f32 {
    let a = w.z / radius(sigma, w);
    let [erf, gauss] = erf(a);
    2.0 * a / (a * (1.0 + erf) + SQRT_PI_INV * gauss)
}

/// The rational fit of G1 (Walter et al. 2007, eq. 27), as a fraction of σ sin θ and cos θ. The fit
/// is 1 at a = 1.6, and G1 is taken as 1 beyond: clamping z and the result avoids a branch.
#[inline(always)]
pub(crate) fn g1_rational(sigma: f32, w: Vec3) -> f32 {
    let rho = radius(sigma, w);
    let z = w.z.min(1.6 * rho);
    ((3.535 * rho + 2.181 * z) * z / (rho * rho + (2.276 * rho + 2.577 * z) * z)).min(1.0)
}
