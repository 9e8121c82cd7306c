//! Run time against error, with the Pareto front: no rival is both faster and more accurate.

use microfacet_report::plot::{Axis, Curve, Dash, Figure, Key, Mark, Panel};

use crate::per_hit::{ALBEDO, ALBEDO_OF_SHAPE, BOUND_ALBEDO, LOOKUP};
use crate::rows::{Quantity, Row};
use crate::settings::GAMMA;

/// Error at which rivals without one, exact in distribution, are drawn.
const EXACT: f64 = 1e-8;

/// Panels of visible normals, of G1, of D, and of E at every hit. Filled points are Student-t with
/// γ = [`GAMMA`], and the front is theirs; rings are other distributions.
pub(crate) fn svg(rows: &[Row]) -> String {
    let of = |quantity| rows.iter().filter(|row| row.quantity == quantity).collect::<Vec<_>>();
    let albedos: Vec<&Row> =
        rows.iter().filter(|row| row.quantity == Quantity::PerHit && is_albedo(row)).collect();
    let panels = vec![
        panel("Visible normals", "error of the CDFs, max", &of(Quantity::Normal)),
        panel("G1", "error of G1, max", &of(Quantity::G1)),
        panel("D", "relative error of D, max", &of(Quantity::D)),
        panel("E at every hit", "error of E, max", &albedos),
    ];
    Figure { panels, columns: 1, panel: [760.0, 470.0] }.drawing().svg()
}

fn is_albedo(row: &Row) -> bool {
    [BOUND_ALBEDO, ALBEDO_OF_SHAPE, ALBEDO, LOOKUP].contains(&row.name)
}

/// Where a row is drawn: time and error. `None` for a sampler that draws anything but all visible
/// normals.
fn place(row: &Row) -> Option<(f64, f64)> {
    let error = row.error_max.map_or(EXACT, |error| error.max(EXACT));
    row.complete.then_some((row.ns.max(0.1), error))
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

fn panel(title: &str, y_label: &str, rows: &[&Row]) -> Panel {
    let marks: Vec<Mark> = rows.iter().filter_map(|row| Some(mark(row, place(row)?))).collect();
    let own = marks.iter().filter(|mark| mark.filled).map(|mark| mark.at).collect();
    let front = front(own);
    let steps = front.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1), pair[1]]);
    let name = format!("nothing is faster and more accurate, γ = {GAMMA}");
    let front = Curve::new(Key::OTHER, name, steps).dashed(Dash::Dashed);
    // Room for names to the right.
    let x = axis("ns a call", marks.iter().map(|mark| mark.at.0), [1.5, 4.0]);
    let y = axis(y_label, marks.iter().map(|mark| mark.at.1), [2.0, 2.0]);
    Panel { marks, ..Panel::new(title, x, y, [front]) }
}

fn mark(row: &Row, at: (f64, f64)) -> Mark {
    let ours = row.name.starts_with("table") || is_albedo(row) && row.name != LOOKUP;
    let exact = if row.error_max.is_some() { "" } else { " (exact)" };
    Mark {
        key: if ours { Key::TABLE } else { Key::OTHER },
        name: format!("{}{exact}", row.name),
        at,
        filled: row.gamma == GAMMA,
    }
}

/// A logarithmic axis over all values, longer at its ends by these factors.
fn axis(label: &str, values: impl Iterator<Item = f64> + Clone, room: [f64; 2]) -> Axis {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(0.0, f64::max);
    Axis::log(label, low / room[0], high * room[1])
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
