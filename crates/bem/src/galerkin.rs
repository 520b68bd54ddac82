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
use crate::near_field::{POINTS, Spheres, TestTriangle};
use crate::panels::{CornerValues, PanelScratch, PanelSet};
use crate::progress::Progress;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use fladder_mesh::Vec3;
use rayon::prelude::*;

/// Triangles whose test points one task evaluates; fixed, so that the order of sums does
/// not depend on the number of threads.
pub(crate) const TASK_TRIANGLES: usize = 16;

/// Tasks held in memory at once.
const TASKS_AT_ONCE: usize = 32;

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
    panels: PanelSet,
    spheres: Spheres,
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

struct TaskRows {
    doublets: Vec<f64>,
    sources: Mat<f64>,
    free_terms: Vec<f64>,
}

impl Galerkin {
    pub(crate) fn new(surface: &CutSurface, image: Image) -> Self {
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
        let panels = PanelSet::new(&surface.vertices, &surface.triangles);
        Self {
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
            spheres: Spheres::new(&panels),
            panels,
        }
    }

    pub(crate) fn n_triangles(&self) -> usize {
        self.triangles.len()
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
        let columns = sources.ncols();
        let mut rows = vec![0.0; n * n];
        let mut right_hand_sides = Mat::zeros(n, columns);
        let mut free_terms = vec![0.0; 3 * self.n_triangles()];
        progress.stage("assembling body influences", self.n_triangles() as u64);
        let tasks: Vec<usize> = (0..self.n_triangles()).step_by(TASK_TRIANGLES).collect();
        for batch in tasks.chunks(TASKS_AT_ONCE) {
            if progress.cancelled() {
                return Err(BemError::Interrupted {
                    stage: "assembling body influences",
                });
            }
            let evaluated: Vec<TaskRows> = batch
                .par_iter()
                .map(|&first| {
                    let result = self.evaluate(first, sources);
                    progress.advance(self.task_triangles(first).len() as u64);
                    result
                })
                .collect();
            self.accumulate(batch, &evaluated, &mut rows, &mut right_hand_sides);
            for (&first, task) in batch.iter().zip(&evaluated) {
                free_terms[3 * first..3 * first + task.free_terms.len()]
                    .copy_from_slice(&task.free_terms);
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

    pub(crate) fn task_triangles(&self, first: usize) -> std::ops::Range<usize> {
        first..(first + TASK_TRIANGLES).min(self.n_triangles())
    }

    /// c N − D and −S σ at the test points of one task.
    fn evaluate(&self, first: usize, sources: MatRef<'_, f64>) -> TaskRows {
        let range = self.task_triangles(first);
        let n_points = 3 * range.len();
        let mut seen = Seen::new(self);
        let mut doublets = vec![0.0; n_points * self.n_vertices];
        let mut influences = vec![[0.0; 3]; n_points * self.n_triangles()];
        let mut free_terms = Vec::with_capacity(n_points);
        for ((t, rows), s) in range
            .zip(doublets.chunks_exact_mut(3 * self.n_vertices))
            .zip(influences.chunks_exact_mut(3 * self.n_triangles()))
        {
            let mut free = [1.0; 3];
            seen.from(&self.tests[t], s, rows);
            for (free, row) in free.iter_mut().zip(rows.chunks_exact(self.n_vertices)) {
                *free -= row.iter().sum::<f64>();
            }
            if let Some(sign) = self.image.sign() {
                let other = seen.seen_from_image(&self.image_tests[t]);
                for (s, value) in s.as_flattened_mut().iter_mut().zip(other.sources) {
                    *s += sign * value;
                }
                for ((free, row), image) in free
                    .iter_mut()
                    .zip(rows.chunks_exact_mut(self.n_vertices))
                    .zip(other.rows.chunks_exact(self.n_vertices))
                {
                    *free -= image.iter().sum::<f64>();
                    for (value, image) in row.iter_mut().zip(image) {
                        *value += sign * image;
                    }
                }
            }
            for ((free, row), point) in free
                .iter()
                .zip(rows.chunks_exact_mut(self.n_vertices))
                .zip(&POINTS)
            {
                for (&v, shape) in self.triangles[t].iter().zip(point) {
                    row[v as usize] += free * shape;
                }
            }
            free_terms.extend(free);
        }
        let influences = influences.as_flattened();
        let transposed =
            MatRef::from_column_major_slice(influences, 3 * self.n_triangles(), n_points);
        let mut product = Mat::zeros(n_points, sources.ncols());
        matmul(
            &mut product,
            Accum::Replace,
            transposed.transpose(),
            sources,
            -1.0,
            Par::Seq,
        );
        TaskRows {
            doublets,
            sources: product,
            free_terms,
        }
    }

    /// Adds the tested rows; one thread a matrix row, tasks in their order.
    fn accumulate(
        &self,
        batch: &[usize],
        evaluated: &[TaskRows],
        rows: &mut [f64],
        right_hand_sides: &mut Mat<f64>,
    ) {
        let mut touching: Vec<Vec<(usize, usize, f64)>> = vec![Vec::new(); self.n_vertices];
        for (task, &first) in batch.iter().enumerate() {
            for (local, t) in self.task_triangles(first).enumerate() {
                for q in 0..3 {
                    for (corner, &v) in self.triangles[t].iter().enumerate() {
                        let weight = self.test_weight(t, q, corner);
                        touching[v as usize].push((task, 3 * local + q, weight));
                    }
                }
            }
        }
        rows.par_chunks_exact_mut(self.n_vertices)
            .zip(&touching)
            .for_each(|(row, list)| {
                for &(task, point, weight) in list {
                    let from = point * self.n_vertices;
                    let values = &evaluated[task].doublets[from..from + self.n_vertices];
                    for (a, d) in row.iter_mut().zip(values) {
                        *a += weight * d;
                    }
                }
            });
        for (v, list) in touching.iter().enumerate() {
            for &(task, point, weight) in list {
                for c in 0..right_hand_sides.ncols() {
                    right_hand_sides[(v, c)] += weight * evaluated[task].sources[(point, c)];
                }
            }
        }
    }
}

/// Working space for what test triangles see of the surface.
struct Seen<'a> {
    of: &'a Galerkin,
    scratch: PanelScratch,
    doublets: [Vec<CornerValues>; 3],
    image_rows: Vec<f64>,
    image_sources: Vec<CornerValues>,
}

/// What the points of an image see.
struct ImageSeen<'a> {
    rows: &'a [f64],
    sources: &'a [f64],
}

impl<'a> Seen<'a> {
    fn new(of: &'a Galerkin) -> Self {
        let has_image = usize::from(of.image.sign().is_some());
        Self {
            of,
            scratch: of.panels.scratch(),
            doublets: std::array::from_fn(|_| vec![[0.0; 3]; of.n_triangles()]),
            image_rows: vec![0.0; has_image * 3 * of.n_vertices],
            image_sources: vec![[0.0; 3]; has_image * 3 * of.n_triangles()],
        }
    }

    /// Subtracts D from the three `rows` of vertices and puts S into `sources`.
    fn from(&mut self, test: &TestTriangle, sources: &mut [CornerValues], rows: &mut [f64]) {
        let n = self.of.n_triangles();
        let (first, rest) = sources.split_at_mut(n);
        let (second, third) = rest.split_at_mut(n);
        test.doublets_and_sources(
            &self.of.panels,
            &self.of.spheres,
            &mut self.scratch,
            &mut self.doublets,
            &mut [first, second, third],
        );
        for (row, d) in rows
            .chunks_exact_mut(self.of.n_vertices)
            .zip(&self.doublets)
        {
            for (corners, values) in self.of.triangles.iter().zip(d) {
                for (&v, value) in corners.iter().zip(values) {
                    row[v as usize] -= value;
                }
            }
        }
    }

    /// As [`Self::from`], into own memory.
    fn seen_from_image(&mut self, test: &TestTriangle) -> ImageSeen<'_> {
        let mut rows = std::mem::take(&mut self.image_rows);
        let mut sources = std::mem::take(&mut self.image_sources);
        rows.fill(0.0);
        self.from(test, &mut sources, &mut rows);
        self.image_rows = rows;
        self.image_sources = sources;
        ImageSeen {
            rows: &self.image_rows,
            sources: self.image_sources.as_flattened(),
        }
    }
}
