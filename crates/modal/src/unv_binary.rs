//! Binary datasets of universal files, which are passed over: measured
//! responses (58b) stand in one file with the modes found from them.
//!
//! Behind the number stand byte order, kind of floating point, and in columns of
//! twelve the number of lines of text and of bytes that follow them:
//! `    58b     2     2          11        8192`.

use crate::error::ReadError;
use crate::unv::Reader;

/// Bytes taken at once.
const CHUNK: usize = 1 << 16;

/// Whether this is the number of a binary dataset.
pub(crate) fn is_binary(number: &str) -> bool {
    let word = number.split_ascii_whitespace().next().unwrap_or("");
    word.strip_suffix('b')
        .is_some_and(|digits| digits.parse::<u32>().is_ok())
}

/// Reads over its lines and bytes to its end.
pub(crate) fn skip(reader: &mut Reader, number: &str) -> Result<(), ReadError> {
    let mut counts = number
        .split_ascii_whitespace()
        .skip(3)
        .map(str::parse::<usize>);
    let (Some(Ok(lines)), Some(Ok(mut bytes))) = (counts.next(), counts.next()) else {
        return Err(reader
            .lines
            .syntax("a binary dataset without its numbers of lines and of bytes"));
    };
    for _ in 0..lines {
        reader.line("the head of a binary dataset")?;
    }
    while bytes > 0 {
        let count = bytes.min(CHUNK);
        reader.lines.bytes(count, "the bytes of a binary dataset")?;
        bytes -= count;
    }
    reader.skip()
}
