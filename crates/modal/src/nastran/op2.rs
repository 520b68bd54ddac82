//! Modes and geometry of a Nastran `.op2` file: `GEOM1`, `GEOM2`, `LAMA` and
//! the eigenvectors of `OUGV1` and its kin.
//!
//! A table of results has pairs of blocks: 146 words that describe, and the
//! values. Word 1 is 10 × the kind of analysis (2: real modes) + device, word 2
//! the kind of result (7: eigenvectors), 5 the mode, 6 its eigenvalue, 9 the
//! format (1: real), 10 the words a node: 10 × number + device, kind (1: grid
//! point), three displacements, three rotations. `LAMA` has seven words a
//! mode: mode, order, λ, ω, f, mass, stiffness. `OUGV1` is in each node's own
//! frame, `BOUGV1` in the basic one.

use super::model::Model;
use super::op2_geometry::{self, Elements};
use super::op2_tables::{Block, Tables};
use crate::binary::Words;
use crate::eigenvalues::{self, Eigenvalue, frequency_of};
use crate::error::ReadError;
use crate::raw::{Geometry, ModeBuilder, ModeTable};
use fladder_mesh::Vec3;
use std::path::Path;

/// Kind of analysis: real eigenvalues.
const REAL_MODES: i64 = 2;
/// Kinds of analysis with complex shapes.
const COMPLEX_MODES: i64 = 9;
/// Kind of result: eigenvectors.
const EIGENVECTORS: i64 = 7;
/// Format of real values.
const REAL: i64 = 1;
/// Words a node with real values.
const NODE: usize = 8;
/// Words a mode in `LAMA`.
const ROW: usize = 7;

/// Tables of displacements in each node's own frame, and in the basic one.
const LOCAL: [&str; 4] = ["OUGV1", "OUG1", "OPHIG", "OUG1S"];
const BASIC: [&str; 3] = ["BOUGV1", "BOUG1", "BOPHIG"];

struct Reader {
    tables: Tables,
    model: Model,
    elements: Elements,
    rows: Vec<Eigenvalue>,
    table: ModeTable,
    notes: Vec<String>,
}

/// Reads geometry and modes, whichever are there.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader {
        tables: Tables::open(path)?,
        model: Model::default(),
        elements: Elements::default(),
        rows: Vec::new(),
        table: ModeTable::default(),
        notes: Vec::new(),
    };
    while let Some(name) = reader.tables.next_table()? {
        reader.table(&name)?;
    }
    let Reader {
        mut model,
        elements,
        rows,
        mut table,
        notes,
        ..
    } = reader;
    let mismatch = |message| ReadError::Mismatch {
        file: path.display().to_string(),
        message,
    };
    let mut geometry = if model.has_nodes() {
        elements.finish(&mut model).map_err(mismatch)?;
        model.finish().map_err(mismatch)?
    } else {
        Geometry::default()
    };
    geometry.notes.extend(notes);
    eigenvalues::join(&mut table, &rows, path)?;
    Ok((geometry, table))
}

impl Reader {
    fn table(&mut self, name: &str) -> Result<(), ReadError> {
        // GEOM1S, GEOM1N and GEOM1OLD are the same model at other stages.
        if name == "GEOM1" || (name.starts_with("GEOM1") && !self.model.has_nodes()) {
            while let Some(block) = self.tables.next_block()? {
                let taken =
                    op2_geometry::geom1(&block.words, self.tables.is_wide(), &mut self.model);
                taken.map_err(|message| self.tables.damaged(format!("{name}: {message}")))?;
            }
        } else if name == "GEOM2" || (name.starts_with("GEOM2") && self.elements.is_empty()) {
            while let Some(block) = self.tables.next_block()? {
                self.elements.push(block.words);
            }
        } else if name.starts_with("LAMA") {
            self.lama()?;
        } else if LOCAL.contains(&name) || BASIC.contains(&name) {
            self.results(name)?;
        } else if matches!(name, "OUGV2" | "OUG2" | "OUGV1PAT") {
            self.notes.push(format!(
                "table {name} is not read; results sorted by mode (SORT1) are in OUGV1"
            ));
        }
        Ok(())
    }

    fn lama(&mut self) -> Result<(), ReadError> {
        while let Some(Block { number, words }) = self.tables.next_block()? {
            // Block 3 describes the table.
            if number == 3 {
                continue;
            }
            if !words.len().is_multiple_of(ROW) {
                let message = format!("LAMA has {} words, which is no whole row", words.len());
                return Err(self.tables.damaged(message));
            }
            for at in (0..words.len()).step_by(ROW) {
                let row = lama_row(&words, at);
                let row =
                    row.ok_or_else(|| self.tables.damaged("LAMA has a row of no mode"))?;
                self.rows.push(row);
            }
        }
        Ok(())
    }

    fn results(&mut self, name: &str) -> Result<(), ReadError> {
        let mut open = None;
        while let Some(Block { words, .. }) = self.tables.next_block()? {
            match open.take() {
                None => open = Some(self.head(name, &words)?),
                Some(None) => {}
                Some(Some(mode)) => self.shape(mode, &words)?,
            }
        }
        Ok(())
    }

    /// The mode that a description announces; `None` for other results.
    fn head(&mut self, name: &str, words: &Words) -> Result<Option<ModeBuilder>, ReadError> {
        let word = |at: usize| {
            let word = words.int(at - 1);
            word.ok_or_else(|| {
                self.tables
                    .damaged(format!("{name} has a short description"))
            })
        };
        let (analysis, result) = (word(1)? / 10, word(2)? % 1000);
        if analysis == COMPLEX_MODES {
            return Err(self.tables.unsupported(format!(
                "{name} holds complex modes; real modes (SOL 103) are needed"
            )));
        }
        if analysis != REAL_MODES || ![EIGENVECTORS, 1].contains(&result) {
            let note = format!("{name} holds results of other analyses, which are not used");
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
            return Ok(None);
        }
        let (format, width) = (word(9)?, word(10)?);
        if format != REAL || width != NODE as i64 || word(2)? / 1000 != 0 {
            return Err(self.tables.unsupported(format!(
                "{name} holds modes in format {format} with {width} words a node; real ones \
                 sorted by mode (SORT1) are needed"
            )));
        }
        let mode = u32::try_from(word(5)?).ok();
        let lambda = words.real(5).filter(|lambda| lambda.is_finite());
        let Some((mode, lambda)) = mode.zip(lambda) else {
            return Err(self
                .tables
                .damaged(format!("{name} has a mode without an eigenvalue")));
        };
        let is_local = LOCAL.contains(&name);
        if self.table.modes.is_empty() {
            self.table.in_local_axes = is_local;
        } else if self.table.in_local_axes != is_local {
            return Err(self.tables.unsupported(
                "modes are there both in the basic frame and in those of the nodes; keep one",
            ));
        }
        Ok(Some(ModeBuilder::new(
            mode,
            frequency_of(lambda),
            Some(lambda),
        )))
    }

    fn shape(&mut self, mut mode: ModeBuilder, words: &Words) -> Result<(), ReadError> {
        let index = mode.index();
        let about = |message: String| format!("mode {index}: {message}");
        if !words.len().is_multiple_of(NODE) {
            let message = about(format!("{} words are no whole nodes", words.len()));
            return Err(self.tables.damaged(message));
        }
        for at in (0..words.len()).step_by(NODE) {
            let node = node(words, at);
            let Some((id, is_grid, displacement, rotation)) = node else {
                return Err(self
                    .tables
                    .damaged(about("a node without finite values".to_owned())));
            };
            if !is_grid {
                mode.scalar_points += 1;
                continue;
            }
            mode.add(&mut self.table, id, displacement, Some(rotation))
                .map_err(|message| self.tables.damaged(about(message)))?;
        }
        mode.finish(&mut self.table, &mut self.notes)
            .map_err(|message| self.tables.damaged(message))
    }
}

fn node(words: &Words, at: usize) -> Option<(u64, bool, Vec3, Vec3)> {
    let id = u64::try_from(words.int(at)? / 10).ok()?;
    let value = |k: usize| words.real(at + 2 + k).filter(|value| value.is_finite());
    let displacement = Vec3::new(value(0)?, value(1)?, value(2)?);
    let rotation = Vec3::new(value(3)?, value(4)?, value(5)?);
    Some((id, words.int(at + 1)? == 1, displacement, rotation))
}

fn lama_row(words: &Words, at: usize) -> Option<Eigenvalue> {
    let value = |k: usize| words.real(at + k).filter(|value| value.is_finite());
    Some(Eigenvalue {
        mode: u32::try_from(words.int(at)?).ok()?,
        lambda: value(2)?,
        frequency_hz: value(4)?,
        generalised_mass: value(5)?,
        generalised_stiffness: value(6)?,
    })
}
