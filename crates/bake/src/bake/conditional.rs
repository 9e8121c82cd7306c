//! The inverse CDF of the slope across the plane of incidence, divided by √(1 + s x²) so that it
//! does not depend on the view.

use rayon::prelude::*;

use microfacet_model::{Shape, across_quantile};
use microfacet_tables::Axis;
use microfacet_tables::axis::hermite::limit_slopes;

use super::{distance, half_tangent_rate, mirrored, round, shapes};
use crate::progress::Stage;
use crate::table_spec::TableSpec;

pub(super) fn bake(spec: &TableSpec, axes: &[Axis], stage: &Stage) -> Vec<f32> {
    let numbers = &axes[1].nodes;
    let of_shape = |shape: &Shape| {
        let mut half = round(numbers.iter().map(|&t| node(shape, t, numbers.len() - 1)));
        limit_slopes(&mut half);
        stage.step();
        half
    };
    stage.split(spec.shapes.nodes.len());
    shapes(spec).par_iter().flat_map_iter(of_shape).flatten_iter().collect()
}

/// A node of the half u > ½: the distance of the half tangent from 1, and its derivative per node.
fn node(shape: &Shape, t: f64, cells: usize) -> [f64; 2] {
    let (u, du_dt) = mirrored(t);
    let x = across_quantile(shape, 1.0 - u);
    [
        distance(shape, x, 1.0),
        du_dt / shape.across_density(x.w) * half_tangent_rate(shape, x) / cells as f64,
    ]
}
