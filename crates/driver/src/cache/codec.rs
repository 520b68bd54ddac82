//! How a payload becomes bytes. The only place that knows of bincode.
//!
//! Decoders of this kind accept flipped bits and hostile lengths, so nothing
//! is decoded here that was not hashed before, and always under a limit.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Largest payload that is decoded: 4 GiB, a hundred times the model of a
/// mesh of 34 000 triangles with 26 modes.
const LIMIT: usize = 1 << 32;

/// Why bytes are no payload.
#[derive(Debug, thiserror::Error)]
#[error("the payload cannot be decoded: {0}")]
pub(super) struct Undecodable(String);

fn config() -> impl bincode::config::Config {
    bincode::config::standard().with_limit::<LIMIT>()
}

/// Bytes of a value; none when it is larger than the limit.
pub(super) fn encode<T: Serialize>(value: &T) -> Option<Vec<u8>> {
    let bytes = bincode::serde::encode_to_vec(value, config()).ok()?;
    (bytes.len() <= LIMIT).then_some(bytes)
}

/// The value of exactly these bytes.
pub(super) fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Undecodable> {
    let (value, used) = bincode::serde::decode_from_slice(bytes, config())
        .map_err(|error| Undecodable(error.to_string()))?;
    if used == bytes.len() {
        return Ok(value);
    }
    Err(Undecodable(format!(
        "{} bytes follow the value",
        bytes.len() - used
    )))
}
