//! The figures as drawings.

use microfacet_report::plot::{
    Axis, Content, Curve, Dash, Figure, Key, Panel, PlotError, Sheet, Tile,
};

use super::Paper;
use super::approximation::Approximation;
use super::integrated::{CLAIM, MEASURES, RELATIVE};
use super::pictures::{Compared, FORMS, srgb};
use super::times::{SIGMAS, Timing};
use crate::rows::Quantity;
use crate::settings::{GAMMA, SIGMA};

/// The ends of the axis of γ.
const SHAPES: [f64; 2] = [1.5, 40.0];

impl Paper {
    /// Each figure as SVG and as PNG.
    pub(super) fn drawings(&self) -> Result<Vec<(&'static str, Vec<u8>)>, PlotError> {
        let drawings = [
            (["figure-4.svg", "figure-4.png"], self.times_figure().drawing()),
            (["figure-5.svg", "figure-5.png"], self.error_figure().drawing()),
            (["figure-6.svg", "figure-6.png"], self.sheet().drawing()),
        ];
        let mut files = Vec::new();
        for ([svg, png], drawing) in drawings {
            files.push((svg, drawing.svg().into_bytes()));
            files.push((png, drawing.png()?));
        }
        Ok(files)
    }

    /// Rows for one G1, for a picture and for a visible normal, over γ and over σ.
    fn times_figure(&self) -> Figure {
        let quantities = [
            (Quantity::G1, "G₁", "time of a call (ns)", 1.0),
            (Quantity::Picture, "Picture of gold", "time of a picture (ms)", 1e-6),
            (Quantity::Normal, "Visible normal", "time of a call (ns)", 1.0),
        ];
        let panels = quantities.into_iter().flat_map(|(quantity, what, unit, scale)| {
            let of_quantity: Vec<&Timing> =
                self.times.iter().filter(|time| time.quantity == quantity).collect();
            // A coarse clock may give 0 for a short batch.
            let values = || of_quantity.iter().map(|time| scale * time.ns.max(0.1));
            let (low, high) =
                (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
            let y = Axis::log(unit, 0.7 * low, 1.4 * high);
            let over = |x: Axis, of: String, is_by_gamma| {
                let curves = time_curves(&of_quantity, is_by_gamma, scale);
                Panel::new(format!("{what}, {of}"), x, y.clone(), curves)
            };
            [
                over(
                    Axis::log("shape γ", SHAPES[0], SHAPES[1]),
                    format!("by γ, σ = {SIGMA}"),
                    true,
                ),
                over(Axis::linear("roughness σ", 0.0, 1.0), format!("by σ, γ = {GAMMA}"), false),
            ]
        });
        Figure::new(panels)
    }

    /// By θ, of the approximation and of the table; and over the hemisphere, by γ.
    fn error_figure(&self) -> Figure {
        let by_angle = |title: &str, error: fn(&Approximation) -> f64| {
            let shapes = self.approximation.chunk_by(|a, b| a.gamma == b.gamma);
            let curve = |(i, of): (usize, &[Approximation])| {
                // Smaller errors are below the rounding of single precision.
                let points = of.iter().map(|at| (at.degrees, error(at).abs().max(1e-9)));
                let name = format!("γ = {}", of[0].gamma);
                Curve::new(Key::Gamma(of[0].gamma), name, points).dashed(alternate(i))
            };
            let curves = shapes.enumerate().map(curve);
            let x = Axis::degrees("angle θ of the view", 0.0, 90.0);
            Panel::new(title, x, Axis::log("error of G₁", 1e-9, 3e-2), curves)
        };
        let rows = [
            by_angle("Rational, eq. 22–23", |at| at.rational_error),
            by_angle("Table, default quality", |at| at.table_error),
            self.by_measure(),
            self.by_sigma(),
        ];
        Figure::new(rows)
    }

    /// Measures of the error over the hemisphere.
    fn by_measure(&self) -> Panel {
        let curves = MEASURES.iter().enumerate().map(|(i, measure)| {
            let curve = self.error_curve(Key::Nth(i), measure.formula.into(), i, SIGMA);
            // The last two coincide, since G1 is close to 1 where the error is largest.
            curve.dashed(alternate(i))
        });
        let title = format!("Over the hemisphere, σ = {SIGMA}");
        self.over_hemisphere(title, curves.collect())
    }

    /// The measure [`RELATIVE`] by σ.
    fn by_sigma(&self) -> Panel {
        let curves = SIGMAS.into_iter().enumerate().map(|(i, sigma)| {
            let key = Key::Sigma(sigma);
            let curve = self.error_curve(key, format!("σ = {sigma}"), RELATIVE, sigma);
            curve.dashed(alternate(i))
        });
        self.over_hemisphere(MEASURES[RELATIVE].formula.into(), curves.collect())
    }

    fn error_curve(&self, key: Key, name: String, measure: usize, sigma: f64) -> Curve {
        let of = self.integrated.iter().filter(|at| at.sigma == sigma);
        Curve::new(key, name, of.map(|at| (at.gamma, 1e2 * at.errors[measure])))
    }

    /// A panel over γ, with the bound that the paper states.
    fn over_hemisphere(&self, title: String, curves: Vec<Curve>) -> Panel {
        let (key, points) = (Key::OTHER, SHAPES.map(|gamma| (gamma, 1e2 * CLAIM)));
        let claim = Curve::new(key, "0.7 %, as the paper has it", points).dashed(Dash::Dotted);
        let x = Axis::log("shape γ", SHAPES[0], SHAPES[1]);
        let y = Axis::linear("error (%)", 0.0, 0.8);
        Panel::new(title, x, y, curves.into_iter().chain([claim]))
    }

    /// The exact picture of each shape, and the differences to it in false colours.
    fn sheet(&self) -> Sheet {
        let tiles = |of: &Compared| {
            let colors = of
                .exact
                .pixels
                .iter()
                .map(|&radiance| (255.0 * srgb(radiance)).to_array().map(|x| x.round() as u8));
            let exact = Tile {
                content: Content::Colors(colors.collect()),
                caption: format!("mean radiance {:.2}", of.mean),
            };
            let differences = of.differences.iter().map(|at| Tile {
                content: Content::Values(at.pixels.clone()),
                caption: format!("RMSE {:.1e}", at.rmse),
            });
            [exact].into_iter().chain(differences).collect()
        };
        let columns = ["exact G1"].into_iter().chain(FORMS).map(String::from);
        let rows = self.compared.iter().map(|of| (format!("γ = {}", of.gamma), tiles(of)));
        let title = format!("Rough gold, σ = {SIGMA}: the exact picture, and differences to it");
        Sheet {
            groups: vec![(1 + FORMS.len(), title)],
            columns: columns.collect(),
            rows: rows.collect(),
            scale: Some(Axis::log(
                "difference of radiance, the largest of the channels",
                1e-8,
                1e-1,
            )),
            edge: 160.0,
        }
    }
}

/// Dashes that distinguish neighbours in a list.
fn alternate(i: usize) -> Dash {
    [Dash::Solid, Dash::Dashed, Dash::LongDashed, Dash::DashDotted, Dash::DashDotDotted][i % 5]
}

/// The curves over γ or over σ; a method of one shape is constant over γ.
fn time_curves(of: &[&Timing], by_gamma: bool, scale: f64) -> Vec<Curve> {
    let mut of: Vec<&Timing> =
        of.iter().copied().filter(|time| time.by_gamma == by_gamma).collect();
    of.sort_by_key(|time| time.method);
    let curve = |times: &[&Timing]| {
        let method = times[0].method;
        let y = |time: &Timing| scale * time.ns.max(0.1);
        let points = times.iter().filter(|time| time.gamma.is_finite() || !by_gamma);
        let points = match method.is_reference() && by_gamma {
            true => SHAPES.map(|gamma| (gamma, y(times[0]))).into(),
            false if by_gamma => points.map(|time| (time.gamma, y(time))).collect(),
            false => points.map(|time| (time.sigma, y(time))).collect(),
        };
        Curve { points, ..Curve::new(method.key(), method.name(), []).dashed(method.dash()) }
    };
    of.chunk_by(|a, b| a.method == b.method).map(curve).collect()
}
