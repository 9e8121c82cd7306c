//! Run time against error, with the Pareto front: no rival is both faster and more accurate.

use microfacet_bake::plot::PlotError;
use plotters::prelude::*;

use crate::rows::{Quantity, Row};
use crate::settings::GAMMA;

/// Size of the page, and fine units per unit of the page.
const PAGE: (u32, u32) = (760, 940);
const FINE: u32 = 8;

/// Error at which rivals without one, exact in distribution, are drawn.
const EXACT: f64 = 1e-8;

/// Two panels, visible normals above and G1 below. Filled points are Student-t with γ = [`GAMMA`],
/// and the front is theirs; rings are other distributions.
///
/// # Errors
/// [`PlotError::Drawing`].
pub(crate) fn svg(rows: &[Row]) -> Result<String, PlotError> {
    let size = (FINE * PAGE.0, FINE * PAGE.1);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let areas = root.split_evenly((2, 1));
        let of = |quantity| rows.iter().filter(|row| row.quantity == quantity).collect::<Vec<_>>();
        panel(&areas[0], "Visible normals", "error of the CDFs, max", &of(Quantity::Normal))?;
        panel(&areas[1], "G1", "error of G1, max", &of(Quantity::G1))?;
        root.present().map_err(failed)?;
    }
    let fine = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", PAGE.0, PAGE.1), 1))
}

fn failed(why: impl std::fmt::Display) -> PlotError {
    PlotError::Drawing(why.to_string())
}

/// Where a row is drawn: log₁₀ of time and of error. `None` for a sampler that draws anything but
/// all visible normals.
fn place(row: &Row) -> Option<(f64, f64)> {
    if !row.complete {
        return None;
    }
    let error = row.error.map_or(EXACT, |error| error.max.max(EXACT));
    Some((row.ns.max(0.1).log10(), error.log10()))
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

fn panel(
    area: &DrawingArea<SVGBackend, plotters::coord::Shift>,
    title: &str,
    y_label: &str,
    rows: &[&Row],
) -> Result<(), PlotError> {
    let places: Vec<((f64, f64), &Row)> =
        rows.iter().filter_map(|row| Some((place(row)?, *row))).collect();
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 16 * FINE))
        .margin(12 * FINE)
        .x_label_area_size(36 * FINE)
        .y_label_area_size(58 * FINE)
        .build_cartesian_2d(range(&places, |at| at.0, 1.1), range(&places, |at| at.1, 0.3))
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("ns a call")
        .y_desc(y_label)
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
        .axis_style(BLACK.stroke_width(FINE))
        .set_all_tick_mark_size(4 * FINE)
        .label_style(("sans-serif", 11 * FINE))
        .x_label_formatter(&|x: &f64| format!("{:.0}", 10_f64.powf(*x)))
        .y_label_formatter(&|y: &f64| format!("{:.0e}", 10_f64.powf(*y)))
        .draw()
        .map_err(failed)?;
    let own = places.iter().filter(|(_, row)| row.gamma == GAMMA).map(|(at, _)| *at).collect();
    let steps: Vec<(f64, f64)> =
        front(own).windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1), pair[1]]).collect();
    let line = RED.mix(0.5).stroke_width(2 * FINE);
    chart.draw_series(LineSeries::new(steps, line)).map_err(failed)?;
    let pixels: Vec<(i32, i32)> = places.iter().map(|(at, _)| chart.backend_coord(at)).collect();
    let mut taken: Vec<Box> = pixels.iter().map(|&(x, y)| Box::around(x, y)).collect();
    for (&(at, row), &(x, y)) in places.iter().zip(&pixels) {
        let ours = row.name.starts_with("table");
        let color = if ours { RGBColor(20, 90, 190) } else { RGBColor(70, 70, 70) };
        let filled = row.gamma == GAMMA;
        let style = if filled { color.filled() } else { color.stroke_width(FINE) };
        let label =
            if row.error.is_some() { row.name.clone() } else { format!("{} (exact)", row.name) };
        let down = free(&mut taken, x, y, label.chars().count());
        let font = ("sans-serif", 10 * FINE).into_font().color(&color);
        let dot = EmptyElement::at(at)
            + Circle::new((0, 0), DOT, style)
            + Text::new(label, (DOT + 3 * FINE as i32, down - 6 * FINE as i32), font);
        chart.draw_series(std::iter::once(dot)).map_err(failed)?;
    }
    Ok(())
}

/// Radius of a point.
const DOT: i32 = 4 * FINE as i32;

/// A rectangle in which nothing else should be drawn: [left, right] and [top, bottom].
struct Box {
    x: [i32; 2],
    y: [i32; 2],
}

impl Box {
    fn around(x: i32, y: i32) -> Self {
        Self { x: [x - DOT, x + DOT], y: [y - DOT, y + DOT] }
    }

    fn meets(&self, other: &Self) -> bool {
        let overlap = |a: [i32; 2], b: [i32; 2]| a[0] < b[1] && b[0] < a[1];
        overlap(self.x, other.x) && overlap(self.y, other.y)
    }
}

/// The nearest vertical offset from the point at (x, y) at which a name of so many letters hides
/// nothing; reserves that place.
fn free(taken: &mut Vec<Box>, x: i32, y: i32, letters: usize) -> i32 {
    let line = 11 * FINE as i32;
    let width = letters as i32 * 11 * FINE as i32 / 2;
    let at = |down: i32| Box {
        x: [x + DOT + 2 * FINE as i32, x + DOT + 2 * FINE as i32 + width],
        y: [y + down - line / 2, y + down + line / 2],
    };
    let steps = (0..24).map(|i| if i % 2 == 0 { i / 2 } else { -(i + 1) / 2 } * line / 2);
    let down = steps
        .into_iter()
        .find(|&down| !taken.iter().any(|other| other.meets(&at(down))))
        .unwrap_or(0);
    taken.push(at(down));
    down
}

/// The range of a coordinate with room for names.
fn range(
    places: &[((f64, f64), &Row)],
    of: fn(&(f64, f64)) -> f64,
    room: f64,
) -> std::ops::Range<f64> {
    let values = || places.iter().map(|(at, _)| of(at));
    values().fold(f64::INFINITY, f64::min) - 0.2..values().fold(f64::NEG_INFINITY, f64::max) + room
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
