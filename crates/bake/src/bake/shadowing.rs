//! Smith's G1, stored as the ratio G1/q to a rational function q with the same limits.
//!
//! With q of [`Rational::BAKED`] the ratio stays within [0.75, 1.6] over the whole domain, so G1
//! has a small *relative* error at grazing, where it is divided by cos θ.

use rayon::prelude::*;

use microfacet_core::shape::s_of_gamma;
use microfacet_model::{Shape, UnitView};
use microfacet_tables::Axis;
use microfacet_tables::axis::Rational;

use super::{round, shapes};
use crate::progress::Stage;
use crate::table_spec::{GAMMA_WHOLE, TableSpec};

/// The view axis: q, crowded towards normal incidence for a table that reaches γ < 1.8, where the
/// ratio approaches its limit there like (1−q)^(1+2k), too slowly for even nodes.
pub(super) fn view(spec: &TableSpec) -> Rational {
    let crowded = spec.shapes.nodes.iter().any(|&s| s > s_of_gamma(GAMMA_WHOLE));
    Rational { crowded, ..Rational::BAKED }
}

pub(super) fn bake(spec: &TableSpec, axes: &[Axis], stage: &Stage) -> Vec<f32> {
    let view = view(spec);
    let of_shape = |shape: &Shape| {
        let beyond = |z: f64| {
            let w = shape.asinh_slope(z);
            (shape.excess(w), shape.tail(w))
        };
        let row = round(ratios(&view, view.kappa(shape.s()), &axes[1].nodes, beyond));
        stage.step();
        row
    };
    stage.split(spec.shapes.nodes.len());
    shapes(spec).par_iter().flat_map_iter(of_shape).flatten_iter().collect()
}

/// The ratio G1/q = (z + κ)/(z + E[(X−z)⁺]) at the nodes of the views, the last of which is z = ∞,
/// and its derivative per node; `beyond` returns E[(X−z)⁺] and P(X > z).
pub(super) fn ratios(
    view: &Rational,
    kappa: f64,
    views: &[f64],
    beyond: impl Fn(f64) -> (f64, f64) + Sync,
) -> Vec<[f64; 2]> {
    let cells = (views.len() - 1) as f64;
    let node = |t: f64| {
        let z = view.quantity(t, kappa);
        let (excess, tail) = beyond(z);
        // Numerator and denominator are divided by √(1 + z²), since z may overflow.
        let UnitView { sin, cos } = UnitView::from_cotangent(z);
        let value = (cos + kappa * sin) / (cos + excess * sin);
        // The derivative of the area by z is 1 − P(X > z). With dz/dq = (z+κ)²/κ the quotient rule
        // gives this form, which is finite for z → ∞.
        let slope = (excess - kappa + (z + kappa) * tail) * value * value / kappa;
        [value, slope * view.rate(t) / cells]
    };
    let mut nodes: Vec<_> = views[..views.len() - 1].par_iter().map(|&t| node(t)).collect();
    // z = ∞, where G1 = 1. Near γ = 3/2 the excess falls like z^(−2k), so the derivative at z = ∞
    // says nothing about the cell; this slope makes the cubic meet the ratio in the cell's middle.
    let ([before, slope], [middle, _]) = (nodes[views.len() - 2], node(1.0 - 0.5 / cells));
    nodes.push([1.0, slope - 8.0 * (middle - 0.5 * (before + 1.0))]);
    nodes
}
