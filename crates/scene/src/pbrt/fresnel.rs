//! Fresnel terms of pbrt's materials.

use std::path::Path;

use microfacet_baker::scene::{Reflectance, SceneError};
use microfacet_sampler::Metal;

use super::definition::{Definition, Parameter};
use crate::Result;
use crate::fresnel::{conductor, dielectric, metal};

/// pbrt's upper limit of a conductor's reflectance, at which k is still finite.
const MOST_REFLECTIVE: f64 = 0.9999;

/// Indices of refraction of pbrt's glasses at the d line, 587.56 nm.
///
/// They are read from the tables of pbrt's `util/spectrum.cpp`, which are of refractiveindex.info
/// (CC0), linearly between the two nearest wavelengths as pbrt does, and rounded to five decimals.
/// Under the names F5, F10 and F11 it has the tables of SF5, SF10 and SF11.
const GLASSES: [(&str, f64); 7] = [
    ("glass-BK7", 1.516_80),
    ("glass-BAF10", 1.670_00),
    ("glass-FK51A", 1.486_56),
    ("glass-LASF9", 1.850_27),
    ("glass-F5", 1.672_72),
    ("glass-F10", 1.728_28),
    ("glass-F11", 1.784_74),
];

impl Parameter {
    /// Three numbers, if it is a colour.
    fn rgb(&self) -> Option<[f64; 3]> {
        let [r, g, b] = &self.values[..] else {
            return None;
        };
        let (r, g, b) = (r.parse().ok()?, g.parse().ok()?, b.parse().ok()?);
        (self.kind == "rgb").then_some([r, g, b])
    }

    /// The name of a spectrum or of a file with one; `None` if the parameter holds another value.
    fn spectrum(&self) -> Option<&str> {
        match &self.values[..] {
            [name] if self.kind == "spectrum" => Some(name),
            _ => None,
        }
    }

    /// The error for the `name` of a spectrum whose numbers are not known here.
    fn unknown(&self, name: &str, instead: &str) -> SceneError {
        let in_file = Path::new(name).extension().is_some_and(|end| end == "spd");
        let what = if in_file {
            "in a file, which is not read"
        } else {
            "not a spectrum that is known here"
        };
        let own = &self.name;
        self.place.invalid(format!("the {own} \"{name}\" is {what}; write \"{instead} {own}\""))
    }
}

/// The Fresnel term of an interface; `None` if a spectrum or a texture leaves it open.
pub(super) fn fresnel(material: &Definition, prefix: &str) -> Result<Option<Reflectance>> {
    match (&material.class[..], prefix) {
        ("conductor", _) => under(1.0, material, prefix),
        ("coatedconductor", "conductor.") => match outside(material, "interface.")? {
            Some(Reflectance::Dielectric(coat)) => under(coat.min, material, prefix),
            _ => Ok(None),
        },
        _ => outside(material, prefix),
    }
}

/// The Fresnel term of a dielectric in air.
fn outside(material: &Definition, prefix: &str) -> Result<Option<Reflectance>> {
    // The defaults in materials.cpp.
    let default = if material.class == "subsurface" { 1.33 } else { 1.5 };
    let Some(eta) = material.parameter(&format!("{prefix}eta")) else {
        return Ok(Some(Reflectance::dielectric(default)));
    };
    let index = match eta.spectrum() {
        Some(name) => {
            let glass = GLASSES.iter().find(|(known, _)| *known == name);
            glass.map(|&(_, index)| index).ok_or_else(|| eta.unknown(name, "float"))?
        }
        None if eta.kind == "float" => eta.number()?,
        None => return Ok(None),
    };
    dielectric(index, &eta.place).map(Some)
}

/// The conductor under a dielectric of index `coat`, to which its own index is relative
/// (`ConductorMaterial` and `CoatedConductorMaterial::GetBxDF`).
fn under(coat: f64, material: &Definition, prefix: &str) -> Result<Option<Reflectance>> {
    let parameter = |name: &str| material.parameter(&format!("{prefix}{name}"));
    let (eta, k) = (parameter("eta"), parameter("k"));
    let index = match material.parameter("reflectance") {
        None => part(eta, "-eta", Metal::eta)?.zip(part(k, "-k", Metal::k)?),
        Some(reflectance) if eta.is_some() || k.is_some() => {
            return Err(reflectance.place.invalid(
                "a conductor has either reflectance or eta and k, and not both; remove one of them",
            ));
        }
        Some(reflectance) => reflecting(reflectance)?.map(|k| ([1.0; 3], k)),
    };
    let Some((eta, k)) = index else {
        return Ok(None);
    };
    // The numbers are checked as written first, so that an error quotes them.
    conductor(eta, k, &material.place)?;
    let relative = |of: [f64; 3]| of.map(|x| x / coat);
    conductor(relative(eta), relative(k), &material.place).map(Some)
}

/// eta or k of a conductor, copper's by default; `None` if samples or a texture leave it open.
fn part(
    parameter: Option<&Parameter>,
    end: &str,
    of: fn(Metal) -> [f64; 3],
) -> Result<Option<[f64; 3]>> {
    let Some(parameter) = parameter else {
        return Ok(Some(of(Metal::Copper)));
    };
    match parameter.spectrum() {
        // Such as "metal-Au-eta".
        Some(name) => {
            let symbol = name.strip_prefix("metal-").and_then(|name| name.strip_suffix(end));
            let metal = symbol.and_then(metal);
            metal.map(|metal| Some(of(metal))).ok_or_else(|| parameter.unknown(name, "rgb"))
        }
        None => Ok(parameter.rgb()),
    }
}

/// The k with which a conductor of eta = 1 reflects a colour at normal incidence, where
/// F = k²/(k² + 4).
fn reflecting(reflectance: &Parameter) -> Result<Option<[f64; 3]>> {
    if let Some(name) = reflectance.spectrum() {
        return Err(reflectance.unknown(name, "rgb"));
    }
    let Some(colour) = reflectance.rgb() else {
        return Ok(None);
    };
    if !colour.iter().all(|r| (0.0..=1.0).contains(r)) {
        return Err(reflectance
            .place
            .invalid(format!("the reflectance is {colour:?}; each number must be from 0 to 1")));
    }
    Ok(Some(colour.map(|r| {
        let r = r.min(MOST_REFLECTIVE);
        2.0 * (r / (1.0 - r)).sqrt()
    })))
}
