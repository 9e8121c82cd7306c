//! What of a set is shown: shapes of the sphere, and lobes with curves and pictures.

use std::f64::consts::FRAC_PI_2;

use microfacet_core::shape::gamma_of_s;
use microfacet_sampler::albedo::Albedo;
use microfacet_sampler::{Masking, Tables};
use microfacet_tables::MaterialEntry;

use super::drawing::{symbols, unbroken};
use crate::words::number;

/// Most shapes whose visible normals a page holds; others are sampled from the next heavier tails.
const SLICES: usize = 8;
/// Most shapes that a page offers.
const STOPS: usize = 64;
/// Most materials with curves, a furnace and a picture of their own.
pub(super) const SHOWN: usize = 8;

/// Stops of γ within a range, at short numbers; ∞ is one too.
const ROUND: [f64; 40] = [
    1.501, 1.51, 1.52, 1.55, 1.6, 1.65, 1.7, 1.75, 1.8, 1.85, 1.9, 1.95, 2.0, 2.1, 2.2, 2.3, 2.4,
    2.5, 2.6, 2.8, 3.0, 3.2, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0,
    40.0, 50.0, 60.0, 80.0, 100.0,
];

/// Shapes and roughness that are shown for a set without materials by name.
const SHAPES: [f64; 6] = [1.501, 1.65, 2.0, 3.0, 5.0, f64::INFINITY];
const SIGMA: f64 = 0.3;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Subjects {
    /// The shapes γ that the sphere can have, ascending.
    pub(super) stops: Vec<f64>,
    /// The stops whose visible normals the page holds, ascending; the first is the first stop.
    pub(super) slices: Vec<f64>,
    /// Whether the set holds a range of shapes, of which the stops are examples.
    pub(super) is_range: bool,
    /// Lobes with curves and pictures of their own.
    pub(super) shown: Vec<Shown>,
    /// Number of lobes beyond [`SHOWN`], which are left out.
    pub(super) left_out: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shown {
    pub(super) name: String,
    pub(super) gamma: f64,
    pub(super) sigma: [f64; 2],
    /// The material of the recipe that it is.
    pub(super) entry: Option<MaterialEntry>,
}

/// Directions of the view for a lobe that is not round: azimuth in radians, and name.
pub(super) const ALONG: [(f64, &str); 2] = [(0.0, "along x"), (FRAC_PI_2, "along y")];

pub(super) fn shape(gamma: f64) -> String {
    unbroken(&format!("γ = {}", symbols(&number(gamma))))
}

impl Subjects {
    pub(super) fn of(set: &Tables) -> Self {
        let materials: Vec<&MaterialEntry> =
            set.provenance().materials.iter().filter(|entry| is_shown(set, entry)).collect();
        let (stops, is_range) = stops(set, &materials);
        let slices = slices(&stops);
        let by_name = materials.iter().map(|entry| Shown {
            name: entry.name.clone(),
            gamma: entry.lobe.gamma(),
            sigma: entry.lobe.sigma(),
            entry: Some((*entry).clone()),
        });
        let mut shown: Vec<Shown> = by_name.collect();
        if shown.is_empty() {
            let gammas: &[f64] = if is_range { &SHAPES } else { &stops };
            let is_stop = |gamma: &&f64| stops.contains(gamma);
            shown = gammas.iter().filter(is_stop).map(|&gamma| Shown::example(gamma)).collect();
        }
        let left_out = shown.len().saturating_sub(SHOWN);
        shown.truncate(SHOWN);
        Self { stops, slices, is_range, shown, left_out }
    }

    /// Which of the lobes is shown first: the first material, or among examples that of γ = 3.
    pub(super) fn opening(&self) -> usize {
        let is_example = |shown: &Shown| shown.entry.is_none() && shown.gamma == 3.0;
        self.shown.iter().position(is_example).unwrap_or(0)
    }
}

impl Shown {
    /// σ of a round lobe, or of the round lobe that stands in for another.
    pub(super) fn round_sigma(&self) -> f64 {
        self.entry.as_ref().map_or(self.sigma[0], |entry| entry.lobe.round_sigma())
    }

    /// The albedo of its own table, if it is not round and the set has one.
    pub(super) fn own_albedo(&self, set: &Tables) -> Option<Albedo> {
        let entry = self.entry.as_ref().filter(|_| self.sigma[0] != self.sigma[1])?;
        set.material_albedo(&entry.name).ok().filter(|_| !entry.lobe.tabulated().is_family())
    }

    /// The form of masking that it states, or the default.
    pub(super) fn masking(&self) -> Masking {
        self.entry.as_ref().map_or(Masking::default(), MaterialEntry::masking)
    }

    /// Its γ, unless that is its name, and σ, in words.
    pub(super) fn description(&self) -> String {
        let [x, y] = self.sigma.map(number);
        let sigma = if x == y { format!("σ = {x}") } else { format!("σx = {x}, σy = {y}") };
        let gamma = shape(self.gamma);
        let words = if self.name == gamma { sigma } else { format!("{gamma}, {sigma}") };
        unbroken(&words)
    }

    fn example(gamma: f64) -> Self {
        let name = match gamma {
            2.0 => "GGX".into(),
            f64::INFINITY => "Beckmann".into(),
            _ => shape(gamma),
        };
        Self { name, gamma, sigma: [SIGMA; 2], entry: None }
    }
}

/// Whether a material has a lobe of the family that is not tilted, which this set serves.
fn is_shown(set: &Tables, entry: &MaterialEntry) -> bool {
    let family = entry.lobe.is_upright() && !entry.lobe.is_smooth();
    family && set.covers(entry.lobe.gamma())
}

/// The shapes to choose from, and whether some are examples of a range.
fn stops(set: &Tables, materials: &[&MaterialEntry]) -> (Vec<f64>, bool) {
    // Ends have passed through 1/(γ−1), which spoils the last digits of a short number.
    let short = |x: f64| format!("{x:.9e}").parse().unwrap_or(x);
    let mut stops: Vec<f64> = materials.iter().map(|entry| entry.lobe.gamma()).collect();
    let mut is_range = false;
    for [low, high] in set.shapes() {
        let [least, most] = [high, low].map(|s| short(gamma_of_s(s)));
        stops.extend([least, most]);
        if least < most {
            is_range = true;
            let round = ROUND.into_iter().chain([f64::INFINITY]);
            stops.extend(round.filter(|gamma| (least..=most).contains(gamma)));
        }
    }
    stops.retain(|&gamma| set.covers(gamma));
    stops.sort_by(f64::total_cmp);
    stops.dedup();
    stops.truncate(STOPS);
    (stops, is_range)
}

/// The heaviest tails, and others evenly among the rest.
fn slices(stops: &[f64]) -> Vec<f64> {
    if stops.len() <= SLICES {
        return stops.to_vec();
    }
    (0..SLICES).map(|i| stops[i * (stops.len() - 1) / (SLICES - 1)]).collect()
}
