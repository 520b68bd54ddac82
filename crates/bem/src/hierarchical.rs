//! The body operator as a hierarchical matrix.
//!
//! Vertices are gathered in a tree of clusters. The block of test functions I and columns
//! J is kept as a product of two narrow matrices where the clusters are far from each other
//! ([`crate::aca`]) and entry by entry where they are near; the free terms are a sparse
//! matrix beside them. Memory and work grow as n log n.
//!
//! The equation is of the second kind, and the iteration ([`crate::krylov`]) needs some tens
//! of steps whatever the mesh. All right-hand sides are multiplied together, in chunks that
//! do not depend on the number of threads.

use crate::aca::{Entries, LowRank, approximate};
use crate::blocked_lu::BlockedLu;
use crate::cluster_tree::{ClusterTree, Pair, pairs};
use crate::cut::CutSurface;
use crate::dense::BodyOperator;
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::krylov::solve_block;
use crate::lanes::WIDTH;
use crate::near_field::POINTS;
use crate::panel_block::{BLOCK, PanelBlock};
use crate::progress::Progress;
use crate::tiles::{PointValues, TestCluster, Tile, TileScratch};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use fladder_mesh::Vec3;
use rayon::prelude::*;

/// Right-hand sides multiplied together by one thread.
const TOGETHER: usize = 32;

/// Residual of a solution, in tolerances of the blocks.
const RESIDUAL: f64 = 0.2;

/// Unknowns of a diagonal block.
const DIAGONAL: usize = 256;

/// c φ − D φ.
#[derive(Debug)]
pub(crate) struct HierarchicalOperator {
    tree: ClusterTree,
    blocks: Vec<(Pair, Stored)>,
    /// Free terms in the order of the tree: row, column and value.
    local: Vec<(u32, u32, f32)>,
    /// Factors of diagonal blocks, and the clusters they belong to.
    diagonal: Vec<(usize, BlockedLu<f32>)>,
    tolerance: f64,
}

/// A block; single precision has seven digits, tolerances are above.
#[derive(Debug)]
enum Stored {
    Full(Mat<f32>),
    Product { left: Mat<f32>, right: Mat<f32> },
}

fn single(matrix: &Mat<f64>) -> Mat<f32> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] as f32)
}

/// What the blocks are made from.
struct Surface<'a> {
    galerkin: &'a Galerkin,
    vertices: &'a [Vec3],
    /// Triangles at each vertex.
    stars: Vec<Vec<u32>>,
}

impl<'a> Surface<'a> {
    fn new(galerkin: &'a Galerkin, surface: &'a CutSurface) -> Self {
        let mut stars = vec![Vec::new(); surface.vertices.len()];
        for (t, corners) in surface.triangles.iter().enumerate() {
            for &v in corners {
                stars[v as usize].push(t as u32);
            }
        }
        Self {
            galerkin,
            vertices: &surface.vertices,
            stars,
        }
    }

    /// Vertices with the triangles round them.
    fn vertex_tree(&self) -> ClusterTree {
        let spheres: Vec<(Vec3, f64)> = self
            .stars
            .iter()
            .zip(self.vertices)
            .map(|(star, centre)| {
                let reach = star
                    .iter()
                    .flat_map(|&t| self.galerkin.triangles[t as usize])
                    .map(|v| (self.vertices[v as usize] - centre).norm())
                    .fold(0.0, f64::max);
                (*centre, reach)
            })
            .collect();
        ClusterTree::new(&spheres)
    }

    /// Triangles round some vertices, each once, in the order of the vertices.
    fn round(&self, vertices: &[u32]) -> Vec<u32> {
        let mut seen = std::collections::HashSet::new();
        vertices
            .iter()
            .flat_map(|&v| &self.stars[v as usize])
            .copied()
            .filter(|t| seen.insert(*t))
            .collect()
    }
}

/// Evaluates tiles and throws away what the row sums change by.
#[derive(Default)]
struct Evaluator {
    scratch: TileScratch,
    tile: Tile,
    changes: Vec<PointValues>,
}

impl Evaluator {
    fn doublets(
        &mut self,
        surface: &Surface<'_>,
        cluster: &TestCluster,
        block: &PanelBlock,
    ) -> &[f64] {
        self.changes.clear();
        self.changes.resize(cluster.groups.len(), [[0.0; WIDTH]; 3]);
        self.scratch.fill(
            surface.galerkin,
            cluster,
            block,
            false,
            &mut self.tile,
            &mut self.changes,
        );
        &self.tile.doublets
    }
}

/// −D of jumps at some vertices, row by row and column by column.
struct Block<'a> {
    surface: &'a Surface<'a>,
    rows: &'a [u32],
    columns: &'a [u32],
    panels: Vec<PanelBlock>,
    cluster: TestCluster,
    evaluator: Evaluator,
}

impl<'a> Block<'a> {
    fn new(surface: &'a Surface<'a>, rows: &'a [u32], columns: &'a [u32]) -> Self {
        let places: std::collections::HashMap<u32, u32> = columns
            .iter()
            .enumerate()
            .map(|(place, &v)| (v, place as u32))
            .collect();
        let all = &surface.galerkin.triangles;
        let panels = surface
            .round(columns)
            .chunks(BLOCK)
            .map(|which| {
                PanelBlock::new(surface.vertices, all, which, |t, c| {
                    places.get(&all[t as usize][c]).copied()
                })
            })
            .collect();
        Self {
            cluster: TestCluster::new(surface.galerkin, &surface.round(rows)),
            evaluator: Evaluator::default(),
            surface,
            rows,
            columns,
            panels,
        }
    }

    /// Rows of the given vertices on a cluster of test triangles round them: `take` gets
    /// row, column and entry; columns may come more than once, to be added.
    fn rows_of(
        &mut self,
        cluster: &TestCluster,
        rows: &[u32],
        mut take: impl FnMut(usize, usize, f64),
    ) {
        for block in &self.panels {
            let doublets = self.evaluator.doublets(self.surface, cluster, block);
            let places = block.places();
            for (i, v) in rows.iter().enumerate() {
                let row = cluster.rows.partition_point(|x| x < v);
                let values = &doublets[row * places..(row + 1) * places];
                for (&column, value) in block.columns.iter().zip(values) {
                    take(i, column as usize, -value);
                }
            }
        }
    }

    fn full(mut self) -> Mat<f64> {
        let mut out = Mat::zeros(self.rows.len(), self.columns.len());
        let (cluster, rows) = (self.cluster.clone(), self.rows);
        self.rows_of(&cluster, rows, |i, j, value| out[(i, j)] += value);
        out
    }

    fn stored(mut self, is_far: bool, tolerance: f64) -> Result<LowRank, Mat<f64>> {
        if is_far && let Some(product) = approximate(&mut self, tolerance) {
            return Ok(product);
        }
        Err(self.full())
    }
}

impl Entries for Block<'_> {
    fn rows(&self) -> usize {
        self.rows.len()
    }

    fn columns(&self) -> usize {
        self.columns.len()
    }

    fn row(&mut self, i: usize, out: &mut [f64]) {
        out.fill(0.0);
        let vertex = self.rows[i];
        let cluster =
            TestCluster::new(self.surface.galerkin, &self.surface.stars[vertex as usize]);
        self.rows_of(&cluster, &[vertex], |_, j, value| out[j] += value);
    }

    fn column(&mut self, j: usize, out: &mut [f64]) {
        let all = &self.surface.galerkin.triangles;
        let vertex = self.columns[j];
        let star = &self.surface.stars[vertex as usize];
        let block = PanelBlock::new(self.surface.vertices, all, star, |t, c| {
            (all[t as usize][c] == vertex).then_some(0)
        });
        let doublets = self.evaluator.doublets(self.surface, &self.cluster, &block);
        for (v, out) in self.rows.iter().zip(out) {
            let row = self.cluster.rows.partition_point(|x| x < v);
            *out = -doublets[row * block.places()];
        }
    }
}

impl HierarchicalOperator {
    /// Evaluates and compresses.
    pub(crate) fn new(
        galerkin: &Galerkin,
        cut: &CutSurface,
        free_terms: &[f64],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BemError> {
        let surface = Surface::new(galerkin, cut);
        let tree = surface.vertex_tree();
        let pairs = pairs(&tree, &tree);
        let stage = "compressing body influences";
        progress.stage(stage, pairs.len() as u64);
        let blocks: Vec<(Pair, Stored)> = pairs
            .into_par_iter()
            .map(|pair| {
                if progress.cancelled() {
                    return Err(BemError::Interrupted { stage });
                }
                let block = Block::new(&surface, tree.of(pair.row), tree.of(pair.column));
                let stored = match block.stored(pair.is_far, tolerance) {
                    Ok(product) => Stored::Product {
                        left: single(&product.left),
                        right: single(&product.right),
                    },
                    Err(full) => Stored::Full(single(&full)),
                };
                progress.advance(1);
                Ok((pair, stored))
            })
            .collect::<Result<_, _>>()?;
        let local = local_terms(galerkin, &tree, free_terms);
        let diagonal = diagonal_factors(&surface, &tree, &local);
        Ok(Self {
            tree,
            blocks,
            local,
            diagonal,
            tolerance,
        })
    }

    /// M⁻¹ X or M⁻ᵀ X, M the diagonal blocks.
    fn precondition(&self, x: MatRef<'_, f64>, transposed: bool) -> Mat<f64> {
        let mut y = Mat::<f32>::from_fn(x.nrows(), x.ncols(), |i, j| x[(i, j)] as f32);
        for (cluster, factors) in &self.diagonal {
            let cluster = &self.tree.clusters[*cluster];
            let part = y.subrows_mut(cluster.first, cluster.end - cluster.first);
            factors.solve_alone(part, transposed);
        }
        Mat::from_fn(x.nrows(), x.ncols(), |i, j| f64::from(y[(i, j)]))
    }

    /// A X or Aᵀ X, rows in the order of the tree; by one thread.
    fn product(&self, x: MatRef<'_, f64>, transposed: bool) -> Mat<f64> {
        let (n, k) = (x.nrows(), x.ncols());
        let x = Mat::<f32>::from_fn(n, k, |i, j| x[(i, j)] as f32);
        let mut y = Mat::<f32>::zeros(n, k);
        for (pair, stored) in &self.blocks {
            let row = &self.tree.clusters[pair.row];
            let column = &self.tree.clusters[pair.column];
            let (from, to) = if transposed {
                (row, column)
            } else {
                (column, row)
            };
            let part = x.subrows(from.first, from.end - from.first);
            let mut out = y.subrows_mut(to.first, to.end - to.first);
            match stored {
                Stored::Full(matrix) if transposed => {
                    add_product(matrix.transpose(), part, &mut out);
                }
                Stored::Full(matrix) => add_product(matrix.as_ref(), part, &mut out),
                Stored::Product { left, right } => {
                    let (first, second) = if transposed {
                        (left, right)
                    } else {
                        (right, left)
                    };
                    let mut inner = Mat::<f32>::zeros(first.ncols(), k);
                    add_product(first.transpose(), part, &mut inner.as_mut());
                    add_product(second.as_ref(), inner.as_ref(), &mut out);
                }
            }
        }
        for &(i, j, value) in &self.local {
            let (i, j) = if transposed { (j, i) } else { (i, j) };
            for c in 0..k {
                y[(i as usize, c)] += value * x[(j as usize, c)];
            }
        }
        Mat::from_fn(n, k, |i, j| f64::from(y[(i, j)]))
    }

    fn solve_either(
        &self,
        b: &mut Mat<f64>,
        transposed: bool,
        progress: &dyn Progress,
    ) -> Result<(), BemError> {
        let stage = "iterating";
        let chunks = b.ncols().div_ceil(TOGETHER);
        progress.stage(stage, chunks as u64);
        let order = &self.tree.order;
        b.par_col_chunks_mut(TOGETHER).try_for_each(|mut part| {
            let right = Mat::from_fn(part.nrows(), part.ncols(), |i, j| {
                part[(order[i] as usize, j)]
            });
            let apply = |x: MatRef<'_, f64>| {
                (!progress.cancelled()).then(|| {
                    self.product(self.precondition(x, transposed).as_ref(), transposed)
                })
            };
            let solution = solve_block(apply, &right, RESIDUAL * self.tolerance)
                .map_err(|failure| failure.into_error(stage))?;
            let solution = self.precondition(solution.as_ref(), transposed);
            for (i, &v) in order.iter().enumerate() {
                for j in 0..part.ncols() {
                    part[(v as usize, j)] = solution[(i, j)];
                }
            }
            progress.advance(1);
            Ok(())
        })
    }
}

fn add_product(a: MatRef<'_, f32>, b: MatRef<'_, f32>, out: &mut MatMut<'_, f32>) {
    matmul(out.as_mut(), Accum::Add, a, b, 1.0, Par::Seq);
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

/// c Σ_q w_iq N_j(q) of every triangle, and ones where the potential is given.
fn local_terms(
    galerkin: &Galerkin,
    tree: &ClusterTree,
    free_terms: &[f64],
) -> Vec<(u32, u32, f32)> {
    let mut place = vec![0; tree.order.len()];
    for (i, &v) in tree.order.iter().enumerate() {
        place[v as usize] = i as u32;
    }
    let mut local = Vec::new();
    for (t, corners) in galerkin.triangles.iter().enumerate() {
        for (i, &row) in corners.iter().enumerate() {
            for (j, &column) in corners.iter().enumerate() {
                let sum: f64 = POINTS
                    .iter()
                    .enumerate()
                    .map(|(q, shape)| {
                        galerkin.test_weight(t, q, i) * free_terms[3 * t + q] * shape[j]
                    })
                    .sum();
                local.push((place[row as usize], place[column as usize], sum as f32));
            }
        }
    }
    for v in galerkin.constrained() {
        local.push((place[v], place[v], 1.0));
    }
    local
}

fn diagonal_factors(
    surface: &Surface<'_>,
    tree: &ClusterTree,
    local: &[(u32, u32, f32)],
) -> Vec<(usize, BlockedLu<f32>)> {
    tree.parts(DIAGONAL)
        .into_par_iter()
        .map(|part| {
            let (cluster, vertices) = (&tree.clusters[part], tree.of(part));
            let block = Block::new(surface, vertices, vertices).full();
            let n = vertices.len();
            let mut columns: Vec<f32> = (0..n * n)
                .map(|entry| block[(entry % n, entry / n)] as f32)
                .collect();
            let own = cluster.first..cluster.end;
            for &(i, j, value) in local {
                let (i, j) = (i as usize, j as usize);
                if own.contains(&i) && own.contains(&j) {
                    columns[(j - cluster.first) * n + i - cluster.first] += value;
                }
            }
            (part, BlockedLu::new(columns, n, &|_| {}))
        })
        .collect()
}
