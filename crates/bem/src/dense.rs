//! Dense factorisation of the body operator.
//!
//! The matrix is kept by rows, one row a test function, which is column-major storage of
//! its transpose: Aᵀ is factorised and the roles of solve and transposed solve swap.
//!
//! The factors are in single precision by default. The operator is of the second kind, its
//! condition some tens whatever the mesh, so that a solution from them is right to six
//! digits, and each refinement x += A⁻¹(b − A x) with the residual in double precision
//! gives six or seven more: two leave the rounding of double precision.

use crate::blocked_lu::BlockedLu;
use crate::error::BemError;
use crate::hierarchical::HierarchicalOperator;
use crate::progress::Progress;
use crate::skeleton;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Rows of a product that one thread makes.
const PRODUCT_ROWS: usize = 256;

/// Refinements of a solution from single-precision factors.
const REFINEMENTS: u64 = 2;

/// Pivots this far below the largest leave no digit, in double and in single precision.
const SMALLEST_PIVOT: f64 = 1e-13;
const SMALLEST_SINGLE_PIVOT: f64 = 1e-6;

/// What the reduced model needs of the body operator A.
pub(crate) trait BodyOperator: Sync {
    /// Overwrites B with A⁻¹ B.
    ///
    /// # Errors
    /// An iteration that does not converge or is interrupted.
    fn solve(&self, b: &mut Mat<f64>, progress: &dyn Progress) -> Result<(), BemError>;
    /// Overwrites B with A⁻ᵀ B.
    ///
    /// # Errors
    /// As [`Self::solve`].
    fn solve_transpose(
        &self,
        b: &mut Mat<f64>,
        progress: &dyn Progress,
    ) -> Result<(), BemError>;
}

/// How the equations of the body are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Solver {
    /// Factors in single precision, and two refinements with the matrix in double precision.
    #[default]
    Refined,
    /// Factors in double precision.
    Double,
    /// A hierarchical matrix and an iteration; for more unknowns than a matrix can hold.
    Hierarchical {
        /// Relative error of its blocks and of the iteration.
        tolerance: f64,
    },
}

impl Solver {
    /// Vertices beyond which a matrix is not kept in full.
    pub const LARGEST_DENSE: usize = 20_000;
    /// Keeps Q to some 1e-5 of its largest entry.
    pub const TOLERANCE: f64 = 1e-6;

    /// Tolerance of far influences: that of blocks, with a digit to spare.
    pub(crate) fn far_tolerance(self) -> f64 {
        match self {
            Self::Refined | Self::Double => skeleton::TOLERANCE,
            Self::Hierarchical { tolerance } => (0.1 * tolerance).max(skeleton::TOLERANCE),
        }
    }

    /// Dense up to [`Self::LARGEST_DENSE`] vertices, hierarchical beyond.
    pub fn automatic(vertices: usize) -> Self {
        if vertices > Self::LARGEST_DENSE {
            Self::Hierarchical {
                tolerance: Self::TOLERANCE,
            }
        } else {
            Self::Refined
        }
    }
}

/// LU factors of Aᵀ.
#[derive(Debug)]
pub(crate) enum DenseOperator {
    Refined {
        /// A by rows.
        rows: Vec<f64>,
        factors: BlockedLu<f32>,
    },
    Double(BlockedLu<f64>),
}

impl DenseOperator {
    /// Factorises a square matrix given by rows.
    pub(crate) fn new(
        rows: Vec<f64>,
        size: usize,
        is_double: bool,
        progress: &dyn Progress,
    ) -> Result<Self, BemError> {
        let stage = "factorising";
        progress.stage(stage, size as u64);
        let advance = |columns: usize| progress.advance(columns as u64);
        let operator = if is_double {
            let factors = BlockedLu::new(rows, size, &advance);
            factors.check(SMALLEST_PIVOT, |x| x)?;
            Self::Double(factors)
        } else {
            let mut single = vec![0.0; rows.len()];
            single
                .par_chunks_mut(1 << 16)
                .zip(rows.par_chunks(1 << 16))
                .for_each(|(single, double)| {
                    for (s, d) in single.iter_mut().zip(double) {
                        *s = *d as f32;
                    }
                });
            let factors = BlockedLu::new(single, size, &advance);
            factors.check(SMALLEST_SINGLE_PIVOT, f64::from)?;
            Self::Refined { rows, factors }
        };
        if progress.cancelled() {
            return Err(BemError::Interrupted { stage });
        }
        Ok(operator)
    }

    fn solve_either(&self, b: &mut Mat<f64>, transposed: bool, progress: &dyn Progress) {
        match self {
            Self::Double(factors) => {
                progress.stage("solving", 1);
                factors.solve(b.as_mut(), !transposed);
            }
            Self::Refined { rows, factors } => {
                progress.stage("solving", REFINEMENTS + 1);
                let right = b.clone();
                let n = right.nrows();
                let matrix = MatRef::from_row_major_slice(rows, n, n);
                let matrix = if transposed {
                    matrix.transpose()
                } else {
                    matrix
                };
                let mut residual = right.clone();
                b.as_mut().fill(0.0);
                for step in 0..=REFINEMENTS {
                    correct(factors, b.as_mut(), residual.as_ref(), !transposed);
                    if step < REFINEMENTS {
                        residual.copy_from(&right);
                        subtract_product(matrix, b.as_ref(), residual.as_mut());
                    }
                    progress.advance(1);
                }
            }
        }
    }
}

/// x += the solution of single precision for the residual.
fn correct(
    factors: &BlockedLu<f32>,
    x: MatMut<'_, f64>,
    residual: MatRef<'_, f64>,
    transposed: bool,
) {
    let (n, columns) = (x.nrows(), x.ncols());
    // Scaled to one, so that small columns keep their digits.
    let scale: Vec<f64> = (0..columns)
        .into_par_iter()
        .map(|j| residual.col(j).norm_max())
        .map(|size| if size > 0.0 { size } else { 1.0 })
        .collect();
    let mut single = Mat::<f32>::zeros(n, columns);
    single
        .par_col_chunks_mut(1)
        .enumerate()
        .for_each(|(j, mut column)| {
            for i in 0..n {
                column[(i, 0)] = (residual[(i, j)] / scale[j]) as f32;
            }
        });
    factors.solve(single.as_mut(), transposed);
    x.par_col_chunks_mut(1)
        .enumerate()
        .for_each(|(j, mut column)| {
            for i in 0..n {
                column[(i, 0)] += scale[j] * f64::from(single[(i, j)]);
            }
        });
}

/// R −= A X, each thread some rows.
fn subtract_product(a: MatRef<'_, f64>, x: MatRef<'_, f64>, r: MatMut<'_, f64>) {
    r.par_row_chunks_mut(PRODUCT_ROWS)
        .enumerate()
        .for_each(|(chunk, mut part)| {
            let rows = a.subrows(chunk * PRODUCT_ROWS, part.nrows());
            matmul(&mut part, Accum::Add, rows, x, -1.0, Par::Seq);
        });
}

/// The factorised or compressed body operator.
#[derive(Debug)]
pub(crate) enum Operator {
    Dense(DenseOperator),
    Hierarchical(HierarchicalOperator),
}

impl BodyOperator for Operator {
    fn solve(&self, b: &mut Mat<f64>, progress: &dyn Progress) -> Result<(), BemError> {
        match self {
            Self::Dense(operator) => operator.solve(b, progress),
            Self::Hierarchical(operator) => operator.solve(b, progress),
        }
    }

    fn solve_transpose(
        &self,
        b: &mut Mat<f64>,
        progress: &dyn Progress,
    ) -> Result<(), BemError> {
        match self {
            Self::Dense(operator) => operator.solve_transpose(b, progress),
            Self::Hierarchical(operator) => operator.solve_transpose(b, progress),
        }
    }
}

impl BodyOperator for DenseOperator {
    fn solve(&self, b: &mut Mat<f64>, progress: &dyn Progress) -> Result<(), BemError> {
        self.solve_either(b, false, progress);
        Ok(())
    }

    fn solve_transpose(
        &self,
        b: &mut Mat<f64>,
        progress: &dyn Progress,
    ) -> Result<(), BemError> {
        self.solve_either(b, true, progress);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;

    /// Also across the borders of blocks and chunks, with rows that must change places.
    #[test]
    fn both_solves_invert_the_matrix_given_by_rows() {
        for n in [1, 70, 256, 700] {
            let entry = |i: usize, j: usize| {
                let base = (((i * 31 + j * 17 + i * j % 7) % 23) as f64 - 11.0) / 23.0;
                if (i + 5) % n == j {
                    base + 9.0 + (n as f64).sqrt()
                } else {
                    base
                }
            };
            let a = Mat::from_fn(n, n, entry);
            let rows: Vec<f64> = (0..n * n).map(|e| entry(e / n, e % n)).collect();
            for is_double in [false, true] {
                let operator =
                    DenseOperator::new(rows.clone(), n, is_double, &Silent).expect("regular");
                let x = Mat::from_fn(n, 80, |i, j| ((i + 3 * j) % 7) as f64);
                for (mut b, transposed) in [(&a * &x, false), (a.transpose() * &x, true)] {
                    if transposed {
                        operator.solve_transpose(&mut b, &Silent).expect("solved");
                    } else {
                        operator.solve(&mut b, &Silent).expect("solved");
                    }
                    let error = (&b - &x).norm_max();
                    println!(
                        "{n} unknowns, double {is_double}, transposed {transposed}: {error:.1e}"
                    );
                    assert!(error < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        for is_double in [false, true] {
            let rows = vec![1.0, 2.0, 2.0, 4.0];
            assert!(matches!(
                DenseOperator::new(rows, 2, is_double, &Silent),
                Err(BemError::Singular { .. })
            ));
        }
    }
}
