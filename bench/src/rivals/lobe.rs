//! Student-t through closed forms of its lobe in single precision: G1, and visible normals by inverting the CDFs numerically.

use glam::Vec3;

use super::tail::{ArcSum, Beta, Sum, Tail, whole};

/// A bound lobe; `A` and `B` are the tails along and across the plane of incidence.
pub(crate) struct Lobe<A, B> {
    sigma: f32,
    /// √(γ−1): slopes over σ and this are those of the lobe's own space.
    root: f32,
    exponent: Exponent,
    along: A,
    across: B,
    /// 1/∫(1−t²)^(γ−2) and 1/∫(1−t²)^(γ−3/2).
    density: [f32; 2],
    /// 1/(2γ−3).
    heavy: f32,
}

/// 2γ − 5.
#[derive(Clone, Copy)]
enum Exponent {
    Any(f32),
    /// Whether it is odd, and half of it.
    Whole(bool, u32),
}

impl Exponent {
    /// cos^(2γ−5).
    #[inline(always)]
    fn of(self, cos: f32) -> f32 {
        match self {
            Self::Any(exponent) => cos.powf(exponent),
            Self::Whole(odd, half) => {
                (0..half).fold(if odd { cos } else { 1.0 }, |power, _| power * cos * cos)
            }
        }
    }
}

/// Both CDFs are met within this, as by the other rival that iterates.
const TOLERANCE: f32 = 1e-5;

impl Lobe<Beta, Beta> {
    /// Any γ.
    pub(crate) fn any(sigma: f64, gamma: f64) -> Self {
        let exponent = Exponent::Any((2.0 * gamma - 5.0) as f32);
        Self::new(sigma, gamma, exponent, Beta::new(gamma - 2.0), Beta::new(gamma - 1.5))
    }
}

impl Lobe<Sum<3>, ArcSum<3>> {
    /// γ = 4.
    pub(crate) fn four(sigma: f64) -> Self {
        Self::new(sigma, 4.0, Exponent::Whole(true, 1), Sum::new(), ArcSum::new())
    }
}

impl Lobe<ArcSum<2>, Sum<3>> {
    /// γ = 3.5.
    pub(crate) fn three_and_a_half(sigma: f64) -> Self {
        Self::new(sigma, 3.5, Exponent::Whole(false, 1), ArcSum::new(), Sum::new())
    }
}

impl<A: Tail, B: Tail> Lobe<A, B> {
    fn new(sigma: f64, gamma: f64, exponent: Exponent, along: A, across: B) -> Self {
        let density = [whole(gamma - 2.0), whole(gamma - 1.5)].map(|whole| (1.0 / whole) as f32);
        let heavy = (1.0 / (2.0 * gamma - 3.0)) as f32;
        Self {
            sigma: sigma as f32,
            root: (gamma - 1.0).sqrt() as f32,
            exponent,
            along,
            across,
            density,
            heavy,
        }
    }

    /// Mass of the tilts whose sine is above `sin`, for a view with (sin θ, cos θ) in the lobe's space.
    #[inline(always)]
    fn mass(&self, view: [f32; 2], sin: f32, cos: f32, power: f32) -> f32 {
        let cubed = power * cos * cos;
        view[1] * self.along.upper(sin, cos, cubed) + view[0] * self.density[0] * self.heavy * cubed
    }

    /// (sin θ, cos θ) of a direction in the lobe's space.
    #[inline(always)]
    fn elevation(&self, w: Vec3) -> [f32; 2] {
        let stretch = self.sigma * self.root;
        let rho = stretch * (w.x * w.x + w.y * w.y).sqrt();
        let r = 1.0 / (rho * rho + w.z * w.z).sqrt();
        [rho * r, w.z * r]
    }

    /// The area seen, of which (mass above the silhouette) the clamped slopes are left out.
    #[inline(always)]
    fn area(&self, [sin, cos]: [f32; 2]) -> f32 {
        self.mass([sin, cos], -cos, sin, self.exponent.of(sin))
    }

    /// Smith's G1: the share of the area that its projection takes.
    #[inline(always)]
    pub(crate) fn g1(&self, w: Vec3) -> f32 {
        let view = self.elevation(w);
        view[1] / self.area(view)
    }

    /// The visible normal at both numbers: they rise as those of the tables do.
    #[inline(always)]
    pub(crate) fn sample(&self, v: Vec3, u: [f32; 2]) -> Vec3 {
        let view = self.elevation(v);
        let (sin_a, cos_a) = self.along(v, view, u[0]);
        let (sin_b, cos_b) = self.across(u[1]);
        let across = (v.x * v.x + v.y * v.y).sqrt();
        let (cos, sin) = if across > 0.0 { (v.x / across, v.y / across) } else { (1.0, 0.0) };
        let (x, y, z) = (cos_b * sin_a, sin_b, cos_b * cos_a);
        let stretch = self.sigma * self.root;
        let m = Vec3::new(stretch * (x * cos - y * sin), stretch * (x * sin + y * cos), z);
        m * (1.0 / m.dot(m).sqrt())
    }

    /// Sine and cosine of the tilt in the plane of incidence.
    #[inline(always)]
    fn along(&self, v: Vec3, view: [f32; 2], u: f32) -> (f32, f32) {
        let [sin, cos] = view;
        let area = self.area(view);
        // GGX has the quantile in closed form, sin(α − θ) = u (1 + cos θ) − 1; its unit slope is near that of other shapes.
        let rho = self.sigma * (v.x * v.x + v.y * v.y).sqrt();
        let r = 1.0 / (rho * rho + v.z * v.z).sqrt();
        let (ggx_sin, ggx_cos) = (rho * r, v.z * r);
        let q = u * (1.0 + ggx_cos) - 1.0;
        let other = (1.0 - q * q).max(0.0).sqrt();
        let slope = [q * ggx_cos + other * ggx_sin, self.root * (other * ggx_cos - q * ggx_sin)];
        let start = slope[0] / (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        let at = newton(start, [-cos, 1.0], TOLERANCE * area, |x| {
            let c = (1.0 - x * x).max(1e-12).sqrt();
            let power = self.exponent.of(c);
            let rate = power * (cos * c + sin * x) * self.density[0];
            (self.mass(view, x, c, power) - (1.0 - u) * area, rate)
        });
        (at, (1.0 - at * at).max(0.0).sqrt())
    }

    /// Sine and cosine of the tilt across it.
    #[inline(always)]
    fn across(&self, u: f32) -> (f32, f32) {
        let target = u.min(1.0 - u);
        let start = (0.5 - target) / self.density[1];
        let at = newton(start, [0.0, 1.0], TOLERANCE, |y| {
            let c = (1.0 - y * y).max(1e-12).sqrt();
            // cos^(2γ−3) is the density, cos^(2γ−2) what the tail takes.
            let density = self.exponent.of(c) * c * c;
            (self.across.upper(y, c, density * c) - target, density * self.density[1])
        });
        (if u < 0.5 { -at } else { at }, (1.0 - at * at).max(0.0).sqrt())
    }
}

/// Where a decreasing function is 0 within `tolerance`: Newton steps inside a bracket. `f` gives the value and minus the derivative.
#[inline(always)]
fn newton(mut x: f32, [mut low, mut high]: [f32; 2], tolerance: f32, f: impl Fn(f32) -> (f32, f32)) -> f32 {
    for _ in 0..30 {
        if !(x > low && x < high) {
            x = 0.5 * (low + high);
        }
        let (value, rate) = f(x);
        if value.abs() < tolerance {
            break;
        }
        if value > 0.0 {
            low = x;
        } else {
            high = x;
        }
        x += value / rate;
    }
    x
}
