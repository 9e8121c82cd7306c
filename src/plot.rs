//! Draws figures of the literature as data and as SVG: pure functions, without files or system
//! fonts.

mod figures;

use std::fmt;

use plotters::prelude::*;

pub use figures::{NAMES, figure};

/// A curve with its name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name.
    pub name: String,
    /// (x, y), x ascending.
    pub points: Vec<(f64, f64)>,
}

/// Corner of the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// Above, on the right.
    Right,
    /// Below, on the left.
    Left,
}

/// One coordinate system.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Quantity and unit along x.
    pub x_label: &'static str,
    /// Quantity and unit along y.
    pub y_label: &'static str,
    /// Range of y; the range of x is that of the points.
    pub y: (f64, f64),
    /// Where the legend hides no curve.
    pub legend: Legend,
    /// Curves.
    pub curves: Vec<Curve>,
}

/// Why a figure was not drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlotError {
    /// No figure has this name.
    Unknown(String),
    /// The drawing library's message.
    Drawing(String),
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "no figure `{name}`; there are {}", NAMES.join(", ")),
            Self::Drawing(why) => write!(f, "the figure could not be drawn: {why}"),
        }
    }
}

impl std::error::Error for PlotError {}

/// Size of a panel on the page, in pixels.
const PANEL: (u32, u32) = (560, 420);
/// The drawing library places points on integers; this many steps make one pixel of the page, so
/// that curves are smooth.
const FINE: u32 = 8;

/// Draws panels side by side, two in a row.
///
/// # Errors
/// [`PlotError::Drawing`].
pub fn svg(panels: &[Panel]) -> Result<String, PlotError> {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns);
    let page = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    let size = (FINE * page.0, FINE * page.1);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).map_err(drawing)?;
        for (area, panel) in root.split_evenly((rows, columns)).iter().zip(panels) {
            draw(area, panel)?;
        }
        root.present().map_err(drawing)?;
    }
    // The view box keeps the fine coordinates; only the size on the page is the panel's own.
    let fine = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", page.0, page.1), 1))
}

fn drawing(e: impl fmt::Display) -> PlotError {
    PlotError::Drawing(e.to_string())
}

fn draw(
    area: &DrawingArea<SVGBackend, plotters::coord::Shift>,
    panel: &Panel,
) -> Result<(), PlotError> {
    let xs = || panel.curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.0));
    let (low, high) = (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max));
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 16 * FINE))
        .margin(12 * FINE)
        .x_label_area_size(36 * FINE)
        .y_label_area_size(52 * FINE)
        .build_cartesian_2d(low..high, panel.y.0..panel.y.1)
        .map_err(drawing)?;
    chart
        .configure_mesh()
        .x_desc(panel.x_label)
        .y_desc(panel.y_label)
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.2).stroke_width(FINE))
        .axis_style(BLACK.stroke_width(FINE))
        .set_all_tick_mark_size(4 * FINE)
        .label_style(("sans-serif", 11 * FINE))
        .x_label_formatter(&tick_label)
        .y_label_formatter(&tick_label)
        .draw()
        .map_err(drawing)?;
    for (i, curve) in panel.curves.iter().enumerate() {
        // Evenly round the colour circle, dark enough for white paper.
        let color = HSLColor(i as f64 / panel.curves.len() as f64, 0.75, 0.42);
        let style = color.stroke_width(2 * FINE);
        // A curve that leaves the panel is interrupted there, not joined across.
        let inside = |p: &(f64, f64)| (panel.y.0..=panel.y.1).contains(&p.1);
        for run in curve.points.split(|p| !inside(p)).filter(|run| !run.is_empty()) {
            chart.draw_series(LineSeries::new(run.iter().copied(), style)).map_err(drawing)?;
        }
        let step = FINE as i32;
        chart
            .draw_series(std::iter::empty::<PathElement<(f64, f64)>>())
            .map_err(drawing)?
            .label(&curve.name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18 * step, y)], style));
    }
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .label_font(("sans-serif", 11 * FINE))
        .legend_area_size(24 * FINE)
        .margin(6 * FINE)
        .position(match panel.legend {
            Legend::Right => SeriesLabelPosition::UpperRight,
            Legend::Left => SeriesLabelPosition::LowerLeft,
        })
        .draw()
        .map_err(drawing)
}

/// A number on an axis, without superfluous zeros.
fn tick_label(x: &f64) -> String {
    // Adding 0 turns −0 into 0.
    format!("{}", (x * 1e6).round() / 1e6 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_is_drawn() {
        for name in NAMES {
            let panels = figure(name).unwrap();
            assert!(!panels.is_empty());
            for panel in &panels {
                for curve in &panel.curves {
                    let inside = curve
                        .points
                        .iter()
                        .filter(|p| (panel.y.0..=panel.y.1).contains(&p.1))
                        .count();
                    assert!(
                        inside * 4 > curve.points.len(),
                        "{name}, {}: {} leaves the panel",
                        panel.title,
                        curve.name
                    );
                    assert!(curve.points.iter().all(|p| p.0.is_finite()), "{name}, {}", curve.name);
                }
            }
            let drawn = svg(&panels).unwrap();
            assert!(drawn.starts_with("<svg") && drawn.trim_end().ends_with("</svg>"));
        }
        assert!(figure("nothing").unwrap_err().to_string().contains("highlights"));
    }
}
