//! A page as SVG.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::canvas::{Anchor, At, Canvas, Shape};
use super::ink::{BLACK, Color, GRID, on_dark};
use super::{png, text};

/// Where a drawing stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// In a file of its own, on white.
    File,
    /// In an HTML page, light or dark.
    Html,
}

/// The page as a text in SVG 1.1, without references to anything outside it.
pub(super) fn write(canvas: &Canvas) -> String {
    let [width, height] = canvas.size;
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        text::FAMILIES
    );
    with_shapes(head, canvas, Place::File)
}

/// The page as an element of HTML: as wide as its place, in the fonts of the document, and with
/// colours for a light and for a dark one. `label` says what is seen to those who do not see it.
///
/// Ink is `--ink` and the grid `--line`, custom properties of the document; other colours are
/// `light-dark()`. A browser without these takes the attributes beside them: those on white.
pub(super) fn write_inline(canvas: &Canvas, label: &str) -> String {
    let [width, height] = canvas.size;
    let label = escaped(label).replace('"', "&quot;");
    let head = format!(
        "<svg class=\"plot\" role=\"img\" viewBox=\"0 0 {width} {height}\" \
         aria-label=\"{label}\">\n"
    );
    with_shapes(head, canvas, Place::Html)
}

fn with_shapes(head: String, canvas: &Canvas, place: Place) -> String {
    let mut out = head;
    for shape in &canvas.shapes {
        // Writing to a string does not fail.
        let _ = write_shape(&mut out, shape, place);
    }
    out + "</svg>\n"
}

/// The attributes of what fills a shape and what its outline has.
fn paint(fill: Option<Color>, stroke: Option<Color>, place: Place) -> String {
    let mut text = format!("fill=\"{}\"", fill.map_or("none".into(), hex));
    if let Some(color) = stroke {
        let _ = write!(text, " stroke=\"{}\"", hex(color));
    }
    if place == Place::Html {
        let styles = [("fill", fill), ("stroke", stroke)];
        let styles = styles.into_iter().filter_map(|(property, color)| Some((property, color?)));
        let styles = styles.map(|(property, color)| format!("{property}:{}", themed(color)));
        let _ = write!(text, " style=\"{}\"", styles.collect::<Vec<_>>().join(";"));
    }
    text
}

/// A colour of CSS that serves light paper and dark.
fn themed(color: Color) -> String {
    match color {
        BLACK => "var(--ink)".into(),
        GRID => "var(--line)".into(),
        _ => format!("light-dark({},{})", hex(color), hex(on_dark(color))),
    }
}

fn write_shape(out: &mut String, shape: &Shape, place: Place) -> std::fmt::Result {
    match shape {
        Shape::Line { points, color, width, dash } => {
            // A page has thousands of ticks: what says nothing of them is left out.
            let paint = paint(None, Some(*color), place);
            match points.len() {
                2 => write!(out, "<polyline {}", paint.trim_start_matches("fill=\"none\" "))?,
                _ => write!(out, "<polyline {paint} stroke-linejoin=\"round\"")?,
            }
            if *width != 1.0 {
                write!(out, " stroke-width=\"{width}\"")?;
            }
            let lengths: Vec<String> =
                dash.lengths().iter().map(|length| number(length * width)).collect();
            if !lengths.is_empty() {
                write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "))?;
            }
            writeln!(out, " points=\"{}\"/>", list(points))
        }
        Shape::Area { corners, color } => {
            let paint = paint(Some(*color), None, place);
            writeln!(out, "<polygon {paint} points=\"{}\"/>", list(corners))
        }
        Shape::Circle { center: [x, y], radius, color, filled } => {
            let paint = paint(filled.then_some(*color), Some(*color), place);
            let (x, y) = (number(*x), number(*y));
            writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {paint}/>")
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
            let (paint, text) = (paint(Some(*color), None, place), escaped(text));
            writeln!(
                out,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
                 {paint}{turn}>{text}</text>"
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
    use super::super::ink::Dash;
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

    #[test]
    fn in_a_page_each_colour_has_one_for_dark_paper_and_ink_is_that_of_the_page() {
        let mut canvas = Canvas { size: [20.0, 10.0], shapes: Vec::new() };
        canvas.text([1.0, 2.0], "<b>", 10.0, Anchor::End, BLACK);
        canvas.line(vec![[0.0, 0.0], [1.0, 1.0]], GRID, 1.0, Dash::Solid);
        canvas.line(vec![[0.0, 0.0], [1.0, 1.0]], [0, 114, 178], 1.0, Dash::Dotted);
        let circle =
            Shape::Circle { center: [1.0; 2], radius: 1.0, color: [0, 114, 178], filled: true };
        canvas.shapes.push(circle);
        let drawn = write_inline(&canvas, "a \"quoted\" & <label>");
        let document = roxmltree::Document::parse(&drawn).unwrap();
        let root = document.root_element();
        assert_eq!(root.attribute("aria-label"), Some("a \"quoted\" & <label>"));
        assert_eq!(root.attribute("role"), Some("img"));
        assert_eq!([root.attribute("width"), root.attribute("font-family")], [None, None]);
        let styles: Vec<&str> = root
            .children()
            .filter(roxmltree::Node::is_element)
            .map(|node| node.attribute("style").unwrap())
            .collect();
        let dark = hex(on_dark([0, 114, 178]));
        let blue = format!("light-dark(#0072b2,{dark})");
        let circle = format!("fill:{blue};stroke:{blue}");
        assert_eq!(styles[..2], ["fill:var(--ink)", "stroke:var(--line)"]);
        assert_eq!(styles[2..], [format!("stroke:{blue}"), circle]);
        // What stands in a file knows nothing of a page.
        let file = write(&canvas);
        assert!(!file.contains("style") && !file.contains("class"), "{file}");
    }
}
