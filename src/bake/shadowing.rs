//! Smith's G1, as the ratio G1/q to a rational function q that has its limits.
//!
//! With z = cot θ/σ and q = z/(z + κ), κ = ½/(2 − s), the ratio stays within [0.75, 1.6] over the whole domain: q takes the zero at
//! grazing, the limit at normal incidence, and (through its pole) the divergence of the projected area at γ → 3/2. G1 then has a
//! small *relative* error at grazing, where it is divided by cos θ.

use rayon::prelude::*;

use microfacet_model::{Shape, UnitView};
use microfacet_sampler::Mapping;

use super::{round, shapes};
use crate::spec::{GAMMA_WHOLE, TableSpec};

/// κ = SCALE/(POLE − s) follows the mean positive slope c√s/(2−s), the projected area at grazing, within 10%.
const SCALE: f64 = 0.5;
const POLE: f64 = 2.0;

/// The view axis: q, or 1 − √(1−q) for a table that reaches below γ = 1.8, where the ratio approaches its limit at normal incidence
/// like (1−q)^(1+2k), too slowly for even nodes.
pub(super) fn view(spec: &TableSpec) -> Mapping {
    if is_crowded(spec) {
        Mapping::RationalRoot { scale: SCALE, pole: POLE }
    } else {
        Mapping::Rational { scale: SCALE, pole: POLE }
    }
}

fn is_crowded(spec: &TableSpec) -> bool {
    spec.shapes.nodes.iter().any(|&s| s > 1.0 / (GAMMA_WHOLE - 1.0))
}

pub(super) fn bake(spec: &TableSpec) -> Vec<f32> {
    let cells = spec.views - 1;
    let crowded = is_crowded(spec);
    let of_shape = |shape: &Shape| {
        let kappa = SCALE / (POLE - shape.s());
        round((0..=cells).map(|i| {
            if i == cells {
                return last_node(shape, kappa, cells as f64, crowded);
            }
            node(shape, kappa, i as f64 / cells as f64, cells as f64, crowded)
        }))
    };
    shapes(spec).par_iter().flat_map_iter(of_shape).flatten_iter().collect()
}

/// G1/q = (z + κ)/(z + E[(X−z)⁺]) at a coordinate below 1, and its derivative per node.
fn node(shape: &Shape, kappa: f64, at: f64, cells: f64, crowded: bool) -> [f64; 2] {
    // 1 − q and its derivative by the coordinate.
    let (rest, rate) = if crowded { ((1.0 - at) * (1.0 - at), 2.0 * (1.0 - at)) } else { (1.0 - at, 1.0) };
    let z = kappa * (1.0 - rest) / rest;
    let w = shape.unit(z);
    let excess = shape.excess(w);
    let view = UnitView::from_cotangent(z);
    let value = (view.cos + kappa * view.sin) / (view.cos + excess * view.sin);
    // d/dz of the area is 1 − Q(z); times dz/dq = (z+κ)²/κ the quotient rule collapses to this, finite for z → ∞.
    let slope = (excess - kappa + (z + kappa) * shape.tail(w)) * value * value / kappa;
    [value, slope * rate / cells]
}

/// z = ∞, where G1 = 1. Near γ = 3/2 the excess fades like z^(−2k), so the derivative there says nothing about the cell; the slope is
/// the one that makes the cubic exact in the cell's middle instead.
fn last_node(shape: &Shape, kappa: f64, cells: f64, crowded: bool) -> [f64; 2] {
    let [before, slope] = node(shape, kappa, 1.0 - 1.0 / cells, cells, crowded);
    let [middle, _] = node(shape, kappa, 1.0 - 0.5 / cells, cells, crowded);
    [1.0, slope - 8.0 * (middle - 0.5 * (before + 1.0))]
}
