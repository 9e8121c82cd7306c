//! The font of figures: how wide a text is, and the outlines of its letters.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// A subset of DejaVu Sans; `font/README.md` lists its letters.
static SANS: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(include_bytes!("font/sans.ttf"), 0).expect("a font in this crate")
});

/// Families for a reader of SVG: the font that was measured, one as wide, and any.
pub(super) const FAMILIES: &str = "DejaVu Sans, Verdana, sans-serif";

/// The width of a text of a size, in the size's unit.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| advance(c) * size).sum()
}

/// The glyph of a character; the font's box for one that it lacks.
fn glyph(c: char) -> GlyphId {
    SANS.glyph_index(c).unwrap_or_default()
}

/// The advance of a letter, in ems.
fn advance(c: char) -> f64 {
    f64::from(SANS.glyph_hor_advance(glyph(c)).unwrap_or(0)) / em()
}

fn em() -> f64 {
    f64::from(SANS.units_per_em())
}

/// A quadratic curve: its start, its control point and its end. The control point of a line is its
/// start.
pub(super) type Curve = [[f32; 2]; 3];

/// The length of an em in units of outlines; and for each letter of a text its start in ems, and
/// its outlines, y upwards.
pub(super) fn outlines(text: &str) -> (f64, Vec<(f64, Vec<Curve>)>) {
    let mut x = 0.0;
    let letters = text.chars().map(|c| {
        let at = x;
        x += advance(c);
        let mut outline = Outline::default();
        SANS.outline_glyph(glyph(c), &mut outline);
        (at, outline.curves)
    });
    let letters = letters.collect();
    (em(), letters)
}

/// The outline of a letter so far, and where its last loop began.
#[derive(Default)]
struct Outline {
    curves: Vec<Curve>,
    first: [f32; 2],
    last: [f32; 2],
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        (self.first, self.last) = ([x, y], [x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let [bend_x, bend_y] = self.last;
        self.quad_to(bend_x, bend_y, x, y);
    }

    fn quad_to(&mut self, bend_x: f32, bend_y: f32, x: f32, y: f32) {
        self.curves.push([self.last, [bend_x, bend_y], [x, y]]);
        self.last = [x, y];
    }

    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, _: f32, _: f32) {
        unreachable!("TrueType outlines are quadratic")
    }

    fn close(&mut self) {
        let [x, y] = self.first;
        self.line_to(x, y);
    }
}

#[cfg(test)]
pub(super) fn has_all(text: &str) -> bool {
    text.chars().all(|c| glyph(c).0 != 0)
}
