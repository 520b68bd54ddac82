//! Binary files of Fortran programs: records between two equal lengths, in
//! either byte order, and words of four or eight bytes.
//!
//! A record is read as it comes, so that a length the file does not hold takes
//! no memory.

use crate::error::ReadError;
use crate::text;
use std::io::{self, BufRead, Read};
use std::path::Path;

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Little,
    Big,
}

impl Order {
    pub(crate) fn i32(self, bytes: [u8; 4]) -> i32 {
        match self {
            Self::Little => i32::from_le_bytes(bytes),
            Self::Big => i32::from_be_bytes(bytes),
        }
    }

    pub(crate) fn i64(self, bytes: [u8; 8]) -> i64 {
        match self {
            Self::Little => i64::from_le_bytes(bytes),
            Self::Big => i64::from_be_bytes(bytes),
        }
    }

    pub(crate) fn f32(self, bytes: [u8; 4]) -> f64 {
        f64::from(f32::from_bits(self.i32(bytes) as u32))
    }

    pub(crate) fn f64(self, bytes: [u8; 8]) -> f64 {
        f64::from_bits(self.i64(bytes) as u64)
    }

    /// The order in which the first four bytes are one of these numbers.
    pub(crate) fn of(start: &[u8], numbers: &[i32]) -> Option<Self> {
        let bytes = *start.first_chunk::<4>()?;
        [Self::Little, Self::Big]
            .into_iter()
            .find(|order| numbers.contains(&order.i32(bytes)))
    }
}

/// A run of words.
#[derive(Clone, Debug)]
pub(crate) struct Words {
    bytes: Vec<u8>,
    order: Order,
    /// Bytes of a word, 4 or 8.
    width: usize,
}

impl Words {
    pub(crate) fn new(bytes: Vec<u8>, order: Order, width: usize) -> Self {
        Self {
            bytes,
            order,
            width,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.bytes.len() / self.width
    }

    /// An integer; `None` behind the end.
    pub(crate) fn int(&self, word: usize) -> Option<i64> {
        if self.width == 8 {
            return self.chunk(word * 8).map(|bytes| self.order.i64(bytes));
        }
        let bytes = self.chunk(word * 4)?;
        Some(i64::from(self.order.i32(bytes)))
    }

    /// A real of one word.
    pub(crate) fn real(&self, word: usize) -> Option<f64> {
        if self.width == 8 {
            return self.double(word);
        }
        self.chunk(word * 4).map(|bytes| self.order.f32(bytes))
    }

    /// A real of eight bytes that begins with a word.
    pub(crate) fn double(&self, word: usize) -> Option<f64> {
        self.chunk(word * self.width)
            .map(|bytes| self.order.f64(bytes))
    }

    /// Letters of some words, four a word whatever its width, without blanks.
    pub(crate) fn letters(&self, words: std::ops::Range<usize>) -> String {
        words
            .filter_map(|word| self.bytes.get(word * self.width..(word + 1) * self.width))
            .flatten()
            .filter(|byte| byte.is_ascii_graphic())
            .map(|byte| char::from(*byte))
            .collect()
    }

    pub(crate) fn append(&mut self, other: &Self) {
        self.bytes.extend_from_slice(&other.bytes);
    }

    fn chunk<const N: usize>(&self, at: usize) -> Option<[u8; N]> {
        self.bytes.get(at..)?.first_chunk().copied()
    }
}

/// A binary file as it is read.
pub(crate) struct Records {
    file: String,
    reader: Box<dyn BufRead>,
    pub(crate) order: Order,
    at: u64,
}

impl Records {
    /// Opens a file whose first record has one of these lengths.
    pub(crate) fn open(path: &Path, lengths: &[i32]) -> Result<Self, ReadError> {
        let mut reader = text::open(path)?;
        let file = path.display().to_string();
        let start = reader.fill_buf().map_err(|source| ReadError::Io {
            file: file.clone(),
            source,
        })?;
        let Some(order) = Order::of(start, lengths) else {
            return Err(ReadError::Damaged {
                file,
                byte: 0,
                message: format!("the first record has none of the lengths {lengths:?}"),
            });
        };
        Ok(Self {
            file,
            reader,
            order,
            at: 0,
        })
    }

    /// The next record; `None` at the end of the file.
    pub(crate) fn next_record(&mut self) -> Result<Option<Vec<u8>>, ReadError> {
        let rest = self.reader.fill_buf().map(<[u8]>::is_empty);
        if rest.map_err(|source| self.failed(source))? {
            return Ok(None);
        }
        let length = self.length()?;
        let bytes = self.bytes(length)?;
        let closing = self.length()?;
        if closing != length {
            return Err(self.damaged(format!(
                "a record begins with the length {length} and ends with {closing}"
            )));
        }
        Ok(Some(bytes))
    }

    /// A record that must be there.
    pub(crate) fn record(&mut self, what: &str) -> Result<Vec<u8>, ReadError> {
        match self.next_record()? {
            Some(bytes) => Ok(bytes),
            None => Err(self.damaged(format!("it is cut short: {what} is missing"))),
        }
    }

    fn length(&mut self) -> Result<u64, ReadError> {
        let bytes = self.bytes(4)?;
        let length = bytes
            .first_chunk()
            .map_or(-1, |bytes| self.order.i32(*bytes));
        u64::try_from(length)
            .map_err(|_| self.damaged(format!("a record has the length {length}")))
    }

    fn bytes(&mut self, count: u64) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        let read = (&mut self.reader).take(count).read_to_end(&mut bytes);
        read.map_err(|source| self.failed(source))?;
        self.at += bytes.len() as u64;
        if (bytes.len() as u64) < count {
            return Err(
                self.damaged(format!("it is cut short within a record of {count} bytes"))
            );
        }
        Ok(bytes)
    }

    pub(crate) fn damaged(&self, message: impl Into<String>) -> ReadError {
        ReadError::Damaged {
            file: self.file.clone(),
            byte: self.at,
            message: message.into(),
        }
    }

    pub(crate) fn unsupported(&self, what: impl Into<String>) -> ReadError {
        ReadError::Unsupported {
            file: self.file.clone(),
            what: what.into(),
        }
    }

    fn failed(&self, source: io::Error) -> ReadError {
        match source.kind() {
            io::ErrorKind::UnexpectedEof => self.damaged("the gzip stream is cut short"),
            _ => ReadError::Io {
                file: self.file.clone(),
                source,
            },
        }
    }
}
