//! The design of the table of visible slopes: the largest CDF error of several designs of the same
//! size.
//!
//! `cargo run --release -p microfacet-study -- table_design` prints the tables in the docs of
//! `microfacet_baker::bake`. Every design of the first has 65 views by 2·17 random numbers, exact
//! values and slopes at its nodes, cubic Hermite along u₁ and lines between views; errors are
//! measured in double precision between the nodes of both axes.

use microfacet_baker::bake::axes;
use microfacet_baker::table_spec::{Level, general_set};
use microfacet_model::{Shape, SignedSlope, UnitView, VisibleSlope};
use microfacet_tables::axis::HalfTangent;
use microfacet_tables::axis::half_tangent::{half_tangent, slope_at};
use microfacet_tables::{Kind, Mapping, Precision};
use rayon::prelude::*;

use crate::{Outcome, print_head};

const VIEWS: usize = 64;
const NUMBERS: usize = 16;

#[derive(Clone, Copy, Debug)]
enum Stored {
    /// h = x/(1 + √(1+x²)).
    HalfTangent,
    /// The random number that would give the same slope for GGX.
    GgxNumber,
}

#[derive(Clone, Copy, Debug)]
enum View {
    Cosine,
    HalfTangent,
}

struct Design {
    stored: Stored,
    view: View,
    /// u = ½ t^power in each half.
    power: i32,
}

impl Design {
    fn view(&self, at: f64) -> UnitView {
        UnitView::from_cotangent(match self.view {
            _ if at == 1.0 => f64::INFINITY,
            View::Cosine => at / (1.0 - at * at).sqrt(),
            View::HalfTangent => HalfTangent::default().quantity(at),
        })
    }

    /// u at t ∈ [0, 2], the halves joined at t = 1.
    fn number(&self, t: f64) -> f64 {
        if t <= 1.0 { 0.5 * t.powi(self.power) } else { 1.0 - 0.5 * (2.0 - t).powi(self.power) }
    }

    fn store(&self, shape: &Shape, view: UnitView, x: SignedSlope) -> f64 {
        let (sin, cos) = shape.unit_sin_cos(x.w);
        let sin = x.sign * sin;
        match self.stored {
            Stored::HalfTangent => half_tangent(sin, cos),
            Stored::GgxNumber => (1.0 + sin * view.cos - cos * view.sin) / (1.0 + view.cos),
        }
    }

    fn restore(&self, shape: &Shape, view: UnitView, value: f64) -> SignedSlope {
        let (sin, cos) = match self.stored {
            Stored::HalfTangent => slope_at(1.0 - value.clamp(-1.0, 1.0)).into(),
            Stored::GgxNumber => {
                let d = (value * (1.0 + view.cos) - 1.0).clamp(-1.0, 1.0);
                let c = (1.0 - d * d).sqrt();
                (d * view.cos + c * view.sin, (c * view.cos - d * view.sin).max(0.0))
            }
        };
        SignedSlope {
            w: shape.asinh_slope((sin / cos).abs()),
            sign: if sin < 0.0 { -1.0 } else { 1.0 },
        }
    }

    /// Values and slopes of one row, the slopes limited so that every cell ascends.
    fn row(&self, shape: &Shape, at: f64) -> Vec<[f64; 2]> {
        let view = self.view(at);
        let slopes = VisibleSlope::new(shape, view);
        let value = |t: f64| self.store(shape, view, slopes.quantile(self.number(t)));
        let step = 1e-4;
        let mut row: Vec<[f64; 2]> = (0..=2 * NUMBERS)
            .map(|i| {
                let t = i as f64 / NUMBERS as f64;
                let (low, high) = ((t - step).max(0.0), (t + step).min(2.0));
                [value(t), (value(high) - value(low)) / (high - low) / NUMBERS as f64]
            })
            .collect();
        for i in 0..row.len() {
            let before = if i > 0 { row[i][0] - row[i - 1][0] } else { f64::INFINITY };
            let after = if i + 1 < row.len() { row[i + 1][0] - row[i][0] } else { f64::INFINITY };
            row[i][1] = row[i][1].min(3.0 * before.min(after)).max(0.0);
        }
        row
    }

    /// Largest CDF error, at three views in every cell and four numbers in every cell.
    fn error(&self, shape: &Shape) -> f64 {
        let rows: Vec<_> = (0..=VIEWS).map(|i| self.row(shape, i as f64 / VIEWS as f64)).collect();
        let mut worst = 0.0_f64;
        for i in 0..3 * VIEWS {
            let at = (i as f64 + 0.5) / 3.0;
            let (row, between) = (at as usize, at.fract());
            let view = self.view(at / VIEWS as f64);
            let slopes = VisibleSlope::new(shape, view);
            for j in 0..8 * NUMBERS {
                let at = (j as f64 + 0.5) / 4.0;
                let (cell, w) = (at as usize, at.fract());
                let node = |i: usize, channel: usize| {
                    let (a, b) = (rows[row][i][channel], rows[row + 1][i][channel]);
                    a + between * (b - a)
                };
                let (a, b, da, db) =
                    (node(cell, 0), node(cell + 1, 0), node(cell, 1), node(cell + 1, 1));
                let rise = b - a;
                let value =
                    a + w * (da + w * (3.0 * rise - 2.0 * da - db + w * (da + db - 2.0 * rise)));
                let u = self.number(at / NUMBERS as f64);
                worst = worst.max((slopes.cdf(self.restore(shape, view, value)) - u).abs());
            }
        }
        worst
    }
}

/// The largest CDF error of linear interpolation between exact views, `cells` + 1 even nodes of a
/// coordinate: in the middle of every cell and on either side of it. If `peeled`, the error is
/// weighted by the share of the distribution that is left, 1 − M₀ sin θ/area.
fn error_between_views(shape: &Shape, axis: HalfTangent, cells: usize, peeled: bool) -> f64 {
    let design = Design { stored: Stored::HalfTangent, view: View::HalfTangent, power: 4 };
    let slopes = |t: f64| {
        let view = UnitView::from_cotangent(axis.quantity(t));
        if peeled { VisibleSlope::peeled(shape, view) } else { VisibleSlope::new(shape, view) }
    };
    let numbers: Vec<f64> =
        (1..4 * NUMBERS).map(|i| design.number(i as f64 / (2 * NUMBERS) as f64)).collect();
    let row = |t: f64| -> Vec<f64> {
        let (view, slopes) = (UnitView { sin: 1.0, cos: 0.0 }, slopes(t));
        numbers.iter().map(|&u| design.store(shape, view, slopes.quantile(u))).collect()
    };
    let in_cell = |i: usize| {
        let t = |w: f64| (i as f64 + w) / cells as f64;
        let (low, high) = (row(t(0.0)), row(t(1.0)));
        let mut worst = 0.0_f64;
        for w in [0.25, 0.5, 0.75] {
            let (view, exact) = (UnitView::from_cotangent(axis.quantity(t(w))), slopes(t(w)));
            let whole = VisibleSlope::new(shape, view).area();
            let share = if peeled { 1.0 - view.sin * shape.first_moment(0.0) / whole } else { 1.0 };
            for ((a, b), u) in low.iter().zip(&high).zip(&numbers) {
                let x = design.restore(shape, view, a + w * (b - a));
                worst = worst.max(share * (exact.cdf(x) - u).abs());
            }
        }
        worst
    };
    (0..cells).into_par_iter().map(in_cell).reduce(|| 0.0, f64::max)
}

/// Prints [`error_between_views`] with even nodes and with the knots of baked tables.
fn print_views() {
    println!();
    print_head(&["views", "nodes", "γ: error", "", "", ""]);
    for spec in general_set(Level::DEFAULT, Precision::F32) {
        let peeled = spec.kind == Kind::VisibleSlopePeeled;
        let gammas = if peeled { [1.501, 1.51, 1.6, 1.79] } else { [1.8, 1.9, 4.0, f64::INFINITY] };
        let Mapping::HalfTangent(baked) = axes(&spec)[1].mapping else { continue };
        for axis in [HalfTangent::default(), baked] {
            let error = |gamma| {
                let shape = Shape::new(gamma).expect("in range");
                let error = error_between_views(&shape, axis, spec.views - 1, peeled);
                format!("{gamma}: {error:.1e}")
            };
            let nodes = axis.knots.map_or("even".into(), |knots| format!("knots {knots:?}"));
            println!("| {} | {nodes} | {} |", spec.views, gammas.map(error).join(" | "));
        }
    }
}

/// Runs the study that the module describes.
pub fn run(_: &[String]) -> Outcome {
    print_head(&["stored", "view axis", "u", "γ = 1.8", "2", "4", "∞"]);
    for stored in [Stored::HalfTangent, Stored::GgxNumber] {
        let half_tangents = [1, 2, 4].map(|power| (View::HalfTangent, power));
        for (view, power) in [(View::Cosine, 4)].into_iter().chain(half_tangents) {
            let design = Design { stored, view, power };
            let errors: Vec<String> = [1.8, 2.0, 4.0, f64::INFINITY]
                .map(|gamma| format!("{:.1e}", design.error(&Shape::new(gamma).expect("in range"))))
                .into();
            println!("| {stored:?} | {view:?} | t^{power} | {} |", errors.join(" | "));
        }
    }
    print_views();
    Ok(())
}
