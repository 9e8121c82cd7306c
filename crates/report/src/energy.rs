//! The white furnace before and after compensation.

use maud::{Markup, html};
use microfacet_baker::progress::Meter;
use microfacet_sampler::{MaterialError, Tables};
use microfacet_validate::furnace::{Furnace, furnace, seconds as furnace_seconds};
use rayon::prelude::*;

use super::drawing::{error, plot};
use super::subjects::{Shown, Subjects};
use super::{ReportError, Source};
use crate::plot::{Axis, Curve, Dash, Key, Panel};

const VIEWS: [f64; 21] = [
    1e-4, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7,
    0.8, 0.9, 0.95, 1.0,
];

/// A share of the light that a furnace returns.
type Share = fn(&Furnace) -> f64;

/// The curves: name, index of the colour, dash and share.
const SHARES: [(&str, usize, Dash, Share); 3] = [
    ("one bounce", 1, Dash::Solid, |row| row.single),
    ("with Kulla–Conty's lobe", 0, Dash::Solid, |row| row.kulla_conty),
    ("with Turquin's scaling", 2, Dash::Dashed, |row| row.turquin),
];

/// The estimated seconds of [`section`] on the current threads.
pub(super) fn seconds(set: &Tables) -> f64 {
    furnace_seconds(Subjects::of(set).shown.len() * VIEWS.len())
}

pub(super) fn section(
    source: &Source,
    subjects: &Subjects,
    meter: &Meter,
) -> Result<Markup, ReportError> {
    let stage = meter.stage(seconds(source.set));
    stage.split(subjects.shown.len() * VIEWS.len());
    let set = source.set.clone().with_fallback(&Tables::embedded());
    let furnaces: Vec<Result<Vec<Furnace>, MaterialError>> = subjects
        .shown
        .par_iter()
        .map(|shown| {
            let row = |&cos: &f64| {
                let row = furnace(&set, shown.masking(), shown.round_sigma(), shown.gamma, cos);
                stage.step();
                row
            };
            VIEWS.par_iter().map(row).collect()
        })
        .collect();
    let figure = |(shown, rows): (&Shown, &Result<Vec<Furnace>, MaterialError>)| match rows {
        Ok(rows) => drawn(source.set, shown, rows),
        Err(why) => html! {
            p.note { b { bdi { (shown.name) } } ": not drawn, since " (why) "." }
        },
    };
    Ok(html! {
        @if !subjects.shown.is_empty() {
            p {
                "Kulla and Conty (2017) add a lobe for what is missing; Turquin (2019) scales the \
                 one bounce. Both read the albedo tables. The bounce itself is computed by \
                 quadrature of the model, without tables."
            }
            div.figures {
                @for pair in subjects.shown.iter().zip(&furnaces) { (figure(pair)) }
            }
            @if subjects.left_out > 0 {
                p.note { (subjects.left_out) " more materials are not drawn." }
            }
        }
    })
}

fn drawn(set: &Tables, shown: &Shown, rows: &[Furnace]) -> Markup {
    let curve = |&(name, place, dash, share): &(&str, usize, Dash, Share)| {
        let points = rows.iter().map(|row| (row.cos_theta, share(row)));
        Curve::new(Key::Nth(place), name, points).dashed(dash)
    };
    let [single, kulla_conty, turquin] = SHARES.map(|(.., share)| furthest(rows, share));
    let least = rows.iter().flat_map(|row| SHARES.map(|(.., share)| share(row)));
    // A tenth below the lowest value, so that no curve lies on the edge.
    let low = ((least.fold(1.0, f64::min) * 10.0).floor() / 10.0 - 0.1).clamp(0.0, 0.8);
    let x = Axis::linear("cos θ, 0 for a grazing view", 0.0, 1.0);
    let y = Axis::linear("share of light that returns", low, 1.05);
    let panel = Panel::new("White furnace", x, y, SHARES.iter().map(curve));
    let lost = format!("{:.1}%", 100.0 * single[0]);
    let label = format!(
        "White furnace of {}: one bounce is off 1 by at most {lost}, with Kulla–Conty's lobe {}, \
         with Turquin's scaling {}",
        shown.name,
        error(kulla_conty[0]),
        error(turquin[0])
    );
    let own = set.albedo(shown.round_sigma(), shown.gamma, shown.masking()).is_ok();
    html! {
        figure {
            div.plots { (plot(panel, &label)) }
            figcaption {
                b { bdi { (shown.name) } } ": " (shown.description()) ", "
                (shown.masking()) " masking. "
                "One bounce loses up to " (lost) ", at cos\u{a0}θ\u{a0}=\u{a0}" (single[1]) ". "
                "The largest deviation from 1 is " (error(kulla_conty[0]))
                " with Kulla–Conty's lobe and " (error(turquin[0])) " with Turquin's scaling. "
                @if shown.sigma[0] != shown.sigma[1] {
                    "All three are of the round lobe of √(σx σy), which stands in for it. "
                }
                @if !own { "The albedo tables are those of the default set." }
            }
        }
    }
}

/// The largest deviation of a share from 1, and cos θ there.
fn furthest(rows: &[Furnace], share: Share) -> [f64; 2] {
    let off = rows.iter().map(|row| [(share(row) - 1.0).abs(), row.cos_theta]);
    // `total_cmp` orders NaN above all numbers.
    off.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([f64::NAN; 2])
}
