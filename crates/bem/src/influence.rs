//! What one region or cluster receives of the surface: entries of the matrix, right-hand
//! sides and free terms, before they are put together.

use crate::galerkin::Galerkin;
use crate::lanes::WIDTH;
use crate::near_field::POINTS;
use crate::received::{Placed, Received, columns_of};
use crate::source_columns::{SourceColumns, SourceSums};
use crate::tiles::{PointValues, Tile, TileScratch, free_terms};
use faer::{ColRef, Mat};

/// Entries over some vertices.
#[derive(Debug)]
pub(crate) struct Block {
    /// Vertices, ascending.
    pub(crate) columns: Vec<u32>,
    pub(crate) values: Mat<f64>,
}

/// How the values of a block lie.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sides {
    ColumnsByRows,
    RowsByColumns,
}

impl Block {
    /// Takes out what belongs to columns from `n` on: slopes of jumps, by their column.
    fn take_slopes(&mut self, n: u32, sides: Sides) -> Vec<(usize, Vec<f64>)> {
        let kept = self.columns.partition_point(|column| *column < n);
        if kept == self.columns.len() {
            return Vec::new();
        }
        let taken = |place: usize| -> Vec<f64> {
            match sides {
                Sides::ColumnsByRows => self.values.row(place).iter().copied().collect(),
                Sides::RowsByColumns => self.values.col_as_slice(place).to_vec(),
            }
        };
        let slopes = (kept..self.columns.len())
            .map(|place| ((self.columns[place] - n) as usize, taken(place)))
            .collect();
        self.columns.truncate(kept);
        self.values = match sides {
            Sides::ColumnsByRows => self.values.subrows(0, kept).to_owned(),
            Sides::RowsByColumns => self.values.subcols(0, kept).to_owned(),
        };
        slopes
    }
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
    /// What the slopes of jumps add to the rows, by column ([`crate::edge_cells`]).
    slopes: Vec<(usize, Vec<f64>)>,
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
        let (mut near, free) = near(part, galerkin, sources, working, &mut near_sources);
        let mut sum = sources.in_order(&near_sources);
        let mut far = Block {
            columns: Vec::new(),
            values: Mat::new(),
        };
        if let Some(receiver) = part.receiver.filter(|_| !part.far.is_empty()) {
            let (scratch, tile) = working;
            let width = receiver.width();
            let columns = columns_of(&part.far, &galerkin.edge_cells);
            let mut values = Mat::zeros(width, columns.len());
            let mut far_sources = sources.zeros(width);
            for Placed { block, first } in &part.far {
                scratch.fill_far(receiver, block, true, tile);
                for (&column, found) in block.columns.iter().zip(tile.doublets.chunks(width)) {
                    for (v, factor) in galerkin.edge_cells.made_of(column) {
                        let place = columns.partition_point(|x| *x < v);
                        let entries = values.col_as_slice_mut(place).iter_mut();
                        for (entry, value) in entries.zip(found) {
                            *entry -= factor * value;
                        }
                    }
                }
                sources.add_by_columns(*first, &tile.sources, &mut far_sources);
            }
            sum += &receiver.tested * sources.in_order(&far_sources);
            far = Block { columns, values };
        }
        let n = galerkin.edge_cells.n_vertices();
        let mut slopes = near.take_slopes(n, Sides::ColumnsByRows);
        if let Some(receiver) = part.receiver {
            let at_points = far.take_slopes(n, Sides::RowsByColumns);
            slopes.extend(at_points.into_iter().map(|(column, values)| {
                let tested = &receiver.tested * ColRef::from_slice(&values);
                (column, tested.iter().copied().collect())
            }));
        }
        Self {
            near,
            far,
            sources: -sum,
            slopes,
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
    let columns = columns_of(&part.near, &galerkin.edge_cells);
    let mut values = Mat::<f64>::zeros(columns.len(), part.rows.len());
    let Some(cluster) = part.cluster else {
        return (Block { columns, values }, Vec::new());
    };
    let mut changes = vec![[[0.0; WIDTH]; 3]; cluster.groups.len()];
    for Placed { block, first } in &part.near {
        scratch.fill(galerkin, cluster, block, true, tile, &mut changes);
        let places: Vec<(usize, usize, f64)> = block
            .columns
            .iter()
            .enumerate()
            .flat_map(|(own, &column)| {
                let unknowns = galerkin.edge_cells.made_of(column);
                unknowns.map(move |(v, factor)| (own, v, factor))
            })
            .map(|(own, v, factor)| (own, columns.partition_point(|x| *x < v), factor))
            .collect();
        for (r, found) in tile.doublets.chunks(block.places()).enumerate() {
            let row = values.col_as_slice_mut(r);
            for &(own, place, factor) in &places {
                row[place] -= factor * found[own];
            }
        }
        sources.add_by_rows(*first, &tile.sources, sums);
    }
    let free: Vec<PointValues> = changes.iter().map(free_terms).collect();
    for (group, free) in cluster.groups.iter().zip(&free) {
        for (lane, &t) in group.triangles.iter().enumerate() {
            let mut add = |v: u32, shape: [f64; 3]| {
                let column = columns.partition_point(|x| *x < v);
                for (weights, rows) in group.weights.iter().zip(&group.rows) {
                    let sum: f64 = (0..3)
                        .map(|q| weights[q][lane] * free[q][lane] * shape[q])
                        .sum();
                    values[(column, rows[lane] as usize)] += sum;
                }
            };
            for (j, &v) in galerkin.triangles[t as usize].iter().enumerate() {
                add(v, POINTS.map(|b| b[j]));
            }
            for (hat, shape) in galerkin.edge_cells.inside(t) {
                for (v, factor) in galerkin.edge_cells.made_of(*hat) {
                    add(v, shape.map(|value| factor * value));
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
    /// c N − D of hat functions by slopes of jumps: vertices × columns of jumps.
    pub(crate) slopes: Mat<f64>,
    /// Free term c at test point q of triangle t, at 3 t + q.
    pub(crate) free_terms: Vec<f64>,
}

impl Totals {
    pub(crate) fn new(galerkin: &Galerkin, sources: &SourceColumns) -> Self {
        Self {
            right_hand_sides: Mat::zeros(galerkin.n_vertices, sources.len()),
            slopes: Mat::zeros(galerkin.n_vertices, galerkin.edge_cells.n_columns()),
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
        for (j, values) in &influence.slopes {
            let column = self.slopes.col_as_slice_mut(*j);
            for (&v, value) in part.rows.iter().zip(values) {
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
