//! Matrices of Nastran `.op4` files: ASCII or binary in either byte order,
//! dense or sparse, real or complex, of single or double precision.
//!
//! A heading has columns, rows (negative: sparse strings of two words, "big"),
//! form, type (1 real single, 2 real double, 3 and 4 the same complex), a name
//! and in ASCII the number format. A column has its number, the row it begins
//! at or 0 for sparse strings, and its count of words; a sparse string begins
//! with `L + 1` and its row, in two words or as `65536 (L + 1) + row` in one,
//! where L counts words. A column behind the last ends the matrix.
//!
//! Only what a file holds is stored, whatever its heading announces.

use super::op4_ascii;
use super::op4_binary;
use crate::error::ReadError;
use crate::text;
use std::path::Path;

/// Values from one row of a column downwards.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) column: u32,
    pub(super) row: u32,
    /// Places of its numbers in the list of all.
    pub(super) numbers: std::ops::Range<usize>,
}

/// A matrix as stored: everything not stored is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Op4Matrix {
    /// Name in the file.
    pub name: String,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Whether the numbers are complex.
    pub is_complex: bool,
    pub(super) runs: Vec<Run>,
    pub(super) numbers: Vec<f64>,
}

impl Op4Matrix {
    /// Stored entries: row, column (from 0), real and imaginary part.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, [f64; 2])> + '_ {
        let width = if self.is_complex { 2 } else { 1 };
        self.runs.iter().flat_map(move |run| {
            let numbers = &self.numbers[run.numbers.clone()];
            numbers
                .chunks_exact(width)
                .enumerate()
                .map(move |(k, number)| {
                    let imaginary = number.get(1).copied().unwrap_or(0.0);
                    let (row, column) = (run.row as usize + k, run.column as usize);
                    (row, column, [number[0], imaginary])
                })
        })
    }

    /// Count of numbers stored.
    pub(crate) fn stored(&self) -> usize {
        self.numbers.len()
    }

    /// Real columns in full; `None` for a complex matrix.
    pub(crate) fn real_columns(&self) -> Option<impl Iterator<Item = Vec<f64>> + '_> {
        (!self.is_complex).then(|| {
            let mut next = 0;
            (0..self.columns as u32).map(move |column| {
                let mut values = vec![0.0; self.rows];
                while let Some(run) = self.runs.get(next).filter(|run| run.column == column) {
                    let numbers = &self.numbers[run.numbers.clone()];
                    let first = run.row as usize;
                    values[first..first + numbers.len()].copy_from_slice(numbers);
                    next += 1;
                }
                values
            })
        })
    }
}

/// What the heading of a matrix says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    pub(super) columns: u32,
    pub(super) rows: u32,
    /// Sparse strings begin with two words.
    pub(super) is_big: bool,
    pub(super) is_complex: bool,
    pub(super) is_double: bool,
}

impl Heading {
    pub(super) fn new(numbers: [i64; 4]) -> Result<Self, String> {
        let [columns, rows, form, kind] = numbers;
        let size = |number: i64| u32::try_from(number).ok().filter(|n| *n < 1 << 31);
        let Some((columns, rows_)) = size(columns).zip(size(rows.checked_abs().unwrap_or(-1)))
        else {
            return Err(format!("{columns} columns of {rows} rows"));
        };
        if !(1..=4).contains(&kind) {
            return Err(format!(
                "a matrix of form {form} and type {kind}, which is not known"
            ));
        }
        Ok(Self {
            columns,
            rows: rows_,
            is_big: rows < 0,
            is_complex: kind > 2,
            is_double: kind % 2 == 0,
        })
    }

    /// Words of a value in a sparse string.
    pub(super) fn words(self) -> usize {
        (if self.is_complex { 2 } else { 1 }) * (if self.is_double { 2 } else { 1 })
    }

    /// Numbers of a value.
    pub(super) fn parts(self) -> usize {
        if self.is_complex { 2 } else { 1 }
    }

    pub(super) fn matrix(self, name: String) -> Op4Matrix {
        Op4Matrix {
            name,
            rows: self.rows as usize,
            columns: self.columns as usize,
            is_complex: self.is_complex,
            runs: Vec::new(),
            numbers: Vec::new(),
        }
    }

    /// Row (from 0) and count of values of a sparse string's beginning.
    pub(super) fn string(self, words_and_row: [i64; 2]) -> Result<(u32, usize), String> {
        let [words, row] = words_and_row;
        let wrong = || format!("a string of {words} words at row {row}");
        let words = usize::try_from(words - 1).map_err(|_| wrong())?;
        let row = u32::try_from(row - 1).map_err(|_| wrong())?;
        if !words.is_multiple_of(self.words()) {
            return Err(wrong());
        }
        Ok((row, words / self.words()))
    }
}

/// Both numbers at the beginning of a sparse string that is not "big".
pub(super) fn packed(word: i64) -> [i64; 2] {
    [word >> 16, word & 0xffff]
}

impl Op4Matrix {
    /// Begins a run of values; says what is wrong with its place.
    pub(super) fn begin(&mut self, column: u32, row: u32, values: usize) -> Result<(), String> {
        let last = (row as usize).checked_add(values);
        if column as usize >= self.columns || last.is_none_or(|last| last > self.rows) {
            return Err(format!(
                "{values} values from row {} of column {}, where the matrix is {} × {}",
                u64::from(row) + 1,
                u64::from(column) + 1,
                self.rows,
                self.columns
            ));
        }
        if self.runs.last().is_some_and(|run| run.column > column) {
            return Err(format!("column {} comes late", u64::from(column) + 1));
        }
        let at = self.numbers.len();
        self.runs.push(Run {
            column,
            row,
            numbers: at..at,
        });
        Ok(())
    }

    pub(super) fn push(&mut self, number: f64) {
        self.numbers.push(number);
        if let Some(run) = self.runs.last_mut() {
            run.numbers.end = self.numbers.len();
        }
    }
}

/// Reads all matrices of a file.
///
/// # Errors
/// [`ReadError`] for files that are cut short, damaged or of another kind.
pub fn read_op4(path: &Path) -> Result<Vec<Op4Matrix>, ReadError> {
    let start = text::start(path)?;
    let is_text = start
        .iter()
        .take(32)
        .all(|byte| byte.is_ascii_digit() || b" -\r\n\xef\xbb\xbf".contains(byte));
    if is_text {
        op4_ascii::read(path)
    } else {
        op4_binary::read(path)
    }
}
