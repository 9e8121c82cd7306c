//! Run time against error, with the Pareto front: no rival is both faster and more accurate.

use microfacet_report::plot::{Axis, Curve, Dash, Figure, Key, Mark, Panel, Symbol};

use crate::per_hit::{ALBEDO, ALBEDO_OF_SHAPE, BOUND_ALBEDO, LOOKUP};
use crate::rows::{Quantity, Row};
use crate::sampler::OTHERS;
use crate::settings::GAMMA;

/// Error at which rivals without one, exact in distribution, are drawn.
const EXACT: f64 = 1e-8;

/// What is drawn of a row.
pub(crate) struct Point {
    pub(crate) quantity: Quantity,
    pub(crate) name: String,
    pub(crate) gamma: f64,
    pub(crate) ns: f64,
    pub(crate) error: Option<f64>,
}

impl From<&Row> for Point {
    fn from(row: &Row) -> Self {
        let &Row { quantity, name, gamma, ns, error_max: error, .. } = row;
        Self { quantity, name: name.into(), gamma, ns, error }
    }
}

/// Panels of visible normals, of G1, of D, and of E at every hit. Squares are tables of this
/// project; what is filled is Student-t with γ = [`GAMMA`], and the front is its own.
pub(crate) fn svg(points: &[Point]) -> String {
    let of = |quantity| points.iter().filter(|at| at.quantity == quantity).collect::<Vec<_>>();
    let normals = of(Quantity::Normal).into_iter().filter(|at| !OTHERS.contains(&&*at.name));
    let albedos = of(Quantity::PerHit).into_iter().filter(|at| is_albedo(at));
    let panels = vec![
        panel("Visible normals", "largest error of the CDFs", &normals.collect::<Vec<_>>()),
        panel("Masking G₁", "largest error of G₁", &of(Quantity::G1)),
        panel("Normal distribution function D", "largest relative error", &of(Quantity::D)),
        panel(
            "Directional albedo E at every hit",
            "largest error of E",
            &albedos.collect::<Vec<_>>(),
        ),
    ];
    Figure { panels, columns: 1, panel: [530.0, 280.0] }.drawing().svg()
}

fn is_albedo(at: &Point) -> bool {
    [BOUND_ALBEDO, ALBEDO_OF_SHAPE, ALBEDO, LOOKUP].contains(&&*at.name)
}

/// The Pareto front: the points for which no other is at least as fast and as accurate, by time.
fn front(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut lowest = f64::INFINITY;
    points.retain(|point| {
        let better = point.1 < lowest;
        lowest = lowest.min(point.1);
        better
    });
    points
}

fn panel(title: &str, y_label: &str, points: &[&Point]) -> Panel {
    let marks: Vec<Mark> = points.iter().map(|at| mark(at)).collect();
    let own = points.iter().zip(&marks).filter(|(at, _)| at.gamma == GAMMA);
    let front = front(own.map(|(_, mark)| mark.at).collect());
    let steps = front.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1), pair[1]]);
    let name = format!("Pareto front of γ = {GAMMA}");
    let front = Curve::new(Key::OTHER, name, steps).dashed(Dash::Dashed);
    let x = axis("time of a call (ns)", marks.iter().map(|mark| mark.at.0));
    let y = axis(y_label, marks.iter().map(|mark| mark.at.1));
    Panel { marks, ..Panel::new(title, x, y, [front]) }
}

fn mark(point: &Point) -> Mark {
    let is_ours = point.name.starts_with("table") || is_albedo(point) && point.name != LOOKUP;
    let (key, symbol, group) = match (is_ours, point.gamma == GAMMA) {
        (true, true) => {
            (Key::TABLE, Symbol::Square, format!("tables of this project, γ = {GAMMA}"))
        }
        (true, false) => (Key::TABLE, Symbol::Frame, "tables of this project, another γ".into()),
        (false, true) => (Key::OTHER, Symbol::Dot, format!("other ways, γ = {GAMMA}")),
        (false, false) => (Key::OTHER, Symbol::Ring, "other ways, another distribution".into()),
    };
    let mut name = point.name.replace("sigma", "σ").replace("gamma", "γ");
    if point.error.is_none() && !name.contains("exact") {
        name += " (exact)";
    }
    let error = point.error.map_or(EXACT, |error| error.max(EXACT));
    Mark { key, name, group, at: (point.ns.max(0.1), error), symbol }
}

/// A logarithmic axis over all values, with room for symbols and their numbers at its ends.
fn axis(label: &str, values: impl Iterator<Item = f64> + Clone) -> Axis {
    const ROOM: f64 = 1.7;
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    Axis::log(label, low / ROOM, high * ROOM)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = vec![(3.0, 1.0), (1.0, 5.0), (2.0, 6.0), (2.0, 2.0), (1.0, 7.0), (4.0, 1.0)];
        assert_eq!(front(points), [(1.0, 5.0), (2.0, 2.0), (3.0, 1.0)]);
    }
}
