//! Lines of text files, gzipped or not, and the numbers Fortran programs write.

use crate::error::ReadError;
use flate2::read::MultiGzDecoder;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// No format read here has longer lines; a longer one is a binary file.
const LINE_LIMIT: u64 = 1 << 16;

/// Bytes by which a format is told: the printed file of Nastran begins with
/// pages of licence.
const START: u64 = 1 << 16;

/// The decompressed content of a file.
pub(crate) fn open(path: &Path) -> Result<Box<dyn BufRead>, ReadError> {
    let failed = |source| ReadError::Io {
        file: path.display().to_string(),
        source,
    };
    let mut reader = BufReader::with_capacity(1 << 16, File::open(path).map_err(failed)?);
    let zipped = reader
        .fill_buf()
        .map_err(failed)?
        .starts_with(&[0x1f, 0x8b]);
    Ok(if zipped {
        Box::new(BufReader::with_capacity(
            1 << 16,
            MultiGzDecoder::new(reader),
        ))
    } else {
        Box::new(reader)
    })
}

/// The first bytes of the decompressed content, enough to tell its format.
pub(crate) fn start(path: &Path) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let read = open(path)?.take(START).read_to_end(&mut bytes);
    match read {
        Err(source) if bytes.is_empty() && source.kind() != io::ErrorKind::UnexpectedEof => {
            Err(ReadError::Io {
                file: path.display().to_string(),
                source,
            })
        }
        _ => Ok(bytes),
    }
}

/// The lines of a text file, without line ends, counted from 1.
pub(crate) struct Lines {
    file: String,
    reader: Box<dyn BufRead>,
    bytes: Vec<u8>,
    text: String,
    number: usize,
    repeat: bool,
}

impl Lines {
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        Ok(Self {
            file: path.display().to_string(),
            reader: open(path)?,
            bytes: Vec::new(),
            text: String::new(),
            number: 0,
            repeat: false,
        })
    }

    pub(crate) fn name(&self) -> String {
        self.file.clone()
    }

    /// Number of the line read last.
    pub(crate) fn number(&self) -> usize {
        self.number
    }

    /// Gives the line read last once more.
    pub(crate) fn step_back(&mut self) {
        self.repeat = true;
    }

    /// The next line; `None` at the end of the file.
    pub(crate) fn next_line(&mut self) -> Result<Option<&str>, ReadError> {
        if std::mem::take(&mut self.repeat) {
            return Ok(Some(&self.text));
        }
        self.bytes.clear();
        let read = (&mut self.reader)
            .take(LINE_LIMIT)
            .read_until(b'\n', &mut self.bytes)
            .map_err(|source| self.io_error(source))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        if read as u64 == LINE_LIMIT {
            return Err(self.syntax(format!("a line of more than {LINE_LIMIT} bytes")));
        }
        let mut line = self.bytes.as_slice();
        if self.number == 1 {
            line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        }
        while let [head @ .., b'\n' | b'\r'] = line {
            line = head;
        }
        self.text.clear();
        self.text.push_str(&String::from_utf8_lossy(line));
        Ok(Some(&self.text))
    }

    /// So many bytes behind the line read last, in a file that is text in parts.
    pub(crate) fn bytes(&mut self, count: usize, missing: &str) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        let read = (&mut self.reader)
            .take(count as u64)
            .read_to_end(&mut bytes);
        match read.map_err(|source| self.io_error(source))? {
            read if read == count => Ok(bytes),
            _ => Err(self.truncated(missing)),
        }
    }

    pub(crate) fn at_end(&mut self) -> bool {
        self.reader.fill_buf().map_or(true, <[u8]>::is_empty)
    }

    pub(crate) fn syntax(&self, message: impl Into<String>) -> ReadError {
        ReadError::Syntax {
            file: self.name(),
            line: self.number,
            message: message.into(),
        }
    }

    pub(crate) fn truncated(&self, missing: impl Into<String>) -> ReadError {
        ReadError::Truncated {
            file: self.name(),
            line: self.number,
            missing: missing.into(),
        }
    }

    pub(crate) fn unsupported(&self, what: impl Into<String>) -> ReadError {
        ReadError::Unsupported {
            file: self.name(),
            what: what.into(),
        }
    }

    fn io_error(&self, source: io::Error) -> ReadError {
        match source.kind() {
            io::ErrorKind::UnexpectedEof => self.truncated("the end of the gzip stream"),
            _ => ReadError::Io {
                file: self.name(),
                source,
            },
        }
    }
}

/// Columns `from..to` (counted from 0) of a fixed-width line, without blanks;
/// empty where the line is shorter.
pub(crate) fn field(line: &str, from: usize, to: usize) -> &str {
    let to = to.min(line.len());
    line.get(from.min(to)..to).unwrap_or("").trim()
}

/// A finite real number as C or Fortran writes it: `1.5`, `1.5E-3`, `1.5D-03`,
/// `1.5-3`.
pub(crate) fn real(text: &str) -> Option<f64> {
    let text = text.trim();
    let value = match text.parse::<f64>() {
        Ok(value) => value,
        Err(_) => fortran_real(text)?,
    };
    value.is_finite().then_some(value)
}

fn fortran_real(text: &str) -> Option<f64> {
    let bytes = text.as_bytes();
    if let Some(letter) = bytes.iter().position(|byte| b"dDqQ".contains(byte)) {
        let (mantissa, exponent) = (text.get(..letter)?, text.get(letter + 1..)?);
        return format!("{mantissa}e{exponent}").parse().ok();
    }
    let sign = bytes.iter().rposition(|byte| b"+-".contains(byte))?;
    let (mantissa, exponent) = (text.get(..sign)?, text.get(sign..)?);
    let ends_in_digit = mantissa.ends_with(|last: char| last.is_ascii_digit() || last == '.');
    ends_in_digit.then(|| format!("{mantissa}e{exponent}").parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_in_every_fortran_spelling() {
        for text in [
            "1.5e-3", "1.5E-03", "1.5D-03", "1.5d-3", "1.5-3", "  .0015 ", "1.5-003",
        ] {
            assert_eq!(real(text), Some(1.5e-3), "{text}");
        }
        assert_eq!(real("-2.5+2"), Some(-250.0));
        for text in [
            "", "x", "NaN", "inf", "1e999", "-", "1.2.3", "+-3", "e5", "1,5",
        ] {
            assert_eq!(real(text), None, "{text}");
        }
    }

    #[test]
    fn fields_end_where_the_line_ends() {
        assert_eq!(field(" -1        17", 3, 13), "17");
        assert_eq!(field(" -1", 3, 13), "");
        assert_eq!(field("äöü", 1, 4), "");
    }
}
