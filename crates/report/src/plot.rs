//! Figures of the literature as data, drawn as SVG and PNG: pure functions, without files or fonts
//! of the system.

mod axis;
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
    /// A curve with a solid line.
    pub fn new(
        key: Key,
        name: impl Into<String>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().collect();
        Self { key, name: name.into(), dash: Dash::Solid, points }
    }

    /// The same curve with this dash.
    #[must_use]
    pub fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }
}

/// A point with its name next to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What the point shows; this sets its colour.
    pub key: Key,
    /// Name.
    pub name: String,
    /// (x, y), inside the panel.
    pub at: (f64, f64),
    /// Whether it is a dot, else a ring.
    pub filled: bool,
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

/// Panels in rows. The legend of a row's curves is beneath it, or beneath the last of the rows that
/// share it.
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
    pub fn new(panels: impl IntoIterator<Item = Panel>) -> Self {
        Self { panels: panels.into_iter().collect(), columns: 2, panel: [560.0, 400.0] }
    }

    /// The figure as a drawing.
    pub fn drawing(&self) -> Drawing {
        layout::drawing(self)
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

    #[test]
    fn names_of_points_do_not_overlap() {
        let mark = |i: i32| Mark {
            key: Key::TABLE,
            name: format!("rival {i}"),
            at: (0.98, 10.0 + 0.1 * f64::from(i)),
            filled: true,
        };
        let mut panel = panel(Vec::new());
        panel.marks = (0..6).map(mark).collect();
        // Names must not lie on a curve either.
        panel.curves = vec![curve(Key::Gamma(2.0), &[(0.0, 10.0), (1.0, 10.0)])];
        let drawn = svg(vec![panel]);
        let names: Vec<[f64; 3]> = drawn
            .lines()
            .filter(|line| line.contains(">rival "))
            .map(|line| {
                let at = |i| line.split('"').nth(i).unwrap().parse::<f64>().unwrap();
                let width = text::width("rival 0", 10.5);
                let before = [("\"end\"", width), ("\"middle\"", 0.5 * width)];
                let before = before.iter().find(|(anchor, _)| line.contains(anchor));
                [at(1) - before.map_or(0.0, |(_, before)| *before), at(3), width]
            })
            .collect();
        assert_eq!(names.len(), 6);
        let meet =
            |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).abs() < a[2] && (a[1] - b[1]).abs() < 10.0;
        for (i, a) in names.iter().enumerate() {
            assert!(names[..i].iter().all(|b| !meet(a, b)), "{names:?}");
        }
        let line = drawn.lines().find(|line| line.contains("stroke-width=\"2\"")).unwrap();
        let height = line.rsplit([',', '"']).nth(1).unwrap().parse::<f64>().unwrap();
        // Baselines are some pixels beneath the middles of names.
        let clear = |name: &[f64; 3]| (name[1] - 3.8 - height).abs() > 6.0;
        assert!(names.iter().all(clear), "{names:?} at {height}");
    }

    #[test]
    fn png_has_the_size_of_the_page_twice_and_the_colours_of_svg() {
        let key = Key::Gamma(2.0);
        let figure = Figure::new(vec![panel(vec![curve(key, &[(0.0, 10.0), (1.0, 10.0)])])]);
        let page = figure.drawing().size.map(|x| 2 * x as usize);
        let (pixels, width) = png::decode(&figure.drawing().png().unwrap());
        assert_eq!([width, pixels.len() / width], page);
        let count = pixels.iter().filter(|&&pixel| pixel == key.color()).count();
        // The curve is four pixels wide, as long as the panel.
        assert!((3000..5000).contains(&count), "{count}");
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
