//! Forces as Nastran OUTPUT4, ASCII with 16 digits.
//!
//! `GK` (points × 2) holds g and k, `Q1` … one complex matrix a point (type 4, double
//! precision). Columns are written in full: column number, first row, how many numbers, then
//! three of them a line (MSC Nastran, *DMAP Programmer's Guide*, OUTPUT4).

use crate::gaf_json::Document;
use std::fmt::Write;

/// Smallest number with two digits in its exponent.
const SMALLEST: f64 = 1e-99;

/// Real and complex double precision.
const REAL: usize = 2;
const COMPLEX: usize = 4;
/// Rectangular.
const FORM: usize = 2;

/// The whole file.
pub(crate) fn op4(document: &Document) -> String {
    let mut text = String::new();
    let points = &document.points;
    let places: Vec<Vec<f64>> = vec![
        points.iter().map(|point| point.g).collect(),
        points.iter().map(|point| point.k).collect(),
    ];
    matrix(&mut text, "GK", REAL, points.len(), &places);
    for (number, point) in points.iter().enumerate() {
        let modes = point.q.len();
        let column = |j: usize| point.q.iter().flat_map(|row| row[j]).collect();
        let columns: Vec<Vec<f64>> = (0..modes).map(column).collect();
        matrix(
            &mut text,
            &format!("Q{}", number + 1),
            COMPLEX,
            modes,
            &columns,
        );
    }
    text
}

/// One matrix by its columns, real and imaginary parts one after the other.
fn matrix(text: &mut String, name: &str, kind: usize, rows: usize, columns: &[Vec<f64>]) {
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:8}{rows:8}{FORM:8}{kind:8}{name:<8}1P,3E23.16",
        columns.len()
    );
    for (number, column) in columns.iter().enumerate() {
        let _ = writeln!(text, "{:8}{:8}{:8}", number + 1, 1, column.len());
        numbers(text, column);
    }
    let _ = writeln!(text, "{:8}{:8}{:8}", columns.len() + 1, 1, 1);
    numbers(text, &[1.0]);
}

fn numbers(text: &mut String, values: &[f64]) {
    for line in values.chunks(3) {
        for value in line {
            let _ = write!(text, "{:>23}", exponential(*value));
        }
        text.push('\n');
    }
}

/// `1.2345678901234567E+01`, as Fortran writes it in 23 columns: there is room for two digits
/// of the exponent, and what needs three below zero is zero beside any other force.
fn exponential(value: f64) -> String {
    let value = if value.abs() < SMALLEST { 0.0 } else { value };
    let text = format!("{value:.16E}");
    let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, size) = match exponent.strip_prefix('-') {
        Some(size) => ('-', size),
        None => ('+', exponent),
    };
    format!("{digits}E{sign}{size:0>2}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_fortran() {
        assert_eq!(exponential(-12.5), "-1.2500000000000000E+01");
        assert_eq!(exponential(0.0), "0.0000000000000000E+00");
        assert_eq!(exponential(-1e-300), "0.0000000000000000E+00");
    }
}
