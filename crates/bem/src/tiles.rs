//! Test triangles against a block of panels: the tested influences as small matrices.
//!
//! A group of eight test triangles has the points q of all eight in the lanes of three
//! vectors. What a block of panels does there is tested in registers,
//!
//! $$ m_i = \sum_q w_{iq}\, D_q , $$
//!
//! i the vertices of the group, and added to their rows. Nothing of
//! the size points × panels is ever held.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a dispatched function has its instructions"
)]

use crate::galerkin::Galerkin;
use crate::lanes::{Lanes, WIDTH};
use crate::near_field::{NEAR, TestTriangle};
use crate::panel_block::{BlockScratch, PanelBlock, Points, enclosing};
use crate::receiver::Receiver;
use fladder_mesh::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// Test triangles of a cluster; fixed, so that the order of sums does not depend on the
/// number of threads.
pub(crate) const CLUSTER: usize = 256;

/// A value at three points of each of eight test triangles.
pub(crate) type PointValues = [[f64; WIDTH]; 3];

/// Up to eight test triangles.
#[derive(Clone, Debug)]
pub(crate) struct TestGroup {
    pub(crate) triangles: Vec<u32>,
    pub(crate) seen: Vec<SeenFrom>,
    /// w_iq of each lane; zero in lanes without triangle.
    pub(crate) weights: [PointValues; 3],
    /// Row of each triangle's corner in its cluster.
    pub(crate) rows: [[u32; WIDTH]; 3],
    /// Rows that the group touches.
    places: Vec<u32>,
    /// Of every eight of them: their weights at point q of each triangle.
    tested: Vec<[[[f64; WIDTH]; WIDTH]; 3]>,
}

/// The points of a group, or their images.
#[derive(Clone, Debug)]
pub(crate) struct SeenFrom {
    pub(crate) points: [Points; 3],
    centre: Vec3,
    radius: f64,
    largest: f64,
    pub(crate) sign: f64,
}

/// Test triangles close together and the rows they touch.
#[derive(Clone, Debug)]
pub(crate) struct TestCluster {
    pub(crate) groups: Vec<TestGroup>,
    /// Vertices, ascending.
    pub(crate) rows: Vec<u32>,
    /// Where it receives what is far, if that has been prepared.
    pub(crate) receiver: Option<Receiver>,
}

impl TestCluster {
    pub(crate) fn new(galerkin: &Galerkin, triangles: &[u32]) -> Self {
        let mut rows: Vec<u32> = triangles
            .iter()
            .flat_map(|&t| galerkin.triangles[t as usize])
            .collect();
        rows.sort_unstable();
        rows.dedup();
        let groups = triangles
            .chunks(WIDTH)
            .map(|part| TestGroup::new(galerkin, part, &rows))
            .collect();
        Self {
            groups,
            rows,
            receiver: None,
        }
    }

    /// The same, prepared to receive far influences at few points.
    pub(crate) fn receiving(galerkin: &Galerkin, triangles: &[u32]) -> Self {
        let mut cluster = Self::new(galerkin, triangles);
        cluster.receiver = Receiver::new(galerkin, triangles, &cluster.rows);
        cluster
    }

    /// The receiver, where it may stand for the test points.
    pub(crate) fn receiver_of(&self, block: &PanelBlock) -> Option<&Receiver> {
        self.receiver.as_ref().filter(|r| r.is_far_from(block))
    }
}

impl TestGroup {
    fn new(galerkin: &Galerkin, triangles: &[u32], rows: &[u32]) -> Self {
        let lane = |l: usize| triangles[l.min(triangles.len() - 1)] as usize;
        let mut weights = [[[0.0; WIDTH]; 3]; 3];
        let mut places = [[0; WIDTH]; 3];
        for l in 0..WIDTH {
            for i in 0..3 {
                let vertex = galerkin.triangles[lane(l)][i];
                places[i][l] = rows.partition_point(|&v| v < vertex) as u32;
                for (q, values) in weights[i].iter_mut().enumerate() {
                    if l < triangles.len() {
                        values[l] = galerkin.test_weight(lane(l), q, i);
                    }
                }
            }
        }
        let mut touched: Vec<u32> = places.iter().flatten().copied().collect();
        touched.sort_unstable();
        touched.dedup();
        let mut tested = vec![[[[0.0; WIDTH]; WIDTH]; 3]; touched.len().div_ceil(WIDTH)];
        for (weights, places) in weights.iter().zip(&places) {
            for (l, place) in places.iter().enumerate() {
                let at = touched.partition_point(|x| x < place);
                for (q, values) in weights.iter().enumerate() {
                    tested[at / WIDTH][q][l][at % WIDTH] += values[l];
                }
            }
        }
        let mut seen = vec![SeenFrom::new(&galerkin.tests, lane, 1.0)];
        if let Some(sign) = galerkin.image.sign() {
            seen.push(SeenFrom::new(&galerkin.image_tests, lane, sign));
        }
        Self {
            triangles: triangles.to_vec(),
            seen,
            weights,
            rows: places,
            places: touched,
            tested,
        }
    }
}

impl SeenFrom {
    fn new(tests: &[TestTriangle], lane: impl Fn(usize) -> usize, sign: f64) -> Self {
        let mut points = [[[0.0; WIDTH]; 3]; 3];
        let mut all = Vec::with_capacity(3 * WIDTH);
        for l in 0..WIDTH {
            let test = &tests[lane(l)];
            for (q, point) in test.points.iter().enumerate() {
                all.push(*point);
                for (axis, values) in points[q].iter_mut().enumerate() {
                    values[l] = point[axis];
                }
            }
        }
        let (centre, radius) = enclosing(&all);
        Self {
            points,
            centre,
            radius,
            largest: (0..WIDTH)
                .map(|l| tests[lane(l)].radius)
                .fold(0.0, f64::max),
            sign,
        }
    }
}

impl SeenFrom {
    /// Whether some triangle may be near some panel.
    fn is_near(&self, block: &PanelBlock) -> bool {
        let reach = NEAR * (block.largest + self.largest) + block.radius + self.radius;
        (block.centre - self.centre).norm() <= reach
    }
}

/// Tested influences of one block on one cluster, by rows: rows × places of doublets,
/// rows × corners of sources.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tile {
    pub(crate) doublets: Vec<f64>,
    pub(crate) sources: Vec<f64>,
}

/// Working space of one thread.
#[derive(Debug)]
pub(crate) struct TileScratch {
    arch: Arch,
    block: BlockScratch,
    doublets: [Vec<f64>; 3],
    sources: [Vec<f64>; 3],
    image_doublets: [Vec<f64>; 3],
    image_sources: [Vec<f64>; 3],
}

impl Default for TileScratch {
    fn default() -> Self {
        Self {
            arch: Arch::new(),
            block: BlockScratch::default(),
            doublets: Default::default(),
            sources: Default::default(),
            image_doublets: Default::default(),
            image_sources: Default::default(),
        }
    }
}

impl TileScratch {
    /// Fills `tile` with the influence of `block` on `cluster`, S only where `sources`, and
    /// adds what the divided test triangles change of Σ D over the block, without the
    /// image's sign, to `sums` of each group.
    pub(crate) fn fill(
        &mut self,
        galerkin: &Galerkin,
        cluster: &TestCluster,
        block: &PanelBlock,
        sources: bool,
        tile: &mut Tile,
        sums: &mut [PointValues],
    ) {
        let rows = cluster.rows.len();
        let corners = if sources {
            3 * block.triangles.len()
        } else {
            0
        };
        tile.doublets.clear();
        tile.doublets.resize(rows * block.places(), 0.0);
        tile.sources.clear();
        tile.sources.resize(rows * corners, 0.0);
        for (group, sums) in cluster.groups.iter().zip(sums) {
            self.at_points(galerkin, group, block, corners, sums);
            if let Some(image) = group.seen.get(1) {
                for q in 0..3 {
                    add_scaled(image.sign, &self.image_doublets[q], &mut self.doublets[q]);
                    add_scaled(image.sign, &self.image_sources[q], &mut self.sources[q]);
                }
            }
            let arch = self.arch;
            test(arch, group, &self.doublets, &mut tile.doublets);
            test(arch, group, &self.sources, &mut tile.sources);
        }
    }

    /// Fills `tile` with the influence of `block` at the chosen points of a receiver far
    /// from it: chosen points × places of doublets and × corners of sources, by columns.
    pub(crate) fn fill_far(
        &mut self,
        receiver: &Receiver,
        block: &PanelBlock,
        sources: bool,
        tile: &mut Tile,
    ) {
        let width = receiver.width();
        let corners = if sources {
            3 * block.triangles.len()
        } else {
            0
        };
        tile.doublets.clear();
        tile.doublets.resize(block.places() * width, 0.0);
        tile.sources.clear();
        tile.sources.resize(corners * width, 0.0);
        let (doublets, sources) = (&mut self.doublets[0], &mut self.sources[0]);
        for seen in &receiver.seen {
            let far = block.is_far(seen.centre, receiver.radius());
            for (eight, points) in seen.points.iter().enumerate() {
                doublets.clear();
                doublets.resize(block.places() * WIDTH, 0.0);
                sources.resize(corners * WIDTH, 0.0);
                block.evaluate(self.arch, points, far, &mut self.block, doublets, sources);
                add_lanes(seen.sign, eight, doublets, width, &mut tile.doublets);
                add_lanes(seen.sign, eight, sources, width, &mut tile.sources);
            }
        }
    }

    /// D and S of a block at the points of a group and at their images.
    fn at_points(
        &mut self,
        galerkin: &Galerkin,
        group: &TestGroup,
        block: &PanelBlock,
        corners: usize,
        sums: &mut PointValues,
    ) {
        for (image, seen) in group.seen.iter().enumerate() {
            let (doublets, sources, tests) = if image == 0 {
                (&mut self.doublets, &mut self.sources, &galerkin.tests)
            } else {
                (
                    &mut self.image_doublets,
                    &mut self.image_sources,
                    &galerkin.image_tests,
                )
            };
            let far = block.is_far(seen.centre, seen.radius);
            for q in 0..3 {
                doublets[q].clear();
                doublets[q].resize(block.places() * WIDTH, 0.0);
                sources[q].resize(corners * WIDTH, 0.0);
                block.evaluate(
                    self.arch,
                    &seen.points[q],
                    far,
                    &mut self.block,
                    &mut doublets[q],
                    &mut sources[q],
                );
            }
            if !seen.is_near(block) {
                continue;
            }
            // Hat functions of divided edges are no part of a constant potential.
            let is_whole = !block.triangles.is_empty();
            for (lane, &t) in group.triangles.iter().enumerate() {
                let test = &tests[t as usize];
                for panel in test.near(&block.spheres) {
                    let change = test.change(&block.near(self.arch, panel, &test.near_points));
                    for q in 0..3 {
                        if is_whole {
                            sums[q][lane] += change.doublets[q].iter().sum::<f64>();
                        }
                        for c in 0..3 {
                            let at = block.place(panel, c) * WIDTH + lane;
                            doublets[q][at] += change.doublets[q][c];
                            if corners > 0 {
                                sources[q][(3 * panel + c) * WIDTH + lane] +=
                                    change.sources[q][c];
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Adds columns of eight lanes to those lanes of columns `width` high.
pub(crate) fn add_lanes(
    scale: f64,
    eight: usize,
    values: &[f64],
    width: usize,
    out: &mut [f64],
) {
    let columns = out.chunks_exact_mut(width);
    for (values, column) in values.as_chunks::<WIDTH>().0.iter().zip(columns) {
        for (o, v) in column[eight * WIDTH..].iter_mut().zip(values) {
            *o += scale * v;
        }
    }
}

fn add_scaled(scale: f64, values: &[f64], out: &mut [f64]) {
    for (o, v) in out.iter_mut().zip(values) {
        *o += scale * v;
    }
}

/// Adds Σ_q w_iq values_q to the rows of the group's vertices; `out` is by rows.
pub(crate) fn test(arch: Arch, group: &TestGroup, values: &[Vec<f64>; 3], out: &mut [f64]) {
    arch.dispatch(Testing { group, values, out });
}

struct Testing<'a> {
    group: &'a TestGroup,
    values: &'a [Vec<f64>; 3],
    out: &'a mut [f64],
}

/// Columns tested together: weights are loaded once for them.
const TOGETHER: usize = 4;

impl WithSimd for Testing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        // Lanes are vertices here: a group has about ten, its corners share them.
        for first in (0..self.group.tested.len()).step_by(2) {
            let values = self.values.each_ref().map(|v| v.as_chunks::<WIDTH>().0);
            if first + 1 < self.group.tested.len() {
                self.rows_from::<S, 2>(simd, first, values);
            } else {
                self.rows_from::<S, 1>(simd, first, values);
            }
        }
    }
}

impl Testing<'_> {
    /// Eight rows in each of `PARTS` parts.
    #[inline(always)]
    fn rows_from<S: Simd, const PARTS: usize>(
        &mut self,
        simd: S,
        first: usize,
        values: [&[[f64; WIDTH]]; 3],
    ) {
        let count = values[0].len();
        let whole = count - count % TOGETHER;
        for column in (0..whole).step_by(TOGETHER) {
            self.columns::<S, PARTS, TOGETHER>(simd, first, column, values);
        }
        for column in whole..count {
            self.columns::<S, PARTS, 1>(simd, first, column, values);
        }
    }

    #[inline(always)]
    fn columns<S: Simd, const PARTS: usize, const COLUMNS: usize>(
        &mut self,
        simd: S,
        first: usize,
        column: usize,
        values: [&[[f64; WIDTH]]; 3],
    ) {
        let tested = &self.group.tested[first..first + PARTS];
        let mut sums = [[[0.0; WIDTH]; COLUMNS]; PARTS];
        for chunk in 0..WIDTH / S::F64_LANES {
            let mut totals = [[Lanes::splat(simd, 0.0); COLUMNS]; PARTS];
            for (q, values) in values.iter().enumerate() {
                let values = &values[column..column + COLUMNS];
                for lane in 0..WIDTH {
                    for p in 0..PARTS {
                        let (weights, _) = S::as_simd_f64s(&tested[p][q][lane]);
                        let weights = Lanes::new(simd, weights[chunk]);
                        for c in 0..COLUMNS {
                            let value = Lanes::splat(simd, values[c][lane]);
                            totals[p][c] = weights.mul_add(value, totals[p][c]);
                        }
                    }
                }
            }
            for p in 0..PARTS {
                for c in 0..COLUMNS {
                    let (out, _) = S::as_mut_simd_f64s(&mut sums[p][c]);
                    out[chunk] = totals[p][c].values();
                }
            }
        }
        let count = values[0].len();
        for (places, sums) in self.group.places[first * WIDTH..].chunks(WIDTH).zip(&sums) {
            // Constant bounds, so that this is a transposition in registers.
            let mut by_row = [[0.0; COLUMNS]; WIDTH];
            for (r, values) in by_row.iter_mut().enumerate() {
                for (value, column) in values.iter_mut().zip(sums) {
                    *value = column[r];
                }
            }
            for (&row, values) in places.iter().zip(&by_row) {
                let from = row as usize * count + column;
                if let Some(out) = self.out[from..].first_chunk_mut::<COLUMNS>() {
                    for (out, value) in out.iter_mut().zip(values) {
                        *out += value;
                    }
                }
            }
        }
    }
}

/// Free terms of the points of a group, c = 1 + D[1]: inside flat triangles of a closed
/// surface D[1] is −½, and what the divided test triangles change.
pub(crate) fn free_terms(changes: &PointValues) -> PointValues {
    changes.map(|lanes| lanes.map(|change| 0.5 + change))
}

/// Blocks of a surface whose corners' columns are their vertices.
pub(crate) fn vertex_blocks(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    order: &[u32],
) -> Vec<PanelBlock> {
    order
        .chunks(crate::panel_block::BLOCK)
        .map(|which| {
            PanelBlock::new(vertices, triangles, which, |t, c| {
                Some(triangles[t as usize][c])
            })
        })
        .collect()
}
