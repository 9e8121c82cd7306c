//! Pictures in rows and columns, in their own colours or in false ones, with a scale of these.

use super::canvas::{Anchor, Canvas, Shape};
use super::ink::{BLACK, Color, false_color};
use super::{Axis, PlotError, heat, png, svg};

/// What a picture shows, line by line from its upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Red, green and blue of sRGB.
    Colors(Vec<[u8; 3]>),
    /// Numbers, in false colours by the scale of the sheet. Beyond its ends they have those of its
    /// ends, and NaN is white.
    Values(Vec<f64>),
}

/// A square picture with a line below it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Pixels along an edge.
    pub edge: usize,
    /// As many pixels as its square has.
    pub content: Content,
    /// Below it.
    pub caption: String,
}

/// A sheet of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Above all.
    pub title: String,
    /// Headings of the columns.
    pub columns: Vec<String>,
    /// Rows with their names, a tile for each column.
    pub rows: Vec<(String, Vec<Tile>)>,
    /// What false colours mean.
    pub scale: Axis,
}

/// Sizes in pixels of the page: a picture, the room of a row's name, of the titles and of a
/// caption, and the gap between pictures.
const TILE: f64 = 160.0;
const NAME: f64 = 84.0;
const HEAD: f64 = 58.0;
const CAPTION: f64 = 22.0;
const GAP: f64 = 8.0;
/// Room below the pictures, and in it the scale: its length and height.
const FOOT: f64 = 70.0;
const BAR: [f64; 2] = [420.0, 14.0];
/// Colours of the scale.
const STEPS: usize = 256;

const TITLE: f64 = 15.0;
const LETTERS: f64 = 12.0;
const NUMBERS: f64 = 11.0;

impl Sheet {
    /// As SVG, without references to anything outside it.
    ///
    /// # Errors
    /// [`PlotError::Drawing`] for a tile whose pixels are not a square.
    pub fn svg(&self) -> Result<String, PlotError> {
        Ok(svg::write(&self.page()?))
    }

    /// As PNG, with two pixels along each of the page.
    ///
    /// # Errors
    /// As [`svg`](Self::svg).
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        png::write(&self.page()?)
    }

    fn page(&self) -> Result<Canvas, PlotError> {
        let (across, down) = (TILE + GAP, TILE + CAPTION);
        let width = NAME + across * self.columns.len() as f64;
        let foot = HEAD + down * self.rows.len() as f64;
        let mut canvas = Canvas { size: [width, foot + FOOT], shapes: Vec::new() };
        canvas.text([0.5 * width, 22.0], &self.title, TITLE, Anchor::Middle, BLACK);
        let left = |column: usize| NAME + across * column as f64;
        for (i, heading) in self.columns.iter().enumerate() {
            let at = [left(i) + 0.5 * TILE, HEAD - 10.0];
            canvas.text(at, heading, LETTERS, Anchor::Middle, BLACK);
        }
        for (row, (name, tiles)) in self.rows.iter().enumerate() {
            let top = HEAD + down * row as f64;
            let at = [NAME - 10.0, top + 0.5 * TILE + 0.35 * LETTERS];
            canvas.text(at, name, LETTERS, Anchor::End, BLACK);
            for (column, tile) in tiles.iter().enumerate() {
                let corner = [left(column), top];
                canvas.shapes.push(self.image(tile, corner)?);
                let at = [corner[0] + 0.5 * TILE, top + TILE + 14.0];
                canvas.text(at, &tile.caption, NUMBERS, Anchor::Middle, BLACK);
            }
        }
        let corner = [0.5 * (width - BAR[0]), foot + 12.0];
        heat::bar(&mut canvas, &self.scale, corner, BAR, STEPS);
        Ok(canvas)
    }

    fn image(&self, tile: &Tile, corner: [f64; 2]) -> Result<Shape, PlotError> {
        let pixels: Vec<Color> = match &tile.content {
            Content::Colors(colors) => colors.clone(),
            Content::Values(values) => values
                .iter()
                .map(|&x| match x.is_nan() {
                    true => [255; 3],
                    false => false_color(self.scale.fraction(x)),
                })
                .collect(),
        };
        let edge = tile.edge;
        if edge == 0 || pixels.len() != edge * edge {
            let why = format!("{} pixels for a picture of {edge} by {edge}", pixels.len());
            return Err(PlotError::Drawing(why));
        }
        Ok(Shape::Image { corner, size: [TILE; 2], columns: edge, pixels })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::text;

    fn sheet(content: Content) -> Sheet {
        let tile = Tile { edge: 2, content, caption: "RMSE 0".into() };
        Sheet {
            title: "differences".into(),
            columns: vec!["a form".into()],
            rows: vec![("γ = 3".into(), vec![tile])],
            scale: Axis::log("radiance", 1e-4, 1.0),
        }
    }

    fn decoded(sheet: &Sheet) -> image::RgbImage {
        image::load_from_memory(&sheet.png().unwrap()).unwrap().to_rgb8()
    }

    /// The four pixels of the tile, as they are on the page.
    fn quarters(sheet: &Sheet) -> [[u8; 3]; 4] {
        let page = decoded(sheet);
        [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]].map(|[x, y]| {
            let at = [NAME + x * TILE, HEAD + y * TILE].map(|x| (2.0 * x) as u32);
            page.get_pixel(at[0], at[1]).0
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
    fn pixels_that_are_no_square_are_refused() {
        let wrong = sheet(Content::Values(vec![0.0; 3]));
        assert!(wrong.png().unwrap_err().to_string().contains("3 pixels"));
        assert!(wrong.svg().is_err());
    }

    #[test]
    fn words_stand_on_the_page_and_have_their_letters() {
        let drawn = sheet(Content::Values(vec![0.0; 4])).svg().unwrap();
        let document = roxmltree::Document::parse(&drawn).unwrap();
        let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
        for word in ["differences", "a form", "γ = 3", "RMSE 0", "radiance"] {
            assert!(texts.contains(&word), "{word} in {texts:?}");
        }
        assert!(texts.iter().all(|text| text::has_all(text.trim())));
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("image")).count(), 2);
    }
}
