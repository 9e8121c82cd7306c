//! The whole figure: panels in rows, each with the names of its points beneath, and a legend of
//! curves and symbols for rows that can share it.

use super::drawing::{Anchor, Drawing};
use super::ink::{BLACK, Color, Dash};
use super::panel::{self, DOT, LEFT, LETTERS, NUMBERS, RIGHT};
use super::{Figure, Panel, Symbol, text};

const LINE: f64 = 17.0;
/// Length of the sample of a curve, the gap before its name, and that after it.
const SAMPLE: f64 = 28.0;
const GAP: f64 = 5.0;
const APART: f64 = 12.0;
const BELOW: f64 = 8.0;
const MARGIN: f64 = 12.0;
/// The room of a number in the list of points.
const NUMBER: f64 = 18.0;
/// Letters are as large as those of a page around the figure, where there is room for it.
pub(super) const ZOOM: f64 = 1.4;

pub(super) fn drawing(figure: &Figure) -> Drawing {
    let rows: Vec<&[Panel]> = figure.panels.chunks(figure.columns.max(1)).collect();
    let columns = rows.iter().map(|row| row.len()).max().unwrap_or(0);
    let mut drawing = Drawing::new([figure.panel[0] * columns as f64, 0.0]);
    drawing.zoom = ZOOM;
    let mut y = 0.0;
    let mut left = &rows[..];
    while !left.is_empty() {
        let (count, all) = sharing(left);
        let (these, others) = left.split_at(count);
        // A list of points may be long: their symbols are explained before it.
        let has_points = all.iter().any(|(_, sample, _)| matches!(sample, Sample::Point(_)));
        if has_points {
            y += BELOW + legend(&mut drawing, &all, y + BELOW);
        }
        y = draw_rows(&mut drawing, these, figure.panel, y);
        if !has_points {
            y += legend(&mut drawing, &all, y);
        }
        left = others;
    }
    drawing.size[1] = y;
    drawing
}

/// How many of the first rows share a legend, and what it names: entries of one of the rows are all
/// that there are in the others.
fn sharing<'a>(rows: &[&'a [Panel]]) -> (usize, Vec<Entry<'a>>) {
    let mut all = entries(rows[0]);
    let mut count = 1;
    for row in &rows[1..] {
        let next = entries(row);
        let is_in = |some: &[Entry], others: &[Entry]| some.iter().all(|of| others.contains(of));
        if is_in(&all, &next) {
            all = next;
        } else if !is_in(&next, &all) {
            break;
        }
        count += 1;
    }
    (count, all)
}

/// Draws rows of panels from a height on; returns that of their end.
fn draw_rows(drawing: &mut Drawing, rows: &[&[Panel]], size: [f64; 2], top: f64) -> f64 {
    let [width, height] = size;
    let mut y = top;
    for row in rows {
        let mut listed = 0.0_f64;
        for (j, panel) in row.iter().enumerate() {
            let x = width * j as f64;
            panel::draw(drawing, panel, [x, y], size);
            listed = listed.max(list(drawing, panel, [x, y + height], width));
        }
        y += height + listed;
    }
    y
}

/// What stands before a name of the legend.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sample {
    Line(Dash),
    Point(Symbol),
}

type Entry<'a> = (Color, Sample, &'a str);

/// What the legend of a row names: each curve and each kind of point once, none without a name.
fn entries(row: &[Panel]) -> Vec<Entry<'_>> {
    let mut all = Vec::new();
    let curves = row.iter().flat_map(|panel| &panel.curves);
    let curves =
        curves.map(|curve| (curve.key.color(), Sample::Line(curve.dash), curve.name.as_str()));
    let marks = row.iter().flat_map(|panel| &panel.marks);
    let marks = marks.map(|mark| (mark.key.color(), Sample::Point(mark.symbol), &*mark.group));
    for entry in marks.chain(curves).filter(|(.., name)| !name.is_empty()) {
        if !all.contains(&entry) {
            all.push(entry);
        }
    }
    all
}

/// Draws a legend in one line, or in columns as wide as its longest name; returns its height.
fn legend(drawing: &mut Drawing, all: &[Entry], top: f64) -> f64 {
    if all.is_empty() {
        return 0.0;
    }
    let pitch = |&(.., name): &Entry| SAMPLE + GAP + text::width(name, LETTERS) + APART;
    let pitches: Vec<f64> = all.iter().map(pitch).collect();
    let room = drawing.size[0] - MARGIN - RIGHT + APART;
    let (length, widest) =
        (pitches.iter().sum::<f64>(), pitches.iter().copied().fold(0.0, f64::max));
    let is_line = length <= room;
    // As many columns as fit, but no more than fill the lines evenly.
    let fit = if is_line { all.len() } else { (room / widest).floor().max(1.0) as usize };
    let lines = all.len().div_ceil(fit);
    let columns = all.len().div_ceil(lines);
    // Beneath the axis where there is room for it.
    let length = if is_line { length } else { widest * columns as f64 };
    let left = (MARGIN + room - length).min(LEFT);
    for (i, &(color, sample, name)) in all.iter().enumerate() {
        let before =
            if is_line { pitches[..i].iter().sum() } else { widest * (i % columns) as f64 };
        let x = left + before;
        let y = top + LINE * ((i / columns) as f64 + 0.5);
        match sample {
            Sample::Line(Dash::Points) => {
                let points = [0.1, 0.5, 0.9].map(|part| [x + SAMPLE * part, y]);
                panel::sample(drawing, &points, color, Dash::Points);
            }
            Sample::Line(dash) => panel::sample(drawing, &[[x, y], [x + SAMPLE, y]], color, dash),
            Sample::Point(symbol) => panel::symbol(drawing, [x + 0.5 * SAMPLE, y], symbol, color),
        }
        let start = [x + SAMPLE + GAP, y + 0.35 * LETTERS];
        drawing.text(start, name, LETTERS, Anchor::Start, BLACK);
    }
    LINE * lines as f64 + BELOW
}

/// Lists the points of a panel that have names, by their numbers, in columns that are read
/// downwards; returns its height.
fn list(drawing: &mut Drawing, panel: &Panel, [left, top]: [f64; 2], width: f64) -> f64 {
    let named = panel::numbered(panel);
    let widest = named.iter().map(|mark| text::width(&mark.name, NUMBERS)).fold(0.0, f64::max);
    let pitch = NUMBER + 3.0 * DOT + GAP + widest + APART;
    let fit = ((width + APART) / pitch).floor().max(1.0) as usize;
    let lines = named.len().div_ceil(fit);
    for (i, mark) in named.iter().enumerate() {
        let x = left + pitch * (i / lines) as f64 + NUMBER;
        let y = top + LINE * ((i % lines) as f64 + 0.5);
        let (color, base) = (mark.key.color(), y + 0.35 * NUMBERS);
        drawing.text([x, base], &format!("{}", i + 1), NUMBERS, Anchor::End, color);
        panel::symbol(drawing, [x + GAP + DOT, y], mark.symbol, color);
        let start = [x + 2.0 * GAP + 2.0 * DOT, base];
        drawing.text(start, &mark.name, NUMBERS, Anchor::Start, BLACK);
    }
    if lines == 0 { 0.0 } else { LINE * lines as f64 + BELOW }
}
