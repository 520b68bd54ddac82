//! Generalised minimal residuals for a block of right-hand sides.
//!
//! Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986), algorithm 3, with modified
//! Gram–Schmidt and Givens rotations, without restart. Every column has its own Krylov
//! space; the products with the matrix are made together, which is what costs.

use crate::error::BemError;
use faer::{Mat, MatRef};

/// Steps after which an equation of the second kind has either converged or is none.
const LARGEST_STEPS: usize = 200;

/// Why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Failure {
    Cancelled,
    /// The largest residual left, of the right-hand side.
    NotConverged(f64),
}

impl Failure {
    pub(crate) fn into_error(self, stage: &'static str) -> BemError {
        match self {
            Self::Cancelled => BemError::Interrupted { stage },
            Self::NotConverged(residual) => BemError::NotConverged {
                residual,
                steps: LARGEST_STEPS,
            },
        }
    }
}

/// One column's small problem.
struct Column {
    size: f64,
    /// Columns of R.
    triangle: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    right: Vec<f64>,
    done: bool,
}

/// X with |B − A X| ≤ `tolerance` |B| in every column; `apply` gives A X, or `None` to stop.
pub(crate) fn solve_block(
    apply: impl Fn(MatRef<'_, f64>) -> Option<Mat<f64>>,
    b: &Mat<f64>,
    tolerance: f64,
) -> Result<Mat<f64>, Failure> {
    let (n, k) = (b.nrows(), b.ncols());
    let mut columns: Vec<Column> = (0..k)
        .map(|j| {
            let size = b.col(j).norm_l2();
            Column {
                size,
                triangle: Vec::new(),
                rotations: Vec::new(),
                right: vec![size],
                done: size == 0.0,
            }
        })
        .collect();
    let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
    let mut basis = vec![Mat::from_fn(n, k, |i, j| {
        b[(i, j)] * inverse(columns[j].size)
    })];
    while columns.iter().any(|c| !c.done) {
        let step = basis.len() - 1;
        if step == LARGEST_STEPS {
            let residual = |c: &Column| c.right[step].abs() * inverse(c.size);
            let left = columns.iter().filter(|c| !c.done).map(residual);
            return Err(Failure::NotConverged(left.fold(0.0, f64::max)));
        }
        let mut next = apply(basis[step].as_ref()).ok_or(Failure::Cancelled)?;
        for (j, column) in columns.iter_mut().enumerate() {
            let w = next
                .col_mut(j)
                .try_as_col_major_mut()
                .expect("a column of an owned matrix")
                .as_slice_mut();
            let mut h = Vec::with_capacity(step + 2);
            for old in &basis {
                let v = old
                    .col(j)
                    .try_as_col_major()
                    .expect("a column of an owned matrix")
                    .as_slice();
                let part: f64 = v.iter().zip(&*w).map(|(a, b)| a * b).sum();
                for (x, v) in w.iter_mut().zip(v) {
                    *x -= part * v;
                }
                h.push(part);
            }
            let size = w.iter().map(|x| x * x).sum::<f64>().sqrt();
            h.push(size);
            let scale = inverse(size);
            for x in w.iter_mut() {
                *x *= scale;
            }
            if !column.done {
                column.add(h, tolerance);
            }
        }
        basis.push(next);
    }
    let mut x = Mat::zeros(n, k);
    for (j, column) in columns.iter().enumerate() {
        for (y, v) in column.coefficients().iter().zip(&basis) {
            for i in 0..n {
                x[(i, j)] += y * v[(i, j)];
            }
        }
    }
    Ok(x)
}

impl Column {
    /// Takes the next column of the Hessenberg matrix.
    fn add(&mut self, mut h: Vec<f64>, tolerance: f64) {
        for (i, &(c, s)) in self.rotations.iter().enumerate() {
            (h[i], h[i + 1]) = (c * h[i] + s * h[i + 1], c * h[i + 1] - s * h[i]);
        }
        let last = self.rotations.len();
        let size = h[last].hypot(h[last + 1]);
        let (c, s) = if size > 0.0 {
            (h[last] / size, h[last + 1] / size)
        } else {
            (1.0, 0.0)
        };
        h[last] = size;
        h.truncate(last + 1);
        self.triangle.push(h);
        self.rotations.push((c, s));
        let rest = self.right[last];
        self.right[last] = c * rest;
        self.right.push(-s * rest);
        self.done = (s * rest).abs() <= tolerance * self.size;
    }

    /// y of R y = g.
    fn coefficients(&self) -> Vec<f64> {
        let n = self.triangle.len();
        let mut y = self.right[..n].to_vec();
        for i in (0..n).rev() {
            let diagonal = self.triangle[i][i];
            y[i] = if diagonal == 0.0 {
                0.0
            } else {
                y[i] / diagonal
            };
            for k in 0..i {
                y[k] -= self.triangle[i][k] * y[i];
            }
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns that converge at different steps, one of them zero, one an eigenvector.
    #[test]
    fn every_column_meets_its_tolerance() {
        let n = 60;
        let a = Mat::from_fn(n, n, |i, j| {
            let base = ((i * 31 + j * 17) % 23) as f64 / 23.0 / n as f64;
            if i == j { 1.0 + base } else { base }
        });
        let b = Mat::from_fn(n, 4, |i, j| match j {
            0 => 0.0,
            1 => ((i * 7) % 11) as f64,
            2 => 1e-9 * (i as f64).sin(),
            _ => f64::from(u8::from(i == 3)),
        });
        let x = solve_block(|x| Some(&a * x), &b, 1e-10).expect("converged");
        let rest = &b - &a * &x;
        for j in 0..4 {
            let size = b.col(j).norm_l2();
            println!(
                "column {j}: residual {:.1e} of {size:.1e}",
                rest.col(j).norm_l2()
            );
            assert!(rest.col(j).norm_l2() <= 2e-10 * size);
        }
        assert_eq!(solve_block(|_| None, &b, 1e-10), Err(Failure::Cancelled));
    }
}
