//! Writes materials as a recipe.

use std::borrow::Cow;
use std::fmt::Write as _;

use microfacet_tables::{Interval, LobeSpec, MaterialEntry};

use crate::distribution::{Distribution, Named};
use crate::escape;
use crate::input::angles::Angles;
use crate::scene::{Haze, Reflectance, Roughness};

/// Writes the recipe that [`read`](super::read) turns into the same materials.
pub(in crate::scene) fn write(materials: &[MaterialEntry]) -> String {
    materials.iter().map(entry).collect::<Vec<_>>().join("\n")
}

fn entry(material: &MaterialEntry) -> String {
    let mut text = format!("[[material]]\nname = {}\n", quoted(&material.name));
    // Writing to a string cannot fail.
    for key in lobe(&material.lobe) {
        let _ = writeln!(text, "{key}");
    }
    if let Some(fresnel) = material.fresnel {
        let value = match fresnel {
            Reflectance::Mirror => "\"mirror\"".to_owned(),
            Reflectance::Schlick([r, g, b]) if r == g && g == b => format!("{{ schlick = {r:?} }}"),
            Reflectance::Schlick(f0) => format!("{{ schlick = {f0:?} }}"),
            Reflectance::Conductor { eta, k } => {
                format!("{{ conductor = {{ eta = {eta:?}, k = {k:?} }} }}")
            }
            Reflectance::Dielectric(eta) | Reflectance::Interface { index: eta, .. } => {
                format!("{{ dielectric = {} }}", range(eta))
            }
        };
        let _ = writeln!(text, "fresnel = {value}");
    }
    if let Some(masking) = material.masking {
        let _ = writeln!(text, "masking = \"{}\"", masking.name());
    }
    if let Some(Haze { weight, lobe: of }) = &material.haze {
        let keys = [vec![format!("weight = {}", range(*weight))], lobe(of)].concat();
        // A comment would take the rest of the line with it.
        let begin = if keys.iter().any(|key| key.starts_with('#')) { "# " } else { "" };
        let _ = writeln!(text, "{begin}haze = {{ {} }}", keys.join(", "));
    }
    if material.is_retroreflecting() {
        let _ = writeln!(text, "retroreflection = {}", range(material.retroreflection));
    }
    text
}

/// The keys of a lobe with their values.
fn lobe(lobe: &LobeSpec) -> Vec<String> {
    let sigma = match lobe.roughness {
        Roughness::Smooth => range(Interval::point(0.0)),
        Roughness::Isotropic(sigma) => range(sigma),
        Roughness::Anisotropic { x, y } => format!("[{}, {}]", range(x), range(y)),
    };
    let mut keys = match &lobe.distribution {
        None => vec![format!("sigma = {sigma}"), format!("gamma = {}", range(lobe.gamma))],
        Some(label) => outside(label),
    };
    keys.extend(lobe.theta.map(|theta| format!("theta = {theta:?}")));
    keys
}

/// The keys of a distribution outside the family.
fn outside(label: &str) -> Vec<String> {
    if let Some((file, angles)) = Distribution::measured_of(label) {
        let unit = if angles == Angles::Degrees { ", degrees = true" } else { "" };
        return vec![format!("distribution = {{ measured = {}{unit} }}", quoted(file))];
    }
    let Ok(Named { kind, values }) = label.parse() else {
        // A label that no bake writes and no recipe can express.
        return vec![format!("# of the distribution {label:?}")];
    };
    let pairs = kind.parameters().iter().zip(values);
    let values = pairs.map(|(key, x)| format!("{key} = {}", range(Interval::point(x))));
    [format!("distribution = {}", quoted(kind.name()))].into_iter().chain(values).collect()
}

/// A string of TOML in which every character is seen.
pub(super) fn quoted(text: &str) -> String {
    match escape::line(text) {
        Cow::Borrowed(seen) => toml::Value::from(seen).to_string(),
        Cow::Owned(_) => escape::string(text),
    }
}

/// A number or a range; Rust's shortest form that reads back to the same bits is valid TOML.
pub(super) fn range(interval: Interval) -> String {
    let number = |x: f64| {
        if x == f64::INFINITY { "\"inf\"".to_owned() } else { format!("{x:?}") }
    };
    if interval.is_point() {
        number(interval.min)
    } else {
        format!("{{ min = {}, max = {} }}", number(interval.min), number(interval.max))
    }
}
