//! One entry for every format: reads the result, its geometry and its
//! eigenvalues, and puts them together.

use crate::error::ReadError;
use crate::format::{self, Content, Format};
use crate::nastran::{bulk, f06, op2, op4_modes, pch};
use crate::raw::{Geometry, ModeTable, RawElement, RawMode};
use crate::result::{Element, ModalResult, Mode, NamedSet, Node};
use crate::{dat, frd, inp, msh, neutral, unv};
use fladder_mesh::Vec3;
use nalgebra::Matrix3;
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// Largest distance between a node's positions in two files, relative to the
/// diagonal of the structure: `.frd` positions have six digits.
const POSITION_TOLERANCE: f64 = 2e-5;

/// Reads a modal result.
///
/// `geometry` names the file with nodes, elements and sets where the result
/// lacks them (CalculiX: the `.inp` file, the only one with element sets).
/// Beside a `.frd` file the `.dat` file of the same stem is read where it
/// exists: its eigenvalues have more digits.
///
/// # Errors
/// [`ReadError`] for files that cannot be read, are cut short, damaged, or do
/// not belong together.
pub fn read_structure(
    file: &Path,
    geometry: Option<&Path>,
    format: Option<Format>,
) -> Result<ModalResult, ReadError> {
    let format = match format {
        Some(format) => format,
        None => format::detect(file)?,
    };
    let (own, mut table) = read_format(file, format)?;
    let mut notes = Vec::new();
    if format == Format::CalculixFrd {
        match eigenvalue_file(file) {
            Some(path) => {
                let tables = dat::read(&path)?;
                dat::refine(&mut table, &tables, &path)?;
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                notes.push(format!("eigenvalues are taken from {name}"));
            }
            None => notes.push(
                "no .dat file of the same name: frequencies have the six digits of the .frd file"
                    .to_owned(),
            ),
        }
    }
    let beside = geometry
        .is_none()
        .then(|| input_file(file))
        .flatten()
        .filter(|_| own.nodes.is_empty());
    if let Some(path) = &beside {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        notes.push(format!("nodes and elements are taken from {name}"));
    }
    let given = geometry.or(beside.as_deref());
    let given = given.map(read_geometry).transpose()?;
    if format == Format::NastranOp4 {
        op4_modes::number(&mut table, given.as_ref(), file)?;
    }
    Assembly {
        file: file.display().to_string(),
        format,
        notes,
    }
    .assemble(own, given, table)
}

/// Reads a file with nodes, elements and sets alone.
fn read_geometry(path: &Path) -> Result<Geometry, ReadError> {
    match format::content(path) {
        Ok(Content::Input) => inp::read(path),
        Ok(Content::Bulk) => bulk::read(path),
        Ok(Content::Result(format)) => {
            let (geometry, _) = read_format(path, format)?;
            if geometry.nodes.is_empty() {
                return Err(ReadError::Unsupported {
                    file: path.display().to_string(),
                    what: format!("a {} file without nodes gives no geometry", format.name()),
                });
            }
            Ok(geometry)
        }
        Err(ReadError::UnknownFormat { file, start }) => {
            Err(ReadError::UnknownGeometry { file, start })
        }
        Err(error) => Err(error),
    }
}

/// Geometry and modes as far as a file has them.
pub(crate) fn read_format(
    file: &Path,
    format: Format,
) -> Result<(Geometry, ModeTable), ReadError> {
    match format {
        Format::CalculixFrd => frd::read(file),
        Format::Neutral => neutral::read(file),
        Format::NastranPunch => pch::read(file),
        Format::NastranF06 => f06::read(file),
        Format::NastranOp2 => op2::read(file),
        Format::NastranOp4 => op4_modes::read(file),
        Format::Universal => unv::read(file),
        Format::Gmsh => msh::read(file),
    }
}

/// The `.dat` file beside a `.frd` file.
fn eigenvalue_file(file: &Path) -> Option<PathBuf> {
    beside(file, &["dat"]).next()
}

/// The input beside a result that has no nodes of its own.
fn input_file(file: &Path) -> Option<PathBuf> {
    beside(file, &["bdf", "nas", "dat", "inp"])
        .find(|path| matches!(format::content(path), Ok(Content::Bulk | Content::Input)))
}

/// Files of the same stem, plain or gzipped.
fn beside<'a>(file: &Path, endings: &'a [&'a str]) -> impl Iterator<Item = PathBuf> + 'a {
    let unzipped = match file.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("gz") => file.with_extension(""),
        _ => file.to_owned(),
    };
    endings
        .iter()
        .flat_map(move |ending| {
            [
                unzipped.with_extension(ending),
                unzipped.with_extension(format!("{ending}.gz")),
            ]
        })
        .filter(|path| path.is_file())
}

struct Assembly {
    file: String,
    format: Format,
    notes: Vec<String>,
}

impl Assembly {
    fn assemble(
        mut self,
        own: Geometry,
        given: Option<Geometry>,
        table: ModeTable,
    ) -> Result<ModalResult, ReadError> {
        if table.modes.is_empty() {
            return Err(self.mismatch(
                "it holds no mode; write the shapes of a modal analysis into it, or give it as \
                 structure.geometry (--geometry) beside the file that has them",
            ));
        }
        if own.nodes.is_empty() && given.is_none() {
            return Err(self.mismatch(
                "it has modes but no nodes; name the file that has them as structure.geometry \
                 (--geometry)",
            ));
        }
        self.notes.extend(own.notes.iter().cloned());
        let geometry = match given {
            Some(given) => {
                self.notes.extend(given.notes.iter().cloned());
                self.same_nodes(&own, &given, &table.order)?;
                given
            }
            None => own,
        };
        let (nodes, place) = self.nodes(&geometry, &table.order)?;
        let (elements, element_place) = self.elements(&geometry, &place)?;
        let element_sets = sets(&geometry.element_sets, &element_place);
        let node_sets = sets(&geometry.node_sets, &place);
        let reorder: Vec<usize> = {
            let row: HashMap<u64, usize> = table
                .order
                .iter()
                .enumerate()
                .map(|(row, id)| (*id, row))
                .collect();
            nodes.iter().map(|node| row[&node.id]).collect()
        };
        let stated_mass = table.stated_mass;
        let mut modes = self.modes(table.modes, &reorder)?;
        if table.in_local_axes {
            self.turn_to_basic_axes(&mut modes, &nodes, &geometry.local_axes);
        }
        let Self { format, notes, .. } = self;
        Ok(ModalResult {
            format,
            nodes,
            elements,
            element_sets,
            node_sets,
            modes,
            stated_mass,
            notes,
        })
    }

    /// Both files must place the nodes that carry displacements alike.
    fn same_nodes(
        &self,
        own: &Geometry,
        given: &Geometry,
        used: &[u64],
    ) -> Result<(), ReadError> {
        let size = diagonal(given.nodes.values());
        for id in used {
            let Some(position) = given.nodes.get(id) else {
                return Err(self.mismatch(format!(
                    "node {id} has displacements but is not in the geometry file{}",
                    if self.format == Format::CalculixFrd {
                        "; CalculiX numbers nodes anew unless results are written with OUTPUT=2D"
                    } else {
                        ""
                    }
                )));
            };
            let Some(other) = own.nodes.get(id) else {
                continue;
            };
            let distance = (position - other).norm();
            if distance > POSITION_TOLERANCE * size {
                return Err(self.mismatch(format!(
                    "node {id} lies {distance:e} away from its place in the geometry file \
                     (limit {:e})",
                    POSITION_TOLERANCE * size
                )));
            }
        }
        Ok(())
    }

    fn nodes(
        &mut self,
        geometry: &Geometry,
        used: &[u64],
    ) -> Result<(Vec<Node>, HashMap<u64, u32>), ReadError> {
        let mut ids = used.to_vec();
        ids.sort_unstable();
        let mut nodes = Vec::with_capacity(ids.len());
        for id in ids {
            let position = geometry.nodes.get(&id).ok_or_else(|| {
                self.mismatch(format!("node {id} has displacements but no position"))
            })?;
            nodes.push(Node {
                id,
                position: *position,
            });
        }
        let place: HashMap<u64, u32> = nodes
            .iter()
            .enumerate()
            .map(|(k, node)| (node.id, k as u32))
            .collect();
        let without: Vec<u64> = geometry
            .nodes
            .keys()
            .filter(|id| !place.contains_key(id))
            .copied()
            .collect();
        if !without.is_empty() {
            self.notes.push(format!(
                "{} nodes carry no displacements and are left out: {}",
                without.len(),
                ranges(&without)
            ));
        }
        Ok((nodes, place))
    }

    fn elements(
        &mut self,
        geometry: &Geometry,
        place: &HashMap<u64, u32>,
    ) -> Result<(Vec<Element>, HashMap<u64, u32>), ReadError> {
        let mut elements = Vec::with_capacity(geometry.elements.len());
        let mut by_id = HashMap::new();
        let mut dropped = Vec::new();
        for RawElement { id, kind, nodes } in &geometry.elements {
            if let Some(unknown) = nodes.iter().find(|node| !geometry.nodes.contains_key(node))
            {
                return Err(self.mismatch(format!(
                    "element {id} refers to node {unknown}, which is not there"
                )));
            }
            let indices: Option<Vec<u32>> =
                nodes.iter().map(|node| place.get(node).copied()).collect();
            let Some(nodes) = indices else {
                dropped.push(*id);
                continue;
            };
            if by_id.insert(*id, elements.len() as u32).is_some() {
                return Err(self.mismatch(format!("element {id} appears twice")));
            }
            elements.push(Element {
                id: *id,
                kind: *kind,
                nodes,
            });
        }
        if !dropped.is_empty() {
            dropped.sort_unstable();
            self.notes.push(format!(
                "{} elements with nodes that carry no displacements are left out: {}",
                dropped.len(),
                ranges(&dropped)
            ));
        }
        Ok((elements, by_id))
    }

    fn modes(&mut self, raw: Vec<RawMode>, reorder: &[usize]) -> Result<Vec<Mode>, ReadError> {
        let mut modes = Vec::with_capacity(raw.len());
        let mut without_mass = 0;
        for mode in raw {
            let index = mode.index;
            let generalised_mass = mode.generalised_mass.unwrap_or_else(|| {
                without_mass += 1;
                1.0
            });
            if !(generalised_mass > 0.0 && generalised_mass.is_finite()) {
                return Err(self.mismatch(format!(
                    "mode {index} has the generalised mass {generalised_mass:e}, which must be \
                     positive"
                )));
            }
            if mode.frequency_hz < 0.0 {
                let frequency = mode.frequency_hz;
                return Err(self.mismatch(format!("mode {index} has {frequency} Hz")));
            }
            if mode.displacement.iter().all(|u| u.norm() == 0.0) {
                return Err(self.mismatch(format!("mode {index} is zero at every node")));
            }
            let from_frequency = (TAU * mode.frequency_hz).powi(2);
            let eigenvalue = mode.eigenvalue.unwrap_or(from_frequency);
            let take = |values: &[Vec3]| reorder.iter().map(|row| values[*row]).collect();
            modes.push(Mode {
                index,
                frequency_hz: mode.frequency_hz,
                eigenvalue,
                generalised_mass,
                generalised_stiffness: eigenvalue * generalised_mass,
                displacement: take(&mode.displacement),
                rotation: mode.rotation.as_deref().map(take),
                participation: mode.participation,
            });
        }
        if without_mass > 0 {
            self.notes.push(format!(
                "{without_mass} modes come without a generalised mass and count as \
                 mass-normalised"
            ));
        }
        Ok(modes)
    }

    /// Turns displacements and rotations from the axes of their nodes.
    fn turn_to_basic_axes(
        &mut self,
        modes: &mut [Mode],
        nodes: &[Node],
        local_axes: &BTreeMap<u64, Matrix3<f64>>,
    ) {
        let turned: Vec<(usize, &Matrix3<f64>)> = nodes
            .iter()
            .enumerate()
            .filter_map(|(k, node)| Some((k, local_axes.get(&node.id)?)))
            .collect();
        if turned.is_empty() {
            return;
        }
        self.notes.push(format!(
            "displacements of {} nodes are turned from their own axes",
            turned.len()
        ));
        for mode in modes {
            for (k, axes) in &turned {
                mode.displacement[*k] = *axes * mode.displacement[*k];
                if let Some(rotation) = &mut mode.rotation {
                    rotation[*k] = *axes * rotation[*k];
                }
            }
        }
    }

    fn mismatch(&self, message: impl Into<String>) -> ReadError {
        ReadError::Mismatch {
            file: self.file.clone(),
            message: message.into(),
        }
    }
}

fn sets(named: &BTreeMap<String, Vec<u64>>, place: &HashMap<u64, u32>) -> Vec<NamedSet> {
    named
        .iter()
        .map(|(name, ids)| {
            let mut members: Vec<u32> =
                ids.iter().filter_map(|id| place.get(id).copied()).collect();
            members.sort_unstable();
            members.dedup();
            NamedSet {
                name: name.clone(),
                members,
            }
        })
        .collect()
}

/// Length of the diagonal of the bounding box.
pub(crate) fn diagonal<'a>(points: impl Iterator<Item = &'a Vec3>) -> f64 {
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for point in points {
        low = low.inf(point);
        high = high.sup(point);
    }
    if low.x > high.x {
        0.0
    } else {
        (high - low).norm()
    }
}

/// Ascending numbers as ranges, the first few of them.
pub(crate) fn ranges(ids: &[u64]) -> String {
    const SHOWN: usize = 6;
    let mut runs: Vec<(u64, u64)> = Vec::new();
    for id in ids {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == *id => *last = *id,
            _ => runs.push((*id, *id)),
        }
    }
    let text: Vec<String> = runs
        .iter()
        .take(SHOWN)
        .map(|(a, b)| {
            if a == b {
                a.to_string()
            } else {
                format!("{a}-{b}")
            }
        })
        .collect();
    let more = if runs.len() > SHOWN { ", …" } else { "" };
    format!("{}{more}", text.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_numbers_are_shown_as_ranges() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1-3, 7, 9-10");
        assert_eq!(ranges(&[1, 3, 5, 7, 9, 11, 13]), "1, 3, 5, 7, 9, 11, …");
    }
}
