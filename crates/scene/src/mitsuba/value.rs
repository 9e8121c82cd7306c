//! Numbers, and the ranges of textures.

use microfacet_tables::Interval;

use super::{Reader, find};
use crate::Result;
use crate::builder::{Row, names_of};
use crate::texture::{Channel, Encoding};
use crate::xml::Element;

/// Properties of textures by their type; the second and the fourth row are of Mitsuba 0.6.
const TEXTURES: [Row; 5] = [
    ("bitmap", "filename bitmap data to_uv filter_type wrap_mode raw format accel"),
    ("bitmap", "channel gamma cache max_anisotropy wrap_mode_u wrap_mode_v"),
    ("checkerboard", "color0 color1 to_uv"),
    ("bitmap checkerboard", "coordinates uoffset voffset uvscale uscale vscale"),
    ("uniform", "value wavelength_min wavelength_max lambda_min lambda_max"),
];

/// Textures with more properties than this are not compared, so that time stays linear.
const MOST_COMPARED: usize = 32;

/// The property `name`, in the spelling of Mitsuba 3 or of 0.6.
pub(super) fn named<'a>(element: &'a Element, name: &str) -> Option<&'a Element> {
    let is_older = |child: &&Element| child.attribute("name").is_some_and(|n| newer(n) == name);
    element.child_named(name).or_else(|| element.children.iter().find(is_older))
}

/// The name of a property of Mitsuba 0.6 as Mitsuba 3 has it: `int_ior` for `intIOR` (its
/// `camel_to_underscore_case`).
fn newer(name: &str) -> String {
    let mut newer = String::with_capacity(name.len() + 2);
    let (mut after_small, mut in_word) = (false, false);
    for letter in name.chars() {
        in_word = letter.is_ascii_uppercase() && (after_small || in_word);
        if in_word && after_small {
            newer.push('_');
        }
        newer.push(if in_word { letter.to_ascii_lowercase() } else { letter });
        after_small = letter.is_ascii_lowercase();
    }
    newer
}

impl<'a> Reader<'a> {
    /// Warns of properties that a plugin does not have; says nothing of plugins in no row.
    pub(super) fn check_properties(&mut self, rows: &[Row], plugin: &Element) {
        let class = plugin.attribute("type").unwrap_or_default();
        let known = names_of(rows, class);
        for child in &plugin.children {
            let id = child.attribute("id").filter(|_| child.tag == "ref");
            // A reference to what does not exist is warned of where it is followed.
            let what = id.map_or(Some(child), |id| self.ids.get(id).copied());
            // BSDFs inside have any name, and the others are no properties.
            let others = ["bsdf", "default", "path", "alias"];
            if known.is_empty() || what.is_none_or(|what| others.contains(&&what.tag[..])) {
                continue;
            }
            match child.attribute("name") {
                Some(name) if known.contains(&&newer(name)[..]) => {}
                Some(name) => self.builder.check_name(class, name, &known, &child.place),
                None => self.builder.warn(
                    &child.place,
                    format!("<{}> in {class} has no name, and is not read", child.tag),
                ),
            }
        }
    }

    /// Whether two properties are one texture, or two that say the same in words; textures inside
    /// textures are not compared.
    pub(super) fn is_same(&self, a: &'a Element, b: &'a Element) -> bool {
        let end = |it: &'a Element| match &it.tag[..] {
            "ref" => self.referred(it).unwrap_or(it),
            _ => it,
        };
        let (a, b) = (end(a), end(b));
        let is_small = a.children.len() <= MOST_COMPARED;
        let said = |it: &'a Element| {
            let named = |(key, _): &&(String, String)| !matches!(&key[..], "name" | "id");
            it.attributes.iter().filter(named)
        };
        let plain = |(a, b): (&Element, &Element)| {
            (&a.tag, &a.attributes) == (&b.tag, &b.attributes)
                && a.children.is_empty()
                && b.children.is_empty()
        };
        core::ptr::eq(a, b)
            || is_small
                && a.tag == b.tag
                && said(a).eq(said(b))
                && a.children.len() == b.children.len()
                && a.children.iter().zip(&b.children).all(plain)
    }

    /// A property that is a number, or the range of a texture.
    pub(super) fn property(
        &mut self,
        element: &'a Element,
        name: &str,
        default: f64,
    ) -> Result<Interval> {
        match named(element, name) {
            Some(property) => self.value(property),
            None => Ok(Interval::point(default)),
        }
    }

    /// A number, or the range of a texture.
    fn value(&mut self, property: &'a Element) -> Result<Interval> {
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
                if let Some(known) = self.ranges.begin(property, &property.place)? {
                    return Ok(known);
                }
                let range = self.texture(property)?;
                self.ranges.end(property, range, &property.place)
            }
            tag => Err(property
                .place
                .invalid(format!("<{tag}> gives no number where one is expected"))),
        }
    }

    fn texture(&mut self, texture: &'a Element) -> Result<Interval> {
        let place = &texture.place;
        self.check_properties(&TEXTURES, texture);
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
pub(super) fn number(property: &Element) -> Result<f64> {
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
pub(super) fn rgb(property: &Element) -> Result<[f64; 3]> {
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
