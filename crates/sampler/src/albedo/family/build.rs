//! Fills the volume from a table of moments, and integrates it over views.

use alloc::vec::Vec;

use microfacet_core::gauss_legendre;
use microfacet_core::math::sqrt64;
use microfacet_tables::{Mapping, Table};

use super::axes::{Axes, View};
use super::spline::{cubic, quadratic};
use super::{FamilyAlbedo, LEAST, VIEWS};
use crate::albedo::moments::{averaged, less_mirror};
use crate::albedo::shape::ShapeAlbedo;

impl FamilyAlbedo {
    /// `None` for a table that is not of moments over γ, σ and the view.
    pub(in crate::albedo) fn of(table: &Table) -> Option<Self> {
        let lobe = &table.subject.lobe;
        let gammas: [f64; 2] = lobe.gamma.into();
        let roughness = table.axes.get(1)?;
        let Mapping::LogRoughness(mapping) = roughness.mapping else { return None };
        let first = mapping.quantity(roughness.nodes[0]);
        let range = lobe.roughness.x();
        let ends = [range.min, range.max].map(|sigma| sigma.max(first) as f32);
        let mut family = Self {
            masking: table.subject.masking?,
            axes: Axes::new(gammas, ends, range.min <= 0.0),
            values: Vec::new(),
            channel: 0,
            shape: 0,
            averages: Vec::new(),
        };
        let gamma = |q: f32| (1.5 + 0.5 / f64::from(q)).clamp(gammas[0], gammas[1]);
        let [shapes, sigmas, averages] = family.axes.nodes();

        let mut all = Vec::new();
        for &q in &shapes {
            let shape = ShapeAlbedo::of(table, gamma(q))?;
            let rows = sigmas.iter().flat_map(|&sigma| row(&shape, sigma, q));
            all.extend(quadratic(rows.collect(), 3 * VIEWS));
        }
        let width = all.len() / shapes.len();
        let all = quadratic(all, width);
        let channel = |i: usize| all.iter().skip(i).step_by(3).map(|&x| x as f32);
        family.values = (0..3).flat_map(channel).collect();
        (family.channel, family.shape) = (all.len() / 3, width / 3);

        let mut all = Vec::new();
        for &q in &shapes {
            let nodes = averages.iter().flat_map(|&sigma| family.integrated(sigma, q));
            all.extend(quadratic(nodes.collect(), 3));
        }
        let width = all.len() / shapes.len();
        let all = quadratic(all, width);
        let nodes = all.chunks_exact(3).map(|node| [node[0], node[1], node[2], 0.0]);
        family.averages = nodes.map(|node| node.map(|x| x as f32)).collect();
        Some(family)
    }

    /// The averages over views of the lookups at σ and q: log₂(1 − E_avg) and the other channels.
    fn integrated(&self, sigma: f32, q: f32) -> [f64; 3] {
        const RULE: [(f64, f64); 2] = gauss_legendre();
        let place = self.place(sigma, q);
        let mut sum = [0.0; 3];
        for ends in place.view.nodes().windows(2) {
            let width = ends[1] - ends[0];
            for (x, weight) in RULE {
                let root = ends[0] + x * width;
                let [cos, sin] = View::direction(root);
                // 2μ dμ of h = root⁴: dμ/dh = 2 (1−h²)/(1+h²)².
                let cube = root * root * root;
                let share = 8.0 * cos * cube * sin * (1.0 + sin) * width * weight;
                let (less, _) = averaged(cos as f32, place.rest(cos as f32));
                for (sum, x) in sum.iter_mut().zip(less) {
                    *sum += share * x;
                }
            }
        }
        let [e, bias, f82] = less_mirror(sum);
        [libm::log2(f64::from(-e).max(libm::exp2(f64::from(LEAST) - 1.0))), bias.into(), f82.into()]
    }
}

/// The coefficients along the view at one roughness, three channels for each.
fn row(shape: &ShapeAlbedo<'_>, sigma: f32, q: f32) -> Vec<f64> {
    let at = shape.at(sigma);
    let mut nodes = View::new(sigma, q).nodes().map(|root| {
        let [e, bias, f82] = at.rest(View::direction(root)[0] as f32).map(f64::from);
        [sqrt64(-e), bias, f82]
    });
    // The cubic through the next four, not the limit at the horizon, which is reached with a power
    // that no spline follows: views of cos θ > 1e-4 gain by it.
    nodes[0] = core::array::from_fn(|i| {
        4.0 * (nodes[1][i] + nodes[3][i]) - 6.0 * nodes[2][i] - nodes[4][i]
    });
    let mut row = cubic(nodes.as_flattened(), 3);
    // Where next to nothing is lost, the waves beside a steeper part would be more than it.
    for (i, near) in nodes.windows(3).enumerate() {
        let [a, b, c] = [near[0][0], near[1][0], near[2][0]];
        let [least, most] = [a.min(b).min(c), a.max(b).max(c)];
        if most < 0.03 {
            row[3 * (i + 2)] = row[3 * (i + 2)].clamp(least, most);
        }
    }
    row
}
