//! The azimuth of views as an axis of a table: a closed circle, or its quarter with mirrors at both ends.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, TAU};

use crate::albedo_axes::{STENCIL, lagrange};
use crate::axis::{Axis, Mapping};
use crate::math::sqrt64;

/// The azimuth coordinate of one table; see [`Mapping::Azimuth`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Azimuth {
    /// σ₁ and σ₂ along the principal axes.
    sigma: [f64; 2],
    /// Cosine and sine of the first axis's azimuth.
    turn: [f64; 2],
    fold: bool,
    nodes: usize,
}

impl Azimuth {
    /// `None` for another mapping.
    pub(crate) fn new(axis: &Axis) -> Option<Self> {
        let Mapping::Azimuth { sigma, turn, fold } = axis.mapping else { return None };
        let (s, c) = libm::sincos(turn);
        Some(Self { sigma, turn: [c, s], fold, nodes: axis.nodes.len() })
    }

    /// A direction's components along the principal axes.
    fn principal(&self, c: f64, s: f64) -> [f64; 2] {
        let [ct, st] = self.turn;
        [ct * c + st * s, ct * s - st * c]
    }

    /// σ_φ of the direction (cos φ, sin φ).
    pub(crate) fn sigma(&self, c: f64, s: f64) -> f64 {
        let [x, y] = self.principal(c, s);
        libm::hypot(self.sigma[0] * x, self.sigma[1] * y)
    }

    /// (cos φ, sin φ) at a coordinate.
    pub(crate) fn direction(&self, t: f64) -> [f64; 2] {
        let p = if self.fold { core::f64::consts::FRAC_PI_2 * t } else { core::f64::consts::TAU * t };
        let (s, c) = libm::sincos(p);
        let (x, y) = (c / sqrt64(self.sigma[0]), s / sqrt64(self.sigma[1]));
        let (length, [ct, st]) = (libm::hypot(x, y), self.turn);
        [(ct * x - st * y) / length, (st * x + ct * y) / length]
    }

    /// dφ/dp at a coordinate, up to a factor: how much of the circle a step of the coordinate stands for.
    fn share(&self, t: f64) -> f64 {
        // φ = atan2(y, x) of (x, y) = (cos p/√σ₁, sin p/√σ₂) has the rate 1/(√σ₁ √σ₂ (x² + y²)).
        let p = if self.fold { core::f64::consts::FRAC_PI_2 * t } else { core::f64::consts::TAU * t };
        let (s, c) = libm::sincos(p);
        1.0 / (c * c / self.sigma[0] + s * s / self.sigma[1])
    }

    /// Nodes and weights of the polynomial at (cos φ, sin φ).
    #[inline]
    pub(crate) fn stencil(&self, c: f64, s: f64) -> [(usize, f32); STENCIL] {
        if self.nodes == 1 {
            let mut one = [(0, 0.0); STENCIL];
            one[0].1 = 1.0;
            return one;
        }
        let [x, y] = self.principal(c, s);
        let (x, y) = ((sqrt64(self.sigma[0]) * x) as f32, (sqrt64(self.sigma[1]) * y) as f32);
        let n = self.nodes as i64;
        let at = if self.fold {
            libm::atan2f(y.abs(), x.abs()).min(FRAC_PI_2) * FRAC_2_PI * (n - 1) as f32
        } else {
            let p = libm::atan2f(y, x);
            (if p < 0.0 { p + TAU } else { p }) / TAU * n as f32
        };
        let start = libm::floorf(at) as i64 - STENCIL as i64 / 2 + 1;
        let weights = lagrange(at - start as f32);
        core::array::from_fn(|i| {
            let i_node = start + i as i64;
            let node = if self.fold {
                // Mirrored at both ends, as often as it takes.
                let round = i_node.rem_euclid(2 * (n - 1));
                round.min(2 * (n - 1) - round)
            } else {
                i_node.rem_euclid(n)
            };
            (node as usize, weights[i])
        })
    }

    /// Directions spread over the coordinate, with the share of the circle that each stands for; the shares add up to one.
    ///
    /// The midpoint rule, which on a closed circle is as good as any.
    pub(crate) fn circle(&self) -> impl Iterator<Item = ([f64; 2], f64)> {
        // Four between nodes; a limit for tables of any size.
        let steps = if self.nodes == 1 { 1 } else { (4 * self.nodes).min(256) };
        let middle = move |i: usize| (i as f64 + 0.5) / steps as f64;
        let whole: f64 = (0..steps).map(|i| self.share(middle(i))).sum();
        (0..steps).map(move |i| (self.direction(middle(i)), self.share(middle(i)) / whole))
    }
}
