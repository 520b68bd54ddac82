//! The formats read, told from a file's first line rather than from its name.

use crate::error::ReadError;
use crate::text::first_line;
use std::path::Path;

/// A format of modal results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// CalculiX `.frd`, ASCII.
    CalculixFrd,
    /// The neutral JSON of `docs/modal-json.md`.
    Neutral,
}

impl Format {
    /// Name in reports and in the case file's `structure.format`.
    pub fn name(self) -> &'static str {
        match self {
            Self::CalculixFrd => "calculix-frd",
            Self::Neutral => "fladder-json",
        }
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::CalculixFrd, Self::Neutral]
            .into_iter()
            .find(|format| format.name() == name)
    }
}

/// Tells the format from the first line that is not blank.
pub(crate) fn detect(path: &Path) -> Result<Format, ReadError> {
    let line = first_line(path)?;
    if line.starts_with('{') {
        return Ok(Format::Neutral);
    }
    if line.starts_with("1C") || line.starts_with("1U") {
        return Ok(Format::CalculixFrd);
    }
    Err(unknown(path, &line))
}

/// The error for a file that begins with `line`.
pub(crate) fn unknown(path: &Path, line: &str) -> ReadError {
    let start = line.chars().take(40).collect();
    ReadError::UnknownFormat {
        file: path.display().to_string(),
        start,
    }
}
