//! Binary `.op4` files; see [`super::op4`].

use super::op4::{Heading, Op4Matrix, packed};
use crate::binary::{Records, Words};
use crate::error::ReadError;
use std::path::Path;

/// Bytes of a heading, with words of four and of eight bytes.
const HEADING: i32 = 24;
const WIDE_HEADING: i32 = 48;

/// Bytes of a word.
const WORD: usize = 4;

pub(super) fn read(path: &Path) -> Result<Vec<Op4Matrix>, ReadError> {
    let mut records = Records::open(path, &[HEADING, WIDE_HEADING])?;
    let mut matrices = Vec::new();
    while let Some(head) = records.next_record()? {
        if head.len() == WIDE_HEADING as usize {
            return Err(records.unsupported(
                "the matrices have words of eight bytes; write them as text, or with words of \
                 four bytes (OUTPUT4 with BIGMAT)",
            ));
        }
        let head = Words::new(head, records.order, WORD);
        matrices.push(matrix(&mut records, &head)?);
    }
    Ok(matrices)
}

fn matrix(records: &mut Records, head: &Words) -> Result<Op4Matrix, ReadError> {
    let number = |word: usize| head.int(word).unwrap_or(-1);
    let heading = Heading::new([number(0), number(1), number(2), number(3)])
        .map_err(|message| records.damaged(message))?;
    let mut matrix = heading.matrix(head.letters(4..6));
    loop {
        let bytes = records.record("the end of a matrix")?;
        let words = Words::new(bytes, records.order, WORD);
        let column = words
            .int(0)
            .and_then(|column| u32::try_from(column - 1).ok());
        let (Some(column), Some(row)) = (column, words.int(1)) else {
            return Err(records.damaged("a column without its number"));
        };
        if column >= heading.columns {
            return Ok(matrix);
        }
        let taken = if row > 0 {
            dense(&words, heading, column, row, &mut matrix)
        } else {
            strings(&words, heading, column, &mut matrix)
        };
        taken
            .map_err(|message| records.damaged(format!("matrix {}: {message}", matrix.name)))?;
    }
}

fn dense(
    words: &Words,
    heading: Heading,
    column: u32,
    row: i64,
    matrix: &mut Op4Matrix,
) -> Result<(), String> {
    let row = u32::try_from(row - 1).map_err(|_| format!("row {row}"))?;
    let stated = words.int(2).unwrap_or(-1);
    let there = words.len() - 3.min(words.len());
    if stated != there as i64 || !there.is_multiple_of(heading.words()) {
        return Err(format!(
            "column {} of {stated} words has {there}",
            column + 1
        ));
    }
    let count = there / heading.words();
    matrix.begin(column, row, count)?;
    values(words, heading, 3, count, matrix)
}

fn strings(
    words: &Words,
    heading: Heading,
    column: u32,
    matrix: &mut Op4Matrix,
) -> Result<(), String> {
    let mut at = 3;
    while at < words.len() {
        let word = |k: usize| words.int(k).unwrap_or(0);
        let head = if heading.is_big {
            [word(at), word(at + 1)]
        } else {
            packed(word(at))
        };
        at += if heading.is_big { 2 } else { 1 };
        let (row, count) = heading.string(head)?;
        matrix.begin(column, row, count)?;
        values(words, heading, at, count, matrix)?;
        at += count * heading.words();
    }
    Ok(())
}

fn values(
    words: &Words,
    heading: Heading,
    from: usize,
    count: usize,
    matrix: &mut Op4Matrix,
) -> Result<(), String> {
    let width = if heading.is_double { 2 } else { 1 };
    for k in 0..count * heading.parts() {
        let at = from + k * width;
        let number = if heading.is_double {
            words.double(at)
        } else {
            words.real(at)
        };
        let number = number.filter(|number| number.is_finite());
        matrix.push(number.ok_or("a value that is missing or no finite number")?);
    }
    Ok(())
}
