//! Nastran `.op4` files.

use super::{lambda, rotation};
use fladder_modal::ModalResult;
use std::fmt::Write;

/// Form of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    TextDense,
    TextSparse,
    TextBig,
    BinaryDense,
    BinarySparse,
    BinaryBig,
}

impl Form {
    fn is_big(self) -> bool {
        matches!(self, Self::TextBig | Self::BinaryBig)
    }

    fn is_dense(self) -> bool {
        matches!(self, Self::TextDense | Self::BinaryDense)
    }

    fn is_text(self) -> bool {
        matches!(self, Self::TextDense | Self::TextSparse | Self::TextBig)
    }
}

/// Shapes and eigenvalues.
pub(crate) fn op4(contents: &ModalResult, form: Form) -> Vec<u8> {
    let columns: Vec<Vec<f64>> = contents
        .modes
        .iter()
        .map(|mode| {
            let nodes = mode.displacement.iter();
            nodes
                .flat_map(|u| [*u, rotation(u)])
                .flat_map(|v| [v.x, v.y, v.z])
                .collect()
        })
        .collect();
    let values = contents.modes.iter().map(lambda).collect();
    let mut bytes = Vec::new();
    for (name, columns) in [("PHIG", columns), ("LAMA", vec![values])] {
        if form.is_text() {
            bytes.extend(text(name, &columns, form).into_bytes());
        } else {
            bytes.extend(binary(name, &columns, form));
        }
    }
    bytes
}

/// Runs without zeros: first row and values.
fn runs(column: &[f64], dense: bool) -> Vec<(usize, &[f64])> {
    if dense {
        let first = column.iter().position(|x| *x != 0.0);
        return first
            .map(|first| (first, &column[first..]))
            .into_iter()
            .collect();
    }
    let mut found = Vec::new();
    let mut at = 0;
    for run in column.split(|x| *x == 0.0) {
        // One word has sixteen bits for the row and the rest for the length.
        for (k, piece) in run.chunks(1000).enumerate() {
            found.push((at + 1000 * k, piece));
        }
        at += run.len() + 1;
    }
    found
}

fn rows(columns: &[Vec<f64>], form: Form) -> i64 {
    let rows = columns[0].len() as i64;
    if form.is_big() { -rows } else { rows }
}

fn text(name: &str, columns: &[Vec<f64>], form: Form) -> String {
    let mut text = String::new();
    writeln!(
        text,
        "{:8}{:8}{:8}{:8}{name:<8}1P,3E24.16",
        columns.len(),
        rows(columns, form),
        2,
        2
    )
    .unwrap();
    let numbers = |text: &mut String, values: &[f64]| {
        for line in values.chunks(3) {
            for value in line {
                write!(text, "{:>24}", format!("{value:.16E}")).unwrap();
            }
            text.push('\n');
        }
    };
    for (k, column) in (1..).zip(columns) {
        let runs = runs(column, form.is_dense());
        if form.is_dense() {
            for (row, values) in runs {
                writeln!(text, "{k:8}{:8}{:8}", row + 1, values.len()).unwrap();
                numbers(&mut text, values);
            }
            continue;
        }
        let head = if form.is_big() { 2 } else { 1 };
        let words: usize = runs.iter().map(|run| head + 2 * run.1.len()).sum();
        writeln!(text, "{k:8}{:8}{words:8}", 0).unwrap();
        for (row, values) in runs {
            let length = 2 * values.len() + 1;
            if form.is_big() {
                writeln!(text, "{length:8}{:8}", row + 1).unwrap();
            } else {
                writeln!(text, "{:12}", length * 65536 + row + 1).unwrap();
            }
            numbers(&mut text, values);
        }
    }
    writeln!(text, "{:8}{:8}{:8}", columns.len() + 1, 1, 1).unwrap();
    numbers(&mut text, &[1.0]);
    text
}

fn binary(name: &str, columns: &[Vec<f64>], form: Form) -> Vec<u8> {
    let mut out = Vec::new();
    let mut record = |content: &[u8]| {
        let length = (content.len() as i32).to_le_bytes();
        out.extend(length);
        out.extend(content);
        out.extend(length);
    };
    let ints = |values: &[i64]| -> Vec<u8> {
        values
            .iter()
            .flat_map(|v| (*v as i32).to_le_bytes())
            .collect()
    };
    let doubles =
        |values: &[f64]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let mut head = ints(&[columns.len() as i64, rows(columns, form), 2, 2]);
    head.extend(format!("{name:<8}").bytes());
    record(&head);
    for (k, column) in (1..).zip(columns) {
        let runs = runs(column, form.is_dense());
        if form.is_dense() {
            for (row, values) in runs {
                let mut bytes = ints(&[k, row as i64 + 1, 2 * values.len() as i64]);
                bytes.extend(doubles(values));
                record(&bytes);
            }
            continue;
        }
        let mut strings = Vec::new();
        for (row, values) in runs {
            let (length, row) = (2 * values.len() as i64 + 1, row as i64 + 1);
            strings.extend(if form.is_big() {
                ints(&[length, row])
            } else {
                ints(&[length * 65536 + row])
            });
            strings.extend(doubles(values));
        }
        let mut bytes = ints(&[k, 0, strings.len() as i64 / 4]);
        bytes.extend(strings);
        record(&bytes);
    }
    let mut end = ints(&[columns.len() as i64 + 1, 1, 2]);
    end.extend(doubles(&[1.0]));
    record(&end);
    out
}
