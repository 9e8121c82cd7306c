//! The coordinates of the volume: of the shape, of the roughness and of the view. Here alone stand
//! their formulas and the distances of nodes.
//!
//! The constants were found by searching for the least error of E with a volume of half a MiB;
//! `cargo test -p microfacet-sampler family -- --nocapture` prints the errors.

use alloc::vec::Vec;

use microfacet_core::math::{sqrt, sqrt64};

use super::octaves::{inverse, octaves};
use super::spline::{THREE, cubic_weights, quadratic_weights};

/// Evenly spaced nodes along an ascending coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nodes {
    first: f32,
    /// Nodes for each unit of the coordinate, their number, and the last.
    density: f32,
    pub(super) count: usize,
    last: f32,
}

impl Nodes {
    /// About `step` apart; one node where the ends are the same.
    fn new([first, last]: [f32; 2], step: f32) -> Self {
        let width = last - first;
        if width < 1e-5 {
            return Self { first, density: 0.0, count: 1, last: 0.0 };
        }
        let cells = libm::ceilf(width / step).max(2.0);
        Self { first, density: cells / width, count: cells as usize + 1, last: cells }
    }

    /// The first of three coefficients and their weights.
    #[inline(always)]
    fn weights(&self, coordinate: f32) -> (u32, [f32; THREE]) {
        let x = (coordinate - self.first) * self.density;
        quadratic_weights(clamp(x, [0.0, self.last]))
    }

    /// The coordinates of the nodes.
    fn coordinates(self) -> impl Iterator<Item = f32> {
        let step = if self.count > 1 { 1.0 / self.density } else { 0.0 };
        (0..self.count).map(move |i| self.first + i as f32 * step)
    }
}

/// x clamped to a range, and its low end for NaN.
#[inline(always)]
fn clamp(x: f32, [low, high]: [f32; 2]) -> f32 {
    // Each comparison is one instruction, unlike `max` and `min`.
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// Shapes, by q = 1/(2γ−3).
#[derive(Clone, Copy, Debug)]
pub(super) struct Shapes {
    /// 2γ−3 of the smallest γ and of the largest.
    ends: [f32; 2],
    pub(super) nodes: Nodes,
}

impl Shapes {
    /// Octaves of 1 + 10 q between nodes.
    const STEP: f32 = 0.352;

    pub(super) fn new(gammas: [f64; 2]) -> Self {
        let ends = gammas.map(|gamma| (2.0 * gamma - 3.0) as f32);
        let [last, first] = ends.map(|d| Self::coordinate(1.0 / d));
        Self { ends, nodes: Nodes::new([first, last], Self::STEP) }
    }

    fn coordinate(q: f32) -> f32 {
        octaves(1.0 + 10.0 * q)
    }

    /// q of a γ clamped to the ends, the smallest for NaN.
    #[inline(always)]
    pub(super) fn clamped(&self, gamma: f32) -> f32 {
        1.0 / clamp(2.0 * gamma - 3.0, self.ends)
    }

    #[inline(always)]
    pub(super) fn weights(&self, q: f32) -> (u32, [f32; THREE]) {
        self.nodes.weights(Self::coordinate(q))
    }

    /// q of the nodes.
    pub(super) fn quantities(&self) -> Vec<f32> {
        let [last, first] = self.ends.map(|d| 1.0 / d);
        let node = |t| inverse([first, last], t, Self::coordinate);
        self.nodes.coordinates().map(node).collect()
    }
}

/// Roughnesses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughnesses {
    /// The smallest and the largest, and whether 0, a mirror, is below them.
    pub(super) ends: [f32; 2],
    pub(super) mirror: bool,
    pub(super) nodes: Nodes,
    /// Nodes of averages, along the logarithm.
    pub(super) averages: Nodes,
}

impl Roughnesses {
    /// Between nodes.
    const STEP: f32 = 0.467;
    /// Octaves of σ between nodes of averages.
    const AVERAGES: f32 = 0.5;

    pub(super) fn new(ends: [f32; 2], mirror: bool) -> Self {
        let nodes = Nodes::new(ends.map(Self::coordinate), Self::STEP);
        let averages = Nodes::new(ends.map(octaves), Self::AVERAGES);
        Self { ends, mirror, nodes, averages }
    }

    /// Close to even ratios of σ near 0.02, wide ratios below, and finer above: that of the stored
    /// tables, [`LogRoughness`](microfacet_tables::axis::LogRoughness), in octaves.
    #[inline(always)]
    fn coordinate(sigma: f32) -> f32 {
        octaves(1.0 + sigma * 60.0) + 0.2 * octaves(sigma) + sigma
    }

    /// σ clamped to the ends, the smallest for NaN; 0 for a mirror.
    #[inline(always)]
    pub(super) fn clamped(&self, sigma: f32) -> f32 {
        if self.mirror && sigma <= 0.0 { 0.0 } else { clamp(sigma, self.ends) }
    }

    #[inline(always)]
    pub(super) fn weights(&self, sigma: f32) -> (u32, [f32; THREE]) {
        self.nodes.weights(Self::coordinate(sigma))
    }

    #[inline(always)]
    pub(super) fn average_weights(&self, sigma: f32) -> (u32, [f32; THREE]) {
        self.averages.weights(octaves(sigma))
    }

    /// σ of the nodes, and of those of averages.
    pub(super) fn quantities(&self) -> [Vec<f32>; 2] {
        let of = |nodes: Nodes, coordinate: fn(f32) -> f32| -> Vec<f32> {
            nodes.coordinates().map(|t| inverse(self.ends, t, coordinate)).collect()
        };
        [of(self.nodes, Self::coordinate), of(self.averages, octaves)]
    }
}

/// Views: t = share·x^¼ + (1−share)·h^¼ with x = μ/(μ + k sin θ) and h = μ/(1 + sin θ).
///
/// x follows the change at grazing, within the roughness of the horizon, and h that of the moments
/// over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// k = κσ.
    knee: f32,
}

impl View {
    pub(super) const CELLS: usize = 26;
    const SHARE: f32 = 0.55;

    /// Of q = 1/(2γ−3): κ = 6 + q follows the range of masking as that grows for γ → 3/2.
    #[inline(always)]
    pub(super) fn new(sigma: f32, q: f32) -> Self {
        // A mirror has no grazing views of its own; with 0, x would be 0/0 at the horizon.
        Self { knee: ((6.0 + q) * sigma).max(1e-20) }
    }

    /// The cell of cos θ ∈ [0, 1], and the weights of its four coefficients.
    #[inline(always)]
    pub(super) fn weights(self, cos: f32) -> (u32, [f32; 4]) {
        // Less than 26 by an ulp.
        const LAST: f32 = (View::CELLS as f32).next_down();
        cubic_weights(clamp(self.coordinate(cos) * Self::CELLS as f32, [0.0, LAST]))
    }

    #[inline(always)]
    fn coordinate(self, cos: f32) -> f32 {
        let sin = sqrt((1.0 - cos) * (1.0 + cos));
        let (near, far) = (cos + self.knee * sin, 1.0 + sin);
        // One division for both quotients.
        let quotient = cos / (near * far);
        let root = |x: f32| sqrt(sqrt(x));
        Self::SHARE * root(quotient * far) + (1.0 - Self::SHARE) * root(quotient * near)
    }

    /// h^¼ of the nodes, ascending from 0 to 1.
    pub(super) fn nodes(self) -> [f64; Self::CELLS + 1] {
        let (knee, share) = (f64::from(self.knee), f64::from(Self::SHARE));
        let coordinate = |root: f64| {
            let h = (root * root) * (root * root);
            let x = root * sqrt64(sqrt64(2.0 / (2.0 * h + knee * (1.0 - h * h))));
            share * x + (1.0 - share) * root
        };
        let (mut nodes, mut low, mut stays) = ([0.0; Self::CELLS + 1], [0.0, 0.0], false);
        for (i, node) in nodes.iter_mut().enumerate().skip(1) {
            let target = i as f64 / Self::CELLS as f64;
            let (mut high, mut x) = ([1.0, 1.0 - target], 1.0);
            low[1] -= target;
            // False position; where one end stays, half of its value serves for the next step.
            for _ in 0..60 {
                x = low[0] + low[1] / (low[1] - high[1]) * (high[0] - low[0]);
                let y = coordinate(x) - target;
                if y.abs() < 1e-9 {
                    break;
                }
                let end = if y < 0.0 { (&mut low, &mut high) } else { (&mut high, &mut low) };
                if stays == (y < 0.0) {
                    end.1[1] *= 0.5;
                }
                (*end.0, stays) = ([x, y], y < 0.0);
            }
            low = [x, target];
            *node = x;
        }
        nodes[Self::CELLS] = 1.0;
        nodes
    }

    /// cos θ and sin θ of h^¼.
    pub(super) fn direction(root: f64) -> [f64; 2] {
        let h = (root * root) * (root * root);
        [2.0 * h / (1.0 + h * h), (1.0 - h * h) / (1.0 + h * h)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_where_the_coordinates_say() {
        let shapes = Shapes::new([1.501, f64::INFINITY]);
        let quantities = shapes.quantities();
        assert_eq!((quantities[0], quantities.len()), (0.0, shapes.nodes.count));
        for (i, &q) in quantities.iter().enumerate() {
            let (start, weights) = shapes.weights(q);
            let x = start as f32 + weights[2] - weights[0];
            assert!((x - i as f32).abs() < 1e-4, "{i}: {x}");
        }
        let sigmas = Roughnesses::new([1e-8, 3.0], true);
        let [nodes, averages] = sigmas.quantities();
        assert_eq!([nodes[0], averages[0]], [1e-8; 2]);
        for (i, &sigma) in nodes.iter().enumerate() {
            let (start, weights) = sigmas.weights(sigma);
            let x = start as f32 + weights[2] - weights[0];
            assert!((x - i as f32).abs() < 1e-4, "{i}: {x}");
        }
        for (sigma, q) in [(1e-8, 500.0), (0.01, 0.0), (3.0, 1.0)] {
            let view = View::new(sigma, q);
            for (i, root) in view.nodes().into_iter().enumerate() {
                let [cos, sin] = View::direction(root);
                assert!((cos * cos + sin * sin - 1.0).abs() < 1e-14);
                let t = view.coordinate(cos as f32) * View::CELLS as f32;
                // Next to the normal t falls with sin θ, of which an ulp of cos θ leaves 3e-4.
                assert!((t - i as f32).abs() < if i < 25 { 2e-4 } else { 0.02 }, "{sigma} {i} {t}");
            }
        }
    }

    #[test]
    fn what_is_outside_is_clamped() {
        let shapes = Shapes::new([1.6, 10.0]);
        let q = [1.0, 1.5, 1.6, f32::NAN].map(|gamma| shapes.clamped(gamma));
        assert!(q.iter().all(|q| (q - 5.0).abs() < 1e-5), "{q:?}");
        assert_eq!([10.0, f32::INFINITY].map(|gamma| shapes.clamped(gamma)), [1.0 / 17.0; 2]);
        let sigmas = Roughnesses::new([0.1, 1.0], true);
        let clamped = [0.0, -1.0, 1e-9, f32::NAN, 9.0].map(|sigma| sigmas.clamped(sigma));
        assert_eq!(clamped, [0.0, 0.0, 0.1, 0.1, 1.0]);
        assert_eq!(Roughnesses::new([0.1, 1.0], false).clamped(0.0), 0.1);
        assert_eq!(Shapes::new([2.0, 2.0]).nodes.count, 1);
    }
}
