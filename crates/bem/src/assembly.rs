//! The whole matrix c N − D by rows, from what regions and clusters receive.
//!
//! Every entry has its near part from a cluster, or its far part from one region or cluster,
//! T W times the influences at chosen points. The products are made strip by strip of rows
//! and added in the order of the parts, one thread a row.

use crate::error::BemError;
use crate::galerkin::Galerkin;
use crate::influence::{Influence, Totals, Working};
use crate::progress::Progress;
use crate::received::{Received, received};
use crate::source_columns::SourceColumns;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use rayon::prelude::*;

/// Regions and clusters held in memory at once.
pub(crate) const PARTS_AT_ONCE: usize = 16;

/// Rows of a product that one thread makes, and such strips held in memory at once.
pub(crate) const STRIP: usize = 64;
pub(crate) const STRIPS_AT_ONCE: usize = 16;

/// The assembled equations.
#[derive(Debug)]
pub(crate) struct Assembly {
    /// Matrix of c φ − D φ by rows.
    pub(crate) rows: Vec<f64>,
    /// −S σ for every source column.
    pub(crate) right_hand_sides: Mat<f64>,
    /// [`Totals::slopes`].
    pub(crate) slopes: Mat<f64>,
    /// Free term c at every test point.
    pub(crate) free_terms: Vec<f64>,
}

/// Some rows of a part.
struct Strip<'a> {
    part: &'a Received<'a>,
    influence: &'a Influence,
    from: usize,
    to: usize,
}

impl Strip<'_> {
    /// −D of what is far: vertices × rows of the strip.
    fn far(&self) -> Mat<f64> {
        let far = self.influence.far.values.transpose();
        match self.part.receiver.filter(|_| far.nrows() > 0) {
            Some(receiver) => {
                let tested = receiver.tested.subrows(self.from, self.to - self.from);
                let mut product = Mat::zeros(far.nrows(), tested.nrows());
                let tested = tested.transpose();
                matmul(&mut product, Accum::Replace, far, tested, 1.0, Par::Seq);
                product
            }
            None => Mat::zeros(0, self.to - self.from),
        }
    }
}

impl Galerkin {
    /// Assembles the matrix and −S σ; `sources` holds σ at triangle corners, row
    /// 3 t + corner, one column a source.
    pub(crate) fn assemble(
        &self,
        sources: MatRef<'_, f64>,
        progress: &dyn Progress,
    ) -> Result<Assembly, BemError> {
        let n = self.n_vertices;
        let mut rows = vec![0.0; n * n];
        let sources = SourceColumns::new(sources, &self.blocks);
        let mut totals = Totals::new(self, &sources);
        let all = received(self);
        let stage = "assembling body influences";
        progress.stage(stage, all.len() as u64);
        for batch in all.chunks(PARTS_AT_ONCE) {
            if progress.cancelled() {
                return Err(BemError::Interrupted { stage });
            }
            let influences: Vec<Influence> = batch
                .par_iter()
                .map_init(Working::default, |working, part| {
                    let influence = Influence::new(part, self, &sources, working);
                    progress.advance(1);
                    influence
                })
                .collect();
            let mut strips = Vec::new();
            for (part, influence) in batch.iter().zip(&influences) {
                totals.add(part, influence);
                let starts = (0..part.rows.len()).step_by(STRIP);
                strips.extend(starts.map(|from| Strip {
                    part,
                    influence,
                    from,
                    to: (from + STRIP).min(part.rows.len()),
                }));
            }
            for few in strips.chunks(STRIPS_AT_ONCE) {
                add(few, &mut rows, n);
            }
        }
        for v in self.constrained() {
            rows[v * n + v] = 1.0;
        }
        Ok(Assembly {
            rows,
            right_hand_sides: totals.right_hand_sides,
            slopes: totals.slopes,
            free_terms: totals.free_terms,
        })
    }
}

/// Adds strips to the rows of the matrix, in their order.
fn add(strips: &[Strip<'_>], rows: &mut [f64], n: usize) {
    let far: Vec<Mat<f64>> = strips.par_iter().map(Strip::far).collect();
    let mut touching: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
    for (s, strip) in strips.iter().enumerate() {
        for (r, &v) in strip.part.rows[strip.from..strip.to].iter().enumerate() {
            touching[v as usize].push((s, r));
        }
    }
    let add = |row: &mut [f64], columns: &[u32], values: &[f64]| {
        for (&v, value) in columns.iter().zip(values) {
            row[v as usize] += value;
        }
    };
    rows.par_chunks_exact_mut(n)
        .zip(&touching)
        .for_each(|(row, list)| {
            for &(s, r) in list {
                let Strip {
                    influence, from, ..
                } = &strips[s];
                let near = influence.near.values.col_as_slice(from + r);
                add(row, &influence.near.columns, near);
                add(row, &influence.far.columns, far[s].col_as_slice(r));
            }
        });
}
