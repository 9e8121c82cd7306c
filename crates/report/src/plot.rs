//! Draws figures of the literature as data, as SVG and as PNG: pure functions, without files or
//! fonts of the system.

mod axis;
mod canvas;
mod clip;
mod figures;
mod frame;
mod heat;
mod ink;
mod label;
mod layout;
mod panel;
mod png;
mod sheet;
mod svg;
mod text;

use std::fmt;

pub use axis::Axis;
pub use figures::{FIGURES, Listed, figure};
pub use heat::{Bar, HeatMap};
pub use ink::{Dash, Key, Method};
pub use sheet::{Content, Sheet, Tile};

/// A curve with its name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it is, which its colour follows from.
    pub key: Key,
    /// Name; the legend leaves out a curve without one.
    pub name: String,
    /// How it is drawn.
    pub dash: Dash,
    /// (x, y), x ascending; a point with NaN interrupts it.
    pub points: Vec<(f64, f64)>,
}

/// A point with its name beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What it is, which its colour follows from.
    pub key: Key,
    /// Name.
    pub name: String,
    /// (x, y), inside the panel.
    pub at: (f64, f64),
    /// Whether it is a dot, else a ring.
    pub filled: bool,
}

/// One coordinate system. A curve that leaves it is interrupted there, and a triangle in its
/// colour points to where it went.
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
    /// Where a point stands: (0, 0) is the left lower corner, (1, 1) the right upper one.
    fn place(&self, (x, y): (f64, f64)) -> [f64; 2] {
        [self.x.fraction(x), self.y.fraction(y)]
    }
}

/// Panels in rows. The legend of a row's curves stands beneath it, or beneath the last of the rows
/// that share it.
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
    /// Panels two in a row.
    pub fn new(panels: Vec<Panel>) -> Self {
        Self { panels, columns: 2, panel: [560.0, 400.0] }
    }

    /// As SVG, without references to anything outside it.
    pub fn svg(&self) -> String {
        svg::write(&layout::page(self))
    }

    /// As an element of an HTML page, of class `plot`: as wide as its place, in the page's fonts,
    /// with colours for light and dark; `label` is read to those who do not see it. The page
    /// defines the custom properties `--ink` and `--line`.
    pub fn inline_svg(&self, label: &str) -> String {
        svg::write_inline(&layout::page(self), label)
    }

    /// As PNG, with two pixels along each of the page.
    ///
    /// # Errors
    /// [`PlotError::Drawing`] for a figure without panels, or larger than memory.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        png::write(&layout::page(self))
    }
}

/// Why a figure was not drawn.
#[derive(Clone, PartialEq, Eq)]
pub enum PlotError {
    /// No figure has this name.
    Unknown(String),
    /// Why there is no image.
    Drawing(String),
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => {
                let names = FIGURES.map(|listed| listed.name);
                write!(f, "no figure `{name}`; there are {}", names.join(", "))
            }
            Self::Drawing(why) => write!(f, "the figure could not be drawn: {why}"),
        }
    }
}

microfacet_core::debug_in_words!(PlotError);

impl std::error::Error for PlotError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(key: Key, points: &[(f64, f64)]) -> Curve {
        Curve { key, name: format!("{key:?}"), dash: Dash::Solid, points: points.into() }
    }

    fn panel(curves: Vec<Curve>) -> Panel {
        let (x, y) = (Axis::linear("x", 0.0, 1.0), Axis::log("y", 1.0, 100.0));
        Panel { title: "a panel".into(), x, y, curves, marks: Vec::new() }
    }

    #[test]
    fn a_colour_follows_from_the_key_wherever_it_stands() {
        let line = [(0.0, 2.0), (1.0, 3.0)];
        let [two, three] = [2.0, 3.0].map(|gamma| curve(Key::Gamma(gamma), &line));
        let both = Figure::new(vec![panel(vec![two.clone(), three.clone()])]).svg();
        let one = Figure::new(vec![panel(vec![three])]).svg();
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
        let count = |figure: &Figure| figure.svg().matches(">Gamma(").count();
        let mut figure = Figure::new(vec![of(2.0), of(2.0), of(2.0)]);
        assert_eq!(count(&figure), 1);
        figure.panels[2] = of(3.0);
        assert_eq!(count(&figure), 2);
    }

    #[test]
    fn a_curve_that_leaves_is_marked_in_its_colour() {
        let key = Key::Gamma(2.0);
        let leaves = curve(key, &[(0.0, 10.0), (0.5, 1000.0), (1.0, 10.0)]);
        let drawn = Figure::new(vec![panel(vec![leaves])]).svg();
        let [r, g, b] = key.color();
        let triangle = format!("<polygon fill=\"#{r:02x}{g:02x}{b:02x}\"");
        assert_eq!(drawn.matches(&triangle).count(), 2, "{drawn}");
        let stays = curve(key, &[(0.0, 1.0), (1.0, 100.0)]);
        assert!(!Figure::new(vec![panel(vec![stays])]).svg().contains("<polygon"));
    }

    #[test]
    fn names_of_points_do_not_overlap() {
        let mark = |i: i32| Mark {
            key: Key::Method(Method::Table),
            name: format!("rival {i}"),
            at: (0.98, 10.0 + 0.1 * f64::from(i)),
            filled: true,
        };
        let mut panel = panel(Vec::new());
        panel.marks = (0..6).map(mark).collect();
        // Neither do they lie on a curve.
        panel.curves = vec![curve(Key::Gamma(2.0), &[(0.0, 10.0), (1.0, 10.0)])];
        let drawn = Figure::new(vec![panel]).svg();
        let mut lines: Vec<f64> = drawn
            .lines()
            .filter(|line| line.contains(">rival "))
            .map(|line| line.split('"').nth(3).unwrap().parse().unwrap())
            .collect();
        lines.sort_by(f64::total_cmp);
        assert_eq!(lines.len(), 6);
        assert!(lines.windows(2).all(|pair| pair[1] - pair[0] > 10.0), "{lines:?}");
        let line = drawn.lines().find(|line| line.contains("stroke-width=\"2\"")).unwrap();
        let height = line.rsplit([',', '"']).nth(1).unwrap().parse::<f64>().unwrap();
        // Baselines are some pixels beneath the middles of names.
        let clear = |y: &f64| (y - 3.8 - height).abs() > 6.0;
        assert!(lines.iter().all(clear), "{lines:?} at {height}");
    }

    #[test]
    fn png_has_the_size_of_the_page_twice_and_the_colours_of_svg() {
        let key = Key::Gamma(2.0);
        let figure = Figure::new(vec![panel(vec![curve(key, &[(0.0, 10.0), (1.0, 10.0)])])]);
        let page = layout::page(&figure).size.map(|x| 2 * x as u32);
        let image = image::load_from_memory(&figure.png().unwrap()).unwrap().to_rgb8();
        assert_eq!([image.width(), image.height()], page);
        let count = image.pixels().filter(|pixel| pixel.0 == key.color()).count();
        // The curve is four pixels wide, as long as the panel.
        assert!((3000..5000).contains(&count), "{count}");
        assert!(Figure::new(Vec::new()).png().is_err());
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
            let drawn = figure.svg();
            let document = roxmltree::Document::parse(&drawn).unwrap();
            for text in document.descendants().filter_map(|node| node.text()) {
                assert!(text::has_all(text.trim()), "{name}: no letter for \"{text}\"");
            }
        }
        assert!(figure("nothing").unwrap_err().to_string().contains("highlights"));
    }
}
