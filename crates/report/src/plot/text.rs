//! The font of figures: how wide a text is, and the outlines of its letters.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, OutlineCurve};

/// A subset of DejaVu Sans; `font/README.md` lists its letters.
static SANS: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("font/sans.ttf")).expect("a font in this crate")
});

/// Families for a reader of SVG: the font that was measured, one as wide, and any.
pub(super) const FAMILIES: &str = "DejaVu Sans, Verdana, sans-serif";

/// The width of a text of a size, in the size's unit.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| advance(c) * size).sum()
}

/// The advance of a letter, in ems.
fn advance(c: char) -> f64 {
    f64::from(SANS.h_advance_unscaled(SANS.glyph_id(c))) / em()
}

fn em() -> f64 {
    f64::from(SANS.units_per_em().unwrap_or(2048.0))
}

/// The length of an em in units of outlines; and for each letter of a text its start in ems, and
/// its outlines, y upwards.
pub(super) fn outlines(text: &str) -> (f64, Vec<(f64, Vec<OutlineCurve>)>) {
    let mut x = 0.0;
    let letters = text.chars().filter_map(|c| {
        let at = x;
        x += advance(c);
        Some((at, SANS.outline(SANS.glyph_id(c))?.curves))
    });
    let letters = letters.collect();
    (em(), letters)
}

#[cfg(test)]
pub(super) fn has_all(text: &str) -> bool {
    text.chars().all(|c| SANS.glyph_id(c).0 != 0)
}
