//! The axis of indices of refraction.

use core::f64::consts::FRAC_PI_2;

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
