//! Numbers of VTK's types from binary data.

/// Bytes of a number.
pub(super) fn width(kind: &str) -> Option<usize> {
    Some(match kind {
        "Int8" | "UInt8" => 1,
        "Int16" | "UInt16" => 2,
        "Int32" | "UInt32" | "Float32" => 4,
        "Int64" | "UInt64" | "Float64" => 8,
        _ => return None,
    })
}

/// The number in little-endian bytes; those behind its width are not looked at.
pub(super) fn value(kind: &str, b: [u8; 8]) -> f64 {
    let (two, four) = ([b[0], b[1]], [b[0], b[1], b[2], b[3]]);
    match kind {
        "Int8" => f64::from(b[0] as i8),
        "UInt8" => f64::from(b[0]),
        "Int16" => f64::from(i16::from_le_bytes(two)),
        "UInt16" => f64::from(u16::from_le_bytes(two)),
        "Int32" => f64::from(i32::from_le_bytes(four)),
        "UInt32" => f64::from(u32::from_le_bytes(four)),
        "Float32" => f64::from(f32::from_le_bytes(four)),
        "Int64" => i64::from_le_bytes(b) as f64,
        "UInt64" => u64::from_le_bytes(b) as f64,
        _ => f64::from_le_bytes(b),
    }
}

/// Bytes that stand as they are, or in base64: groups of four characters, padded wherever a
/// part ends.
pub(super) struct Stream<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) is_base64: bool,
    /// Decoded, not yet taken.
    pub(super) buffer: Vec<u8>,
}

impl Stream<'_> {
    pub(super) fn take(&mut self, count: usize) -> Result<Vec<u8>, String> {
        let room = self.bytes.len().saturating_add(self.buffer.len());
        if count > room {
            return Err(format!(
                "{count} bytes are announced, but there is room for {room}"
            ));
        }
        if !self.is_base64 {
            let (taken, rest) = self.bytes.split_at(count);
            self.bytes = rest;
            return Ok(taken.to_vec());
        }
        while self.buffer.len() < count {
            self.group()?;
        }
        let rest = self.buffer.split_off(count);
        Ok(std::mem::replace(&mut self.buffer, rest))
    }

    /// The next four characters.
    fn group(&mut self) -> Result<(), String> {
        let mut bits = 0_u32;
        let (mut digits, mut characters) = (0, 0);
        while characters < 4 {
            let (&byte, rest) = self.bytes.split_first().ok_or("the data end early")?;
            self.bytes = rest;
            let digit = match byte {
                b'A'..=b'Z' => byte - b'A',
                b'a'..=b'z' => byte - b'a' + 26,
                b'0'..=b'9' => byte - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                b'=' if characters >= 2 => {
                    characters += 1;
                    bits <<= 6;
                    continue;
                }
                byte if byte.is_ascii_whitespace() => continue,
                _ => return Err(format!("byte {byte} is not base64")),
            };
            if digits < characters {
                return Err("base64 goes on behind its end".to_owned());
            }
            bits = bits << 6 | u32::from(digit);
            digits += 1;
            characters += 1;
        }
        let bytes = bits.to_be_bytes();
        self.buffer.extend_from_slice(&bytes[1..digits]);
        Ok(())
    }
}
