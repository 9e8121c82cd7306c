//! A drawing as a list of shapes, whatever the format that it is written in.

use super::ink::{BLACK, Color, Dash};

/// A point of a drawing, in pixels from its left upper corner.
pub(super) type At = [f64; 2];

/// How a text is aligned to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Line {
        points: Vec<At>,
        color: Color,
        width: f64,
        dash: Dash,
    },
    Area {
        corners: Vec<At>,
        color: Color,
    },
    /// Pixels line by line, `columns` of them in each, over a rectangle.
    Image {
        corner: At,
        size: At,
        columns: usize,
        pixels: Vec<Color>,
    },
    /// A text; `at` is on its baseline. Turned, it is read upwards.
    Text {
        at: At,
        text: String,
        size: f64,
        anchor: Anchor,
        turned: bool,
        color: Color,
    },
}

/// A drawing: its size in pixels and what is on it, in order. It is written as SVG and as PNG.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(super) size: At,
    /// By how much a file of SVG is shown larger, where there is room.
    pub(super) zoom: f64,
    pub(super) shapes: Vec<Shape>,
}

impl Drawing {
    pub(super) fn new(size: At) -> Self {
        Self { size, zoom: 1.0, shapes: Vec::new() }
    }

    pub(super) fn line(&mut self, points: Vec<At>, color: Color, width: f64, dash: Dash) {
        self.shapes.push(Shape::Line { points, color, width, dash });
    }

    pub(super) fn area(&mut self, corners: Vec<At>, color: Color) {
        self.shapes.push(Shape::Area { corners, color });
    }

    pub(super) fn image(&mut self, corner: At, size: At, columns: usize, pixels: Vec<Color>) {
        self.shapes.push(Shape::Image { corner, size, columns, pixels });
    }

    pub(super) fn text(&mut self, at: At, text: &str, size: f64, anchor: Anchor, color: Color) {
        let text = text.to_owned();
        self.shapes.push(Shape::Text { at, text, size, anchor, turned: false, color });
    }

    pub(super) fn turned_text(&mut self, at: At, text: &str, size: f64) {
        let (text, color, anchor) = (text.to_owned(), BLACK, Anchor::Middle);
        self.shapes.push(Shape::Text { at, text, size, anchor, turned: true, color });
    }
}

/// A circle as a closed line, with sides of 1 to 2 pixels at the radii of points and rings.
pub(super) fn circle(center: At, radius: f64) -> Vec<At> {
    polygon(center, radius, 24)
}

/// A regular polygon as a closed line, with a corner to the right.
pub(super) fn polygon([x, y]: At, radius: f64, sides: u32) -> Vec<At> {
    let corner = |i: u32| {
        let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / f64::from(sides));
        [x + radius * cos, y + radius * sin]
    };
    (0..=sides).map(corner).collect()
}
