//! Writes materials as a recipe.

use std::fmt::Write as _;

use microfacet_tables::{Interval, MaterialEntry};

use crate::distribution::{Distribution, Named};
use crate::input::angles::Angles;
use crate::scene::{Reflectance, Roughness};

/// Writes the recipe that [`read`](super::read) turns into the same materials.
pub(in crate::scene) fn write(materials: &[MaterialEntry]) -> String {
    materials.iter().map(entry).collect::<Vec<_>>().join("\n")
}

fn entry(material: &MaterialEntry) -> String {
    let mut text = format!("[[material]]\nname = {}\n", quoted(&material.name));
    let sigma = match material.lobe.roughness {
        Roughness::Smooth => range(Interval::point(0.0)),
        Roughness::Isotropic(sigma) => range(sigma),
        Roughness::Anisotropic { x, y } => format!("[{}, {}]", range(x), range(y)),
    };
    // Writing to a string cannot fail.
    let label = material.lobe.distribution.as_ref();
    let _ = match label.map(|label| (Distribution::measured_of(label), label.parse::<Named>())) {
        None => writeln!(text, "sigma = {sigma}\ngamma = {}", range(material.lobe.gamma)),
        Some((Some((file, angles)), _)) => {
            let unit = if angles == Angles::Degrees { ", degrees = true" } else { "" };
            writeln!(text, "distribution = {{ measured = {}{unit} }}", quoted(file))
        }
        // A label that no bake writes and no recipe can express.
        Some((None, Err(_))) => writeln!(text, "# of the distribution {label:?}"),
        Some((None, Ok(named))) => {
            let number = |x: f64| range(Interval::point(x));
            let pairs = named.kind.parameters().iter().zip(&named.values);
            let values: String =
                pairs.map(|(key, x)| format!("\n{key} = {}", number(*x))).collect();
            writeln!(text, "distribution = {}{values}", quoted(named.kind.name()))
        }
    };
    if let Some(theta) = material.lobe.theta {
        let _ = writeln!(text, "theta = {theta:?}");
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
    text
}

pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
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
