//! Reference files in `tests/data`; each carries its definition and source on top.

use std::collections::HashMap;
use std::path::PathBuf;

use crate::case::Fault;

/// Path of a reference file.
pub fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(name)
}

/// One line of a comma-separated file, by column.
#[derive(Clone, Debug)]
pub struct Line {
    file: String,
    cells: HashMap<String, String>,
}

impl Line {
    /// Text of a column, empty where there is none.
    pub fn text(&self, column: &str) -> &str {
        self.cells.get(column).map_or("", String::as_str)
    }

    /// Whether the file has that column.
    pub fn has(&self, column: &str) -> bool {
        self.cells.contains_key(column)
    }

    /// Number in a column.
    ///
    /// # Errors
    /// [`Fault::Reference`] where there is no number.
    pub fn number(&self, column: &str) -> Result<f64, Fault> {
        self.text(column).parse().map_err(|_| Fault::Reference {
            file: self.file.clone(),
            what: format!("column `{column}` holds no number"),
        })
    }

    /// Numbers in several columns.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn numbers<const N: usize>(&self, columns: [&str; N]) -> Result<[f64; N], Fault> {
        let mut values = [0.0; N];
        for (value, column) in values.iter_mut().zip(columns) {
            *value = self.number(column)?;
        }
        Ok(values)
    }
}

/// Lines of a comma-separated file with `#` comments and one line of column names.
///
/// # Errors
/// [`Fault::Reference`] where the file cannot be read or is empty.
pub fn lines(name: &str) -> Result<Vec<Line>, Fault> {
    let fault = |what: String| Fault::Reference {
        file: name.to_owned(),
        what,
    };
    let text = std::fs::read_to_string(path(name)).map_err(|error| fault(error.to_string()))?;
    let mut kept = text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    let head = kept.next().ok_or_else(|| fault("it is empty".to_owned()))?;
    let columns: Vec<&str> = head.split(',').map(str::trim).collect();
    Ok(kept
        .map(|line| Line {
            file: name.to_owned(),
            cells: columns
                .iter()
                .zip(line.split(','))
                .map(|(column, cell)| ((*column).to_owned(), cell.trim().to_owned()))
                .collect(),
        })
        .collect())
}

/// The line whose column `name` holds `value`.
///
/// # Errors
/// [`Fault::Reference`] where there is none.
pub fn line(file: &str, value: &str) -> Result<Line, Fault> {
    lines(file)?
        .into_iter()
        .find(|line| line.text("name") == value)
        .ok_or_else(|| Fault::Reference {
            file: file.to_owned(),
            what: format!("it has no line named `{value}`"),
        })
}
