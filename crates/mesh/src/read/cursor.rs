//! A place in the bytes of a file, from which values are taken.

use super::Place;
use super::draft::SHOWN;
use crate::Vec3;

/// What a parser found wrong; the path is added outside.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Malformed {
    pub(super) place: Place,
    pub(super) what: String,
    pub(super) remedy: String,
}

impl Malformed {
    /// A fault of the file as a whole.
    pub(super) fn whole(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            place: Place::File,
            what: what.into(),
            remedy: remedy.into(),
        }
    }
}

/// What to do about a file whose content stops or makes no sense.
pub(super) const WRITE_AGAIN: &str = "the file is damaged or cut short: write it again";

/// Reads values in text or little-endian binary, whichever the file is in.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether numbers are binary from here on.
    pub(super) is_binary: bool,
    /// The first few places of positions that are not finite.
    not_finite: Vec<Place>,
    n_not_finite: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        };
        Self {
            bytes,
            at,
            is_binary: false,
            not_finite: Vec::new(),
            n_not_finite: 0,
        }
    }

    /// A fault at the present place.
    pub(super) fn fault(
        &self,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Malformed {
        Malformed {
            place: self.place(),
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    fn place(&self) -> Place {
        if self.is_binary {
            return Place::Byte(self.at);
        }
        Place::Line(self.bytes[..self.at].split(|&byte| byte == b'\n').count())
    }

    /// Bytes not yet taken.
    pub(super) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub(super) fn skip_space(&mut self) {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    /// The rest of this line without its end; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return None;
        }
        let length = rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
        self.at = (self.at + length + 1).min(self.bytes.len());
        Some(rest[..length].trim_ascii_end())
    }

    /// The next word of text.
    pub(super) fn word(&mut self) -> Result<&'a str, Malformed> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        if length == 0 {
            return Err(self.fault("the file ends where a value should be", WRITE_AGAIN));
        }
        let word = std::str::from_utf8(&rest[..length])
            .map_err(|_| self.fault("this is not text", WRITE_AGAIN))?;
        self.at += length;
        Ok(word)
    }

    /// Text between double quotes on this line.
    pub(super) fn quoted(&mut self) -> Result<String, Malformed> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let line = &rest[..rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len())];
        let end = line.iter().rposition(|&byte| byte == b'"').unwrap_or(0);
        if line.first() != Some(&b'"') || end == 0 {
            return Err(self.fault("a name in double quotes is missing", WRITE_AGAIN));
        }
        self.at += end + 1;
        Ok(String::from_utf8_lossy(&line[1..end]).into_owned())
    }

    pub(super) fn take<const N: usize>(&mut self) -> Result<[u8; N], Malformed> {
        match self.bytes[self.at..].first_chunk() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => Err(self.fault("the file ends inside a value", WRITE_AGAIN)),
        }
    }

    fn number<T: std::str::FromStr>(&mut self, kind: &str) -> Result<T, Malformed> {
        let word = self.word()?;
        word.parse().map_err(|_| {
            let shown: String = word.chars().take(40).collect();
            self.fault(format!("`{shown}` is not {kind}"), WRITE_AGAIN)
        })
    }

    /// A 4-byte integer.
    pub(super) fn int(&mut self) -> Result<i32, Malformed> {
        if self.is_binary {
            self.take().map(i32::from_le_bytes)
        } else {
            self.number("an integer")
        }
    }

    /// An 8-byte count or tag.
    pub(super) fn size(&mut self) -> Result<u64, Malformed> {
        if self.is_binary {
            self.take().map(u64::from_le_bytes)
        } else {
            self.number("a non-negative integer")
        }
    }

    /// An 8-byte floating-point number, in text any spelling Rust reads.
    pub(super) fn double(&mut self) -> Result<f64, Malformed> {
        if self.is_binary {
            self.take().map(f64::from_le_bytes)
        } else {
            self.number("a number")
        }
    }

    /// A position; where it is not finite, the place is kept for a note.
    pub(super) fn position(&mut self) -> Result<Vec3, Malformed> {
        let position = Vec3::new(self.double()?, self.double()?, self.double()?);
        if !position.iter().all(|x| x.is_finite()) {
            self.n_not_finite += 1;
            // Finding the line reads the file from its start.
            if self.not_finite.len() < SHOWN {
                self.not_finite.push(self.place());
            }
        }
        Ok(position)
    }

    /// Where positions were not finite, in words; empty when nowhere.
    pub(super) fn note_of_not_finite(&self) -> Option<String> {
        let places: Vec<String> = self.not_finite.iter().map(Place::to_string).collect();
        let more = self.n_not_finite - places.len();
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        (!places.is_empty()).then(|| {
            format!(
                "coordinates that are no finite numbers: {}{more}",
                places.join(", ")
            )
        })
    }

    /// Checks a count of records against what is left of the file, where each
    /// takes at least the given bytes in text or in binary.
    pub(super) fn count(
        &self,
        count: u64,
        text: usize,
        binary: usize,
    ) -> Result<usize, Malformed> {
        let room = self.remaining() / if self.is_binary { binary } else { text };
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= room)
            .ok_or_else(|| {
                self.fault(
                    format!("{count} records are announced, but the file has room for {room}"),
                    WRITE_AGAIN,
                )
            })
    }

    /// Moves past the next occurrence of `mark`; false when there is none.
    pub(super) fn skip_past(&mut self, mark: &str) -> bool {
        let mark = mark.as_bytes();
        let found = self.bytes[self.at..]
            .windows(mark.len())
            .position(|window| window == mark);
        if let Some(offset) = found {
            self.at += offset + mark.len();
        }
        found.is_some()
    }
}
