//! The azimuth of views as an axis: a closed circle, or a quarter of it mirrored at both ends.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, TAU};
use core::f64::consts;

use microfacet_core::gauss_legendre;
use microfacet_core::math::sqrt64;
use serde::{Deserialize, Serialize};

use super::coordinate::{Coordinate, Placement};
use super::lagrange::{SIX, six_weights};

/// The azimuth φ of a view, in radians from the x axis, as a coordinate t ∈ [0, 1].
///
/// With p = atan2(√σ₂ sin(φ − turn), √σ₁ cos(φ − turn)), t = p/2π modulo one, and the nodes are 0,
/// 1/n, …, (n−1)/n. Where `fold`, with |sin| and |cos|, t = 2p/π, and the nodes are 0, 1/(n−1),
/// …, 1. A single node stands for every azimuth.
///
/// p lies half-way between φ and the azimuth in unit space: a narrow lobe varies with φ within an
/// angle of its aspect ratio, and everything else varies with the azimuth in unit space. σ_φ, with
/// σ_φ² = σ₁² cos²(φ − turn) + σ₂² sin²(φ − turn), is the roughness along φ, and replaces σ in
/// [`ViewBlend`](super::ViewBlend).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Azimuth {
    /// σ₁ and σ₂ along the principal axes. In files it is left out where it is σx and σy of the
    /// table's lobe, and then 0 until the lobe is known.
    #[serde(default, skip_serializing_if = "is_left_out")]
    pub sigma: [f64; 2],
    /// Azimuth of the first principal axis, in radians.
    pub turn: f64,
    /// Whether the tabulated quantity is symmetric about both principal axes.
    pub fold: bool,
}

fn is_left_out(sigma: &[f64; 2]) -> bool {
    *sigma == [0.0; 2]
}

impl Azimuth {
    /// Prepares the coordinate for an axis of `nodes` nodes.
    pub fn prepare(&self, nodes: usize) -> PreparedAzimuth {
        let (s, c) = libm::sincos(self.turn);
        PreparedAzimuth { sigma: self.sigma, turn: [c, s], fold: self.fold, nodes }
    }
}

impl Coordinate for Azimuth {
    fn formula(&self) -> &'static str {
        "t = p/2π mod 1, p = atan2(√σ₂ sin δ, √σ₁ cos δ), δ = φ − turn, sigma = [σ₁, σ₂]; where fold, t = \
         2p/π of |sin δ| and |cos δ|"
    }

    fn fault(&self) -> Option<&'static str> {
        let sound = self.sigma.iter().all(|x| (1e-12..=1e6).contains(x)) && self.turn.abs() <= 7.0;
        (!sound).then_some("sigma or turn out of range")
    }

    fn placement(&self) -> Placement {
        if self.fold { Placement::Even } else { Placement::Closed }
    }

    fn count_fault(&self, _: usize) -> Option<&'static str> {
        None
    }
}

/// [`Azimuth`] prepared for an axis of a number of nodes.
#[derive(Clone, Copy, Debug)]
pub struct PreparedAzimuth {
    sigma: [f64; 2],
    /// Cosine and sine of the first axis's azimuth.
    turn: [f64; 2],
    fold: bool,
    nodes: usize,
}

impl PreparedAzimuth {
    /// The components of a direction along the principal axes.
    fn principal(&self, c: f64, s: f64) -> [f64; 2] {
        let [ct, st] = self.turn;
        [ct * c + st * s, ct * s - st * c]
    }

    /// The principal components times √σ₁ and √σ₂, whose angle is p.
    fn stretched(&self, c: f64, s: f64) -> [f64; 2] {
        let [x, y] = self.principal(c, s);
        [sqrt64(self.sigma[0]) * x, sqrt64(self.sigma[1]) * y]
    }

    /// σ_φ of the direction (cos φ, sin φ).
    pub fn sigma(&self, c: f64, s: f64) -> f64 {
        let [x, y] = self.principal(c, s);
        libm::hypot(self.sigma[0] * x, self.sigma[1] * y)
    }

    /// t ∈ [0, 1] of the direction (cos φ, sin φ); unless folded, 0 and 1 are the same azimuth.
    pub fn coordinate(&self, c: f64, s: f64) -> f64 {
        let [x, y] = self.stretched(c, s);
        if self.fold {
            return libm::atan2(y.abs(), x.abs()) / consts::FRAC_PI_2;
        }
        let t = libm::atan2(y, x) / consts::TAU;
        if t < 0.0 { t + 1.0 } else { t }
    }

    /// (cos φ, sin φ) at t.
    pub fn direction(&self, t: f64) -> [f64; 2] {
        let (s, c) = libm::sincos(self.angle(t));
        let (x, y) = (c / sqrt64(self.sigma[0]), s / sqrt64(self.sigma[1]));
        let (length, [ct, st]) = (libm::hypot(x, y), self.turn);
        [(ct * x - st * y) / length, (st * x + ct * y) / length]
    }

    /// φ ∈ [0, 2π] at t.
    pub fn quantity(&self, t: f64) -> f64 {
        let [c, s] = self.direction(t);
        let phi = libm::atan2(s, c);
        if phi < 0.0 { phi + consts::TAU } else { phi }
    }

    /// p at t.
    fn angle(&self, t: f64) -> f64 {
        if self.fold { consts::FRAC_PI_2 * t } else { consts::TAU * t }
    }

    /// dφ/dp at t, up to a factor: the share of the circle that a step of the coordinate covers.
    fn share(&self, t: f64) -> f64 {
        // φ = atan2(y, x) of (x, y) = (cos p/√σ₁, sin p/√σ₂) has the derivative 1/(√σ₁ √σ₂
        // (x² + y²)).
        let (s, c) = libm::sincos(self.angle(t));
        1.0 / (c * c / self.sigma[0] + s * s / self.sigma[1])
    }

    /// The six nodes nearest to (cos φ, sin φ) with their weights in the polynomial, in single
    /// precision.
    #[inline]
    pub fn six(&self, c: f64, s: f64) -> [(usize, f32); SIX] {
        if self.nodes == 1 {
            let mut one = [(0, 0.0); SIX];
            one[0].1 = 1.0;
            return one;
        }
        let [x, y] = self.stretched(c, s).map(|x| x as f32);
        let n = self.nodes as i64;
        let at = if self.fold {
            libm::atan2f(y.abs(), x.abs()).min(FRAC_PI_2) * FRAC_2_PI * (n - 1) as f32
        } else {
            let p = libm::atan2f(y, x);
            (if p < 0.0 { p + TAU } else { p }) / TAU * n as f32
        };
        let start = libm::floorf(at) as i64 - SIX as i64 / 2 + 1;
        let weights = six_weights(at - start as f32);
        core::array::from_fn(|i| {
            let i_node = start + i as i64;
            let node = if self.fold {
                // Mirrored at both ends, as often as needed.
                let round = i_node.rem_euclid(2 * (n - 1));
                round.min(2 * (n - 1) - round)
            } else {
                i_node.rem_euclid(n)
            };
            (node as usize, weights[i])
        })
    }

    /// Directions spread over the coordinate, each with its share of the circle; the shares add up
    /// to one. Each cell has a Gauss–Legendre rule, because interpolated values have kinks at the
    /// nodes.
    pub fn circle(&self) -> impl Iterator<Item = ([f64; 2], f64)> {
        const RULE: [(f64, f64); 4] = gauss_legendre();
        // Limits the number of directions for tables of any size.
        let cells = if self.fold { self.nodes - 1 } else { self.nodes }.clamp(1, 64);
        let points = RULE.len() * if self.nodes == 1 { 0 } else { cells };
        let at = move |i: usize| {
            let (node, weight) = RULE[i % RULE.len()];
            let t = ((i / RULE.len()) as f64 + node) / cells as f64;
            (t, weight * self.share(t))
        };
        let whole: f64 = (0..points).map(|i| at(i).1).sum();
        let spread = (0..points).map(at).map(move |(t, share)| (self.direction(t), share / whole));
        // A single node has the values of every azimuth.
        (points == 0).then(|| (self.direction(0.0), 1.0)).into_iter().chain(spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [Azimuth; 3] = [
        Azimuth { sigma: [0.3, 0.3], turn: 0.0, fold: true },
        Azimuth { sigma: [0.02, 1.5], turn: 0.0, fold: true },
        Azimuth { sigma: [0.9, 0.1], turn: 1.1, fold: false },
    ];

    #[test]
    fn there_and_back() {
        for axis in AXES {
            let prepared = axis.prepare(9);
            for t in [0.0, 0.05, 0.3, 0.5, 0.77, 0.999] {
                let [c, s] = prepared.direction(t);
                assert!((prepared.coordinate(c, s) - t).abs() < 1e-14, "{axis:?}, {t}");
                let (sin, cos) = libm::sincos(prepared.quantity(t));
                assert!((sin - s).abs() < 1e-15 && (cos - c).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_fast_form_reads_the_nodes_about_the_coordinate() {
        for axis in AXES {
            let n = 17;
            let prepared = axis.prepare(n);
            for i in 0..400 {
                let t = (f64::from(i) + 0.3) / 400.0;
                let [c, s] = prepared.direction(t);
                // A function of low degree with the axis's own symmetry.
                let f = |t: f64| libm::cos(prepared.angle(t) * if axis.fold { 2.0 } else { 1.0 });
                // Three nodes on either side.
                let cell = t * if axis.fold { n - 1 } else { n } as f64;
                assert_eq!(prepared.six(c, s)[2].0, cell as usize, "{axis:?}, {t}");
                let at =
                    |(i, w): (usize, f32)| f64::from(w) * f(axis.placement().node(i, n).unwrap());
                let got: f64 = prepared.six(c, s).into_iter().map(at).sum();
                assert!((got - f(t)).abs() < 1e-4, "{axis:?}, {t}: {got} for {}", f(t));
            }
            let shares: f64 = prepared.circle().map(|(_, share)| share).sum();
            assert!((shares - 1.0).abs() < 1e-14);
        }
    }
}
