//! Dense linear algebra in double precision, real and complex.
//!
//! Every call of the matrix library sits here, with concrete types and with
//! threads switched off inside: the loops over speeds and cells are parallel
//! outside, and the results keep their bits at any thread count.
//!
//! The generalised eigenvalue routine of the library is not used: with
//! vectors it takes a second for orders between 78 and 96. A quadratic problem
//! is solved as a standard one, after its leading matrix has been factorised.

use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{self, ComputeEigenvectors};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::linalg::svd::{self, ComputeSvdVectors};
use faer::perm::PermRef;
use faer::{Accum, Conj, Mat, MatMut, MatRef, Par, c64};

/// The iteration for eigenvalues or singular values did not converge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "an eigenvalue iteration of order {order} did not converge or met a value that is not finite"
)]
pub struct NoConvergence {
    /// Order of the matrix.
    pub order: usize,
}

/// Eigenvalues of a general complex matrix, in the order of the Schur form.
pub(crate) fn eigenvalues(matrix: MatRef<'_, c64>) -> Result<Vec<c64>, NoConvergence> {
    let order = matrix.nrows();
    let no = ComputeEigenvectors::No;
    let scratch = evd::evd_scratch::<c64>(order, no, no, Par::Seq, faer::Spec::default());
    let mut buffer = MemBuffer::new(scratch);
    let mut values = vec![c64::new(0.0, 0.0); order];
    evd::evd_cplx::<f64>(
        matrix,
        DiagMut::from_slice_mut(&mut values),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut buffer),
        faer::Spec::default(),
    )
    .map_err(|_| NoConvergence { order })?;
    Ok(values)
}

/// Eigenvalues of a general real matrix: exactly real, or in exact conjugate
/// pairs.
pub(crate) fn eigenvalues_real(matrix: MatRef<'_, f64>) -> Result<Vec<c64>, NoConvergence> {
    let order = matrix.nrows();
    let no = ComputeEigenvectors::No;
    let scratch = evd::evd_scratch::<f64>(order, no, no, Par::Seq, faer::Spec::default());
    let mut buffer = MemBuffer::new(scratch);
    let (mut real, mut imaginary) = (vec![0.0; order], vec![0.0; order]);
    evd::evd_real::<f64>(
        matrix,
        DiagMut::from_slice_mut(&mut real),
        DiagMut::from_slice_mut(&mut imaginary),
        None,
        None,
        Par::Seq,
        MemStack::new(&mut buffer),
        faer::Spec::default(),
    )
    .map_err(|_| NoConvergence { order })?;
    Ok(real
        .into_iter()
        .zip(imaginary)
        .map(|(re, im)| c64::new(re, im))
        .collect())
}

/// LU factorisation with partial pivoting of a square complex matrix.
pub(crate) struct Lu {
    factors: Mat<c64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl Lu {
    /// Factorises; a singular matrix leaves a zero pivot and no error.
    pub(crate) fn new(mut matrix: Mat<c64>) -> Self {
        let order = matrix.nrows();
        let (mut forward, mut inverse) = (vec![0; order], vec![0; order]);
        let scratch = factor::lu_in_place_scratch::<usize, c64>(
            order,
            order,
            Par::Seq,
            faer::Spec::default(),
        );
        let mut buffer = MemBuffer::new(scratch);
        factor::lu_in_place(
            matrix.as_mut(),
            &mut forward,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut buffer),
            faer::Spec::default(),
        );
        Self {
            factors: matrix,
            forward,
            inverse,
        }
    }

    fn permutation(&self) -> PermRef<'_, usize> {
        PermRef::new_checked(&self.forward, &self.inverse, self.forward.len())
    }

    /// Replaces `rhs` by the solution of `A x = rhs`.
    pub(crate) fn solve(&self, rhs: MatMut<'_, c64>) {
        let (order, columns) = (self.factors.nrows(), rhs.ncols());
        let scratch = solve::solve_in_place_scratch::<usize, c64>(order, columns, Par::Seq);
        solve::solve_in_place_with_conj(
            self.factors.as_ref(),
            self.factors.as_ref(),
            self.permutation(),
            Conj::No,
            rhs,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }

    /// Replaces `rhs` by the solution of `A^H x = rhs`.
    pub(crate) fn solve_adjoint(&self, rhs: MatMut<'_, c64>) {
        let (order, columns) = (self.factors.nrows(), rhs.ncols());
        let scratch =
            solve::solve_transpose_in_place_scratch::<usize, c64>(order, columns, Par::Seq);
        solve::solve_transpose_in_place_with_conj(
            self.factors.as_ref(),
            self.factors.as_ref(),
            self.permutation(),
            Conj::Yes,
            rhs,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }

    /// Determinant as its logarithm's real part and its direction in the
    /// complex plane, which cannot overflow. A singular matrix gives minus
    /// infinity.
    #[cfg(test)]
    pub(crate) fn determinant(&self) -> (f64, c64) {
        let mut cycles = vec![false; self.forward.len()];
        let (mut magnitude, mut direction) = (0.0, c64::new(1.0, 0.0));
        for start in 0..cycles.len() {
            let mut at = start;
            let mut length = 0;
            while !cycles[at] {
                cycles[at] = true;
                at = self.forward[at];
                length += 1;
            }
            if length > 0 && length % 2 == 0 {
                direction = -direction;
            }
        }
        for index in 0..self.factors.nrows() {
            let pivot = self.factors[(index, index)];
            let size = pivot.norm();
            if size == 0.0 {
                return (f64::NEG_INFINITY, c64::new(1.0, 0.0));
            }
            magnitude += size.ln();
            direction *= pivot / size;
        }
        (magnitude, direction)
    }

    /// Puts a floor under the pivots, so that inverse iteration at an exact
    /// eigenvalue stays finite.
    pub(crate) fn guard_pivots(&mut self) {
        let order = self.factors.nrows();
        let largest = (0..order)
            .map(|i| self.factors[(i, i)].norm())
            .fold(0.0, f64::max);
        let floor = f64::EPSILON * f64::EPSILON * largest.max(f64::MIN_POSITIVE);
        for i in 0..order {
            if self.factors[(i, i)].norm() < floor {
                self.factors[(i, i)] = c64::new(floor, 0.0);
            }
        }
    }
}

/// Matrix product `A B`.
pub(crate) fn product(left: MatRef<'_, c64>, right: MatRef<'_, c64>) -> Mat<c64> {
    let mut out = Mat::zeros(left.nrows(), right.ncols());
    matmul(
        out.as_mut(),
        Accum::Replace,
        left,
        right,
        c64::new(1.0, 0.0),
        Par::Seq,
    );
    out
}

/// Matrix product `A B` of real matrices.
pub(crate) fn real_product(left: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    let mut out = Mat::zeros(left.nrows(), right.ncols());
    matmul(out.as_mut(), Accum::Replace, left, right, 1.0, Par::Seq);
    out
}

/// Product `A x` with a vector.
pub(crate) fn apply(matrix: MatRef<'_, c64>, vector: &[c64]) -> Vec<c64> {
    let mut out = vec![c64::new(0.0, 0.0); matrix.nrows()];
    for (column, &factor) in vector.iter().enumerate() {
        for (row, value) in out.iter_mut().enumerate() {
            *value += matrix[(row, column)] * factor;
        }
    }
    out
}

/// `x^H y`.
pub(crate) fn inner(left: &[c64], right: &[c64]) -> c64 {
    left.iter().zip(right).map(|(a, b)| a.conj() * b).sum()
}

/// Euclidean length.
pub(crate) fn length(vector: &[c64]) -> f64 {
    vector.iter().map(c64::norm_sqr).sum::<f64>().sqrt()
}

/// Largest magnitude among the entries.
pub(crate) fn largest(matrix: MatRef<'_, c64>) -> f64 {
    let mut size: f64 = 0.0;
    for column in 0..matrix.ncols() {
        for row in 0..matrix.nrows() {
            size = size.max(matrix[(row, column)].norm());
        }
    }
    size
}

/// Solution of a linear least-squares problem and what is known of it.
pub(crate) struct LeastSquares {
    /// Solution of least norm, one column per right-hand side.
    pub(crate) solution: Mat<c64>,
    /// Numerical rank of the design matrix.
    pub(crate) rank: usize,
}

/// Singular values under this fraction of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-13;

/// Least-squares solution of least norm through the singular value
/// decomposition; the rank is counted at 1e-13 of the largest singular value.
pub(crate) fn least_squares(
    design: MatRef<'_, c64>,
    rhs: MatRef<'_, c64>,
) -> Result<LeastSquares, NoConvergence> {
    let (rows, columns) = (design.nrows(), design.ncols());
    let order = rows.min(columns);
    let thin = ComputeSvdVectors::Thin;
    let scratch =
        svd::svd_scratch::<c64>(rows, columns, thin, thin, Par::Seq, faer::Spec::default());
    let mut buffer = MemBuffer::new(scratch);
    let mut left = Mat::<c64>::zeros(rows, order);
    let mut right = Mat::<c64>::zeros(columns, order);
    let mut singular = vec![c64::new(0.0, 0.0); order];
    svd::svd::<c64>(
        design,
        DiagMut::from_slice_mut(&mut singular),
        Some(left.as_mut()),
        Some(right.as_mut()),
        Par::Seq,
        MemStack::new(&mut buffer),
        faer::Spec::default(),
    )
    .map_err(|_| NoConvergence { order })?;
    let limit = RANK_TOLERANCE * singular.first().map_or(0.0, |value| value.re);
    let mut projected = product(left.adjoint().to_owned().as_ref(), rhs);
    let rank = singular.iter().filter(|value| value.re > limit).count();
    for column in 0..projected.ncols() {
        for (row, value) in singular.iter().enumerate() {
            let entry = &mut projected[(row, column)];
            *entry = if value.re > limit {
                *entry / value.re
            } else {
                c64::new(0.0, 0.0)
            };
        }
    }
    Ok(LeastSquares {
        solution: product(right.as_ref(), projected.as_ref()),
        rank,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(order: usize) -> Mat<c64> {
        Mat::from_fn(order, order, |i, j| {
            c64::new(
                ((3 * i + 7 * j) % 11) as f64 - 4.0,
                ((5 * i + 2 * j) % 7) as f64 - 3.0,
            ) + if i == j {
                c64::new(9.0, 0.0)
            } else {
                c64::new(0.0, 0.0)
            }
        })
    }

    /// Sum of the eigenvalues is the trace, their product the determinant.
    #[test]
    fn eigenvalues_agree_with_trace_and_determinant() {
        let matrix = sample(6);
        let values = eigenvalues(matrix.as_ref()).unwrap();
        let trace: c64 = (0..6).map(|i| matrix[(i, i)]).sum();
        let sum: c64 = values.iter().sum();
        assert!((sum - trace).norm() < 1e-11, "{sum} != {trace}");
        let (magnitude, direction) = Lu::new(matrix).determinant();
        let product = values.iter().fold(c64::new(1.0, 0.0), |acc, v| acc * v);
        assert!((product / magnitude.exp() - direction).norm() < 1e-11);
    }

    /// Both solves leave a residual of rounding size.
    #[test]
    fn solves_satisfy_their_equations() {
        let matrix = sample(5);
        let lu = Lu::new(matrix.clone());
        let rhs = Mat::from_fn(5, 2, |i, j| c64::new(i as f64 + 1.0, j as f64 - 0.5));
        let mut x = rhs.clone();
        lu.solve(x.as_mut());
        let residual = product(matrix.as_ref(), x.as_ref()) - &rhs;
        assert!(largest(residual.as_ref()) < 1e-13);
        let mut y = rhs.clone();
        lu.solve_adjoint(y.as_mut());
        let residual = product(matrix.adjoint().to_owned().as_ref(), y.as_ref()) - &rhs;
        assert!(largest(residual.as_ref()) < 1e-13);
    }

    /// A repeated column lowers the rank by one; the solution of least norm
    /// shares the load between the two.
    #[test]
    fn rank_deficiency_is_counted_and_shared() {
        let design = Mat::from_fn(4, 3, |i, j| {
            c64::new(if j == 2 { 0.0 } else { 1.0 + i as f64 }, 0.0)
        });
        let rhs = Mat::from_fn(4, 1, |i, _| c64::new(2.0 + 2.0 * i as f64, 0.0));
        let fit = least_squares(design.as_ref(), rhs.as_ref()).unwrap();
        assert_eq!(fit.rank, 1);
        assert!((fit.solution[(0, 0)] - 1.0).norm() < 1e-14);
        assert!((fit.solution[(1, 0)] - 1.0).norm() < 1e-14);
    }
}
