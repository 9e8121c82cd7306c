//! The materials of a scene: microfacet lobes with a roughness, a shape and a Fresnel term.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

use super::Place;
use crate::distribution::Distribution;

use microfacet_tables::{Interval, MaterialEntry};

pub use microfacet_sampler::Masking;
pub use microfacet_tables::{Haze, LobeSpec, Reflectance, Roughness};

/// The format in which a material was described.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// The native recipe (TOML).
    Recipe,
    /// pbrt-v4.
    Pbrt,
    /// Mitsuba 3 XML.
    Mitsuba,
    /// glTF 2.0.
    Gltf,
    /// MaterialX.
    MaterialX,
}

impl Format {
    /// The format by the extension of a file's name; `None` if it is of none.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_lowercase();
        let name =
            name.strip_suffix(".pbrt.gz").map_or(name.clone(), |stem| format!("{stem}.pbrt"));
        match Path::new(&name).extension()?.to_str()? {
            "toml" => Some(Self::Recipe),
            "pbrt" => Some(Self::Pbrt),
            "xml" => Some(Self::Mitsuba),
            "gltf" | "glb" => Some(Self::Gltf),
            "mtlx" => Some(Self::MaterialX),
            _ => None,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Recipe => "recipe",
            Self::Pbrt => "pbrt-v4",
            Self::Mitsuba => "Mitsuba 3",
            Self::Gltf => "glTF 2.0",
            Self::MaterialX => "MaterialX",
        })
    }
}

/// The source of a material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The format.
    pub format: Format,
    /// The position of its definition.
    pub place: Place,
    /// The name of a lobe of a layered material, for instance "coat"; `None` for the only or main
    /// lobe.
    pub lobe: Option<&'static str>,
}

/// One microfacet surface that a scene asks for: one lobe, or a core and a haze.
///
/// A layered material of the scene appears as one `Material` for each rough interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name, unique in its scene; a further lobe is named "material.lobe".
    pub name: String,
    /// The lobe; the core, if it has a haze.
    pub lobe: LobeSpec<Distribution>,
    /// The second lobe, if it has one.
    pub haze: Option<Haze<Distribution>>,
    /// The share in [0, 1] of the reflected light that goes back to where it comes from;
    /// [`MaterialEntry::SPECULAR`] if none does.
    pub retroreflection: Interval,
    /// The facets' reflectance; `None` if the scene states none, or none that [`Reflectance`] has.
    pub fresnel: Option<Reflectance>,
    /// The form of G2 that the scene's renderer uses; `None` where the format leaves it open.
    pub masking: Option<Masking>,
    /// The source of its description.
    pub origin: Origin,
    /// Whether any geometry uses it; true if that cannot be known.
    pub used: bool,
}

impl Material {
    /// Its lobes: the core, then the haze if it has one.
    pub fn lobes(&self) -> impl Iterator<Item = &LobeSpec<Distribution>> {
        std::iter::once(&self.lobe).chain(self.haze.iter().map(|haze| &haze.lobe))
    }

    /// It as materials of one lobe each under its name: the core, then the haze if it has one. No
    /// table differs by retroreflection.
    pub fn parts(&self) -> impl Iterator<Item = Cow<'_, Self>> {
        let haze = self.haze.as_ref().map(|Haze { lobe, .. }| {
            Cow::Owned(Self { lobe: lobe.clone(), haze: None, ..self.clone() })
        });
        let core = match haze {
            None => Cow::Borrowed(self),
            Some(_) => Cow::Owned(Self { haze: None, ..self.clone() }),
        };
        std::iter::once(core).chain(haze)
    }

    /// The material as sets list it.
    #[must_use]
    pub fn entry(&self) -> MaterialEntry {
        let Self { name, masking, fresnel, retroreflection, .. } = self;
        MaterialEntry {
            name: name.clone(),
            lobe: self.lobe.map(Distribution::label),
            haze: self.haze.as_ref().map(|haze| haze.map(Distribution::label)),
            retroreflection: *retroreflection,
            masking: *masking,
            fresnel: *fresnel,
        }
    }

    /// Whether both state the same lobes under the same name, wherever they were described.
    #[must_use]
    pub fn asks_the_same(&self, other: &Self) -> bool {
        self.name == other.name
            && self.lobe == other.lobe
            && self.haze == other.haze
            && self.retroreflection == other.retroreflection
            && self.fresnel == other.fresnel
            && self.masking == other.masking
    }
}

/// A material of the scene without a lobe in [`Scene::materials`](super::Scene::materials).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ignored {
    /// Its name.
    pub name: String,
    /// Its kind in the scene's format, for instance "hair".
    pub kind: String,
    /// Why it was left out.
    pub reason: Cow<'static, str>,
    /// Whether it was understood, so that there is nothing to bake for it. If not, it is of an
    /// unknown kind or has an impossible value, and may have microfacets.
    pub understood: bool,
    /// The position of its description.
    pub place: Place,
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, reason, understood, place } = self;
        let what = if *understood { "nothing to bake for" } else { "not understood:" };
        write!(f, "{place}: {what} \"{name}\" ({kind}): {reason}")
    }
}
