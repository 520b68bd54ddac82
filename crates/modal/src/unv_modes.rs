//! Modes in universal files: datasets 55 (data at nodes) and 2414 (results).
//!
//! Dataset 55, after five lines of text: model, analysis (2 normal modes, 3 and
//! 7 complex ones), characteristic (2: three components, 3: six), specific type
//! (8 displacement, 12 acceleration, 11 velocity), data type (2 real, 5
//! complex), values a node; counts, load case, mode; frequency, modal mass, two
//! dampings. Dataset 2414, after a number, a name, the place (1: nodes) and five
//! lines of text: the same six; ten integers with the mode as seventh … sixth
//! counted from 0; two; frequency as second real; modal mass as fourth. Then a
//! node number and its values, six a line.

use crate::error::ReadError;
use crate::raw::ModeBuilder;
use crate::unv::{INTEGER, Reader};
use fladder_mesh::Vec3;

/// Kinds of analysis.
const NORMAL_MODES: i64 = 2;
const COMPLEX_MODES: [i64; 2] = [3, 7];
/// Kinds of value: displacement, and general ones that test programs write.
const DISPLACEMENT: i64 = 8;
const UNKNOWN: i64 = 0;

/// What the heading of a result says of its values.
struct Values {
    count: usize,
    /// Columns of a real.
    width: usize,
}

impl Reader {
    /// Judges model, analysis, characteristic, kind, data type and count;
    /// `None` for a result that is no mode.
    fn values(&mut self, what: [i64; 6]) -> Result<Option<Values>, ReadError> {
        let [_, analysis, characteristic, kind, data, count] = what;
        let is_complex = data == 5 || data == 6;
        if COMPLEX_MODES.contains(&analysis) || (analysis == NORMAL_MODES && is_complex) {
            return Err(self.lines.unsupported(format!(
                "line {}: the modes are complex; write real (normal) modes",
                self.lines.number()
            )));
        }
        let is_mode = analysis == NORMAL_MODES && [DISPLACEMENT, UNKNOWN].contains(&kind);
        if !is_mode {
            let note = format!(
                "results of analysis {analysis} and kind {kind} are not used (modes are analysis \
                 2, displacements kind 8)"
            );
            if !self.geometry.notes.contains(&note) {
                self.geometry.notes.push(note);
            }
            return Ok(None);
        }
        let fits = matches!((characteristic, count), (2, 3) | (3, 6));
        if !fits {
            return Err(self.lines.syntax(format!(
                "a mode of characteristic {characteristic} with {count} values a node, where 2 \
                 with 3 or 3 with 6 are needed"
            )));
        }
        Ok(Some(Values {
            count: count as usize,
            width: if data == 4 { 25 } else { 13 },
        }))
    }

    /// Node by node to the end of the dataset.
    fn shape(&mut self, mut mode: ModeBuilder, values: &Values) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [id] = self.integers(&line)?;
            let id = self.id(id)?;
            let mut numbers = Vec::with_capacity(values.count);
            while numbers.len() < values.count {
                let line = self.line("the values of a node")?;
                let fields = line.trim_end().len().div_ceil(values.width);
                let here = fields.clamp(1, values.count - numbers.len());
                numbers.extend(self.reals(&line, here, values.width)?);
            }
            let displacement = Vec3::from_row_slice(&numbers[..3]);
            let rotation = (values.count == 6).then(|| Vec3::from_row_slice(&numbers[3..]));
            mode.add(&mut self.table, id, displacement, rotation)
                .map_err(|message| self.lines.syntax(message))?;
        }
        self.keep(mode)
    }

    fn lines_of_text(&mut self, count: usize) -> Result<(), ReadError> {
        for _ in 0..count {
            self.line("the heading of a result")?;
        }
        Ok(())
    }

    fn mode(&self, number: i64, frequency_hz: f64, mass: f64) -> ModeBuilder {
        // Test programs leave the number 0: modes count in the order of the file.
        let index = u32::try_from(number).ok().filter(|index| *index > 0);
        let next = u32::try_from(self.table.modes.len() + 1).unwrap_or(u32::MAX);
        let index = index.unwrap_or(next);
        // Test programs write 0 where they know no mass.
        let mass = (mass != 0.0).then_some(mass);
        ModeBuilder::new(index, frequency_hz, None).with_mass(mass)
    }
}

pub(crate) fn dataset_55(reader: &mut Reader) -> Result<(), ReadError> {
    reader.lines_of_text(5)?;
    let line = reader.line("the heading of a mode")?;
    let what = reader.integers(&line)?;
    let Some(values) = reader.values(what)? else {
        return reader.skip();
    };
    let line = reader.line("the number of a mode")?;
    let [_, _, _, number] = reader.integers(&line)?;
    let line = reader.line("the frequency of a mode")?;
    let count = line.split_ascii_whitespace().count().min(4);
    let reals = reader.reals(&line, count.max(1), 13)?;
    let mass = reals.get(1).copied().unwrap_or(0.0);
    let mode = reader.mode(number, reals[0], mass);
    reader.shape(mode, &values)
}

pub(crate) fn dataset_2414(reader: &mut Reader) -> Result<(), ReadError> {
    reader.lines_of_text(2)?;
    let line = reader.line("the place of a result")?;
    let [place] = reader.integers(&line)?;
    reader.lines_of_text(5)?;
    let line = reader.line("the heading of a result")?;
    let what = reader.integers(&line)?;
    let values = if place == 1 {
        reader.values(what)?
    } else {
        None
    };
    let Some(values) = values else {
        return reader.skip();
    };
    let line = reader.line("the number of a mode")?;
    let numbers = reader.integers::<8>(line.get(..8 * INTEGER).unwrap_or(&line))?;
    reader.lines_of_text(1)?;
    let line = reader.line("the frequency of a mode")?;
    let reals = reader.reals(&line, 6, 13)?;
    reader.lines_of_text(1)?;
    let mode = reader.mode(numbers[5], reals[1], reals[3]);
    reader.shape(mode, &values)
}
