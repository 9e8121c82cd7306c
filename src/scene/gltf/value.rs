//! Values of the document that are read one by one, so that an error in one costs that one alone.

use std::collections::BTreeSet;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{DeserializeSeed, Error as _, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};
use serde_json::Error;
use serde_json::value::RawValue;

use super::schema::VERSION_1;
use crate::scene::builder::{shortened, shortened_to};
use crate::scene::limits;

/// A value of the document as its text, which takes no more memory than that.
///
/// An object is read from an object alone, where serde takes a list of its members too; a member
/// that is null is absent; and an error begins with the members that lead to it.
#[derive(Clone, Copy)]
pub(super) struct Value<'de, 'r> {
    text: &'de RawValue,
    required: &'r BTreeSet<String>,
}

impl<'de, 'r> Value<'de, 'r> {
    pub(super) fn of(text: &'de RawValue) -> Self {
        const NONE: &BTreeSet<String> = &BTreeSet::new();
        Self { text, required: NONE }
    }

    /// The same, which cannot be read where it has one of these extensions and it is not known.
    pub(super) fn requiring(self, required: &'r BTreeSet<String>) -> Self {
        Self { required, ..self }
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
        self.text.deserialize_map(Object { visitor, known, required: self.required })
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
struct Object<'r, V> {
    visitor: V,
    known: &'static [&'static str],
    required: &'r BTreeSet<String>,
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Object<'_, V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<V::Value, A::Error> {
        let Self { visitor, known, required } = self;
        visitor.visit_map(Members { map, known, required, last: None })
    }
}

/// The members that are not null.
struct Members<'de, 'r, A> {
    map: A,
    known: &'static [&'static str],
    required: &'r BTreeSet<String>,
    /// That of which the name was read last.
    last: Option<(String, &'de RawValue)>,
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
            if self.required.contains(&name) && !self.known.contains(&&name[..]) {
                return Err(A::Error::custom(format!(
                    "{name} is not known here, and extensionsRequired has it"
                )));
            }
            let key = seed.deserialize(name.as_str().into_deserializer())?;
            self.last = Some((name, text));
            return Ok(Some(key));
        }
        Ok(None)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        let last = self.last.take();
        let (name, text) = last.ok_or_else(|| A::Error::custom("a value without a name"))?;
        let value = seed.deserialize(Value { text, required: self.required });
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
