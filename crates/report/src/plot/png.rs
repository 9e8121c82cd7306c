//! A drawing as PNG.

use std::io::Cursor;

use ab_glyph::OutlineCurve;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use tiny_skia::{
    ColorU8, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash,
    Transform,
};

use super::drawing::{Anchor, At, Drawing, Shape};
use super::ink::Color;
use super::{PlotError, text};

pub(super) const SCALE: u32 = 2;

impl Drawing {
    /// As PNG, with twice as many pixels along each edge as the page.
    ///
    /// # Errors
    /// [`PlotError::Drawing`] for a figure without panels, or larger than memory.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        let [width, height] = self.size.map(|x| (x * f64::from(SCALE)).ceil() as u32);
        let mut pixmap = Pixmap::new(width, height)
            .ok_or_else(|| PlotError::Drawing(format!("an image of {width} by {height} pixels")))?;
        pixmap.fill(tiny_skia::Color::WHITE);
        for shape in &self.shapes {
            draw(&mut pixmap, shape);
        }
        // Alpha is dropped: the white background is opaque.
        let rgb: Vec<u8> = pixmap.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        let png = encode(&rgb, [width, height], FilterType::Adaptive);
        png.map_err(|why| PlotError::Drawing(why.to_string()))
    }
}

fn encode(rgb: &[u8], [width, height]: [u32; 2], filter: FilterType) -> ImageResult<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    PngEncoder::new_with_quality(&mut file, CompressionType::Best, filter).write_image(
        rgb,
        width,
        height,
        ExtendedColorType::Rgb8,
    )?;
    Ok(file.into_inner())
}

/// An image of whole lines. Most have few colours, from which filters would make more values.
pub(super) fn of_pixels(pixels: &[Color], columns: usize) -> Vec<u8> {
    let size = [columns, pixels.len() / columns].map(|edge| edge as u32);
    encode(pixels.as_flattened(), size, FilterType::NoFilter).expect("whole lines, in memory")
}

fn draw(pixmap: &mut Pixmap, shape: &Shape) {
    let page = Transform::from_scale(SCALE as f32, SCALE as f32);
    match shape {
        Shape::Line { points, color, width, dash } => {
            let lengths = dash.lengths().iter().map(|length| (length * width) as f32).collect();
            let stroke = Stroke {
                width: *width as f32,
                line_join: LineJoin::Round,
                dash: StrokeDash::new(lengths, 0.0),
                ..Stroke::default()
            };
            // A line of one point has no path, and nothing is drawn.
            if let Some(path) = through(points) {
                pixmap.stroke_path(&path, &paint(*color), &stroke, page, None);
            }
        }
        Shape::Area { corners, color } => {
            if let Some(path) = through(corners) {
                pixmap.fill_path(&path, &paint(*color), FillRule::Winding, page, None);
            }
        }
        Shape::Image { corner: [x, y], size: [width, height], columns, pixels } => {
            let lines = pixels.len() / columns;
            let Some(mut picture) = Pixmap::new(*columns as u32, lines as u32) else {
                return;
            };
            for (to, &[r, g, b]) in picture.pixels_mut().iter_mut().zip(pixels) {
                *to = ColorU8::from_rgba(r, g, b, 255).premultiply();
            }
            let [across, down] = [width / *columns as f64, height / lines as f64];
            let place =
                page.pre_translate(*x as f32, *y as f32).pre_scale(across as f32, down as f32);
            // The default paint has no filter, so that pixels keep their colours.
            pixmap.draw_pixmap(0, 0, picture.as_ref(), &PixmapPaint::default(), place, None);
        }
        Shape::Text { at: [x, y], text, size, anchor, turned, color } => {
            let length = text::width(text, *size);
            let back = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5 * length,
                Anchor::End => length,
            };
            let place = page
                .pre_translate(*x as f32, *y as f32)
                .pre_concat(Transform::from_rotate(if *turned { -90.0 } else { 0.0 }))
                .pre_translate(-back as f32, 0.0);
            if let Some(path) = letters(text, *size) {
                pixmap.fill_path(&path, &paint(*color), FillRule::Winding, place, None);
            }
        }
    }
}

fn paint([r, g, b]: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn through(points: &[At]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, point) in points.iter().enumerate() {
        let [x, y] = point.map(|x| x as f32);
        if i == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
    path.finish()
}

/// The outlines of a text that starts at the origin.
fn letters(text: &str, size: f64) -> Option<Path> {
    let (em, letters) = text::outlines(text);
    let scale = (size / em) as f32;
    let mut path = PathBuilder::new();
    for (start, curves) in letters {
        let place = |p: ab_glyph::Point| [(start * size) as f32 + p.x * scale, -p.y * scale];
        let mut last = None;
        for curve in curves {
            let (from, bend, to) = match curve {
                OutlineCurve::Line(a, b) => (place(a), place(a), place(b)),
                OutlineCurve::Quad(a, bend, b) => (place(a), place(bend), place(b)),
                OutlineCurve::Cubic(..) => unreachable!("TrueType outlines are quadratic"),
            };
            if last != Some(from) {
                path.move_to(from[0], from[1]);
            }
            // A line is a quadratic curve with its control point at its start.
            path.quad_to(bend[0], bend[1], to[0], to[1]);
            last = Some(to);
        }
    }
    path.finish()
}
