//! The printed file of Nastran: `R E A L   E I G E N V A L U E S` and
//! `R E A L   E I G E N V E C T O R   N O .`.
//!
//! Tables go on over pages, each with its heading again, and are read by it.
//! An eigenvector's heading has the eigenvalue in the line before. Pages
//! between them hold what else was asked for. The file has no mark at its end
//! that every version writes: each eigenvector must have the nodes of the first.

use crate::eigenvalues::{self, Eigenvalue, frequency_of};
use crate::error::ReadError;
use crate::raw::{Geometry, ModeBuilder, ModeTable};
use crate::text::{Lines, real};
use fladder_mesh::Vec3;
use std::path::Path;

const EIGENVALUES: &str = "REALEIGENVALUES";
const EIGENVECTOR: &str = "REALEIGENVECTORNO.";
/// Most lines between the title of a table of eigenvalues and its first row.
const HEADINGS: usize = 5;
const COMPLEX: &str = "COMPLEXEIGENVECTORNO.";

struct Reader {
    lines: Lines,
    table: ModeTable,
    notes: Vec<String>,
    rows: Vec<Eigenvalue>,
    /// The last `EIGENVALUE =` of a page.
    lambda: Option<f64>,
    open: Option<ModeBuilder>,
}

/// Reads eigenvectors and eigenvalues; the file has no geometry.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader::read(path)?;
    if reader.table.modes.is_empty() {
        let eigenvalues = if reader.rows.is_empty() {
            "neither eigenvalues nor eigenvectors"
        } else {
            "eigenvalues but no eigenvectors"
        };
        return Err(reader.lines.unsupported(format!(
            "the printed file has {eigenvalues}; run SOL 103 with DISPLACEMENT = ALL"
        )));
    }
    eigenvalues::join(&mut reader.table, &reader.rows, path)?;
    let geometry = Geometry {
        notes: reader.notes,
        ..Geometry::default()
    };
    Ok((geometry, reader.table))
}

/// Reads eigenvectors and tables of eigenvalues, whichever are there.
pub(crate) fn read_tables(path: &Path) -> Result<(ModeTable, Vec<Eigenvalue>), ReadError> {
    let mut reader = Reader::read(path)?;
    eigenvalues::join(&mut reader.table, &reader.rows, path)?;
    Ok((reader.table, reader.rows))
}

impl Reader {
    fn read(path: &Path) -> Result<Self, ReadError> {
        let mut reader = Self {
            lines: Lines::open(path)?,
            table: ModeTable::in_local_axes(),
            notes: Vec::new(),
            rows: Vec::new(),
            lambda: None,
            open: None,
        };
        while let Some(line) = reader.lines.next_line()? {
            let line = line.to_owned();
            reader.line(&line)?;
        }
        reader.close()?;
        Ok(reader)
    }

    fn line(&mut self, line: &str) -> Result<(), ReadError> {
        // Headings are spaced letters: compared without blanks.
        if !line.contains(" E I G E N V ") && !line.contains("EIGENVALUE =") {
            return Ok(());
        }
        if let Some((_, value)) = line.split_once("EIGENVALUE =") {
            self.lambda = value.split_ascii_whitespace().next().and_then(real);
        }
        let packed: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        if packed.contains(COMPLEX) {
            return Err(self.lines.unsupported(format!(
                "line {}: the eigenvectors are complex; real modes (SOL 103) are needed",
                self.lines.number()
            )));
        }
        if packed.ends_with(EIGENVALUES) || packed.contains("REALEIGENVALUES(") {
            return self.eigenvalues();
        }
        match packed.split_once(EIGENVECTOR) {
            Some((_, number)) => self.eigenvector(number),
            None => Ok(()),
        }
    }

    /// Rows of two numbers and five reals, after some lines of heading.
    fn eigenvalues(&mut self) -> Result<(), ReadError> {
        let mut any = false;
        let mut headings = 0;
        while let Some(line) = self.lines.next_line()? {
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            let mode = words.first().and_then(|word| word.parse::<u32>().ok());
            let Some(mode) = mode.filter(|_| !line.starts_with('1')) else {
                if !any && headings < HEADINGS && !line.starts_with('1') {
                    headings += 1;
                    continue;
                }
                self.lines.step_back();
                return Ok(());
            };
            let values: Option<Vec<f64>> =
                words.iter().skip(2).map(|word| real(word)).collect();
            let Some([lambda, _, frequency_hz, mass, stiffness]) =
                values.and_then(|values| <[f64; 5]>::try_from(values).ok())
            else {
                return Err(self
                    .lines
                    .syntax("an eigenvalue needs its mode, its order and five numbers"));
            };
            any = true;
            self.rows.push(Eigenvalue {
                mode,
                lambda,
                frequency_hz,
                generalised_mass: mass,
                generalised_stiffness: stiffness,
            });
        }
        Ok(())
    }

    fn eigenvector(&mut self, number: &str) -> Result<(), ReadError> {
        let digits: String = number.chars().take_while(char::is_ascii_digit).collect();
        let mode: u32 = digits
            .parse()
            .map_err(|_| self.lines.syntax("the eigenvector has no number"))?;
        let Some(lambda) = self.lambda else {
            return Err(self
                .lines
                .syntax("an eigenvector without EIGENVALUE = before it"));
        };
        if self.open.as_ref().is_none_or(|open| open.index() != mode) {
            self.close()?;
            self.open = Some(ModeBuilder::new(mode, frequency_of(lambda), Some(lambda)));
        }
        let mut is_heading = true;
        while let Some(line) = self.lines.next_line()? {
            let line = line.to_owned();
            if is_heading {
                if line.contains("POINT ID.") {
                    is_heading = false;
                } else if !line.trim().is_empty() {
                    return Err(self.lines.syntax("no heading POINT ID. of an eigenvector"));
                }
                continue;
            }
            if !self.row(&line)? {
                self.lines.step_back();
                return Ok(());
            }
        }
        if is_heading {
            return Err(self.lines.truncated("the table of an eigenvector"));
        }
        Ok(())
    }

    /// One node, or up to six scalar points; false for any other line.
    fn row(&mut self, line: &str) -> Result<bool, ReadError> {
        // Column 1 has the mark of a new page.
        let mut words = line
            .strip_prefix(' ')
            .unwrap_or("")
            .split_ascii_whitespace();
        let id = words.next().and_then(|word| word.parse::<u64>().ok());
        let (Some(id), Some(kind)) = (id, words.next()) else {
            return Ok(false);
        };
        let open = self
            .open
            .as_mut()
            .expect("a row comes within an eigenvector");
        match kind {
            "S" | "L" | "H" => {
                open.scalar_points += words.count().max(1);
                Ok(true)
            }
            "G" => {
                let values: Option<Vec<f64>> = words.map(real).collect();
                let values = values.and_then(|values| <[f64; 6]>::try_from(values).ok());
                let Some([x, y, z, a, b, c]) = values else {
                    return Err(self.lines.syntax(format!(
                        "node {id} needs three displacements and three rotations"
                    )));
                };
                let (translation, rotation) = (Vec3::new(x, y, z), Vec3::new(a, b, c));
                open.add(&mut self.table, id, translation, Some(rotation))
                    .map_err(|message| self.lines.syntax(message))?;
                Ok(true)
            }
            _ => Ok(false),
        }
    }

    fn close(&mut self) -> Result<(), ReadError> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        open.finish(&mut self.table, &mut self.notes)
            .map_err(|message| self.lines.syntax(message))
    }
}
