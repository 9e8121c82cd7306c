//! The white furnace before and after compensation.

use maud::{Markup, html};
use microfacet_baker::progress::Meter;
use microfacet_sampler::{MaterialError, Tables};
use microfacet_validate::furnace::{Furnace, anisotropic, furnace, seconds as furnace_seconds};
use rayon::prelude::*;

use super::drawing::{error, plot};
use super::subjects::{ALONG, Shown, Subjects};
use super::texts;
use super::{ReportError, Source};
use crate::plot::{Axis, Curve, Dash, Key, Panel};

const VIEWS: [f64; 21] = [
    1e-4, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7,
    0.8, 0.9, 0.95, 1.0,
];
/// Rows of a round lobe that take as long as one of an anisotropic lobe: 25 to 100 by the view, for
/// σ = (0.08, 0.4) and γ = 2.5. Only the share of progress depends on it.
const ANISOTROPIC: usize = 70;
/// The range of |1 − share|, the same in all figures: from about the rounding of single precision.
const RANGE: [f64; 2] = [1e-7, 1.0];

/// A share of the light that a furnace returns.
type Share = fn(&Furnace) -> f64;

/// The curves: name, index of the colour, dash and share.
const SHARES: [(&str, usize, Dash, Share); 3] = [
    ("one bounce", 1, Dash::Solid, |row| row.single),
    ("with Kulla–Conty's lobe", 0, Dash::Solid, |row| row.kulla_conty),
    ("with Turquin's scaling", 2, Dash::Dashed, |row| row.turquin),
];

/// The views of one lobe: in any direction of a round one, or along x and along y.
type Views = Vec<Vec<Furnace>>;

/// The estimated seconds of [`section`] on the current threads.
pub(super) fn seconds(set: &Tables) -> f64 {
    let rows = |shown: &Shown| shown.own_albedo(set).map_or(1, |_| ALONG.len() * ANISOTROPIC);
    furnace_seconds(Subjects::of(set).shown.iter().map(rows).sum::<usize>() * VIEWS.len())
}

pub(super) fn section(
    source: &Source,
    subjects: &Subjects,
    meter: &Meter,
) -> Result<Markup, ReportError> {
    let stage = meter.stage(seconds(source.set));
    stage.split(subjects.shown.len());
    let set = source.set.clone().with_fallback(&Tables::embedded());
    let of = |shown: &Shown| {
        let views = views(&set, shown);
        stage.step();
        views
    };
    let all: Vec<Result<Views, MaterialError>> = subjects.shown.par_iter().map(of).collect();
    let figure = |(shown, views): (&Shown, &Result<Views, MaterialError>)| match views {
        Ok(views) => drawn(source.set, shown, views),
        Err(why) => html! {
            p.note { b { (texts::name(&shown.name)) } ": not drawn, since " (why) "." }
        },
    };
    Ok(html! {
        @if !subjects.shown.is_empty() {
            p {
                "Kulla and Conty (2017) add a lobe for what is missing; Turquin (2019) scales the \
                 one bounce. Both read the albedo tables. The bounce itself is computed by \
                 quadrature of the model, without tables. Axes are logarithmic, and the same in \
                 all figures: at 10⁻³ a thousandth of the light is missing, or too much; what is \
                 below 10⁻⁷ is drawn there."
            }
            div.figures {
                @for pair in subjects.shown.iter().zip(&all) { (figure(pair)) }
            }
            @if subjects.left_out > 0 {
                p.note { (subjects.left_out) " more materials are not drawn." }
            }
        }
    })
}

fn views(set: &Tables, shown: &Shown) -> Result<Views, MaterialError> {
    let own = shown.own_albedo(set);
    let row = |phi: f64, cos: f64| match &own {
        Some(own) => anisotropic(own, shown.sigma, shown.gamma, cos, phi),
        None => furnace(set, shown.masking(), shown.round_sigma(), shown.gamma, cos),
    };
    let along = if own.is_some() { &ALONG[..] } else { &ALONG[..1] };
    along.iter().map(|&(phi, _)| VIEWS.par_iter().map(|&cos| row(phi, cos)).collect()).collect()
}

fn drawn(set: &Tables, shown: &Shown, views: &Views) -> Markup {
    let rows: Vec<&Furnace> = views.iter().flatten().collect();
    let [single, kulla_conty, turquin] = SHARES.map(|(.., share)| furthest(&rows, share));
    let lost = format!("{:.1}%", 100.0 * single[0]);
    let label = |along: &str| {
        format!(
            "White furnace of {}{along}: one bounce is off 1 by at most {lost}, with Kulla–Conty's \
             lobe {}, with Turquin's scaling {}",
            texts::short(&shown.name),
            error(kulla_conty[0]),
            error(turquin[0])
        )
    };
    let is_own = shown.own_albedo(set).is_some();
    let of_set = is_own || set.albedo(shown.round_sigma(), shown.gamma, shown.masking()).is_ok();
    html! {
        figure {
            div.plots {
                @for (rows, (_, along)) in views.iter().zip(ALONG) {
                    @let along = if is_own { format!(", view {along}") } else { String::new() };
                    (plot(panel(rows, format!("White furnace{along}")), &label(&along)))
                }
            }
            figcaption {
                b { (texts::name(&shown.name)) } ": " (shown.description()) ", "
                (shown.masking()) " masking. "
                "One bounce loses up to " (lost) ", at cos\u{a0}θ\u{a0}=\u{a0}" (single[1]) ". "
                "The largest deviation from 1 is " (error(kulla_conty[0]))
                " with Kulla–Conty's lobe and " (error(turquin[0])) " with Turquin's scaling. "
                @if is_own {
                    "Compensation reads its own albedo, over azimuth and view. "
                } @else if shown.sigma[0] != shown.sigma[1] {
                    "All three are of the round lobe of √(σx σy), which stands in for it. "
                }
                @if !of_set { "The albedo tables are those of the default set." }
            }
        }
    }
}

/// What is missing from 1, or too much, over the cosine of the view.
fn panel(rows: &[Furnace], title: String) -> Panel {
    let curve = |&(name, place, dash, share): &(&str, usize, Dash, Share)| {
        // A logarithm has no place for 0; NaN stays one.
        let off = |row: &Furnace| {
            let off = (1.0 - share(row)).abs();
            if off < RANGE[0] { RANGE[0] } else { off }
        };
        let points = rows.iter().map(|row| (row.cos_theta, off(row)));
        Curve::new(Key::Nth(place), name, points).dashed(dash)
    };
    let x = Axis::linear("cos θ, 0 for a grazing view", 0.0, 1.0);
    let y = Axis::log("|1 − share of light|", RANGE[0], RANGE[1]).coarse();
    Panel::new(title, x, y, SHARES.iter().map(curve))
}

/// The largest deviation of a share from 1, and cos θ there.
fn furthest(rows: &[&Furnace], share: Share) -> [f64; 2] {
    let off = rows.iter().map(|row| [(share(row) - 1.0).abs(), row.cos_theta]);
    // `total_cmp` orders NaN above all numbers.
    off.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([f64::NAN; 2])
}
