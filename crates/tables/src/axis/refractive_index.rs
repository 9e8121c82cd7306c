//! The axis of indices of refraction.

use core::f64::consts::{FRAC_PI_2, SQRT_2};

use serde::{Deserialize, Serialize};

use microfacet_core::math::sqrt64;

use super::coordinate::{Coordinate, Placement};

/// The coordinate of an index of refraction η ∈ [1, ∞], dense side over thin: t = acos(1 − 2x)/π ∈
/// [0, 1] with x = F0^¼ = √((η−1)/(η+1)).
///
/// It is finer towards both ends, where the reflectance of grazing views changes within √(η²−1) and
/// 1/η of the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReflectanceRoot;

impl ReflectanceRoot {
    /// t of η ∈ [1, ∞].
    pub fn coordinate(&self, eta: f64) -> f64 {
        // sin²(πt/2) = F0^¼.
        let root = if eta == f64::INFINITY { 1.0 } else { sqrt64((eta - 1.0) / (eta + 1.0)) };
        libm::asin(sqrt64(root)) / FRAC_PI_2
    }

    /// 1/η of t.
    pub fn inverse_index(&self, t: f64) -> f64 {
        let (sin, cos) = libm::sincos(FRAC_PI_2 * t);
        let root = sin * sin;
        if t < 1.0 { cos * cos * (1.0 + root) / (1.0 + root * root) } else { 0.0 }
    }

    /// η of t; ∞ for 1.
    pub fn quantity(&self, t: f64) -> f64 {
        1.0 / self.inverse_index(t)
    }
}

impl Coordinate for ReflectanceRoot {
    fn formula(&self) -> &'static str {
        "t = acos(1 − 2x)/π, x = √((η−1)/(η+1))"
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }
}

/// [`ReflectanceRoot`] in two parts of equal width, which meet at η = √2: there the cosines √(1 −
/// 1/η²) and 1/η, at which the parts of [`CriticalBlend`](super::CriticalBlend) meet, change their
/// order. A polynomial reads nodes of one part only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrossingRoot {
    /// Whether nodes crowd towards √2: where tails are heavy, the light that one angle turns on is
    /// seen at the other as a square root of their distance.
    pub crowded: bool,
}

/// t of [`CrossingRoot`] at η = √2.
const CROSSING: f64 = 0.5;

impl CrossingRoot {
    /// t of η ∈ [1, ∞].
    pub fn coordinate(&self, eta: f64) -> f64 {
        let [r, c] = [eta, SQRT_2].map(|eta| ReflectanceRoot.coordinate(eta));
        let away = |d: f64| CROSSING * if self.crowded { sqrt64(d) } else { d };
        if r < c { CROSSING - away((c - r) / c) } else { CROSSING + away((r - c) / (1.0 - c)) }
    }

    /// η of t; ∞ for 1.
    pub fn quantity(&self, t: f64) -> f64 {
        let c = ReflectanceRoot.coordinate(SQRT_2);
        let x = t / CROSSING - 1.0;
        let d = if self.crowded { x * x.abs() } else { x };
        // The ends are exactly 1 and ∞.
        ReflectanceRoot.quantity(if d < 0.0 { c * (1.0 + d) } else { 1.0 - (1.0 - c) * (1.0 - d) })
    }
}

impl Coordinate for CrossingRoot {
    fn formula(&self) -> &'static str {
        "two parts, each interpolated from its own nodes: (1 − d)/2 with d = (c−r)/c for r < c, else \
         (1 + d)/2 with d = (r−c)/(1−c), or √d in place of d if crowded; r = acos(1 − 2√((η−1)/(η+1)))/π, \
         c = r of η = √2"
    }

    fn placement(&self) -> Placement {
        Placement::Free
    }

    fn knots(&self) -> &'static [f64] {
        &[CROSSING]
    }
}
