//! G1 and E of the lobes shown, compared with GGX and Beckmann of the same σ.

use std::f64::consts::PI;

use glam::Vec3;
use maud::{Markup, html};

use microfacet_baker::distribution::DistributionKind;
use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Lobe, MicrofacetDistribution, Tables};
use microfacet_tables::MaterialEntry;

use super::Source;
use super::drawing::{plot, symbols, unbroken};
use super::subjects::{ALONG, SHOWN, Shown, Subjects};
use super::texts;
use crate::plot::{Axis, Curve, Dash, Key, Panel};
use crate::words::material::material;
use crate::words::{number, range};

/// Intervals of θ along a curve, denser at the normal, where heavy tails fall, and at the horizon.
const VIEWS: u32 = 45;
/// Most letters of a name in a legend.
const LEGEND: usize = 28;
/// θ in degrees of the view whose values captions state.
const STATED: f64 = 80.0;

struct Line {
    name: String,
    key: Key,
    dash: Dash,
    /// The azimuth of its views in radians.
    phi: f64,
    /// G1 of a view, and E if a table covers it; a line may be of one of them.
    quantities: [Option<Quantity>; 2],
}

type Quantity = Box<dyn Fn(Vec3) -> f32>;

fn masking_of(lobe: Lobe) -> Quantity {
    Box::new(move |v| lobe.g1(v))
}

fn albedo_of(albedo: Albedo) -> Quantity {
    Box::new(move |v| albedo.albedo(v))
}

/// Titles and labels of the panels, one for each of `Line::quantities`.
const PANELS: [[&str; 2]; 2] = [
    ["Masking", "G1, the share of facets that is seen"],
    ["Directional albedo, F = 1", "E, the share of light that returns"],
];

impl Line {
    fn new(name: String, key: Key, dash: Dash, lobe: Lobe, albedo: Option<Albedo>) -> Self {
        let quantities = [Some(masking_of(lobe)), albedo.map(albedo_of)];
        Self { name, key, dash, phi: 0.0, quantities }
    }

    fn of_family(set: &Tables, shown: &Shown, gamma: f64) -> Option<Self> {
        let lobe = set.lobe(shown.sigma, gamma).ok()?;
        let albedo = set.albedo(shown.round_sigma(), gamma, shown.masking()).ok();
        let (name, key, dash) = match gamma {
            2.0 => ("GGX".into(), Key::Kind(DistributionKind::TrowbridgeReitz), Dash::Dashed),
            f64::INFINITY => {
                ("Beckmann".into(), Key::Kind(DistributionKind::Beckmann), Dash::Dotted)
            }
            _ => (format!("γ = {}", number(gamma)), Key::TABLE, Dash::Solid),
        };
        // The lobe that the figure is about has a solid line, even if it is GGX or Beckmann.
        let dash = if gamma == shown.gamma { Dash::Solid } else { dash };
        Some(Self::new(name, key, dash, lobe, albedo))
    }

    /// An anisotropic lobe with an albedo of its own, seen along x and along y, with GGX of the
    /// same σx and σy, and E of the round lobe that would stand in for it.
    fn of_anisotropic(set: &Tables, shown: &Shown, own: &Albedo) -> Vec<Self> {
        let lines = |gamma: f64, dash, of: &str, albedo: Option<&Albedo>| -> Vec<Self> {
            let Ok(lobe) = set.lobe(shown.sigma, gamma) else { return Vec::new() };
            let line = |(i, &(phi, along)): (usize, &(f64, &str))| Self {
                phi,
                ..Self::new(
                    format!("{of}{along}"),
                    Key::Nth(i),
                    dash,
                    lobe.clone(),
                    albedo.cloned(),
                )
            };
            ALONG.iter().enumerate().map(line).collect()
        };
        let mut all = lines(shown.gamma, Dash::Solid, "", Some(own));
        if shown.gamma != 2.0 {
            all.extend(lines(2.0, Dash::Dashed, "GGX, ", None));
        }
        let round = set.albedo(shown.round_sigma(), shown.gamma, shown.masking()).ok();
        all.extend(round.map(|round| {
            let (name, quantities) = ("the round lobe".into(), [None, Some(albedo_of(round))]);
            Self { name, key: Key::OTHER, dash: Dash::Dotted, phi: 0.0, quantities }
        }));
        all
    }

    /// A lobe with tables of its own, or tilted.
    fn of_material(set: &Tables, entry: &MaterialEntry) -> Option<Self> {
        let lobe = set.material(&entry.name).ok()?;
        let albedo = set.material_albedo(&entry.name).ok();
        let tilted = || format!("γ = {}, tilted", symbols(&range(entry.lobe.gamma)));
        let name = entry.lobe.distribution.clone().unwrap_or_else(tilted);
        let name = texts::cut(&name, LEGEND).into_owned();
        Some(Self::new(name, Key::TABLE, Dash::Solid, lobe, albedo))
    }

    fn curve(&self, quantity: usize) -> Option<Curve> {
        let of = self.quantities[quantity].as_ref()?;
        let points = (0..=VIEWS).map(|i| {
            let degrees = 45.0 * (1.0 - (PI * f64::from(i) / f64::from(VIEWS)).cos());
            (degrees / 90.0, f64::from(of(view(degrees, self.phi))))
        });
        Some(Curve::new(self.key, &self.name, points).dashed(self.dash))
    }

    /// The quantity at θ = [`STATED`], with the name of the lobe.
    fn stated(&self, quantity: usize) -> Option<String> {
        let value = self.quantities[quantity].as_ref()?(view(STATED, self.phi));
        Some(format!("{value:.3} ({})", unbroken(&self.name)))
    }
}

/// The view direction at this angle from the normal and this azimuth.
fn view(degrees: f64, phi: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (y, x) = phi.sin_cos();
    Vec3::new((sin * x) as f32, (sin * y) as f32, cos.max(0.0) as f32)
}

pub(super) fn section(source: &Source, subjects: &Subjects) -> Markup {
    let set = source.set.clone().with_fallback(&Tables::embedded());
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

/// Materials whose lobes are drawn without GGX and Beckmann: tilted, or outside the family.
fn others(set: &Tables) -> Vec<&MaterialEntry> {
    let is_other = |entry: &&MaterialEntry| {
        let family = entry.lobe.is_upright();
        !family && !entry.lobe.is_smooth() && set.material(&entry.name).is_ok()
    };
    set.provenance().materials.iter().filter(is_other).collect()
}

/// A lobe of the family with GGX and Beckmann of the same σ.
fn of_family(set: &Tables, shown: &Shown) -> Markup {
    if let Some(own) = shown.own_albedo(set) {
        let what = html! {
            b { (texts::name(&shown.name)) } ": " (shown.description())
            ", seen along x and along y. E is that of its own table, over azimuth and view; beside \
             it stands E of the round lobe of σ = √(σx σy). "
        };
        return figure(&shown.name, &Line::of_anisotropic(set, shown, &own), &what);
    }
    let beside = [2.0, f64::INFINITY].into_iter().filter(|&gamma| gamma != shown.gamma);
    let gammas = std::iter::once(shown.gamma).chain(beside);
    let lines: Vec<Line> = gammas.filter_map(|gamma| Line::of_family(set, shown, gamma)).collect();
    let stands_in = shown.sigma[0] != shown.sigma[1];
    let what = html! {
        b { (texts::name(&shown.name)) } ": " (shown.description()) ". "
        @if stands_in {
            "The views of G1 lie along x. E is that of the round lobe of σ = √(σx σy) = "
            (number(shown.round_sigma())) ", which stands in for it. "
        }
    };
    figure(&shown.name, &lines, &what)
}

fn of_material(set: &Tables, entry: &MaterialEntry) -> Markup {
    let Some(line) = Line::of_material(set, entry) else { return html! {} };
    let what = html! {
        b { (texts::name(&entry.name)) } ": " (texts::words(&symbols(&material(entry))))
        ". The views lie along x. "
    };
    figure(&entry.name, &[line], &what)
}

/// The plots of some lobes; the first lobe is the subject of the figure.
fn figure(name: &str, lines: &[Line], what: &Markup) -> Markup {
    let drawn: [(Vec<Curve>, String); 2] = std::array::from_fn(|i| {
        let stated: Vec<String> = lines.iter().filter_map(|line| line.stated(i)).collect();
        (lines.iter().filter_map(|line| line.curve(i)).collect(), stated.join(", "))
    });
    let degrees = [0.0, 90.0, 30.0, 60.0].map(|x| (x / 90.0, number(x)));
    let views = || Axis::marked("θ, the angle of the view, degrees", degrees.clone());
    html! {
        figure {
            div.plots {
                @for ([title, label], (curves, stated)) in PANELS.iter().zip(&drawn) {
                    @if !curves.is_empty() {
                        @let y = Axis::linear(*label, 0.0, 1.0);
                        (plot(
                            Panel::new(*title, views(), y, curves.clone()),
                            &format!("{label}, of {}. Seen at {STATED}°: {stated}.", texts::short(name)),
                        ))
                    }
                }
            }
            figcaption {
                (what)
                "Seen at " (STATED) "°, "
                @for (i, ([_, label], (curves, stated))) in PANELS.iter().zip(&drawn).enumerate() {
                    @let quantity = label.split(',').next().unwrap_or_default();
                    @if i > 0 { "; " }
                    @if curves.is_empty() {
                        "no table covers " (quantity)
                    } @else {
                        (quantity) " is " (stated)
                    }
                }
                "."
            }
        }
    }
}
