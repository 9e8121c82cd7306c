//! One panel of a drawing: frame, ticks, curves and labelled points.

use super::clip::{Place, clip};
use super::drawing::{Anchor, At, Drawing, circle, polygon};
use super::ink::{BLACK, Color, Dash, GRID};
use super::{Axis, Curve, Mark, Panel, Symbol, label, text};

/// Margins between a panel's area and what its axes span.
pub(super) const LEFT: f64 = 66.0;
pub(super) const RIGHT: f64 = 14.0;
const ABOVE: f64 = 28.0;
/// Margin above a panel without a title.
pub(super) const BARE: f64 = 14.0;
pub(super) const BELOW: f64 = 46.0;

pub(super) const CURVE: f64 = 2.0;
pub(super) const DOT: f64 = 4.0;
/// The radius of a point of a curve without a line.
const POINT: f64 = 1.7;

pub(super) const TITLE: f64 = 13.0;
pub(super) const LETTERS: f64 = 12.0;
pub(super) const NUMBERS: f64 = 11.0;
/// Length of a tick with a number.
const TICK: f64 = 5.0;
/// Room of a number along x and along y.
const ROOM: At = [38.0, 26.0];
/// Half the width, and the height, of the triangle where a curve leaves.
const TRIANGLE: At = [4.0, 6.0];

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
    // Over the frame, or as far to the left as a long title needs.
    let half = 0.5 * text::width(&panel.title, TITLE) + 4.0;
    let middle = (frame.left + 0.5 * frame.width).min(corner[0] + size[0] - half);
    drawing.text([middle, corner[1] + 19.0], &panel.title, TITLE, Anchor::Middle, BLACK);
    axes(drawing, [&panel.x, &panel.y], &frame, true);
    let curves = |dash| panel.curves.iter().filter(move |curve| curve.dash == dash);
    let mut drawn = Vec::new();
    for curve in Dash::ORDER.into_iter().flat_map(curves) {
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
    drawing.text([middle, bottom + 35.0], &axes[0].label, LETTERS, Anchor::Middle, BLACK);
    let [left, half] = frame.at([0.0, 0.5]);
    drawing.turned_text([left - TICK - 4.0 - widest - 10.0, half], &axes[1].label, LETTERS);
}

/// Draws a curve, with triangles that point outwards where its line leaves; returns the runs of its
/// line inside.
fn draw_curve(drawing: &mut Drawing, panel: &Panel, curve: &Curve, frame: &Frame) -> Vec<Vec<At>> {
    let color = curve.key.color();
    let places = curve.points.iter().map(|&point| panel.place(point));
    if curve.dash == Dash::Points {
        let inside = places.filter(|place| place.iter().all(|x| (0.0..=1.0).contains(x)));
        let points: Vec<At> = inside.map(|place| frame.at(place)).collect();
        sample(drawing, &points, color, curve.dash);
        return Vec::new();
    }
    let clipped = clip(places);
    let on_page = |run: Vec<Place>| run.into_iter().map(|place| frame.at(place)).collect();
    let runs: Vec<Vec<At>> = clipped.runs.into_iter().map(on_page).collect();
    for run in &runs {
        sample(drawing, run, color, curve.dash);
    }
    for exit in clipped.exits {
        let [x, y] = frame.at(exit);
        let base = if exit[1] > 0.5 { y + TRIANGLE[1] } else { y - TRIANGLE[1] };
        drawing.area(vec![[x, y], [x - TRIANGLE[0], base], [x + TRIANGLE[0], base]], color);
    }
    runs
}

/// Draws a line with a dash, or its points.
pub(super) fn sample(drawing: &mut Drawing, points: &[At], color: Color, dash: Dash) {
    if dash == Dash::Points {
        points.iter().for_each(|&at| drawing.area(polygon(at, POINT, 8), color));
    } else {
        drawing.line(points.to_vec(), color, CURVE, dash);
    }
}

pub(super) fn symbol(drawing: &mut Drawing, at: At, symbol: Symbol, color: Color) {
    const LINE: f64 = 1.4;
    let [x, y] = at;
    let side = 0.9 * DOT;
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]
        .map(|[dx, dy]| [x + side * dx, y + side * dy]);
    match symbol {
        Symbol::Dot => drawing.area(circle(at, DOT), color),
        Symbol::Ring => drawing.line(circle(at, DOT), color, LINE, Dash::Solid),
        Symbol::Square => drawing.area(square.into(), color),
        Symbol::Frame => drawing.line(square.into(), color, LINE, Dash::Solid),
    }
}

/// The points of a panel that have names, from left to right; the first has the number 1.
pub(super) fn numbered(panel: &Panel) -> Vec<&Mark> {
    let mut named: Vec<&Mark> = panel.marks.iter().filter(|mark| !mark.name.is_empty()).collect();
    named.sort_by(|a, b| a.at.0.total_cmp(&b.at.0).then(b.at.1.total_cmp(&a.at.1)));
    named
}

fn marks(drawing: &mut Drawing, panel: &Panel, frame: &Frame, curves: &[Vec<At>]) {
    let center = |mark: &Mark| frame.at(panel.place(mark.at));
    for mark in &panel.marks {
        symbol(drawing, center(mark), mark.symbol, mark.key.color());
    }
    let numbers = numbered(panel).into_iter().enumerate();
    let points: Vec<(At, String, Color)> =
        numbers.map(|(i, mark)| (center(mark), format!("{}", i + 1), mark.key.color())).collect();
    label::write(drawing, frame, curves, &points);
}
