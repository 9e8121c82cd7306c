//! The coordinates of the volume: of the shape, of the roughness and of the view. Here alone stand
//! their formulas and the distances of nodes.
//!
//! The constants were found by searching for the least error of E with a volume of half a MiB;
//! `tests/family_albedo.rs` prints the errors.

use alloc::vec::Vec;

use microfacet_core::math::{sqrt, sqrt64, within};
use wide::f32x4;

use super::octaves::{inverse, octaves};
use super::spline::{THREE, cubic_weights, quadratic_weights};

/// The axes that a material has a place on, as lanes: of shapes, of roughnesses, and of the
/// roughnesses of averages.
pub(super) const SHAPE: usize = 0;
pub(super) const SIGMA: usize = 1;
pub(super) const AVERAGE: usize = 2;

/// The axes of the material, each with evenly spaced nodes along an ascending coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// 2γ−3 of the smallest γ and of the largest.
    shapes: [f32; 2],
    /// The smallest σ and the largest, and whether 0, a mirror, is below them.
    sigmas: [f32; 2],
    mirror: bool,
    /// The coordinates of the first nodes, nodes for each unit, and the last nodes.
    first: f32x4,
    density: f32x4,
    last: f32x4,
    /// Numbers of nodes.
    pub(super) counts: [usize; 4],
}

/// The first of three coefficients along each axis, and their weights.
pub(super) type Place = ([usize; 4], [f32x4; THREE]);

impl Axes {
    /// About the distances of nodes.
    const STEPS: [f32; 3] = [0.352, 0.485, 0.65];

    pub(super) fn new(gammas: [f64; 2], sigmas: [f32; 2], mirror: bool) -> Self {
        let shapes = gammas.map(|gamma| (2.0 * gamma - 3.0) as f32);
        let ends = [(sigmas[0], shapes[1]), (sigmas[1], shapes[0])];
        let [first, end] = ends.map(|(sigma, d)| Self::coordinates(sigma, 1.0 / d));
        let widths = (end - first).to_array();
        let mut cells = [0.0; 4];
        for (lane, step) in Self::STEPS.into_iter().enumerate() {
            // One node where the ends are the same.
            if widths[lane] > 1e-5 {
                cells[lane] = libm::ceilf(widths[lane] / step).max(2.0);
            }
        }
        let density: [f32; 4] = core::array::from_fn(|lane| match cells[lane] {
            0.0 => 0.0,
            cells => cells / widths[lane],
        });
        Self {
            shapes,
            sigmas,
            mirror,
            first,
            density: density.into(),
            last: cells.into(),
            counts: cells.map(|cells| cells as usize + 1),
        }
    }

    /// Of the shape, octaves of 1 + 10 q, q = 1/(2γ−3). Of the roughness, what has close to even
    /// ratios near 0.02, wide ratios below, and finer ones above, as the coordinate of stored
    /// tables, [`LogRoughness`](microfacet_tables::axis::LogRoughness). For averages, octaves and
    /// finer above 1.
    #[inline(always)]
    fn coordinates(sigma: f32, q: f32) -> f32x4 {
        let logs = octaves(f32x4::from([1.0 + 10.0 * q, 1.0 + 60.0 * sigma, sigma, 1.0]));
        let [shape, near, far, _] = logs.to_array();
        f32x4::from([shape, near + 0.2 * far + sigma, far + 2.0 * sigma, 0.0])
    }

    /// σ and q = 1/(2γ−3), clamped to what is covered; NaN counts as the smallest. A mirror has
    /// σ = 0.
    #[inline(always)]
    pub(super) fn clamped(&self, sigma: f32, gamma: f32) -> (f32, f32) {
        let is_mirror = self.mirror && sigma <= 0.0;
        let sigma = if is_mirror { 0.0 } else { within(sigma, self.sigmas) };
        (sigma, 1.0 / within(2.0 * gamma - 3.0, self.shapes))
    }

    /// The place of a clamped σ and q.
    #[inline(always)]
    pub(super) fn place(&self, sigma: f32, q: f32) -> Place {
        let x = (Self::coordinates(sigma, q) - self.first) * self.density;
        quadratic_weights(x.fast_max(f32x4::ZERO).fast_min(self.last))
    }

    /// q of the nodes of shapes; σ of the nodes of roughnesses, and of those of averages.
    pub(super) fn nodes(&self) -> [Vec<f32>; 3] {
        let nodes = |lane: usize, ends: [f32; 2], coordinate: &dyn Fn(f32) -> f32x4| {
            let [first, density] = [self.first, self.density].map(|lanes| lanes.to_array()[lane]);
            let of = |x: f32| coordinate(x).to_array()[lane];
            let count = self.counts[lane];
            let target = |i: usize| first + if count > 1 { i as f32 / density } else { 0.0 };
            (0..count).map(|i| inverse(ends, target(i), of)).collect::<Vec<_>>()
        };
        let [last, first] = self.shapes.map(|d| 1.0 / d);
        let of_sigma = |sigma| Self::coordinates(sigma, 1.0);
        [
            nodes(SHAPE, [first, last], &|q| Self::coordinates(1.0, q)),
            nodes(SIGMA, self.sigmas, &of_sigma),
            nodes(AVERAGE, self.sigmas, &of_sigma),
        ]
    }
}

/// Views: t = share·x^¼ + (1−share)·h^¼ with x = μ/(μ + k sin θ) and h = μ/(1 + sin θ).
///
/// x follows the change at grazing, within the roughness of the horizon, and h that of the moments
/// over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// κσ.
    knee: f32,
}

impl View {
    pub(super) const CELLS: usize = 26;
    const SHARE: f32 = 0.55;

    /// Of q = 1/(2γ−3): κ = 6 + q follows the range of masking as that grows for γ → 3/2.
    #[inline(always)]
    pub(super) fn new(sigma: f32, q: f32) -> Self {
        // Not 0 for a mirror, for which x would be 0/0 at the horizon.
        Self { knee: (6.0 + q) * sigma + 1e-20 }
    }

    /// About the cosine, over sin θ, at which half of the light is lost: σ where tails are short.
    pub(super) fn reach(self) -> f32 {
        self.knee / 6.0
    }

    /// The cell of cos θ ∈ [0, 1], which is also the first of four coefficients, and their weights.
    #[inline(always)]
    pub(super) fn weights(self, cos: f32) -> (usize, f32x4) {
        // Less than the number of cells by an ulp.
        const LAST: f32 = (View::CELLS as f32).next_down();
        let x = self.coordinate(cos);
        cubic_weights(if x < LAST { x } else { LAST })
    }

    /// In cells.
    #[inline(always)]
    fn coordinate(self, cos: f32) -> f32 {
        const SHARES: [f32; 2] =
            [View::SHARE * View::CELLS as f32, (1.0 - View::SHARE) * View::CELLS as f32];
        let sin = sqrt((1.0 - cos) * (1.0 + cos));
        // Of lanes that were written one by one, the load of all would wait for the writes.
        let [x, h] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]].map(f32x4::from);
        let sum = f32x4::from([cos, 1.0, 1.0, 1.0]) + (x * self.knee + h) * sin;
        let [x, h, ..] = (f32x4::splat(cos) / sum).sqrt().sqrt().to_array();
        SHARES[0] * x + SHARES[1] * h
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
                if y.abs() < 1e-6 {
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
        let axes = Axes::new([1.501, f64::INFINITY], [1e-8, 3.0], true);
        let nodes = axes.nodes();
        assert_eq!([nodes[SHAPE][0], nodes[SIGMA][0], nodes[AVERAGE][0]], [0.0, 1e-8, 1e-8]);
        for (lane, nodes) in nodes.iter().enumerate() {
            assert_eq!(nodes.len(), axes.counts[lane]);
            for (i, &x) in nodes.iter().enumerate() {
                let (start, weights) =
                    if lane == SHAPE { axes.place(0.1, x) } else { axes.place(x, 1.0) };
                let [below, _, above] = weights.map(|weight| weight.to_array()[lane]);
                let x = start[lane] as f32 + above - below;
                assert!((x - i as f32).abs() < 1e-4, "{lane} {i}: {x}");
            }
        }
        for (sigma, q) in [(1e-8, 500.0), (0.01, 0.0), (3.0, 1.0)] {
            let view = View::new(sigma, q);
            for (i, root) in view.nodes().into_iter().enumerate() {
                let [cos, sin] = View::direction(root);
                assert!((cos * cos + sin * sin - 1.0).abs() < 1e-14);
                let x = view.coordinate(cos as f32);
                // Next to the normal it falls with sin θ, of which an ulp of cos θ leaves 3e-4.
                assert!((x - i as f32).abs() < if i < 25 { 2e-4 } else { 0.02 }, "{sigma} {i} {x}");
            }
        }
    }

    #[test]
    fn what_is_outside_is_clamped() {
        let axes = Axes::new([1.6, 10.0], [0.1, 1.0], true);
        let q = [1.0, 1.5, 1.6, f32::NAN].map(|gamma| axes.clamped(0.2, gamma).1);
        assert!(q.iter().all(|q| (q - 5.0).abs() < 1e-5), "{q:?}");
        assert_eq!([10.0, f32::INFINITY].map(|gamma| axes.clamped(0.2, gamma).1), [1.0 / 17.0; 2]);
        let clamped = [0.0, -1.0, 1e-9, f32::NAN, 9.0].map(|sigma| axes.clamped(sigma, 2.0).0);
        assert_eq!(clamped, [0.0, 0.0, 0.1, 0.1, 1.0]);
        assert_eq!(Axes::new([2.0, 2.0], [0.1, 1.0], false).clamped(0.0, 2.0), (0.1, 1.0));
        assert_eq!(Axes::new([2.0, 2.0], [0.1, 0.1], false).counts, [1; 4]);
    }
}
