//! The formats read, told from a file's content rather than from its name.

use crate::binary::Order;
use crate::error::ReadError;
use crate::text;
use std::path::Path;

/// A format of modal results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// CalculiX `.frd`, ASCII or binary.
    CalculixFrd,
    /// The neutral JSON of `docs/modal-json.md`.
    Neutral,
    /// Nastran punch file.
    NastranPunch,
    /// Printed file of Nastran.
    NastranF06,
    /// Nastran tables, binary.
    NastranOp2,
    /// Nastran matrices, ASCII or binary.
    NastranOp4,
    /// Universal file.
    Universal,
    /// Gmsh `.msh` with node data.
    Gmsh,
}

const FORMATS: [(Format, &str); 8] = [
    (Format::CalculixFrd, "calculix-frd"),
    (Format::Neutral, "fladder-json"),
    (Format::Gmsh, "gmsh-msh"),
    (Format::NastranF06, "nastran-f06"),
    (Format::NastranOp2, "nastran-op2"),
    (Format::NastranOp4, "nastran-op4"),
    (Format::NastranPunch, "nastran-punch"),
    (Format::Universal, "unv"),
];

/// Words at the start of a line that only bulk data have.
const BULK: [&str; 7] = [
    "BEGIN BULK",
    "CEND",
    "GRID",
    "CQUAD",
    "CTRIA",
    "CORD",
    "INCLUDE",
];

impl Format {
    /// Name in reports and in the case file's `structure.format`.
    pub fn name(self) -> &'static str {
        FORMATS
            .iter()
            .find(|entry| entry.0 == self)
            .map_or("", |entry| entry.1)
    }

    /// The format of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        FORMATS
            .iter()
            .find(|entry| entry.1 == name)
            .map(|entry| entry.0)
    }

    /// Names of all formats, by alphabet.
    pub fn names() -> impl Iterator<Item = &'static str> {
        FORMATS.iter().map(|entry| entry.1)
    }
}

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    Result(Format),
    /// Nastran bulk data.
    Bulk,
    /// Input of CalculiX or Abaqus.
    Input,
}

/// Tells the content of a file from its start.
pub(crate) fn content(path: &Path) -> Result<Content, ReadError> {
    let start = text::start(path)?;
    if let Some(format) = binary(&start) {
        return Ok(Content::Result(format));
    }
    let lossy = String::from_utf8_lossy(&start);
    let lossy = lossy.trim_start_matches('\u{feff}');
    let Some(first) = lossy.lines().find(|line| !line.trim().is_empty()) else {
        return Err(ReadError::Truncated {
            file: path.display().to_string(),
            line: 0,
            missing: "any content".to_owned(),
        });
    };
    text_content(lossy, first).ok_or_else(|| ReadError::UnknownFormat {
        file: path.display().to_string(),
        start: first.trim().chars().take(40).collect(),
    })
}

fn text_content(text: &str, first: &str) -> Option<Content> {
    let word = first.trim_start();
    let any = |marks: &[&str]| {
        text.lines()
            .any(|line| marks.iter().any(|mark| starts(line, mark)))
    };
    if word.starts_with('{') {
        return Some(Content::Result(Format::Neutral));
    }
    if word.starts_with("1C") || word.starts_with("1U") {
        return Some(Content::Result(Format::CalculixFrd));
    }
    if word.starts_with("$MeshFormat") {
        return Some(Content::Result(Format::Gmsh));
    }
    if first.trim() == "-1" {
        return Some(Content::Result(Format::Universal));
    }
    if is_op4_header(first) {
        return Some(Content::Result(Format::NastranOp4));
    }
    if word.starts_with('$')
        && any(&[
            "$EIGENV",
            "$REAL OUTPUT",
            "$SUBCASE ID",
            "$MAGNITUDE",
            "$REAL-",
        ])
    {
        return Some(Content::Result(Format::NastranPunch));
    }
    if ["N A S T R A N", "N a s t r a n", "E I G E N V A L U E"]
        .iter()
        .any(|mark| text.contains(mark))
    {
        return Some(Content::Result(Format::NastranF06));
    }
    if word.starts_with('*') {
        return Some(Content::Input);
    }
    any(&BULK).then_some(Content::Bulk)
}

fn starts(line: &str, word: &str) -> bool {
    let line = line.trim_start();
    line.get(..word.len())
        .is_some_and(|start| start.eq_ignore_ascii_case(word))
}

/// Binary files begin with the length of a record: 4 or 8 of an `.op2` file's
/// key, 24 of an `.op4` file's heading.
fn binary(start: &[u8]) -> Option<Format> {
    if let Some(order) = Order::of(start, &[4, 8]) {
        let length = order.i32(*start.first_chunk::<4>()?);
        let closing = start.get(4 + length as usize..)?.first_chunk::<4>()?;
        return (order.i32(*closing) == length).then_some(Format::NastranOp2);
    }
    Order::of(start, &[24, 48]).map(|_| Format::NastranOp4)
}

/// Four integers of eight columns, a name, a number format such as `1P,3E23.16`.
fn is_op4_header(line: &str) -> bool {
    let integers = (0..4).all(|k| {
        let text = text::field(line, 8 * k, 8 * (k + 1));
        text.parse::<i64>().is_ok()
    });
    integers && text::field(line, 40, line.len()).contains(['E', 'D', 'e'])
}

/// The format of a result file.
pub(crate) fn detect(path: &Path) -> Result<Format, ReadError> {
    match content(path)? {
        Content::Result(format) => Ok(format),
        Content::Bulk | Content::Input => Err(ReadError::Unsupported {
            file: path.display().to_string(),
            what:
                "it is the input of a finite-element program, which has geometry and no modes; \
                   give the result file, and this one as structure.geometry"
                    .to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_by_their_content() {
        for (text, expected) in [
            ("{\"schema\"", Some(Content::Result(Format::Neutral))),
            ("    1C\n", Some(Content::Result(Format::CalculixFrd))),
            ("    -1\n    15\n", Some(Content::Result(Format::Universal))),
            (
                "$TITLE = X\n$SUBTITLE\n$EIGENVECTOR\n",
                Some(Content::Result(Format::NastranPunch)),
            ),
            (
                "      10      10       6       2EYE10   1P,3E23.16\n",
                Some(Content::Result(Format::NastranOp4)),
            ),
            ("$ made by hand\ngrid,1,,0.,0.\n", Some(Content::Bulk)),
            ("*NODE\n1, 0., 0.\n", Some(Content::Input)),
            ("hello\n", None),
        ] {
            let first = text.lines().next().unwrap();
            assert_eq!(text_content(text, first), expected, "{text:?}");
        }
    }

    #[test]
    fn every_format_has_a_name_of_its_own() {
        for (format, name) in FORMATS {
            assert_eq!(Format::from_name(name), Some(format));
            assert_eq!(format.name(), name);
        }
    }
}
