//! One panel of a drawing: frame, ticks, curves and labelled points.

use super::clip::{Place, clip};
use super::drawing::{Anchor, At, Drawing, circle};
use super::ink::{BLACK, Color, Dash, GRID};
use super::{Axis, Curve, Panel, label, text};

/// Margins between a panel's area and what its axes span.
pub(super) const LEFT: f64 = 78.0;
pub(super) const RIGHT: f64 = 18.0;
const ABOVE: f64 = 34.0;
/// Margin above a panel without a title.
pub(super) const BARE: f64 = 14.0;
pub(super) const BELOW: f64 = 50.0;

pub(super) const CURVE: f64 = 2.0;
pub(super) const DOT: f64 = 4.0;

pub(super) const TITLE: f64 = 15.0;
pub(super) const LETTERS: f64 = 12.0;
pub(super) const NUMBERS: f64 = 11.0;
/// Length of a tick with a number.
const TICK: f64 = 5.0;
/// Room of a number along x and along y.
const ROOM: At = [50.0, 34.0];
/// Half the width, and the height, of the triangle where a curve leaves.
const TRIANGLE: At = [5.0, 8.0];

/// The rectangle that the axes of a panel span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Frame {
    /// The frame in the area of a panel, with this margin above it.
    pub(super) fn within([left, top]: At, [width, height]: At, above: f64) -> Self {
        Self {
            left: left + LEFT,
            top: top + above,
            width: width - LEFT - RIGHT,
            height: height - above - BELOW,
        }
    }

    pub(super) fn at(&self, [x, y]: Place) -> At {
        [self.left + self.width * x, self.top + self.height * (1.0 - y)]
    }
}

pub(super) fn draw(drawing: &mut Drawing, panel: &Panel, corner: At, size: At) {
    let above = if panel.title.is_empty() { BARE } else { ABOVE };
    let frame = Frame::within(corner, size, above);
    let middle = frame.left + 0.5 * frame.width;
    drawing.text([middle, corner[1] + 22.0], &panel.title, TITLE, Anchor::Middle, BLACK);
    axes(drawing, [&panel.x, &panel.y], &frame, true);
    let curves = |dash| panel.curves.iter().filter(move |curve| curve.dash == dash);
    let mut drawn = Vec::new();
    for curve in [Dash::Solid, Dash::Dashed, Dash::Dotted].into_iter().flat_map(curves) {
        drawn.extend(draw_curve(drawing, panel, curve, &frame));
    }
    marks(drawing, panel, &frame, &drawn);
}

/// Draws the frame with the numbers of its axes and, if asked for, grid lines at the numbers.
pub(super) fn axes(drawing: &mut Drawing, axes: [&Axis; 2], frame: &Frame, has_grid: bool) {
    let rooms = [frame.width / ROOM[0], frame.height / ROOM[1]].map(|room| room as usize);
    let (mut ticks, mut numbers, mut widest) = (Vec::new(), Vec::new(), 0.0_f64);
    for (i, axis) in axes.into_iter().enumerate() {
        let is_x = i == 0;
        for tick in axis.ticks(rooms[i]) {
            let at = |across| frame.at(if is_x { [tick.at, across] } else { [across, tick.at] });
            let [x, y] = at(0.0);
            let long = if tick.label.is_some() { TICK } else { 0.5 * TICK };
            ticks.push(vec![[x, y], if is_x { [x, y + long] } else { [x - long, y] }]);
            let Some(label) = tick.label else { continue };
            if has_grid {
                drawing.line(vec![[x, y], at(1.0)], GRID, 1.0, Dash::Solid);
            }
            numbers.push(if is_x {
                ([x, y + TICK + NUMBERS + 2.0], label, Anchor::Middle)
            } else {
                widest = widest.max(text::width(&label, NUMBERS));
                ([x - TICK - 4.0, y + 0.36 * NUMBERS], label, Anchor::End)
            });
        }
    }
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    for line in ticks.into_iter().chain([corners.map(|place| frame.at(place)).into()]) {
        drawing.line(line, BLACK, 1.0, Dash::Solid);
    }
    for (at, label, anchor) in numbers {
        drawing.text(at, &label, NUMBERS, anchor, BLACK);
    }
    let [middle, bottom] = frame.at([0.5, 0.0]);
    drawing.text([middle, bottom + 38.0], &axes[0].label, LETTERS, Anchor::Middle, BLACK);
    let [left, half] = frame.at([0.0, 0.5]);
    drawing.turned_text([left - TICK - 4.0 - widest - 10.0, half], &axes[1].label, LETTERS);
}

/// Draws a curve, with triangles that point outwards where it leaves; returns its runs inside.
fn draw_curve(drawing: &mut Drawing, panel: &Panel, curve: &Curve, frame: &Frame) -> Vec<Vec<At>> {
    let color = curve.key.color();
    let clipped = clip(curve.points.iter().map(|&point| panel.place(point)));
    let on_page = |run: Vec<Place>| run.into_iter().map(|place| frame.at(place)).collect();
    let runs: Vec<Vec<At>> = clipped.runs.into_iter().map(on_page).collect();
    for run in &runs {
        drawing.line(run.clone(), color, CURVE, curve.dash);
    }
    for exit in clipped.exits {
        let [x, y] = frame.at(exit);
        let base = if exit[1] > 0.5 { y + TRIANGLE[1] } else { y - TRIANGLE[1] };
        drawing.area(vec![[x, y], [x - TRIANGLE[0], base], [x + TRIANGLE[0], base]], color);
    }
    runs
}

fn marks(drawing: &mut Drawing, panel: &Panel, frame: &Frame, curves: &[Vec<At>]) {
    let points = panel.marks.iter().map(|mark| {
        let (center, color) = (frame.at(panel.place(mark.at)), mark.key.color());
        if mark.filled {
            drawing.area(circle(center, DOT), color);
        } else {
            drawing.line(circle(center, DOT), color, 1.0, Dash::Solid);
        }
        (center, mark.name.as_str(), color)
    });
    let points: Vec<(At, &str, Color)> = points.collect();
    label::write(drawing, frame, curves, &points);
}
