//! Words and numbers of a `.msh` file, of text or binary.

use crate::binary::Order;
use crate::error::ReadError;
use crate::text::{self, real};
use std::io::{self, BufRead, Read};
use std::path::Path;

/// Longest number or word.
const WORD: usize = 256;

/// A `.msh` file as it is read.
pub(crate) struct Scanner {
    file: String,
    reader: Box<dyn BufRead>,
    /// Order of binary numbers; `None` in text.
    binary: Option<Order>,
    /// Bytes read, and the line they are in.
    at: u64,
    line: usize,
}

impl Scanner {
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut scanner = Self {
            file: path.display().to_string(),
            reader: text::open(path)?,
            binary: None,
            at: 0,
            line: 1,
        };
        let start = scanner.reader.fill_buf();
        let mark = start.is_ok_and(|start| start.starts_with(b"\xef\xbb\xbf"));
        scanner.reader.consume(if mark { 3 } else { 0 });
        Ok(scanner)
    }

    pub(crate) fn is_binary(&self) -> bool {
        self.binary.is_some()
    }

    /// Name of the next section; `None` at the end of the file.
    pub(crate) fn section(&mut self) -> Result<Option<String>, ReadError> {
        let Some(line) = self.line()? else {
            return Ok(None);
        };
        match line.strip_prefix('$') {
            Some(name) => Ok(Some(name.to_owned())),
            None => Err(self.wrong("no section ($…) begins here")),
        }
    }

    /// Passes over the rest of a section.
    pub(crate) fn end_of(&mut self, name: &str) -> Result<(), ReadError> {
        let end = format!("$End{name}");
        loop {
            match self.line()? {
                Some(line) if line == end => return Ok(()),
                Some(_) => {}
                None => return Err(self.cut(&end)),
            }
        }
    }

    /// The next line that is not blank, without blanks around it.
    fn line(&mut self) -> Result<Option<String>, ReadError> {
        let mut bytes = Vec::new();
        loop {
            bytes.clear();
            let read = self.reader.read_until(b'\n', &mut bytes);
            let count = read.map_err(|source| self.failed(source))?;
            if count == 0 {
                return Ok(None);
            }
            self.at += count as u64;
            self.line += usize::from(bytes.ends_with(b"\n"));
            let line = bytes.trim_ascii();
            if !line.is_empty() {
                return Ok(Some(String::from_utf8_lossy(line).into_owned()));
            }
        }
    }

    fn byte(&mut self) -> Result<u8, ReadError> {
        let [byte] = self.bytes()?;
        self.line += usize::from(byte == b'\n');
        Ok(byte)
    }

    /// Text up to the next blank, which is taken too unless it ends a line.
    pub(crate) fn word(&mut self) -> Result<String, ReadError> {
        let mut word = Vec::new();
        while word.is_empty() {
            let byte = self.byte()?;
            if !byte.is_ascii_whitespace() {
                word.push(byte);
            }
        }
        while let Some(byte) = self.peek()?.filter(|byte| !byte.is_ascii_whitespace()) {
            if word.len() == WORD {
                return Err(self.wrong(format!("a word of more than {WORD} letters")));
            }
            word.push(byte);
            self.byte()?;
        }
        Ok(String::from_utf8_lossy(&word).into_owned())
    }

    fn peek(&mut self) -> Result<Option<u8>, ReadError> {
        let first = self.reader.fill_buf().map(|rest| rest.first().copied());
        first.map_err(|source| self.failed(source))
    }

    /// Text in double quotes.
    pub(crate) fn quoted(&mut self) -> Result<String, ReadError> {
        while self.peek()?.is_some_and(|byte| byte != b'"') {
            if !self.byte()?.is_ascii_whitespace() {
                return Err(self.wrong("a name in double quotes is missing"));
            }
        }
        self.byte()?;
        let mut name = Vec::new();
        loop {
            match self.byte()? {
                b'"' => return Ok(String::from_utf8_lossy(&name).into_owned()),
                b'\n' => return Err(self.wrong("a name in double quotes has no end")),
                byte => name.push(byte),
            }
        }
    }

    /// An integer of text, in binary files too.
    pub(crate) fn text_int(&mut self) -> Result<i64, ReadError> {
        let word = self.word()?;
        let number = word
            .parse()
            .map_err(|_| self.wrong(format!("{word:?} is no whole number")))?;
        // Binary numbers begin behind the line's end.
        if self.is_binary() {
            while matches!(self.peek()?, Some(b' ' | b'\r')) {
                self.byte()?;
            }
            if self.peek()? == Some(b'\n') {
                self.byte()?;
            }
        }
        Ok(number)
    }

    /// A real of text, in binary files too.
    pub(crate) fn text_real(&mut self) -> Result<f64, ReadError> {
        let word = self.word()?;
        real(&word).ok_or_else(|| self.wrong(format!("{word:?} is no finite number")))
    }

    /// An integer of four bytes.
    pub(crate) fn int(&mut self) -> Result<i32, ReadError> {
        if let Some(order) = self.binary {
            return Ok(order.i32(self.bytes()?));
        }
        let number = self.text_int()?;
        i32::try_from(number).map_err(|_| self.wrong(format!("{number} is too large")))
    }

    /// A number of a node or element of four bytes.
    pub(crate) fn id(&mut self) -> Result<u64, ReadError> {
        let number = self.int()?;
        u64::try_from(number).map_err(|_| self.wrong(format!("{number} numbers nothing")))
    }

    /// A count or number of eight bytes.
    pub(crate) fn size(&mut self) -> Result<u64, ReadError> {
        let number = match self.binary {
            Some(order) => order.i64(self.bytes()?),
            None => self.text_int()?,
        };
        u64::try_from(number).map_err(|_| self.wrong(format!("{number} counts nothing")))
    }

    /// A finite real of eight bytes.
    pub(crate) fn double(&mut self) -> Result<f64, ReadError> {
        let Some(order) = self.binary else {
            return self.text_real();
        };
        let value = order.f64(self.bytes()?);
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.wrong("a number that is not finite"))
        }
    }

    /// Takes the 1 that tells the order of bytes.
    pub(crate) fn begin_binary(&mut self) -> Result<(), ReadError> {
        while self.byte()? != b'\n' {}
        let one: [u8; 4] = self.bytes()?;
        self.binary = Order::of(&one, &[1]);
        if self.binary.is_none() {
            return Err(self.wrong("the number that tells the order of bytes is not 1"));
        }
        Ok(())
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let mut bytes = [0; N];
        let read = self.reader.read_exact(&mut bytes);
        read.map_err(|source| self.failed(source))?;
        self.at += N as u64;
        Ok(bytes)
    }

    pub(crate) fn wrong(&self, message: impl Into<String>) -> ReadError {
        let (file, message) = (self.file.clone(), message.into());
        if self.is_binary() {
            ReadError::Damaged {
                file,
                byte: self.at,
                message,
            }
        } else {
            ReadError::Syntax {
                file,
                line: self.line,
                message,
            }
        }
    }

    pub(crate) fn unsupported(&self, what: impl Into<String>) -> ReadError {
        ReadError::Unsupported {
            file: self.file.clone(),
            what: what.into(),
        }
    }

    fn cut(&self, missing: &str) -> ReadError {
        ReadError::Truncated {
            file: self.file.clone(),
            line: self.line,
            missing: missing.to_owned(),
        }
    }

    fn failed(&self, source: io::Error) -> ReadError {
        match source.kind() {
            io::ErrorKind::UnexpectedEof => self.cut("the rest of a section"),
            _ => ReadError::Io {
                file: self.file.clone(),
                source,
            },
        }
    }
}
