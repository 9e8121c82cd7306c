//! A drawing as SVG.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::drawing::{Anchor, At, Drawing, Shape};
use super::ink::{BLACK, Color, GRID, on_dark};
use super::{png, text};

const LINES: &str = "fill=\"none\" stroke-linejoin=\"round\"";

impl Drawing {
    /// As SVG 1.1 on white, without references to anything outside it.
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let [wide, high] = self.size.map(|x| number(x * self.zoom));
        let head = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{high}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{}\" {LINES}>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
            text::FAMILIES
        );
        self.with_shapes(head, |property, color| format!("{property}=\"{}\"", hex(color)))
    }

    /// As an element of an HTML page, of class `plot`: as wide as its container, in the page's
    /// fonts, with colours for light and dark pages; `label` is for screen readers.
    ///
    /// Black is `--ink` and the grid `--line`, custom properties of the page; other colours are
    /// `light-dark()`. A browser without these takes the attributes, whose colours are those on
    /// white.
    pub fn inline_svg(&self, label: &str) -> String {
        let [width, height] = self.size;
        let label = escaped(label).replace('"', "&quot;");
        let head = format!(
            "<svg class=\"plot\" role=\"img\" viewBox=\"0 0 {width} {height}\" {LINES} \
             aria-label=\"{label}\">\n"
        );
        self.with_shapes(head, |property, color| {
            let themed = match color {
                BLACK => "var(--ink)".into(),
                GRID => "var(--line)".into(),
                _ => format!("light-dark({},{})", hex(color), hex(on_dark(color))),
            };
            format!("{property}=\"{}\" style=\"{property}:{themed}\"", hex(color))
        })
    }

    /// Writes the shapes; `paint` writes the attributes of a property that is a colour.
    fn with_shapes(&self, head: String, paint: impl Fn(&str, Color) -> String) -> String {
        let mut out = head;
        for shape in &self.shapes {
            write_shape(&mut out, shape, &paint).expect("memory");
        }
        out + "</svg>\n"
    }
}

fn write_shape(
    out: &mut String,
    shape: &Shape,
    paint: impl Fn(&str, Color) -> String,
) -> std::fmt::Result {
    match shape {
        Shape::Line { points, color, width, dash } => {
            write!(out, "<polyline {}", paint("stroke", *color))?;
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
            writeln!(out, "<polygon {} points=\"{}\"/>", paint("fill", *color), list(corners))
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
            let (paint, text) = (paint("fill", *color), escaped(text));
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
        let mut drawing = Drawing::new([20.0, 10.0]);
        drawing.text([1.0, 2.345], "σ < 1 & γ > 2", 10.0, Anchor::End, [255, 0, 16]);
        let drawn = drawing.svg();
        assert!(drawn.contains(">σ &lt; 1 &amp; γ &gt; 2</text>"), "{drawn}");
        assert!(drawn.contains("y=\"2.35\"") && drawn.contains("#ff0010"), "{drawn}");
        assert!(roxmltree::Document::parse(&drawn).is_ok());
    }

    #[test]
    fn in_a_page_each_colour_has_one_for_dark_paper_and_ink_is_that_of_the_page() {
        let mut drawing = Drawing::new([20.0, 10.0]);
        drawing.text([1.0, 2.0], "<b>", 10.0, Anchor::End, BLACK);
        drawing.line(vec![[0.0, 0.0], [1.0, 1.0]], GRID, 1.0, Dash::Solid);
        drawing.line(vec![[0.0, 0.0], [1.0, 1.0]], [0, 114, 178], 1.0, Dash::Dotted);
        drawing.area(vec![[1.0; 2]], [0, 114, 178]);
        let drawn = drawing.inline_svg("a \"quoted\" & <label>");
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
        let blue = format!("light-dark(#0072b2,{})", hex(on_dark([0, 114, 178])));
        assert_eq!(styles[..2], ["fill:var(--ink)", "stroke:var(--line)"]);
        assert_eq!(styles[2..], [format!("stroke:{blue}"), format!("fill:{blue}")]);
        // A file has neither styles nor classes of a page.
        let file = drawing.svg();
        assert!(!file.contains("style") && !file.contains("class"), "{file}");
    }
}
