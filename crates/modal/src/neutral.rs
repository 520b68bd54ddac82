//! The neutral modal file: JSON, schema `fladder.structure/1`.
//!
//! ```json
//! {"schema": "fladder.structure/1",
//!  "nodes": [{"id": 1, "position": [0.0, 0.0, 0.0]}],
//!  "elements": [{"id": 1, "kind": "quad8", "nodes": [1, 2, 3, 4, 5, 6, 7, 8]}],
//!  "element_sets": {"SKIN": [1]},
//!  "node_sets": {"TIP": [7]},
//!  "modes": [{"index": 1, "frequency_hz": 7.7, "generalised_mass": 1.0,
//!             "displacement": [[0.0, 0.0, 1.0]]}],
//!  "mass_properties": {"mass": 17.9, "cg": [0.66, 0.0, 0.0],
//!                      "inertia": {"xx": 1.0, "yy": 1.3, "zz": 2.2, "xz": 0.0}}}
//! ```
//!
//! `displacement`, and `rotation` where it is given, hold one vector a node in
//! the order of `nodes`. `eigenvalue` (λ in (rad/s)²) is optional and may be
//! negative; without it λ = (2π f)². `generalised_mass` is 1 where it is left
//! out. `participation` holds the factors of the three translations. Elements,
//! sets and mass properties are optional. Units and axes are those of the case
//! file's `structure.units` and `structure.axes`. Unknown keys are refused.
//! Kinds: `point`, `line2`, `line3`, `tri3`, `tri6`, `quad4`, `quad8`, `tet4`,
//! `tet10`, `wedge6`, `wedge15`, `hex8`, `hex20`; node order as in Abaqus input.

use crate::element::ElementKind;
use crate::error::ReadError;
use crate::raw::{Geometry, ModeTable, RawElement, RawMode, ShapeBuilder};
use crate::result::{ModalResult, Mode, NamedSet};
use crate::rigid::RigidBody;
use crate::text;
use fladder_mesh::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// Value of the key `schema`.
pub const SCHEMA: &str = "fladder.structure/1";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: String,
    nodes: Vec<FileNode>,
    #[serde(default)]
    elements: Vec<FileElement>,
    #[serde(default)]
    element_sets: BTreeMap<String, Vec<u64>>,
    #[serde(default)]
    node_sets: BTreeMap<String, Vec<u64>>,
    modes: Vec<FileMode>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mass_properties: Option<RigidBody>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileNode {
    id: u64,
    position: Vec3,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileElement {
    id: u64,
    kind: String,
    nodes: Vec<u64>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileMode {
    index: u32,
    frequency_hz: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    eigenvalue: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    generalised_mass: Option<f64>,
    displacement: Vec<Vec3>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rotation: Option<Vec<Vec3>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    participation: Option<Vec3>,
}

/// Reads a neutral file.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let name = path.display().to_string();
    let file: File = serde_json::from_reader(text::open(path)?).map_err(|error| {
        let (file, line) = (name.clone(), error.line());
        let cut = error.io_error_kind() == Some(io::ErrorKind::UnexpectedEof);
        if cut || error.is_eof() {
            ReadError::Truncated {
                file,
                line,
                missing: "the end of the JSON text".to_owned(),
            }
        } else if error.is_io() {
            ReadError::Io {
                file,
                source: error.into(),
            }
        } else {
            ReadError::Syntax {
                file,
                line,
                message: error.to_string(),
            }
        }
    })?;
    convert(file).map_err(|message| ReadError::Mismatch {
        file: name,
        message,
    })
}

fn convert(file: File) -> Result<(Geometry, ModeTable), String> {
    if file.schema != SCHEMA {
        return Err(format!(
            "schema {:?} where {SCHEMA:?} is needed",
            file.schema
        ));
    }
    let mut geometry = Geometry {
        element_sets: file.element_sets,
        node_sets: file.node_sets,
        ..Geometry::default()
    };
    let order: Vec<u64> = file.nodes.iter().map(|node| node.id).collect();
    for node in file.nodes {
        if geometry.nodes.insert(node.id, node.position).is_some() {
            return Err(format!("node {} appears twice", node.id));
        }
    }
    for element in file.elements {
        geometry.elements.push(convert_element(element)?);
    }
    let mut table = ModeTable::default();
    table.stated_mass = file.mass_properties;
    for mode in file.modes {
        add_mode(&mut table, &order, mode)?;
    }
    Ok((geometry, table))
}

fn convert_element(element: FileElement) -> Result<RawElement, String> {
    let FileElement { id, kind, nodes } = element;
    let kind = ElementKind::from_name(&kind)
        .ok_or_else(|| format!("element {id} is of unknown kind {kind:?}"))?;
    let (found, wanted) = (nodes.len(), kind.node_count());
    if found != wanted {
        return Err(format!("element {id} has {found} nodes and needs {wanted}"));
    }
    Ok(RawElement { id, kind, nodes })
}

fn add_mode(table: &mut ModeTable, order: &[u64], mode: FileMode) -> Result<(), String> {
    let index = mode.index;
    let lengths = [Some(&mode.displacement), mode.rotation.as_ref()];
    for values in lengths.into_iter().flatten() {
        if values.len() != order.len() {
            let (found, nodes) = (values.len(), order.len());
            return Err(format!("mode {index} has {found} vectors on {nodes} nodes"));
        }
    }
    let mut shape = ShapeBuilder::default();
    for (id, value) in order.iter().zip(&mode.displacement) {
        table.add(&mut shape, *id, *value)?;
    }
    let displacement = table.finish(shape)?;
    table.modes.push(RawMode {
        index,
        frequency_hz: mode.frequency_hz,
        eigenvalue: mode.eigenvalue,
        generalised_mass: mode.generalised_mass,
        displacement,
        rotation: mode.rotation,
        participation: mode.participation,
    });
    Ok(())
}

/// Writes a result as a neutral file.
///
/// # Errors
/// Those of the writer.
pub fn write(result: &ModalResult, to: impl io::Write) -> io::Result<()> {
    let file = File {
        schema: SCHEMA.to_owned(),
        nodes: result
            .nodes
            .iter()
            .map(|node| FileNode {
                id: node.id,
                position: node.position,
            })
            .collect(),
        elements: result
            .elements
            .iter()
            .map(|element| FileElement {
                id: element.id,
                kind: element.kind.name().to_owned(),
                nodes: element
                    .nodes
                    .iter()
                    .map(|n| result.nodes[*n as usize].id)
                    .collect(),
            })
            .collect(),
        element_sets: named(&result.element_sets, |e| result.elements[e as usize].id),
        node_sets: named(&result.node_sets, |n| result.nodes[n as usize].id),
        modes: result.modes.iter().map(file_mode).collect(),
        mass_properties: result.stated_mass,
    };
    serde_json::to_writer(to, &file).map_err(io::Error::from)
}

fn file_mode(mode: &Mode) -> FileMode {
    FileMode {
        index: mode.index,
        frequency_hz: mode.frequency_hz,
        eigenvalue: Some(mode.eigenvalue),
        generalised_mass: Some(mode.generalised_mass),
        displacement: mode.displacement.clone(),
        rotation: mode.rotation.clone(),
        participation: mode.participation,
    }
}

fn named(sets: &[NamedSet], id: impl Fn(u32) -> u64) -> BTreeMap<String, Vec<u64>> {
    sets.iter()
        .map(|set| {
            (
                set.name.clone(),
                set.members.iter().map(|member| id(*member)).collect(),
            )
        })
        .collect()
}
