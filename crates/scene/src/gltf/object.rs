//! Objects of the document, of which each member is read by itself, so that an error in one costs
//! no more than what it is a part of.

use std::collections::BTreeMap;

use crate::Result;
use microfacet_baker::scene::{Place, SceneError};
use serde::Deserialize;
use serde_json::value::RawValue;

/// An object, whose members are kept as their texts and take no more memory than those.
#[derive(Clone)]
pub(super) struct Object<'a> {
    place: &'a Place,
    /// The members that lead to it, each with a colon.
    path: String,
    /// Without those that are null, which are absent.
    pub(super) members: BTreeMap<String, &'a RawValue>,
}

impl<'a> Object<'a> {
    /// The object of a text, to which the members of `path` lead.
    pub(super) fn new(place: &'a Place, path: String, text: &'a RawValue) -> Result<Self> {
        let mut object = Self { place, path, members: BTreeMap::new() };
        object.members = object.read("", text)?;
        object.members.retain(|_, text| text.get() != "null");
        Ok(object)
    }

    /// The error for something in it.
    pub(super) fn invalid(&self, why: impl AsRef<str>) -> SceneError {
        self.place.invalid(format!("{}{}", self.path, why.as_ref()))
    }

    fn read<T: Deserialize<'a>>(&self, name: &str, text: &'a RawValue) -> Result<T> {
        serde_json::from_str(text.get()).map_err(|e| self.invalid(format!("{name}{}", message(&e))))
    }

    fn member<T: Deserialize<'a>>(&self, name: &str) -> Result<Option<T>> {
        let text = self.members.get(name);
        text.map(|text| self.read(&format!("{name}: "), text)).transpose()
    }

    /// An object in it; `None` if it is absent.
    pub(super) fn object(&self, name: &str) -> Result<Option<Self>> {
        let path = format!("{}{name}: ", self.path);
        self.members.get(name).map(|text| Self::new(self.place, path, text)).transpose()
    }

    /// An object in it; one without members if it is absent.
    pub(super) fn object_or_empty(&self, name: &str) -> Result<Self> {
        let empty = Self { place: self.place, path: String::new(), members: BTreeMap::new() };
        Ok(self.object(name)?.unwrap_or(empty))
    }

    pub(super) fn text(&self, name: &str) -> Result<Option<String>> {
        self.member(name)
    }

    /// The texts of the elements of a list, which is empty if it is absent.
    pub(super) fn list(&self, name: &str) -> Result<Vec<&'a RawValue>> {
        Ok(self.member(name)?.unwrap_or_default())
    }

    /// The objects in a list.
    pub(super) fn objects(&self, name: &str) -> Result<Vec<Self>> {
        let path = format!("{}{name}: ", self.path);
        let of = |text: &'a RawValue| Self::new(self.place, path.clone(), text);
        self.list(name)?.into_iter().map(of).collect()
    }

    pub(super) fn number(&self, name: &str, default: f64) -> Result<f64> {
        Ok(self.member(name)?.unwrap_or(default))
    }

    /// A number, which must be in [0, 1].
    pub(super) fn unit(&self, name: &str, default: f64) -> Result<f64> {
        self.in_unit(name, self.number(name, default)?)
    }

    /// A list of exactly so many numbers.
    pub(super) fn numbers<const N: usize>(
        &self,
        name: &str,
        default: [f64; N],
    ) -> Result<[f64; N]> {
        let Some(list) = self.member::<Vec<f64>>(name)? else { return Ok(default) };
        list.try_into().map_err(|list: Vec<f64>| {
            let count = list.len();
            self.invalid(format!("{name}: the list has {count} numbers; it must have {N}"))
        })
    }

    /// A colour, whose channels must be in [0, 1].
    pub(super) fn colour(&self, name: &str, [r, g, b]: [f64; 3]) -> Result<[f64; 3]> {
        Ok([self.in_unit(name, r)?, self.in_unit(name, g)?, self.in_unit(name, b)?])
    }

    fn in_unit(&self, name: &str, factor: f64) -> Result<f64> {
        if (0.0..=1.0).contains(&factor) {
            return Ok(factor);
        }
        Err(self.place.invalid(format!("{name} is {factor}; it must be from 0 to 1")))
    }

    /// A whole number, which some programs write as `1.0`.
    pub(super) fn index(&self, name: &str) -> Result<Option<u64>> {
        // Above 2^53 not every whole number is one of these.
        const MOST: f64 = (1u64 << 53) as f64;
        match self.member::<f64>(name)? {
            Some(number) if !(number.fract() == 0.0 && (0.0..=MOST).contains(&number)) => {
                Err(self
                    .invalid(format!("{name}: {number:?} is not a whole number from 0 to 2^53")))
            }
            number => Ok(number.map(|number| number as u64)),
        }
    }

    /// The same, of a member that must be there.
    pub(super) fn required_index(&self, name: &str) -> Result<u64> {
        self.index(name)?.ok_or_else(|| self.invalid(format!("{name} is missing")))
    }
}

/// What an error of the parser says, without the place at the end: it counts from where the value
/// begins.
pub(super) fn message(error: &serde_json::Error) -> String {
    let text = error.to_string().replace("expected a map", "expected an object");
    text.rsplit_once(" at line ").map_or(&text[..], |(message, _)| message).to_owned()
}
