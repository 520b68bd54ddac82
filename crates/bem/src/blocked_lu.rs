//! LU factorisation with partial pivoting, right-looking, in blocks of columns.
//!
//! P A = L U. After a block of columns is factorised every chunk of the columns behind it
//! is independent of the others: rows swapped, U₁₂ = L₁₁⁻¹ A₁₂, A₂₂ −= L₂₁ U₁₂, all of it a
//! matrix product of one thread. The next block of columns is updated first and factorised
//! while the rest is updated. Chunks depend on the size only, so that the factors have the
//! same bits at any number of threads; and the work runs at the speed of the product,
//! where a parallel factorisation that divides single products waits for its panels.

use crate::error::BemError;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
    solve_unit_upper_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::prelude::ReborrowMut;
use faer::traits::RealField;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use rayon::prelude::*;

/// Columns of a block.
const BLOCK: usize = 256;
/// Widest chunk behind it.
const CHUNK: usize = 512;
/// Rows of a product in a substitution.
const ROWS: usize = 1024;
/// Right-hand sides of a diagonal block that one thread solves.
const SOLVED_TOGETHER: usize = 32;

/// Factors and row permutation.
#[derive(Debug)]
pub(crate) struct BlockedLu<T> {
    size: usize,
    /// L below the diagonal, U on and above it, by columns.
    factors: Vec<T>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

/// Rows that change places: `to[i]` gets what was in `from[i]`.
#[derive(Default)]
struct Swaps {
    to: Vec<usize>,
    from: Vec<usize>,
}

impl<T: RealField + Copy> BlockedLu<T> {
    /// Factorises a square matrix given by columns; `advance` is told every block.
    ///
    /// # Errors
    /// None: a zero pivot leaves infinities, which [`Self::check`] finds.
    pub(crate) fn new(
        mut columns: Vec<T>,
        size: usize,
        advance: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let n = size;
        let mut swaps = Swaps::default();
        let mut all_swaps = Vec::new();
        if n > 0 {
            swaps = factorise(panel(&mut columns, n, 0, BLOCK.min(n)), 0);
        }
        for first in (0..n).step_by(BLOCK) {
            let width = BLOCK.min(n - first);
            let next = first + width;
            let (done, behind) = columns.split_at_mut(next * n);
            let block = &done[first * n..];
            if next == n {
                all_swaps.push(swaps);
                break;
            }
            let block = MatRef::from_column_major_slice(block, n, width);
            let (coming, rest) = behind.split_at_mut(BLOCK.min(n - next) * n);
            coming
                .par_chunks_mut(n * BLOCK.div_ceil(4))
                .for_each(|chunk| update(block, first, &swaps, chunk));
            let chunk = ((n - next) / 16).clamp(BLOCK / 2, CHUNK);
            let (found, ()) = rayon::join(
                || {
                    let width = coming.len() / n;
                    factorise(
                        MatMut::from_column_major_slice_mut(coming, n, width)
                            .subrows_mut(next, n - next),
                        next,
                    )
                },
                || {
                    rest.par_chunks_mut(n * chunk)
                        .for_each(|chunk| update(block, first, &swaps, chunk));
                },
            );
            all_swaps.push(std::mem::replace(&mut swaps, found));
            advance(width);
        }
        let forward = finish_swaps(&mut columns, n, &all_swaps);
        let mut inverse = vec![0; n];
        for (i, &from) in forward.iter().enumerate() {
            inverse[from] = i;
        }
        Self {
            size,
            factors: columns,
            forward,
            inverse,
        }
    }

    /// Refuses pivots that are no numbers or below `smallest` times the largest.
    ///
    /// # Errors
    /// [`BemError::Singular`].
    pub(crate) fn check(
        &self,
        smallest: f64,
        value: impl Fn(T) -> f64,
    ) -> Result<(), BemError> {
        let n = self.size;
        let pivots = (0..n).map(|i| value(self.factors[i * n + i]).abs());
        let largest = pivots.clone().fold(0.0, f64::max);
        for (pivot, value) in pivots.enumerate() {
            if !value.is_finite() || value <= smallest * largest {
                return Err(BemError::Singular {
                    pivot,
                    size: n,
                    value,
                });
            }
        }
        Ok(())
    }

    /// Overwrites B with A⁻¹ B, or A⁻ᵀ B.
    ///
    /// Substitution by blocks, all right-hand sides together: what a solved block of rows
    /// takes from the others is a product, in chunks of rows.
    pub(crate) fn solve(&self, mut b: MatMut<'_, T>, transposed: bool) {
        let n = self.size;
        let lu = MatRef::from_column_major_slice(&self.factors, n, n);
        if transposed {
            substitute(lu.transpose(), b.rb_mut(), Triangle::Lower);
            substitute(lu.transpose(), b.rb_mut(), Triangle::UnitUpper);
            permute(b, &self.inverse);
        } else {
            permute(b.rb_mut(), &self.forward);
            substitute(lu, b.rb_mut(), Triangle::UnitLower);
            substitute(lu, b, Triangle::Upper);
        }
    }
}

/// Part of a matrix that a substitution takes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Triangle {
    Lower,
    UnitLower,
    Upper,
    UnitUpper,
}

/// Overwrites B with T⁻¹ B.
fn substitute<T: RealField + Copy>(
    matrix: MatRef<'_, T>,
    mut b: MatMut<'_, T>,
    triangle: Triangle,
) {
    let n = matrix.nrows();
    let is_lower = matches!(triangle, Triangle::Lower | Triangle::UnitLower);
    let mut blocks: Vec<usize> = (0..n).step_by(BLOCK).collect();
    if !is_lower {
        blocks.reverse();
    }
    for first in blocks {
        let width = BLOCK.min(n - first);
        let (before, rest) = b.rb_mut().split_at_row_mut(first);
        let (mut own, behind) = rest.split_at_row_mut(width);
        let diagonal = matrix.submatrix(first, first, width, width);
        own.rb_mut()
            .par_col_chunks_mut(SOLVED_TOGETHER)
            .for_each(|part| match triangle {
                Triangle::Lower => {
                    solve_lower_triangular_in_place(diagonal, part, Par::Seq);
                }
                Triangle::UnitLower => {
                    solve_unit_lower_triangular_in_place(diagonal, part, Par::Seq);
                }
                Triangle::Upper => {
                    solve_upper_triangular_in_place(diagonal, part, Par::Seq);
                }
                Triangle::UnitUpper => {
                    solve_unit_upper_triangular_in_place(diagonal, part, Par::Seq);
                }
            });
        let (others, from) = if is_lower {
            (behind, first + width)
        } else {
            (before, 0)
        };
        let own = own.as_ref();
        others
            .par_row_chunks_mut(ROWS)
            .enumerate()
            .for_each(|(chunk, mut part)| {
                let block = matrix.submatrix(from + chunk * ROWS, first, part.nrows(), width);
                matmul(&mut part, Accum::Add, block, own, -T::one_impl(), Par::Seq);
            });
    }
}

/// Row i becomes what was row `from[i]`.
fn permute<T: RealField + Copy>(b: MatMut<'_, T>, from: &[usize]) {
    b.par_col_chunks_mut(1).for_each(|mut column| {
        let values: Vec<T> = from.iter().map(|&i| column[(i, 0)]).collect();
        for (i, value) in values.into_iter().enumerate() {
            column[(i, 0)] = value;
        }
    });
}

/// Moves the rows of each block of columns as the blocks after it ask, in one go; gives the
/// row that each row of the factors was.
fn finish_swaps<T: Copy + Send + Sync>(
    columns: &mut [T],
    n: usize,
    swaps: &[Swaps],
) -> Vec<usize> {
    let mut source: Vec<usize> = (0..n).collect();
    let mut earlier: Vec<usize> = (0..n).collect();
    for (b, swaps) in swaps.iter().enumerate().rev() {
        let (first, end) = (b * BLOCK * n, ((b + 1) * BLOCK).min(n) * n);
        columns[first..end].par_chunks_mut(n).for_each_init(
            || Vec::with_capacity(n),
            |moved, column| {
                moved.clear();
                moved.extend(source.iter().map(|&i| column[i]));
                column.copy_from_slice(moved);
            },
        );
        for (&to, &from) in swaps.to.iter().zip(&swaps.from) {
            earlier[to] = from;
        }
        for row in &mut source {
            *row = earlier[*row];
        }
        for &to in &swaps.to {
            earlier[to] = to;
        }
    }
    source
}

/// Rows from `first` on of `width` columns from `first` on.
fn panel<T: Copy>(columns: &mut [T], n: usize, first: usize, width: usize) -> MatMut<'_, T> {
    let part = &mut columns[first * n..(first + width) * n];
    MatMut::from_column_major_slice_mut(part, n, width).subrows_mut(first, n - first)
}

/// Factorises a panel whose first row is row `first` of the matrix.
fn factorise<T: RealField + Copy>(panel: MatMut<'_, T>, first: usize) -> Swaps {
    let (height, width) = (panel.nrows(), panel.ncols());
    let (mut forward, mut inverse) = (vec![0; height], vec![0; height]);
    let request =
        factor::lu_in_place_scratch::<usize, T>(height, width, Par::Seq, Spec::default());
    let mut memory = MemBuffer::new(request);
    factor::lu_in_place(
        panel,
        &mut forward,
        &mut inverse,
        Par::Seq,
        MemStack::new(&mut memory),
        Spec::default(),
    );
    let mut swaps = Swaps::default();
    for (to, &from) in forward.iter().enumerate() {
        if to != from {
            swaps.to.push(first + to);
            swaps.from.push(first + from);
        }
    }
    swaps
}

/// Swaps, triangular solve and product on columns behind the block that starts at `first`.
fn update<T: RealField + Copy>(
    block: MatRef<'_, T>,
    first: usize,
    swaps: &Swaps,
    columns: &mut [T],
) {
    let (n, width) = (block.nrows(), block.ncols());
    for column in columns.chunks_exact_mut(n) {
        swaps.apply(column);
    }
    let count = columns.len() / n;
    let columns = MatMut::from_column_major_slice_mut(columns, n, count);
    let (mut upper, lower) = columns
        .subrows_mut(first, n - first)
        .split_at_row_mut(width);
    let (own, below) = block.subrows(first, n - first).split_at_row(width);
    solve_unit_lower_triangular_in_place(own, upper.as_mut(), Par::Seq);
    matmul(lower, Accum::Add, below, upper, -T::one_impl(), Par::Seq);
}

impl Swaps {
    fn apply<T: Copy>(&self, column: &mut [T]) {
        // At most two rows a column of the block change places.
        let values: Vec<T> = self.from.iter().map(|&i| column[i]).collect();
        for (&to, value) in self.to.iter().zip(values) {
            column[to] = value;
        }
    }
}
