//! Universal files: nodes (15, 2411), elements (2412), groups (2467 and its
//! kin), lines of test geometry (82), modes (55, 2414), all ASCII.
//!
//! A dataset stands between two lines `-1` and begins with its number. Fields
//! have fixed widths: integers 10 columns, reals 13 or 25; they may touch.
//! Parabolic elements list their nodes ring by ring, each corner with the
//! midside node behind it. Of the coordinate systems (18, 2420) only those
//! that are the global one are taken. Modes are real displacements with three
//! or six components a node; dataset 55 has frequency and modal mass in its
//! line 8. A dataset without its closing `-1` is a cut.

use crate::element::ElementKind;
use crate::error::ReadError;
use crate::raw::{Geometry, ModeBuilder, ModeTable, RawElement};
use crate::text::{Lines, field, real};
use crate::{unv_binary, unv_modes};
use fladder_mesh::Vec3;
use std::collections::BTreeSet;
use std::path::Path;

/// Columns of an integer.
pub(crate) const INTEGER: usize = 10;
/// Columns of reals in single and in double precision.
const SINGLE: usize = 13;
const DOUBLE: usize = 25;

/// Elements with a line of orientation before their nodes.
const BEAMS: std::ops::RangeInclusive<i64> = 11..=24;

/// Nodes of a trace line, 0 where the pen is lifted.
type Trace = Vec<u64>;

pub(crate) struct Reader {
    pub(crate) lines: Lines,
    pub(crate) geometry: Geometry,
    pub(crate) table: ModeTable,
    /// Coordinate systems other than the global one that nodes name.
    systems: BTreeSet<u64>,
    /// Coordinate systems that are the global one.
    global: BTreeSet<u64>,
    traces: Vec<Trace>,
    passed_over: BTreeSet<String>,
}

/// Reads nodes, elements, groups and modes, whichever are there.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader {
        lines: Lines::open(path)?,
        geometry: Geometry::default(),
        table: ModeTable::default(),
        systems: BTreeSet::new(),
        global: BTreeSet::new(),
        traces: Vec::new(),
        passed_over: BTreeSet::new(),
    };
    while let Some(line) = reader.lines.next_line()? {
        if line.trim().is_empty() {
            continue;
        }
        if line.trim() != "-1" {
            return Err(reader.lines.syntax("no -1 where a dataset begins"));
        }
        let number = reader.line("the number of a dataset")?;
        reader.dataset(number.trim())?;
    }
    reader.finish()
}

impl Reader {
    fn dataset(&mut self, number: &str) -> Result<(), ReadError> {
        match number {
            "15" => self.nodes(1),
            "2411" | "781" => self.nodes(2),
            "2412" => self.elements(),
            "82" => self.trace_lines(),
            "2467" | "2477" | "2452" | "2435" => self.groups(),
            "18" => self.systems_18(),
            "2420" => self.systems_2420(),
            "55" => unv_modes::dataset_55(self),
            "2414" => unv_modes::dataset_2414(self),
            "164" => self.units(),
            "151" => self.skip(),
            other => {
                let word = other.split_ascii_whitespace().next().unwrap_or("");
                self.passed_over.insert(word.chars().take(10).collect());
                if unv_binary::is_binary(other) {
                    unv_binary::skip(self, other)
                } else {
                    self.skip()
                }
            }
        }
    }

    /// The next line; an error at the end of the file.
    pub(crate) fn line(&mut self, missing: &str) -> Result<String, ReadError> {
        match self.lines.next_line()? {
            Some(line) => Ok(line.to_owned()),
            None => Err(self
                .lines
                .truncated(format!("{missing} (and the -1 that ends a dataset)"))),
        }
    }

    /// The next line of this dataset; `None` at its end.
    pub(crate) fn within(&mut self) -> Result<Option<String>, ReadError> {
        let line = self.line("a line")?;
        Ok((line.trim() != "-1").then_some(line))
    }

    /// Reads to the end of this dataset.
    pub(crate) fn skip(&mut self) -> Result<(), ReadError> {
        while self.within()?.is_some() {}
        Ok(())
    }

    pub(crate) fn integers<const N: usize>(&self, line: &str) -> Result<[i64; N], ReadError> {
        let mut numbers = [0; N];
        for (k, number) in numbers.iter_mut().enumerate() {
            let text = field(line, k * INTEGER, (k + 1) * INTEGER);
            *number = text
                .parse()
                .map_err(|_| self.lines.syntax(format!("{text:?} is no whole number")))?;
        }
        Ok(numbers)
    }

    pub(crate) fn id(&self, number: i64) -> Result<u64, ReadError> {
        u64::try_from(number)
            .ok()
            .filter(|id| *id > 0)
            .ok_or_else(|| {
                self.lines
                    .syntax(format!("{number} numbers no node or element"))
            })
    }

    /// So many reals of a line, between blanks or in fields of that width.
    pub(crate) fn reals(
        &self,
        line: &str,
        count: usize,
        width: usize,
    ) -> Result<Vec<f64>, ReadError> {
        let spaced: Option<Vec<f64>> = line.split_ascii_whitespace().map(real).collect();
        if let Some(values) = spaced.filter(|values| values.len() == count) {
            return Ok(values);
        }
        (0..count)
            .map(|k| {
                let text = field(line, k * width, (k + 1) * width);
                real(text)
                    .ok_or_else(|| self.lines.syntax(format!("{text:?} is no finite number")))
            })
            .collect()
    }

    /// Number, frames of definition and displacement, colour, and three
    /// coordinates in the same line or in the next.
    fn nodes(&mut self, lines: usize) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [id, defined, moved, _] = self.integers(&line)?;
            let coordinates = if lines == 1 {
                let rest = line.get(4 * INTEGER..).unwrap_or("");
                self.reals(rest, 3, SINGLE)?
            } else {
                let line = self.line("the coordinates of a node")?;
                self.reals(&line, 3, DOUBLE)?
            };
            for system in [defined, moved] {
                self.systems.extend(u64::try_from(system).ok());
            }
            let (id, place) = (self.id(id)?, Vec3::from_row_slice(&coordinates));
            if self.geometry.nodes.insert(id, place).is_some() {
                return Err(self.lines.syntax(format!("node {id} appears twice")));
            }
        }
        Ok(())
    }

    /// Number, shape, two properties, colour, count of nodes; a line more for
    /// beams; the nodes, eight a line.
    fn elements(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [id, shape, _, _, _, count] = self.integers(&line)?;
            let mut nodes = Vec::new();
            if BEAMS.contains(&shape) {
                // Rods have the line or not: nodes of a rod are two.
                let line = self.line("the orientation of a beam")?;
                if line.split_ascii_whitespace().count() != 3 {
                    self.list(&line, &mut nodes)?;
                }
            }
            while (nodes.len() as i64) < count {
                let line = self.line("the nodes of an element")?;
                self.list(&line, &mut nodes)?;
            }
            let id = self.id(id)?;
            let Some(kind) = kind(shape) else {
                self.passed_over.insert(format!("element type {shape}"));
                continue;
            };
            if nodes.len() != kind.node_count() {
                return Err(self.lines.syntax(format!(
                    "element {id} has {} nodes and needs {}",
                    nodes.len(),
                    kind.node_count()
                )));
            }
            let order = order(kind);
            let nodes = order.iter().map(|place| nodes[*place]).collect();
            self.geometry.elements.push(RawElement { id, kind, nodes });
        }
        Ok(())
    }

    /// Adds up to eight numbers.
    fn list(&self, line: &str, numbers: &mut Vec<u64>) -> Result<(), ReadError> {
        for k in 0..8 {
            let text = field(line, k * INTEGER, (k + 1) * INTEGER);
            if text.is_empty() {
                return match k {
                    0 => Err(self.lines.syntax("numbers are missing")),
                    _ => Ok(()),
                };
            }
            let number = text.parse();
            numbers.push(
                number
                    .map_err(|_| self.lines.syntax(format!("{text:?} is no whole number")))?,
            );
        }
        Ok(())
    }

    /// Number, count, colour; a name; the nodes, eight a line.
    fn trace_lines(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [_, count, _] = self.integers(&line)?;
            self.line("the name of a trace line")?;
            let mut nodes = Trace::new();
            while (nodes.len() as i64) < count {
                let line = self.line("the nodes of a trace line")?;
                self.list(&line, &mut nodes)?;
            }
            self.traces.push(nodes);
        }
        Ok(())
    }

    /// Number, six more, count; a name; kind (7 node, 8 element), number and
    /// two more of two members a line.
    fn groups(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [_, _, _, _, _, _, _, count] = self.integers(&line)?;
            let name = self.line("the name of a group")?.trim().to_owned();
            let mut left = count;
            while left > 0 {
                let line = self.line("the members of a group")?;
                for from in [0, 4 * INTEGER].into_iter().take(left.min(2) as usize) {
                    let rest = line.get(from..).unwrap_or("");
                    let [kind, number] = self.integers(rest)?;
                    let sets = match kind {
                        7 => &mut self.geometry.node_sets,
                        8 => &mut self.geometry.element_sets,
                        _ => continue,
                    };
                    let id = u64::try_from(number).unwrap_or(0);
                    sets.entry(name.clone()).or_default().push(id);
                }
                left -= 2;
            }
        }
        Ok(())
    }

    /// Number, kind (0 rectangular), frame, colour, method; name; origin and a
    /// point on x; a point in the x–z plane.
    fn systems_18(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.within()? {
            let [id, kind, other, _, _] = self.integers(&line)?;
            self.line("the name of a coordinate system")?;
            let line = self.line("a coordinate system")?;
            let mut values = self.reals(&line, 6, SINGLE)?;
            let line = self.line("a coordinate system")?;
            values.extend(self.reals(&line, 3, SINGLE)?);
            let [origin, x, xz] = [0, 3, 6].map(|k| Vec3::from_row_slice(&values[k..k + 3]));
            let same = kind == 0
                && other == 0
                && origin == Vec3::zeros()
                && x.x > 0.0
                && x.yz() == Vec3::zeros().yz()
                && xz.y == 0.0
                && xz.z > 0.0;
            if same {
                self.global.extend(u64::try_from(id).ok());
            }
        }
        Ok(())
    }

    /// A part and its name; then number, kind, colour; name; three rows of
    /// directions and the origin.
    fn systems_2420(&mut self) -> Result<(), ReadError> {
        let Some(_) = self.within()? else {
            return Ok(());
        };
        self.line("the name of a part")?;
        while let Some(line) = self.within()? {
            let [id, kind, _] = self.integers(&line)?;
            self.line("the name of a coordinate system")?;
            let mut rows = Vec::new();
            for _ in 0..4 {
                let line = self.line("a coordinate system")?;
                rows.extend(self.reals(&line, 3, DOUBLE)?);
            }
            let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
            if kind == 0 && rows == identity {
                self.global.extend(u64::try_from(id).ok());
            }
        }
        Ok(())
    }

    /// The units are the case's matter; their name is shown.
    fn units(&mut self) -> Result<(), ReadError> {
        if let Some(line) = self.within()? {
            let name: String = line.chars().skip(INTEGER).take(20).collect();
            let note = format!("dataset 164 names the units {:?}", name.trim());
            self.geometry.notes.push(note);
            self.skip()?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(Geometry, ModeTable), ReadError> {
        // Systems 0 and 1 are the global one where the file says nothing.
        let foreign = self
            .systems
            .iter()
            .find(|id| **id > 1 && !self.global.contains(*id));
        if let Some(id) = foreign {
            return Err(self.lines.unsupported(format!(
                "nodes are in coordinate system {id}, which is not the global one; write nodes \
                 and displacements in global axes"
            )));
        }
        self.add_traces();
        if !self.passed_over.is_empty() {
            let list: Vec<String> = self.passed_over.iter().take(12).cloned().collect();
            self.geometry.notes.push(format!(
                "datasets and elements not read: {}",
                list.join(", ")
            ));
        }
        Ok((self.geometry, self.table))
    }

    /// Trace lines are bars, numbered behind the elements.
    fn add_traces(&mut self) {
        let mut id = self
            .geometry
            .elements
            .iter()
            .map(|e| e.id)
            .max()
            .unwrap_or(0);
        for pair in self.traces.iter().flat_map(|trace| trace.windows(2)) {
            let there = |id: &u64| self.geometry.nodes.contains_key(id);
            if pair.iter().all(there) && pair[0] != pair[1] && id < u64::MAX {
                id += 1;
                self.geometry.elements.push(RawElement {
                    id,
                    kind: ElementKind::Line2,
                    nodes: pair.to_vec(),
                });
            }
        }
    }

    /// Puts a finished mode into the table.
    pub(crate) fn keep(&mut self, mode: ModeBuilder) -> Result<(), ReadError> {
        mode.finish(&mut self.table, &mut self.geometry.notes)
            .map_err(|message| self.lines.syntax(message))
    }
}

/// Kind of an element by its number in dataset 2412.
fn kind(shape: i64) -> Option<ElementKind> {
    use ElementKind::{
        Hex8, Hex20, Line2, Line3, Point, Quad4, Quad8, Tet4, Tet10, Tri3, Tri6, Wedge6,
        Wedge15,
    };
    Some(match shape {
        11 | 21..=23 | 31 | 121 | 136 | 137 => Line2,
        24 => Line3,
        41 | 51 | 61 | 74 | 81 | 91 => Tri3,
        42 | 52 | 62 | 72 | 82 | 92 => Tri6,
        44 | 54 | 64 | 71 | 84 | 94 => Quad4,
        45 | 55 | 65 | 75 | 85 | 95 => Quad8,
        111 => Tet4,
        118 => Tet10,
        112 => Wedge6,
        113 => Wedge15,
        115 => Hex8,
        116 => Hex20,
        161 => Point,
        _ => return None,
    })
}

/// Places in the file of the nodes in input order.
fn order(kind: ElementKind) -> Vec<usize> {
    match kind {
        ElementKind::Line3 => vec![0, 2, 1],
        ElementKind::Tri6 => vec![0, 2, 4, 1, 3, 5],
        ElementKind::Quad8 => vec![0, 2, 4, 6, 1, 3, 5, 7],
        ElementKind::Tet10 => vec![0, 2, 4, 9, 1, 3, 5, 6, 7, 8],
        ElementKind::Wedge15 => vec![0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8],
        ElementKind::Hex20 => vec![
            0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11,
        ],
        _ => (0..kind.node_count()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_each_node_once() {
        for shape in 0..200 {
            if let Some(kind) = kind(shape) {
                let mut order = order(kind);
                order.sort_unstable();
                assert_eq!(order, (0..kind.node_count()).collect::<Vec<_>>());
            }
        }
    }
}
