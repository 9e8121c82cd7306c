//! The whole figure: panels in rows, each row with the legend of its curves beneath.

use super::drawing::{Anchor, Drawing};
use super::ink::{BLACK, Color, Dash};
use super::panel::{self, LEFT, LETTERS, RIGHT};
use super::{Figure, Panel, text};

const LINE: f64 = 19.0;
/// Length of the sample of a curve, the gap before its name, and that after it.
const SAMPLE: f64 = 22.0;
const GAP: f64 = 7.0;
const APART: f64 = 20.0;
const BELOW: f64 = 10.0;

pub(super) fn drawing(figure: &Figure) -> Drawing {
    let [width, height] = figure.panel;
    let rows: Vec<&[Panel]> = figure.panels.chunks(figure.columns.max(1)).collect();
    let columns = rows.iter().map(|row| row.len()).max().unwrap_or(0);
    let mut drawing = Drawing::new([width * columns as f64, 0.0]);
    let mut y = 0.0;
    for (i, row) in rows.iter().enumerate() {
        for (j, panel) in row.iter().enumerate() {
            panel::draw(&mut drawing, panel, [width * j as f64, y], figure.panel);
        }
        y += height;
        let all = entries(row);
        // One legend serves the rows that share it.
        if rows.get(i + 1).is_none_or(|next| entries(next) != all) {
            y += legend(&mut drawing, &all, y);
        }
    }
    drawing.size[1] = y;
    drawing
}

/// What the legend of a row names: each curve once, but none without a name.
fn entries(row: &[Panel]) -> Vec<(Color, Dash, &str)> {
    let mut all = Vec::new();
    let curves = row.iter().flat_map(|panel| &panel.curves);
    for curve in curves.filter(|curve| !curve.name.is_empty()) {
        let entry = (curve.key.color(), curve.dash, curve.name.as_str());
        if !all.contains(&entry) {
            all.push(entry);
        }
    }
    all
}

/// Draws a legend in one line, or in columns as wide as its longest name; returns its height.
fn legend(drawing: &mut Drawing, all: &[(Color, Dash, &str)], top: f64) -> f64 {
    if all.is_empty() {
        return 0.0;
    }
    let pitch = |&(.., name): &(_, _, &str)| SAMPLE + GAP + text::width(name, LETTERS) + APART;
    let pitches: Vec<f64> = all.iter().map(pitch).collect();
    let room = drawing.size[0] - LEFT - RIGHT + APART;
    let is_line = pitches.iter().sum::<f64>() <= room;
    let widest = pitches.iter().copied().fold(0.0, f64::max);
    // As many columns as fit, but no more than fill the lines evenly.
    let fit = if is_line { all.len() } else { (room / widest).floor().max(1.0) as usize };
    let lines = all.len().div_ceil(fit);
    let columns = all.len().div_ceil(lines);
    for (i, &(color, dash, name)) in all.iter().enumerate() {
        let before =
            if is_line { pitches[..i].iter().sum() } else { widest * (i % columns) as f64 };
        let x = LEFT + before;
        let y = top + LINE * ((i / columns) as f64 + 0.5);
        drawing.line(vec![[x, y], [x + SAMPLE, y]], color, panel::CURVE, dash);
        let start = [x + SAMPLE + GAP, y + 0.35 * LETTERS];
        drawing.text(start, name, LETTERS, Anchor::Start, BLACK);
    }
    LINE * lines as f64 + BELOW
}
