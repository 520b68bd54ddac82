//! Nastran punch files: the block `$EIGENVECTOR`, real.
//!
//! Lines of 72 columns and an eight-column number behind them. A block begins
//! with comment lines (`$TITLE`, …, `$EIGENVECTOR`, `$REAL OUTPUT`,
//! `$SUBCASE ID =`, `$EIGENVALUE = … MODE = …`); a node is ten columns of
//! number, `G` in column 18 and three reals of 18 columns, its rotations a line
//! `-CONT-` with three more. A punch file has no generalised masses, and no
//! mark at its end: a node without its `-CONT-` line is a cut.

use crate::eigenvalues::frequency_of;
use crate::error::ReadError;
use crate::raw::{Geometry, ModeBuilder, ModeTable};
use crate::text::{Lines, field, real};
use fladder_mesh::Vec3;
use std::path::Path;

/// Vectors of nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Vectors {
    Shapes,
    /// Shapes where an eigenvalue is stated, else static.
    Displacements,
}

/// What the comment lines of a block say.
#[derive(Default)]
struct Head {
    vectors: Option<Vectors>,
    mode: Option<(u32, f64)>,
}

impl Head {
    fn is_shape(&self) -> bool {
        match self.vectors {
            Some(Vectors::Shapes) => true,
            Some(Vectors::Displacements) => self.mode.is_some(),
            None => false,
        }
    }
}

struct Reader {
    lines: Lines,
    table: ModeTable,
    geometry: Geometry,
    head: Head,
    open: Option<ModeBuilder>,
}

/// Reads the modes; a punch file has no geometry.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader {
        lines: Lines::open(path)?,
        table: ModeTable::in_local_axes(),
        geometry: Geometry::default(),
        head: Head::default(),
        open: None,
    };
    while let Some(line) = reader.lines.next_line()? {
        let line = line.to_owned();
        if line.starts_with('$') {
            reader.comment(&line)?;
        } else if !line.trim().is_empty() && reader.head.is_shape() {
            reader.point(&line)?;
        }
    }
    reader.close()?;
    let Reader {
        lines,
        table,
        geometry,
        ..
    } = reader;
    if table.modes.is_empty() {
        return Err(lines.unsupported(
            "the punch file has no eigenvectors; run SOL 103 with DISPLACEMENT(PUNCH) = ALL",
        ));
    }
    Ok((geometry, table))
}

impl Reader {
    fn comment(&mut self, line: &str) -> Result<(), ReadError> {
        self.close()?;
        // Columns 73 to 80 number the lines.
        let text: String = line.chars().skip(1).take(71).collect();
        let word = text
            .split(['=', ' '])
            .next()
            .unwrap_or("")
            .to_ascii_uppercase();
        match word.as_str() {
            "TITLE" => self.head = Head::default(),
            "EIGENVECTOR" | "EIGENVECTORS" => self.head.vectors = Some(Vectors::Shapes),
            "DISPLACEMENT" | "DISPLACEMENTS" => {
                self.head.vectors = Some(Vectors::Displacements);
            }
            "REAL-IMAGINARY" | "MAGNITUDE-PHASE"
                if self.head.vectors == Some(Vectors::Shapes) =>
            {
                return Err(self.lines.unsupported(format!(
                    "line {}: the eigenvectors are complex; real modes (SOL 103) are needed",
                    self.lines.number()
                )));
            }
            "POINT" if self.head.vectors == Some(Vectors::Shapes) => {
                return Err(self.lines.unsupported(format!(
                    "line {}: the eigenvectors are sorted by node (SORT2); write SORT1",
                    self.lines.number()
                )));
            }
            "EIGENVALUE" => self.head.mode = Some(self.eigenvalue(&text)?),
            _ => {}
        }
        Ok(())
    }

    /// `EIGENVALUE =  1.5E+03  MODE =     1`.
    fn eigenvalue(&self, text: &str) -> Result<(u32, f64), ReadError> {
        let parts: Vec<&str> = text.split('=').collect();
        let value = |i: usize| {
            let part = parts.get(i).copied().unwrap_or("");
            part.split_ascii_whitespace().next().unwrap_or("")
        };
        let (lambda, mode) = (real(value(1)), value(2).parse().ok());
        mode.zip(lambda).ok_or_else(|| {
            self.lines
                .syntax("$EIGENVALUE without its value and mode number")
        })
    }

    fn point(&mut self, line: &str) -> Result<(), ReadError> {
        let Some((mode, lambda)) = self.head.mode else {
            return Err(self
                .lines
                .syntax("an eigenvector without $EIGENVALUE before it"));
        };
        let open = self
            .open
            .get_or_insert_with(|| ModeBuilder::new(mode, frequency_of(lambda), Some(lambda)));
        if field(line, 0, 6) == "-CONT-" {
            return Err(self.lines.syntax("-CONT- after no node"));
        }
        let id = field(line, 0, 10);
        let id: u64 = id
            .parse()
            .map_err(|_| self.lines.syntax(format!("{id:?} is no node number")))?;
        let kind = field(line, 10, 18).to_owned();
        let translation = vector(&self.lines, line)?;
        let next = self.lines.next_line()?.map(str::to_owned);
        let Some(next) = next else {
            return Err(self.lines.truncated(format!("the rotation of node {id}")));
        };
        if field(&next, 0, 6) != "-CONT-" {
            return Err(self.lines.syntax(format!("no -CONT- line of node {id}")));
        }
        if kind == "S" {
            open.scalar_points += 1;
            return Ok(());
        }
        let rotation = vector(&self.lines, &next)?;
        open.add(&mut self.table, id, translation, Some(rotation))
            .map_err(|message| self.lines.syntax(message))
    }

    fn close(&mut self) -> Result<(), ReadError> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        self.head.mode = None;
        open.finish(&mut self.table, &mut self.geometry.notes)
            .map_err(|message| self.lines.syntax(message))
    }
}

/// Three reals of 18 columns; blank ones are zero.
fn vector(lines: &Lines, line: &str) -> Result<Vec3, ReadError> {
    let mut vector = Vec3::zeros();
    for axis in 0..3 {
        let text = field(line, 18 * (axis + 1), 18 * (axis + 2));
        if text.is_empty() && axis > 0 {
            continue;
        }
        vector[axis] =
            real(text).ok_or_else(|| lines.syntax(format!("{text:?} is no finite number")))?;
    }
    Ok(vector)
}
