//! Materials and textures as they are written: a class with parameters.

use std::rc::Rc;

use microfacet_baker::scene::{Place, SceneError};

use super::syntax::Parameter;

/// Materials of pbrt-v3 that pbrt-v4 does not have (`api.cpp` of v3, `materials.cpp` of v4).
pub(super) const OLDER: [&str; 11] = [
    "disney",
    "fourier",
    "glass",
    "kdsubsurface",
    "matte",
    "metal",
    "mirror",
    "plastic",
    "substrate",
    "translucent",
    "uber",
];

/// A material or a float texture: a class with parameters.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) class: String,
    parameters: Vec<Rc<Parameter>>,
    pub(super) place: Place,
}

impl Definition {
    pub(super) fn new(
        name: String,
        class: String,
        parameters: Vec<Rc<Parameter>>,
        place: Place,
    ) -> Self {
        Self { name, class, parameters, place }
    }

    pub(super) fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|p| p.name == name).map(Rc::as_ref)
    }

    /// Whether pbrt-v3 has such a material and pbrt-v4 has not.
    pub(super) fn is_of_v3(&self) -> bool {
        OLDER.contains(&&self.class[..])
            || self.class == "mix" && self.parameter("namedmaterial1").is_some()
    }

    pub(super) fn truth(&self, name: &str, default: bool) -> Result<bool, SceneError> {
        let Some(parameter) = self.parameter(name) else {
            return Ok(default);
        };
        match parameter.values.first().map(|value| &value[..]) {
            Some("true") => Ok(true),
            Some("false") => Ok(false),
            _ => Err(parameter.place.invalid(format!("{name} must be true or false"))),
        }
    }
}

impl Parameter {
    pub(super) fn number(&self) -> Result<f64, SceneError> {
        let text = self.values.first().map_or("", |value| value);
        match text.parse() {
            Ok(number) if f64::is_finite(number) => Ok(number),
            _ => Err(self.place.invalid(format!("{} must be a number, not \"{text}\"", self.name))),
        }
    }
}
