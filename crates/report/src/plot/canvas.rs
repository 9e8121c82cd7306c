//! A page as a list of shapes, whatever the format that it is written in.

use super::ink::{Color, Dash};

/// A point of the page, in pixels from its left upper corner.
pub(super) type At = [f64; 2];

/// Which part of a text stands at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One thing on the page.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A line through points.
    Line { points: Vec<At>, color: Color, width: f64, dash: Dash },
    /// A filled polygon.
    Area { corners: Vec<At>, color: Color },
    /// A circle, filled or not.
    Circle { center: At, radius: f64, color: Color, filled: bool },
    /// Pixels line by line, `columns` of them in each, over a rectangle.
    Image { corner: At, size: At, columns: usize, pixels: Vec<Color> },
    /// A text; `at` is on its baseline. Turned, it is read upwards.
    Text { at: At, text: String, size: f64, anchor: Anchor, turned: bool, color: Color },
}

/// A page: its size in pixels and what is on it, in order of drawing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Canvas {
    pub(super) size: At,
    pub(super) shapes: Vec<Shape>,
}

impl Canvas {
    pub(super) fn line(&mut self, points: Vec<At>, color: Color, width: f64, dash: Dash) {
        self.shapes.push(Shape::Line { points, color, width, dash });
    }

    pub(super) fn text(&mut self, at: At, text: &str, size: f64, anchor: Anchor, color: Color) {
        let text = text.to_owned();
        self.shapes.push(Shape::Text { at, text, size, anchor, turned: false, color });
    }

    pub(super) fn turned_text(&mut self, at: At, text: &str, size: f64) {
        let (text, color, anchor) = (text.to_owned(), super::ink::BLACK, Anchor::Middle);
        self.shapes.push(Shape::Text { at, text, size, anchor, turned: true, color });
    }
}

impl Dash {
    /// Lengths of dashes and gaps in turn, in widths of the line; none if there are no gaps.
    pub(super) fn lengths(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[4.0, 2.5],
            Self::Dotted => &[1.2, 1.8],
        }
    }
}
