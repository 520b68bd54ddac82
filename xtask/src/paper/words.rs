//! Numbers and tables for people.

use std::fmt::Write as _;

/// Three significant digits.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    let decimals = if size >= 1.0 {
        (2.0 - size.log10().floor()).clamp(0.0, 3.0)
    } else if size > 0.0 {
        (2.0 - size.log10().floor()).min(6.0)
    } else {
        2.0
    };
    format!("{value:.*}", decimals as usize).replace('-', "−")
}

/// What an amplitude does that grows by σ, 1/s.
pub(super) fn amplitude(sigma: f64) -> String {
    let time = number(std::f64::consts::LN_2 / sigma.abs());
    if sigma > 0.0 {
        format!("doubles in {time} s")
    } else {
        format!("halves in {time} s")
    }
}

/// A table with a head.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub(super) head: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new(head: &[&str]) -> Self {
        Self {
            head: head.iter().map(ToString::to_string).collect(),
            rows: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, row: impl IntoIterator<Item = String>) {
        self.rows.push(row.into_iter().collect());
    }

    pub(super) fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = format!("|{}\n", "---|".repeat(self.head.len()));
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        line(&self.head) + &rule + &rows
    }

    pub(super) fn csv(&self) -> String {
        let cell = |text: &String| {
            if text.contains([',', '"', '\n']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.clone()
            }
        };
        let line = |cells: &Vec<String>| {
            let cells: Vec<String> = cells.iter().map(cell).collect();
            cells.join(",") + "\n"
        };
        std::iter::once(&self.head)
            .chain(&self.rows)
            .map(line)
            .collect()
    }

    pub(super) fn html(&self) -> String {
        let cells = |row: &[String], tag: &str| -> String {
            let mut cells = String::new();
            for cell in row {
                // Writing to a string cannot fail.
                let _ = write!(cells, "<{tag}>{}</{tag}>", escape(cell));
            }
            format!("<tr>{cells}</tr>\n")
        };
        let rows: String = self.rows.iter().map(|row| cells(row, "td")).collect();
        format!("<table>\n{}{rows}</table>\n", cells(&self.head, "th"))
    }

    /// Columns of one width.
    pub(super) fn text(&self) -> String {
        let all = || std::iter::once(&self.head).chain(&self.rows);
        let width = |column: usize| {
            let cells = all().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.head.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells: Vec<String> = row
                .iter()
                .zip(&widths)
                .map(|(cell, width)| format!("{cell:<width$}"))
                .collect();
            cells.join("  ").trim_end().to_owned() + "\n"
        };
        all().map(line).collect()
    }
}

/// Text that cannot be taken for markup.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
