//! The scene under construction, shared by the importers.

use std::borrow::Cow;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

use microfacet_baker::scene::{
    Format, Ignored, LobeSpec, MOST_CANDIDATES, Masking, Material, Names, Origin, Place,
    Reflectance, Roughness, Scene, SceneError, SceneErrorKind, did_you_mean,
};
use microfacet_tables::{Interval, MaterialEntry};

use crate::Result;
use crate::limits::{self, Budget};
use crate::texture::{self, Channel, Encoding, Textures};

/// γ of GGX (Trowbridge-Reitz).
pub(super) const GGX: Interval = Interval::point(2.0);
/// γ of Beckmann.
pub(super) const BECKMANN: Interval = Interval::point(f64::INFINITY);

/// A lobe of the material being read, as [`Builder::add`] takes it.
pub(super) struct Lobe {
    /// What distinguishes it from the material's other lobes, if anything.
    pub(super) name: Option<&'static str>,
    pub(super) roughness: Roughness,
    pub(super) gamma: Interval,
    pub(super) fresnel: Option<Reflectance>,
}

impl Lobe {
    pub(super) fn ggx(
        name: Option<&'static str>,
        roughness: Roughness,
        fresnel: Option<Reflectance>,
    ) -> Self {
        Self { name, roughness, gamma: GGX, fresnel }
    }
}

/// Kinds of materials or nodes, and parameters that all of them have; both separated by spaces.
pub(super) type Row = (&'static str, &'static str);

/// The parameters that the `rows` give to a kind; none if it is in no row.
pub(super) fn names_of(rows: &[Row], kind: &str) -> Vec<&'static str> {
    let of_kind = rows.iter().filter(|(kinds, _)| has_word(kinds, kind));
    of_kind.flat_map(|(_, names)| names.split(' ')).collect()
}

/// Whether `word` is one of `words`, which are separated by spaces.
pub(super) fn has_word(words: &str, word: &str) -> bool {
    words.split(' ').any(|one| one == word)
}

/// A text cut at `limits::MESSAGE` bytes, since each of many materials may keep one.
pub(super) fn shortened(text: &str) -> Cow<'_, str> {
    if text.len() <= limits::MESSAGE {
        return text.into();
    }
    let end = (0..=limits::MESSAGE).rev().find(|&end| text.is_char_boundary(end));
    format!("{} ...", &text[..end.unwrap_or(0)]).into()
}

/// Refuses a scene that already has `limits::MATERIALS` of something.
pub(super) fn check_count(count: usize, what: &str, place: &Place) -> Result<()> {
    if count < limits::MATERIALS {
        return Ok(());
    }
    Err(place.too_large(format!("the scene has more than {} {what}; split it", limits::MATERIALS)))
}

/// Collects the materials of a scene of one format.
pub(super) struct Builder {
    format: Format,
    scene: Scene,
    /// How often each name was requested.
    names: Names,
    warned: HashSet<String>,
    /// Names that may still be compared for suggestions.
    hints: Budget,
    pub(super) textures: Textures,
}

impl Builder {
    pub(super) fn new(format: Format) -> Self {
        Self {
            format,
            scene: Scene::default(),
            names: Names::default(),
            warned: HashSet::new(),
            hints: Budget::new(limits::HINTS),
            textures: Textures::default(),
        }
    }

    /// The scene, with the files that it includes.
    pub(super) fn finish(mut self, included: Vec<PathBuf>) -> Scene {
        self.scene.included = included;
        self.scene
    }

    pub(super) fn add(&mut self, name: &str, place: &Place, used: bool, lobe: Lobe) -> Result<()> {
        check_count(self.count(), "materials", place)?;
        let name = shortened(name);
        for Interval { min, max } in [lobe.roughness.x(), lobe.roughness.y()] {
            if !(min >= 0.0 && max < f64::INFINITY) {
                return Err(place.invalid(format!(
                    "the roughness of \"{name}\" comes to [{min}, {max}]; it must be finite and 0 or \
                     more: check the numbers that it is computed from"
                )));
            }
        }
        let name = match lobe.name {
            Some(suffix) => format!("{name}.{suffix}"),
            None => name.into_owned(),
        };
        let material = Material {
            name: self.names.unique(name),
            lobe: LobeSpec::family(lobe.roughness, lobe.gamma),
            haze: None,
            retroreflection: MaterialEntry::SPECULAR,
            fresnel: lobe.fresnel,
            masking: match self.format {
                Format::Pbrt => Some(Masking::HeightCorrelated),
                Format::Mitsuba => Some(Masking::Uncorrelated),
                Format::Recipe | Format::Gltf | Format::MaterialX => None,
            },
            origin: Origin { format: self.format, place: place.clone(), lobe: lobe.name },
            used,
        };
        self.scene.materials.push(material);
        Ok(())
    }

    /// Lists a material for which there is nothing to bake.
    pub(super) fn ignore(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        reason: &'static str,
    ) -> Result<()> {
        self.leave_out(name, kind, place, reason.into(), true)
    }

    /// Lists a material of which nothing is known but its kind.
    pub(super) fn not_understood(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        reason: &str,
    ) -> Result<()> {
        self.leave_out(name, kind, place, shortened(reason).into_owned().into(), false)
    }

    fn leave_out(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        reason: Cow<'static, str>,
        understood: bool,
    ) -> Result<()> {
        check_count(self.count(), "materials", place)?;
        let (name, kind) = (shortened(name).into(), shortened(kind).into());
        self.scene.ignored.push(Ignored { name, kind, reason, understood, place: place.clone() });
        Ok(())
    }

    /// The materials so far, with those that were left out.
    fn count(&self) -> usize {
        self.scene.materials.len() + self.scene.ignored.len()
    }

    /// Lists a material as not understood if `read` found something impossible in it, so that the
    /// rest of the scene is still read. Other errors are returned.
    pub(super) fn degrade(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        read: Result<()>,
    ) -> Result<()> {
        match read {
            Err(SceneError { place: at, kind: SceneErrorKind::Invalid(why) }) => {
                // The material's own place is listed with it.
                let why = if at == *place { why } else { format!("{at}: {why}") };
                // Its kind is listed, too.
                let own = why.strip_prefix(kind).and_then(|why| why.strip_prefix(": "));
                self.not_understood(name, kind, place, own.unwrap_or(&why))
            }
            read => read,
        }
    }

    /// The value that `read` gives; `instead` with a warning if that is impossible, so that the
    /// rest of the material is still read. Other errors are returned.
    pub(super) fn or_warn<T>(&mut self, read: Result<T>, (instead, said): (T, &str)) -> Result<T> {
        match read {
            Err(SceneError { place, kind: SceneErrorKind::Invalid(why) }) => {
                self.warn(&place, format!("{why}; {said}"));
                Ok(instead)
            }
            read => read,
        }
    }

    /// What was read of a Fresnel term, or `instead` with a warning.
    pub(super) fn without_fresnel<T>(&mut self, read: Result<T>, instead: T) -> Result<T> {
        self.or_warn(read, (instead, "the lobe is read without its Fresnel term"))
    }

    pub(super) fn warn(&mut self, place: &Place, message: impl AsRef<str>) {
        let warnings = self.scene.warnings.len();
        if warnings > limits::WARNINGS {
            return;
        }
        let warning = format!("{place}: {}", shortened(message.as_ref()));
        // Materials share textures: each warning is given once.
        if self.warned.insert(warning.clone()) {
            self.scene.warnings.push(match warnings {
                limits::WARNINGS => format!("{place}: further warnings are not listed"),
                _ => warning,
            });
        }
    }

    /// As [`did_you_mean`], but empty after `limits::HINTS` compared names, since each takes time.
    pub(super) fn did_you_mean<'a>(
        &self,
        word: &str,
        candidates: impl IntoIterator<Item = &'a str>,
    ) -> String {
        if self.hints.left() == 0 {
            return String::new();
        }
        let candidates: Vec<&str> = candidates.into_iter().take(MOST_CANDIDATES).collect();
        match self.hints.take(candidates.len() as u64) {
            true => did_you_mean(word, &candidates),
            false => String::new(),
        }
    }

    /// Warns of a parameter that is not among those `known` of its `owner`: it is not read.
    pub(super) fn check_name(&mut self, owner: &str, name: &str, known: &[&str], place: &Place) {
        if known.contains(&name) {
            return;
        }
        let hint = match self.did_you_mean(name, known.iter().copied()) {
            none if none.is_empty() => format!("; it has {}", known.join(", ")),
            hint => hint,
        };
        self.warn(place, format!("{owner} has no parameter `{name}`{hint}; this one is not read"));
    }

    /// The range of a channel of an image file; [0, 1] with a warning if it cannot be read.
    pub(super) fn image(
        &mut self,
        file: &Path,
        channel: Channel,
        encoding: Encoding,
        place: &Place,
    ) -> Interval {
        let range = self.textures.range(file, channel, encoding, |left| texture::file(file, left));
        range.unwrap_or_else(|error| self.unread(&file.display().to_string(), &error, place))
    }

    /// The range [0, 1], with a warning that the texture `name` cannot be followed.
    pub(super) fn unread(&mut self, name: &str, reason: &str, place: &Place) -> Interval {
        self.warn(place, format!("texture {name} {reason}; it is assumed to cover [0, 1]"));
        Interval::UNIT
    }
}
