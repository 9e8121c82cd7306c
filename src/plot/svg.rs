//! A page as SVG.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::canvas::{Anchor, At, Canvas, Shape};
use super::ink::Color;
use super::{png, text};

/// The page as a text in SVG 1.1, without references to anything outside it.
pub(super) fn write(canvas: &Canvas) -> String {
    let [width, height] = canvas.size;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        text::FAMILIES
    );
    for shape in &canvas.shapes {
        // Writing to a string does not fail.
        let _ = write_shape(&mut out, shape);
    }
    out + "</svg>\n"
}

fn write_shape(out: &mut String, shape: &Shape) -> std::fmt::Result {
    match shape {
        Shape::Line { points, color, width, dash } => {
            write!(
                out,
                "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" \
                 stroke-linejoin=\"round\"",
                hex(*color)
            )?;
            let lengths: Vec<String> =
                dash.lengths().iter().map(|length| number(length * width)).collect();
            if !lengths.is_empty() {
                write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "))?;
            }
            writeln!(out, " points=\"{}\"/>", list(points))
        }
        Shape::Area { corners, color } => {
            writeln!(out, "<polygon fill=\"{}\" points=\"{}\"/>", hex(*color), list(corners))
        }
        Shape::Circle { center: [x, y], radius, color, filled } => {
            let color = hex(*color);
            let fill = if *filled { &color } else { "none" };
            let (x, y) = (number(*x), number(*y));
            writeln!(
                out,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{color}\"/>"
            )
        }
        Shape::Image { corner: [x, y], size: [width, height], columns, pixels } => {
            let [x, y, width, height] = [x, y, width, height].map(|x| number(*x));
            writeln!(
                out,
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
                 preserveAspectRatio=\"none\" style=\"image-rendering: pixelated\" \
                 href=\"data:image/png;base64,{}\"/>",
                STANDARD.encode(png::of_pixels(pixels, *columns))
            )
        }
        Shape::Text { at: [x, y], text, size, anchor, turned, color } => {
            let (x, y) = (number(*x), number(*y));
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn =
                if *turned { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
            let (color, text) = (hex(*color), escaped(text));
            writeln!(
                out,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                 fill=\"{color}\"{turn}>{text}</text>"
            )
        }
    }
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// To a hundredth of a pixel, without superfluous zeros.
fn number(x: f64) -> String {
    // Adding 0 turns −0 into 0.
    format!("{}", (x * 100.0).round() / 100.0 + 0.0)
}

fn list(points: &[At]) -> String {
    let pairs: Vec<String> =
        points.iter().map(|&[x, y]| format!("{},{}", number(x), number(y))).collect();
    pairs.join(" ")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_with_a_meaning_in_xml_are_escaped() {
        let mut canvas = Canvas { size: [20.0, 10.0], shapes: Vec::new() };
        canvas.text([1.0, 2.345], "σ < 1 & γ > 2", 10.0, Anchor::End, [255, 0, 16]);
        let drawn = write(&canvas);
        assert!(drawn.contains(">σ &lt; 1 &amp; γ &gt; 2</text>"), "{drawn}");
        assert!(drawn.contains("y=\"2.35\"") && drawn.contains("#ff0010"), "{drawn}");
        assert!(roxmltree::Document::parse(&drawn).is_ok());
    }
}
