//! What one region or cluster receives of the surface: entries of the matrix, right-hand
//! sides and free terms, before they are put together.

use crate::galerkin::Galerkin;
use crate::lanes::WIDTH;
use crate::near_field::POINTS;
use crate::received::{Placed, Received, columns_of};
use crate::source_columns::{SourceColumns, SourceSums};
use crate::tiles::{PointValues, Tile, TileScratch, free_terms};
use faer::Mat;

/// Entries over some vertices.
#[derive(Debug)]
pub(crate) struct Block {
    /// Vertices, ascending.
    pub(crate) columns: Vec<u32>,
    pub(crate) values: Mat<f64>,
}

/// Of one part.
#[derive(Debug)]
pub(crate) struct Influence {
    /// c N − D over the vertices near a cluster; vertices × rows of the cluster, so that what
    /// belongs to a row lies together.
    pub(crate) near: Block,
    /// −D over the vertices of what is far; chosen points × vertices.
    pub(crate) far: Block,
    /// −S σ: rows × source columns.
    sources: Mat<f64>,
    /// Free terms of each group of a cluster.
    free: Vec<PointValues>,
}

/// Memory of one thread.
pub(crate) type Working = (TileScratch, Tile);

impl Influence {
    pub(crate) fn new(
        part: &Received<'_>,
        galerkin: &Galerkin,
        sources: &SourceColumns,
        working: &mut Working,
    ) -> Self {
        let mut near_sources = sources.zeros(part.rows.len());
        let (near, free) = near(part, galerkin, sources, working, &mut near_sources);
        let mut sum = sources.in_order(&near_sources);
        let mut far = Block {
            columns: Vec::new(),
            values: Mat::new(),
        };
        if let Some(receiver) = part.receiver.filter(|_| !part.far.is_empty()) {
            let (scratch, tile) = working;
            let width = receiver.width();
            let columns = columns_of(&part.far);
            let mut values = Mat::zeros(width, columns.len());
            let mut far_sources = sources.zeros(width);
            for Placed { block, first } in &part.far {
                scratch.fill_far(receiver, block, true, tile);
                for (v, found) in block.columns.iter().zip(tile.doublets.chunks(width)) {
                    let column = columns.partition_point(|x| x < v);
                    let entries = values.col_as_slice_mut(column).iter_mut();
                    for (entry, value) in entries.zip(found) {
                        *entry -= value;
                    }
                }
                sources.add_by_columns(*first, &tile.sources, &mut far_sources);
            }
            sum += &receiver.tested * sources.in_order(&far_sources);
            far = Block { columns, values };
        }
        Self {
            near,
            far,
            sources: -sum,
            free,
        }
    }
}

/// Entries and free terms of a cluster from the blocks near it, and their S σ.
fn near(
    part: &Received<'_>,
    galerkin: &Galerkin,
    sources: &SourceColumns,
    (scratch, tile): &mut Working,
    sums: &mut SourceSums,
) -> (Block, Vec<PointValues>) {
    let columns = columns_of(&part.near);
    let mut values = Mat::<f64>::zeros(columns.len(), part.rows.len());
    let Some(cluster) = part.cluster else {
        return (Block { columns, values }, Vec::new());
    };
    let mut changes = vec![[[0.0; WIDTH]; 3]; cluster.groups.len()];
    for Placed { block, first } in &part.near {
        scratch.fill(galerkin, cluster, block, true, tile, &mut changes);
        let places: Vec<usize> = block
            .columns
            .iter()
            .map(|v| columns.partition_point(|x| x < v))
            .collect();
        for (r, found) in tile.doublets.chunks(block.places()).enumerate() {
            let row = values.col_as_slice_mut(r);
            for (&place, value) in places.iter().zip(found) {
                row[place] -= value;
            }
        }
        sources.add_by_rows(*first, &tile.sources, sums);
    }
    let free: Vec<PointValues> = changes.iter().map(free_terms).collect();
    for (group, free) in cluster.groups.iter().zip(&free) {
        for (lane, &t) in group.triangles.iter().enumerate() {
            for (j, v) in galerkin.triangles[t as usize].iter().enumerate() {
                let column = columns.partition_point(|x| x < v);
                for (weights, rows) in group.weights.iter().zip(&group.rows) {
                    let sum: f64 = (0..3)
                        .map(|q| weights[q][lane] * free[q][lane] * POINTS[q][j])
                        .sum();
                    values[(column, rows[lane] as usize)] += sum;
                }
            }
        }
    }
    (Block { columns, values }, free)
}

/// Right-hand sides and free terms of the whole surface.
#[derive(Debug)]
pub(crate) struct Totals {
    /// −S σ: vertices × source columns.
    pub(crate) right_hand_sides: Mat<f64>,
    /// Free term c at test point q of triangle t, at 3 t + q.
    pub(crate) free_terms: Vec<f64>,
}

impl Totals {
    pub(crate) fn new(galerkin: &Galerkin, sources: &SourceColumns) -> Self {
        Self {
            right_hand_sides: Mat::zeros(galerkin.n_vertices, sources.len()),
            free_terms: vec![0.0; 3 * galerkin.n_triangles()],
        }
    }

    /// Adds those of a part.
    pub(crate) fn add(&mut self, part: &Received<'_>, influence: &Influence) {
        for j in 0..influence.sources.ncols() {
            let column = self.right_hand_sides.col_as_slice_mut(j);
            for (&v, value) in part.rows.iter().zip(influence.sources.col_as_slice(j)) {
                column[v as usize] += value;
            }
        }
        let groups = part.cluster.iter().flat_map(|cluster| &cluster.groups);
        for (group, free) in groups.zip(&influence.free) {
            for (lane, &t) in group.triangles.iter().enumerate() {
                for (q, values) in free.iter().enumerate() {
                    self.free_terms[3 * t as usize + q] = values[lane];
                }
            }
        }
    }
}
