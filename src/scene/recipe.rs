//! The native recipe: a TOML file that lists materials.
//!
//! ```toml
//! [[material]]
//! name = "frosted glass"
//! sigma = 0.454                  # or [x, y], or { min = .., max = .. }; 0 is smooth
//! gamma = 3.0                    # or "inf" (Beckmann), or { min = .., max = .. }
//! fresnel = { dielectric = 1.5 } # or "mirror", { schlick = F0 },
//!                                # { conductor = { eta = [..], k = [..] } }
//! masking = "height-correlated"  # or "uncorrelated"; height-correlated if absent
//! ```
//!
//! For a distribution outside the family, `distribution` with its parameters takes the place of σ
//! and γ: `distribution = "gtr"`, `c = 0.2`, `gamma = 1.5`, or `distribution = { measured =
//! "steel.csv" }` for a CSV of angles in radians and D. Distributions that are members of the
//! family (Beckmann, Trowbridge–Reitz, Blinn–Phong, Hyper-Cauchy) are read as such.
//!
//! `theta = [0.1, -0.2, 0.5]` beside single numbers of σ and γ tilts and turns the lobe: an
//! ellipsoid with the angles θx, θy, θz in radians.
//!
//! The index of a dielectric may be a range, `{ dielectric = { min = 1.0, max = "inf" } }`, whose
//! tables have an axis of indices. `fresnel` and `masking` may be absent. The ends of an
//! anisotropic roughness may be ranges as well: `sigma = [{ min = 0.1, max = 0.2 }, 0.3]`.

use std::collections::HashMap;
use std::fmt::{Display, Write as _};
use std::ops::Range;
use std::path::Path;

use microfacet_model::Skew;
use microfacet_model::classic::Marginal;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Lines, did_you_mean};
use super::limits::Budget;
use super::{
    Format, Fresnel, Interval, Masking, Material, Origin, Place, Roughness, SceneError, limits,
};
use crate::distribution::{Distribution, DistributionKind, Named};
use crate::fit::{Angles, read_csv};
use crate::input;
use crate::table_spec::GAMMA_MIN;

const MATERIAL_KEYS: [&str; 7] =
    ["name", "sigma", "gamma", "theta", "distribution", "fresnel", "masking"];
const FRESNEL_KEYS: [&str; 3] = ["schlick", "conductor", "dielectric"];

/// Reads the materials of the recipe `text`, the content of `file`.
pub(super) fn read(text: &str, file: &Path) -> Result<Vec<Material>, SceneError> {
    let lines = Lines::new(file, text);
    let (measured, distributions) =
        (Budget::new(limits::MEASURED), Budget::new(limits::DISTRIBUTIONS));
    Source { text, file, lines, measured, distributions }.materials()
}

/// Writes the recipe that [`read`] turns into the same materials.
pub(super) fn write<'a>(materials: impl IntoIterator<Item = &'a Material>) -> String {
    let entries: Vec<String> = materials.into_iter().map(entry).collect();
    entries.join("\n")
}

fn entry(material: &Material) -> String {
    let mut text = format!("[[material]]\nname = {}\n", quoted(&material.name));
    let sigma = match material.roughness {
        Roughness::Smooth => range(Interval::point(0.0)),
        Roughness::Isotropic(sigma) => range(sigma),
        Roughness::Anisotropic { x, y } => format!("[{}, {}]", range(x), range(y)),
    };
    // Writing to a string cannot fail.
    let _ = match &material.distribution {
        None => writeln!(text, "sigma = {sigma}\ngamma = {}", range(material.gamma)),
        Some(Distribution::Measured { file, .. }) => {
            writeln!(text, "distribution = {{ measured = {} }}", quoted(file))
        }
        Some(Distribution::Named(named)) => {
            let number = |x: f64| range(Interval::point(x));
            let pairs = named.kind.parameters().iter().zip(&named.values);
            let values: String =
                pairs.map(|(key, x)| format!("\n{key} = {}", number(*x))).collect();
            writeln!(text, "distribution = {}{values}", quoted(named.kind.name()))
        }
    };
    if let Some(theta) = material.theta {
        let _ = writeln!(text, "theta = {theta:?}");
    }
    if let Some(fresnel) = material.fresnel {
        let value = match fresnel {
            Fresnel::Mirror => "\"mirror\"".to_owned(),
            Fresnel::Schlick(f0) => format!("{{ schlick = {f0:?} }}"),
            Fresnel::Conductor { eta, k } => {
                format!("{{ conductor = {{ eta = {eta:?}, k = {k:?} }} }}")
            }
            Fresnel::Dielectric(eta) => format!("{{ dielectric = {eta:?} }}"),
            Fresnel::Dielectrics { min, max } => {
                let eta = Interval { min, max: max.unwrap_or(f64::INFINITY) };
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

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// A number or a range; Rust's shortest form that reads back to the same bits is valid TOML.
fn range(interval: Interval) -> String {
    let number = |x: f64| {
        if x == f64::INFINITY { "\"inf\"".to_owned() } else { format!("{x:?}") }
    };
    if interval.is_point() {
        number(interval.min)
    } else {
        format!("{{ min = {}, max = {} }}", number(interval.min), number(interval.max))
    }
}

/// Roughness, shape, and the distribution that replaces them.
type Lobe = (Roughness, Interval, Option<Distribution>);

struct Source<'a> {
    text: &'a str,
    file: &'a Path,
    lines: Lines,
    /// Bytes of measured distributions.
    measured: Budget,
    distributions: Budget,
}

type Table<'a> = DeTable<'a>;
type Value<'a> = Spanned<DeValue<'a>>;

impl Source<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        self.lines.place(span.start)
    }

    fn materials(&self) -> Result<Vec<Material>, SceneError> {
        let document = DeTable::parse(self.text)
            .map_err(|error| self.place(error.span().unwrap_or(0..0)).syntax(error.message()))?;
        let document = document.get_ref();
        self.only_keys(document, &["material"])?;
        let entries = match document.get("material") {
            None => &[][..],
            Some(value) => value.get_ref().as_array().ok_or_else(|| {
                self.place(value.span())
                    .invalid("`material` must be a list: head each material with [[material]]")
            })?,
        };
        if entries.is_empty() {
            return Err(Place::file(self.file).invalid(
                "the recipe has no materials; add at least one:\n\
                 [[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 2.0",
            ));
        }
        if entries.len() > limits::MATERIALS {
            return Err(Place::file(self.file).invalid(format!(
                "the recipe has {} materials, and at most {} are read; split it",
                entries.len(),
                limits::MATERIALS
            )));
        }
        let mut seen: HashMap<String, Place> = HashMap::new();
        entries
            .iter()
            .map(|entry| {
                let material = self.material(entry)?;
                let place = material.origin.place.clone();
                match seen.insert(material.name.clone(), place.clone()) {
                    None => Ok(material),
                    Some(first) => Err(place.invalid(format!(
                        "the name {} is taken by the material at line {}; give each material a name of its own",
                        quoted(&material.name),
                        first.line.unwrap_or(0),
                    ))),
                }
            })
            .collect()
    }

    fn material(&self, entry: &Value<'_>) -> Result<Material, SceneError> {
        let place = self.place(entry.span());
        let table = entry.get_ref().as_table().ok_or_else(|| {
            place.invalid("a material must be a table: head each material with [[material]]")
        })?;
        let lobe = match table.get("distribution") {
            Some(value) => Some(self.distribution(table, value)?),
            None => {
                self.only_keys(table, &MATERIAL_KEYS)?;
                None
            }
        };
        let required = |key: &str, example: &str| {
            table.get(key).ok_or_else(|| {
                place.invalid(format!(
                    "the material has no `{key}`; add for example {key} = {example}"
                ))
            })
        };

        let name = required("name", "\"gold\"")?;
        let name = match name.get_ref().as_str() {
            Some(text) if !text.is_empty() => text.to_owned(),
            _ => {
                return Err(self
                    .place(name.span())
                    .invalid("`name` must be a text that is not empty"));
            }
        };
        let (roughness, gamma, distribution) = match lobe {
            Some(lobe) => lobe,
            None => {
                let roughness = self.sigma(required("sigma", "0.3")?)?;
                (roughness, self.gamma(required("gamma", "2.0")?)?, None)
            }
        };
        let theta = match table.get("theta") {
            Some(value) if distribution.is_none() => Some(self.theta(value, roughness, gamma)?),
            _ => None,
        };
        Ok(Material {
            name,
            roughness,
            gamma,
            distribution,
            theta,
            fresnel: table.get("fresnel").map(|v| self.fresnel(v)).transpose()?,
            masking: table.get("masking").map(|v| self.masking(v)).transpose()?,
            origin: Origin { format: Format::Recipe, place, lobe: None },
            used: true,
        })
    }

    /// The lobe of a material with a named distribution; as a Student-t if it is one.
    fn distribution(&self, table: &Table<'_>, value: &Value<'_>) -> Result<Lobe, SceneError> {
        let place = self.place(value.span());
        let common = ["name", "distribution", "fresnel", "masking"];
        let distribution = if let Some(name) = value.get_ref().as_str() {
            let kind = DistributionKind::by_name(name).map_err(|e| place.invalid(e.to_string()))?;
            let keys: Vec<&str> = common.iter().chain(kind.parameters()).copied().collect();
            self.only_keys(table, &keys)?;
            let parameter = |key: &&str| {
                let value = table.get(*key).ok_or_else(|| {
                    place.invalid(format!(
                        "distribution \"{name}\" has no `{key}`; add for example {key} = 0.3"
                    ))
                })?;
                self.number(value, key)
            };
            let values = kind.parameters().iter().map(parameter).collect::<Result<_, _>>()?;
            Distribution::Named(Named { kind, values })
        } else {
            let forms = "distribution must be a name in quotes or { measured = \"file.csv\" }";
            let source = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
            self.only_keys(table, &common)?;
            self.only_keys(source, &["measured"])?;
            let file = source.get("measured").and_then(|file| file.get_ref().as_str());
            let file = file.ok_or_else(|| place.invalid(forms))?;
            // Relative to the recipe's folder.
            let path = self.file.parent().unwrap_or(Path::new("")).join(file);
            let in_file = |why: &dyn Display| place.invalid(format!("{}: {why}", path.display()));
            let bytes = input::read(&path, limits::MEASURED).map_err(|e| in_file(&e))?;
            if !self.measured.take(bytes.len() as u64) {
                return Err(place.invalid(format!(
                    "the measured distributions of the recipe have more than {} MiB; split it",
                    limits::MEASURED >> 20
                )));
            }
            let measured = read_csv(&bytes[..], Angles::Radians).map_err(|e| in_file(&e))?;
            Distribution::Measured { file: file.to_owned(), table: measured }
        };
        let built = distribution.build().map_err(|e| place.invalid(e.to_string()))?;
        Ok(match built.student_t() {
            Some(t) => {
                let sigma = Interval::point(t.sigma_x());
                (Roughness::isotropic(sigma), Interval::point(t.shape().gamma()), None)
            }
            None => {
                if !self.distributions.take(1) {
                    return Err(place.invalid(format!(
                        "the recipe has more than {} materials with a distribution outside the \
                         Student-t family; split it",
                        limits::DISTRIBUTIONS
                    )));
                }
                let sigma = Interval::point(Marginal::new(&*built).sigma());
                (Roughness::isotropic(sigma), Interval::point(2.0), Some(distribution))
            }
        })
    }

    fn only_keys(&self, table: &Table<'_>, known: &[&str]) -> Result<(), SceneError> {
        match table.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
            None => Ok(()),
            Some(key) => Err(self.place(key.span()).invalid(format!(
                "unknown key `{}`{}; the keys here are {}",
                key.get_ref(),
                did_you_mean(key.get_ref(), known),
                known.join(", ")
            ))),
        }
    }

    fn sigma(&self, value: &Value<'_>) -> Result<Roughness, SceneError> {
        let valid = |value: &Value<'_>| {
            let sigma = self.interval(value, "sigma")?;
            if sigma.min >= 0.0 && sigma.max < f64::INFINITY {
                Ok(sigma)
            } else {
                Err(self.place(value.span()).invalid(format!(
                    "sigma = {} is out of range; the roughness must be finite and 0 (smooth) or more",
                    range(sigma)
                )))
            }
        };
        let Some(pair) = value.get_ref().as_array() else {
            return Ok(Roughness::isotropic(valid(value)?));
        };
        let place = self.place(value.span());
        let [x, y] = &pair[..] else {
            return Err(place.invalid(format!(
                "sigma has {} values; an anisotropic roughness is [x, y]",
                pair.len()
            )));
        };
        let (x, y) = (valid(x)?, valid(y)?);
        match Roughness::anisotropic(x, y) {
            // A lobe that is rough along one axis only has no density: the distribution degenerates
            // to a line.
            Roughness::Anisotropic { .. } if x.max == 0.0 || y.max == 0.0 => Err(place.invalid(
                "sigma is 0 along one axis alone; make both more than 0, or write sigma = 0 for a smooth surface",
            )),
            roughness => Ok(roughness),
        }
    }

    fn gamma(&self, value: &Value<'_>) -> Result<Interval, SceneError> {
        let gamma = self.interval(value, "gamma")?;
        if gamma.min > 1.5 {
            return Ok(gamma);
        }
        Err(self.place(value.span()).invalid(format!(
            "gamma = {} is out of range; the shape must be more than 1.5, where the projected area \
             diverges, up to \"inf\" (Beckmann); tables cover it from {GAMMA_MIN} on",
            range(gamma)
        )))
    }

    /// The angles of an ellipsoid, checked together with its σ and γ.
    fn theta(
        &self,
        value: &Value<'_>,
        roughness: Roughness,
        gamma: Interval,
    ) -> Result<[f64; 3], SceneError> {
        let place = self.place(value.span());
        let theta = match value.get_ref().as_array().map(|array| &array[..]) {
            Some([x, y, z]) => {
                [self.number(x, "theta")?, self.number(y, "theta")?, self.number(z, "theta")?]
            }
            _ => {
                return Err(place.invalid(
                    "theta must be three angles in radians, about x, y and z: theta = [0.1, -0.2, 0.5]",
                ));
            }
        };
        let (x, y) = (roughness.x(), roughness.y());
        for (key, interval) in [("sigma", x), ("sigma", y), ("gamma", gamma)] {
            if !interval.is_point() {
                return Err(place.invalid(format!(
                    "theta with a range of {key}, {}: an ellipsoid needs single numbers; give {key} one",
                    range(interval)
                )));
            }
        }
        match Skew::new([x.min, y.min], theta) {
            Ok(_) => Ok(theta),
            Err(why) => Err(place.invalid(format!("theta = {theta:?} with its sigma: {why}"))),
        }
    }

    fn interval(&self, value: &Value<'_>, key: &str) -> Result<Interval, SceneError> {
        let Some(table) = value.get_ref().as_table() else {
            return Ok(Interval::point(self.number(value, key)?));
        };
        self.only_keys(table, &["min", "max"])?;
        let (Some(min), Some(max)) = (table.get("min"), table.get("max")) else {
            return Err(self
                .place(value.span())
                .invalid(format!("a range of {key} needs both ends: {{ min = .., max = .. }}")));
        };
        let (min, max) = (self.number(min, key)?, self.number(max, key)?);
        if min <= max {
            Ok(Interval { min, max })
        } else {
            Err(self.place(value.span()).invalid(format!(
                "the range of {key} is inverted: min = {min} is more than max = {max}; exchange them"
            )))
        }
    }

    /// A number that is not NaN; "inf" is infinity.
    fn number(&self, value: &Value<'_>, key: &str) -> Result<f64, SceneError> {
        let number = match value.get_ref() {
            DeValue::Integer(digits) if digits.radix() == 10 => digits.as_str().parse().ok(),
            DeValue::Float(digits) => digits.as_str().parse().ok(),
            DeValue::String(text) if text == "inf" => Some(f64::INFINITY),
            _ => None,
        };
        match number {
            Some(number) if !f64::is_nan(number) => Ok(number),
            _ => Err(self.place(value.span()).invalid(format!(
                "{key} must be a number, not {}",
                self.text.get(value.span()).unwrap_or("this")
            ))),
        }
    }

    fn fresnel(&self, value: &Value<'_>) -> Result<Fresnel, SceneError> {
        let place = self.place(value.span());
        let forms = "fresnel must be \"mirror\", { schlick = F0 }, \
                     { conductor = { eta = [r, g, b], k = [r, g, b] } } or { dielectric = eta }, a number or \
                     { min = .., max = .. }";
        if value.get_ref().as_str() == Some("mirror") {
            return Ok(Fresnel::Mirror);
        }
        let table = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
        self.only_keys(table, &FRESNEL_KEYS)?;
        let mut entries = table.iter();
        let (Some((form, value)), None) = (entries.next(), entries.next()) else {
            return Err(place.invalid(forms));
        };
        match form.get_ref().as_ref() {
            "schlick" => {
                let f0 = self.number(value, "schlick")?;
                self.check(
                    value,
                    (0.0..=1.0).contains(&f0),
                    "schlick",
                    "a reflectance from 0 to 1",
                )?;
                Ok(Fresnel::Schlick(f0))
            }
            "dielectric" if value.get_ref().is_table() => {
                let eta = self.interval(value, "dielectric")?;
                let valid = eta.min >= 1.0 && eta.min < f64::INFINITY && eta.min < eta.max;
                let what = "a range of indices inside over outside, from 1 or more up to \"inf\"; both sides are baked";
                self.check(value, valid, "dielectric", what)?;
                Ok(Fresnel::Dielectrics {
                    min: eta.min,
                    max: (eta.max < f64::INFINITY).then_some(eta.max),
                })
            }
            "dielectric" => {
                let eta = self.index(value, "dielectric")?;
                Ok(Fresnel::Dielectric(eta))
            }
            _ => {
                let table = value.get_ref().as_table().ok_or_else(|| place.invalid(forms))?;
                self.only_keys(table, &["eta", "k"])?;
                let (Some(eta), Some(k)) = (table.get("eta"), table.get("k")) else {
                    return Err(
                        place.invalid("a conductor needs both eta = [r, g, b] and k = [r, g, b]")
                    );
                };
                Ok(Fresnel::Conductor {
                    eta: self.rgb(eta, "eta", |value| self.index(value, "eta"))?,
                    k: self.rgb(k, "k", |value| {
                        let k = self.number(value, "k")?;
                        let valid = (0.0..f64::INFINITY).contains(&k);
                        self.check(
                            value,
                            valid,
                            "k",
                            "an extinction coefficient, finite and 0 or more",
                        )?;
                        Ok(k)
                    })?,
                })
            }
        }
    }

    fn index(&self, value: &Value<'_>, key: &str) -> Result<f64, SceneError> {
        let eta = self.number(value, key)?;
        let valid = eta > 0.0 && eta < f64::INFINITY;
        self.check(value, valid, key, "an index of refraction, finite and more than 0")?;
        Ok(eta)
    }

    fn check(
        &self,
        value: &Value<'_>,
        valid: bool,
        key: &str,
        what: &str,
    ) -> Result<(), SceneError> {
        if valid {
            return Ok(());
        }
        let text = self.text.get(value.span()).unwrap_or_default();
        Err(self
            .place(value.span())
            .invalid(format!("{key} = {text} is out of range; it must be {what}")))
    }

    fn rgb(
        &self,
        value: &Value<'_>,
        key: &str,
        channel: impl Fn(&Value<'_>) -> Result<f64, SceneError>,
    ) -> Result<[f64; 3], SceneError> {
        match value.get_ref().as_array().map(|array| &array[..]) {
            Some([r, g, b]) => Ok([channel(r)?, channel(g)?, channel(b)?]),
            _ => Err(self.place(value.span()).invalid(format!(
                "{key} must be three numbers, for red, green and blue: {key} = [0.2, 0.9, 1.1]"
            ))),
        }
    }

    fn masking(&self, value: &Value<'_>) -> Result<Masking, SceneError> {
        let name = value.get_ref().as_str().unwrap_or_default();
        name.parse().map_err(|why: microfacet_common::UnknownMasking| {
            let hint = did_you_mean(name, &Masking::ALL.map(Masking::name));
            self.place(value.span()).invalid(format!("{why}{hint}"))
        })
    }
}
