//! The native recipe: a TOML file that lists materials.
//!
//! ```toml
//! [[material]]
//! name = "frosted glass"
//! sigma = 0.454                  # or [x, y], or { min = .., max = .. }; 0 is smooth
//! gamma = 3.0                    # or "inf" (Beckmann), or { min = .., max = .. }
//! fresnel = { dielectric = 1.5 } # optional, as all that follows
//! masking = "height-correlated"
//! haze = { weight = 0.3, sigma = 0.8 }
//! retroreflection = 0.1
//! ```
//!
//! `docs/recipe.md` has every key, its range and its default. A distribution that is a member of
//! the family (Beckmann, Trowbridge–Reitz, Blinn–Phong, Hyper-Cauchy) is read as such.

mod fresnel;
mod lobe;
mod write;

use std::cell::RefCell;
use std::collections::HashMap;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;

use microfacet_tables::{Interval, MaterialEntry};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use self::write::quoted;
pub(super) use self::write::write;
use super::error::{Lines, did_you_mean_key};
use super::limits::{self, Budget};
use super::{Format, Haze, LobeSpec, Material, Origin, Place, Scene, SceneError, SceneErrorKind};
use crate::distribution::Distribution;
use crate::input;

// `docs/recipe.md` has every key.
const LOBE_KEYS: [&str; 5] = ["sigma", "gamma", "theta", "degrees", "distribution"];
/// The keys before and after those of a lobe.
type Beside = [&'static [&'static str]; 2];
const MATERIAL_KEYS: Beside = [&["name"], &["fresnel", "masking", "haze", "retroreflection"]];
const HAZE_KEYS: Beside = [&["weight"], &[]];
const MEASURED_KEYS: [&str; 2] = ["measured", "degrees"];
const FRESNEL_KEYS: [&str; 4] = ["schlick", "metal", "conductor", "dielectric"];
const CONDUCTOR_KEYS: [&str; 2] = ["eta", "k"];
const RANGE_KEYS: [&str; 2] = ["min", "max"];

pub(super) fn load(file: &Path) -> Result<Scene, SceneError> {
    let place = Place::file(file);
    let text = input::read_text(file, limits::RECIPE).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => place.too_large(format!("it {error}; split the recipe")),
        _ => place.io(error),
    })?;
    read(&text, file).map_err(|error| {
        // A file of TOML without materials may be of another program.
        let is_ours = |line: &str| line.trim_start_matches(['[', ' ']).starts_with("material");
        match error.kind {
            SceneErrorKind::Invalid(why) if !text.lines().any(is_ours) => error.place.foreign(why),
            kind => SceneError { kind, ..error },
        }
    })
}

pub(super) fn read(text: &str, file: &Path) -> Result<Scene, SceneError> {
    read_parts(text, file, parts(text), limits::RECIPE_MATERIALS)
}

/// The parts of a recipe, which are parsed one by one so that memory holds the tree of one part
/// only: from one line with `[[material]]` to the next, and all before the second.
///
/// The tree of a part does not depend on the parts before it, since a recipe has nothing but
/// materials at its top; the first part holds anything that may come before them, such as another
/// `material`. A text with strings of several lines, which may contain the line `[[material]]`, is
/// one part.
fn parts(text: &str) -> Vec<Range<usize>> {
    let mut headers = Vec::new();
    if !text.lines().any(begins_long_string) {
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            if is_header(line) {
                headers.push(start + line.len() - line.trim_start_matches([' ', '\t']).len());
            }
            start += line.len();
        }
    }
    let mut ends: Vec<usize> = headers.into_iter().skip(1).collect();
    ends.push(text.len());
    let starts = [0].into_iter().chain(ends.clone());
    starts.zip(ends).map(|(start, end)| start..end).collect()
}

/// Whether a line heads a material; TOML allows blanks around the brackets and the key.
fn is_header(line: &str) -> bool {
    let blank = [' ', '\t'];
    let key = line.trim_start_matches(blank).strip_prefix("[[");
    let after = key.and_then(|key| key.trim_start_matches(blank).strip_prefix("material"));
    after.is_some_and(|after| after.trim_start_matches(blank).starts_with("]]"))
}

/// Whether a line may begin a string of several lines; a comment, with `#` before any quote, does
/// not.
fn begins_long_string(line: &str) -> bool {
    let code = match line.split_once('#') {
        Some((before, _)) if !before.contains(['"', '\'']) => before,
        _ => line,
    };
    code.contains("\"\"\"") || code.contains("'''")
}

/// Reads a recipe part by part, up to the first part with an error; more than `most` materials are
/// an error.
fn read_parts(
    text: &str,
    file: &Path,
    parts: impl IntoIterator<Item = Range<usize>>,
    most: usize,
) -> Result<Scene, SceneError> {
    let invalid = |why: &str| Err(Place::file(file).invalid(why));
    let lines = Lines::new(file, text.as_bytes());
    let mut source = Source {
        text: "",
        start: 0,
        file,
        lines: &lines,
        measured: Budget::new(limits::MEASURED),
        distributions: Budget::new(limits::DISTRIBUTIONS),
        warnings: RefCell::default(),
    };
    let mut materials: Vec<Material> = Vec::new();
    // The line of each name.
    let mut names: HashMap<String, u32> = HashMap::new();
    for part in parts {
        (source.text, source.start) = (&text[part.clone()], part.start);
        for material in source.materials()? {
            if materials.len() == most {
                return invalid(&format!("the recipe has more than {most} materials; split it"));
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
        }
    }
    if materials.is_empty() {
        return invalid(
            "the recipe has no materials; add at least one:\n\
             [[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 2.0",
        );
    }
    Ok(Scene { materials, warnings: source.warnings.take(), ..Scene::default() })
}

/// A part of a recipe, which is parsed by itself.
struct Source<'a> {
    /// The part; spans of parsed values are relative to it.
    text: &'a str,
    /// The offset of the part in the recipe.
    start: usize,
    file: &'a Path,
    /// The lines of the whole recipe.
    lines: &'a Lines<'a>,
    measured: Budget,
    distributions: Budget,
    warnings: RefCell<Vec<String>>,
}

impl Source<'_> {
    fn place(&self, span: Range<usize>) -> Place {
        self.lines.place(self.start + span.start)
    }

    fn materials(&self) -> Result<Vec<Material>, SceneError> {
        if self.text.len() as u64 > limits::RECIPE_PART {
            return Err(self.place(0..0).invalid(format!(
                "from here to the next [[material]] the recipe has {} bytes, and at most {} MiB \
                 are read at once; head each material with [[material]], close what is open, and \
                 write strings of several lines (\"\"\" or ''') on one, since a recipe with them is \
                 not divided",
                self.text.len(),
                limits::RECIPE_PART >> 20
            )));
        }
        let document = DeTable::parse(self.text)
            .map_err(|error| self.place(error.span().unwrap_or(0..0)).syntax(error.message()))?;
        let document = Spanned::new(document.span(), DeValue::Table(document.into_inner()));
        let document = Entry { source: self, key: "recipe", value: &document };
        document.only_keys(&["material"])?;
        let Some(list) = document.field("material") else { return Ok(Vec::new()) };
        match list.list() {
            Some(entries) => entries.iter().map(|entry| list.with(entry).material()).collect(),
            None => list.invalid("`material` must be a list: head each material with [[material]]"),
        }
    }
}

/// A value of a recipe, and the key that messages name it by.
#[derive(Clone, Copy)]
struct Entry<'a> {
    source: &'a Source<'a>,
    key: &'a str,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Entry<'a> {
    fn with(self, value: &'a Spanned<DeValue<'a>>) -> Self {
        Self { value, ..self }
    }

    fn place(self) -> Place {
        self.source.place(self.value.span())
    }

    /// The value as it is written in the recipe.
    fn written(self) -> &'a str {
        self.source.text.get(self.value.span()).unwrap_or("this")
    }

    fn error(self, why: impl ToString) -> SceneError {
        self.place().invalid(why.to_string())
    }

    fn invalid<T>(self, why: impl ToString) -> Result<T, SceneError> {
        Err(self.error(why))
    }

    fn expected<T>(self, what: &str) -> Result<T, SceneError> {
        self.invalid(format!("{} must be {what}, not {}", self.key, self.written()))
    }

    fn out_of_range<T>(self, range: &str) -> Result<T, SceneError> {
        let Self { key, .. } = self;
        self.invalid(format!("{key} = {} is out of range; it must be {range}", self.written()))
    }

    fn text(self) -> Option<&'a str> {
        self.value.get_ref().as_str()
    }

    fn table(self) -> Option<&'a DeTable<'a>> {
        self.value.get_ref().as_table()
    }

    fn list(self) -> Option<&'a [Spanned<DeValue<'a>>]> {
        self.value.get_ref().as_array().map(|list| &list[..])
    }

    /// The values of a list of N.
    fn list_of<const N: usize>(self) -> Option<[Self; N]> {
        let list: &[_; N] = self.list()?.try_into().ok()?;
        Some(list.each_ref().map(|value| self.with(value)))
    }

    fn field(self, key: &'a str) -> Option<Self> {
        let value = self.table()?.get(key)?;
        Some(Self { key, value, ..self })
    }

    fn required(self, key: &'a str, example: &str) -> Result<Self, SceneError> {
        self.field(key).ok_or_else(|| {
            let Self { key: of, .. } = self;
            self.error(format!("the {of} has no `{key}`; add for example {key} = {example}"))
        })
    }

    /// Checks that a table has no other keys; a value that is no table passes.
    fn only_keys(self, known: &[&str]) -> Result<(), SceneError> {
        let mut keys = self.table().into_iter().flat_map(|table| table.keys());
        match keys.find(|key| !known.contains(&key.get_ref().as_ref())) {
            None => Ok(()),
            Some(key) => Err(self.source.place(key.span()).invalid(format!(
                "unknown key `{}`{}; the keys here are {}",
                key.get_ref(),
                did_you_mean_key(key.get_ref(), known),
                known.join(", ")
            ))),
        }
    }

    fn material(self) -> Result<Material, SceneError> {
        if self.table().is_none() {
            return self
                .invalid("a material must be a table: head each material with [[material]]");
        }
        let lobe = self.lobe(MATERIAL_KEYS, None)?;
        let haze = self.field("haze").map(|haze| haze.haze(&lobe)).transpose()?;
        let share = self.field("retroreflection");
        let retroreflection = share.map_or(Ok(MaterialEntry::SPECULAR), Entry::retroreflection)?;
        let lobes = [Some(&lobe), haze.as_ref().map(|haze| &haze.lobe)];
        let is_tilted = lobes.into_iter().flatten().any(|lobe| lobe.theta.is_some());
        if let Some(share) = share
            && retroreflection != MaterialEntry::SPECULAR
            && is_tilted
        {
            return share.invalid(
                "retroreflection off a lobe with theta is not reciprocal, since half a turn about \
                 the macro normal changes a tilted lobe; remove one of the two",
            );
        }
        let name = self.required("name", "\"gold\"")?;
        let Some(text) = name.text().filter(|text| !text.is_empty()) else {
            return name.expected("a text that is not empty");
        };
        Ok(Material {
            name: text.to_owned(),
            lobe,
            haze,
            retroreflection,
            fresnel: self.field("fresnel").map(Entry::fresnel).transpose()?,
            masking: self.field("masking").map(Entry::masking).transpose()?,
            origin: Origin { format: Format::Recipe, place: self.place(), lobe: None },
            used: true,
        })
    }

    /// The second lobe of a material with this core.
    fn haze(self, core: &LobeSpec<Distribution>) -> Result<Haze<Distribution>, SceneError> {
        if self.table().is_none() {
            return self.expected("a table such as haze = { weight = 0.3, sigma = 0.5 }");
        }
        let gamma = core.distribution.is_none().then_some(core.gamma);
        let lobe = self.lobe(HAZE_KEYS, gamma)?;
        let weight = self.required("weight", "0.3")?;
        Ok(Haze { weight: weight.share("the share of the haze, from 0 to 1")?, lobe })
    }

    fn retroreflection(self) -> Result<Interval, SceneError> {
        self.share("the share of the reflected light that goes back to where it comes from, 0 to 1")
    }

    /// A number or a range within [0, 1].
    fn share(self, what: &str) -> Result<Interval, SceneError> {
        let share = self.interval()?;
        if share.min >= 0.0 && share.max <= 1.0 {
            return Ok(share);
        }
        self.out_of_range(what)
    }

    fn interval(self) -> Result<Interval, SceneError> {
        let key = self.key;
        if let Some([min, max]) = self.list_of() {
            let [min, max] = [min, max].map(Self::written);
            return self.invalid(format!(
                "{key} = {} is no number; a range is written {{ min = {min}, max = {max} }}",
                self.written()
            ));
        }
        if self.table().is_none() {
            return Ok(Interval::point(self.number()?));
        }
        self.only_keys(&RANGE_KEYS)?;
        let (Some(min), Some(max)) = (self.field("min"), self.field("max")) else {
            return self
                .invalid(format!("a range of {key} needs both ends: {{ min = .., max = .. }}"));
        };
        let (min, max) = (Self { key, ..min }.number()?, Self { key, ..max }.number()?);
        if min <= max {
            return Ok(Interval { min, max });
        }
        self.invalid(format!(
            "the range of {key} is inverted: min = {min} is more than max = {max}; exchange them"
        ))
    }

    /// A number that is not NaN; "inf" and "Infinity" are infinity.
    fn number(self) -> Result<f64, SceneError> {
        let number = match self.value.get_ref() {
            DeValue::Integer(digits) if digits.radix() == 10 => digits.as_str().parse().ok(),
            DeValue::Float(digits) => digits.as_str().parse().ok(),
            // TOML has `inf` only; in quotes every name of infinity that Rust parses is allowed.
            DeValue::String(text) => text.trim().parse().ok().filter(|x: &f64| x.is_infinite()),
            _ => None,
        };
        match number {
            Some(number) if !f64::is_nan(number) => Ok(number),
            _ => self.expected("a number"),
        }
    }

    fn number_where(self, is_valid: impl Fn(f64) -> bool, range: &str) -> Result<f64, SceneError> {
        let number = self.number()?;
        if is_valid(number) { Ok(number) } else { self.out_of_range(range) }
    }
}

#[cfg(test)]
mod tests;
