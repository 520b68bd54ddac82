//! Content address of one aerodynamic result.

use std::fmt;

/// Hash of everything that can change the numbers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key([u8; 32]);

impl Key {
    /// Number of bytes.
    pub const LENGTH: usize = 32;

    /// From the bytes of a header.
    pub(crate) fn from_bytes(bytes: [u8; 32]) -> Self {
        Self(bytes)
    }

    /// The bytes.
    pub(crate) fn as_bytes(&self) -> &[u8; 32] {
        &self.0
    }

    /// From 64 hexadecimal digits, as in a file name.
    pub fn from_hex(text: &str) -> Option<Self> {
        blake3::Hash::from_hex(text)
            .ok()
            .map(|hash| Self(*hash.as_bytes()))
    }

    /// 64 hexadecimal digits.
    pub fn to_hex(&self) -> String {
        blake3::Hash::from_bytes(self.0).to_hex().to_string()
    }

    /// The first digits, enough to tell entries of one store apart.
    pub fn short(&self) -> String {
        self.to_hex()[..12].to_owned()
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.to_hex())
    }
}

/// Hashes named fields.
///
/// Anything that can change the numbers goes in; anything that cannot (thread
/// count, paths, names, time) stays out. Names and contents are both preceded
/// by their length, so that fields cannot run together.
#[derive(Clone, Debug)]
pub struct KeyBuilder(blake3::Hasher);

impl KeyBuilder {
    /// Begins with the word of meaning: it changes when the same inputs would
    /// give other numbers.
    pub fn new(meaning: &str) -> Self {
        Self(blake3::Hasher::new()).field("meaning", meaning.as_bytes())
    }

    /// Adds a named field.
    #[must_use]
    pub fn field(mut self, name: &str, bytes: &[u8]) -> Self {
        self.part(name.as_bytes());
        self.part(bytes);
        self
    }

    /// Adds numbers by their bits; −0 counts as 0.
    #[must_use]
    pub fn numbers(mut self, name: &str, values: impl ExactSizeIterator<Item = f64>) -> Self {
        self.part(name.as_bytes());
        self.0.update(&(8 * values.len() as u64).to_le_bytes());
        for value in values {
            self.0.update(&(value + 0.0).to_bits().to_le_bytes());
        }
        self
    }

    /// Adds indices.
    #[must_use]
    pub fn indices(mut self, name: &str, values: impl ExactSizeIterator<Item = u32>) -> Self {
        self.part(name.as_bytes());
        self.0.update(&(4 * values.len() as u64).to_le_bytes());
        for value in values {
            self.0.update(&value.to_le_bytes());
        }
        self
    }

    fn part(&mut self, bytes: &[u8]) {
        self.0.update(&(bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    /// The key.
    pub fn finish(&self) -> Key {
        Key(*self.0.finalize().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_cannot_run_together() {
        let key = |parts: &[(&str, &[u8])]| {
            parts
                .iter()
                .fold(KeyBuilder::new("t/1"), |k, (n, b)| k.field(n, b))
                .finish()
        };
        assert_ne!(key(&[("a", b"bc")]), key(&[("ab", b"c")]));
        assert_ne!(key(&[("a", b"b"), ("c", b"d")]), key(&[("a", b"bcd")]));
        assert_ne!(key(&[]), key(&[("", b"")]));
    }

    #[test]
    fn a_key_survives_its_text() {
        let key = KeyBuilder::new("t/1")
            .numbers("x", [1.0, -0.0].into_iter())
            .finish();
        assert_eq!(Key::from_hex(&key.to_hex()), Some(key));
        let other = KeyBuilder::new("t/1")
            .numbers("x", [1.0, 0.0].into_iter())
            .finish();
        assert_eq!(key, other);
        assert_eq!(Key::from_hex("zz"), None);
    }
}
