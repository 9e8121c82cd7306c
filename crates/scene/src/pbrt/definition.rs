//! Materials and float textures as they are written: a class with parameters.

use std::rc::Rc;

use microfacet_baker::scene::Place;

use crate::Result;
use crate::builder::has_word;

/// Materials of pbrt-v3 that pbrt-v4 does not have (`api.cpp` of v3, `materials.cpp` of v4).
pub(super) const OLDER: &str = "disney fourier glass kdsubsurface matte metal mirror plastic \
                                substrate translucent uber";

#[derive(Debug)]
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) class: String,
    pub(super) parameters: Vec<Rc<Parameter>>,
    pub(super) place: Place,
}

/// A parameter: `"type name" value` or `"type name" [ values ]`.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) kind: String,
    pub(super) name: String,
    /// The first values, as written.
    pub(super) values: Vec<String>,
    pub(super) place: Place,
}

impl Definition {
    pub(super) fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|p| p.name == name).map(Rc::as_ref)
    }

    /// Whether pbrt-v3 has such a material and pbrt-v4 does not.
    pub(super) fn is_of_v3(&self) -> bool {
        has_word(OLDER, &self.class)
            || self.class == "mix" && self.parameter("namedmaterial1").is_some()
    }

    pub(super) fn truth(&self, name: &str, default: bool) -> Result<bool> {
        let Some(parameter) = self.parameter(name) else { return Ok(default) };
        let value = parameter.first().parse();
        value.map_err(|_| parameter.place.invalid(format!("{name} must be true or false")))
    }
}

impl Parameter {
    /// Bytes of its texts, with one for the end of each.
    pub(super) fn bytes(&self) -> usize {
        let values: usize = self.values.iter().map(|value| value.len() + 1).sum();
        self.kind.len() + self.name.len() + 2 + values
    }

    pub(super) fn first(&self) -> &str {
        self.values.first().map_or("", |value| value)
    }

    pub(super) fn number(&self) -> Result<f64> {
        match self.first().parse() {
            Ok(number) if f64::is_finite(number) => Ok(number),
            _ => Err(self.place.invalid(format!(
                "{} must be a number, not \"{}\"",
                self.name,
                self.first()
            ))),
        }
    }
}
