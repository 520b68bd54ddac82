//! A value or a list of values.

use serde::Deserialize;
use serde::de::{Deserializer, SeqAccess, Visitor, value::SeqAccessDeserializer};
use std::fmt;
use std::marker::PhantomData;

/// One value, or one a mode.
#[derive(Clone, Debug, PartialEq)]
pub enum OneOrMany<T> {
    /// The same for all.
    One(T),
    /// One each.
    Many(Vec<T>),
}

impl<T> OneOrMany<T> {
    /// All values given.
    pub fn as_slice(&self) -> &[T] {
        match self {
            Self::One(value) => std::slice::from_ref(value),
            Self::Many(values) => values,
        }
    }
}

/// Values that can stand alone where a list may stand.
pub trait Single: Sized {
    /// What the value is called in messages.
    const EXPECTED: &'static str;
    /// From a number.
    fn number(value: f64) -> Option<Self>;
    /// From a text.
    fn text(value: &str) -> Option<Self>;
}

impl Single for f64 {
    const EXPECTED: &'static str = "a number or a list of numbers";
    fn number(value: f64) -> Option<Self> {
        Some(value)
    }
    fn text(_: &str) -> Option<Self> {
        None
    }
}

impl Single for std::path::PathBuf {
    const EXPECTED: &'static str = "a file name or a list of file names";
    fn number(_: f64) -> Option<Self> {
        None
    }
    fn text(value: &str) -> Option<Self> {
        Some(value.into())
    }
}

impl Single for String {
    const EXPECTED: &'static str = "a name or a list of names";
    fn number(_: f64) -> Option<Self> {
        None
    }
    fn text(value: &str) -> Option<Self> {
        Some(value.to_owned())
    }
}

struct Either<T>(PhantomData<T>);

impl<'de, T: Single + Deserialize<'de>> Visitor<'de> for Either<T> {
    type Value = OneOrMany<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Self::Value, E> {
        let wrong = || E::invalid_type(serde::de::Unexpected::Float(value), &self);
        T::number(value).map(OneOrMany::One).ok_or_else(wrong)
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
        let wrong = || E::invalid_type(serde::de::Unexpected::Signed(value), &self);
        T::number(value as f64)
            .map(OneOrMany::One)
            .ok_or_else(wrong)
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Self::Value, E> {
        let wrong = || E::invalid_type(serde::de::Unexpected::Str(value), &self);
        T::text(value).map(OneOrMany::One).ok_or_else(wrong)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<Self::Value, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(sequence)).map(OneOrMany::Many)
    }
}

impl<'de, T: Single + Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Either(PhantomData))
    }
}
