//! The axes of albedo tables: coordinates of γ, σ and the view, and the polynomials between their even nodes.

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_2, TAU};

use crate::axis::{Axis, Mapping};
use crate::azimuth::Azimuth;
use crate::critical::CriticalCoordinate;
use crate::math::sqrt64;

pub(crate) fn shape_coordinate(axis: &Axis, gamma: f64) -> f64 {
    match axis.mapping {
        Mapping::LogShape { scale } => libm::log1p(scale / (2.0 * gamma - 3.0)),
        _ => unreachable!("validated on load"),
    }
}

pub(crate) fn roughness_coordinate(axis: &Axis, sigma: f64) -> f64 {
    match axis.mapping {
        Mapping::Roughness { offset, first, slow, linear } => {
            libm::log1p(sigma / offset) + slow * libm::log(sigma / first) + linear * sigma
        }
        _ => unreachable!("validated on load"),
    }
}

/// σ at a coordinate, by bisection: the coordinate ascends.
pub(crate) fn roughness(axis: &Axis, t: f64) -> f64 {
    let (mut low, mut high) = (-40.0, 14.0);
    for _ in 0..64 {
        let ln = 0.5 * (low + high);
        if roughness_coordinate(axis, libm::exp(ln)) < t { low = ln } else { high = ln }
    }
    libm::exp(0.5 * (low + high))
}

/// The coordinate of an index η ≥ 1, ∞ included.
pub(crate) fn index_coordinate(eta: f64) -> f64 {
    // sin²(πt/2) = F0^¼.
    let root = if eta == f64::INFINITY { 1.0 } else { sqrt64((eta - 1.0) / (eta + 1.0)) };
    libm::asin(sqrt64(root)) / FRAC_PI_2
}

/// 1/η at a coordinate of an axis of indices.
pub(crate) fn inverse_index(t: f64) -> f64 {
    let (sin, cos) = libm::sincos(FRAC_PI_2 * t);
    let root = sin * sin;
    if t < 1.0 { cos * cos * (1.0 + root) / (1.0 + root * root) } else { 0.0 }
}

/// The view coordinate of one material; see [`Mapping::ViewBlend`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewCoordinate {
    weight: f64,
    normal: f64,
    share: f64,
    /// κσ.
    knee: f64,
    /// ν.
    turn: f64,
    /// μ₀ and y(μ₀).
    pub(crate) floor: f64,
    start: f64,
}

impl ViewCoordinate {
    pub(crate) fn new(axis: &Axis, sigma: f64, gamma: f64) -> Self {
        let Mapping::ViewBlend { weight, normal, share, scale, heavy, spread, floor, slope } = axis.mapping
        else {
            unreachable!("validated on load")
        };
        let knee = (scale + heavy / (2.0 * gamma - 3.0)) * sigma;
        // Without the kink of a minimum, which would show in the nodes along σ.
        let floor = floor * (slope * sigma) / (floor + slope * sigma);
        let mut view = Self { weight, normal, share, knee, turn: spread * sigma, floor, start: 0.0 };
        view.start = view.blend(floor);
        view
    }

    /// y(μ).
    fn blend(&self, cos: f64) -> f64 {
        let sin = sqrt64((1.0 - cos) * (1.0 + cos));
        let (x, h) = (cos / (cos + self.knee * sin), cos / (1.0 + sin));
        let [x4, h4] = [x, h].map(|x| sqrt64(sqrt64(x)));
        let roots = self.share * x4 + (1.0 - self.share) * h4;
        self.weight * x
            + self.normal * self.turn / (self.turn + sin)
            + (1.0 - self.weight - self.normal) * roots
    }

    /// The coordinate of cos θ ≥ μ₀.
    fn at(&self, cos: f64) -> f64 {
        (self.blend(cos) - self.start) / (1.0 - self.start)
    }

    /// The coordinate of any cos θ ∈ [0, 1]: that of the first node below μ₀.
    pub(crate) fn clamped(&self, cos: f32) -> f32 {
        if cos > self.floor as f32 { self.at(f64::from(cos)) as f32 } else { 0.0 }
    }

    /// cos θ at a coordinate, by bisection to the last bit.
    fn cos(&self, t: f64) -> f64 {
        if t >= 1.0 {
            return 1.0;
        }
        let (mut low, mut high) = (self.floor, 1.0);
        for _ in 0..80 {
            let cos = 0.5 * (low + high);
            if self.at(cos) < t { low = cos } else { high = cos }
        }
        0.5 * (low + high)
    }
}

/// Weights of the nodes about a coordinate, or `None` where the axis does not cover it.
pub(crate) fn weights(axis: &Axis, t: f64) -> Option<Vec<(usize, f64)>> {
    let (n, first, last) = (axis.nodes.len(), axis.nodes[0], axis.nodes[axis.nodes.len() - 1]);
    let slack = 1e-9 * (1.0 + last.abs());
    if !(t >= first - slack && t <= last + slack) {
        return None;
    }
    if n == 1 {
        return Some(vec![(0, 1.0)]);
    }
    let x = ((t - first) / (last - first)).clamp(0.0, 1.0) * (n - 1) as f64;
    let count = n.min(STENCIL);
    let start = first_node(x as usize, n, count);
    let x = x - start as f64;
    let weight = |i: usize| {
        let others = (0..count).filter(|&j| j != i);
        others.map(|j| (x - j as f64) / (i as f64 - j as f64)).product()
    };
    Some((0..count).map(|i| (start + i, weight(i))).collect())
}

/// Nodes that a polynomial goes through.
pub(crate) const STENCIL: usize = 6;

/// The first of `count` nodes with the cell in their middle, or as near to it as the ends allow.
fn first_node(cell: usize, n: usize, count: usize) -> usize {
    (cell + 1).saturating_sub(count / 2).min(n - count)
}

/// The first of the six nodes about t ∈ [0, 1], of `n` spread evenly, and their weights.
#[inline]
pub(crate) fn stencil(t: f32, n: usize) -> (usize, [f32; STENCIL]) {
    let x = (t * (n - 1) as f32).clamp(0.0, (n - 1) as f32);
    let start = first_node(x as usize, n, STENCIL);
    (start, lagrange(x - start as f32))
}

/// Weights of the polynomial through the nodes 0 … 5 at x.
#[inline]
pub(crate) fn lagrange(x: f32) -> [f32; STENCIL] {
    // Products from the left and from the right leave one factor out at each node.
    const C: [f32; STENCIL] = [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 12.0, 1.0 / 12.0, -1.0 / 24.0, 1.0 / 120.0];
    let mut weights = C;
    let (mut left, mut right) = (1.0, 1.0);
    for i in 0..STENCIL {
        weights[i] *= left;
        left *= x - i as f32;
        let j = STENCIL - 1 - i;
        weights[j] *= right;
        right *= x - j as f32;
    }
    weights
}

/// Where nodes of a table stand, for those who fill one.
impl Axis {
    /// σ at a coordinate of a [`Mapping::Roughness`] axis, γ at one of a [`Mapping::LogShape`] axis, η at one of a
    /// [`Mapping::ReflectanceRoot`] axis; `None` for others.
    pub fn quantity(&self, t: f64) -> Option<f64> {
        match self.mapping {
            Mapping::LogShape { scale } => Some(1.5 + 0.5 * scale / libm::expm1(t)),
            Mapping::Roughness { .. } => Some(roughness(self, t)),
            Mapping::ReflectanceRoot => Some(1.0 / inverse_index(t)),
            _ => None,
        }
    }

    /// The coordinate of σ along a [`Mapping::Roughness`] axis, of γ along a [`Mapping::LogShape`] axis, of η ≥ 1 along a
    /// [`Mapping::ReflectanceRoot`] axis; `None` for others.
    pub fn coordinate(&self, quantity: f64) -> Option<f64> {
        match self.mapping {
            Mapping::LogShape { .. } => Some(shape_coordinate(self, quantity)),
            Mapping::Roughness { .. } => Some(roughness_coordinate(self, quantity)),
            Mapping::ReflectanceRoot => Some(index_coordinate(quantity)),
            _ => None,
        }
    }

    /// φ ∈ [0, 2π) at a coordinate of a [`Mapping::Azimuth`] axis and the roughness σ_φ seen from there; `None` for others.
    pub fn azimuth(&self, t: f64) -> Option<(f64, f64)> {
        let azimuth = Azimuth::new(self)?;
        let [c, s] = azimuth.direction(t);
        let phi = libm::atan2(s, c);
        Some((if phi < 0.0 { phi + TAU } else { phi }, azimuth.sigma(c, s)))
    }

    /// cos θ at a coordinate of a [`Mapping::ViewBlend`] axis for one material; `None` for others.
    pub fn view_cosine(&self, sigma: f64, gamma: f64, t: f64) -> Option<f64> {
        let blends = matches!(self.mapping, Mapping::ViewBlend { .. });
        blends.then(|| ViewCoordinate::new(self, sigma, gamma).cos(t))
    }

    /// cos θ at a coordinate of a [`Mapping::CriticalBlend`] axis for one material and an index η ≥ 1; `None` for others.
    pub fn critical_view_cosine(&self, sigma: f64, gamma: f64, eta: f64, t: f64) -> Option<f64> {
        let splits = matches!(self.mapping, Mapping::CriticalBlend { .. });
        splits.then(|| CriticalCoordinate::new(self, sigma, gamma, 1.0 / eta).cos(t))
    }
}
