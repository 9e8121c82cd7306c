//! The inverse CDF of the in-plane slope of visible normals, over view and u₁.
//!
//! A node holds the distance g of the half tangent h = x/(1 + √(1+x²)) of the unit slope from the
//! end of its half, g = 1 + h for u ≤ ½ and 1 − h above, and the exact derivative.
//! `cargo run --release -p microfacet-study -- table_design` prints the largest CDF error between
//! the nodes for several designs of 65 views by 2·17 random numbers, with cubic Hermite
//! interpolation along u and linear interpolation between views:
//!
//! | stored | view axis | u | γ = 1.8 | 2 | 4 | ∞ |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | h | cos θ | t⁴ | 2.7e-2 | 2.1e-2 | 1.4e-2 | 1.2e-2 |
//! | h | tan ½(π/2−θ) | t | 5.7e-3 | 5.3e-3 | 5.2e-3 | 1.1e-2 |
//! | h | tan ½(π/2−θ) | t² | 1.7e-4 | 9.6e-5 | 4.0e-4 | 4.1e-4 |
//! | **h** | **tan ½(π/2−θ)** | **t⁴** | 1.2e-4 | 2.3e-5 | 2.4e-5 | 3.4e-5 |
//! | u of GGX | cos θ | t⁴ | 7.1e-3 | 2.3e-6 | 1.1e-2 | 1.5e-2 |
//! | u of GGX | tan ½(π/2−θ) | t | 2.2e-3 | 7.9e-13 | 7.5e-3 | 1.1e-2 |
//! | u of GGX | tan ½(π/2−θ) | t² | 7.6e-5 | 4.6e-7 | 4.8e-4 | 4.5e-4 |
//! | u of GGX | tan ½(π/2−θ) | t⁴ | 5.1e-5 | 2.3e-6 | 2.4e-5 | 2.9e-5 |
//!
//! Storing the random number of a GGX sampler is as accurate, and exact at γ = 2, but costs a
//! rotation and two square roots more at run time. The half tangent has the silhouette x = −cot θ
//! at h = −τ, linear in the view coordinate τ, so that no interpolated slope faces away from the
//! view; stored as a distance from an end, it keeps its digits in both tails.

use rayon::prelude::*;

use microfacet_model::{Shape, UnitView, VisibleSlope};
use microfacet_tables::axis::HalfTangent;
use microfacet_tables::axis::hermite::limit_slopes;
use microfacet_tables::{Axis, Kind};

use super::{distance, half_tangent_rate, mirrored, round, shapes};
use crate::progress::Stage;
use crate::table_spec::TableSpec;

/// The view axis, with more nodes towards normal incidence: there the slopes depend on the tilt η
/// like η^(2γ−2), whose second derivative is infinite for γ < 2. The knots are the best of a coarse
/// grid, and at eighths, so that they are nodes. The largest CDF error of linear interpolation
/// between 89 exact views, as `table_design` prints it:
///
/// | nodes | γ = 1.8 | 1.9 | 4 | ∞ | peeled: 1.501 | 1.51 | 1.6 | 1.79 |
/// | --- | --- | --- | --- | --- | --- | --- | --- | --- |
/// | even | 7.1e-5 | 2.0e-5 | 1.3e-5 | 1.8e-5 | 6.0e-4 | 7.0e-4 | 2.9e-4 | 4.0e-5 |
/// | with knots | 2.2e-5 | 1.4e-5 | 1.7e-5 | 2.4e-5 | 4.9e-5 | 4.3e-5 | 2.7e-5 | 3.4e-5 |
pub(super) fn view(kind: Kind) -> HalfTangent {
    let peeled = [[0.8, 0.375], [0.985, 0.75]];
    let whole = [[0.72, 0.625], [0.94, 0.875]];
    HalfTangent { knots: Some(if kind == Kind::VisibleSlopePeeled { peeled } else { whole }) }
}

/// Distance of the first node from the silhouette: sixteen roundings of f32, so that m·v stays
/// positive in single precision. The density vanishes at the silhouette, and the share of normals
/// displaced is of the order of this distance squared.
const INSIDE: f64 = 1.0 / 1_048_576.0;

pub(super) fn bake(spec: &TableSpec, axes: &[Axis], stage: &Stage) -> Vec<f32> {
    let (view, peeled) = (view(spec.kind), spec.kind == Kind::VisibleSlopePeeled);
    let [_, views, numbers] = axes else { unreachable!("the axes of this kind") };
    let shapes = shapes(spec);
    let rows: Vec<(&Shape, f64)> =
        shapes.iter().flat_map(|shape| views.nodes.iter().map(move |&t| (shape, t))).collect();
    stage.split(rows.len());
    let of_row = |&(shape, t): &(&Shape, f64)| {
        let row = row_nodes(shape, [view.parts(t)[1], view.quantity(t)], &numbers.nodes, peeled);
        stage.step();
        row
    };
    rows.par_iter().flat_map_iter(of_row).flatten_iter().collect()
}

/// Both halves of a row: the nodes for u ≤ ½ from u = 0 up, then those for u > ½ from u = 1 down.
fn row_nodes(shape: &Shape, [rest, z]: [f64; 2], numbers: &[f64], peeled: bool) -> Vec<[f32; 2]> {
    let view = UnitView::from_cotangent(z);
    let slopes =
        if peeled { VisibleSlope::peeled(shape, view) } else { VisibleSlope::new(shape, view) };
    let mut row = Vec::with_capacity(2 * numbers.len());
    for end in [-1.0, 1.0] {
        let mut half =
            round(numbers.iter().map(|&t| node(shape, &slopes, end, t, numbers.len() - 1)));
        if end < 0.0 && z.is_finite() {
            // The silhouette in closed form. It is linear in τ, so that interpolation between rows
            // meets it too, and no sampled normal faces away from the view.
            half[0][0] = (rest + INSIDE) as f32;
        }
        limit_slopes(&mut half);
        row.extend(half);
    }
    row
}

/// Distance of the half tangent from the end at t, and its derivative per node.
fn node(shape: &Shape, slopes: &VisibleSlope, end: f64, t: f64, cells: usize) -> [f64; 2] {
    let (u, du_dt) = mirrored(t);
    let x = slopes.quantile(if end < 0.0 { u } else { 1.0 - u });
    let slope = du_dt / slopes.density(x) * half_tangent_rate(shape, x) / cells as f64;
    [distance(shape, x, end), if slope.is_finite() { slope } else { 0.0 }]
}
