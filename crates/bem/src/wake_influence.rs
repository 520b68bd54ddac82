//! The wake's influence at the test points, tested and contracted on the fly.
//!
//! Nothing of size points × wake is kept: a task evaluates its test points and leaves
//! either rows summed over the wake (steady) or small blocks Lᵀ T W (reduced model).

use crate::contour::Path;
use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::near_field::{POINTS, Spheres, TestTriangle};
use crate::panels::{CornerValues, PanelScratch};
use crate::progress::Progress;
use crate::wake::Wake;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, c64};
use rayon::prelude::*;
use std::ops::{AddAssign, Mul};

/// Parts into which the test points are divided; each sums by itself and the parts are
/// added in order, so that the number of threads does not change a bit.
const PARTS: usize = 16;

/// Influence of every slot, and of every far streamline at every node.
pub(crate) struct WakeBlocks {
    /// Lᵀ T W of each slot: functionals × slots.
    pub(crate) near: Mat<f64>,
    /// One a path: functionals × (streamlines × nodes × 2), real and imaginary part beside
    /// each other, weights of the path included.
    pub(crate) far: Vec<Mat<f64>>,
}

/// Evaluates a wake over a surface.
pub(crate) struct WakeInfluence<'a> {
    pub(crate) galerkin: &'a Galerkin,
    pub(crate) wake: &'a Wake,
    pub(crate) free_terms: &'a [f64],
}

impl WakeInfluence<'_> {
    /// T W(0): test functions × columns, the steady wake.
    pub(crate) fn steady(
        &self,
        columns: usize,
        progress: &dyn Progress,
    ) -> Result<Mat<f64>, BemError> {
        let path = &self.wake.paths.oscillating;
        self.tested_rows(columns, progress, |evaluator, t, q, out| {
            evaluator.steady_row(t, q, path, out);
        })
    }

    /// Contracts the wake with functionals given on the vertices: `left` has one
    /// column a functional.
    pub(crate) fn blocks(
        &self,
        left: MatRef<'_, f64>,
        progress: &dyn Progress,
    ) -> Result<WakeBlocks, BemError> {
        let stage = "contracting the wake";
        let n_triangles = self.galerkin.n_triangles();
        progress.stage(stage, n_triangles as u64);
        let size = n_triangles.div_ceil(PARTS);
        let parts: Vec<WakeBlocks> = (0..PARTS)
            .into_par_iter()
            .map(|part| {
                let range =
                    (part * size).min(n_triangles)..((part + 1) * size).min(n_triangles);
                self.part(range, left, progress)
            })
            .collect();
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        let mut parts = parts.into_iter();
        let mut total = parts.next().expect("there is at least one part");
        for part in parts {
            total.near += part.near;
            for (sum, far) in total.far.iter_mut().zip(part.far) {
                *sum += far;
            }
        }
        Ok(total)
    }

    fn part(
        &self,
        range: std::ops::Range<usize>,
        left: MatRef<'_, f64>,
        progress: &dyn Progress,
    ) -> WakeBlocks {
        let functionals = left.ncols();
        let paths = [&self.wake.paths.oscillating, &self.wake.paths.decaying];
        let lines = self.wake.far.anchors.len();
        let mut blocks = WakeBlocks {
            near: Mat::zeros(functionals, self.wake.slots.len()),
            far: paths
                .map(|p| Mat::zeros(functionals, 2 * lines * p.nodes.len()))
                .to_vec(),
        };
        let mut evaluator = Evaluator::new(self);
        for first in range.clone().step_by(crate::galerkin::TASK_TRIANGLES) {
            if progress.cancelled() {
                return blocks;
            }
            let triangles = first..(first + crate::galerkin::TASK_TRIANGLES).min(range.end);
            self.contract(triangles.clone(), left, &mut evaluator, &mut blocks);
            progress.advance(triangles.len() as u64);
        }
        blocks
    }

    fn contract(
        &self,
        triangles: std::ops::Range<usize>,
        left: MatRef<'_, f64>,
        evaluator: &mut Evaluator<'_>,
        blocks: &mut WakeBlocks,
    ) {
        let n_points = 3 * triangles.len();
        let slots = self.wake.slots.len();
        let paths = [&self.wake.paths.oscillating, &self.wake.paths.decaying];
        let lines = self.wake.far.anchors.len();
        let mut tested = Mat::<f64>::zeros(left.ncols(), n_points);
        let mut near = vec![0.0; n_points * slots];
        let mut far = paths.map(|p| vec![0.0; 2 * n_points * lines * p.nodes.len()]);
        for (i, t) in triangles.enumerate() {
            evaluator.near(t);
            for q in 0..3 {
                let p = 3 * i + q;
                for (corner, &v) in self.galerkin.triangles[t].iter().enumerate() {
                    let weight = self.galerkin.test_weight(t, q, corner);
                    for f in 0..left.ncols() {
                        tested[(f, p)] += weight * left[(v as usize, f)];
                    }
                }
                near[p * slots..(p + 1) * slots].copy_from_slice(&evaluator.slots[q]);
                for (path, out) in paths.iter().zip(&mut far) {
                    let width = 2 * lines * path.nodes.len();
                    evaluator.far_parts(t, q, path, &mut out[p * width..(p + 1) * width]);
                }
            }
        }
        let near = MatRef::from_column_major_slice(&near, slots, n_points);
        matmul(
            &mut blocks.near,
            Accum::Add,
            &tested,
            near.transpose(),
            1.0,
            Par::Seq,
        );
        for ((block, values), path) in blocks.far.iter_mut().zip(&far).zip(paths) {
            let width = 2 * lines * path.nodes.len();
            let values = MatRef::from_column_major_slice(values, width, n_points);
            matmul(
                block,
                Accum::Add,
                &tested,
                values.transpose(),
                1.0,
                Par::Seq,
            );
        }
    }
}

impl WakeInfluence<'_> {
    /// T W(s): test functions × columns.
    pub(crate) fn tested(
        &self,
        s: c64,
        columns: usize,
        progress: &dyn Progress,
    ) -> Result<Mat<c64>, BemError> {
        let path = self.wake.paths.of(s);
        self.tested_rows(columns, progress, |evaluator, t, q, out| {
            evaluator.row(t, q, s, path, out);
        })
    }

    /// Test functions × columns of rows that `fill` gives at each of a triangle's points.
    fn tested_rows<T>(
        &self,
        columns: usize,
        progress: &dyn Progress,
        fill: impl Fn(&mut Evaluator<'_>, usize, usize, &mut [T]) + Sync,
    ) -> Result<Mat<T>, BemError>
    where
        T: Copy + Default + Send + AddAssign + Mul<f64, Output = T>,
    {
        let stage = "evaluating the wake";
        let n_triangles = self.galerkin.n_triangles();
        progress.stage(stage, n_triangles as u64);
        let rows: Vec<Vec<T>> = (0..n_triangles)
            .into_par_iter()
            .map_init(
                || Evaluator::new(self),
                |evaluator, t| {
                    if progress.cancelled() {
                        return Vec::new();
                    }
                    let mut out = vec![T::default(); 3 * columns];
                    evaluator.near(t);
                    for (q, part) in out.chunks_exact_mut(columns).enumerate() {
                        fill(evaluator, t, q, part);
                    }
                    progress.advance(1);
                    out
                },
            )
            .collect();
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        let mut tested = Mat::from_fn(self.galerkin.n_vertices, columns, |_, _| T::default());
        for (t, row) in rows.iter().enumerate() {
            for (q, values) in row.chunks_exact(columns).enumerate() {
                for (corner, &v) in self.galerkin.triangles[t].iter().enumerate() {
                    let weight = self.galerkin.test_weight(t, q, corner);
                    for (c, &value) in values.iter().enumerate() {
                        tested[(v as usize, c)] += value * weight;
                    }
                }
            }
        }
        Ok(tested)
    }
}

/// Working space of one thread.
struct Evaluator<'a> {
    of: &'a WakeInfluence<'a>,
    near_spheres: Spheres,
    near_scratch: PanelScratch,
    near_values: [Vec<CornerValues>; 3],
    body_spheres: Spheres,
    body_scratch: PanelScratch,
    body_values: [Vec<CornerValues>; 3],
    /// Influence of every slot at the three points of the triangle last asked for.
    slots: [Vec<f64>; 3],
    distances: Vec<c64>,
    lines: Vec<c64>,
    image_far: Vec<c64>,
}

impl<'a> Evaluator<'a> {
    fn new(of: &'a WakeInfluence<'a>) -> Self {
        let wake = of.wake;
        let values = |n: usize| std::array::from_fn(|_| vec![[0.0; 3]; n]);
        Self {
            of,
            near_spheres: Spheres::new(&wake.near.panels),
            near_scratch: wake.near.panels.scratch(),
            near_values: values(wake.near.panels.len()),
            body_spheres: Spheres::new(&wake.body.panels),
            body_scratch: wake.body.panels.scratch(),
            body_values: values(wake.body.panels.len()),
            slots: std::array::from_fn(|_| vec![0.0; wake.slots.len()]),
            distances: Vec::new(),
            lines: Vec::new(),
            image_far: Vec::new(),
        }
    }

    /// Influence of every slot at the points of one triangle: free sheet, and on bodies
    /// D^up − c N^up of the corners that carry a jump; the image's sheet with its sign.
    fn near(&mut self, triangle: usize) {
        let galerkin = self.of.galerkin;
        for out in &mut self.slots {
            out.fill(0.0);
        }
        self.seen_from(&galerkin.tests[triangle], Some(triangle), 1.0);
        if let Some(sign) = galerkin.image.sign() {
            self.seen_from(&galerkin.image_tests[triangle], None, sign);
        }
    }

    /// Adds sign × the influence of the sheets; `own` is the triangle where c N^up acts.
    fn seen_from(&mut self, test: &TestTriangle, own: Option<usize>, sign: f64) {
        let wake = self.of.wake;
        test.doublets(
            &wake.near.panels,
            &self.near_spheres,
            &mut self.near_scratch,
            &mut self.near_values,
        );
        test.doublets(
            &wake.body.panels,
            &self.body_spheres,
            &mut self.body_scratch,
            &mut self.body_values,
        );
        if let Some(triangle) = own {
            self.subtract_free_term(triangle);
        }
        for (q, out) in self.slots.iter_mut().enumerate() {
            wake.near.gather(&self.near_values[q], sign, out);
            wake.body.gather(&self.body_values[q], sign, out);
        }
    }

    /// −c N^up where the points lie on a triangle whose corners carry jumps.
    fn subtract_free_term(&mut self, triangle: usize) {
        // A triangle is there once for each jump that a corner carries.
        let carrying = &self.of.wake.body.body_triangles;
        let first = carrying.partition_point(|&t| (t as usize) < triangle);
        let same = carrying[first..]
            .iter()
            .take_while(|&&t| t as usize == triangle)
            .count();
        for (q, values) in self.body_values.iter_mut().enumerate() {
            let free = self.of.free_terms[3 * triangle + q];
            for corners in &mut values[first..first + same] {
                for (value, shape) in corners.iter_mut().zip(&POINTS[q]) {
                    *value -= free * shape;
                }
            }
        }
    }

    /// Influence of every streamline at every node of a path.
    fn far_row(&mut self, triangle: usize, q: usize, path: &Path, out: &mut [c64]) {
        let galerkin = self.of.galerkin;
        let far = &self.of.wake.far;
        let point = galerkin.tests[triangle].points[q];
        far.influence(point, &path.nodes, &path.weights, &mut self.distances, out);
        if let Some(sign) = galerkin.image.sign() {
            let point = galerkin.image_tests[triangle].points[q];
            self.image_far.resize(out.len(), c64::new(0.0, 0.0));
            far.influence(
                point,
                &path.nodes,
                &path.weights,
                &mut self.distances,
                &mut self.image_far,
            );
            for (value, image) in out.iter_mut().zip(&self.image_far) {
                *value += sign * image;
            }
        }
    }

    /// As [`Self::far_row`], real and imaginary parts beside each other.
    fn far_parts(&mut self, triangle: usize, q: usize, path: &Path, out: &mut [f64]) {
        let mut lines = std::mem::take(&mut self.lines);
        lines.resize(out.len() / 2, c64::new(0.0, 0.0));
        self.far_row(triangle, q, path, &mut lines);
        for (pair, value) in out.chunks_exact_mut(2).zip(&lines) {
            pair.copy_from_slice(&[value.re, value.im]);
        }
        self.lines = lines;
    }

    /// Influence of every column at s = 0 at one point of the triangle last asked for.
    fn steady_row(&mut self, triangle: usize, q: usize, path: &Path, out: &mut [f64]) {
        let wake = self.of.wake;
        for (slot, value) in wake.slots.iter().zip(&self.slots[q]) {
            for &(column, weight) in &wake.threads[slot.thread] {
                out[column] += weight * value;
            }
        }
        let n = path.nodes.len();
        let mut lines = std::mem::take(&mut self.lines);
        lines.resize(wake.far.anchors.len() * n, c64::new(0.0, 0.0));
        self.far_row(triangle, q, path, &mut lines);
        for (values, &thread) in lines.chunks_exact(n).zip(&wake.far_threads) {
            let sum: f64 = values.iter().map(|v| v.re).sum();
            for &(column, weight) in &wake.threads[thread] {
                out[column] += weight * sum;
            }
        }
        self.lines = lines;
    }

    /// Influence of every column at s at one point of the triangle last asked for.
    fn row(&mut self, triangle: usize, q: usize, s: c64, path: &Path, out: &mut [c64]) {
        let wake = self.of.wake;
        for (slot, value) in wake.slots.iter().zip(&self.slots[q]) {
            let decay = (-s * slot.xi).exp();
            for &(column, weight) in &wake.threads[slot.thread] {
                out[column] += weight * value * decay;
            }
        }
        let n = path.nodes.len();
        let mut lines = std::mem::take(&mut self.lines);
        lines.resize(wake.far.anchors.len() * n, c64::new(0.0, 0.0));
        self.far_row(triangle, q, path, &mut lines);
        for (values, &thread) in lines.chunks_exact(n).zip(&wake.far_threads) {
            let sum: c64 = values
                .iter()
                .zip(&path.nodes)
                .map(|(value, xi)| value * (-s * xi).exp())
                .sum();
            for &(column, weight) in &wake.threads[thread] {
                out[column] += weight * sum;
            }
        }
        self.lines = lines;
    }
}
