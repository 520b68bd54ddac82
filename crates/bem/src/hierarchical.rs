//! The body operator for more unknowns than a matrix can hold.
//!
//! The rows of a cluster of test triangles are kept entry by entry over the vertices near
//! it. What is far from a cluster or a region is kept as the product of its matrix T W with
//! the influences at its chosen points ([`crate::receiver`]); they are the same for all
//! that is far, so that nothing has to be approximated block by block. Memory and work
//! grow as n log n.
//!
//! The equation is of the second kind, and the iteration ([`crate::krylov`]) needs some tens
//! of steps whatever the mesh. All right-hand sides are multiplied together, in chunks that
//! do not depend on the number of threads.

use crate::assembly::PARTS_AT_ONCE;
use crate::blocked_lu::BlockedLu;
use crate::dense::BodyOperator;
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::influence::{Influence, Totals, Working};
use crate::krylov::solve_block;
use crate::progress::Progress;
use crate::received::{Received, received};
use crate::source_columns::SourceColumns;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Right-hand sides multiplied together by one thread, at most: the more, the less often the
/// operator comes from memory. From so many unknowns on half as many, their Krylov spaces
/// being large.
const TOGETHER: usize = 48;
const MANY: usize = 40_000;

/// Chunks of right-hand sides are a multiple of this and equally large.
const CHUNKS: usize = 2;

/// Residual of a solution, in tolerances.
const RESIDUAL: f64 = 0.2;

/// Clusters whose vertices have a diagonal block together.
const CLUSTERS_OF_A_DIAGONAL: usize = 2;

/// c φ − D φ.
#[derive(Debug)]
pub(crate) struct HierarchicalOperator {
    size: usize,
    parts: Vec<StoredPart>,
    /// Vertices whose potential is zero.
    constrained: Vec<usize>,
    /// Vertices of the diagonal blocks and their factors.
    diagonal: Vec<(Vec<u32>, BlockedLu<f32>)>,
    tolerance: f64,
}

/// Rows of a region or cluster; single precision has seven digits, tolerances are above.
#[derive(Debug)]
struct StoredPart {
    rows: Vec<u32>,
    near: Entries,
    far: Entries,
    /// T W: rows × chosen points, which are the far block's rows.
    tested: Mat<f32>,
}

/// Entries over some vertices.
#[derive(Debug)]
struct Entries {
    columns: Vec<u32>,
    values: Mat<f32>,
}

/// The operator, −S σ for every source column, and the free term at every test point.
pub(crate) struct Assembled {
    pub(crate) operator: HierarchicalOperator,
    pub(crate) right_hand_sides: Mat<f64>,
    pub(crate) slopes: Mat<f64>,
    pub(crate) free_terms: Vec<f64>,
}

impl StoredPart {
    fn new(part: &Received<'_>, influence: Influence) -> Self {
        let Influence { near, far, .. } = influence;
        let tested = part.receiver.filter(|_| !far.columns.is_empty());
        Self {
            rows: part.rows.to_vec(),
            near: Entries {
                values: single(near.values.transpose()),
                columns: near.columns,
            },
            far: Entries {
                values: single(far.values.as_ref()),
                columns: far.columns,
            },
            tested: tested.map_or_else(Mat::new, |receiver| single(receiver.tested.as_ref())),
        }
    }

    /// Y += A X over these rows and columns, or with their transpose.
    fn multiply(&self, x: &Mat<f32>, y: &mut Mat<f32>, transposed: bool) {
        if transposed {
            let x = gathered(x, &self.rows);
            let near = product(self.near.values.transpose(), x.as_ref());
            scatter(&near, &self.near.columns, y);
            if !self.far.columns.is_empty() {
                let inner = product(self.tested.transpose(), x.as_ref());
                let far = product(self.far.values.transpose(), inner.as_ref());
                scatter(&far, &self.far.columns, y);
            }
        } else {
            let part = gathered(x, &self.near.columns);
            let mut rows = product(self.near.values.as_ref(), part.as_ref());
            if !self.far.columns.is_empty() {
                let part = gathered(x, &self.far.columns);
                let inner = product(self.far.values.as_ref(), part.as_ref());
                matmul(&mut rows, Accum::Add, &self.tested, &inner, 1.0, Par::Seq);
            }
            scatter(&rows, &self.rows, y);
        }
    }
}

fn single(matrix: MatRef<'_, f64>) -> Mat<f32> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] as f32)
}

fn product(a: MatRef<'_, f32>, b: MatRef<'_, f32>) -> Mat<f32> {
    let mut out = Mat::zeros(a.nrows(), b.ncols());
    matmul(&mut out, Accum::Replace, a, b, 1.0, Par::Seq);
    out
}

/// Some rows of a matrix.
fn gathered(x: &Mat<f32>, rows: &[u32]) -> Mat<f32> {
    let mut out = Mat::zeros(rows.len(), x.ncols());
    for j in 0..x.ncols() {
        let from = x.col_as_slice(j);
        for (out, &row) in out.col_as_slice_mut(j).iter_mut().zip(rows) {
            *out = from[row as usize];
        }
    }
    out
}

/// Adds rows to their places.
fn scatter(values: &Mat<f32>, rows: &[u32], out: &mut Mat<f32>) {
    for j in 0..values.ncols() {
        let to = out.col_as_slice_mut(j);
        for (value, &row) in values.col_as_slice(j).iter().zip(rows) {
            to[row as usize] += value;
        }
    }
}

impl HierarchicalOperator {
    /// Evaluates everything; `sources` holds σ at triangle corners, row 3 t + corner.
    pub(crate) fn assemble(
        galerkin: &Galerkin,
        sources: MatRef<'_, f64>,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Assembled, BemError> {
        let sources = SourceColumns::new(sources, &galerkin.blocks);
        let all = received(galerkin);
        let stage = "assembling body influences";
        progress.stage(stage, all.len() as u64);
        let mut totals = Totals::new(galerkin, &sources);
        let mut parts = Vec::with_capacity(all.len());
        for batch in all.chunks(PARTS_AT_ONCE) {
            if progress.cancelled() {
                return Err(BemError::Interrupted { stage });
            }
            let influences: Vec<Influence> = batch
                .par_iter()
                .map_init(Working::default, |working, part| {
                    let influence = Influence::new(part, galerkin, &sources, working);
                    progress.advance(1);
                    influence
                })
                .collect();
            for (part, influence) in batch.iter().zip(influences) {
                totals.add(part, &influence);
                parts.push(StoredPart::new(part, influence));
            }
        }
        let constrained: Vec<usize> = galerkin.constrained().collect();
        let clusters: Vec<&StoredPart> = all
            .iter()
            .zip(&parts)
            .filter_map(|(part, stored)| part.cluster.and(Some(stored)))
            .collect();
        let diagonal = diagonal_factors(&clusters, galerkin.n_vertices, &constrained);
        Ok(Assembled {
            operator: Self {
                size: galerkin.n_vertices,
                parts,
                constrained,
                diagonal,
                tolerance,
            },
            right_hand_sides: totals.right_hand_sides,
            slopes: totals.slopes,
            free_terms: totals.free_terms,
        })
    }

    /// M⁻¹ X or M⁻ᵀ X, M the diagonal blocks.
    fn precondition(&self, x: MatRef<'_, f64>, transposed: bool) -> Mat<f32> {
        let mut y = Mat::<f32>::zeros(x.nrows(), x.ncols());
        for (vertices, factors) in &self.diagonal {
            let mut part = Mat::<f32>::from_fn(vertices.len(), x.ncols(), |i, j| {
                x[(vertices[i] as usize, j)] as f32
            });
            factors.solve_alone(part.as_mut(), transposed);
            scatter(&part, vertices, &mut y);
        }
        y
    }

    /// A X or Aᵀ X; by one thread.
    fn product(&self, x: &Mat<f32>, transposed: bool) -> Mat<f64> {
        let mut y = Mat::<f32>::zeros(self.size, x.ncols());
        for part in &self.parts {
            part.multiply(x, &mut y, transposed);
        }
        for &v in &self.constrained {
            for j in 0..x.ncols() {
                y[(v, j)] += x[(v, j)];
            }
        }
        Mat::from_fn(self.size, x.ncols(), |i, j| f64::from(y[(i, j)]))
    }

    fn solve_either(
        &self,
        b: &mut Mat<f64>,
        transposed: bool,
        progress: &dyn Progress,
    ) -> Result<(), BemError> {
        let stage = "iterating";
        let together = if self.size < MANY {
            TOGETHER
        } else {
            TOGETHER / 2
        };
        let chunks = b.ncols().div_ceil(together).next_multiple_of(CHUNKS);
        let together = b.ncols().div_ceil(chunks).max(1);
        progress.stage(stage, b.ncols().div_ceil(together) as u64);
        b.par_col_chunks_mut(together)
            .try_for_each(|mut part: MatMut<'_, f64>| {
                let apply = |x: MatRef<'_, f64>| {
                    (!progress.cancelled())
                        .then(|| self.product(&self.precondition(x, transposed), transposed))
                };
                let right = part.as_ref().to_owned();
                let solution = solve_block(apply, &right, RESIDUAL * self.tolerance)
                    .map_err(|failure| failure.into_error(stage))?;
                let solution = self.precondition(solution.as_ref(), transposed);
                for j in 0..part.ncols() {
                    for i in 0..part.nrows() {
                        part[(i, j)] = f64::from(solution[(i, j)]);
                    }
                }
                progress.advance(1);
                Ok(())
            })
    }
}

impl BodyOperator for HierarchicalOperator {
    fn solve(&self, b: &mut Mat<f64>, progress: &dyn Progress) -> Result<(), BemError> {
        self.solve_either(b, false, progress)
    }

    fn solve_transpose(
        &self,
        b: &mut Mat<f64>,
        progress: &dyn Progress,
    ) -> Result<(), BemError> {
        self.solve_either(b, true, progress)
    }
}

/// Factors of the entries between the vertices of a few clusters, each vertex in the first
/// cluster that has it.
fn diagonal_factors(
    clusters: &[&StoredPart],
    size: usize,
    constrained: &[usize],
) -> Vec<(Vec<u32>, BlockedLu<f32>)> {
    let mut groups: Vec<Vec<u32>> = Vec::new();
    let mut place = vec![(usize::MAX, 0); size];
    for (g, few) in clusters.chunks(CLUSTERS_OF_A_DIAGONAL).enumerate() {
        let mut vertices = Vec::new();
        for &v in few.iter().flat_map(|part| &part.rows) {
            if place[v as usize].0 == usize::MAX {
                place[v as usize] = (g, vertices.len());
                vertices.push(v);
            }
        }
        groups.push(vertices);
    }
    // By columns.
    let mut entries: Vec<Vec<f32>> = groups.iter().map(|v| vec![0.0; v.len().pow(2)]).collect();
    for part in clusters {
        for (c, &w) in part.near.columns.iter().enumerate() {
            let (group, column) = place[w as usize];
            for (r, &v) in part.rows.iter().enumerate() {
                let (row_group, row) = place[v as usize];
                if row_group == group {
                    entries[group][column * groups[group].len() + row] +=
                        part.near.values[(r, c)];
                }
            }
        }
    }
    for &v in constrained {
        let (group, at) = place[v];
        entries[group][at * groups[group].len() + at] += 1.0;
    }
    groups
        .into_par_iter()
        .zip(entries)
        .filter(|(vertices, _)| !vertices.is_empty())
        .map(|(vertices, entries)| {
            let n = vertices.len();
            (vertices, BlockedLu::new(entries, n, &|_| {}))
        })
        .collect()
}
