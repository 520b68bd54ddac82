//! One entry as bytes, little-endian:
//!
//! magic 8 · format 4 · flags 4 · payload length 8 · key 32 · BLAKE3 of the
//! payload 32 · BLAKE3 of the header before it 32 · payload · nothing after.
//!
//! The header keeps this layout in all formats, so that an entry of a newer
//! version is told from a damaged one.

use super::key::Key;

const MAGIC: [u8; 8] = *b"FLADGAF\n";
/// Format that is written.
pub(super) const FORMAT: u32 = 1;
const HASHED: usize = 8 + 4 + 4 + 8 + Key::LENGTH + 32;
const HEADER: usize = HASHED + 32;

/// Why a file is not the entry that was asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Not a regular file.
    #[error("it is no regular file")]
    NotAFile,
    /// It could not be read.
    #[error("it cannot be read: {0}")]
    Unreadable(String),
    /// Too short for a header.
    #[error("it has {found} bytes, its header alone has {HEADER}")]
    NoHeader {
        /// Bytes of the file.
        found: u64,
    },
    /// The file begins otherwise.
    #[error("it does not begin as an entry does")]
    Magic,
    /// The header does not match its checksum.
    #[error("the checksum of its header does not match")]
    HeaderChecksum,
    /// Written by a later version.
    #[error("it has format {found}, this version knows up to {FORMAT}; it was left untouched")]
    Newer {
        /// Format of the entry.
        found: u32,
    },
    /// Written by an earlier version.
    #[error("it has the earlier format {found}, this version reads {FORMAT}")]
    Older {
        /// Format of the entry.
        found: u32,
    },
    /// More or fewer bytes than the header says.
    #[error("it is {found} of {expected} bytes")]
    Size {
        /// Bytes of the file.
        found: u64,
        /// Bytes of header and payload.
        expected: u64,
    },
    /// The header holds another key.
    #[error("it belongs to another case: its key is {}", .0.short())]
    OtherKey(Key),
    /// The payload does not match its checksum.
    #[error("the checksum of its payload does not match")]
    PayloadChecksum,
    /// The payload cannot be decoded.
    #[error("{0}")]
    Undecodable(String),
    /// Values that are not finite, or sizes that do not fit together.
    #[error("its values are not finite or do not fit together")]
    Unsound,
}

/// Header and payload in one piece.
pub(super) fn seal(key: &Key, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&FORMAT.to_le_bytes());
    bytes.extend_from_slice(&0u32.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(key.as_bytes());
    bytes.extend_from_slice(blake3::hash(payload).as_bytes());
    let header = blake3::hash(&bytes);
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend_from_slice(payload);
    bytes
}

/// The payload of an entry, if the bytes are one whole and unharmed entry of
/// this key. Nothing is decoded here.
pub(super) fn open<'b>(bytes: &'b [u8], key: &Key) -> Result<&'b [u8], Fault> {
    let found = bytes.len() as u64;
    let Some((header, payload)) = bytes.split_at_checked(HEADER) else {
        return Err(Fault::NoHeader { found });
    };
    if header[..8] != MAGIC {
        return Err(Fault::Magic);
    }
    if *blake3::hash(&header[..HASHED]).as_bytes() != header[HASHED..] {
        return Err(Fault::HeaderChecksum);
    }
    match word(header, 8) {
        newer if newer > FORMAT => return Err(Fault::Newer { found: newer }),
        older if older < FORMAT => return Err(Fault::Older { found: older }),
        _ => {}
    }
    let length = u64::from(word(header, 16)) | u64::from(word(header, 20)) << 32;
    let expected = length.saturating_add(HEADER as u64);
    if expected != found {
        return Err(Fault::Size { found, expected });
    }
    let own = Key::from_bytes(digest(header, 24));
    if own != *key {
        return Err(Fault::OtherKey(own));
    }
    if *blake3::hash(payload).as_bytes() != digest(header, 24 + Key::LENGTH) {
        return Err(Fault::PayloadChecksum);
    }
    Ok(payload)
}

fn word(header: &[u8], at: usize) -> u32 {
    let bytes: [u8; 4] = std::array::from_fn(|i| header[at + i]);
    u32::from_le_bytes(bytes)
}

fn digest(header: &[u8], at: usize) -> [u8; 32] {
    std::array::from_fn(|i| header[at + i])
}

#[cfg(test)]
mod tests {
    use super::super::KeyBuilder;
    use super::*;

    fn key(name: &str) -> Key {
        KeyBuilder::new(name).finish()
    }

    /// Deterministic bytes without structure (multiplicative congruence).
    fn noise(count: usize) -> Vec<u8> {
        let mut state = 1u64;
        (0..count)
            .map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (state >> 56) as u8
            })
            .collect()
    }

    #[test]
    fn an_entry_gives_back_its_payload() {
        let payload = noise(5000);
        assert_eq!(
            open(&seal(&key("a"), &payload), &key("a")),
            Ok(&payload[..])
        );
    }

    #[test]
    fn no_truncation_is_accepted() {
        let whole = seal(&key("a"), &noise(2000));
        for length in 0..whole.len() {
            assert!(
                open(&whole[..length], &key("a")).is_err(),
                "{length} bytes accepted"
            );
        }
    }

    #[test]
    fn no_flipped_bit_is_accepted() {
        let whole = seal(&key("a"), &noise(3000));
        let bits = whole.len() * 8;
        for flip in 0..4000 {
            let bit = if flip < HEADER * 8 {
                flip
            } else {
                (flip * 7919) % bits
            };
            let mut damaged = whole.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(open(&damaged, &key("a")).is_err(), "bit {bit} accepted");
        }
    }

    #[test]
    fn appended_bytes_and_foreign_keys_are_refused() {
        let mut whole = seal(&key("a"), &noise(100));
        assert!(matches!(open(&whole, &key("b")), Err(Fault::OtherKey(_))));
        whole.extend(noise(64));
        assert!(matches!(open(&whole, &key("a")), Err(Fault::Size { .. })));
    }

    #[test]
    fn other_formats_are_told_from_damage() {
        for (format, newer) in [(FORMAT + 1, true), (0, false)] {
            let mut bytes = seal(&key("a"), &noise(100));
            bytes[8..12].copy_from_slice(&format.to_le_bytes());
            let header = blake3::hash(&bytes[..HASHED]);
            bytes[HASHED..HEADER].copy_from_slice(header.as_bytes());
            let fault = open(&bytes, &key("a")).expect_err("another format");
            assert_eq!(matches!(fault, Fault::Newer { .. }), newer);
            assert_eq!(matches!(fault, Fault::Older { .. }), !newer);
        }
    }
}
