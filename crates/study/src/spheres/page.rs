//! Where spheres and words stand on a page, and how radiance becomes a picture.

use std::error::Error;
use std::path::Path;

use ab_glyph::{Font, FontRef, ScaleFont, point};
use glam::Vec3;
use image::{Rgb, RgbImage};

use crate::spheres::figures::Sheet;

/// In edges of a sphere's square.
const NAMES: f32 = 0.95;
const GAP: f32 = 0.12;
const HEAD: f32 = 0.5;
const EDGE: f32 = 0.06;
const TEXT: f32 = 0.145;
const SMALL: f32 = 0.115;
/// Of a square, left white beside the next.
const MARGIN: f32 = 0.03;

/// Of what is shown with a shoulder.
const EXPOSURE: f32 = 0.7;

/// Where everything stands, in pixels.
pub(crate) struct Layout {
    /// The edge of a sphere's square.
    pub(crate) cell: usize,
    width: usize,
    height: usize,
    /// The left edge of each column.
    columns: Vec<usize>,
    /// The upper edge of each row.
    rows: Vec<usize>,
}

impl Layout {
    pub(crate) fn new(sheet: &Sheet, width: usize) -> Self {
        let gaps = sheet.groups.len() - 1;
        let across = NAMES + sheet.columns.len() as f32 + GAP * gaps as f32 + EDGE;
        let pitch = (width as f32 / across).floor();
        // What rounding leaves over goes to the names.
        let mut x = width as f32 - pitch * EDGE;
        let mut columns = Vec::new();
        for (count, _) in sheet.groups.iter().rev() {
            for _ in 0..*count {
                x -= pitch;
                columns.push(x as usize);
            }
            x -= pitch * GAP;
        }
        columns.reverse();
        let line = |row: usize| (pitch * (HEAD + row as f32)) as usize;
        Self {
            cell: (pitch * (1.0 - MARGIN)) as usize,
            width,
            height: line(sheet.rows.len()),
            columns,
            rows: (0..sheet.rows.len()).map(line).collect(),
        }
    }

    fn corner(&self, row: usize, column: usize) -> [usize; 2] {
        [self.columns[column], self.rows[row]]
    }
}

/// The squares of a sheet as they are rendered: radiance by row, column and pixel.
pub(crate) struct Page<'a> {
    pub(crate) sheet: &'a Sheet,
    pub(crate) layout: Layout,
    /// One line of pixels after the other, of one square after the other, by rows of squares.
    pub(crate) lines: Vec<Vec<Vec3>>,
}

impl Page<'_> {
    /// Pixels of all squares, with their places on the page.
    fn pixels(&self) -> impl Iterator<Item = ([usize; 2], Vec3)> {
        let (cell, columns) = (self.layout.cell, self.sheet.columns.len());
        self.lines.iter().enumerate().flat_map(move |(i, line)| {
            let (square, y) = (i / cell, i % cell);
            let [left, top] = self.layout.corner(square / columns, square % columns);
            line.iter().enumerate().map(move |(x, radiance)| ([left + x, top + y], *radiance))
        })
    }

    /// Linear radiance, without words; transparent beside the spheres' squares.
    pub(crate) fn write_exr(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let Layout { width, height, .. } = self.layout;
        let mut all = vec![(0.0, 0.0, 0.0, 0.0); width * height];
        for ([x, y], c) in self.pixels() {
            all[y * width + x] = (c.x, c.y, c.z, 1.0);
        }
        Ok(exr::prelude::write_rgba_file(path, width, height, |x, y| all[y * width + x])?)
    }

    /// What is shown, with words, on white.
    pub(crate) fn write_png(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let (width, height) = (self.layout.width as u32, self.layout.height as u32);
        let mut picture = RgbImage::from_pixel(width, height, Rgb([255; 3]));
        for ([x, y], radiance) in self.pixels() {
            picture.put_pixel(x as u32, y as u32, display(radiance, self.sheet.is_linear));
        }
        self.write_words(&mut picture)?;
        Ok(picture.save(path)?)
    }

    fn write_words(&self, picture: &mut RgbImage) -> Result<(), Box<dyn Error>> {
        let (layout, sheet) = (&self.layout, self.sheet);
        let cell = layout.cell as f32;
        let pen = Pen::new()?;
        let middle = |column: usize| layout.columns[column] as f32 + cell / 2.0;
        for (column, text) in sheet.columns.iter().enumerate() {
            pen.write(picture, text, TEXT * cell, [middle(column), 0.42 * cell], 0.5);
        }
        let mut first = 0;
        for (count, text) in &sheet.groups {
            let x = (middle(first) + middle(first + count - 1)) / 2.0;
            pen.write(picture, text, TEXT * cell, [x, 0.19 * cell], 0.5);
            first += count;
        }
        let right = layout.columns[0] as f32 - 0.08 * cell;
        for (row, what) in sheet.rows.iter().enumerate() {
            let y = layout.rows[row] as f32 + cell / 2.0;
            let lift = if what.detail.is_empty() { -0.05 } else { 0.02 };
            pen.write(picture, &what.name, TEXT * cell, [right, y - lift * cell], 1.0);
            pen.write(picture, &what.detail, SMALL * cell, [right, y + 0.15 * cell], 1.0);
            for (column, sphere) in what.cells.iter().enumerate() {
                let at = [middle(column), y + 0.49 * cell];
                pen.write(picture, &sphere.caption, SMALL * cell, at, 0.5);
            }
        }
        Ok(())
    }
}

/// Steps of 1/255 by which an error changes what is shown.
pub(crate) fn steps(radiance: Vec3, error: Vec3, is_linear: bool) -> f32 {
    let [a, b] = [radiance, radiance + error].map(|radiance| encoded(radiance, is_linear));
    255.0 * (b - a).max_element()
}

/// Eight bits a channel.
fn display(radiance: Vec3, is_linear: bool) -> Rgb<u8> {
    Rgb((255.0 * encoded(radiance, is_linear)).to_array().map(|x| x.round() as u8))
}

/// Encoded as sRGB.
fn encoded(radiance: Vec3, is_linear: bool) -> Vec3 {
    let encode = |x: f32| {
        let x = if is_linear { x } else { shoulder(EXPOSURE * x) };
        if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    Vec3::from(radiance.to_array().map(encode))
}

/// Keeps what is brighter than white apart: the identity below a half, then a curve to 1.
fn shoulder(x: f32) -> f32 {
    if x <= 0.5 { x } else { 1.0 - 0.5 * (1.0 - 2.0 * x).exp() }
}

/// Writes in a serif, and Greek letters as symbols, in italics.
struct Pen {
    upright: FontRef<'static>,
    italic: FontRef<'static>,
}

impl Pen {
    fn new() -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            upright: FontRef::try_from_slice(dejavu::serif::regular())?,
            italic: FontRef::try_from_slice(dejavu::serif::italic())?,
        })
    }

    fn font(&self, letter: char) -> &FontRef<'static> {
        if ('α'..='ω').contains(&letter) { &self.italic } else { &self.upright }
    }

    /// A line of black text on a baseline at y; x is its left end, middle or right end for an
    /// `align` of 0, 0.5 or 1.
    fn write(&self, picture: &mut RgbImage, text: &str, size: f32, [x, y]: [f32; 2], align: f32) {
        let advance = |letter| {
            let font = self.font(letter).as_scaled(size);
            font.h_advance(font.glyph_id(letter))
        };
        let mut x = x - align * text.chars().map(advance).sum::<f32>();
        for letter in text.chars() {
            let font = self.font(letter);
            let glyph = font.glyph_id(letter).with_scale_and_position(size, point(x, y));
            x += advance(letter);
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, coverage| {
                let (px, py) = (corner.x as i64 + i64::from(dx), corner.y as i64 + i64::from(dy));
                let pixel = u32::try_from(px).ok().zip(u32::try_from(py).ok());
                if let Some(pixel) = pixel.and_then(|(x, y)| picture.get_pixel_mut_checked(x, y)) {
                    pixel.0 = pixel.0.map(|ink| (f32::from(ink) * (1.0 - coverage)) as u8);
                }
            });
        }
    }
}
