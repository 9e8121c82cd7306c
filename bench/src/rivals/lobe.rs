//! Student-t through closed forms of its lobe in single precision: G1, and visible normals by
//! inverting the CDFs numerically.

use glam::Vec3;

use super::form::{self, AnyGamma, Area, HalfIntegerGamma, IntegerGamma, Tails, View};
use super::tail::{Tail, whole};

/// A lobe with its coefficients prepared.
pub(crate) struct Lobe<F> {
    sigma: f32,
    /// √(γ−1): a slope divided by σ and by this is a slope of the lobe's own space.
    root: f32,
    /// σ√(γ−1).
    stretch: f32,
    form: F,
    /// 1/∫(1−t²)^(γ−2) and 1/∫(1−t²)^(γ−3/2), and of the second its inverse.
    density: [f32; 2],
    whole: f32,
    /// The weight of slopes in the projected area, see [`form::edge`].
    edge: f32,
    /// 2γ−5 and 2γ−3.
    exponents: [f32; 2],
    /// The sine across the plane of incidence as q + c₀q³ + c₁q⁵, q = (u − ½) ∫(1−t²)^(γ−3/2).
    series: [f32; 2],
}

/// Tolerance of both CDFs, the same as that of the iteration for Beckmann.
const TOLERANCE: f32 = 1e-5;

/// The last step of an inversion ends within one tolerance if the value is below [`CLOSE`]
/// tolerances and the relative curvature below [`NEARLY_STRAIGHT`].
const CLOSE: f32 = 100.0;
const NEARLY_STRAIGHT: f32 = 0.03;

impl Lobe<AnyGamma> {
    /// Any γ.
    pub(crate) fn any(sigma: f64, gamma: f64) -> Self {
        Self::new(sigma, gamma, AnyGamma::new(gamma))
    }
}

impl Lobe<IntegerGamma<3>> {
    /// γ = 4.
    pub(crate) fn four(sigma: f64) -> Self {
        Self::new(sigma, 4.0, IntegerGamma::new())
    }
}

impl Lobe<HalfIntegerGamma<2>> {
    /// γ = 3.5.
    pub(crate) fn three_and_a_half(sigma: f64) -> Self {
        Self::new(sigma, 3.5, HalfIntegerGamma::new())
    }
}

impl<F: Area> Lobe<F> {
    fn new(sigma: f64, gamma: f64, closed: F) -> Self {
        let wholes = [gamma - 2.0, gamma - 1.5].map(whole);
        let p = gamma - 1.5;
        Self {
            sigma: sigma as f32,
            root: (gamma - 1.0).sqrt() as f32,
            stretch: (sigma * (gamma - 1.0).sqrt()) as f32,
            form: closed,
            density: wholes.map(|whole| (1.0 / whole) as f32),
            whole: wholes[1] as f32,
            edge: form::edge(gamma) as f32,
            exponents: [(2.0 * gamma - 5.0) as f32, (2.0 * gamma - 3.0) as f32],
            series: [(p / 3.0) as f32, (p * (7.0 * p + 3.0) / 30.0) as f32],
        }
    }

    /// The elevation of a direction in the lobe's space.
    #[inline(always)]
    fn view(&self, w: Vec3) -> View {
        let rho = self.stretch * (w.x * w.x + w.y * w.y).sqrt();
        let rho2 = self.stretch * self.stretch * (w.x * w.x + w.y * w.y);
        let r = 1.0 / (rho2 + w.z * w.z).sqrt();
        View { sin: rho * r, cos: w.z * r, square: rho2 * r * r }
    }

    /// Smith's G1: the projected area of the flat surface over that of the microsurface.
    #[inline(always)]
    pub(crate) fn g1(&self, w: Vec3) -> f32 {
        let view = self.view(w);
        view.cos / self.form.area(view)
    }
}

impl<F: Tails> Lobe<F> {
    /// The visible normal at both random numbers, in the same order as that of the tables.
    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let horizontal = (v.x * v.x + v.y * v.y).sqrt();
        let [sin_a, cos_a] = self.along(horizontal, v, u[0]);
        let [sin_b, cos_b] = self.across(u[1]);
        let inverse = 1.0 / horizontal;
        let (cos, sin) = if horizontal > 0.0 { (v.x * inverse, v.y * inverse) } else { (1.0, 0.0) };
        let (x, y, z) = (self.stretch * cos_b * sin_a, self.stretch * sin_b, cos_b * cos_a);
        let m = Vec3::new(x * cos - y * sin, x * sin + y * cos, z);
        m * (1.0 / m.dot(m).sqrt())
    }

    /// Sine and cosine of the tilt in the plane of incidence.
    #[inline(always)]
    fn along(&self, horizontal: f32, v: Vec3, u: f32) -> [f32; 2] {
        let view = self.view(v);
        let View { sin, cos, .. } = view;
        let area = self.form.area(view);
        let target = (1.0 - u) * area;
        let edge = sin * self.edge;
        // GGX has the quantile in closed form, sin(α − θ) = u (1 + cos θ) − 1; its unit slope is
        // close to that of other shapes.
        let rho = self.sigma * horizontal;
        let r = 1.0 / (rho * rho + v.z * v.z).sqrt();
        let (ggx_sin, ggx_cos) = (rho * r, v.z * r);
        let q = u * (1.0 + ggx_cos) - 1.0;
        let other = (1.0 - q * q).max(0.0).sqrt();
        let slope = [q * ggx_cos + other * ggx_sin, self.root * (other * ggx_cos - q * ggx_sin)];
        let start = slope[0] / (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        invert(start, [-cos, 1.0], TOLERANCE * area, |x| {
            let y = (1.0 - x * x).max(1e-12);
            let c = y.sqrt();
            let (power, over) = (self.form.power(c, y), x / y);
            let facing = cos * c + sin * x;
            let mass = cos * self.form.tails().0.upper(x, c, power * y * c) + edge * power * y;
            let density = self.density[0] * power;
            let bend = sin - cos * over * c - self.exponents[0] * over * facing;
            [mass - target, density * facing, density * bend]
        })
    }

    /// Sine and cosine of the tilt across the plane of incidence.
    #[inline(always)]
    fn across(&self, u: f32) -> [f32; 2] {
        let target = u.min(1.0 - u);
        let q = (0.5 - target) * self.whole;
        let start = q * (1.0 + q * q * (self.series[0] + q * q * self.series[1]));
        let [sin, cos] = invert(start, [0.0, 1.0], TOLERANCE, |x| {
            let y = (1.0 - x * x).max(1e-12);
            let c = y.sqrt();
            let power = self.form.power(c, y);
            let density = self.density[1] * power;
            let tail = self.form.tails().1.upper(x, c, power * y * y);
            [tail - target, density * y, -self.exponents[1] * x * density]
        });
        [sin.copysign(u - 0.5), cos]
    }
}

/// The sine at which a decreasing function is 0 within `tolerance`, and the cosine: Halley's steps
/// inside a bracket. `f` gives the value, minus the derivative, and the derivative of that.
#[inline(always)]
fn invert(
    mut x: f32,
    [mut low, mut high]: [f32; 2],
    tolerance: f32,
    f: impl Fn(f32) -> [f32; 3],
) -> [f32; 2] {
    for _ in 0..30 {
        if !(x > low && x < high) {
            x = 0.5 * (low + high);
        }
        let [value, rate, bend] = f(x);
        if value.abs() < tolerance {
            break;
        }
        if value > 0.0 {
            low = x;
        } else {
            high = x;
        }
        let (square, curved) = (rate * rate, value * bend);
        x += value * rate / (square + 0.5 * curved);
        // The step multiplies a small residual by about the square of curved/square, so the new
        // residual need not be checked.
        if value.abs() < CLOSE * tolerance && curved.abs() < NEARLY_STRAIGHT * square {
            x = x.max(low).min(high);
            break;
        }
    }
    [x, (1.0 - x * x).max(0.0).sqrt()]
}
