//! Low-rank factors of a matrix from some of its rows and columns.
//!
//! Adaptive cross approximation with partial pivoting (Bebendorf, Numer. Math. 86 (2000);
//! Bebendorf & Rjasanow, Computing 70 (2003), algorithm 4.2): A ≈ Σ_k u_k v_kᵀ, each term a
//! row and a column of what is left. It stops when a term is small against the sum and
//! some rows not seen yet are met too; without that check a matrix with blocks of zeros,
//! such as a doublet's influence in its own plane, is taken for finished. The factors are
//! then made orthogonal and cut by their singular values.

use faer::{Mat, MatRef};

/// Rows that must be met before the approximation counts as finished.
const CHECKS: usize = 3;

/// A matrix that is evaluated by rows and columns.
pub(crate) trait Entries {
    fn rows(&self) -> usize;
    fn columns(&self) -> usize;
    fn row(&mut self, i: usize, out: &mut [f64]);
    fn column(&mut self, j: usize, out: &mut [f64]);
}

/// A ≈ left rightᵀ.
#[derive(Clone, Debug)]
pub(crate) struct LowRank {
    pub(crate) left: Mat<f64>,
    pub(crate) right: Mat<f64>,
}

/// Factors with an error of about `tolerance` times the matrix, in the Frobenius norm;
/// `None` where they would be larger than the matrix.
pub(crate) fn approximate(entries: &mut impl Entries, tolerance: f64) -> Option<LowRank> {
    let (m, n) = (entries.rows(), entries.columns());
    let largest = m * n / (m + n);
    let mut cross = Cross::default();
    let mut unused: Vec<bool> = vec![true; m];
    let mut checks = 0;
    let mut pivot = m / 2;
    loop {
        unused[pivot] = false;
        let mut v = vec![0.0; n];
        entries.row(pivot, &mut v);
        cross.subtract_row(pivot, &mut v);
        let (j, value) = largest_entry(&v);
        let is_met = norm(&v) * (m as f64).sqrt() <= tolerance * cross.norm();
        let mut next = None;
        if is_met {
            checks += 1;
            if checks >= CHECKS {
                break;
            }
        } else {
            if cross.left.len() == largest {
                return None;
            }
            let mut u = vec![0.0; m];
            entries.column(j, &mut u);
            cross.subtract_column(j, &mut u);
            for x in &mut v {
                *x /= value;
            }
            let size = norm(&u) * norm(&v);
            next = (0..m)
                .filter(|&i| unused[i])
                .max_by(|&a, &b| u[a].abs().total_cmp(&u[b].abs()));
            cross.push(u, v);
            if size > tolerance * cross.norm() {
                checks = 0;
            } else {
                next = None;
            }
        }
        // Without a pivot to follow, a row far from those seen.
        match next.or_else(|| far_from_used(&unused)) {
            Some(i) => pivot = i,
            None => break,
        }
    }
    Some(cross.recompressed(tolerance))
}

/// Middle of the longest run of rows not used.
fn far_from_used(unused: &[bool]) -> Option<usize> {
    let (mut best, mut start) = (None, 0);
    let mut longest = 0;
    for i in 0..=unused.len() {
        if i == unused.len() || !unused[i] {
            if i - start > longest {
                longest = i - start;
                best = Some(start + longest / 2);
            }
            start = i + 1;
        }
    }
    best
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn largest_entry(values: &[f64]) -> (usize, f64) {
    values
        .iter()
        .copied()
        .enumerate()
        .fold((0, 0.0_f64), |(i, x), (j, y)| {
            if y.abs() > x.abs() { (j, y) } else { (i, x) }
        })
}

/// Terms found.
#[derive(Default)]
struct Cross {
    left: Vec<Vec<f64>>,
    right: Vec<Vec<f64>>,
    norm_squared: f64,
}

impl Cross {
    /// Frobenius norm of the sum.
    fn norm(&self) -> f64 {
        self.norm_squared.max(0.0).sqrt()
    }

    fn subtract_row(&self, i: usize, row: &mut [f64]) {
        for (u, v) in self.left.iter().zip(&self.right) {
            subtract(u[i], v, row);
        }
    }

    fn subtract_column(&self, j: usize, column: &mut [f64]) {
        for (u, v) in self.left.iter().zip(&self.right) {
            subtract(v[j], u, column);
        }
    }

    fn push(&mut self, u: Vec<f64>, v: Vec<f64>) {
        let mixed: f64 = self
            .left
            .iter()
            .zip(&self.right)
            .map(|(a, b)| dot(a, &u) * dot(b, &v))
            .sum();
        self.norm_squared += 2.0 * mixed + dot(&u, &u) * dot(&v, &v);
        self.left.push(u);
        self.right.push(v);
    }

    /// U Vᵀ = Q_u (R_u R_vᵀ) Q_vᵀ, cut behind the singular values that matter.
    fn recompressed(self, tolerance: f64) -> LowRank {
        let matrix = |columns: &[Vec<f64>], rows: usize| {
            Mat::from_fn(rows, columns.len(), |i, k| columns[k][i])
        };
        let rows = self.left.first().map_or(0, Vec::len);
        let columns = self.right.first().map_or(0, Vec::len);
        let (left, right) = (matrix(&self.left, rows), matrix(&self.right, columns));
        if left.ncols() == 0 {
            return LowRank { left, right };
        }
        let (q_left, q_right) = (left.qr(), right.qr());
        let core = q_left.thin_R() * q_right.thin_R().transpose();
        let Ok(svd) = core.thin_svd() else {
            return LowRank { left, right };
        };
        let values = svd.S().column_vector();
        let total: f64 = values.iter().map(|s| s * s).sum();
        let mut rest = 0.0;
        let mut rank = values.nrows();
        while rank > 0 {
            rest += values[rank - 1] * values[rank - 1];
            if rest > (tolerance * tolerance) * total {
                break;
            }
            rank -= 1;
        }
        let scaled = |part: MatRef<'_, f64>| {
            Mat::from_fn(part.nrows(), rank, |i, k| part[(i, k)] * values[k])
        };
        LowRank {
            left: q_left.compute_thin_Q() * scaled(svd.U()),
            right: q_right.compute_thin_Q() * svd.V().subcols(0, rank),
        }
    }
}

fn subtract(factor: f64, from: &[f64], values: &mut [f64]) {
    for (x, y) in values.iter_mut().zip(from) {
        *x -= factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Given(Mat<f64>);

    impl Entries for Given {
        fn rows(&self) -> usize {
            self.0.nrows()
        }
        fn columns(&self) -> usize {
            self.0.ncols()
        }
        fn row(&mut self, i: usize, out: &mut [f64]) {
            for (j, x) in out.iter_mut().enumerate() {
                *x = self.0[(i, j)];
            }
        }
        fn column(&mut self, j: usize, out: &mut [f64]) {
            for (i, x) in out.iter_mut().enumerate() {
                *x = self.0[(i, j)];
            }
        }
    }

    /// 1/r between two lines, and the same with half of its rows and columns zero in turn,
    /// as plane parts have it.
    #[test]
    fn kernels_and_kernels_with_zeros_are_met_to_the_tolerance() {
        let kernel = |i: usize, j: usize| {
            let (x, y) = (i as f64 / 200.0, 2.0 + j as f64 / 150.0);
            1.0 / (x - y).hypot(0.3)
        };
        let smooth = Mat::from_fn(200, 150, kernel);
        let holed = Mat::from_fn(200, 150, |i, j| {
            if (i < 100) == (j < 75) {
                0.0
            } else {
                kernel(i, j)
            }
        });
        for (name, a) in [("smooth", smooth), ("with zeros", holed)] {
            for tolerance in [1e-4, 1e-8] {
                let found = approximate(&mut Given(a.clone()), tolerance).expect("low rank");
                let error =
                    (&a - &found.left * found.right.transpose()).norm_l2() / a.norm_l2();
                println!(
                    "{name}, {tolerance:.0e}: rank {}, {error:.1e}",
                    found.left.ncols()
                );
                assert!(error < 3.0 * tolerance && found.left.ncols() < 20);
            }
        }
    }

    #[test]
    fn nothing_is_gained_on_a_full_matrix_and_zero_is_zero() {
        let full = Mat::from_fn(40, 40, |i, j| if i == j { 1.0 } else { 0.01 });
        assert!(approximate(&mut Given(full), 1e-8).is_none());
        let zero = approximate(&mut Given(Mat::zeros(30, 20)), 1e-8).expect("zero");
        assert_eq!((zero.left.nrows(), zero.left.ncols()), (0, 0));
    }
}
