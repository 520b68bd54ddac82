//! Galerkin rows of the boundary integral equation.
//!
//! On the surface, with n out of the body and σ = ∂φ/∂n,
//! $$ c\,\varphi - D[\varphi] - W[\kappa] = -S[\sigma], \qquad c = 1 + D[1]. $$
//! The free term c follows from the row sum of D over the closed surface, at vertices,
//! sharp edges and inside triangles alike. The equation is taken at three interior
//! points q of each triangle, (2/3, 1/6, 1/6) and its turns, and tested with the hat
//! functions: Σ_t A_t/3 Σ_q Nᵢ(q) {…}, divided by the test function's weight.
//! With a plane of symmetry D and S are those of both halves, the other half being seen as
//! the given one from the point's image ([`crate::image`]).
//! One point a triangle has a null space on right-angled meshes; collocation at the
//! vertices loses lift on thin wings. Panels near a test triangle are integrated with more
//! points ([`crate::near_field`]).

use crate::cut::CutSurface;
use crate::error::BemError;
use crate::image::{self, Image};
use crate::lanes::WIDTH;
use crate::near_field::{POINTS, TestTriangle};
use crate::ordering::spatial_order;
use crate::panel_block::{BLOCK, PanelBlock};
use crate::progress::Progress;
use crate::receiver::Receiver;
use crate::regions::{Regions, TOGETHER};
use crate::skeleton::TOLERANCE;
use crate::source_columns::SourceColumns;
use crate::tiles::vertex_blocks;
use crate::tiles::{CLUSTER, PointValues, TestCluster, Tile, TileScratch, free_terms};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use fladder_mesh::Vec3;
use rayon::prelude::*;

/// Clusters whose rows are held in memory at once.
pub(crate) const CLUSTERS_AT_ONCE: usize = 8;

/// Triangles of a surface up to which every influence is evaluated at every test point: it
/// takes a second or two, and what is zero by symmetry stays zero to rounding.
const EVALUATED_EVERYWHERE: usize = 4096;

/// Test triangles of the regions' levels, of a cluster, of a block of panels, of a group.
const RUNS: [usize; 5] = [
    TOGETHER * TOGETHER * CLUSTER,
    TOGETHER * CLUSTER,
    CLUSTER,
    BLOCK,
    WIDTH,
];

/// Normals, areas, gradients and test points of a cut surface.
#[derive(Clone, Debug)]
pub(crate) struct Galerkin {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) n_vertices: usize,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) areas: Vec<f64>,
    /// ∇Nᵢ of each triangle.
    pub(crate) gradients: Vec<[Vec3; 3]>,
    /// Weight of each test function: a third of the areas round its vertex.
    pub(crate) weights: Vec<f64>,
    /// Where each triangle is tested.
    pub(crate) tests: Vec<TestTriangle>,
    /// The other half of the surface, if only one is given.
    pub(crate) image: Image,
    /// The test points' images: what they see of the given half, the points see of the
    /// other. Empty without image.
    pub(crate) image_tests: Vec<TestTriangle>,
    /// Vertices whose potential is zero by antisymmetry.
    constrained: Vec<bool>,
    /// Test triangles, close ones together.
    pub(crate) clusters: Vec<TestCluster>,
    /// Of far influences.
    pub(crate) tolerance: f64,
    /// Clusters together, for what is far from them.
    pub(crate) regions: Regions,
    /// The surface in blocks of close triangles.
    pub(crate) blocks: Vec<PanelBlock>,
}

/// The assembled equations.
#[derive(Debug)]
pub(crate) struct Assembly {
    /// Matrix of c φ − D φ by rows.
    pub(crate) rows: Vec<f64>,
    /// −S σ for every source column.
    pub(crate) right_hand_sides: Mat<f64>,
    /// Free term c at every test point.
    pub(crate) free_terms: Vec<f64>,
}

/// D of the far part of the surface at the chosen points of a receiver.
#[derive(Debug, Default)]
struct FarDoublets {
    width: usize,
    /// Chosen points × vertices, by columns.
    values: Vec<f64>,
}

impl FarDoublets {
    fn clear(&mut self, receiver: Option<&Receiver>, vertices: usize) {
        self.width = receiver.map_or(0, Receiver::width);
        self.values.clear();
        self.values.resize(self.width * vertices, 0.0);
    }

    fn add(&mut self, block: &PanelBlock, tile: &Tile) {
        for (&v, values) in block
            .columns
            .iter()
            .zip(tile.doublets.chunks_exact(self.width))
        {
            let from = v as usize * self.width;
            let column = &mut self.values[from..from + self.width];
            for (sum, value) in column.iter_mut().zip(values) {
                *sum += value;
            }
        }
    }

    fn doublets(&self) -> MatRef<'_, f64> {
        let vertices = self.values.len() / self.width.max(1);
        MatRef::from_column_major_slice(&self.values, self.width, vertices)
    }
}

/// Memory of one evaluation, used again.
#[derive(Debug, Default)]
struct Working {
    scratch: TileScratch,
    tile: Tile,
    far: FarDoublets,
}

/// The rows that one cluster contributes to.
struct ClusterRows {
    /// c φ − D φ by rows.
    rows: Vec<f64>,
    /// −S σ.
    sources: Mat<f64>,
    free_terms: Vec<PointValues>,
    working: Working,
}

impl Galerkin {
    /// With far influences to the rounding of what is done with them.
    pub(crate) fn new(surface: &CutSurface, image: Image) -> Self {
        Self::with_tolerance(surface, image, TOLERANCE)
    }

    /// `tolerance`: that of [`crate::skeleton`].
    pub(crate) fn with_tolerance(surface: &CutSurface, image: Image, tolerance: f64) -> Self {
        let n_vertices = surface.vertices.len();
        let mut weights = vec![0.0; n_vertices];
        let mut normals = Vec::new();
        let mut areas = Vec::new();
        let mut gradients = Vec::new();
        let mut tests = Vec::new();
        let mut image_tests = Vec::new();
        for corners in &surface.triangles {
            let p = corners.map(|v| surface.vertices[v as usize]);
            let vector = (p[1] - p[0]).cross(&(p[2] - p[0]));
            let twice_area = vector.norm();
            let normal = vector / twice_area;
            normals.push(normal);
            areas.push(0.5 * twice_area);
            gradients.push(std::array::from_fn(|i| {
                normal.cross(&(p[(i + 2) % 3] - p[(i + 1) % 3])) / twice_area
            }));
            tests.push(TestTriangle::new(&p));
            if image.sign().is_some() {
                image_tests.push(TestTriangle::new(&p.map(|x| image::mirrored(&x))));
            }
            for &v in corners {
                weights[v as usize] += twice_area / 6.0;
            }
        }
        let centres: Vec<Vec3> = surface
            .triangles
            .iter()
            .map(|t| {
                t.iter()
                    .map(|&v| surface.vertices[v as usize])
                    .sum::<Vec3>()
                    / 3.0
            })
            .collect();
        let order = spatial_order(&centres, RUNS);
        let blocks = vertex_blocks(&surface.vertices, &surface.triangles, &order);
        let mut galerkin = Self {
            triangles: surface.triangles.clone(),
            n_vertices,
            normals,
            areas,
            gradients,
            weights,
            tests,
            image,
            image_tests,
            constrained: surface
                .vertices
                .iter()
                .map(|v| image == Image::Odd && image::on_plane(v))
                .collect(),
            clusters: Vec::new(),
            tolerance,
            regions: Regions::default(),
            blocks,
        };
        let is_large = order.len() > EVALUATED_EVERYWHERE;
        galerkin.clusters = order
            .par_chunks(CLUSTER)
            .map(|triangles| {
                if is_large {
                    TestCluster::receiving(&galerkin, triangles)
                } else {
                    TestCluster::new(&galerkin, triangles)
                }
            })
            .collect();
        galerkin.regions = Regions::new(&galerkin.clusters, image, tolerance);
        galerkin
    }

    pub(crate) fn n_triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Vertices whose potential is zero.
    pub(crate) fn constrained(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.n_vertices).filter(|&v| self.constrained[v])
    }

    /// Weight of test function `corner` of a triangle at test point `q`; zero where the
    /// potential is given.
    pub(crate) fn test_weight(&self, triangle: usize, q: usize, corner: usize) -> f64 {
        let vertex = self.triangles[triangle][corner] as usize;
        if self.constrained[vertex] {
            return 0.0;
        }
        self.areas[triangle] / 3.0 * POINTS[q][corner] / self.weights[vertex]
    }

    /// Assembles the matrix and −S σ; `sources` holds σ at triangle corners, row
    /// 3 t + corner, one column a source.
    pub(crate) fn assemble(
        &self,
        sources: MatRef<'_, f64>,
        progress: &dyn Progress,
    ) -> Result<Assembly, BemError> {
        let n = self.n_vertices;
        let mut rows = vec![0.0; n * n];
        let mut right_hand_sides = Mat::zeros(n, sources.ncols());
        let mut free_terms = vec![0.0; 3 * self.n_triangles()];
        let sources = SourceColumns::new(sources, &self.blocks);
        let stage = "assembling body influences";
        progress.stage(stage, self.n_triangles() as u64);
        let mut memory = Vec::new();
        memory.resize_with(CLUSTERS_AT_ONCE, || ClusterRows {
            rows: Vec::new(),
            sources: Mat::new(),
            free_terms: Vec::new(),
            working: Working::default(),
        });
        for batch in self.clusters.chunks(CLUSTERS_AT_ONCE) {
            if progress.cancelled() {
                return Err(BemError::Interrupted { stage });
            }
            let evaluated = &mut memory[..batch.len()];
            batch
                .par_iter()
                .zip(evaluated.par_iter_mut())
                .for_each(|(cluster, result)| {
                    self.evaluate(cluster, &sources, result);
                    let triangles = cluster.groups.iter().map(|g| g.triangles.len());
                    progress.advance(triangles.sum::<usize>() as u64);
                });
            self.accumulate(batch, evaluated, &mut rows, &mut right_hand_sides);
            for (cluster, result) in batch.iter().zip(&*evaluated) {
                for (group, free) in cluster.groups.iter().zip(&result.free_terms) {
                    for (lane, &t) in group.triangles.iter().enumerate() {
                        for (q, values) in free.iter().enumerate() {
                            free_terms[3 * t as usize + q] = values[lane];
                        }
                    }
                }
            }
        }
        for v in (0..n).filter(|&v| self.constrained[v]) {
            rows[v * n + v] = 1.0;
        }
        Ok(Assembly {
            rows,
            right_hand_sides,
            free_terms,
        })
    }

    /// c N − D and −S σ tested over one cluster.
    fn evaluate(
        &self,
        cluster: &TestCluster,
        sources: &SourceColumns,
        result: &mut ClusterRows,
    ) {
        let (n, height) = (self.n_vertices, cluster.rows.len());
        let rows = &mut result.rows;
        rows.clear();
        rows.resize(height * n, 0.0);
        let mut near = sources.zeros(height);
        let mut sums = vec![[[0.0; WIDTH]; 3]; cluster.groups.len()];
        let Working { scratch, tile, far } = &mut result.working;
        far.clear(cluster.receiver.as_ref(), n);
        let mut far_sources = sources.zeros(far.width);
        let mut next = 0;
        for block in &self.blocks {
            let first = next;
            next += block.triangles.len();
            if let Some(receiver) = cluster.receiver_of(block) {
                scratch.fill_far(receiver, block, true, tile);
                far.add(block, tile);
                sources.add_by_columns(first, &tile.sources, &mut far_sources);
                continue;
            }
            scratch.fill(self, cluster, block, true, tile, &mut sums);
            let tested = tile.doublets.chunks_exact(block.places());
            for (row, tested) in rows.chunks_exact_mut(n).zip(tested) {
                for (&v, value) in block.columns.iter().zip(tested) {
                    row[v as usize] -= value;
                }
            }
            sources.add_by_rows(first, &tile.sources, &mut near);
        }
        let mut product = -sources.in_order(&near);
        if let Some(receiver) = &cluster.receiver {
            let tested = receiver.tested.as_ref();
            let all = MatMut::from_row_major_slice_mut(rows, height, n);
            matmul(all, Accum::Add, tested, far.doublets(), -1.0, Par::Seq);
            let far = sources.in_order(&far_sources);
            matmul(&mut product, Accum::Add, tested, &far, -1.0, Par::Seq);
        }
        let free: Vec<PointValues> = sums.iter().map(free_terms).collect();
        for (group, free) in cluster.groups.iter().zip(&free) {
            for (lane, &t) in group.triangles.iter().enumerate() {
                for (weights, places) in group.weights.iter().zip(&group.rows) {
                    let from = places[lane] as usize * n;
                    for (q, shape) in POINTS.iter().enumerate() {
                        let value = weights[q][lane] * free[q][lane];
                        for (&v, shape) in self.triangles[t as usize].iter().zip(shape) {
                            rows[from + v as usize] += value * shape;
                        }
                    }
                }
            }
        }
        result.sources = product;
        result.free_terms = free;
    }

    /// Adds the rows of a batch; one thread a matrix row, clusters in their order.
    fn accumulate(
        &self,
        batch: &[TestCluster],
        evaluated: &[ClusterRows],
        rows: &mut [f64],
        right_hand_sides: &mut Mat<f64>,
    ) {
        let n = self.n_vertices;
        let mut touching: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
        for (c, cluster) in batch.iter().enumerate() {
            for (r, &v) in cluster.rows.iter().enumerate() {
                touching[v as usize].push((c, r));
                for j in 0..right_hand_sides.ncols() {
                    right_hand_sides[(v as usize, j)] += evaluated[c].sources[(r, j)];
                }
            }
        }
        rows.par_chunks_exact_mut(n)
            .zip(&touching)
            .for_each(|(row, list)| {
                for &(c, r) in list {
                    let values = &evaluated[c].rows[r * n..(r + 1) * n];
                    for (a, d) in row.iter_mut().zip(values) {
                        *a += d;
                    }
                }
            });
    }
}
