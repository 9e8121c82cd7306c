//! Pictures in rows and columns, in their own colours or in false ones with a scale.

use super::Axis;
use super::drawing::{Anchor, Drawing};
use super::heat::draw_bar;
use super::ink::{BLACK, Color, false_color};
use super::panel::{LETTERS, NUMBERS};
use super::text;

/// What a picture shows, line by line from its upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Red, green and blue of sRGB.
    Colors(Vec<[u8; 3]>),
    /// Numbers, in false colours by the scale of the sheet. A number beyond its ends has the colour
    /// of the nearer end, and NaN is white.
    Values(Vec<f64>),
}

/// A square picture with a line below it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The pixels of a square.
    pub content: Content,
    /// The line below the picture.
    pub caption: String,
}

/// A sheet of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Groups of columns from the left: the number of columns, and the heading above them.
    pub groups: Vec<(usize, String)>,
    /// Headings of the columns.
    pub columns: Vec<String>,
    /// Rows with their names, which may have several lines, and a tile for each column.
    pub rows: Vec<(String, Vec<Tile>)>,
    /// The scale of false colours; `None` without false colours.
    pub scale: Option<Axis>,
    /// The edge of a picture, in pixels of the page.
    pub edge: f64,
}

/// Sizes in pixels of the page: the room on either side of a row's name, that of titles and their
/// letters, the room of a caption, and the gaps between pictures and between groups of columns.
const BESIDE: f64 = 10.0;
const HEAD: f64 = 58.0;
const TITLE: f64 = 15.0;
const CAPTION: f64 = 22.0;
const GAP: f64 = 8.0;
const APART: f64 = 16.0;
/// Room for the scale below the pictures, and in it the scale: its length and height.
const FOOT: f64 = 70.0;
const BAR: [f64; 2] = [420.0, 14.0];
const STEPS: usize = 256;

impl Sheet {
    /// The edge of the pictures of a page of this width.
    pub fn edge_within(&self, width: f64) -> f64 {
        let apart = APART * (self.groups.len() - 1) as f64;
        (width - self.names() - apart) / self.columns.len() as f64 - GAP
    }

    fn names(&self) -> f64 {
        let lines = self.rows.iter().flat_map(|(name, _)| name.lines());
        let widest = lines.map(|line| text::width(line, LETTERS)).fold(0.0, f64::max);
        (2.0 * BESIDE + widest).ceil()
    }

    /// The sheet as a drawing.
    ///
    /// # Panics
    /// For a tile whose pixels are not a square, and for values without a scale.
    pub fn drawing(&self) -> Drawing {
        let (across, edge, names) = (self.edge + GAP, self.edge, self.names());
        let has_captions =
            self.rows.iter().flat_map(|row| &row.1).any(|tile| !tile.caption.is_empty());
        let down = edge + if has_captions { CAPTION } else { GAP };
        let group = |column: usize| {
            let ends = self.groups.iter().scan(0, |end, (count, _)| {
                *end += count;
                Some(*end)
            });
            ends.filter(|&end| end <= column).count()
        };
        let left = |i: usize| names + across * i as f64 + APART * group(i) as f64;
        let width = left(self.columns.len() - 1) + across;
        let foot = HEAD + down * self.rows.len() as f64;
        let height = foot + if self.scale.is_some() { FOOT } else { 0.0 };
        let mut drawing = Drawing::new([width, height]);
        let mut first = 0;
        for (count, heading) in &self.groups {
            let middle = 0.5 * (left(first) + left(first + count - 1) + edge);
            drawing.text([middle, 22.0], heading, TITLE, Anchor::Middle, BLACK);
            first += count;
        }
        for (i, heading) in self.columns.iter().enumerate() {
            let at = [left(i) + 0.5 * edge, HEAD - 10.0];
            drawing.text(at, heading, LETTERS, Anchor::Middle, BLACK);
        }
        for (row, (name, tiles)) in self.rows.iter().enumerate() {
            let top = HEAD + down * row as f64;
            for (i, line) in name.lines().enumerate() {
                let y = top + 0.5 * edge + (0.35 + 1.3 * i as f64) * LETTERS;
                drawing.text([names - BESIDE, y], line, LETTERS, Anchor::End, BLACK);
            }
            for (column, tile) in tiles.iter().enumerate() {
                let pixels = self.pixels(tile);
                let side = pixels.len().isqrt();
                assert_eq!(side * side, pixels.len(), "a square of pixels");
                drawing.image([left(column), top], [edge; 2], side, pixels);
                let at = [left(column) + 0.5 * edge, top + edge + 14.0];
                drawing.text(at, &tile.caption, NUMBERS, Anchor::Middle, BLACK);
            }
        }
        if let Some(scale) = &self.scale {
            let corner = [0.5 * (width - BAR[0]), foot + 12.0];
            draw_bar(&mut drawing, scale, corner, BAR, STEPS);
        }
        drawing
    }

    fn pixels(&self, tile: &Tile) -> Vec<Color> {
        let shown = |scale: &Axis, x: f64| match x.is_nan() {
            true => [255; 3],
            false => false_color(scale.fraction(x)),
        };
        match (&tile.content, &self.scale) {
            (Content::Colors(colors), _) => colors.clone(),
            (Content::Values(values), Some(scale)) => {
                values.iter().map(|&x| shown(scale, x)).collect()
            }
            (Content::Values(_), None) => panic!("numbers without a scale"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::png::decode;
    use super::*;

    const EDGE: f64 = 160.0;

    fn sheet(content: Content) -> Sheet {
        Sheet {
            groups: vec![(1, "differences".into())],
            columns: vec!["a form".into()],
            rows: vec![("γ = 3".into(), vec![Tile { content, caption: "RMSE 0".into() }])],
            scale: Some(Axis::log("radiance", 1e-4, 1.0)),
            edge: EDGE,
        }
    }

    /// The four pixels of the tile, as they are on the page.
    fn quarters(sheet: &Sheet) -> [[u8; 3]; 4] {
        let (pixels, width) = decode(&sheet.drawing().png().unwrap());
        [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(|[x, y]| {
            let at = [sheet.names() + x * EDGE, HEAD + y * EDGE].map(|x| (2.0 * x) as usize);
            pixels[at[1] * width + at[0]]
        })
    }

    #[test]
    fn pictures_keep_their_colours_and_values_get_those_of_the_scale() {
        let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [10, 20, 30]];
        assert_eq!(quarters(&sheet(Content::Colors(colors.into()))), colors);
        let values = sheet(Content::Values(vec![0.0, 1e-2, 1e3, f64::NAN]));
        let want = [0.0, 0.5, 1.0].map(false_color);
        assert_eq!(quarters(&values), [want[0], want[1], want[2], [255; 3]]);
    }

    #[test]
    #[should_panic = "a square of pixels"]
    fn pixels_that_are_no_square_are_refused() {
        sheet(Content::Values(vec![0.0; 3])).drawing();
    }

    #[test]
    fn words_stand_on_the_page_and_have_their_letters() {
        let drawn = sheet(Content::Values(vec![0.0; 4])).drawing().svg();
        let document = roxmltree::Document::parse(&drawn).unwrap();
        let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
        for word in ["differences", "a form", "γ = 3", "RMSE 0", "radiance"] {
            assert!(texts.contains(&word), "{word} in {texts:?}");
        }
        assert!(texts.iter().all(|text| text::has_all(text.trim())));
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("image")).count(), 2);
    }
}
