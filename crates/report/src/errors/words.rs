//! Maps of errors in words.

use microfacet_sampler::Masking;
use microfacet_tables::{Axis, Kind, Reflectance, Table};

use super::super::drawing::error;
use crate::error_map::{ErrorMap, Quantity};
use crate::words::certificate;

pub(super) fn what(table: &Table) -> String {
    let form = || match table.subject.masking.unwrap_or_default() {
        Masking::Uncorrelated => "uncorrelated masking",
        Masking::HeightCorrelated => "height-correlated masking",
    };
    match table.kind {
        Kind::Shadowing | Kind::RadialShadowing => "Masking G1".into(),
        Kind::VisibleSlope | Kind::RadialSlope => "In-plane slopes".into(),
        Kind::VisibleSlopePeeled => "In-plane slopes of heavy tails".into(),
        Kind::VisibleSlopeConditional | Kind::RadialConditional => "Slopes across".into(),
        Kind::RadialDensity => "Density D".into(),
        Kind::AlbedoAverage => format!("Average albedo, {}", form()),
        _ => match table.subject.reflectance {
            Some(Reflectance::Conductor { .. }) => format!("Albedo of a metal, {}", form()),
            Some(Reflectance::Dielectric { .. }) => format!("Albedo of a dielectric, {}", form()),
            _ => format!("Albedo, {}", form()),
        },
    }
}

pub(super) fn axis(quantity: Quantity) -> &'static str {
    spoken(quantity)[0]
}

fn symbol(quantity: Quantity) -> &'static str {
    spoken(quantity)[1]
}

fn spoken(quantity: Quantity) -> [&'static str; 2] {
    match quantity {
        Quantity::Gamma => ["shape γ", "γ"],
        Quantity::Sigma => ["roughness σ", "σ"],
        Quantity::Eta => ["index of refraction η", "η"],
        Quantity::Azimuth => ["azimuth of the view, degrees", "φ"],
        Quantity::Cosine => ["cos θ of the view", "cos θ"],
        Quantity::Cotangent => ["view, cot θ / σ", "cot θ/σ"],
        Quantity::Slope => ["slope / σ", "the slope"],
        Quantity::Number => ["random number u", "u"],
    }
}

/// A number to four digits: `1.501`, `0.02`, `∞`; five where it is so close to 1 that four are 1.
pub(super) fn number(x: f64) -> String {
    if x == f64::INFINITY {
        return "∞".into();
    }
    let digits = if (1.0 - x).abs() < 1e-3 { 5 } else { 3 };
    let rounded: f64 = format!("{x:.digits$e}").parse().unwrap_or(x);
    match rounded.abs() {
        1e-3..1e5 | 0.0 => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
    .replace('-', "−")
}

/// A quantity with its value, which no line breaks.
fn value(quantity: Quantity, x: f64) -> String {
    let degrees = if quantity == Quantity::Azimuth { "°" } else { "" };
    format!("{}\u{a0}=\u{a0}{}{degrees}", symbol(quantity), number(x)).replace(' ', "\u{a0}")
}

/// The largest error that a certificate states, and where it is.
pub(super) fn certified(table: &Table) -> String {
    let worst = table.certificate.worst();
    if worst == f64::INFINITY {
        return "It has no certificate.".into();
    }
    let place = |axis: &Axis| {
        let quantity = Quantity::of(axis);
        Some(value(quantity, quantity.worst(table)?))
    };
    let places: Vec<String> = table.axes.iter().filter_map(place).collect();
    let at = if places.is_empty() { String::new() } else { format!(" at {}", places.join(", ")) };
    format!("Certified to {}{at}.", error(worst))
}

/// The whole certificate, as sentences.
pub(super) fn lines(table: &Table) -> Vec<String> {
    certificate::lines(&table.certificate).iter().map(|line| sentence(line)).collect()
}

/// A text as a sentence by itself.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// What a map of a table shows, for its caption.
pub(super) fn map(table: &Table, map: &ErrorMap) -> String {
    let rows = map.errors.len() / map.columns;
    let grid = match rows {
        1 => format!("{} pixels", map.columns),
        _ => format!("{}\u{a0}×\u{a0}{rows} pixels", map.columns),
    };
    let largest = map.largest();
    let mut text = if largest.is_nan() {
        "Some errors here are not a number: report it.".to_owned()
    } else {
        format!("Here it is at most {}", error(largest))
    };
    let fixed: Vec<String> = map.fixed.iter().map(|&(quantity, x)| value(quantity, x)).collect();
    if !fixed.is_empty() {
        text += &format!(", for {}", fixed.join(", "));
    }
    let over: Vec<&str> = map.over.iter().map(|quantity| symbol(*quantity)).collect();
    if !over.is_empty() {
        text += &format!(", over all {}", over.join(" and "));
    }
    text += &format!("; measured at {} points, shown in {grid}.", map.points);
    if largest > table.certificate.worst() {
        text += " That is more than its certificate promises: the search that ended the bake went \
                 by another way.";
    }
    text
}

/// What a map shows, for screen readers.
pub(super) fn label(table: &Table, map: &ErrorMap) -> String {
    let y = map.y.as_ref().map(|y| format!(" and {}", axis(y.quantity)));
    format!(
        "{}: errors over {}{}; the largest is {}",
        what(table),
        axis(map.x.quantity),
        y.unwrap_or_default(),
        error(map.largest())
    )
}
