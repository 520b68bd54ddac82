//! Dense factorisation of the body operator.
//!
//! The matrix is kept by rows, one row a test function, which is column-major storage of
//! its transpose: Aᵀ is factorised and the roles of solve and transposed solve swap.

use crate::error::BemError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Right-hand sides solved together by one thread; fixed, so that results do not depend
/// on the number of threads.
const SOLVE_BLOCK: usize = 32;

/// Pivots this far below the largest leave no digit of single-precision worth.
const SMALLEST_PIVOT: f64 = 1e-13;

/// What the reduced model needs of the body operator A.
pub(crate) trait BodyOperator: Sync {
    /// Overwrites B with A⁻¹ B.
    fn solve(&self, b: &mut Mat<f64>);
    /// Overwrites B with A⁻ᵀ B.
    fn solve_transpose(&self, b: &mut Mat<f64>);
}

/// LU factors of Aᵀ with row pivoting.
#[derive(Debug)]
pub(crate) struct DenseOperator {
    size: usize,
    factors: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl DenseOperator {
    /// Factorises a square matrix given by rows.
    pub(crate) fn new(mut rows: Vec<f64>, size: usize) -> Result<Self, BemError> {
        let mut forward = vec![0; size];
        let mut inverse = vec![0; size];
        let matrix = MatMut::from_column_major_slice_mut(&mut rows, size, size);
        let mut memory = MemBuffer::new(factor::lu_in_place_scratch::<usize, f64>(
            size,
            size,
            Par::Seq,
            faer::Spec::default(),
        ));
        factor::lu_in_place(
            matrix,
            &mut forward,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut memory),
            faer::Spec::default(),
        );
        let operator = Self {
            size,
            factors: rows,
            forward,
            inverse,
        };
        operator.check()?;
        Ok(operator)
    }

    fn check(&self) -> Result<(), BemError> {
        let pivots = (0..self.size).map(|i| self.factors[i * self.size + i].abs());
        let largest = pivots.clone().fold(0.0, f64::max);
        for (pivot, value) in pivots.enumerate() {
            if value.is_nan() || value <= SMALLEST_PIVOT * largest {
                return Err(BemError::Singular {
                    pivot,
                    size: self.size,
                    value,
                });
            }
        }
        Ok(())
    }

    fn in_blocks(&self, b: &mut Mat<f64>, transposed: bool) {
        let lu = MatRef::from_column_major_slice(&self.factors, self.size, self.size);
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.size);
        let columns = b.ncols();
        let mut blocks = Vec::new();
        let mut rest = b.as_mut();
        let mut left = columns;
        while left > 0 {
            let width = left.min(SOLVE_BLOCK);
            let (head, tail) = rest.split_at_col_mut(width);
            blocks.push(head);
            rest = tail;
            left -= width;
        }
        blocks.into_par_iter().for_each(|block| {
            let request =
                solve::solve_in_place_scratch::<usize, f64>(self.size, block.ncols(), Par::Seq);
            let mut memory = MemBuffer::new(request);
            let stack = MemStack::new(&mut memory);
            if transposed {
                solve::solve_transpose_in_place(lu, lu, permutation, block, Par::Seq, stack);
            } else {
                solve::solve_in_place(lu, lu, permutation, block, Par::Seq, stack);
            }
        });
    }
}

impl BodyOperator for DenseOperator {
    fn solve(&self, b: &mut Mat<f64>) {
        self.in_blocks(b, true);
    }

    fn solve_transpose(&self, b: &mut Mat<f64>) {
        self.in_blocks(b, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_solves_invert_the_matrix_given_by_rows() {
        let n = 70;
        let entry = |i: usize, j: usize| {
            let base = (((i * 31 + j * 17) % 23) as f64 - 11.0) / 23.0;
            if i == j { base + 9.0 } else { base }
        };
        let a = Mat::from_fn(n, n, entry);
        let rows: Vec<f64> = (0..n * n).map(|e| entry(e / n, e % n)).collect();
        let operator = DenseOperator::new(rows, n).expect("regular");
        let x = Mat::from_fn(n, 40, |i, j| ((i + 3 * j) % 7) as f64);
        for (mut b, transposed) in [(&a * &x, false), (a.transpose() * &x, true)] {
            if transposed {
                operator.solve_transpose(&mut b);
            } else {
                operator.solve(&mut b);
            }
            assert!((&b - &x).norm_max() < 1e-12);
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let rows = vec![1.0, 2.0, 2.0, 4.0];
        assert!(matches!(
            DenseOperator::new(rows, 2),
            Err(BemError::Singular { .. })
        ));
    }
}
