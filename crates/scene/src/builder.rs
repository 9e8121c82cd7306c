//! The scene under construction, shared by the importers.

use std::borrow::Cow;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

use microfacet_baker::scene::{
    Format, Ignored, LobeSpec, MOST_CANDIDATES, Masking, Material, Names, Origin, Place,
    Reflectance, Roughness, Scene, SceneError, SceneErrorKind, did_you_mean,
};
use microfacet_sampler::Metal;
use microfacet_tables::Interval;

use super::texture::{self, Channel, Encoding, Textures};
use crate::limits;
use crate::limits::Budget;

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
    pub(super) masking: Option<Masking>,
}

/// The Fresnel term of a dielectric of relative index `eta`.
pub(super) fn dielectric(eta: f64, place: &Place) -> Result<Reflectance, SceneError> {
    if eta > 0.0 && eta < f64::INFINITY {
        Ok(Reflectance::dielectric(eta))
    } else {
        Err(place.invalid(format!(
            "the index of refraction is {eta}; it must be finite and more than 0"
        )))
    }
}

/// The Fresnel term of a conductor.
pub(super) fn conductor(
    eta: [f64; 3],
    k: [f64; 3],
    place: &Place,
) -> Result<Reflectance, SceneError> {
    let finite = eta.iter().chain(&k).all(|x| x.is_finite());
    if finite && eta.iter().all(|&eta| eta > 0.0) && k.iter().all(|&k| k >= 0.0) {
        Ok(Reflectance::Conductor { eta, k })
    } else {
        Err(place.invalid(format!(
            "the conductor has eta = {eta:?} and k = {k:?}; eta must be more than 0 and k at least 0"
        )))
    }
}

/// Some of a format's kinds of materials or nodes, and parameters that all of them have; words with
/// spaces between.
pub(super) type Row = (&'static str, &'static str);

/// The parameters that the `rows` give to a kind; none if it is in no row.
pub(super) fn names_of(rows: &[Row], kind: &str) -> Vec<&'static str> {
    let of_kind = |(kinds, _): &&Row| kinds.split(' ').any(|known| known == kind);
    rows.iter().filter(of_kind).flat_map(|(_, names)| names.split(' ')).collect()
}

/// A text that is kept for each of many materials, without the end of a very long one.
pub(super) fn shortened(text: Cow<'_, str>) -> Cow<'_, str> {
    shortened_to(limits::MESSAGE, text)
}

/// The same, without what is beyond `most` bytes.
pub(super) fn shortened_to(most: usize, text: Cow<'_, str>) -> Cow<'_, str> {
    if text.len() <= most {
        return text;
    }
    let end = (0..=most).rev().find(|&end| text.is_char_boundary(end));
    format!("{} ...", &text[..end.unwrap_or(0)]).into()
}

/// Names of metals in pbrt's spectra and Mitsuba's presets; all others are unknown here.
const METALS: [(&str, Metal); 8] = [
    ("Ag", Metal::Silver),
    ("Al", Metal::Aluminium),
    ("Au", Metal::Gold),
    ("Cr", Metal::Chromium),
    ("Cu", Metal::Copper),
    ("CuZn", Metal::Brass),
    ("Ni", Metal::Nickel),
    ("W", Metal::Tungsten),
];

/// A metal by its chemical symbol, if it is known.
///
/// The index is that of [`Metal`], of which the renderer's own spectrum is another measurement.
pub(super) fn metal(symbol: &str) -> Option<Metal> {
    METALS.iter().find(|(known, _)| *known == symbol).map(|&(_, metal)| metal)
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
    textures: Textures<PathBuf>,
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
    pub(super) fn finish(self, included: Vec<PathBuf>) -> Scene {
        Scene { included, ..self.scene }
    }

    /// Adds a lobe of the material `name`.
    pub(super) fn add(
        &mut self,
        name: &str,
        place: &Place,
        used: bool,
        lobe: Lobe,
    ) -> Result<(), SceneError> {
        self.check(name, place)?;
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
            None => name.to_owned(),
        };
        let material = Material {
            name: self.names.unique(name),
            lobe: LobeSpec::family(lobe.roughness, lobe.gamma),
            fresnel: lobe.fresnel,
            masking: lobe.masking,
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
    ) -> Result<(), SceneError> {
        self.leave_out(name, kind, place, reason.into(), true)
    }

    /// Lists a material of which nothing is known but its kind.
    pub(super) fn not_understood(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        reason: impl Into<Cow<'static, str>>,
    ) -> Result<(), SceneError> {
        self.leave_out(name, kind, place, reason.into(), false)
    }

    /// Lists a material as not understood if `read` found something impossible in it, so that the
    /// rest of the scene is still read. Other errors are returned.
    pub(super) fn degrade(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        read: Result<(), SceneError>,
    ) -> Result<(), SceneError> {
        match read {
            Err(SceneError { place: at, kind: SceneErrorKind::Invalid(why) }) => {
                // The place of a part of the material; its own is said anyway.
                let why = if at == *place { why } else { format!("{at}: {why}") };
                self.not_understood(name, kind, place, why)
            }
            read => read,
        }
    }

    /// The value that `read` gives; `instead` with a warning if that is impossible, so that the
    /// rest of the material is still read. Other errors are returned.
    pub(super) fn or_warn<T>(
        &mut self,
        read: Result<T, SceneError>,
        (instead, said): (T, &str),
    ) -> Result<T, SceneError> {
        match read {
            Err(SceneError { place, kind: SceneErrorKind::Invalid(why) }) => {
                self.warn(&place, format!("{why}; {said}"));
                Ok(instead)
            }
            read => read,
        }
    }

    fn leave_out(
        &mut self,
        name: &str,
        kind: &str,
        place: &Place,
        reason: Cow<'static, str>,
        understood: bool,
    ) -> Result<(), SceneError> {
        self.check(name, place)?;
        let (name, kind, place) = (name.to_owned(), shortened(kind.into()).into(), place.clone());
        let reason = shortened(reason);
        self.scene.ignored.push(Ignored { name, kind, reason, understood, place });
        Ok(())
    }

    /// Checks that one more material, of this name, stays within the limits.
    fn check(&self, name: &str, place: &Place) -> Result<(), SceneError> {
        if self.scene.materials.len() + self.scene.ignored.len() == limits::MATERIALS {
            return Err(place.too_large(format!(
                "the scene has more than {} materials; split it",
                limits::MATERIALS
            )));
        }
        if name.len() > limits::NAME {
            return Err(place.too_large(format!(
                "the name of a material has {} bytes, and at most {} are read; shorten it",
                name.len(),
                limits::NAME
            )));
        }
        Ok(())
    }

    pub(super) fn warn(&mut self, place: &Place, message: impl AsRef<str>) {
        let warnings = self.scene.warnings.len();
        if warnings > limits::WARNINGS {
            return;
        }
        let warning = format!("{place}: {}", shortened(message.as_ref().into()));
        // Materials share textures: each warning is given once.
        if self.warned.insert(warning.clone()) {
            self.scene.warnings.push(match warnings {
                limits::WARNINGS => format!("{place}: further warnings are not listed"),
                _ => warning,
            });
        }
    }

    /// The text "; did you mean `x`?", or an empty one, as by [`did_you_mean`]; a scene with very
    /// many unknown names gets no more of them after a while, since each takes time.
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
        self.textures
            .range(file.to_owned(), channel, encoding, |file, left| texture::file(file, left))
            .unwrap_or_else(|error| self.unread(&file.display().to_string(), &error, place))
    }

    /// The range [0, 1], with a warning that the texture `name` cannot be followed.
    pub(super) fn unread(&mut self, name: &str, reason: &str, place: &Place) -> Interval {
        self.warn(place, format!("texture {name} {reason}; it is assumed to cover [0, 1]"));
        Interval::UNIT
    }
}
