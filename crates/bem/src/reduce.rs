//! From contracted pieces to the transfer model.

use crate::blocks::{Block, FarBlocks, NearBlocks};
use crate::boundary::ModeFields;
use crate::contour::Path;
use crate::pressure::Functionals;
use crate::solve::Problem;
use crate::transfer::TransferModel;
use crate::wake::Wake;
use crate::wake_influence::WakeBlocks;
use faer::Mat;
use fladder_mesh::Symmetry;

/// Pressure coefficient against the pressure in units of ρU²: c_p = 2p.
const COEFFICIENT: f64 = 2.0;

/// Everything the reduced model is made from.
pub(crate) struct Reduction<'a> {
    pub(crate) problem: &'a Problem<'a>,
    pub(crate) wake: &'a Wake,
    pub(crate) fields: &'a ModeFields,
    pub(crate) functionals: &'a Functionals,
    /// Potentials of the sources of [`ModeFields::sources`], without wake.
    pub(crate) potentials: &'a Mat<f64>,
    pub(crate) selector: &'a Mat<f64>,
}

impl Reduction<'_> {
    pub(crate) fn transfer(&self, mut blocks: WakeBlocks) -> TransferModel {
        self.add_carried(&mut blocks);
        let (m, onsets) = (self.fields.count, self.fields.basis.len());
        let columns = self.selector.ncols();
        let functionals = self.functionals;
        let b1 = self.potentials.subcols(0, m).to_owned();
        let b0: Vec<Mat<f64>> = (0..onsets).map(|a| self.convected_potentials(a)).collect();
        let jump = |b: &Mat<f64>| block(&(self.selector.transpose() * b));
        let products = |p: &Mat<f64>| -> Vec<Block> {
            b0.iter().map(|b| block(&(p.transpose() * b))).collect()
        };
        let p0 = &functionals.p0;
        let far = |path: &Path, values: &Mat<f64>| far_blocks(self.wake, path, values, columns);
        let paths = &self.wake.paths;
        TransferModel {
            semichord: self.problem.semichord,
            modes: m,
            columns,
            basis: self.fields.basis.clone(),
            flow: self.problem.flow,
            factor: if self.problem.symmetry == Symmetry::None {
                COEFFICIENT
            } else {
                2.0 * COEFFICIENT
            },
            jump1: jump(&b1),
            jump0: b0.iter().map(jump).collect(),
            p0_b1: p0.iter().map(|p| block(&(p.transpose() * &b1))).collect(),
            p0_b0: p0.iter().flat_map(products).collect(),
            p1_b1: block(&(functionals.p1.transpose() * &b1)),
            p1_b0: products(&functionals.p1),
            c1: functionals.c1.iter().map(block).collect(),
            c0: functionals.c0.iter().map(block).collect(),
            near: near_blocks(self.wake, &blocks.near),
            slopes: block(&blocks.slopes),
            oscillating: far(&paths.oscillating, &blocks.far[0]),
            decaying: far(&paths.decaying, &blocks.far[1]),
        }
    }

    /// b₀ of one unit onset: potentials of ∂u, zero for modes without.
    fn convected_potentials(&self, onset: usize) -> Mat<f64> {
        let (m, inertial) = (self.fields.count, &self.fields.inertial);
        let mut b0 = Mat::zeros(self.potentials.nrows(), m);
        for (e, &mode) in inertial.iter().enumerate() {
            let column = m + onset * inertial.len() + e;
            b0.col_mut(mode).copy_from(self.potentials.col(column));
        }
        b0
    }

    /// Adds the direct share of the jump on bodies to the rows of P0 and P1.
    fn add_carried(&self, blocks: &mut WakeBlocks) {
        let columns = self.selector.ncols();
        for carried in &self.functionals.carried {
            let rows = carried.p0.iter().chain(&carried.p1);
            for (i, value) in rows.enumerate() {
                blocks.near[(columns + i, carried.slot)] += value;
            }
        }
    }
}

fn block(matrix: &Mat<f64>) -> Block {
    Block::new(matrix.as_ref())
}

fn near_blocks(wake: &Wake, near: &Mat<f64>) -> NearBlocks {
    let mut stations: Vec<f64> = wake.slots.iter().map(|s| s.xi).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    let mut blocks = NearBlocks {
        stations,
        ..NearBlocks::default()
    };
    for (r, slot) in wake.slots.iter().enumerate() {
        let station = blocks.stations.partition_point(|x| *x < slot.xi);
        for &(column, weight) in &wake.threads[slot.thread] {
            blocks.entries.push((column as u32, station as u32));
            blocks
                .values
                .extend((0..near.nrows()).map(|i| weight * near[(i, r)]));
        }
    }
    blocks
}

fn far_blocks(wake: &Wake, path: &Path, far: &Mat<f64>, columns: usize) -> FarBlocks {
    let (f, n) = (far.nrows(), path.nodes.len());
    let mut re = vec![0.0; f * columns * n];
    let mut im = re.clone();
    for (line, &thread) in wake.far_threads.iter().enumerate() {
        for &(column, weight) in &wake.threads[thread] {
            for node in 0..n {
                let from = (node * columns + column) * f;
                for i in 0..f {
                    let at = 2 * (line * n + node);
                    re[from + i] += weight * far[(i, at)];
                    im[from + i] += weight * far[(i, at + 1)];
                }
            }
        }
    }
    FarBlocks::new(path, re, im)
}
