//! The materials of a scene: microfacet lobes with a roughness, a shape and a Fresnel term.

use std::borrow::Cow;
use std::fmt;
use std::path::Path;

use super::Place;
use crate::distribution::Distribution;
use crate::interval::Interval;

pub use microfacet_sampler::Masking;
pub use microfacet_tables::FresnelEntry as Fresnel;

/// The slope roughness σ of a microfacet lobe, along the tangent (x) and the bitangent (y).
///
/// σ is dimensionless: the scale of the surface's slopes in the Student-t distribution (Ribardière
/// et al. 2017, doi:10.1111/cgf.13137, eq. 11 and 18), equal to the α of GGX (γ = 2) and of
/// Beckmann (γ = ∞). A range may start at 0, for a texture with smooth points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roughness {
    /// σ = 0 everywhere: a mirror or a pane, with no microfacets to sample.
    Smooth,
    /// σx = σy at every point, even where σ varies.
    Isotropic(Interval),
    /// σx and σy vary independently.
    Anisotropic {
        /// σx.
        x: Interval,
        /// σy.
        y: Interval,
    },
}

impl Roughness {
    /// The isotropic roughness of range `sigma`; [`Roughness::Smooth`] if that is 0 alone.
    pub fn isotropic(sigma: Interval) -> Self {
        if sigma.max > 0.0 { Self::Isotropic(sigma) } else { Self::Smooth }
    }

    /// A roughness with independent σx and σy; isotropic if both are the same single number.
    pub fn anisotropic(x: Interval, y: Interval) -> Self {
        if x.is_point() && x == y { Self::isotropic(x) } else { Self::Anisotropic { x, y } }
    }

    /// σx, which is 0 for a smooth surface.
    #[must_use]
    pub fn x(self) -> Interval {
        match self {
            Self::Smooth => Interval::point(0.0),
            Self::Isotropic(x) | Self::Anisotropic { x, .. } => x,
        }
    }

    /// σy, which is 0 for a smooth surface.
    #[must_use]
    pub fn y(self) -> Interval {
        match self {
            Self::Anisotropic { y, .. } => y,
            _ => self.x(),
        }
    }

    /// Whether σx = σy at every point.
    #[must_use]
    pub fn is_isotropic(self) -> bool {
        !matches!(self, Self::Anisotropic { .. })
    }
}

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
    /// The format that the name of a file says it has; `None` if its extension is of none.
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

/// Where a material comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The format.
    pub format: Format,
    /// The place of its definition.
    pub place: Place,
    /// The lobe of a layered material, for instance "coat"; `None` for the only or main one.
    pub lobe: Option<&'static str>,
}

/// One microfacet lobe that a scene asks for.
///
/// A layered material of the scene appears as one `Material` for each rough interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name, unique in its scene; a further lobe is named "material.lobe".
    pub name: String,
    /// σ.
    pub roughness: Roughness,
    /// The shape γ > 3/2; `INFINITY` is Beckmann, 2 is GGX.
    pub gamma: Interval,
    /// A distribution outside the Student-t family; σ is then the median slope of its normals, and
    /// γ has no meaning.
    pub distribution: Option<Distribution>,
    /// The tilt and turn of an ellipsoid, θx, θy, θz in radians
    /// (`microfacet_model::Ellipsoid::new`); σ and γ are then single numbers.
    pub theta: Option<[f64; 3]>,
    /// The facets' reflectance; `None` if the scene states none, or none of these forms.
    pub fresnel: Option<Fresnel>,
    /// The form of G2 that the scene's renderer uses; `None` where the format leaves it open.
    pub masking: Option<Masking>,
    /// Where it was described.
    pub origin: Origin,
    /// Whether any geometry uses it; true if that cannot be known.
    pub used: bool,
}

impl Material {
    /// Whether both state the same lobe under the same name, wherever they were described.
    #[must_use]
    pub fn asks_the_same(&self, other: &Self) -> bool {
        self.name == other.name
            && self.roughness == other.roughness
            && self.gamma == other.gamma
            && self.distribution == other.distribution
            && self.theta == other.theta
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
    /// Whether it was understood: then there is nothing to bake for it. If not, it is of a kind
    /// that is not known here, or says something impossible, and it may well have microfacets.
    pub understood: bool,
    /// Where it was described.
    pub place: Place,
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, reason, understood, place } = self;
        let what = if *understood { "nothing to bake for" } else { "not understood:" };
        write!(f, "{place}: {what} \"{name}\" ({kind}): {reason}")
    }
}
