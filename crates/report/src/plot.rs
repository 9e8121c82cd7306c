//! Figures of the literature as data, drawn as SVG and PNG: pure functions, without files or fonts
//! of the system.

mod axis;
mod bars;
mod clip;
mod drawing;
mod figures;
mod heat;
mod ink;
mod label;
mod layout;
mod panel;
mod png;
mod sheet;
mod svg;
mod text;

pub use axis::Axis;
pub use bars::{Bar, Bars};
pub use drawing::Drawing;
pub use figures::{FIGURES, Listed, figure};
pub use heat::{HeatMap, bar};
pub use ink::{Dash, Key};
pub use sheet::{Content, Sheet, Tile};

/// A curve with its name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What the curve shows; this sets its colour.
    pub key: Key,
    /// Name; the legend leaves out a curve without one.
    pub name: String,
    /// How the line is drawn.
    pub dash: Dash,
    /// (x, y), x ascending; a point with NaN interrupts it.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A curve with the dash that follows from its key.
    pub fn new(
        key: Key,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().collect();
        Self { key, name: name.into(), dash: key.dash(), points }
    }

    /// The same curve with this dash.
    #[must_use]
    pub fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }
}

/// A point. Those of a panel that have names are numbered from left to right, and listed beneath.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What the point shows; this sets its colour.
    pub key: Key,
    /// Name; a point without one has no number.
    pub name: String,
    /// What all points with its symbol and colour are, for the legend; it leaves out "".
    pub group: String,
    /// (x, y), inside the panel.
    pub at: (f64, f64),
    /// How it is drawn.
    pub symbol: Symbol,
}

/// How a point is drawn; symbols are told apart without colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// A filled circle.
    Dot,
    /// A circle.
    Ring,
    /// A filled square.
    Square,
    /// A square that is not filled.
    Frame,
}

/// One coordinate system. A curve that leaves its range is interrupted there, and a triangle of the
/// curve's colour at the edge points outwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// The axis along x.
    pub x: Axis,
    /// The axis along y.
    pub y: Axis,
    /// Curves.
    pub curves: Vec<Curve>,
    /// Labelled points.
    pub marks: Vec<Mark>,
}

impl Panel {
    /// A panel of curves.
    pub fn new(
        title: impl Into<String>,
        x: Axis,
        y: Axis,
        curves: impl IntoIterator<Item = Curve>,
    ) -> Self {
        let curves = curves.into_iter().collect();
        Self { title: title.into(), x, y, curves, marks: Vec::new() }
    }

    /// A point as fractions of the panel, (0, 0) at the left lower corner, (1, 1) at the right
    /// upper.
    fn place(&self, (x, y): (f64, f64)) -> [f64; 2] {
        [self.x.fraction(x), self.y.fraction(y)]
    }
}

/// Panels in rows. Rows share a legend if it names what one of them shows; it is beneath them, or
/// above where there are points with names.
///
/// Letters have one size whatever the size of a panel, so that the narrower a figure is, the larger
/// they are where it is shown as wide as a page or a phone.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels in a row.
    pub columns: usize,
    /// Width and height of a panel with its numbers and labels, in pixels of the page.
    pub panel: [f64; 2],
}

impl Figure {
    /// Panels two in a row: on a phone, 375 pixels wide, their numbers are 8 pixels high.
    pub fn new(panels: impl IntoIterator<Item = Panel>) -> Self {
        Self { panels: panels.into_iter().collect(), columns: 2, panel: [256.0, 236.0] }
    }

    /// Panels one below the other: on a phone their numbers are 11 pixels high.
    pub fn stacked(panels: impl IntoIterator<Item = Panel>) -> Self {
        Self { panels: panels.into_iter().collect(), columns: 1, panel: [375.0, 280.0] }
    }

    /// The figure as a drawing.
    pub fn drawing(&self) -> Drawing {
        layout::drawing(self)
    }
}

/// A shape γ in a legend; GGX and Beckmann by their names.
pub fn shape_name(gamma: f64) -> String {
    match gamma {
        2.0 => "γ = 2, GGX".into(),
        f64::INFINITY => "γ = ∞, Beckmann".into(),
        _ => format!("γ = {gamma}"),
    }
}

/// Why a figure was not drawn.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum PlotError {
    /// No figure has this name.
    #[error("no figure `{0}`; there are {names}", names = FIGURES.map(|of| of.name).join(", "))]
    Unknown(String),
    /// The image could not be made, with the reason.
    #[error("the figure could not be drawn: {0}")]
    Drawing(String),
}

microfacet_core::debug_in_words!(PlotError);

#[cfg(test)]
mod tests {
    use super::drawing::{Anchor, Shape};
    use super::*;

    fn curve(key: Key, points: &[(f64, f64)]) -> Curve {
        Curve::new(key, format!("{key:?}"), points.to_vec())
    }

    fn panel(curves: Vec<Curve>) -> Panel {
        Panel::new("a panel", Axis::linear("x", 0.0, 1.0), Axis::log("y", 1.0, 100.0), curves)
    }

    fn svg(panels: Vec<Panel>) -> String {
        Figure::new(panels).drawing().svg()
    }

    #[test]
    fn a_colour_follows_from_the_key_wherever_it_stands() {
        let line = [(0.0, 2.0), (1.0, 3.0)];
        let [two, three] = [2.0, 3.0].map(|gamma| curve(Key::Gamma(gamma), &line));
        let both = svg(vec![panel(vec![two.clone(), three.clone()])]);
        let one = svg(vec![panel(vec![three])]);
        let strokes = |drawn: &str| -> Vec<String> {
            let wide = drawn.lines().filter(|line| line.contains("stroke-width=\"2\""));
            let stroke = |line: &str| {
                let (_, rest) = line.split_once(" stroke=\"").unwrap();
                rest.split_once('"').unwrap().0.to_owned()
            };
            wide.map(stroke).collect()
        };
        // Each curve in the panel and in the legend.
        assert_eq!(strokes(&both).len(), 4);
        assert_eq!(strokes(&one), [strokes(&both)[1].clone(), strokes(&both)[3].clone()]);
        assert_ne!(strokes(&both)[0], strokes(&both)[1]);
    }

    #[test]
    fn rows_that_share_a_legend_have_one() {
        let of = |gamma| panel(vec![curve(Key::Gamma(gamma), &[(0.0, 2.0), (1.0, 3.0)])]);
        let count = |figure: &Figure| figure.drawing().svg().matches(">Gamma(").count();
        let mut figure = Figure::new(vec![of(2.0), of(2.0), of(2.0)]);
        assert_eq!(count(&figure), 1);
        figure.panels[2] = of(3.0);
        assert_eq!(count(&figure), 2);
        // What the second row shows is in the legend of the first.
        figure.panels[1] = of(3.0);
        assert_eq!(count(&figure), 2);
        figure.panels.push(of(4.0));
        assert_eq!(count(&figure), 4);
    }

    #[test]
    fn a_curve_that_leaves_is_marked_in_its_colour() {
        let key = Key::Gamma(2.0);
        let leaves = curve(key, &[(0.0, 10.0), (0.5, 1000.0), (1.0, 10.0)]);
        let drawn = svg(vec![panel(vec![leaves])]);
        let [r, g, b] = key.color();
        let triangle = format!("<polygon fill=\"#{r:02x}{g:02x}{b:02x}\"");
        assert_eq!(drawn.matches(&triangle).count(), 2, "{drawn}");
        let stays = curve(key, &[(0.0, 1.0), (1.0, 100.0)]);
        assert!(!svg(vec![panel(vec![stays])]).contains("<polygon"));
    }

    /// What the texts of a drawing cover: left, right, top and bottom.
    fn texts(drawing: &Drawing) -> Vec<(&str, [f64; 4])> {
        drawing.shapes.iter().filter_map(covered).collect()
    }

    fn covered(shape: &Shape) -> Option<(&str, [f64; 4])> {
        let Shape::Text { at: [x, y], text, size, anchor, turned, .. } = shape else {
            return None;
        };
        let length = text::width(text, *size);
        let start = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * length,
            Anchor::End => -length,
        };
        let (ascent, descent) = (0.73 * size, 0.2 * size);
        let covered = match turned {
            false => [x + start, x + start + length, y - ascent, y + descent],
            true => [x - ascent, x + descent, y + start, y + start + length],
        };
        (!text.is_empty()).then_some((text.as_str(), covered))
    }

    /// That no text is cut off, and none lies on another.
    fn assert_texts_are_clear(drawing: &Drawing) {
        let [width, height] = drawing.size;
        let texts = texts(drawing);
        let apart = |a: f64, b: f64| a >= b - 0.01;
        for (i, (text, [left, right, top, bottom])) in texts.iter().enumerate() {
            let inside = *left >= 0.0 && *right <= width && *top >= 0.0 && *bottom <= height;
            assert!(inside, "\"{text}\" is cut off: {left} to {right} of {width}");
            for (other, [l, r, t, b]) in &texts[..i] {
                let clear =
                    apart(*l, *right) || apart(*left, *r) || apart(*t, *bottom) || apart(*top, *b);
                assert!(clear, "\"{text}\" lies on \"{other}\"");
            }
        }
    }

    #[test]
    fn points_are_numbered_and_listed_and_their_numbers_are_clear_of_all_else() {
        let mark = |i: i32| Mark {
            key: Key::TABLE,
            name: format!("rival {i}"),
            group: "rivals".into(),
            at: (0.98, 10.0 - 0.1 * f64::from(i)),
            symbol: Symbol::Dot,
        };
        let mut panel = panel(Vec::new());
        panel.marks = (1..=6).map(mark).collect();
        panel.curves = vec![curve(Key::Gamma(2.0), &[(0.0, 10.0), (1.0, 10.0)])];
        let drawing = Figure::stacked([panel]).drawing();
        assert_texts_are_clear(&drawing);
        for i in 1..=6 {
            let number = format!("{i}");
            let numbers = texts(&drawing).into_iter().filter(|(text, _)| *text == number).count();
            // At its point, and before its name; numbers of axes are others.
            assert!(numbers >= 2, "{number}");
            assert!(texts(&drawing).iter().any(|(text, _)| *text == format!("rival {i}")));
        }
    }

    #[test]
    fn bars_are_as_long_as_their_values_and_their_words_are_whole() {
        let bar = |key, to: f64| Bar { key, name: "Student-t".into(), to, value: "4.1 ns".into() };
        let pair = |name: &str| (name.into(), vec![bar(Key::OTHER, 1.0), bar(Key::TABLE, 2.5)]);
        let x = Axis::linear("run time", 0.0, 4.0);
        let bars = Bars { title: "Bars".into(), x, groups: vec![pair("one"), pair("other")] };
        let drawing = bars.drawing();
        assert_texts_are_clear(&drawing);
        let long: Vec<f64> = drawing
            .shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Area { corners, .. } => Some(corners[1][0] - corners[0][0]),
                _ => None,
            })
            .collect();
        assert_eq!(long.len(), 4);
        assert!((long[1] / long[0] - 2.5).abs() < 1e-12 && long[..2] == long[2..], "{long:?}");
    }

    #[test]
    fn texts_of_figures_are_whole_and_legible_on_a_phone() {
        for Listed { name, .. } in FIGURES {
            let drawing = figure(name).unwrap().drawing();
            assert_texts_are_clear(&drawing);
            let on_phone = 375.0 / drawing.size[0];
            for shape in &drawing.shapes {
                let Shape::Text { text, size, .. } = shape else { continue };
                assert!(size * on_phone >= 8.0, "{name}: \"{text}\" is {}", size * on_phone);
            }
        }
    }

    #[test]
    fn png_has_the_size_of_the_page_twice_and_the_colours_of_svg() {
        let key = Key::TABLE;
        let figure = Figure::new(vec![panel(vec![curve(key, &[(0.0, 10.0), (1.0, 10.0)])])]);
        let page = figure.drawing().size.map(|x| 2 * x as usize);
        let (pixels, width) = png::decode(&figure.drawing().png().unwrap());
        assert_eq!([width, pixels.len() / width], page);
        let count = pixels.iter().filter(|&&pixel| pixel == key.color()).count();
        // The curve and its sample in the legend are four pixels wide.
        assert!((1500..1800).contains(&count), "{count}");
        assert!(Figure::new([]).drawing().png().is_err());
    }

    #[test]
    fn every_figure_is_drawn() {
        for Listed { name, .. } in FIGURES {
            let figure = figure(name).unwrap();
            assert!(!figure.panels.is_empty());
            for panel in &figure.panels {
                for curve in &panel.curves {
                    let at = format!("{name}, {}: {}", panel.title, curve.name);
                    let inside = |&&point: &&(f64, f64)| {
                        panel.place(point).iter().all(|x| (-1e-9..=1.0 + 1e-9).contains(x))
                    };
                    let inside = curve.points.iter().filter(inside).count();
                    assert!(inside * 4 > curve.points.len(), "{at} leaves the panel");
                    assert!(curve.points.iter().all(|p| p.0.is_finite()), "{at}");
                }
            }
            let drawn = figure.drawing().svg();
            let document = roxmltree::Document::parse(&drawn).unwrap();
            for text in document.descendants().filter_map(|node| node.text()) {
                assert!(text::has_all(text.trim()), "{name}: no letter for \"{text}\"");
            }
        }
        assert!(figure("nothing").unwrap_err().to_string().contains("highlights"));
    }
}
