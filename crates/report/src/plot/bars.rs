//! Groups of bars with their names on them: legible on a narrow page, since no name takes room
//! beside a bar, and without colours, since no legend is needed.

use super::Axis;
use super::drawing::{Anchor, Drawing};
use super::ink::{BLACK, Dash, Key, WHITE};
use super::layout::ZOOM;
use super::panel::{LETTERS, NUMBERS, TITLE};

/// A bar from the left end of the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// What it shows; this sets its colour.
    pub key: Key,
    /// Its name, written on it.
    pub name: String,
    /// Where it ends on the axis.
    pub to: f64,
    /// What is written after its end.
    pub value: String,
}

/// A figure of bars, one below the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// Title.
    pub title: String,
    /// The axis along which they lie.
    pub x: Axis,
    /// Groups from the top, each with a line above it.
    pub groups: Vec<(String, Vec<Bar>)>,
}

const WIDTH: f64 = 375.0;
const SIDE: f64 = 14.0;
const ABOVE: f64 = 28.0;
const BELOW: f64 = 46.0;
/// The line above a group, a bar, and the gap after a group.
const LINE: f64 = 20.0;
const HEIGHT: f64 = 17.0;
const GAP: f64 = 8.0;
/// Room of a number.
const ROOM: f64 = 45.0;

impl Bars {
    /// The figure as a drawing.
    pub fn drawing(&self) -> Drawing {
        let height = |bars: &[Bar]| LINE + HEIGHT * bars.len() as f64 + GAP;
        let foot = ABOVE + self.groups.iter().map(|(_, bars)| height(bars)).sum::<f64>();
        let mut drawing = Drawing::new([WIDTH, foot + BELOW]);
        drawing.zoom = ZOOM;
        let width = WIDTH - 2.0 * SIDE;
        let at = |fraction: f64| SIDE + width * fraction;
        let middle = at(0.5);
        drawing.text([middle, 19.0], &self.title, TITLE, Anchor::Middle, BLACK);
        for tick in self.x.ticks((width / ROOM) as usize) {
            let (x, Some(label)) = (at(tick.at), tick.label) else { continue };
            drawing.line(vec![[x, foot], [x, foot + 5.0]], BLACK, 1.0, Dash::Solid);
            drawing.text([x, foot + 7.0 + NUMBERS], &label, NUMBERS, Anchor::Middle, BLACK);
        }
        let mut top = ABOVE;
        for (name, bars) in &self.groups {
            drawing.text([SIDE + 4.0, top + 15.0], name, LETTERS, Anchor::Start, BLACK);
            for (i, bar) in bars.iter().enumerate() {
                let high = top + LINE + HEIGHT * i as f64;
                let (end, low) = (at(self.x.fraction(bar.to)), high + HEIGHT - 1.0);
                let corners = vec![[SIDE, high], [end, high], [end, low], [SIDE, low]];
                drawing.area(corners, bar.key.color());
                let base = low - 0.5 * (HEIGHT - 1.0) + 0.36 * LETTERS;
                drawing.text([SIDE + 4.0, base], &bar.name, LETTERS, Anchor::Start, WHITE);
                drawing.text([end + 5.0, base], &bar.value, LETTERS, Anchor::Start, BLACK);
            }
            top += height(bars);
        }
        for [from, to] in [[[SIDE, ABOVE], [SIDE, foot]], [[SIDE, foot], [SIDE + width, foot]]] {
            drawing.line(vec![from, to], BLACK, 1.0, Dash::Solid);
        }
        drawing.text([middle, foot + 36.0], &self.x.label, LETTERS, Anchor::Middle, BLACK);
        drawing
    }
}
