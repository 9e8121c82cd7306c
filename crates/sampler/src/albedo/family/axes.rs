//! The coordinates of the volume: of the shape, of the roughness and of the view. Here alone stand
//! their formulas and the distances of nodes.
//!
//! The constants were found by searching for the least error of E with a volume of half a MiB;
//! `tests/family_albedo.rs` prints the errors.

use alloc::vec::Vec;

use microfacet_core::math::{sqrt, sqrt64, within};
use microfacet_lanes::{Lanes, f32x4};

use super::octaves::{inverse, octaves};
use super::spline::{FOUR, THREE, cubic_weights, cubic_weights_in_lanes, quadratic_weights};

/// The axes that a material has a place on, as lanes: of shapes and of roughnesses.
pub(super) const SHAPE: usize = 0;
pub(super) const SIGMA: usize = 1;

/// The axes of the material, each with evenly spaced nodes along an ascending coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// 2γ−3 of the smallest γ and of the largest.
    pub(super) shapes: [f32; 2],
    /// The smallest σ and the largest.
    pub(super) sigmas: [f32; 2],
    /// The coordinates of the first nodes, and nodes for each unit.
    pub(super) first: f32x4,
    pub(super) density: f32x4,
    /// Cells between nodes of roughnesses: 0 where all have one σ.
    cells: usize,
    /// The coordinate of the first roughness of averages, nodes for each unit, and cells.
    pub(super) averages: (f32, f32, usize),
}

/// The first of three coefficients along each axis, and their weights, as lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) first: [usize; 2],
    pub(super) weights: [f32x4; THREE],
}

impl Axes {
    /// Cells between nodes of shapes, in every set: rows of a known length cost less to address.
    pub(super) const SHAPES: usize = 34;
    /// 2γ−3 of Beckmann: as good as infinite, and not so large that products overflow.
    pub(super) const FLAT: f32 = 1e30;
    /// About the distance of nodes of roughnesses: 34 cells in the default set.
    const STEP: f32 = 0.485;
    /// And of those of averages.
    const AVERAGE_STEP: f32 = 0.65;

    pub(super) fn new(gammas: [f64; 2], sigmas: [f32; 2]) -> Self {
        let shapes = gammas.map(|gamma| within((2.0 * gamma - 3.0) as f32, [0.0, Self::FLAT]));
        let [first, end] = [0, 1].map(|end| Self::coordinates(sigmas[end], shapes[end]));
        let widths = (end - first).to_array();
        // All nodes at one place where the ends are the same.
        let density =
            |width: f32, cells: usize| if width > 1e-6 { cells as f32 / width } else { 0.0 };
        let cells = |width: f32, step: f32| match width > 1e-6 {
            true => libm::ceilf(width / step).max(2.0) as usize,
            false => 0,
        };
        let [start, end] = sigmas.map(Self::of_average);
        let width = end - start;
        let averages = cells(width, Self::AVERAGE_STEP);
        let cells = cells(widths[SIGMA], Self::STEP);
        let densities =
            [density(widths[SHAPE], Self::SHAPES), density(widths[SIGMA], cells), 0.0, 0.0];
        Self {
            shapes,
            sigmas,
            first,
            density: densities.into(),
            cells,
            averages: (start, density(width, averages), averages),
        }
    }

    /// Of the shape, (d/(d+3))^¼ with d = 2γ−3: close to even ratios of d for small d, and to even
    /// steps of 1/d next to Beckmann. Of the roughness, what has close to even ratios near 0.02,
    /// wide ratios below, and finer ones above, as the coordinate of stored tables,
    /// [`LogRoughness`](microfacet_tables::axis::LogRoughness): between their nodes the smallest
    /// losses have waves, which other nodes would take for the losses themselves.
    #[inline(always)]
    fn coordinates(sigma: f32, d: f32) -> f32x4 {
        let shape = sqrt(sqrt(d / (d + 3.0)));
        let [near, far, ..] =
            octaves(f32x4::from([1.0 + 60.0 * sigma, sigma, 1.0, 1.0])).to_array();
        f32x4::from([shape, near + 0.2 * far + sigma, 0.0, 0.0])
    }

    /// Of the roughness of averages, octaves and finer above 1.
    fn of_average(sigma: f32) -> f32 {
        octaves(f32x4::splat(sigma)).to_array()[0] + 2.0 * sigma
    }

    /// σ and d = 2γ−3, clamped to what is covered; NaN counts as the smallest.
    #[inline(always)]
    pub(super) fn clamped(&self, sigma: f32, gamma: f32) -> (f32, f32) {
        (within(sigma, self.sigmas), within(2.0 * gamma - 3.0, self.shapes))
    }

    /// The place of a clamped σ and d.
    #[inline(always)]
    pub(super) fn place(&self, sigma: f32, d: f32) -> Place {
        // Beyond the first and the last node by rounding at most: the nearest node is that one.
        quadratic_weights((Self::coordinates(sigma, d) - self.first) * self.density)
    }

    /// The first of three roughnesses of averages at a clamped σ, and their weights.
    #[inline]
    pub(super) fn average(&self, sigma: f32) -> (usize, [f32; THREE]) {
        let (first, density, _) = self.averages;
        let x = (Self::of_average(sigma) - first) * density;
        let place = quadratic_weights(f32x4::splat(x));
        (place.first[SIGMA], place.weights.map(|weight| weight.to_array()[SIGMA]))
    }

    /// d of the nodes of shapes; σ of the nodes of roughnesses, and of those of averages.
    pub(super) fn nodes(&self) -> [Vec<f32>; 3] {
        let nodes =
            |ends: [f32; 2], first: f32, density: f32, cells: usize, of: &dyn Fn(f32) -> f32| {
                let target =
                    |i: usize| first + if density > 0.0 { i as f32 / density } else { 0.0 };
                (0..=cells).map(|i| inverse(ends, target(i), of)).collect::<Vec<_>>()
            };
        let [first, density] = [self.first, self.density].map(f32x4::to_array);
        let shape = |d| Self::coordinates(1.0, d).to_array()[SHAPE];
        let sigma = |sigma| Self::coordinates(sigma, 1.0).to_array()[SIGMA];
        let (start, steps, averages) = self.averages;
        [
            nodes(self.shapes, first[SHAPE], density[SHAPE], Self::SHAPES, &shape),
            nodes(self.sigmas, first[SIGMA], density[SIGMA], self.cells, &sigma),
            nodes(self.sigmas, start, steps, averages, &Self::of_average),
        ]
    }
}

/// Views: t = share·x^¼ + (1−share)·h^¼ with x = μ/(μ + κσ sin θ) and h = μ/(1 + sin θ).
///
/// x follows the change at grazing, within the roughness of the horizon, and h that of the moments
/// over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// d = 2γ−3.
    shape: f32,
    /// dκσ.
    knee: f32,
}

impl View {
    pub(super) const CELLS: usize = 26;
    const SHARE: f32 = 0.55;
    /// Of either root, in cells.
    pub(super) const SHARES: [f32; 2] =
        [Self::SHARE * Self::CELLS as f32, (1.0 - Self::SHARE) * Self::CELLS as f32];

    /// κ = 6 + 1/d follows the range of masking as that grows for γ → 3/2.
    #[inline(always)]
    pub(super) fn new(sigma: f32, d: f32) -> Self {
        Self { shape: d, knee: 6.0 * sigma * d + sigma }
    }

    /// About the cosine, over sin θ, at which half of the light is lost: σ where tails are short.
    pub(super) fn reach(self) -> f32 {
        self.knee / (6.0 * self.shape)
    }

    /// The first of four coefficients at cos θ ∈ [0, 1], and their weights. At the normal the first
    /// may be `CELLS`, and the last weight is next to 0.
    #[inline(always)]
    pub(super) fn weights(self, cos: f32) -> (usize, f32x4) {
        cubic_weights(self.coordinate(cos))
    }

    /// [`weights`](Self::weights) in lanes, by coefficient.
    #[inline(always)]
    pub(super) fn weights_in_lanes<L: Lanes>(self, cos: L) -> (L::Ints, [L; FOUR]) {
        let sin = (L::splat(1.0) - cos * cos).sqrt();
        // As `coordinate`.
        let part = cos * self.shape;
        let x = (part / (part + sin * self.knee)).sqrt().sqrt();
        let h = (cos / (sin + 1.0)).sqrt().sqrt();
        cubic_weights_in_lanes(x * Self::SHARES[0] + h * Self::SHARES[1])
    }

    /// In cells.
    #[inline(always)]
    fn coordinate(self, cos: f32) -> f32 {
        let sin = sqrt(1.0 - cos * cos);
        // Both fractions of x are times d, so that no division waits for another.
        let [part, rest, one] =
            [self.shape, self.knee, self.shape * cos].map(|x| f32x4::from([x, 1.0, 1.0, 1.0]));
        let [x, h, ..] = ((part * cos) / (one + rest * sin)).sqrt().sqrt().to_array();
        Self::SHARES[0] * x + Self::SHARES[1] * h
    }

    /// h^¼ of the nodes, ascending from 0 to 1.
    pub(super) fn nodes(self) -> [f64; Self::CELLS + 1] {
        let (knee, share) = (f64::from(self.knee) / f64::from(self.shape), f64::from(Self::SHARE));
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
        let axes = Axes::new([1.501, f64::INFINITY], [1e-8, 3.0]);
        let [shapes, sigmas, averages] = axes.nodes();
        for (i, &sigma) in averages.iter().enumerate() {
            let (first, [below, _, above]) = axes.average(sigma);
            assert!((first as f32 + above - below - i as f32).abs() < 1e-4, "{i}");
        }
        let nodes = [shapes, sigmas];
        assert_eq!([nodes[SHAPE][Axes::SHAPES], nodes[SIGMA][0]], [Axes::FLAT, 1e-8]);
        assert_eq!(nodes.each_ref().map(Vec::len), [Axes::SHAPES + 1, 35]);
        for (lane, nodes) in nodes.iter().enumerate() {
            for (i, &x) in nodes.iter().enumerate() {
                let Place { first, weights } =
                    if lane == SHAPE { axes.place(0.1, x) } else { axes.place(x, 1.0) };
                let [below, _, above] = weights.map(|weight| weight.to_array()[lane]);
                let x = first[lane] as f32 + above - below;
                assert!((x - i as f32).abs() < 1e-4, "{lane} {i}: {x}");
            }
        }
        for (sigma, d) in [(1e-8, 0.002), (0.01, Axes::FLAT), (3.0, 1.0)] {
            let view = View::new(sigma, d);
            for (i, root) in view.nodes().into_iter().enumerate() {
                let [cos, sin] = View::direction(root);
                assert!((cos * cos + sin * sin - 1.0).abs() < 1e-14);
                let x = view.coordinate(cos as f32);
                // Next to the normal it falls with sin θ, of which an ulp of cos θ leaves 3e-4.
                assert!(
                    (x - i as f32).abs() < if i < 25 { 2e-4 } else { 0.02 },
                    "{sigma} {d} {i} {x}"
                );
            }
        }
    }

    #[test]
    fn what_is_outside_is_clamped() {
        let axes = Axes::new([1.6, 10.0], [0.1, 1.0]);
        let d = [1.0, 1.5, 1.6, f32::NAN].map(|gamma| axes.clamped(0.2, gamma).1);
        assert!(d.iter().all(|d| (d - 0.2).abs() < 1e-6), "{d:?}");
        assert_eq!([10.0, f32::INFINITY].map(|gamma| axes.clamped(0.2, gamma).1), [17.0; 2]);
        let clamped = [0.0, -1.0, 1e-9, f32::NAN, 9.0].map(|sigma| axes.clamped(sigma, 2.0).0);
        assert_eq!(clamped, [0.1, 0.1, 0.1, 0.1, 1.0]);
        for (sigma, d) in [(0.1, d[0]), (1.0, 17.0), (1.0, d[0])] {
            let [shape, roughness] = axes.place(sigma, d).first;
            assert_eq!(shape, if d == 17.0 { Axes::SHAPES } else { 0 });
            assert_eq!(roughness, if sigma == 1.0 { axes.cells } else { 0 });
        }
        let one = Axes::new([2.0, 2.0], [0.1, 0.1]);
        assert_eq!((one.clamped(0.0, 2.0), one.place(0.1, 1.0).first), ((0.1, 1.0), [0; 2]));
        assert_eq!(one.nodes().map(|nodes| nodes.len()), [Axes::SHAPES + 1, 1, 1]);
    }
}
