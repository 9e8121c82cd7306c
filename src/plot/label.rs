//! Names beside points, where they hide nothing.

use super::canvas::{Anchor, At, Canvas};
use super::ink::{Color, Dash};
use super::panel::{DOT, Frame};
use super::text;

/// Size of the letters and of the space that a line of them takes.
const LETTERS: f64 = 10.5;
const LINE: f64 = 12.0;
/// Gap between a point and its name.
const GAP: f64 = 3.0;

/// A rectangle of the page in which nothing else should be drawn: [left, right], [top, bottom].
#[derive(Clone, Copy, Debug)]
struct Taken {
    x: [f64; 2],
    y: [f64; 2],
}

impl Taken {
    fn meets(&self, other: &Self) -> bool {
        let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
        overlap(self.x, other.x) && overlap(self.y, other.y)
    }
}

/// Half the side of the squares that stand for a line, and how far apart they are.
const PEN: f64 = 1.5;
const STRIDE: f64 = 3.0;

/// The free space of a panel.
pub(super) struct Labels {
    frame: Frame,
    /// Points, curves and the lines that lead to names.
    taken: Vec<Taken>,
    /// Names.
    names: Vec<Taken>,
}

impl Labels {
    /// The panel with points at these places of the page, and these curves.
    pub(super) fn around(frame: &Frame, places: &[At], curves: &[Vec<At>]) -> Self {
        let dots = places.iter().map(|&at| square(at, DOT));
        let segments = curves.iter().flat_map(|curve| curve.windows(2));
        let lines = segments.flat_map(|ends| line(ends[0], ends[1]));
        Self { frame: *frame, taken: dots.chain(lines).collect(), names: Vec::new() }
    }

    /// Writes a point's name to its right or, where there is no room, to its left, as near to its
    /// height as hides nothing; a thin line leads to it from farther away.
    pub(super) fn name(&mut self, canvas: &mut Canvas, from: At, name: &str, color: Color) {
        let [x, y] = from;
        let width = text::width(name, LETTERS);
        let inner = DOT + GAP;
        let at = |right: bool, down: f64| Taken {
            x: if right { [x + inner, x + inner + width] } else { [x - inner - width, x - inner] },
            y: [y + down - 0.5 * LINE, y + down + 0.5 * LINE],
        };
        // Where a line leads to, if the name is not beside its point.
        let lead = |right: bool, down: f64| {
            let end = if right { x + inner - 1.0 } else { x - inner + 1.0 };
            (down.abs() > 0.75 * LINE).then_some([end, y + down])
        };
        let heights =
            (0..60).map(|i: i32| f64::from(if i % 2 == 0 { i / 2 } else { -(i + 1) / 2 }));
        let mut places = heights.flat_map(|i| [true, false].map(|right| (right, 0.5 * LINE * i)));
        let free = places.find(|&(right, down)| {
            let place = at(right, down);
            let hidden = |others: &[Taken], by: &Taken| others.iter().any(|other| other.meets(by));
            let mut led = lead(right, down).into_iter().flat_map(|end| line(from, end));
            self.holds(&place)
                && !hidden(&self.taken, &place)
                && !hidden(&self.names, &place)
                && !led.any(|part| hidden(&self.names, &part))
        });
        let (right, down) = free.unwrap_or((true, 0.0));
        self.names.push(at(right, down));
        if let Some(end) = lead(right, down) {
            self.taken.extend(line(from, end));
            canvas.line(vec![from, end], color, 0.6, Dash::Solid);
        }
        let (start, anchor) =
            if right { (x + inner, Anchor::Start) } else { (x - inner, Anchor::End) };
        canvas.text([start, y + down + 0.36 * LETTERS], name, LETTERS, anchor, color);
    }

    fn holds(&self, place: &Taken) -> bool {
        let Frame { left, top, width, height } = self.frame;
        place.x[0] >= left
            && place.x[1] <= left + width
            && place.y[0] >= top
            && place.y[1] <= top + height
    }
}

fn square([x, y]: At, half: f64) -> Taken {
    Taken { x: [x - half, x + half], y: [y - half, y + half] }
}

/// Squares along a line.
fn line(from: At, to: At) -> impl Iterator<Item = Taken> {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let steps = (dx.hypot(dy) / STRIDE).ceil().max(1.0);
    (0..=steps as u32).map(move |i| {
        let part = f64::from(i) / steps;
        square([from[0] + part * dx, from[1] + part * dy], PEN)
    })
}
