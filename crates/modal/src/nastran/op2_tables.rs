//! The tables of a Nastran `.op2` file.
//!
//! Every second record is a key of one word: a positive one is the length of
//! the record behind it, a negative one begins the next block of a table, 0
//! ends the table, a second 0 the file. A table is its name, a block −1 of
//! seven words, a block −2 with the name again, and its data from block −3 on;
//! a block's first record is its type (0 a table, 1 a matrix) and the others
//! make one run of words. A file may begin with its date and a label. Words
//! have four or eight bytes, in either byte order; letters are four a word.

use crate::binary::{Records, Words};
use crate::error::ReadError;
use std::path::Path;

/// A block of a table.
pub(crate) struct Block {
    /// 3 and so on: data.
    pub(crate) number: i64,
    pub(crate) words: Words,
}

/// Tables as they come.
pub(crate) struct Tables {
    records: Records,
    width: usize,
    /// The key read last.
    key: i64,
    is_open: bool,
}

impl Tables {
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut records = Records::open(path, &[4, 8])?;
        let first = records.record("the first key")?;
        let mut tables = Self {
            width: first.len(),
            records,
            key: 0,
            is_open: false,
        };
        tables.key = tables.key_of(first)?;
        if tables.key == 3 {
            tables.label()?;
        }
        Ok(tables)
    }

    /// Date, seven words, label.
    fn label(&mut self) -> Result<(), ReadError> {
        while self.key > 0 {
            self.records.record("the date of the file")?;
            self.key = self.next_key()?;
        }
        if self.key != -1 || self.next_key()? != 0 {
            return Err(self.records.damaged("the label does not end with -1 and 0"));
        }
        self.key = self.next_key()?;
        Ok(())
    }

    /// Name of the next table; `None` at the end of the file.
    pub(crate) fn next_table(&mut self) -> Result<Option<String>, ReadError> {
        while self.is_open {
            self.block(false)?;
        }
        if self.key == 0 {
            return Ok(None);
        }
        let name = self.take("the name of a table")?.letters(0..2);
        if name.is_empty() {
            return Err(self.records.damaged("a table has no name"));
        }
        self.key = self.next_key()?;
        self.is_open = true;
        Ok(Some(name))
    }

    /// The next block of data of this table; `None` at its end.
    pub(crate) fn next_block(&mut self) -> Result<Option<Block>, ReadError> {
        while self.is_open {
            if let Some(block) = self.block(true)?.filter(|block| block.number > 2) {
                return Ok(Some(block));
            }
        }
        Ok(None)
    }

    fn block(&mut self, keep: bool) -> Result<Option<Block>, ReadError> {
        if self.key >= 0 {
            return Err(self
                .records
                .damaged(format!("a block begins with the key {}", self.key)));
        }
        let number = -self.key;
        let mut words: Option<Words> = None;
        self.key = self.next_key()?;
        let mut is_type = number > 1;
        while self.key > 0 {
            let part = self.take("the data of a table")?;
            if !std::mem::take(&mut is_type) && keep {
                match &mut words {
                    Some(words) => words.append(&part),
                    None => words = Some(part),
                }
            }
            self.key = self.next_key()?;
        }
        if self.key == 0 {
            self.is_open = false;
            self.key = self.next_key()?;
        }
        Ok(words.map(|words| Block { number, words }))
    }

    /// The record that the key has announced.
    fn take(&mut self, what: &str) -> Result<Words, ReadError> {
        let bytes = self.records.record(what)?;
        let stated = usize::try_from(self.key).unwrap_or(0);
        if stated.checked_mul(self.width) != Some(bytes.len()) {
            return Err(self.records.damaged(format!(
                "a key announces {stated} words of {} bytes, and {} bytes come",
                self.width,
                bytes.len()
            )));
        }
        Ok(Words::new(bytes, self.records.order, self.width))
    }

    fn next_key(&mut self) -> Result<i64, ReadError> {
        let bytes = self.records.record("the key 0, which ends the file,")?;
        self.key_of(bytes)
    }

    fn key_of(&self, bytes: Vec<u8>) -> Result<i64, ReadError> {
        let length = bytes.len();
        if length != self.width || ![4, 8].contains(&length) {
            return Err(self
                .records
                .damaged(format!("{length} bytes where a key of one word is due")));
        }
        let words = Words::new(bytes, self.records.order, self.width);
        Ok(words.int(0).unwrap_or(0))
    }

    /// Words of eight bytes.
    pub(crate) fn is_wide(&self) -> bool {
        self.width == 8
    }

    pub(crate) fn damaged(&self, message: impl Into<String>) -> ReadError {
        self.records.damaged(message)
    }

    pub(crate) fn unsupported(&self, what: impl Into<String>) -> ReadError {
        self.records.unsupported(what)
    }
}
