//! Everything one file holds, before files are put together: for comparison
//! with other readers, node by node.

use crate::eigenvalues::Eigenvalue;
use crate::error::ReadError;
use crate::format::{self, Content, Format};
use crate::nastran::{bulk, f06};
use crate::raw::{Geometry, ModeTable};
use crate::read::read_format;
use crate::{inp, nastran::op4};
use fladder_mesh::Vec3;
use serde::Serialize;
use std::path::Path;

/// Contents of one file, by the numbers and in the units of that file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FileContents {
    /// Name of the format; `nastran-bulk` and `calculix-inp` for input.
    pub format: String,
    /// Number and place of every node, in basic axes.
    pub nodes: Vec<(u64, Vec3)>,
    /// Number, kind and nodes of every element.
    pub elements: Vec<(u64, &'static str, Vec<u64>)>,
    /// Nodes of the shapes, in their order.
    pub mode_nodes: Vec<u64>,
    /// Modes, in the axes of the file.
    pub modes: Vec<FileMode>,
    /// Eigenvalues of tables apart from shapes.
    pub eigenvalues: Vec<Eigenvalue>,
    /// Matrices.
    pub matrices: Vec<FileMatrix>,
}

/// One mode of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileMode {
    /// Number in the file.
    pub index: u32,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Where the file gives it.
    pub generalised_mass: Option<f64>,
    /// One vector a node of [`FileContents::mode_nodes`].
    pub displacement: Vec<Vec3>,
    /// Where the file has them.
    pub rotation: Option<Vec<Vec3>>,
}

/// One matrix of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileMatrix {
    /// Name in the file.
    pub name: String,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Row, column (from 0), real and imaginary part of what is stored.
    pub entries: Vec<(usize, usize, [f64; 2])>,
}

/// Reads all that a file holds, without any other file but those it includes.
///
/// # Errors
/// [`ReadError`] for a file that cannot be read, is cut short or damaged.
pub fn read_contents(path: &Path) -> Result<FileContents, ReadError> {
    let content = format::content(path)?;
    let mut contents = match content {
        Content::Bulk => of(bulk::read(path)?, ModeTable::default()),
        Content::Input => of(inp::read(path)?, ModeTable::default()),
        Content::Result(Format::NastranOp4) => return matrices(path),
        Content::Result(Format::NastranF06) => {
            let (table, rows) = f06::read_tables(path)?;
            let mut contents = of(Geometry::default(), table);
            contents.eigenvalues = rows;
            contents
        }
        Content::Result(format) => {
            let (geometry, table) = read_format(path, format)?;
            of(geometry, table)
        }
    };
    let name = match content {
        Content::Bulk => "nastran-bulk",
        Content::Input => "calculix-inp",
        Content::Result(format) => format.name(),
    };
    name.clone_into(&mut contents.format);
    Ok(contents)
}

fn of(geometry: Geometry, table: ModeTable) -> FileContents {
    FileContents {
        nodes: geometry.nodes.into_iter().collect(),
        elements: geometry
            .elements
            .into_iter()
            .map(|element| (element.id, element.kind.name(), element.nodes))
            .collect(),
        mode_nodes: table.order,
        modes: table
            .modes
            .into_iter()
            .map(|mode| FileMode {
                index: mode.index,
                frequency_hz: mode.frequency_hz,
                generalised_mass: mode.generalised_mass,
                displacement: mode.displacement,
                rotation: mode.rotation,
            })
            .collect(),
        ..FileContents::default()
    }
}

fn matrices(path: &Path) -> Result<FileContents, ReadError> {
    let matrices = op4::read_op4(path)?;
    Ok(FileContents {
        format: Format::NastranOp4.name().to_owned(),
        matrices: matrices
            .iter()
            .map(|matrix| FileMatrix {
                name: matrix.name.clone(),
                rows: matrix.rows,
                columns: matrix.columns,
                entries: matrix.entries().collect(),
            })
            .collect(),
        ..FileContents::default()
    })
}
