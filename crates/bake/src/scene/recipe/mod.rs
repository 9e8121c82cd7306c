//! The native recipe: a TOML file that lists materials.
//!
//! ```toml
//! [[material]]
//! name = "frosted glass"
//! sigma = 0.454                  # or [x, y], or { min = .., max = .. }; 0 is smooth
//! gamma = 3.0                    # or "inf" (Beckmann), or { min = .., max = .. }
//! fresnel = { dielectric = 1.5 } # may be absent, as may masking
//! masking = "height-correlated"
//! ```
//!
//! `docs/recipe.md` has every key, its range and its default. A distribution that is a member of
//! the family (Beckmann, Trowbridge–Reitz, Blinn–Phong, Hyper-Cauchy) is read as such.

mod fresnel;
mod lobe;
mod parts;
mod write;

use std::cell::RefCell;
use std::collections::HashMap;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;

use microfacet_tables::Interval;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::limits;
use crate::scene::limits::Budget;

use self::parts::parts;
use self::write::quoted;
pub(super) use self::write::write;
use super::error::{Lines, did_you_mean_key};
use super::{Format, Material, Origin, Place, Scene, SceneError, SceneErrorKind};
use crate::input;

// docs/recipe.md has each of these.
const MATERIAL_KEYS: [&str; 8] =
    ["name", "sigma", "gamma", "theta", "degrees", "distribution", "fresnel", "masking"];
const MEASURED_KEYS: [&str; 2] = ["measured", "degrees"];
const FRESNEL_KEYS: [&str; 4] = ["schlick", "metal", "conductor", "dielectric"];
const CONDUCTOR_KEYS: [&str; 2] = ["eta", "k"];
const RANGE_KEYS: [&str; 2] = ["min", "max"];

/// Reads the recipe in `file`.
pub(super) fn load(file: &Path) -> Result<Scene, SceneError> {
    let place = Place::file(file);
    let text = input::read_text(file, limits::RECIPE).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => place.too_large(format!("it {error}; split the recipe")),
        _ => place.io(error),
    })?;
    read(&text, file).map_err(|error| {
        // Much else is written in TOML.
        let is_ours = |line: &str| line.trim_start_matches(['[', ' ']).starts_with("material");
        match error.kind {
            SceneErrorKind::Invalid(why) if !text.lines().any(is_ours) => error.place.foreign(why),
            kind => SceneError { kind, ..error },
        }
    })
}

/// Reads the recipe `text`, the content of `file`.
pub(super) fn read(text: &str, file: &Path) -> Result<Scene, SceneError> {
    read_parts(text, file, parts(text), limits::RECIPE_MATERIALS)
}

/// Reads it part by part, and at most so many materials; the first part with an error ends it.
fn read_parts(
    text: &str,
    file: &Path,
    parts: impl IntoIterator<Item = Range<usize>>,
    most: usize,
) -> Result<Scene, SceneError> {
    let lines = Lines::new(file, text.as_bytes());
    let warnings = RefCell::default();
    let mut source = Source {
        text: "",
        start: 0,
        file,
        lines: &lines,
        measured: Budget::new(limits::MEASURED),
        distributions: Budget::new(limits::DISTRIBUTIONS),
        warnings: &warnings,
    };
    let mut materials = Vec::new();
    // The line that each name is from.
    let mut names: HashMap<String, u32> = HashMap::new();
    for part in parts {
        (source.text, source.start) = (&text[part.clone()], part.start);
        source.read(|material| {
            if materials.len() == most {
                return Err(Place::file(file)
                    .invalid(format!("the recipe has more than {most} materials; split it")));
            }
            let place = &material.origin.place;
            let line = place.line.unwrap_or(0);
            if let Some(first) = names.insert(material.name.clone(), line) {
                return Err(place.invalid(format!(
                    "the name {} is taken by the material at line {first}; give each material a \
                     name of its own",
                    quoted(&material.name),
                )));
            }
            materials.push(material);
            Ok(())
        })?;
    }
    if materials.is_empty() {
        return Err(Place::file(file).invalid(
            "the recipe has no materials; add at least one:\n\
             [[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 2.0",
        ));
    }
    Ok(Scene { materials, warnings: warnings.take(), ..Scene::default() })
}

/// A part of a recipe, which is parsed by itself.
struct Source<'a> {
    /// The part; spans of parsed values are relative to it.
    text: &'a str,
    /// Where it begins in the recipe.
    start: usize,
    file: &'a Path,
    /// Those of the whole recipe.
    lines: &'a Lines<'a>,
    /// Bytes of measured distributions.
    measured: Budget,
    distributions: Budget,
    warnings: &'a RefCell<Vec<String>>,
}

type Table<'a> = DeTable<'a>;
type Value<'a> = Spanned<DeValue<'a>>;

impl Source<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        self.lines.place(self.start + span.start)
    }

    /// Reads the materials of the part, in order, and hands them to `add`.
    fn read(
        &self,
        mut add: impl FnMut(Material) -> Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        if self.text.len() as u64 > limits::RECIPE_PART {
            return Err(self.place(0..0).invalid(format!(
                "from here to the next [[material]] the recipe has {} bytes, and at most {} MiB \
                 are read at once; head each material with [[material]], and close what is open",
                self.text.len(),
                limits::RECIPE_PART >> 20
            )));
        }
        let document = DeTable::parse(self.text)
            .map_err(|error| self.place(error.span().unwrap_or(0..0)).syntax(error.message()))?;
        let document = document.get_ref();
        self.only_keys(document, &["material"])?;
        let Some(value) = document.get("material") else { return Ok(()) };
        let entries = value.get_ref().as_array().ok_or_else(|| {
            self.place(value.span())
                .invalid("`material` must be a list: head each material with [[material]]")
        })?;
        entries.iter().try_for_each(|entry| add(self.material(entry)?))
    }

    fn material(&self, entry: &Value<'_>) -> Result<Material, SceneError> {
        let place = self.place(entry.span());
        let table = entry.get_ref().as_table().ok_or_else(|| {
            place.invalid("a material must be a table: head each material with [[material]]")
        })?;
        let lobe = self.lobe(&place, table)?;
        let name = self.required(&place, table, "name", "\"gold\"")?;
        let name = match name.get_ref().as_str() {
            Some(text) if !text.is_empty() => text.to_owned(),
            _ => {
                return Err(self
                    .place(name.span())
                    .invalid("`name` must be a text that is not empty"));
            }
        };
        Ok(Material {
            name,
            lobe,
            fresnel: table.get("fresnel").map(|v| self.fresnel(v)).transpose()?,
            masking: table.get("masking").map(|v| self.masking(v)).transpose()?,
            origin: Origin { format: Format::Recipe, place, lobe: None },
            used: true,
        })
    }

    /// The value of a key that a material must have.
    fn required<'t>(
        &self,
        place: &Place,
        table: &'t Table<'_>,
        key: &str,
        example: &str,
    ) -> Result<&'t Value<'t>, SceneError> {
        table.get(key).ok_or_else(|| {
            place.invalid(format!("the material has no `{key}`; add for example {key} = {example}"))
        })
    }

    fn warn(&self, place: &Place, message: String) {
        self.warnings.borrow_mut().push(format!("{place}: {message}"));
    }

    fn only_keys(&self, table: &Table<'_>, known: &[&str]) -> Result<(), SceneError> {
        match table.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
            None => Ok(()),
            Some(key) => Err(self.place(key.span()).invalid(format!(
                "unknown key `{}`{}; the keys here are {}",
                key.get_ref(),
                did_you_mean_key(key.get_ref(), known),
                known.join(", ")
            ))),
        }
    }

    fn interval(&self, value: &Value<'_>, key: &str) -> Result<Interval, SceneError> {
        let Some(table) = value.get_ref().as_table() else {
            return Ok(Interval::point(self.number(value, key)?));
        };
        self.only_keys(table, &RANGE_KEYS)?;
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

    /// A number that is not NaN; "inf" and "Infinity" are infinity.
    fn number(&self, value: &Value<'_>, key: &str) -> Result<f64, SceneError> {
        let number = match value.get_ref() {
            DeValue::Integer(digits) if digits.radix() == 10 => digits.as_str().parse().ok(),
            DeValue::Float(digits) => digits.as_str().parse().ok(),
            // TOML has `inf` alone; in quotes it is what Rust reads, in upper case or lower.
            DeValue::String(text) => text.trim().parse().ok().filter(|x: &f64| x.is_infinite()),
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_recipes_has_every_key() {
        let page = include_str!("../../../../../docs/recipe.md");
        let keys: [&[&str]; 5] =
            [&MATERIAL_KEYS, &MEASURED_KEYS, &FRESNEL_KEYS, &CONDUCTOR_KEYS, &RANGE_KEYS];
        for key in keys.concat() {
            assert!(page.contains(&format!("`{key}`")), "docs/recipe.md: no `{key}`");
        }
    }
}
