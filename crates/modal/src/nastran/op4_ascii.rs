//! `.op4` files of text; see [`super::op4`].

use super::op4::{Heading, Op4Matrix, packed};
use crate::error::ReadError;
use crate::text::{Lines, field, real};
use std::path::Path;

/// Columns of an integer.
const INTEGER: usize = 8;

/// Numbers a line and columns a number, from a format such as `1P,3E23.16`.
#[derive(Clone, Copy)]
struct Layout {
    per_line: usize,
    width: usize,
}

impl Layout {
    fn parse(text: &str) -> Option<Self> {
        let text = text.rsplit(',').next()?.trim();
        let (count, rest) = text.split_once(['E', 'D', 'e', 'd'])?;
        let width = rest.split('.').next()?;
        let layout = Self {
            per_line: count.trim().parse().ok()?,
            width: width.trim().parse().ok()?,
        };
        let is_sensible =
            (1..=100).contains(&layout.per_line) && (4..=64).contains(&layout.width);
        is_sensible.then_some(layout)
    }
}

pub(super) fn read(path: &Path) -> Result<Vec<Op4Matrix>, ReadError> {
    let mut lines = Lines::open(path)?;
    let mut matrices = Vec::new();
    while let Some(line) = lines.next_line()? {
        if line.trim().is_empty() {
            continue;
        }
        let line = line.to_owned();
        matrices.push(matrix(&mut lines, &line)?);
    }
    Ok(matrices)
}

fn matrix(lines: &mut Lines, head: &str) -> Result<Op4Matrix, ReadError> {
    let numbers = integers::<4>(lines, head)?;
    let heading = Heading::new(numbers).map_err(|message| lines.syntax(message))?;
    let layout = Layout::parse(field(head, 40, head.len()))
        .ok_or_else(|| lines.syntax("the heading of a matrix has no number format"))?;
    let mut matrix = heading.matrix(field(head, 32, 40).to_owned());
    loop {
        let line = next(lines, &matrix)?;
        let [column, row, words] = integers::<3>(lines, &line)?;
        let column =
            u32::try_from(column - 1).map_err(|_| lines.syntax(format!("column {column}")))?;
        let mut words = usize::try_from(words)
            .map_err(|_| lines.syntax(format!("a column of {words} words")))?;
        if column >= heading.columns {
            // The column behind the last: one number, which means nothing.
            let mut end = heading.matrix(String::new());
            values(lines, layout, words, &mut end)?;
            return Ok(matrix);
        }
        if row > 0 {
            let row = u32::try_from(row - 1).map_err(|_| lines.syntax(format!("row {row}")))?;
            begin(lines, &mut matrix, column, row, words / heading.parts())?;
            values(lines, layout, words, &mut matrix)?;
            continue;
        }
        while words > 0 {
            let line = next(lines, &matrix)?;
            let head = if heading.is_big {
                integers::<2>(lines, &line)?
            } else {
                packed(integer(lines, line.trim())?)
            };
            let string = heading.string(head);
            let (row, count) = string.map_err(|message| lines.syntax(message))?;
            begin(lines, &mut matrix, column, row, count)?;
            values(lines, layout, count * heading.parts(), &mut matrix)?;
            let taken = count * heading.words() + if heading.is_big { 2 } else { 1 };
            words = words.checked_sub(taken).ok_or_else(|| {
                lines.syntax(format!("the strings of column {} are too long", column + 1))
            })?;
        }
    }
}

fn next(lines: &mut Lines, matrix: &Op4Matrix) -> Result<String, ReadError> {
    match lines.next_line()? {
        Some(line) => Ok(line.to_owned()),
        None => Err(lines.truncated(format!("the end of matrix {}", matrix.name))),
    }
}

fn begin(
    lines: &Lines,
    matrix: &mut Op4Matrix,
    column: u32,
    row: u32,
    values: usize,
) -> Result<(), ReadError> {
    let begun = matrix.begin(column, row, values);
    begun.map_err(|message| lines.syntax(message))
}

fn values(
    lines: &mut Lines,
    layout: Layout,
    count: usize,
    matrix: &mut Op4Matrix,
) -> Result<(), ReadError> {
    let mut left = count;
    while left > 0 {
        let line = next(lines, matrix)?;
        let here = left.min(layout.per_line);
        for k in 0..here {
            let text = field(&line, k * layout.width, (k + 1) * layout.width);
            let number = real(text)
                .ok_or_else(|| lines.syntax(format!("{text:?} is no finite number")))?;
            matrix.push(number);
        }
        left -= here;
    }
    Ok(())
}

fn integers<const N: usize>(lines: &Lines, line: &str) -> Result<[i64; N], ReadError> {
    let mut numbers = [0; N];
    for (k, number) in numbers.iter_mut().enumerate() {
        *number = integer(lines, field(line, k * INTEGER, (k + 1) * INTEGER))?;
    }
    Ok(numbers)
}

fn integer(lines: &Lines, text: &str) -> Result<i64, ReadError> {
    text.parse()
        .map_err(|_| lines.syntax(format!("{text:?} is no whole number of eight columns")))
}
