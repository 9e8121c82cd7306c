//! Numbers, and the ranges of textures.

use super::{Reader, find};
use crate::scene::texture::{Channel, Encoding};
use crate::scene::xml::Element;
use crate::scene::{Interval, SceneError};

/// Names of properties, and those that Mitsuba 0.6 has for the same.
const OLDER: [(&str, &str); 4] =
    [("alpha_u", "alphaU"), ("alpha_v", "alphaV"), ("int_ior", "intIOR"), ("ext_ior", "extIOR")];

/// The property of that name, in either spelling.
pub(super) fn named<'a>(element: &'a Element, name: &str) -> Option<&'a Element> {
    let older = || OLDER.iter().find(|(newer, _)| *newer == name);
    element.child_named(name).or_else(|| element.child_named(older()?.1))
}

impl<'a> Reader<'a> {
    /// A property that is a number, or the range of a texture.
    pub(super) fn property(
        &mut self,
        element: &'a Element,
        name: &str,
        default: f64,
    ) -> Result<Interval, SceneError> {
        match named(element, name) {
            Some(property) => self.value(property),
            None => Ok(Interval::point(default)),
        }
    }

    /// A number, or the range of a texture.
    fn value(&mut self, property: &'a Element) -> Result<Interval, SceneError> {
        match &property.tag[..] {
            "float" | "integer" | "spectrum" => number(property).map(Interval::point),
            "rgb" => rgb(property).map(|rgb| Interval::point(luminance(rgb))),
            "ref" => match self.referred(property) {
                // A reference has no id of its own, so the element found is no reference.
                Ok(texture) => self.value(texture),
                Err(_) if self.incomplete => {
                    let id = property.attribute("id").unwrap_or_default();
                    let reason = "is not in the files that were found";
                    Ok(self.builder.unread(id, reason, &property.place))
                }
                Err(error) => Err(error),
            },
            "texture" => {
                let key = property.key();
                if let Some(known) = self.ranges.begin(key, &property.place)? {
                    return Ok(known);
                }
                let range = self.texture(property)?;
                self.ranges.end(key, range, &property.place)
            }
            tag => Err(property
                .place
                .invalid(format!("<{tag}> gives no number where one is expected"))),
        }
    }

    fn texture(&mut self, texture: &'a Element) -> Result<Interval, SceneError> {
        let place = &texture.place;
        match texture.required("type")? {
            "bitmap" => {
                let value = |name| texture.child_named(name).and_then(|p| p.attribute("value"));
                let Some(file) = value("filename") else {
                    return Ok(self.builder.unread("bitmap", "names no file", place));
                };
                let encoding =
                    if value("raw") == Some("true") { Encoding::Linear } else { Encoding::Srgb };
                let file = find(&self.folders, file);
                Ok(self.builder.image(&file, Channel::Luminance, encoding, place))
            }
            "checkerboard" => {
                let first = self.property(texture, "color0", 0.4)?;
                Ok(first.union(self.property(texture, "color1", 0.2)?))
            }
            "uniform" => self.property(texture, "value", 1.0),
            class => {
                let reason = "has a range that is not known";
                Ok(self.builder.unread(class, reason, place))
            }
        }
    }
}

/// The number in the attribute "value".
pub(super) fn number(property: &Element) -> Result<f64, SceneError> {
    let text = property.required("value")?;
    match text.trim().parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => {
            let remedy = match text.strip_prefix('$') {
                Some(name) => {
                    format!("; give it a value with <default name=\"{name}\" value=\"..\"/>")
                }
                None => String::new(),
            };
            let name = property.attribute("name").unwrap_or("value");
            Err(property.place.invalid(format!("{name} must be a number, not \"{text}\"{remedy}")))
        }
    }
}

/// The three numbers in the attribute "value", or one that stands for all.
pub(super) fn rgb(property: &Element) -> Result<[f64; 3], SceneError> {
    let text = property.required("value")?;
    let numbers: Option<Vec<f64>> = text
        .split([',', ' '])
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[grey]) => Ok([grey; 3]),
        Some(&[r, g, b]) => Ok([r, g, b]),
        _ => {
            let name = property.attribute("name").unwrap_or("value");
            let message =
                format!("{name} must be three numbers, red, green and blue, not \"{text}\"");
            Err(property.place.invalid(message))
        }
    }
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
