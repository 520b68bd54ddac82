//! Modes as matrices of an `.op4` file, over the nodes of a bulk-data file.
//!
//! `PHIG` (or `PHG`, `PHI`) has a column a mode and six rows a node, in
//! ascending order of the node numbers; eigenvalues are the column or row
//! `LAMA` (or `LAMBDA`), or the diagonal of `KHH` over that of `MHH`.
//! Displacements are in each node's own frame, as everywhere in the g-set.

use super::op4::{Op4Matrix, read_op4};
use crate::eigenvalues::frequency_of;
use crate::error::ReadError;
use crate::raw::{Geometry, ModeBuilder, ModeTable};
use fladder_mesh::Vec3;
use std::path::Path;

/// Rows a node.
const NODE: usize = 6;

/// Entries of a matrix of shapes for each one stored: a heading may state any
/// size.
const EMPTINESS: usize = 4;

const SHAPES: [&str; 4] = ["PHIG", "PHG", "PHI", "BPHIG"];
const EIGENVALUES: [&str; 3] = ["LAMA", "LAMBDA", "LAMAS"];

/// Modes over nodes numbered 1, 2, … until [`number`] gives them their numbers.
pub(crate) fn read(path: &Path) -> Result<(Geometry, ModeTable), ReadError> {
    let matrices = read_op4(path)?;
    modes(&matrices)
        .map(|table| (Geometry::default(), table))
        .map_err(|message| ReadError::Mismatch {
            file: path.display().to_string(),
            message,
        })
}

fn named<'a>(matrices: &'a [Op4Matrix], names: &[&str]) -> Option<&'a Op4Matrix> {
    let is = |matrix: &&Op4Matrix| {
        names
            .iter()
            .any(|name| matrix.name.eq_ignore_ascii_case(name))
    };
    matrices.iter().rfind(is)
}

fn modes(matrices: &[Op4Matrix]) -> Result<ModeTable, String> {
    let Some(shapes) = named(matrices, &SHAPES) else {
        let names: Vec<&str> = matrices.iter().map(|m| m.name.as_str()).collect();
        return Err(format!(
            "it has the matrices {}, and none named PHIG with the shapes of modes",
            names.join(", ")
        ));
    };
    if !shapes.rows.is_multiple_of(NODE) {
        let (name, rows) = (&shapes.name, shapes.rows);
        return Err(format!("{name} has {rows} rows, which are no six a node"));
    }
    if shapes.rows.saturating_mul(shapes.columns) > EMPTINESS * shapes.stored() + NODE {
        return Err(format!(
            "{} is stated as {} × {} and holds {} numbers, too few for shapes",
            shapes.name,
            shapes.rows,
            shapes.columns,
            shapes.stored()
        ));
    }
    let eigenvalues = eigenvalues(matrices, shapes.columns)?;
    let complex = || format!("{} is complex; real modes are needed", shapes.name);
    let mut table = ModeTable::in_local_axes();
    if shapes.name.starts_with('B') {
        table.in_local_axes = false;
    }
    let columns = shapes.real_columns().ok_or_else(complex)?;
    for ((index, column), (lambda, mass)) in (1..).zip(columns).zip(eigenvalues) {
        let mut mode =
            ModeBuilder::new(index, frequency_of(lambda), Some(lambda)).with_mass(mass);
        for (id, values) in (1..).zip(column.chunks_exact(NODE)) {
            let rotation = Vec3::from_row_slice(&values[3..]);
            let displacement = Vec3::from_row_slice(&values[..3]);
            mode.add(&mut table, id, displacement, Some(rotation))?;
        }
        mode.finish(&mut table, &mut Vec::new())?;
    }
    Ok(table)
}

/// Eigenvalue and, where it is there, generalised mass of each mode.
fn eigenvalues(
    matrices: &[Op4Matrix],
    count: usize,
) -> Result<Vec<(f64, Option<f64>)>, String> {
    if let Some(list) = named(matrices, &EIGENVALUES) {
        if list.is_complex
            || list.rows.min(list.columns) != 1
            || list.rows * list.columns != count
        {
            return Err(format!(
                "{} is {} × {}, where one real eigenvalue for each of {count} modes is needed",
                list.name, list.rows, list.columns
            ));
        }
        let mut values = vec![(0.0, None); count];
        for (row, column, [lambda, _]) in list.entries() {
            values[row.max(column)].0 = lambda;
        }
        return Ok(values);
    }
    let (Some(stiffness), Some(mass)) = (named(matrices, &["KHH"]), named(matrices, &["MHH"]))
    else {
        return Err("it has no eigenvalues: neither LAMA nor KHH and MHH".to_owned());
    };
    let diagonal = |matrix: &Op4Matrix| {
        let mut values = vec![0.0; count];
        for (row, column, [value, _]) in matrix.entries() {
            if row == column && row < count {
                values[row] = value;
            }
        }
        values
    };
    let pairs = diagonal(stiffness).into_iter().zip(diagonal(mass));
    pairs
        .map(|(k, m)| {
            if m > 0.0 {
                Ok((k / m, Some(m)))
            } else {
                Err(format!("MHH has {m} on its diagonal"))
            }
        })
        .collect()
}

/// Gives the rows the numbers of the nodes.
pub(crate) fn number(
    table: &mut ModeTable,
    geometry: Option<&Geometry>,
    file: &Path,
) -> Result<(), ReadError> {
    let Some(geometry) = geometry else {
        return Ok(());
    };
    let (rows, nodes) = (table.order.len(), geometry.nodes.len());
    if rows != nodes {
        return Err(ReadError::Mismatch {
            file: file.display().to_string(),
            message: format!(
                "the shapes have {rows} nodes and the geometry {nodes}; all nodes of the model \
                 are needed, in ascending order, and no scalar points"
            ),
        });
    }
    table.order = geometry.nodes.keys().copied().collect();
    Ok(())
}
