//! A root with its vectors.

use faer::{Mat, c64};

use crate::linalg::{Lu, length};

/// A root $p$ with $T(p)x = 0$ and $y^HT(p) = 0$.
#[derive(Clone, Debug)]
pub struct Eigenpair {
    /// The root; $\operatorname{Im}p\ge0$, exactly zero for a real root.
    pub p: c64,
    /// $x$, of unit length.
    pub right: Vec<c64>,
    /// $y$, of unit length.
    pub left: Vec<c64>,
}

/// Rounds of inverse iteration; the first already gains as many digits as the
/// root has, the second settles the unlikely start that misses the vector.
const ROUNDS: usize = 2;

/// Vectors of a known root from the factorised $T(p)$.
pub(crate) fn inverse_iteration(p: c64, operator: Mat<c64>) -> Eigenpair {
    let order = operator.nrows();
    let mut lu = Lu::new(operator);
    lu.guard_pivots();
    let mut right = start(order);
    let mut left = start(order);
    for _ in 0..ROUNDS {
        lu.solve(right.as_mut());
        normalise(&mut right);
        lu.solve_adjoint(left.as_mut());
        normalise(&mut left);
    }
    let column = |matrix: &Mat<c64>| (0..order).map(|i| matrix[(i, 0)]).collect();
    Eigenpair {
        p,
        right: column(&right),
        left: column(&left),
    }
}

/// The same where the right vector is known.
pub(crate) fn left_vector(p: c64, operator: Mat<c64>, right: Vec<c64>) -> Eigenpair {
    let order = operator.nrows();
    let mut lu = Lu::new(operator);
    lu.guard_pivots();
    let mut left = start(order);
    for _ in 0..ROUNDS {
        lu.solve_adjoint(left.as_mut());
        normalise(&mut left);
    }
    let left = (0..order).map(|i| left[(i, 0)]).collect();
    Eigenpair { p, right, left }
}

/// A start vector without symmetry, so that no family of modes is missed.
fn start(order: usize) -> Mat<c64> {
    Mat::from_fn(order, 1, |i, _| {
        let phase = 2.4 * (i + 1) as f64;
        c64::new(1.0 + 0.3 * phase.cos(), 0.3 * phase.sin())
    })
}

/// Unit length, the largest entry real and positive.
fn normalise(vector: &mut Mat<c64>) {
    let entries: Vec<c64> = (0..vector.nrows()).map(|i| vector[(i, 0)]).collect();
    let scale = turned_to_unit(&entries);
    for i in 0..vector.nrows() {
        vector[(i, 0)] *= scale;
    }
}

/// Factor that makes a vector of unit length with its largest entry real.
pub(crate) fn turned_to_unit(entries: &[c64]) -> c64 {
    let peak = entries.iter().fold(c64::new(0.0, 0.0), |best, v| {
        if v.norm() > best.norm() { *v } else { best }
    });
    let size = length(entries);
    if size == 0.0 || peak.norm() == 0.0 {
        return c64::new(1.0, 0.0);
    }
    peak.conj() / (peak.norm() * size)
}
