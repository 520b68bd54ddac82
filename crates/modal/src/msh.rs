//! Gmsh `.msh` files with node data: versions 2 and 4.1, ASCII and binary.
//!
//! Each `$NodeData` of three components is a mode, in the order of the file.
//! Its frequency in Hz is the number before `Hz` in its name (`mode 3, 12.5
//! Hz`) and else its time value. The format has no generalised masses.
//! Physical groups are element sets. Gmsh manual, "MSH file format".

use crate::element::ElementKind;
use crate::error::ReadError;
use crate::msh_scanner::Scanner;
use crate::raw::{Geometry, ModeBuilder, ModeTable, RawElement};
use crate::text::real;
use fladder_mesh::Vec3;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

struct Reader {
    scanner: Scanner,
    is_version_4: bool,
    geometry: Geometry,
    table: ModeTable,
    /// Names of physical groups by dimension and tag.
    names: HashMap<(i32, i32), String>,
    /// Physical groups of an entity, by dimension and tag.
    groups: HashMap<(i32, i32), Vec<i32>>,
    passed_over: BTreeSet<i32>,
}

/// Reads nodes, elements and node data.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let mut reader = Reader {
        scanner: Scanner::open(path)?,
        is_version_4: false,
        geometry: Geometry::default(),
        table: ModeTable::default(),
        names: HashMap::new(),
        groups: HashMap::new(),
        passed_over: BTreeSet::new(),
    };
    while let Some(name) = reader.scanner.section()? {
        reader.section(&name)?;
        reader.scanner.end_of(&name)?;
    }
    reader.finish()
}

impl Reader {
    fn section(&mut self, name: &str) -> Result<(), ReadError> {
        match name {
            "MeshFormat" => self.format(),
            "PhysicalNames" => self.physical_names(),
            "Entities" => self.entities(),
            "Nodes" if self.is_version_4 => self.nodes_4(),
            "Nodes" => self.nodes_2(),
            "Elements" if self.is_version_4 => self.elements_4(),
            "Elements" => self.elements_2(),
            "NodeData" => self.node_data(),
            _ => Ok(()),
        }
    }

    fn format(&mut self) -> Result<(), ReadError> {
        let version = self.scanner.word()?;
        let kind = self.scanner.word()?;
        let size = self.scanner.word()?;
        self.is_version_4 = match version.as_str() {
            "4.1" => true,
            _ if version.starts_with('2') => false,
            _ => {
                return Err(self.scanner.unsupported(format!(
                    "it is of Gmsh's format {version}; save it as 4.1 or 2.2"
                )));
            }
        };
        if kind == "1" {
            if size != "8" {
                let what = format!("numbers have {size} bytes, where 8 are read");
                return Err(self.scanner.unsupported(what));
            }
            self.scanner.begin_binary()?;
        }
        Ok(())
    }

    fn physical_names(&mut self) -> Result<(), ReadError> {
        for _ in 0..self.scanner.text_int()? {
            let (dimension, tag) = (self.scanner.text_int()?, self.scanner.text_int()?);
            let name = self.scanner.quoted()?;
            self.names.insert((dimension as i32, tag as i32), name);
        }
        Ok(())
    }

    fn entities(&mut self) -> Result<(), ReadError> {
        if !self.is_version_4 {
            return Ok(());
        }
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = self.scanner.size()?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = self.scanner.int()?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    self.scanner.double()?;
                }
                for _ in 0..self.scanner.size()? {
                    let group = self.scanner.int()?;
                    self.groups.entry((dimension, tag)).or_default().push(group);
                }
                if dimension > 0 {
                    for _ in 0..self.scanner.size()? {
                        self.scanner.int()?;
                    }
                }
            }
        }
        Ok(())
    }

    fn node(&mut self, id: u64) -> Result<(), ReadError> {
        let mut place = Vec3::zeros();
        for axis in 0..3 {
            place[axis] = self.scanner.double()?;
        }
        match self.geometry.nodes.insert(id, place) {
            Some(_) => Err(self.scanner.wrong(format!("node {id} appears twice"))),
            None => Ok(()),
        }
    }

    fn nodes_2(&mut self) -> Result<(), ReadError> {
        for _ in 0..self.scanner.text_int()? {
            let id = self.scanner.id()?;
            self.node(id)?;
        }
        Ok(())
    }

    fn nodes_4(&mut self) -> Result<(), ReadError> {
        let blocks = self.scanner.size()?;
        for _ in 0..3 {
            self.scanner.size()?;
        }
        for _ in 0..blocks {
            let (dimension, _) = (self.scanner.int()?, self.scanner.int()?);
            let parameters = if self.scanner.int()? == 0 {
                0
            } else {
                dimension
            };
            let mut ids = Vec::new();
            for _ in 0..self.scanner.size()? {
                ids.push(self.scanner.size()?);
            }
            for id in ids {
                self.node(id)?;
                for _ in 0..parameters {
                    self.scanner.double()?;
                }
            }
        }
        Ok(())
    }

    fn elements_2(&mut self) -> Result<(), ReadError> {
        let mut left = self.scanner.text_int()?;
        while left > 0 {
            // In text every element is a block of its own, its number first.
            let mut first = None;
            if !self.scanner.is_binary() {
                first = Some(self.scanner.id()?);
            }
            let kind = self.scanner.int()?;
            let count = if self.scanner.is_binary() {
                i64::from(self.scanner.int()?)
            } else {
                1
            };
            let tags = self.scanner.int()?;
            if count < 1 || count > left {
                return Err(self.scanner.wrong(format!("a block of {count} elements")));
            }
            for _ in 0..count {
                let id = match first {
                    Some(id) => id,
                    None => self.scanner.id()?,
                };
                let mut group = None;
                for _ in 0..tags {
                    let tag = self.scanner.int()?;
                    group = group.or(Some(tag));
                }
                let groups: Vec<i32> = group.into_iter().filter(|tag| *tag != 0).collect();
                self.element(id, kind, &groups)?;
            }
            left -= count;
        }
        Ok(())
    }

    fn elements_4(&mut self) -> Result<(), ReadError> {
        let blocks = self.scanner.size()?;
        for _ in 0..3 {
            self.scanner.size()?;
        }
        for _ in 0..blocks {
            let (dimension, entity) = (self.scanner.int()?, self.scanner.int()?);
            let kind = self.scanner.int()?;
            let groups = self.groups.get(&(dimension, entity)).cloned();
            let groups = groups.unwrap_or_default();
            for _ in 0..self.scanner.size()? {
                let id = self.scanner.size()?;
                self.element(id, kind, &groups)?;
            }
        }
        Ok(())
    }

    fn element(&mut self, id: u64, number: i32, groups: &[i32]) -> Result<(), ReadError> {
        let Some((kind, count)) = shape(number) else {
            return Err(self.scanner.unsupported(format!(
                "element {id} is of Gmsh's type {number}, which is not read; export elements of \
                 first or second order"
            )));
        };
        let mut nodes = Vec::with_capacity(count);
        for _ in 0..count {
            nodes.push(if self.is_version_4 {
                self.scanner.size()?
            } else {
                self.scanner.id()?
            });
        }
        let Some(kind) = kind else {
            self.passed_over.insert(number);
            return Ok(());
        };
        let nodes = order(kind).iter().map(|place| nodes[*place]).collect();
        self.geometry.elements.push(RawElement { id, kind, nodes });
        let dimension = dimension(kind);
        for group in groups {
            let name = self.names.get(&(dimension, *group)).cloned();
            let name = name.unwrap_or_else(|| format!("physical_{group}"));
            self.geometry.element_sets.entry(name).or_default().push(id);
        }
        Ok(())
    }

    fn node_data(&mut self) -> Result<(), ReadError> {
        let mut name = String::new();
        for k in 0..self.scanner.text_int()? {
            let text = self.scanner.quoted()?;
            if k == 0 {
                name = text;
            }
        }
        let mut time = 0.0;
        for k in 0..self.scanner.text_int()? {
            let value = self.scanner.text_real()?;
            if k == 0 {
                time = value;
            }
        }
        let mut integers = Vec::new();
        for _ in 0..self.scanner.text_int()? {
            integers.push(self.scanner.text_int()?);
        }
        let (Some(&components), Some(&count)) = (integers.get(1), integers.get(2)) else {
            return Err(self
                .scanner
                .wrong("node data without a count of components"));
        };
        if components != 3 {
            let note = format!("node data {name:?} of {components} components are not used");
            self.geometry.notes.push(note);
            for _ in 0..count {
                self.scanner.id()?;
                for _ in 0..components {
                    self.scanner.double()?;
                }
            }
            return Ok(());
        }
        let frequency = frequency_in(&name).unwrap_or(time);
        let index = u32::try_from(self.table.modes.len() + 1).unwrap_or(u32::MAX);
        let mut mode = ModeBuilder::new(index, frequency, None);
        for _ in 0..count {
            let id = self.scanner.id()?;
            let mut value = Vec3::zeros();
            for axis in 0..3 {
                value[axis] = self.scanner.double()?;
            }
            mode.add(&mut self.table, id, value, None)
                .map_err(|message| self.scanner.wrong(message))?;
        }
        mode.finish(&mut self.table, &mut self.geometry.notes)
            .map_err(|message| self.scanner.wrong(message))
    }

    fn finish(mut self) -> Result<(Geometry, ModeTable), ReadError> {
        let modes = &self.table.modes;
        if !modes.is_empty() && modes.iter().all(|mode| mode.frequency_hz == 0.0) {
            return Err(self.scanner.unsupported(
                "no node data has a frequency: give it in Hz as the time value, or in the name as \
                 in \"mode 1, 7.5 Hz\"",
            ));
        }
        if !self.passed_over.is_empty() {
            let types: Vec<i32> = self.passed_over.iter().copied().collect();
            let note = format!("elements of Gmsh's types {types:?} are left out");
            self.geometry.notes.push(note);
        }
        Ok((self.geometry, self.table))
    }
}

/// The number before `Hz`.
fn frequency_in(name: &str) -> Option<f64> {
    let before = &name[..name.find("Hz")?];
    let word = before.split(|c: char| c.is_whitespace() || "=:,;(".contains(c));
    word.rev().find(|word| !word.is_empty()).and_then(real)
}

/// Kind and number of nodes of an element type; no kind for those that carry
/// no face here.
fn shape(number: i32) -> Option<(Option<ElementKind>, usize)> {
    use ElementKind::{
        Hex8, Hex20, Line2, Line3, Point, Quad4, Quad8, Tet4, Tet10, Tri3, Tri6, Wedge6,
        Wedge15,
    };
    let kind = |kind: ElementKind| (Some(kind), kind.node_count());
    Some(match number {
        1 => kind(Line2),
        2 => kind(Tri3),
        3 => kind(Quad4),
        4 => kind(Tet4),
        5 => kind(Hex8),
        6 => kind(Wedge6),
        7 => (None, 5),
        8 => kind(Line3),
        9 => kind(Tri6),
        // The node in the middle of a nine-node face is left out.
        10 => (Some(Quad8), 9),
        11 => kind(Tet10),
        12 => (Some(Hex20), 27),
        13 => (Some(Wedge15), 18),
        14 => (None, 14),
        15 => kind(Point),
        16 => kind(Quad8),
        17 => kind(Hex20),
        18 => kind(Wedge15),
        19 => (None, 13),
        _ => return None,
    })
}

/// Dimension of the entity an element lies on.
fn dimension(kind: ElementKind) -> i32 {
    match kind {
        ElementKind::Point => 0,
        ElementKind::Line2 | ElementKind::Line3 => 1,
        kind if kind.is_shell() => 2,
        _ => 3,
    }
}

/// Places in the file of the nodes in input order.
fn order(kind: ElementKind) -> Vec<usize> {
    match kind {
        ElementKind::Tet10 => vec![0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
        ElementKind::Wedge15 => vec![0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
        ElementKind::Hex20 => vec![
            0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
        ],
        _ => (0..kind.node_count()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_each_node_once() {
        for (kind, count) in (1..20).filter_map(shape) {
            let Some(kind) = kind else { continue };
            let mut order = order(kind);
            order.sort_unstable();
            assert_eq!(order, (0..kind.node_count()).collect::<Vec<_>>());
            assert!(count >= kind.node_count());
        }
    }

    #[test]
    fn frequencies_stand_before_hz() {
        assert_eq!(frequency_in("mode 3, 12.5 Hz"), Some(12.5));
        assert_eq!(frequency_in("f=1.25e1Hz"), Some(12.5));
        assert_eq!(frequency_in("displacement"), None);
    }
}
