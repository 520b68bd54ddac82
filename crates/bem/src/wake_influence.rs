//! The wake's influence at the test points, tested and contracted on the fly.
//!
//! Nothing of size points × wake is kept. The wake is evaluated tile by tile, a block of
//! the near sheet's triangles ([`crate::tiles`]) or of the far wake's strips
//! ([`crate::far_tiles`]) against a cluster of test triangles, and leaves either rows
//! summed over the wake (steady, or at one s) or small blocks Lᵀ T W (reduced model).

use crate::contour::{Path, Paths};
use crate::error::BemError;
use crate::far_tiles::{FarBlock, FarScratch};
use crate::galerkin::Galerkin;
use crate::lanes::WIDTH;
use crate::near_field::POINTS;
use crate::panel_block::PanelBlock;
use crate::progress::Progress;
use crate::receiver::Receiver;
use crate::regions::Part;
use crate::tiles::{TestCluster, Tile, TileScratch};
use crate::wake::{JumpSheet, Slot, Wake};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, c64};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::{AddAssign, Mul};

/// Influence of every slot, and of every far streamline at every node.
pub(crate) struct WakeBlocks {
    /// Lᵀ T W of each slot: functionals × slots.
    pub(crate) near: Mat<f64>,
    /// One a path: functionals × (streamlines × nodes × 2), real and imaginary part beside
    /// each other, weights of the path included.
    pub(crate) far: Vec<Mat<f64>>,
    /// −Lᵀ of the slopes: functionals × columns, by s.
    pub(crate) slopes: Mat<f64>,
}

/// Evaluates a wake over a surface.
pub(crate) struct WakeInfluence<'a> {
    pub(crate) galerkin: &'a Galerkin,
    pub(crate) wake: &'a Wake,
    pub(crate) free_terms: &'a [f64],
    /// What the slopes of the jumps, s κ, add to the body's rows: it is moved over to the
    /// wake, s being no part of the body's operator.
    pub(crate) slopes: &'a Mat<f64>,
}

impl WakeInfluence<'_> {
    /// T W(0): test functions × columns, the steady wake.
    pub(crate) fn steady(
        &self,
        columns: usize,
        progress: &dyn Progress,
    ) -> Result<Mat<f64>, BemError> {
        let mut rows = self.near_rows(columns, |_| 1.0, progress)?;
        let far = self.far_rows(c64::new(0.0, 0.0), columns, progress)?;
        rows += Mat::from_fn(far.nrows(), columns, |i, j| far[(i, j)].re);
        Ok(rows)
    }

    /// T W(s): test functions × columns.
    pub(crate) fn tested(
        &self,
        s: c64,
        columns: usize,
        progress: &dyn Progress,
    ) -> Result<Mat<c64>, BemError> {
        let mut rows = self.near_rows(columns, |slot| (-s * slot.xi).exp(), progress)?;
        rows += self.far_rows(s, columns, progress)?;
        for j in 0..columns {
            for i in 0..rows.nrows() {
                rows[(i, j)] -= s * self.slopes[(i, j)];
            }
        }
        Ok(rows)
    }

    /// Contracts the wake with functionals given on the vertices: `left` has one
    /// column a functional.
    pub(crate) fn blocks(
        &self,
        left: MatRef<'_, f64>,
        progress: &dyn Progress,
    ) -> Result<WakeBlocks, BemError> {
        let stage = "contracting the wake";
        let wake = self.wake;
        let lefts = Lefts::new(left, self.galerkin);
        let mut near = Mat::<f64>::zeros(left.ncols(), wake.slots.len());
        progress.stage(
            stage,
            (wake.near.blocks.len() + wake.body.blocks.len()) as u64,
        );
        for sheet in [&wake.near, &wake.body] {
            let own = OwnTriangles::new(sheet);
            let parts: Vec<Mat<f64>> = (0..sheet.blocks.len())
                .into_par_iter()
                .map_init(Working::default, |working, b| {
                    let block = &sheet.blocks[b];
                    let mut sum = Mat::zeros(left.ncols(), block.columns.len());
                    let is_far = |r: &Receiver| r.is_far_from(block);
                    for part in self.galerkin.regions.receiving(is_far) {
                        if progress.cancelled() {
                            break;
                        }
                        let (left, tile) = match self.target(part, is_far) {
                            Target::Points(receiver) => {
                                (lefts.far(part), working.far_tile(receiver, block))
                            }
                            Target::Rows(c, cluster) => {
                                let tile = self.tile(sheet, b, cluster, &own, working);
                                let (rows, places) = (cluster.rows.len(), block.places());
                                let tile = MatRef::from_row_major_slice(tile, rows, places);
                                (&lefts.rows[c], tile.subcols(0, block.columns.len()))
                            }
                        };
                        matmul(&mut sum, Accum::Add, left, tile, 1.0, Par::Seq);
                    }
                    progress.advance(1);
                    sum
                })
                .collect();
            if progress.cancelled() {
                return Err(BemError::Interrupted { stage });
            }
            for (block, part) in sheet.blocks.iter().zip(parts) {
                for (c, &slot) in block.columns.iter().enumerate() {
                    let mut column = near.col_mut(slot as usize);
                    column += part.col(c);
                }
            }
        }
        Ok(WakeBlocks {
            near,
            far: self.far_blocks(&lefts, left.ncols(), progress)?,
            slopes: -(left.transpose() * self.slopes),
        })
    }

    /// A part that [`crate::regions::Regions::receiving`] has found.
    fn target(&self, part: Part, is_far: impl Fn(&Receiver) -> bool) -> Target<'_> {
        match part {
            Part::Region(r) => Target::Points(&self.galerkin.regions.all[r].receiver),
            Part::Cluster(c) => {
                let cluster = &self.galerkin.clusters[c];
                match cluster.receiver.as_ref().filter(|r| is_far(r)) {
                    Some(receiver) => Target::Points(receiver),
                    None => Target::Rows(c, cluster),
                }
            }
        }
    }

    /// Lᵀ T W of every far streamline and node, one matrix a path; `lefts` are L's rows of
    /// each cluster.
    fn far_blocks(
        &self,
        lefts: &Lefts,
        functionals: usize,
        progress: &dyn Progress,
    ) -> Result<Vec<Mat<f64>>, BemError> {
        let stage = "contracting the far wake";
        let wake = self.wake;
        let blocks = FarBlock::of(&wake.far);
        progress.stage(stage, 2 * blocks.len() as u64);
        let mut far = Vec::new();
        for path in [&wake.paths.oscillating, &wake.paths.decaying] {
            let parts: Vec<Mat<f64>> = blocks
                .par_iter()
                .map_init(FarScratch::default, |scratch, block| {
                    let columns = block.columns(path.nodes.len());
                    let mut sum = Mat::zeros(functionals, columns);
                    let is_far = |r: &Receiver| block.is_far_from(r, &path.nodes);
                    for part in self.galerkin.regions.receiving(is_far) {
                        if progress.cancelled() {
                            break;
                        }
                        let (left, tile) = match self.target(part, is_far) {
                            Target::Points(receiver) => (
                                lefts.far(part),
                                scratch.far_tile(receiver, block, &path.nodes, None),
                            ),
                            Target::Rows(c, cluster) => (
                                &lefts.rows[c],
                                scratch.tile(cluster, block, &path.nodes, None),
                            ),
                        };
                        matmul(&mut sum, Accum::Add, left, tile, 1.0, Par::Seq);
                    }
                    progress.advance(1);
                    sum
                })
                .collect();
            if progress.cancelled() {
                return Err(BemError::Interrupted { stage });
            }
            let lines = wake.far.anchors.len();
            let mut total = Mat::zeros(functionals, 2 * lines * path.nodes.len());
            for (block, part) in blocks.iter().zip(&parts) {
                add_weighted(path, block, part, &mut total);
            }
            far.push(total);
        }
        Ok(far)
    }

    /// Test functions × columns of the far wake at s.
    fn far_rows(
        &self,
        s: c64,
        columns: usize,
        progress: &dyn Progress,
    ) -> Result<Mat<c64>, BemError> {
        let stage = "evaluating the far wake";
        let (wake, clusters) = (self.wake, &self.galerkin.clusters);
        let path = [&wake.paths.oscillating, &wake.paths.decaying][Paths::number_of(s)];
        let decays: Vec<c64> = path
            .nodes
            .iter()
            .zip(&path.weights)
            .map(|(xi, weight)| weight * (-s * xi).exp())
            .collect();
        let blocks = FarBlock::of(&wake.far);
        progress.stage(stage, clusters.len() as u64);
        let parts: Vec<Mat<c64>> = clusters
            .par_iter()
            .map_init(FarScratch::default, |scratch, cluster| {
                let mut sum = Contributions::new(cluster, columns);
                for block in &blocks {
                    if progress.cancelled() {
                        return sum.rows;
                    }
                    let (out, tile) = match cluster
                        .receiver
                        .as_ref()
                        .filter(|r| block.is_far_from(r, &path.nodes))
                    {
                        Some(receiver) => (
                            &mut sum.far,
                            scratch.far_tile(receiver, block, &path.nodes, Some(&decays)),
                        ),
                        None => (
                            &mut sum.rows,
                            scratch.tile(cluster, block, &path.nodes, Some(&decays)),
                        ),
                    };
                    for (i, &line) in block.lines.iter().enumerate() {
                        for &(column, weight) in &wake.threads[wake.far_threads[line as usize]]
                        {
                            for r in 0..tile.nrows() {
                                let value = c64::new(tile[(r, 2 * i)], tile[(r, 2 * i + 1)]);
                                out[(r, column)] += weight * value;
                            }
                        }
                    }
                }
                progress.advance(1);
                sum.all(cluster)
            })
            .collect();
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        let mut rows = Mat::zeros(self.galerkin.n_vertices, columns);
        for (cluster, part) in clusters.iter().zip(&parts) {
            for (r, &v) in cluster.rows.iter().enumerate() {
                for c in 0..columns {
                    rows[(v as usize, c)] += part[(r, c)];
                }
            }
        }
        Ok(rows)
    }

    /// Tested influence of one block of a sheet: rows × places, by rows.
    fn tile<'w>(
        &self,
        sheet: &JumpSheet,
        block: usize,
        cluster: &TestCluster,
        own: &OwnTriangles,
        working: &'w mut Working,
    ) -> &'w [f64] {
        let panels = &sheet.blocks[block];
        working.sums.clear();
        working.sums.resize(cluster.groups.len(), [[0.0; WIDTH]; 3]);
        working.scratch.fill(
            self.galerkin,
            cluster,
            panels,
            false,
            &mut working.tile,
            &mut working.sums,
        );
        self.subtract_free_terms(sheet, block, cluster, own, &mut working.tile.doublets);
        &working.tile.doublets
    }

    /// −c N^up where the points lie on a triangle whose corners carry jumps.
    fn subtract_free_terms(
        &self,
        sheet: &JumpSheet,
        block: usize,
        cluster: &TestCluster,
        own: &OwnTriangles,
        tile: &mut [f64],
    ) {
        let panels = &sheet.blocks[block];
        if sheet.body_triangles.is_empty() {
            return;
        }
        for group in &cluster.groups {
            for (lane, &t) in group.triangles.iter().enumerate() {
                for &(_, panel) in own.of(t).iter().filter(|(b, _)| *b == block) {
                    for (weights, places) in group.weights.iter().zip(&group.rows) {
                        for corner in 0..3 {
                            let sum: f64 = POINTS
                                .iter()
                                .enumerate()
                                .map(|(q, shape)| {
                                    let free = self.free_terms[3 * t as usize + q];
                                    weights[q][lane] * free * shape[corner]
                                })
                                .sum();
                            let place = panels.place(panel, corner);
                            tile[places[lane] as usize * panels.places() + place] -= sum;
                        }
                    }
                }
            }
        }
    }

    /// Test functions × columns of the near sheet, each slot with a weight.
    fn near_rows<T>(
        &self,
        columns: usize,
        weight: impl Fn(&Slot) -> T,
        progress: &dyn Progress,
    ) -> Result<Mat<T>, BemError>
    where
        T: Copy + Default + Send + Sync + AddAssign + Mul<f64, Output = T>,
    {
        let stage = "evaluating the wake";
        let (wake, clusters) = (self.wake, &self.galerkin.clusters);
        let weights: Vec<T> = wake.slots.iter().map(weight).collect();
        let sheets = [&wake.near, &wake.body].map(|sheet| (sheet, OwnTriangles::new(sheet)));
        progress.stage(stage, clusters.len() as u64);
        let parts: Vec<Mat<T>> = clusters
            .par_iter()
            .map_init(Working::default, |working, cluster| {
                let mut sum = Contributions::new(cluster, columns);
                for (sheet, own) in &sheets {
                    for (b, block) in sheet.blocks.iter().enumerate() {
                        if progress.cancelled() {
                            return sum.rows;
                        }
                        let (out, tile) = if let Some(receiver) = cluster.receiver_of(block) {
                            (&mut sum.far, working.far_tile(receiver, block))
                        } else {
                            let tile = self.tile(sheet, b, cluster, own, working);
                            let (rows, places) = (cluster.rows.len(), block.places());
                            let tile = MatRef::from_row_major_slice(tile, rows, places);
                            (&mut sum.rows, tile)
                        };
                        for (place, &slot) in block.columns.iter().enumerate() {
                            let slot = slot as usize;
                            for &(column, share) in &wake.threads[wake.slots[slot].thread] {
                                let factor = weights[slot] * share;
                                for r in 0..tile.nrows() {
                                    out[(r, column)] += factor * tile[(r, place)];
                                }
                            }
                        }
                    }
                }
                progress.advance(1);
                sum.all(cluster)
            })
            .collect();
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        let mut rows = Mat::from_fn(self.galerkin.n_vertices, columns, |_, _| T::default());
        for (cluster, part) in clusters.iter().zip(&parts) {
            for (r, &v) in cluster.rows.iter().enumerate() {
                for c in 0..columns {
                    rows[(v as usize, c)] += part[(r, c)];
                }
            }
        }
        Ok(rows)
    }
}

/// L, transposed: functionals × rows of each cluster, and functionals × chosen points of
/// each receiver.
struct Lefts {
    rows: Vec<Mat<f64>>,
    clusters: Vec<Mat<f64>>,
    regions: Vec<Mat<f64>>,
}

impl Lefts {
    fn new(left: MatRef<'_, f64>, galerkin: &Galerkin) -> Self {
        let on = |rows: &[u32]| {
            Mat::from_fn(left.ncols(), rows.len(), |f, r| left[(rows[r] as usize, f)])
        };
        let at_points = |rows: &Mat<f64>, receiver: Option<&Receiver>| {
            let mut far = Mat::zeros(rows.nrows(), receiver.map_or(0, Receiver::width));
            if let Some(receiver) = receiver {
                matmul(
                    &mut far,
                    Accum::Replace,
                    rows,
                    &receiver.tested,
                    1.0,
                    Par::Seq,
                );
            }
            far
        };
        let clusters = &galerkin.clusters;
        let rows: Vec<Mat<f64>> = clusters.par_iter().map(|c| on(&c.rows)).collect();
        Self {
            clusters: clusters
                .par_iter()
                .zip(&rows)
                .map(|(c, rows)| at_points(rows, c.receiver.as_ref()))
                .collect(),
            regions: galerkin
                .regions
                .all
                .par_iter()
                .map(|r| at_points(&on(&r.rows), Some(&r.receiver)))
                .collect(),
            rows,
        }
    }

    fn far(&self, part: Part) -> &Mat<f64> {
        match part {
            Part::Cluster(c) => &self.clusters[c],
            Part::Region(r) => &self.regions[r],
        }
    }
}

/// Where the influence of a block is taken.
enum Target<'a> {
    Points(&'a Receiver),
    Rows(usize, &'a TestCluster),
}

/// What blocks give a cluster: at its rows, and at the chosen points of its receiver.
struct Contributions<T> {
    rows: Mat<T>,
    far: Mat<T>,
}

impl<T> Contributions<T>
where
    T: Copy + Default + AddAssign + Mul<f64, Output = T>,
{
    fn new(cluster: &TestCluster, columns: usize) -> Self {
        let width = cluster.receiver.as_ref().map_or(0, Receiver::width);
        let zeros = |rows| Mat::from_fn(rows, columns, |_, _| T::default());
        Self {
            rows: zeros(cluster.rows.len()),
            far: zeros(width),
        }
    }

    /// Both together at the rows.
    fn all(self, cluster: &TestCluster) -> Mat<T> {
        let mut rows = self.rows;
        if let Some(receiver) = &cluster.receiver {
            for c in 0..rows.ncols() {
                for k in 0..receiver.width() {
                    let value = self.far[(k, c)];
                    for r in 0..rows.nrows() {
                        rows[(r, c)] += value * receiver.tested[(r, k)];
                    }
                }
            }
        }
        rows
    }
}

/// Adds a block's columns, times the weights of the path, to those of its streamlines.
fn add_weighted(path: &Path, block: &FarBlock, part: &Mat<f64>, total: &mut Mat<f64>) {
    let n = path.nodes.len();
    for (i, &line) in block.lines.iter().enumerate() {
        for (node, weight) in path.weights.iter().enumerate() {
            let (from, to) = (2 * (i * n + node), 2 * (line as usize * n + node));
            for f in 0..part.nrows() {
                let value = c64::new(part[(f, from)], part[(f, from + 1)]) * weight;
                total[(f, to)] += value.re;
                total[(f, to + 1)] += value.im;
            }
        }
    }
}

/// Working space of one thread.
#[derive(Default)]
struct Working {
    scratch: TileScratch,
    tile: Tile,
    sums: Vec<crate::tiles::PointValues>,
}

impl Working {
    /// Influence of a far block at chosen points: points × columns.
    fn far_tile(&mut self, receiver: &Receiver, block: &PanelBlock) -> MatRef<'_, f64> {
        self.scratch
            .fill_far(receiver, block, false, &mut self.tile);
        let (width, places) = (receiver.width(), block.places());
        MatRef::from_column_major_slice(&self.tile.doublets, width, places)
            .subcols(0, block.columns.len())
    }
}

/// Where a triangle of the body is in a sheet on it: block and place; once for each jump
/// that a corner carries.
struct OwnTriangles(HashMap<u32, Vec<(usize, usize)>>);

impl OwnTriangles {
    fn new(sheet: &JumpSheet) -> Self {
        let mut map: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
        if !sheet.body_triangles.is_empty() {
            for (b, block) in sheet.blocks.iter().enumerate() {
                for (p, &t) in block.triangles.iter().enumerate() {
                    map.entry(sheet.body_triangles[t as usize])
                        .or_default()
                        .push((b, p));
                }
            }
        }
        Self(map)
    }

    fn of(&self, triangle: u32) -> &[(usize, usize)] {
        self.0.get(&triangle).map_or(&[], Vec::as_slice)
    }
}
