//! The microfacet lobes of a scene, from which a table set is planned, and the native format of
//! scenes, the recipe. The crate `microfacet-scene` reads other formats.

mod error;
mod limits;
mod material;
mod names;
mod recipe;

use std::path::{Path, PathBuf};

use microfacet_tables::MaterialEntry;

pub use error::{
    Lines, MOST_CANDIDATES, Place, SceneError, SceneErrorKind, characters, did_you_mean,
    did_you_mean_key,
};
pub use limits::Budget;
pub use material::{
    Format, Haze, Ignored, LobeSpec, Masking, Material, Origin, Reflectance, Roughness,
};
pub use names::Names;

/// The microfacet lobes of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The microfacet lobes, in the order of their definition; names are unique.
    pub materials: Vec<Material>,
    /// Materials without a lobe: those for which there is nothing to bake, and those that were
    /// not understood.
    pub ignored: Vec<Ignored>,
    /// The files that the scene's own file includes, and those that they include, each once, with
    /// links resolved.
    pub included: Vec<PathBuf>,
    /// Assumptions made where the scene could not be read in full, and values that look like a
    /// mistake, each with its position in the file.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Reads a native recipe.
    ///
    /// # Errors
    ///
    /// [`SceneErrorKind::Syntax`] for text that is not TOML, [`SceneErrorKind::Invalid`] for an
    /// unknown key, a duplicate name, no material at all, or a value out of its range.
    ///
    /// # Example
    ///
    /// ```
    /// use microfacet_tables::Interval;
    /// use microfacet_baker::scene::Scene;
    ///
    /// let recipe = "[[material]]\nname = \"gold\"\nsigma = 0.3\ngamma = 4.0\n";
    /// let scene = Scene::from_recipe_str(recipe)?;
    /// assert_eq!(scene.materials[0].lobe.gamma, Interval::point(4.0));
    /// assert_eq!(scene.to_recipe(), recipe);
    /// # Ok::<(), microfacet_baker::scene::SceneError>(())
    /// ```
    pub fn from_recipe_str(text: &str) -> Result<Self, SceneError> {
        recipe::read(text, Path::new("recipe"))
    }

    /// Reads a native recipe from a file.
    ///
    /// # Errors
    ///
    /// As [`from_recipe_str`](Self::from_recipe_str); [`SceneErrorKind::Io`] if the file cannot be
    /// read, [`SceneErrorKind::TooLarge`] and [`SceneErrorKind::Foreign`] for other kinds of TOML.
    pub fn load_recipe(file: &Path) -> Result<Self, SceneError> {
        recipe::load(file)
    }

    /// The warnings, then the materials that were not understood, each with its position in the
    /// file.
    pub fn doubts(&self) -> impl Iterator<Item = String> {
        let unknown = self.ignored.iter().filter(|ignored| !ignored.understood);
        self.warnings.iter().cloned().chain(unknown.map(Ignored::to_string))
    }

    /// The native recipe of the materials in use.
    ///
    /// It reads back to [the same](Material::asks_the_same) materials, bit for bit. A scene that
    /// uses no material gives an empty text, which is not a valid recipe.
    #[must_use]
    pub fn to_recipe(&self) -> String {
        let used = self.materials.iter().filter(|material| material.used);
        recipe_of(&used.map(Material::entry).collect::<Vec<_>>())
    }
}

/// The native recipe of the materials that a set lists, from which the same set can be baked.
pub fn recipe_of(materials: &[MaterialEntry]) -> String {
    recipe::write(materials)
}
