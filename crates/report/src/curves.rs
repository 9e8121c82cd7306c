//! G1 and E of the lobes shown, beside GGX and Beckmann of the same σ.

use std::f64::consts::PI;

use glam::Vec3;
use maud::{Markup, html};

use microfacet_baker::distribution::DistributionKind;
use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Lobe, MicrofacetDistribution, Tables};
use microfacet_tables::MaterialEntry;

use super::Source;
use super::drawing::{plot, symbols, unbroken};
use super::subjects::{SHOWN, Shown, Subjects};
use crate::plot::{Axis, Curve, Dash, Key, Method, Panel};
use crate::words::material::material;
use crate::words::{number, range};

/// Views of a curve from the normal to the horizon, denser at both: heavy tails fall steeply at the
/// one, and all albedos rise at the other.
const VIEWS: u32 = 45;
/// The view of which captions state the numbers, in degrees.
const STATED: f64 = 80.0;

/// A lobe that is drawn.
struct Line {
    name: String,
    key: Key,
    dash: Dash,
    lobe: Lobe,
    /// E, of the round lobe of √(σx σy); `None` where no table covers it.
    albedo: Option<Albedo>,
}

impl Line {
    /// A lobe of the family, in its own colour.
    fn of_family(set: &Tables, shown: &Shown, gamma: f64) -> Option<Self> {
        let lobe = set.lobe(shown.sigma, gamma).ok()?;
        let albedo = set.albedo(shown.round_sigma(), gamma, shown.masking()).ok();
        let (name, key, dash) = match gamma {
            2.0 => ("GGX".into(), Key::Kind(DistributionKind::TrowbridgeReitz), Dash::Dashed),
            f64::INFINITY => {
                ("Beckmann".into(), Key::Kind(DistributionKind::Beckmann), Dash::Dotted)
            }
            _ => (format!("γ = {}", number(gamma)), Key::Method(Method::Table), Dash::Solid),
        };
        // The lobe itself is drawn without gaps, whatever it is.
        let dash = if gamma == shown.gamma { Dash::Solid } else { dash };
        Some(Self { name, key, dash, lobe, albedo })
    }

    /// A lobe with tables of its own, or tilted.
    fn of_material(set: &Tables, entry: &MaterialEntry) -> Option<Self> {
        let lobe = set.material(&entry.name).ok()?;
        let albedo = set.material_albedo(&entry.name).ok();
        let (key, dash) = (Key::Method(Method::Table), Dash::Solid);
        let tilted = || format!("γ = {}, tilted", symbols(&range(entry.lobe.gamma)));
        let name = entry.lobe.distribution.clone().unwrap_or_else(tilted);
        Some(Self { name, key, dash, lobe, albedo })
    }

    fn g1(&self, v: Vec3) -> Option<f64> {
        Some(f64::from(self.lobe.g1(v)))
    }

    fn albedo(&self, v: Vec3) -> Option<f64> {
        Some(f64::from(self.albedo.as_ref()?.albedo(v)))
    }
}

/// A quantity of a lobe and a view.
type Quantity = fn(&Line, Vec3) -> Option<f64>;

/// What is drawn of each lobe.
const PANELS: [(&str, &str, Quantity); 2] = [
    ("Masking", "G1, the share of facets that is seen", Line::g1),
    ("Directional albedo, F = 1", "E, the share of light that returns", Line::albedo),
];

pub(super) fn section(source: &Source, subjects: &Subjects) -> Markup {
    let set = source.set.clone().or_embedded();
    let others = others(source.set);
    let room = SHOWN.saturating_sub(subjects.shown.len());
    let left_out = subjects.left_out + others.len().saturating_sub(room);
    html! {
        div.figures {
            @for shown in &subjects.shown { (of_family(&set, shown)) }
            @for entry in others.iter().take(room) { (of_material(&set, entry)) }
        }
        @if left_out > 0 {
            p.note { (left_out) " more materials are not drawn." }
        }
    }
}

/// Materials with lobes that GGX and Beckmann do not compare with.
fn others(set: &Tables) -> Vec<&MaterialEntry> {
    let is_other = |entry: &&MaterialEntry| {
        let family = entry.lobe.is_upright();
        !family && !entry.lobe.is_smooth() && set.material(&entry.name).is_ok()
    };
    set.provenance().materials.iter().filter(is_other).collect()
}

/// A lobe of the family beside the two that everybody knows.
fn of_family(set: &Tables, shown: &Shown) -> Markup {
    let beside = [2.0, f64::INFINITY].into_iter().filter(|&gamma| gamma != shown.gamma);
    let gammas = std::iter::once(shown.gamma).chain(beside);
    let lines: Vec<Line> = gammas.filter_map(|gamma| Line::of_family(set, shown, gamma)).collect();
    let stands_in = shown.sigma[0] != shown.sigma[1];
    let what = html! {
        b { bdi { (shown.name) } } ": " (shown.description()) ". "
        @if stands_in {
            "The views of G1 lie along x. E is that of the round lobe of σ = √(σx σy) = "
            (number(shown.round_sigma())) ", which stands in for it. "
        }
    };
    figure(&shown.name, &lines, &what)
}

/// A lobe alone.
fn of_material(set: &Tables, entry: &MaterialEntry) -> Markup {
    let Some(line) = Line::of_material(set, entry) else { return html! {} };
    let what = html! {
        b { bdi { (entry.name) } } ": " bdi { (symbols(&material(entry))) }
        ". The views lie along x. "
    };
    figure(&entry.name, &[line], &what)
}

/// The plots of some lobes, the first of which it is about.
fn figure(name: &str, lines: &[Line], what: &Markup) -> Markup {
    let drawn = PANELS.map(|(title, label, quantity)| {
        let curves: Vec<Curve> = lines.iter().filter_map(|line| curve(line, quantity)).collect();
        let numbers: Vec<String> = lines.iter().filter_map(|line| at(line, quantity)).collect();
        (title, label, curves, numbers.join(", "))
    });
    let views = || Axis::linear("θ, the angle of the view, degrees", 0.0, 90.0);
    html! {
        figure {
            div.plots {
                @for (title, label, curves, numbers) in &drawn {
                    @if !curves.is_empty() {
                        (plot(
                            Panel::new(*title, views(), Axis::linear(*label, 0.0, 1.0), curves.clone()),
                            &format!("{label}, of {name}. Seen at {STATED}°: {numbers}."),
                        ))
                    }
                }
            }
            figcaption {
                (what)
                "Seen at " (STATED) "°, "
                @for (i, (_, label, curves, numbers)) in drawn.iter().enumerate() {
                    @let quantity = label.split(',').next().unwrap_or_default();
                    @if i > 0 { "; " }
                    @if curves.is_empty() {
                        "no table covers " (quantity)
                    } @else {
                        (quantity) " is " (numbers)
                    }
                }
                "."
            }
        }
    }
}

/// A view at this many degrees from the normal, in the azimuth of x.
fn view(degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(sin as f32, 0.0, cos.max(0.0) as f32)
}

fn curve(line: &Line, quantity: Quantity) -> Option<Curve> {
    let point = |i: u32| {
        let degrees = 45.0 * (1.0 - (PI * f64::from(i) / f64::from(VIEWS)).cos());
        Some((degrees, quantity(line, view(degrees))?))
    };
    let points = (0..=VIEWS).map(point).collect::<Option<Vec<_>>>()?;
    Some(Curve::new(line.key, &line.name, points).dashed(line.dash))
}

/// The quantity at the view that is stated, with the name of the lobe.
fn at(line: &Line, quantity: Quantity) -> Option<String> {
    let value = quantity(line, view(STATED))?;
    Some(format!("{value:.3} ({})", unbroken(&line.name)))
}
