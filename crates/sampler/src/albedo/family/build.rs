//! Fills the volume from a table of moments, and integrates it over views.

use alloc::vec::Vec;

use microfacet_core::gauss_legendre;
use microfacet_core::math::sqrt64;
use microfacet_tables::{Mapping, Table};

use super::axes::{Axes, View};
use super::spline::{cubic, quadratic};
use super::{FamilyAlbedo, LEAST, SHAPES, VIEWS};
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
            axes: Axes::new(gammas, ends),
            mirror: range.min <= 0.0,
            values: Default::default(),
            averages: Vec::new(),
        };
        let gamma = |d: f32| match d {
            Axes::FLAT => gammas[1],
            d => (1.5 + 0.5 * f64::from(d)).clamp(gammas[0], gammas[1]),
        };
        let [shapes, sigmas, averages] = family.axes.nodes();

        let mut all = Vec::new();
        for &d in &shapes {
            let shape = ShapeAlbedo::of(table, gamma(d))?;
            all.push(sigmas.iter().flat_map(|&sigma| row(&shape, sigma, d)).collect());
        }
        let all = splines(all, 3 * VIEWS);
        family.values = core::array::from_fn(|i| {
            let channel = all.iter().skip(i).step_by(3).map(|&x| x as f32);
            // At the normal the last lookup reads, with a weight of 0, one coefficient beyond.
            channel.chain([0.0]).collect()
        });

        let nodes = |&d: &f32| averages.iter().flat_map(|&s| family.integrated(s, d)).collect();
        let all = splines(shapes.iter().map(nodes).collect(), 3);
        let nodes = all.chunks_exact(3).map(|node| [node[0], node[1], node[2], 0.0]);
        family.averages = nodes.map(|node| node.map(|x| x as f32)).collect();
        Some(family)
    }

    /// The averages over views of the lookups at σ and d = 2γ−3: log₂(1 − E_avg), and of the other
    /// channels.
    fn integrated(&self, sigma: f32, d: f32) -> [f64; 3] {
        const RULE: [(f64, f64); 2] = gauss_legendre();
        let place = self.place(sigma, d);
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

/// The coefficients by σ and γ of values of `width` numbers at each node: by γ, by σ.
fn splines(shapes: Vec<Vec<f64>>, width: usize) -> Vec<f64> {
    let all: Vec<f64> = shapes.into_iter().flat_map(|values| quadratic(values, width)).collect();
    let row = all.len() / (SHAPES - 2);
    let all = quadratic(all, row);
    let place = |i: usize, j: usize| j * row + i * width;
    let at = |(i, j)| all[place(i, j)..][..width].iter().copied();
    (0..row / width).flat_map(|i| (0..SHAPES).map(move |j| (i, j))).flat_map(at).collect()
}

/// The coefficients along the view at one roughness, three channels for each.
fn row(shape: &ShapeAlbedo<'_>, sigma: f32, d: f32) -> Vec<f64> {
    let at = shape.at(sigma);
    let mut nodes = View::new(sigma, d).nodes().map(|root| {
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
