//! Objects of a glTF document. Each member is read separately, so that an error in one affects only
//! the object that contains it.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use microfacet_baker::scene::{Place, SceneError};

use super::VERSION_1;
use crate::Result;
use crate::builder::shortened;
use crate::limits;

/// An object, whose members are slices of the document's text.
pub(super) struct Object<'a> {
    place: &'a Place,
    /// The members that lead to it, each with a colon.
    path: String,
    /// Without members that are null, which count as absent.
    pub(super) members: BTreeMap<String, &'a RawValue>,
}

impl<'a> Object<'a> {
    /// The object of a text, to which the members of `path` lead.
    pub(super) fn new(place: &'a Place, path: String, text: &'a RawValue) -> Result<Self> {
        let mut object = Self { place, path, members: BTreeMap::new() };
        let members = text.deserialize_any(Members(BTreeMap::new()));
        object.members = members.map_err(|error| object.invalid(message(&error)))?;
        object.check_length("", object.members.len(), "members")?;
        object.members.retain(|_, text| text.get() != "null");
        Ok(object)
    }

    pub(super) fn invalid(&self, why: impl AsRef<str>) -> SceneError {
        self.place.invalid(format!("{}{}", self.path, why.as_ref()))
    }

    /// Checks how many elements a list in it has, or how many members it has itself.
    fn check_length(&self, name: &str, length: usize, what: &str) -> Result<()> {
        if length <= limits::ENTRIES {
            return Ok(());
        }
        Err(self.place.too_large(format!(
            "{}{name}there are more than {} {what}; split the scene",
            self.path,
            limits::ENTRIES
        )))
    }

    fn read<T: Deserialize<'a>>(&self, name: &str, text: &'a RawValue) -> Result<T> {
        T::deserialize(text).map_err(|e| self.invalid(format!("{name}: {}", message(&e))))
    }

    fn member<T: Deserialize<'a>>(&self, name: &str) -> Result<Option<T>> {
        self.members.get(name).map(|text| self.read(name, text)).transpose()
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
        let Some(text) = self.members.get(name) else { return Ok(Vec::new()) };
        let name = format!("{name}: ");
        let list = text.deserialize_any(Elements(Vec::new()));
        let list = list.map_err(|error| self.invalid(name.clone() + &message(&error)))?;
        self.check_length(&name, list.len(), "elements")?;
        Ok(list)
    }

    /// The objects in a list, read one at a time: each takes far more memory than the text "{}".
    pub(super) fn objects(&self, name: &str) -> Result<impl Iterator<Item = Result<Self>>> {
        let (place, path) = (self.place, format!("{}{name}: ", self.path));
        Ok(self.list(name)?.into_iter().map(move |text| Self::new(place, path.clone(), text)))
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
        if !self.members.contains_key(name) {
            return Ok(default);
        }
        let (list, mut numbers) = (self.list(name)?, default);
        if list.len() != N {
            let count = list.len();
            let why = format!("{name}: the list has {count} numbers; it must have {N}");
            return Err(self.invalid(why));
        }
        for (number, text) in numbers.iter_mut().zip(list) {
            *number = self.read(name, text)?;
        }
        Ok(numbers)
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
        // Above 2^53 not every whole number is an `f64`.
        const MOST: f64 = (1u64 << 53) as f64;
        let Some(text) = self.members.get(name) else { return Ok(None) };
        match f64::deserialize(*text) {
            Ok(number) if number.fract() == 0.0 && (0.0..=MOST).contains(&number) => {
                Ok(Some(number as u64))
            }
            _ => {
                let said = shortened(text.get());
                Err(self.invalid(format!("{name}: {said} is not a whole number from 0 to 2^53")))
            }
        }
    }

    /// As [`Self::index`]; an absent member is an error.
    pub(super) fn required_index(&self, name: &str) -> Result<u64> {
        self.index(name)?.ok_or_else(|| self.invalid(format!("{name} is missing")))
    }
}

/// The message of a parser error without line and column, which count from the value's start.
pub(super) fn message(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let text = text.rsplit_once(" at line ").map_or(&text[..], |(message, _)| message);
    // Rust's names of types become those of JSON.
    let text = text.replace("invalid type: map", "invalid type: object");
    // The message may quote a whole image.
    shortened(&text.replace("expected f64", "expected a number")).into_owned()
}

/// Collects the members of an object, at most one more than the limit.
struct Members<'a>(BTreeMap<String, &'a RawValue>);

impl<'a> Visitor<'a> for Members<'a> {
    type Value = BTreeMap<String, &'a RawValue>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'a>>(self, mut input: A) -> Result<Self::Value, A::Error> {
        let Self(mut members) = self;
        while members.len() <= limits::ENTRIES {
            let Some(name) = input.next_key::<String>()? else { return Ok(members) };
            if members.contains_key(&name) {
                let why = format!("a second member {name}; remove one of them");
                return Err(A::Error::custom(why));
            }
            members.insert(name, input.next_value()?);
        }
        while input.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(members)
    }
}

/// Collects the elements of a list, at most one more than the limit.
struct Elements<'a>(Vec<&'a RawValue>);

impl<'a> Visitor<'a> for Elements<'a> {
    type Value = Vec<&'a RawValue>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'a>>(self, mut input: A) -> Result<Self::Value, A::Error> {
        let Self(mut list) = self;
        while list.len() <= limits::ENTRIES {
            let Some(element) = input.next_element()? else { return Ok(list) };
            list.push(element);
        }
        while input.next_element::<IgnoredAny>()?.is_some() {}
        Ok(list)
    }

    /// Version 1 has objects for the lists of version 2.
    fn visit_map<A: MapAccess<'a>>(self, _: A) -> Result<Self::Value, A::Error> {
        Err(A::Error::custom(format!("an object where a list is expected, as in {VERSION_1}")))
    }
}
