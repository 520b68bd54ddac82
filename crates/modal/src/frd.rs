//! CalculiX `.frd` results, ASCII and binary.
//!
//! Fixed-width records: a node line is `-1`, its number in ten columns (five in
//! the short form) and reals of twelve columns each, without separators. Blocks
//! state how many records follow and end with `-3`, the file ends with `9999`;
//! both are required, so that a file cut short is never half read. Layout from
//! the CalculiX GraphiX manual, "Result Format". Each mode is a `DISP` block
//! after the parameters `1PMODE` (number), `1PGM` (generalised mass) and `1PGK`
//! (generalised stiffness, λ for unit mass).

use crate::element;
use crate::error::ReadError;
use crate::frd_binary::{self, Precision};
use crate::raw::{Geometry, ModeTable, RawElement, RawMode, ShapeBuilder};
use crate::text::{Lines, field, real};
use fladder_mesh::Vec3;
use std::path::Path;

/// Analysis type of a natural mode in a result block's header.
const MODAL: &str = "2";

/// Parameters that precede a result block.
#[derive(Default)]
struct Parameters {
    mode: Option<u32>,
    generalised_mass: Option<f64>,
    generalised_stiffness: Option<f64>,
}

/// Width of the number in a record, from the format digit of its block.
#[derive(Clone, Copy)]
enum Form {
    Short,
    Long,
    Binary(Precision),
}

impl Form {
    fn of(digit: &str) -> Option<Self> {
        Some(match digit {
            "0" => Self::Short,
            "1" => Self::Long,
            "2" => Self::Binary(Precision::Single),
            "3" => Self::Binary(Precision::Double),
            _ => return None,
        })
    }
}

struct Reader {
    lines: Lines,
    geometry: Geometry,
    table: ModeTable,
    parameters: Parameters,
}

/// Reads nodes, elements and modes.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader {
        lines: Lines::open(path)?,
        geometry: Geometry::default(),
        table: ModeTable::default(),
        parameters: Parameters::default(),
    };
    match reader.blocks() {
        Ok(()) => Ok((reader.geometry, reader.table)),
        // A damaged last line is the mark of a cut, not of a bad writer.
        Err(ReadError::Syntax { message, .. }) if reader.lines.at_end() => {
            Err(reader.lines.truncated(format!(
                "the end mark 9999, and in the last line {message}; it"
            )))
        }
        Err(error) => Err(error),
    }
}

impl Reader {
    fn blocks(&mut self) -> Result<(), ReadError> {
        loop {
            let Some(line) = self.lines.next_line()? else {
                return Err(self.lines.truncated("the end mark 9999"));
            };
            let code = line.as_bytes().get(5).copied();
            match (field(line, 0, 5), code) {
                ("1", Some(b'P')) => self.parameter()?,
                ("2", Some(b'C')) => self.node_block()?,
                ("3", Some(b'C')) => self.element_block()?,
                ("100", Some(b'C')) => self.result_block()?,
                ("9999", None) => return self.rest(),
                ("1", _) | ("", None) => {}
                _ => {
                    return Err(self
                        .lines
                        .syntax("no block of a .frd file begins like this"));
                }
            }
        }
    }

    /// Reads on to the end of the file, where a gzip stream has its checksum.
    fn rest(&mut self) -> Result<(), ReadError> {
        while self.lines.next_line()?.is_some() {}
        Ok(())
    }

    fn line(&mut self, missing: &str) -> Result<String, ReadError> {
        match self.lines.next_line()? {
            Some(line) => Ok(line.to_owned()),
            None => Err(self.lines.truncated(missing)),
        }
    }

    fn current(&mut self) -> Result<String, ReadError> {
        self.lines.step_back();
        self.line("a header")
    }

    fn parameter(&mut self) -> Result<(), ReadError> {
        let line = self.current()?;
        let value = field(&line, 10, 60);
        match field(&line, 5, 10) {
            "PMODE" => {
                let mode = value.parse();
                self.parameters.mode = Some(
                    mode.map_err(|_| self.lines.syntax("the mode number is not a number"))?,
                );
            }
            "PGM" => self.parameters.generalised_mass = Some(self.parameter_value(value)?),
            "PGK" => self.parameters.generalised_stiffness = Some(self.parameter_value(value)?),
            _ => {}
        }
        Ok(())
    }

    fn parameter_value(&self, text: &str) -> Result<f64, ReadError> {
        real(text).ok_or_else(|| self.lines.syntax(format!("{text:?} is no finite number")))
    }

    /// Stated record count and record form of a `2C` or `3C` header.
    fn block_header(&mut self) -> Result<(usize, Form), ReadError> {
        let line = self.current()?;
        let count = field(&line, 24, 36)
            .parse()
            .map_err(|_| self.lines.syntax("the block header states no record count"))?;
        Ok((count, self.form(field(&line, 73, 74))?))
    }

    fn form(&self, digit: &str) -> Result<Form, ReadError> {
        Form::of(digit).ok_or_else(|| self.lines.syntax("the block header has no format digit"))
    }

    fn node_block(&mut self) -> Result<(), ReadError> {
        let (stated, form) = self.block_header()?;
        if let Form::Binary(precision) = form {
            return frd_binary::nodes(&mut self.lines, stated, precision, &mut self.geometry);
        }
        let mut found = 0;
        loop {
            let line = self.line("the end of the node block")?;
            match field(&line, 0, 3) {
                "-1" => {
                    let (id, at) = self.number(&line, form)?;
                    let position = self.vector(&line, at)?;
                    if self.geometry.nodes.insert(id, position).is_some() {
                        return Err(self.lines.syntax(format!("node {id} appears twice")));
                    }
                    found += 1;
                }
                "-3" => return self.counted("nodes", found, stated),
                _ => return Err(self.lines.syntax("no node record")),
            }
        }
    }

    fn element_block(&mut self) -> Result<(), ReadError> {
        let (stated, form) = self.block_header()?;
        if let Form::Binary(_) = form {
            return frd_binary::elements(&mut self.lines, stated, &mut self.geometry);
        }
        let mut found = 0;
        let mut current: Option<RawElement> = None;
        loop {
            let line = self.line("the end of the element block")?;
            match field(&line, 0, 3) {
                "-1" => {
                    self.keep(current.take())?;
                    current = Some(self.element_head(&line, form)?);
                    found += 1;
                }
                "-2" => {
                    let element = current
                        .as_mut()
                        .ok_or_else(|| self.lines.syntax("nodes of no element"))?;
                    self.element_nodes(&line, form, element)?;
                }
                "-3" => {
                    self.keep(current.take())?;
                    return self.counted("elements", found, stated);
                }
                _ => return Err(self.lines.syntax("no element record")),
            }
        }
    }

    fn element_head(&self, line: &str, form: Form) -> Result<RawElement, ReadError> {
        let (id, at) = self.number(line, form)?;
        let number = field(line, at, at + 5);
        let kind = number.parse().ok().and_then(element::of_frd_type);
        let unknown = || {
            self.lines
                .syntax(format!("element {id} is of unknown type {number:?}"))
        };
        Ok(RawElement {
            id,
            kind: kind.ok_or_else(unknown)?,
            nodes: Vec::new(),
        })
    }

    fn element_nodes(
        &self,
        line: &str,
        form: Form,
        element: &mut RawElement,
    ) -> Result<(), ReadError> {
        let width = match form {
            Form::Short => 5,
            Form::Long | Form::Binary(_) => 10,
        };
        let mut at = 3;
        while at < line.len() && !field(line, at, line.len()).is_empty() {
            let text = field(line, at, at + width);
            let bad = || self.lines.syntax(format!("{text:?} is no node number"));
            element.nodes.push(text.parse().map_err(|_| bad())?);
            at += width;
        }
        Ok(())
    }

    fn keep(&mut self, element: Option<RawElement>) -> Result<(), ReadError> {
        let Some(mut element) = element else {
            return Ok(());
        };
        let (found, wanted) = (element.nodes.len(), element.kind.node_count());
        if found != wanted {
            let id = element.id;
            let message = format!("element {id} has {found} nodes and needs {wanted}");
            return Err(self.lines.syntax(message));
        }
        element::frd_to_input_order(element.kind, &mut element.nodes);
        self.geometry.elements.push(element);
        Ok(())
    }

    fn result_block(&mut self) -> Result<(), ReadError> {
        let header = self.current()?;
        let parameters = std::mem::take(&mut self.parameters);
        let attribute = self.line("the name of a result block")?;
        if field(&attribute, 0, 3) != "-4" {
            return Err(self.lines.syntax("a result block without a name"));
        }
        let name = field(&attribute, 5, 13).to_owned();
        let modal = parameters.mode.is_some() || field(&header, 56, 58) == MODAL;
        match name.as_str() {
            "DISP" if modal => self.mode([&header, &attribute], &parameters),
            "PDISP" | "DISPI" => Err(self.lines.unsupported(format!(
                "the block {name} holds complex modes; real modes are needed"
            ))),
            _ => self.skip(&name, modal, [&header, &attribute]),
        }
    }

    fn skip(
        &mut self,
        name: &str,
        modal: bool,
        [header, attribute]: [&str; 2],
    ) -> Result<(), ReadError> {
        let kind = if modal { "modal" } else { "static" };
        let note = format!("{kind} results {name} are not used");
        if !self.geometry.notes.contains(&note) {
            self.geometry.notes.push(note);
        }
        let form = Form::of(field(header, 73, 75));
        if let Some(form @ Form::Binary(precision)) = form {
            let stated = self.stated(header)?;
            let components = self.stored_components(attribute, form)?.len();
            return frd_binary::skip(&mut self.lines, stated, components, precision);
        }
        while field(&self.line("the end of a result block")?, 0, 3) != "-3" {}
        Ok(())
    }

    fn mode(
        &mut self,
        [header, attribute]: [&str; 2],
        parameters: &Parameters,
    ) -> Result<(), ReadError> {
        let stated = self.stated(header)?;
        let form = self.form(field(header, 73, 75))?;
        let frequency_hz = self.parameter_value(field(header, 12, 24))?;
        self.components(attribute, form)?;
        let displacement = match form {
            Form::Binary(precision) => {
                frd_binary::displacements(&mut self.lines, stated, precision, &mut self.table)?
            }
            _ => self.displacements(stated, form)?,
        };
        let next = u32::try_from(self.table.modes.len() + 1).unwrap_or(u32::MAX);
        let index = parameters.mode.unwrap_or(next);
        if self.table.modes.iter().any(|mode| mode.index == index) {
            return Err(self.lines.unsupported(format!(
                "mode {index} comes twice, as after two *FREQUENCY steps; keep one step"
            )));
        }
        // For a negative eigenvalue the stiffness is written as zero.
        let eigenvalue = match (
            parameters.generalised_stiffness,
            parameters.generalised_mass,
        ) {
            (Some(stiffness), Some(mass)) if mass > 0.0 => Some(stiffness / mass),
            _ => None,
        };
        self.table.modes.push(RawMode {
            index,
            frequency_hz,
            eigenvalue,
            generalised_mass: parameters.generalised_mass,
            displacement,
            rotation: None,
            participation: None,
        });
        Ok(())
    }

    fn stated(&self, header: &str) -> Result<usize, ReadError> {
        field(header, 24, 36).parse().map_err(|_| {
            self.lines
                .syntax("the result header states no record count")
        })
    }

    /// Names of the components that are stored, not to be computed.
    ///
    /// The attribute line counts them all; in binary files values begin right
    /// behind the last, in text a line of another kind ends them.
    fn stored_components(
        &mut self,
        attribute: &str,
        form: Form,
    ) -> Result<Vec<String>, ReadError> {
        let count: Option<usize> = field(attribute, 13, 18).parse().ok();
        let count = count.filter(|_| matches!(form, Form::Binary(_)));
        let mut stored = Vec::new();
        for k in 0.. {
            if count.is_some_and(|count| k == count) {
                break;
            }
            let line = self.line("the components of a result")?;
            if field(&line, 0, 3) != "-5" {
                self.lines.step_back();
                break;
            }
            if field(&line, 33, 38) != "1" {
                stored.push(field(&line, 5, 13).to_owned());
            }
        }
        Ok(stored)
    }

    /// Checks that the stored components are the displacements.
    fn components(&mut self, attribute: &str, form: Form) -> Result<(), ReadError> {
        let stored = self.stored_components(attribute, form)?;
        if stored == ["D1", "D2", "D3"] {
            return Ok(());
        }
        Err(self
            .lines
            .syntax(format!("components {stored:?} where D1, D2, D3 are needed")))
    }

    fn displacements(&mut self, stated: usize, form: Form) -> Result<Vec<Vec3>, ReadError> {
        let mut shape = ShapeBuilder::default();
        let mut found = 0;
        loop {
            let line = self.line("the end of a mode")?;
            match field(&line, 0, 3) {
                "-1" => {
                    let (id, at) = self.number(&line, form)?;
                    let value = self.vector(&line, at)?;
                    let added = self.table.add(&mut shape, id, value);
                    added.map_err(|message| self.lines.syntax(message))?;
                    found += 1;
                }
                "-3" => {
                    self.counted("displacements", found, stated)?;
                    let finished = self.table.finish(shape);
                    return finished.map_err(|message| self.lines.syntax(message));
                }
                _ => return Err(self.lines.syntax("no displacement record")),
            }
        }
    }

    /// Number of a `-1` record and the column after it.
    fn number(&self, line: &str, form: Form) -> Result<(u64, usize), ReadError> {
        let end = match form {
            Form::Short => 8,
            Form::Long | Form::Binary(_) => 13,
        };
        let text = field(line, 3, end);
        match text.parse() {
            Ok(id) => Ok((id, end)),
            Err(_) => Err(self
                .lines
                .syntax(format!("{text:?} is no node or element number"))),
        }
    }

    /// Three reals of twelve columns.
    fn vector(&self, line: &str, at: usize) -> Result<Vec3, ReadError> {
        let mut vector = Vec3::zeros();
        for axis in 0..3 {
            let text = field(line, at + 12 * axis, at + 12 * (axis + 1));
            vector[axis] = real(text)
                .ok_or_else(|| self.lines.syntax(format!("{text:?} is no finite number")))?;
        }
        Ok(vector)
    }

    fn counted(
        &self,
        what: &'static str,
        found: usize,
        stated: usize,
    ) -> Result<(), ReadError> {
        if found == stated {
            return Ok(());
        }
        let (file, line) = (self.lines.name(), self.lines.number());
        Err(ReadError::Count {
            file,
            line,
            what,
            found,
            stated,
        })
    }
}
