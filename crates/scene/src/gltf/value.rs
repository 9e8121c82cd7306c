//! Values of the document that are read one by one, so that an error in one costs that one alone.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{DeserializeSeed, Error as _, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};
use serde_json::Error;
use serde_json::value::RawValue;

use super::ignored::OTHERS;
use crate::builder::{names_of, shortened, shortened_to};
use crate::limits;

/// A value of the document as its text, which takes no more memory than that.
///
/// An object is read from an object alone, where serde takes a list of its members too; a member
/// that is null is absent; and an error begins with the members that lead to it.
#[derive(Clone, Copy)]
pub(super) struct Value<'de, 'r> {
    text: &'de RawValue,
    /// The member that it is; empty for one that was not reached by a name.
    member: &'r str,
    required: &'r BTreeSet<String>,
    unknown: Option<&'r RefCell<Vec<Unknown>>>,
}

/// Members that are not known and that are told of one material.
const MAX_UNKNOWN: usize = 100;

/// A member that no lobe is read from and that glTF does not have.
pub(super) struct Unknown {
    /// The object that it is in, as a member of its own.
    pub(super) object: String,
    pub(super) name: String,
    /// The names that glTF has there.
    pub(super) known: Vec<&'static str>,
}

impl<'de, 'r> Value<'de, 'r> {
    pub(super) fn of(text: &'de RawValue) -> Self {
        const NONE: &BTreeSet<String> = &BTreeSet::new();
        Self { text, member: "", required: NONE, unknown: None }
    }

    /// The same, which cannot be read where it has one of these extensions and it is not known.
    pub(super) fn requiring(self, required: &'r BTreeSet<String>) -> Self {
        Self { required, ..self }
    }

    /// The same, which notes what is not known in a material.
    pub(super) fn noting(self, unknown: &'r RefCell<Vec<Unknown>>) -> Self {
        Self { unknown: Some(unknown), ..self }
    }

    /// Reads it; the error says why it cannot be read.
    pub(super) fn read<T: Deserialize<'de>>(self) -> Result<T, String> {
        T::deserialize(self).map_err(|error| message(&error))
    }
}

/// What an error of the parser says, without the place at the end: it counts from where the value
/// begins.
pub(super) fn message(error: &Error) -> String {
    let text = error.to_string();
    let (message, _) = text.rsplit_once(" at line ").unwrap_or((&text, ""));
    // It may quote a whole image.
    shortened(message.into()).into_owned()
}

impl<'de> Deserializer<'de> for Value<'de, '_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.text.deserialize_any(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.text.deserialize_map(Object { visitor, known, value: self })
    }

    /// Of members that are there; null is not.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    /// As a [`RawValue`] asks for its text.
    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.text.deserialize_newtype_struct(name, visitor)
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map enum identifier
    }
}

/// Gives the members of an object to the visitor of a struct with the members `known`.
struct Object<'de, 'r, V> {
    visitor: V,
    known: &'static [&'static str],
    value: Value<'de, 'r>,
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Object<'de, '_, V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<V::Value, A::Error> {
        let Self { visitor, known, value } = self;
        visitor.visit_map(Members { map, known, value, last: None })
    }
}

/// The members that are not null.
struct Members<'de, 'r, A> {
    map: A,
    known: &'static [&'static str],
    /// The object.
    value: Value<'de, 'r>,
    /// That of which the name was read last.
    last: Option<(String, &'de RawValue)>,
}

impl<A> Members<'_, '_, A> {
    /// Notes a member if it is not known; the error says that it is required.
    fn check(&self, name: &str) -> Result<(), String> {
        let Value { member, required, unknown, .. } = self.value;
        let others = || names_of(&OTHERS, member);
        if self.known.contains(&name) || others().contains(&name) {
            return Ok(());
        }
        if required.contains(name) {
            return Err(format!("{name} is not known here, and extensionsRequired has it"));
        }
        // Any object may have these two, and of a texture nothing else is read than its number.
        let Some(unknown) = unknown.filter(|_| !member.ends_with("Texture")) else { return Ok(()) };
        let is_free = ["extensions", "extras"].contains(&name);
        if !is_free && unknown.borrow().len() < MAX_UNKNOWN {
            let known = self.known.iter().copied().chain(others()).collect();
            let (object, name) = (member.to_owned(), name.to_owned());
            unknown.borrow_mut().push(Unknown { object, name, known });
        }
        Ok(())
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Members<'de, '_, A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, A::Error> {
        while let Some((name, text)) = self.map.next_entry::<String, &'de RawValue>()? {
            if text.get() == "null" {
                continue;
            }
            self.check(&name).map_err(A::Error::custom)?;
            let key = seed.deserialize(name.as_str().into_deserializer())?;
            self.last = Some((name, text));
            return Ok(Some(key));
        }
        Ok(None)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        let last = self.last.take();
        let (name, text) = last.ok_or_else(|| A::Error::custom("a value without a name"))?;
        let value = seed.deserialize(Value { text, member: &name, ..self.value });
        value.map_err(|error| A::Error::custom(format!("{name}: {}", message(&error))))
    }
}

/// An element of a list, or why it cannot be read.
pub(super) struct Entry<T>(pub(super) Result<T, String>);

/// Bytes of the reason that an [`Entry`] keeps: there may be very many.
const REASON: usize = 100;

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entry<T> {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
        let read = Value::of(<&RawValue>::deserialize(input)?).read();
        Ok(Self(read.map_err(|why| shortened_to(REASON, why.into()).into_owned())))
    }
}

/// What a file of version 1 is, and what to do with it.
pub(super) const VERSION_1: &str = "glTF 1.0, and only version 2.0 is read; convert it: \
                                    `gltf-pipeline -i old.gltf -o new.gltf` (CesiumGS)";

/// A list of limited length: each element takes far more memory than the text "{}".
pub(super) fn list<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    input: D,
) -> Result<Vec<T>, D::Error> {
    struct List<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for List<T> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a list")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut input: A) -> Result<Vec<T>, A::Error> {
            let mut list = Vec::new();
            while let Some(element) = input.next_element()? {
                if list.len() == limits::JSON_LIST {
                    let most = limits::JSON_LIST;
                    return Err(A::Error::custom(format!("a list has more than {most} elements")));
                }
                let element = Value::of(element).read();
                list.push(element.map_err(A::Error::custom)?);
            }
            Ok(list)
        }

        /// Version 1 has objects for the lists of version 2.
        fn visit_map<A: MapAccess<'de>>(self, _: A) -> Result<Vec<T>, A::Error> {
            Err(A::Error::custom(format!("an object where a list is expected, as in {VERSION_1}")))
        }

        /// As a member that is absent.
        fn visit_unit<E: serde::de::Error>(self) -> Result<Vec<T>, E> {
            Ok(Vec::new())
        }
    }

    // As any value, so that an object is told from the rest.
    input.deserialize_any(List(PhantomData))
}
