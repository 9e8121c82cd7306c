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

/// The free space of a panel.
pub(super) struct Labels {
    frame: Frame,
    taken: Vec<Taken>,
}

impl Labels {
    /// The panel with points at these places of the page.
    pub(super) fn around(frame: &Frame, places: &[At]) -> Self {
        let dot = |&[x, y]: &At| Taken { x: [x - DOT, x + DOT], y: [y - DOT, y + DOT] };
        Self { frame: *frame, taken: places.iter().map(dot).collect() }
    }

    /// Writes a point's name to its right or, where there is no room, to its left, as near to its
    /// height as hides nothing; a thin line leads to it from farther away.
    pub(super) fn name(&mut self, canvas: &mut Canvas, [x, y]: At, name: &str, color: Color) {
        let width = text::width(name, LETTERS);
        let inner = DOT + GAP;
        let at = |right: bool, down: f64| Taken {
            x: if right { [x + inner, x + inner + width] } else { [x - inner - width, x - inner] },
            y: [y + down - 0.5 * LINE, y + down + 0.5 * LINE],
        };
        let heights = (0..40)
            .map(|i: i32| f64::from(if i % 2 == 0 { i / 2 } else { -(i + 1) / 2 }) * 0.5 * LINE);
        let places = heights.flat_map(|down| [(true, down), (false, down)]);
        let free = places.clone().find(|&(right, down)| {
            let place = at(right, down);
            self.holds(&place) && !self.taken.iter().any(|other| other.meets(&place))
        });
        let (right, down) = free.unwrap_or((true, 0.0));
        self.taken.push(at(right, down));
        let (start, anchor) =
            if right { (x + inner, Anchor::Start) } else { (x - inner, Anchor::End) };
        if down.abs() > 0.75 * LINE {
            let toward = if right { -1.0 } else { 1.0 };
            canvas.line(vec![[x, y], [start + toward, y + down]], color, 0.6, Dash::Solid);
        }
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
