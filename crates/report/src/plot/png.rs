//! A page as PNG.

use std::collections::BTreeSet;
use std::io::Cursor;

use ab_glyph::OutlineCurve;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use tiny_skia::{
    ColorU8, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash,
    Transform,
};

use super::canvas::{Anchor, At, Canvas, Shape};
use super::ink::Color;
use super::{PlotError, text};

/// Pixels of the image along one of the page.
pub(super) const SCALE: u32 = 2;

/// So many colours are few.
const FEW: usize = 32;

/// The page as an RGB image, [`SCALE`] times its size.
///
/// # Errors
/// [`PlotError::Drawing`] for a page without area, or too large.
pub(super) fn write(canvas: &Canvas) -> Result<Vec<u8>, PlotError> {
    let [width, height] = canvas.size.map(|x| (x * f64::from(SCALE)).ceil() as u32);
    let mut pixmap = Pixmap::new(width, height)
        .ok_or_else(|| PlotError::Drawing(format!("an image of {width} by {height} pixels")))?;
    pixmap.fill(tiny_skia::Color::WHITE);
    for shape in &canvas.shapes {
        draw(&mut pixmap, shape);
    }
    // Nothing is transparent, for the paper is not.
    let rgb: Vec<u8> = pixmap.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    encode(&rgb, [width, height]).map_err(|why| PlotError::Drawing(why.to_string()))
}

fn encode(rgb: &[u8], [width, height]: [u32; 2]) -> ImageResult<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    let encoder = if has_few_colors(rgb) {
        // Differences of neighbours, as other filters take them, have more values than a few
        // colours.
        PngEncoder::new_with_quality(&mut file, CompressionType::Best, FilterType::NoFilter)
    } else {
        PngEncoder::new(&mut file)
    };
    encoder.write_image(rgb, width, height, ExtendedColorType::Rgb8)?;
    Ok(file.into_inner())
}

/// Whether an image has at most [`FEW`] colours.
fn has_few_colors(rgb: &[u8]) -> bool {
    let mut colors = BTreeSet::new();
    rgb.chunks_exact(3).all(|color| {
        colors.insert(color);
        colors.len() <= FEW
    })
}

/// An image of whole lines of pixels, as a file by itself.
pub(super) fn of_pixels(pixels: &[Color], columns: usize) -> Vec<u8> {
    let size = [columns, pixels.len() / columns].map(|edge| edge as u32);
    encode(pixels.as_flattened(), size).expect("whole lines, in memory")
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
            if let Some(path) = polygon(points, false) {
                pixmap.stroke_path(&path, &paint(*color), &stroke, page, None);
            }
        }
        Shape::Area { corners, color } => {
            if let Some(path) = polygon(corners, true) {
                pixmap.fill_path(&path, &paint(*color), FillRule::Winding, page, None);
            }
        }
        Shape::Circle { center: [x, y], radius, color, filled } => {
            let Some(path) = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32) else {
                return;
            };
            if *filled {
                pixmap.fill_path(&path, &paint(*color), FillRule::Winding, page, None);
            }
            pixmap.stroke_path(&path, &paint(*color), &Stroke::default(), page, None);
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
            // Without a filter, pixels stay what they are.
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

fn polygon(points: &[At], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, &[x, y]) in points.iter().enumerate() {
        if i == 0 {
            path.move_to(x as f32, y as f32);
        } else {
            path.line_to(x as f32, y as f32);
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

/// The outlines of a text that starts at the origin.
fn letters(text: &str, size: f64) -> Option<Path> {
    let (em, letters) = text::outlines(text);
    let mut path = PathBuilder::new();
    for (start, curves) in letters {
        let scale = (size / em) as f32;
        let place = |p: ab_glyph::Point| [(start * size) as f32 + p.x * scale, -p.y * scale];
        let mut last = None;
        for curve in curves {
            let (from, to) = match &curve {
                OutlineCurve::Line(a, b)
                | OutlineCurve::Quad(a, _, b)
                | OutlineCurve::Cubic(a, _, _, b) => (place(*a), place(*b)),
            };
            if last != Some(from) {
                path.move_to(from[0], from[1]);
            }
            match curve {
                OutlineCurve::Line(..) => path.line_to(to[0], to[1]),
                OutlineCurve::Quad(_, c, _) => {
                    let c = place(c);
                    path.quad_to(c[0], c[1], to[0], to[1]);
                }
                OutlineCurve::Cubic(_, c, d, _) => {
                    let (c, d) = (place(c), place(d));
                    path.cubic_to(c[0], c[1], d[0], d[1], to[0], to[1]);
                }
            }
            last = Some(to);
        }
    }
    path.finish()
}
