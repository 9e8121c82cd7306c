//! Averages over views of what is looked up: piecewise polynomials of the view's coordinate, with
//! kinks at nodes and where an albedo is clamped, integrated piece by piece.

use microfacet_core::math::sqrt64;

use super::elevation::Elevation;

/// The largest ratio of h from one end of a panel to the other.
const RATIO: f64 = 1.5;
/// The inner points of the Gauss–Lobatto rule of four points on [0, 1], ½ ∓ 1/√20. It is exact for
/// polynomials of degree five, and neighbouring panels share its ends.
const INNER: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];
/// Halvings of the interval in which a clamp sets in.
const HALVINGS: usize = 7;
/// How often a panel is split where a clamp sets in, recursively; bounded, because a lookup that is
/// 0 to rounding may be clamped at any point.
const SPLITS: u32 = 3;
/// How near to a node panels end, in cells, and the steps of that search.
const NEAR: f64 = 1e-5;
const STEPS: usize = 6;
/// Views of smaller cosine weigh less than rounding.
const LOWEST: f64 = 1e-12;

/// Quantities at a view, and bits that say which of them are clamped.
pub(super) type At<const N: usize> = ([f64; N], u32);

/// 2 ∫ μ dμ of functions of cos θ that are looked up at `nodes` nodes.
pub(super) fn over_views<const N: usize>(
    view: &Elevation,
    nodes: usize,
    quantities: &impl Fn(f32) -> At<N>,
) -> [f64; N] {
    // With h = tan(½ elevation), μ = 2h/(1+h²), which is even in the angle near normal incidence.
    let at = |h: f64| {
        let square = 1.0 + h * h;
        let cos = 2.0 * h / square;
        let (values, clamped) = quantities(cos as f32);
        // 2μ dμ/dh.
        let weight = 4.0 * cos * (1.0 - h * h) / (square * square);
        Point { h, values, weight, clamped }
    };
    // Seen from its dense side, a dielectric of index 1 has no critical angle, and its first view
    // is the horizon.
    let floor = view.floor().max(LOWEST);
    let mut sum = [0.0; N];
    add(&mut sum, floor * floor, &quantities((2.0 / 3.0 * floor) as f32).0);
    let mut from = at(half_tangent(floor));
    each_node(view, floor, nodes, |h| {
        while from.h < h {
            let rest = h / from.h;
            // The last two panels of a cell are alike.
            let to = at(if rest > RATIO { from.h * RATIO.min(sqrt64(rest)) } else { h });
            add_panel(&mut sum, [&from, &to], &at, SPLITS);
            from = to;
        }
    });
    sum
}

pub(super) fn add<const N: usize>(sum: &mut [f64; N], factor: f64, values: &[f64; N]) {
    for (sum, x) in sum.iter_mut().zip(values) {
        *sum += factor * x;
    }
}

fn half_tangent(cos: f64) -> f64 {
    cos / (1.0 + sqrt64((1.0 - cos) * (1.0 + cos)))
}

/// Quantities at h, with their weight in ∫ dh.
struct Point<const N: usize> {
    h: f64,
    values: [f64; N],
    weight: f64,
    clamped: u32,
}

/// Adds ∫ dh from one point to another, between which clamps may set in.
fn add_panel<const N: usize>(
    sum: &mut [f64; N],
    [from, to]: [&Point<N>; 2],
    at: &impl Fn(f64) -> Point<N>,
    splits: u32,
) {
    let width = to.h - from.h;
    let [a, b] = INNER.map(|x| at(from.h + x * width));
    let points = [from, &a, &b, to];
    // The weight of normal incidence is 0.
    let kinked = |pair: &&[&Point<N>]| pair[0].clamped != pair[1].clamped && pair[1].weight > 0.0;
    let Some(&[low, high]) = points.windows(2).find(kinked).filter(|_| splits > 0) else {
        for (point, weight) in points.into_iter().zip([1.0, 5.0, 5.0, 1.0]) {
            add(sum, width / 12.0 * weight * point.weight, &point.values);
        }
        return;
    };
    let (mut before, mut after) = (low.h, high.h);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if at(middle).clamped == low.clamped { before = middle } else { after = middle }
    }
    let [before, after] = [before, after].map(at);
    add_panel(sum, [from, &before], at, splits - 1);
    for point in [&before, &after] {
        add(sum, 0.5 * (after.h - before.h) * point.weight, &point.values);
    }
    add_panel(sum, [&after, to], at, splits - 1);
}

/// Calls `then` with h of each node but the first, ascending.
fn each_node(view: &Elevation, floor: f64, nodes: usize, mut then: impl FnMut(f64)) {
    let cells = nodes - 1;
    let root = |cos: f64| sqrt64(sqrt64(half_tangent(cos)));
    let mut part = |from: [f64; 2], to: [f64; 2]| {
        let [first, last] = [from, to].map(|[_, t]| libm::round(t * cells as f64) as usize);
        let (mut low, mut step) = (from, (to[0] - from[0]) / (last - first) as f64);
        for node in first + 1..last {
            let next = view_at(view, node as f64 / cells as f64, cells, [low, to], step);
            step = next[0] - low[0];
            low = next;
            then(next[0] * next[0] * (next[0] * next[0]));
        }
        then(to[0] * to[0] * (to[0] * to[0]));
    };
    let mut from = [root(floor), 0.0];
    let [_, kinks @ .., _] = view.ends() else { return part(from, [1.0, 1.0]) };
    let parts = (kinks.len() + 1) as f64;
    let ends = kinks.iter().enumerate().map(|(i, &cos)| [root(cos), (i + 1) as f64 / parts]);
    for to in ends.chain([[1.0, 1.0]]) {
        // A part without width is a single point.
        if to[0] > from[0] {
            part(from, to);
        }
        from = to;
    }
}

/// Finds a node on the fourth root of h, in which nodes are nearly even: the root and the view's
/// coordinate there. The node lies between two such pairs, at about `step` from the first.
fn view_at(
    view: &Elevation,
    target: f64,
    cells: usize,
    [mut low, mut high]: [[f64; 2]; 2],
    step: f64,
) -> [f64; 2] {
    let mut x = (low[0] + step).min(0.5 * (low[0] + high[0]));
    for _ in 0..STEPS {
        let h = x * x * (x * x);
        let here = [x, view.coordinate(2.0 * h / (1.0 + h * h))];
        if (here[1] - target).abs() * cells as f64 <= NEAR {
            return here;
        }
        if here[1] < target {
            low = here;
        } else {
            high = here;
        }
        x = low[0] + (target - low[1]) / (high[1] - low[1]) * (high[0] - low[0]);
    }
    [x, target]
}

#[cfg(test)]
mod tests {
    use super::*;
    use microfacet_tables::axis::{CriticalBlend, ViewBlend};

    #[test]
    fn the_whole_hemisphere_is_covered_and_clamps_are_met() {
        let blend = |sigma| ViewBlend::BAKED.prepare(sigma, 2.0);
        // For η = 1 the first view is the horizon.
        let critical = |eta: f64| CriticalBlend::BAKED.prepare(0.3, 2.0, 1.0 / eta);
        let upright = |eta: f64| CriticalBlend::UPRIGHT.prepare(0.3, 1.6, 1.0 / eta);
        let (rough, smooth) = (blend(0.3), blend(1e-8));
        let (glass, nothing) = (critical(1.5), critical(1.0));
        let (heavy, light, none) = (upright(1.5), upright(1.2), upright(1.0));
        for view in [
            Elevation::Blend(rough),
            Elevation::Blend(smooth),
            Elevation::Critical(glass),
            Elevation::Critical(nothing),
            Elevation::Critical(heavy),
            Elevation::Critical(light),
            Elevation::Critical(none),
        ] {
            let [one, cos, above] = over_views(&view, 31, &|cos| {
                let cos = f64::from(cos);
                ([1.0, cos, (cos - 0.4).max(0.0)], u32::from(cos > 0.4))
            });
            // 2 ∫ (μ − 0.4) μ dμ over μ > 0.4.
            let part = 2.0 / 3.0 * (1.0 - 0.064) - 0.4 * (1.0 - 0.16);
            for (got, want) in [(one, 1.0), (cos, 2.0 / 3.0), (above, part)] {
                assert!((got - want).abs() < 1e-6, "{got} for {want}");
            }
        }
    }
}
