//! A quantity over two axes in false colours, and the bar of their scale.

use super::Axis;
use super::drawing::{Anchor, At, Drawing, circle};
use super::ink::{BLACK, Color, Dash, NOT_A_NUMBER, false_color};
use super::panel::{self, BARE, Frame, LETTERS, NUMBERS};

/// Numbers in false colours over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// The axis along x.
    pub x: Axis,
    /// The axis along y.
    pub y: Axis,
    /// Pixels in a row.
    pub columns: usize,
    /// A number for each pixel, row by row from the low end of y; those that are NaN have a colour
    /// of their own.
    pub values: Vec<f64>,
    /// The scale of the colours; a value beyond its ends has the colour of the nearer end.
    pub scale: Axis,
    /// A point to ring, as fractions of the axes.
    pub ring: Option<[f64; 2]>,
    /// Width and height with numbers and labels, in pixels of the page.
    pub size: [f64; 2],
}

/// Shades of maps and their bars: few take fewer bytes, and can be told apart.
const SHADES: usize = 24;
/// The ring: its radius, and widths and colours of its lines, the same on light and dark pages.
const RADIUS: f64 = 7.0;
const RING: [(f64, Color); 2] = [(4.5, [24, 24, 24]), (2.0, [250, 250, 250])];

/// The height of a bar, and the room of a number.
const HEIGHT: f64 = 14.0;
const ROOM: f64 = 62.0;

impl HeatMap {
    /// Draws it.
    ///
    /// # Panics
    /// For values that are not whole rows.
    pub fn drawing(&self) -> Drawing {
        let Self { columns, values, size, .. } = self;
        assert!(
            !values.is_empty() && values.len().is_multiple_of(*columns),
            "{} pixels in rows of {columns}",
            values.len()
        );
        let mut drawing = Drawing::new(*size);
        let frame = Frame::within([0.0; 2], *size, BARE);
        // Images begin at the top, values at the low end of y.
        let rows = values.chunks(*columns).rev();
        let pixels = rows.flatten().map(|&x| self.color(x)).collect();
        drawing.image(frame.at([0.0, 1.0]), [frame.width, frame.height], *columns, pixels);
        panel::axes(&mut drawing, [&self.x, &self.y], &frame, false);
        if let Some(place) = self.ring {
            for (width, color) in RING {
                drawing.line(circle(frame.at(place), RADIUS), color, width, Dash::Solid);
            }
        }
        drawing
    }

    fn color(&self, x: f64) -> Color {
        if x.is_nan() { NOT_A_NUMBER } else { shade(self.scale.fraction(x), SHADES) }
    }
}

/// The bar of a scale with its numbers. Its width, in pixels of the page, includes half of the
/// number at each end.
pub fn bar(scale: &Axis, width: f64) -> Drawing {
    let mut drawing = Drawing::new([width, HEIGHT + 44.0]);
    draw_bar(&mut drawing, scale, [0.5 * ROOM, 2.0], [width - ROOM, HEIGHT], SHADES);
    drawing
}

/// Draws the bar of a scale in this number of shades, with its numbers and its label beneath.
pub(super) fn draw_bar(
    drawing: &mut Drawing,
    scale: &Axis,
    [left, top]: At,
    [width, height]: At,
    shades: usize,
) {
    let pixels = (0..shades).map(|i| shade((i as f64 + 0.5) / shades as f64, shades)).collect();
    drawing.image([left, top], [width, height], shades, pixels);
    let bottom = top + height;
    for tick in scale.ticks((width / ROOM) as usize) {
        let x = left + width * tick.at;
        let Some(label) = tick.label else { continue };
        drawing.line(vec![[x, bottom], [x, bottom + 4.0]], BLACK, 1.0, Dash::Solid);
        drawing.text([x, bottom + NUMBERS + 5.0], &label, NUMBERS, Anchor::Middle, BLACK);
    }
    let at = [left + 0.5 * width, bottom + 36.0];
    drawing.text(at, &scale.label, LETTERS, Anchor::Middle, BLACK);
}

/// The false colour of the middle of the shade that a fraction of the scale falls into.
fn shade(fraction: f64, shades: usize) -> Color {
    let shades = shades as f64;
    let of = (fraction * shades).floor().clamp(0.0, shades - 1.0);
    false_color((of + 0.5) / shades)
}

#[cfg(test)]
mod tests {
    use super::super::panel::{BELOW, LEFT, RIGHT};
    use super::super::png::decode;
    use super::*;

    fn map(values: Vec<f64>, ring: Option<[f64; 2]>) -> HeatMap {
        let axis = |label: &str| Axis::marked(label, [(0.0, "1".to_owned()), (1.0, "∞".into())]);
        let (x, y, scale) = (axis("γ"), axis("σ"), Axis::log("error", 1e-6, 1e-2));
        HeatMap { x, y, columns: 2, values, scale, ring, size: [400.0, 300.0] }
    }

    fn at(map: &HeatMap, [x, y]: [f64; 2]) -> Color {
        let (pixels, columns) = decode(&map.drawing().png().unwrap());
        let [width, height] = [400.0 - LEFT - RIGHT, 300.0 - BARE - BELOW];
        let place = [LEFT + x * width, BARE + (1.0 - y) * height];
        let [x, y] = place.map(|x| (2.0 * x) as usize);
        pixels[y * columns + x]
    }

    #[test]
    fn the_first_value_is_at_the_low_ends_and_nan_is_no_colour_of_the_scale() {
        let map = map(vec![1e-9, 1e-4, f64::NAN, f64::INFINITY], None);
        let quarters = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]];
        let shades = [0.0, 0.5, 1.0].map(|x| shade(x, SHADES));
        let want = [shades[0], shades[1], NOT_A_NUMBER, shades[2]];
        assert_eq!(quarters.map(|place| at(&map, place)), want);
        let all: Vec<Color> = (0..SHADES).map(|i| shade(i as f64 / 23.99, SHADES)).collect();
        assert!(!all.contains(&NOT_A_NUMBER));
    }

    #[test]
    fn the_ring_stands_where_it_is_said_and_is_seen_on_every_shade() {
        for error in [1e-9, 1e-4, 1.0] {
            let map = map(vec![error; 4], Some([0.5, 0.5]));
            let beneath = at(&map, [0.5, 0.5]);
            let beside = |off: f64| at(&map, [0.5 + off / (400.0 - LEFT - RIGHT), 0.5]);
            let across: Vec<Color> = (0..24).map(|i| beside(0.5 * f64::from(i))).collect();
            for (_, color) in RING {
                assert!(across.contains(&color), "{error}: {across:?}");
                assert_ne!(beneath, color);
            }
        }
    }

    #[test]
    #[should_panic = "3 pixels in rows of 2"]
    fn rows_that_are_not_whole_are_refused() {
        map(vec![1.0; 3], None).drawing();
    }

    #[test]
    fn a_bar_has_the_numbers_of_its_scale() {
        let drawn = bar(&Axis::log("error", 1e-6, 1e-2), 400.0).svg();
        let document = roxmltree::Document::parse(&drawn).unwrap();
        let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
        for word in ["10⁻⁶", "10⁻²", "error"] {
            assert!(texts.contains(&word), "{word} in {texts:?}");
        }
    }
}
