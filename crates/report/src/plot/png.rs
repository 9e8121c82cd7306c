//! A drawing as PNG.

use png::{ColorType, Compression, EncodingError, Filter};
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
        let png = encode(&rgb, [width, height], Filter::Adaptive);
        png.map_err(|why| PlotError::Drawing(why.to_string()))
    }
}

fn encode(rgb: &[u8], [width, height]: [u32; 2], filter: Filter) -> Result<Vec<u8>, EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_compression(Compression::High);
    encoder.set_filter(filter);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(file)
}

/// The pixels of a PNG that was written here, and how many stand in a line.
#[cfg(test)]
pub(super) fn decode(file: &[u8]) -> (Vec<Color>, usize) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut rgb).unwrap();
    assert_eq!(frame.color_type, ColorType::Rgb);
    (rgb.as_chunks().0.to_vec(), frame.width as usize)
}

/// An image of whole lines. Most have few colours, from which filters would make more values.
pub(super) fn of_pixels(pixels: &[Color], columns: usize) -> Vec<u8> {
    let size = [columns, pixels.len() / columns].map(|edge| edge as u32);
    encode(pixels.as_flattened(), size, Filter::NoFilter).expect("whole lines, in memory")
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
        let place = |[x, y]: [f32; 2]| [(start * size) as f32 + x * scale, -y * scale];
        let mut last = None;
        for curve in curves {
            let [from, bend, to] = curve.map(place);
            if last != Some(from) {
                path.move_to(from[0], from[1]);
            }
            path.quad_to(bend[0], bend[1], to[0], to[1]);
            last = Some(to);
        }
    }
    path.finish()
}
