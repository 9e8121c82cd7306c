//! One panel on the page: frame, ticks, curves and labelled points.

use super::canvas::{Anchor, At, Canvas, Shape};
use super::clip::{Place, clip};
use super::frame::{DOT, Frame};
use super::ink::{BLACK, Color, Dash, GRID};
use super::{Axis, Curve, Panel, label, text};

/// Margins between a panel's area and what its axes span.
pub(super) const LEFT: f64 = 78.0;
pub(super) const RIGHT: f64 = 18.0;
const ABOVE: f64 = 34.0;
/// Room above what has no title.
pub(super) const BARE: f64 = 14.0;
pub(super) const BELOW: f64 = 50.0;

/// Width of a curve.
pub(super) const CURVE: f64 = 2.0;

const TITLE: f64 = 15.0;
const LETTERS: f64 = 12.0;
const NUMBERS: f64 = 11.0;
/// Length of a tick with a number.
const TICK: f64 = 5.0;
/// Room of a number along x and along y.
const ROOM: At = [50.0, 34.0];
/// Half the width, and the height, of the triangle where a curve leaves.
const TRIANGLE: At = [5.0, 8.0];

/// Draws a panel into an area of the page.
pub(super) fn draw(canvas: &mut Canvas, panel: &Panel, corner: At, size: At) {
    let above = if panel.title.is_empty() { BARE } else { ABOVE };
    let frame = Frame {
        left: corner[0] + LEFT,
        top: corner[1] + above,
        width: size[0] - LEFT - RIGHT,
        height: size[1] - above - BELOW,
    };
    let middle = frame.left + 0.5 * frame.width;
    canvas.text([middle, corner[1] + 22.0], &panel.title, TITLE, Anchor::Middle, BLACK);
    axes(canvas, [&panel.x, &panel.y], &frame, true);
    let curves = |dash| panel.curves.iter().filter(move |curve| curve.dash == dash);
    let mut drawn = Vec::new();
    for curve in [Dash::Solid, Dash::Dashed, Dash::Dotted].into_iter().flat_map(curves) {
        drawn.extend(draw_curve(canvas, panel, curve, &frame));
    }
    marks(canvas, panel, &frame, &drawn);
}

/// Draws the frame with the numbers of its axes and, if asked for, lines across at these.
pub(super) fn axes(
    canvas: &mut Canvas,
    [x_axis, y_axis]: [&Axis; 2],
    frame: &Frame,
    has_grid: bool,
) {
    let rooms = [frame.width / ROOM[0], frame.height / ROOM[1]].map(|room| room as usize);
    let (mut ticks, mut numbers) = (Vec::new(), Vec::new());
    for tick in x_axis.ticks(rooms[0]) {
        let [x, y] = frame.at([tick.at, 0.0]);
        let long = if tick.label.is_some() { TICK } else { 0.5 * TICK };
        if has_grid && tick.label.is_some() {
            canvas.line(vec![[x, y], frame.at([tick.at, 1.0])], GRID, 1.0, Dash::Solid);
        }
        ticks.push(vec![[x, y], [x, y + long]]);
        numbers.push(([x, y + TICK + NUMBERS + 2.0], tick.label, Anchor::Middle));
    }
    let mut widest: f64 = 0.0;
    for tick in y_axis.ticks(rooms[1]) {
        let width = tick.label.as_ref().map_or(0.0, |label| text::width(label, NUMBERS));
        widest = widest.max(width);
        let [x, y] = frame.at([0.0, tick.at]);
        let long = if tick.label.is_some() { TICK } else { 0.5 * TICK };
        if has_grid && tick.label.is_some() {
            canvas.line(vec![[x, y], frame.at([1.0, tick.at])], GRID, 1.0, Dash::Solid);
        }
        ticks.push(vec![[x - long, y], [x, y]]);
        numbers.push(([x - TICK - 4.0, y + 0.36 * NUMBERS], tick.label, Anchor::End));
    }
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    canvas.line(corners.map(|place| frame.at(place)).into(), BLACK, 1.0, Dash::Solid);
    for tick in ticks {
        canvas.line(tick, BLACK, 1.0, Dash::Solid);
    }
    for (at, label, anchor) in numbers {
        if let Some(label) = label {
            canvas.text(at, &label, NUMBERS, anchor, BLACK);
        }
    }
    let [middle, bottom] = frame.at([0.5, 0.0]);
    canvas.text([middle, bottom + 38.0], &x_axis.label, LETTERS, Anchor::Middle, BLACK);
    let [left, half] = frame.at([0.0, 0.5]);
    canvas.turned_text([left - TICK - 4.0 - widest - 10.0, half], &y_axis.label, LETTERS);
}

/// Draws a curve; returns its parts.
fn draw_curve(canvas: &mut Canvas, panel: &Panel, curve: &Curve, frame: &Frame) -> Vec<Vec<At>> {
    let color = curve.key.color();
    let clipped = clip(curve.points.iter().map(|&point| panel.place(point)));
    let on_page = |run: Vec<Place>| run.into_iter().map(|place| frame.at(place)).collect();
    let runs: Vec<Vec<At>> = clipped.runs.into_iter().map(on_page).collect();
    for run in &runs {
        canvas.line(run.clone(), color, CURVE, curve.dash);
    }
    for exit in clipped.exits {
        leaves(canvas, frame.at(exit), exit[1] > 0.5, color);
    }
    runs
}

/// A triangle at the edge that points to where the curve went.
fn leaves(canvas: &mut Canvas, [x, y]: At, upwards: bool, color: Color) {
    let base = if upwards { y + TRIANGLE[1] } else { y - TRIANGLE[1] };
    let corners = vec![[x, y], [x - TRIANGLE[0], base], [x + TRIANGLE[0], base]];
    canvas.shapes.push(Shape::Area { corners, color });
}

fn marks(canvas: &mut Canvas, panel: &Panel, frame: &Frame, curves: &[Vec<At>]) {
    let points = panel.marks.iter().map(|mark| {
        let (center, color) = (frame.at(panel.place(mark.at)), mark.key.color());
        let filled = mark.filled;
        canvas.shapes.push(Shape::Circle { center, radius: DOT, color, filled });
        (center, mark.name.as_str(), color)
    });
    let points: Vec<_> = points.collect();
    label::write(canvas, frame, curves, &points);
}
