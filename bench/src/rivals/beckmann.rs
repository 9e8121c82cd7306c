//! Beckmann, γ = ∞: visible normals by numerical inversion, and G1 with its rational fit.

use std::f32::consts::PI;

use glam::Vec3;

/// 1/√π.
const SQRT_PI_INV: f32 = 0.564_189_6;

/// The error function to 1.5e-7, Abramowitz and Stegun 7.1.26.
#[inline(always)]
pub(crate) fn erf(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let p = 1.061_405_429_f32;
    let p = (((p * t - 1.453_152_027) * t + 1.421_413_741) * t - 0.284_496_736) * t + 0.254_829_592;
    (1.0 - p * t * (-x * x).exp()).copysign(x)
}

/// The inverse error function by Giles 2010, "Approximating the erfinv function", single precision.
#[inline(always)]
pub(crate) fn erf_inv(x: f32) -> f32 {
    // At ±1 itself the logarithm would be infinite.
    let x = x.clamp(-0.999_99, 0.999_99);
    let w = -((1.0 - x) * (1.0 + x)).ln();
    let polynomial = |c: [f32; 9], w: f32| c.iter().fold(0.0, |p, c| p * w + c);
    x * if w < 5.0 {
        let c = [
            2.810_226_4e-8,
            3.432_739_4e-7,
            -3.523_387_7e-6,
            -4.391_506_5e-6,
            2.185_808_7e-4,
            -1.253_725e-3,
            -4.177_681_6e-3,
            2.466_407_3e-1,
            1.501_409_4,
        ];
        polynomial(c, w - 2.5)
    } else {
        let c = [
            -2.002_142_6e-4,
            1.009_505_6e-4,
            1.349_343_2e-3,
            -3.673_428_4e-3,
            5.739_507_7e-3,
            -7.622_461_3e-3,
            9.438_870_5e-3,
            1.001_674_1,
            2.832_976_8,
        ];
        polynomial(c, w.sqrt() - 3.0)
    }
}

/// The slope away from the viewer and the slope across, in units of σ, of a view whose unit cotangent is `cot` = cot θ/σ.
///
/// Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution": Newton steps within a bracket, over
/// the error function of the slope, until the CDF is within 1e-5 of `u[0]`.
#[inline(always)]
pub(crate) fn slopes(cot: f32, u: [f32; 2]) -> [f32; 2] {
    let (tan, theta) = (1.0 / cot, (1.0 / cot).atan());
    let (mut low, mut high) = (-1.0, erf(cot));
    let number = u[0].max(1e-6);
    // His starting value: the inverse of a fit to the CDF.
    let fit = 1.0 + theta * (-0.876 + theta * (0.4265 - 0.0594 * theta));
    let mut b = high - (1.0 + high) * (1.0 - number).powf(fit);
    let norm = 1.0 / (1.0 + high + SQRT_PI_INV * tan * (-cot * cot).exp());
    for _ in 1..10 {
        // Catches what is no number, too.
        if !(b >= low && b <= high) {
            b = 0.5 * (low + high);
        }
        let slope = erf_inv(b);
        let value = norm * (1.0 + b + SQRT_PI_INV * tan * (-slope * slope).exp()) - number;
        if value.abs() < 1e-5 {
            break;
        }
        if value > 0.0 {
            high = b;
        } else {
            low = b;
        }
        b -= value / (norm * (1.0 - slope * tan));
    }
    [erf_inv(b), erf_inv(2.0 * u[1].max(1e-6) - 1.0)]
}

/// A visible normal from its slopes; `u[0]` rises away from the viewer.
#[inline(always)]
pub(crate) fn sample(sigma: f32, v: Vec3, u: [f32; 2]) -> Vec3 {
    let w = Vec3::new(sigma * v.x, sigma * v.y, v.z);
    let rho = (w.x * w.x + w.y * w.y).sqrt();
    let [away, across] = slopes(w.z / rho.max(1e-9), u);
    let (cos, sin) = if rho > 0.0 { (w.x / rho, w.y / rho) } else { (1.0, 0.0) };
    normal(sigma, [cos, sin], [-away, across])
}

/// The unit normal of unit slopes towards the viewer and across, turned to the view's azimuth and stretched.
#[inline(always)]
pub(crate) fn normal(sigma: f32, [cos, sin]: [f32; 2], [x, y]: [f32; 2]) -> Vec3 {
    let m = Vec3::new(sigma * (x * cos - y * sin), sigma * (x * sin + y * cos), 1.0);
    m * (1.0 / m.dot(m).sqrt())
}

#[inline(always)]
pub(crate) fn cotangent(sigma: f32, w: Vec3) -> f32 {
    w.z / (sigma * (w.x * w.x + w.y * w.y).sqrt())
}

/// G1 = 2/(1 + erf a + exp(−a²)/(a√π)), a = cot θ/σ (Walter et al. 2007, eq. 26).
#[inline(always)]
pub(crate) fn g1(sigma: f32, w: Vec3) -> f32 {
    let a = cotangent(sigma, w);
    2.0 / (1.0 + erf(a) + (-a * a).exp() / (a * PI.sqrt()))
}

/// Its rational fit (Walter et al. 2007, eq. 27).
#[inline(always)]
pub(crate) fn g1_rational(sigma: f32, w: Vec3) -> f32 {
    let a = cotangent(sigma, w);
    if a >= 1.6 {
        return 1.0;
    }
    (3.535 + 2.181 * a) * a / (1.0 + (2.276 + 2.577 * a) * a)
}
