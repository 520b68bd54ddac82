//! A sparse matrix of 3 × 3 blocks, nodes of the structure to vertices of the
//! surface.
//!
//! `u = H q` carries displacements, `F = Hᵀ f` forces; with one matrix for both
//! the virtual work `fᵀ u = Fᵀ q` is the same on both sides by construction.

use fladder_mesh::Vec3;
use nalgebra::Matrix3;

/// Compressed rows of 3 × 3 blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockMatrix {
    columns: usize,
    start: Vec<usize>,
    column: Vec<u32>,
    block: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// From the blocks of each row, as (column, block) pairs.
    pub(crate) fn from_rows(columns: usize, rows: Vec<Vec<(u32, Matrix3<f64>)>>) -> Self {
        let mut matrix = Self {
            columns,
            start: vec![0],
            column: Vec::new(),
            block: Vec::new(),
        };
        for row in rows {
            for (column, block) in row {
                matrix.column.push(column);
                matrix.block.push(block);
            }
            matrix.start.push(matrix.column.len());
        }
        matrix
    }

    /// Number of vertices.
    pub fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// Number of structural nodes.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of 3 × 3 blocks.
    pub fn blocks(&self) -> usize {
        self.block.len()
    }

    /// Displacements of the vertices from those of the nodes.
    ///
    /// # Panics
    /// When `nodal` has another length than [`columns`](Self::columns).
    pub fn displacement(&self, nodal: &[Vec3]) -> Vec<Vec3> {
        assert_eq!(nodal.len(), self.columns, "one displacement a node");
        self.start
            .windows(2)
            .map(|row| {
                (row[0]..row[1])
                    .map(|k| self.block[k] * nodal[self.column[k] as usize])
                    .sum()
            })
            .collect()
    }

    /// Forces on the nodes from those on the vertices, by the transpose.
    ///
    /// # Panics
    /// When `surface` has another length than [`rows`](Self::rows).
    pub fn force(&self, surface: &[Vec3]) -> Vec<Vec3> {
        assert_eq!(surface.len(), self.rows(), "one force a vertex");
        let mut nodal = vec![Vec3::zeros(); self.columns];
        for (row, force) in self.start.windows(2).zip(surface) {
            for k in row[0]..row[1] {
                nodal[self.column[k] as usize] += self.block[k].tr_mul(force);
            }
        }
        nodal
    }
}
