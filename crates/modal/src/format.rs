//! The formats read, told from a file's first line rather than from its name.

use crate::error::ReadError;
use crate::text::Lines;
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
    let mut lines = Lines::open(path)?;
    while let Some(line) = lines.next_line()? {
        if line.trim().is_empty() {
            continue;
        }
        if line.trim_start().starts_with('{') {
            return Ok(Format::Neutral);
        }
        let key = line.trim_start();
        if key.starts_with("1C") || key.starts_with("1U") {
            return Ok(Format::CalculixFrd);
        }
        let start: String = key.chars().take(40).collect();
        return Err(ReadError::UnknownFormat {
            file: lines.name(),
            start,
        });
    }
    Err(ReadError::Truncated {
        file: lines.name(),
        line: 0,
        missing: "any content".to_owned(),
    })
}
