//! Reads the microfacet materials of scenes: importers of pbrt, Mitsuba, glTF and MaterialX.
//!
//! [`load`] reads a scene description and lists the microfacet lobes in it. A table set is planned
//! from that list alone; geometry, lights and cameras are skipped.
//!
//! | format | file | roughness to σ | γ | G2 |
//! | --- | --- | --- | --- | --- |
//! | recipe | `.toml` | as written | as written | as written |
//! | [pbrt-v4] | `.pbrt`, `.pbrt.gz` | √roughness | 2 | height-correlated |
//! | [Mitsuba 3] | `.xml` | α; `principled` roughness² | ∞ or 2 | uncorrelated |
//! | [glTF 2.0] | `.gltf`, `.glb` | roughness² | 2 | left open |
//! | [MaterialX] | `.mtlx` | roughness² with the model's anisotropy; BSDF nodes α | 2 | left open |
//!
//! In pbrt σ is the roughness as written with `remaproughness` false, and a surface is smooth under
//! 1e-3. In Mitsuba α is as written, but at least 1e-4; γ is ∞ for `beckmann` and 2 for `ggx`.
//!
//! A roughness that comes from an image is the range of that image's pixels, with the scene's
//! scales and offsets applied. An image that cannot be read counts as [0, 1], with a warning. A
//! parameter that its material does not have gives a warning: it may be misspelt. Materials that
//! are not microfacet models, and those that were not understood, are listed in [`Scene::ignored`];
//! they are not errors. An included file that is missing (scenes are often shared without their
//! geometry), or that is XML and not well formed, gives a warning; in pbrt and Mitsuba every
//! material then counts as used.
//!
//! Outside recipes no content of a material makes the scene an error. Errors are another kind of
//! document, a wrong grammar or version, includes in a circle, and a size above the limits.
//!
//! Scenes far larger than any that exist are refused, with the limit: reading ends within seconds
//! and about 1 GB of memory, whatever a file holds. Only regular files are read.
//!
//! [pbrt-v4]: https://pbrt.org/fileformat-v4
//! [Mitsuba 3]: https://mitsuba.readthedocs.io/en/stable/src/plugin_reference/plugins_bsdfs.html
//! [glTF 2.0]: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
//! [MaterialX]: https://materialx.org/Specification.html

mod builder;
mod fresnel;
mod gltf;
mod include;
mod limits;
mod materialx;
mod mitsuba;
mod pbrt;
mod references;
pub mod survey;
mod texture;
mod xml;

use std::path::Path;

use microfacet_baker::input;
use microfacet_baker::scene::{Format, Place, Scene, SceneError, SceneErrorKind};

type Result<T, E = SceneError> = std::result::Result<T, E>;

/// Reads the scene description in `path`; the extension determines the format.
///
/// # Errors
///
/// [`SceneErrorKind::UnknownExtension`] for an extension of no known format, [`SceneErrorKind::Io`]
/// if the file cannot be read, [`SceneErrorKind::Syntax`], [`SceneErrorKind::Foreign`] and
/// [`SceneErrorKind::TooLarge`] with the place of the error in it. A missing image or included file
/// is a warning, and an impossible value in a material makes that material [not
/// understood](microfacet_baker::scene::Ignored::understood); in a recipe it is an error,
/// [`SceneErrorKind::Invalid`].
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    match Format::of(path) {
        Some(Format::Recipe) => Scene::load_recipe(path),
        Some(Format::Pbrt) => pbrt::load(path),
        Some(Format::Mitsuba) => mitsuba::load(path),
        Some(Format::Gltf) => gltf::load(path),
        Some(Format::MaterialX) => materialx::load(path),
        None => {
            let place = Place::file(path);
            // A path that cannot be opened is reported as such, whatever its extension.
            input::open(path, u64::MAX).map_err(|error| place.io(error))?;
            let extension = path.extension().unwrap_or_default().into();
            Err(SceneError { place, kind: SceneErrorKind::UnknownExtension(extension) })
        }
    }
}
