//! The page: panels in rows, each row with the legend of its curves beneath.

use super::canvas::{Anchor, Canvas};
use super::ink::{BLACK, Color, Dash};
use super::panel::{self, LEFT, RIGHT};
use super::{Figure, Panel, text};

/// Height of a line of the legend, and the size of its letters.
const LINE: f64 = 19.0;
const LETTERS: f64 = 12.0;
/// Length of the sample of a curve, the gap before its name, and that after it.
const SAMPLE: f64 = 22.0;
const GAP: f64 = 7.0;
const APART: f64 = 20.0;
/// Room beneath a legend.
const BELOW: f64 = 10.0;

/// An entry of a legend.
#[derive(Clone, Debug, PartialEq)]
struct Entry<'a> {
    color: Color,
    dash: Dash,
    name: &'a str,
}

/// Lays a figure out.
pub(super) fn page(figure: &Figure) -> Canvas {
    let [width, height] = figure.panel;
    let rows: Vec<&[Panel]> = figure.panels.chunks(figure.columns.max(1)).collect();
    let columns = rows.iter().map(|row| row.len()).max().unwrap_or(0);
    let mut canvas = Canvas { size: [width * columns as f64, 0.0], shapes: Vec::new() };
    let mut y = 0.0;
    for (i, row) in rows.iter().enumerate() {
        for (j, panel) in row.iter().enumerate() {
            panel::draw(&mut canvas, panel, [width * j as f64, y], figure.panel);
        }
        y += height;
        let all = entries(row);
        // One legend serves the rows that share it.
        if rows.get(i + 1).is_none_or(|next| entries(next) != all) {
            y += legend(&mut canvas, &all, y);
        }
    }
    canvas.size[1] = y;
    canvas
}

/// What the legend of a row names: each curve once, but none without a name.
fn entries(row: &[Panel]) -> Vec<Entry<'_>> {
    let mut all = Vec::new();
    let curves = row.iter().flat_map(|panel| &panel.curves);
    for curve in curves.filter(|curve| !curve.name.is_empty()) {
        let entry = Entry { color: curve.key.color(), dash: curve.dash, name: &curve.name };
        if !all.contains(&entry) {
            all.push(entry);
        }
    }
    all
}

/// Draws a legend in one line, or in columns as wide as its longest name; returns its height.
fn legend(canvas: &mut Canvas, all: &[Entry], top: f64) -> f64 {
    if all.is_empty() {
        return 0.0;
    }
    let pitches: Vec<f64> =
        all.iter().map(|entry| SAMPLE + GAP + text::width(entry.name, LETTERS) + APART).collect();
    let room = canvas.size[0] - LEFT - RIGHT + APART;
    let is_line = pitches.iter().sum::<f64>() <= room;
    let widest = pitches.iter().copied().fold(0.0, f64::max);
    // As many columns as fit, but no more than fill the lines evenly.
    let fit = if is_line { all.len() } else { (room / widest).floor().max(1.0) as usize };
    let lines = all.len().div_ceil(fit);
    let columns = all.len().div_ceil(lines);
    for (i, entry) in all.iter().enumerate() {
        let before =
            if is_line { pitches[..i].iter().sum() } else { widest * (i % columns) as f64 };
        let x = LEFT + before;
        let y = top + LINE * ((i / columns) as f64 + 0.5);
        canvas.line(vec![[x, y], [x + SAMPLE, y]], entry.color, panel::CURVE, entry.dash);
        let start = [x + SAMPLE + GAP, y + 0.35 * LETTERS];
        canvas.text(start, entry.name, LETTERS, Anchor::Start, BLACK);
    }
    LINE * lines as f64 + BELOW
}
