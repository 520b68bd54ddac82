//! Determinants of eight complex matrices at once, one a SIMD lane.
//!
//! LU factorisation by columns. A lane exchanges rows only where its diagonal
//! entry is below a tenth of the largest of its column: growth stays bounded by
//! $11^{n-1}$ instead of $2^{n-1}$, in practice by some tens, and most columns
//! go without an exchange. The instruction set is chosen at run time; every
//! lane goes through the same operations whatever the width.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into a dispatched function has its instructions"
)]

use faer::c64;
use pulp::{Arch, Simd, WithSimd};

/// Matrices evaluated together; a multiple of every width of instructions.
pub(crate) const WIDTH: usize = 8;

/// A diagonal entry above this part of the largest of its column stays.
const THRESHOLD: f64 = 0.1;

/// Eight square matrices: entries column by column, of each entry the eight
/// lanes side by side.
#[derive(Clone, Debug)]
pub(crate) struct LaneMatrices {
    order: usize,
    pub(crate) re: Vec<f64>,
    pub(crate) im: Vec<f64>,
}

impl LaneMatrices {
    pub(crate) fn new(order: usize) -> Self {
        let size = order * order * WIDTH;
        Self {
            order,
            re: vec![0.0; size],
            im: vec![0.0; size],
        }
    }

    /// Writes one entry of one lane.
    pub(crate) fn set(&mut self, row: usize, column: usize, lane: usize, value: c64) {
        let at = (column * self.order + row) * WIDTH + lane;
        self.re[at] = value.re;
        self.im[at] = value.im;
    }

    /// Sets every entry to $\sum_j a_jw_j$: `terms` holds the real $a_j$ of one
    /// entry side by side, `weights` the $w_j$ of the eight lanes.
    pub(crate) fn combine(&mut self, arch: Arch, terms: &[f64], weights: &[[[f64; WIDTH]; 2]]) {
        arch.dispatch(Combination {
            target: self,
            terms,
            weights,
        });
    }

    /// Direction of the determinant of every lane in the complex plane, NaN
    /// for a singular matrix; the matrices are used up.
    pub(crate) fn determinants(&mut self, arch: Arch) -> [c64; WIDTH] {
        arch.dispatch(Factorisation(self))
    }

    /// Row below the diagonal of a column whose entry has the given size.
    fn row_of(&self, lane: usize, column: usize, size: f64) -> Option<usize> {
        (column + 1..self.order).find(|row| {
            let at = (column * self.order + row) * WIDTH + lane;
            self.re[at].abs() + self.im[at].abs() == size
        })
    }

    /// Exchanges two rows of one lane from a column on.
    fn exchange(&mut self, lane: usize, rows: [usize; 2], from: usize) {
        for column in from..self.order {
            let [one, other] = rows.map(|row| (column * self.order + row) * WIDTH + lane);
            self.re.swap(one, other);
            self.im.swap(one, other);
        }
    }
}

struct Combination<'a> {
    target: &'a mut LaneMatrices,
    terms: &'a [f64],
    weights: &'a [[[f64; WIDTH]; 2]],
}

impl WithSimd for Combination<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let parts = WIDTH / S::F64_LANES;
        let (re, _) = S::as_mut_simd_f64s(&mut self.target.re);
        let (im, _) = S::as_mut_simd_f64s(&mut self.target.im);
        let entries = self.terms.chunks_exact(self.weights.len());
        for (entry, terms) in entries.enumerate() {
            for part in 0..parts {
                let mut sums = [simd.splat_f64s(0.0); 2];
                for (term, weight) in terms.iter().zip(self.weights) {
                    let term = simd.splat_f64s(*term);
                    for (sum, lanes) in sums.iter_mut().zip(weight) {
                        let (lanes, _) = S::as_simd_f64s(lanes);
                        *sum = simd.mul_add_e_f64s(term, lanes[part], *sum);
                    }
                }
                re[entry * parts + part] = sums[0];
                im[entry * parts + part] = sums[1];
            }
        }
    }
}

struct Factorisation<'a>(&'a mut LaneMatrices);

impl WithSimd for Factorisation<'_> {
    type Output = [c64; WIDTH];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [c64; WIDTH] {
        let matrices = self.0;
        let order = matrices.order;
        let mut directions = [c64::new(1.0, 0.0); WIDTH];
        for step in 0..order {
            choose_pivots(simd, matrices, step, &mut directions);
            let at = (step * order + step) * WIDTH;
            for (lane, direction) in directions.iter_mut().enumerate() {
                let pivot = c64::new(matrices.re[at + lane], matrices.im[at + lane]);
                *direction *= pivot / pivot.norm_sqr().sqrt();
            }
            eliminate(simd, matrices, step);
        }
        directions
    }
}

/// Brings a large enough entry to the diagonal of every lane.
#[inline(always)]
fn choose_pivots<S: Simd>(
    simd: S,
    matrices: &mut LaneMatrices,
    step: usize,
    directions: &mut [c64; WIDTH],
) {
    let order = matrices.order;
    let mut largest = [0.0; WIDTH];
    let mut diagonal = [0.0; WIDTH];
    {
        let parts = WIDTH / S::F64_LANES;
        let (re, _) = S::as_simd_f64s(&matrices.re);
        let (im, _) = S::as_simd_f64s(&matrices.im);
        let (largest, _) = S::as_mut_simd_f64s(&mut largest);
        let (diagonal, _) = S::as_mut_simd_f64s(&mut diagonal);
        let column = step * order * parts..(step + 1) * order * parts;
        let below = step * parts..;
        let re = re[column.clone()][below.clone()].chunks_exact(parts);
        let im = im[column][below].chunks_exact(parts);
        for (row, (x, y)) in re.zip(im).enumerate() {
            for part in 0..parts {
                let size = simd.add_f64s(simd.abs_f64s(x[part]), simd.abs_f64s(y[part]));
                if row == 0 {
                    diagonal[part] = size;
                    largest[part] = size;
                } else {
                    largest[part] = simd.max_f64s(largest[part], size);
                }
            }
        }
    }
    for lane in 0..WIDTH {
        if diagonal[lane] >= THRESHOLD * largest[lane] {
            continue;
        }
        if let Some(pivot) = matrices.row_of(lane, step, largest[lane]) {
            matrices.exchange(lane, [step, pivot], step);
            directions[lane] = -directions[lane];
        }
    }
}

/// Takes the multiples of row `step` off the rows below.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, matrices: &mut LaneMatrices, step: usize) {
    let order = matrices.order;
    let parts = WIDTH / S::F64_LANES;
    let (re, _) = S::as_mut_simd_f64s(&mut matrices.re);
    let (im, _) = S::as_mut_simd_f64s(&mut matrices.im);
    let height = order * parts;
    let (head_re, tail_re) = re.split_at_mut((step + 1) * height);
    let (head_im, tail_im) = im.split_at_mut((step + 1) * height);
    let below = (step + 1) * parts..height;
    let own_re = &mut head_re[step * height..];
    let own_im = &mut head_im[step * height..];
    for part in 0..parts {
        let at = step * parts + part;
        let (a, b) = (own_re[at], own_im[at]);
        let size = simd.mul_add_e_f64s(a, a, simd.mul_f64s(b, b));
        let (c, d) = (
            simd.div_f64s(a, size),
            simd.neg_f64s(simd.div_f64s(b, size)),
        );
        for row in step + 1..order {
            let at = row * parts + part;
            let (x, y) = (own_re[at], own_im[at]);
            own_re[at] = simd.negate_mul_add_e_f64s(y, d, simd.mul_f64s(x, c));
            own_im[at] = simd.mul_add_e_f64s(x, d, simd.mul_f64s(y, c));
        }
    }
    let (factor_re, factor_im) = (&own_re[below.clone()], &own_im[below.clone()]);
    let columns = tail_re
        .chunks_exact_mut(height)
        .zip(tail_im.chunks_exact_mut(height));
    for (column_re, column_im) in columns {
        let (upper_re, lower_re) = column_re.split_at_mut(below.start);
        let (upper_im, lower_im) = column_im.split_at_mut(below.start);
        let (u, v) = (&upper_re[step * parts..], &upper_im[step * parts..]);
        let targets = lower_re
            .chunks_exact_mut(parts)
            .zip(lower_im.chunks_exact_mut(parts));
        let factors = factor_re
            .chunks_exact(parts)
            .zip(factor_im.chunks_exact(parts));
        for ((x, y), (l, m)) in targets.zip(factors) {
            for part in 0..parts {
                // (x + iy) − (l + im)(u + iv)
                let real = simd.negate_mul_add_e_f64s(l[part], u[part], x[part]);
                x[part] = simd.mul_add_e_f64s(m[part], v[part], real);
                let imaginary = simd.negate_mul_add_e_f64s(l[part], v[part], y[part]);
                y[part] = simd.negate_mul_add_e_f64s(m[part], u[part], imaginary);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Lu;
    use faer::Mat;

    /// Lanes against one factorisation after the other, matrices with small
    /// diagonals among them; on every width the machine has.
    #[test]
    fn lanes_agree_with_single_factorisations() {
        for order in [1, 2, 5, 26] {
            let entry = |lane: usize, i: usize, j: usize| {
                let t = (1 + lane) as f64 * (0.37 + i as f64) + 2.3 * j as f64;
                let size = if i == j && lane.is_multiple_of(2) {
                    1e-9
                } else {
                    1.0
                };
                c64::new((7.1 * t).sin(), (3.3 * t * t).cos()) * size
            };
            let mut lanes = LaneMatrices::new(order);
            for lane in 0..WIDTH {
                for i in 0..order {
                    (0..order).for_each(|j| lanes.set(i, j, lane, entry(lane, i, j)));
                }
            }
            let found = lanes.determinants(Arch::new());
            for (lane, direction) in found.into_iter().enumerate() {
                let matrix = Mat::from_fn(order, order, |i, j| entry(lane, i, j));
                let (_, expected) = Lu::new(matrix).determinant();
                assert!(
                    (direction - expected).norm() < 1e-10,
                    "{order} {lane}: {direction} {expected}"
                );
            }
        }
    }

    /// A combination is the sum of its terms.
    #[test]
    fn combinations_are_sums() {
        let terms = [1.0, 2.0, -0.5, 4.0];
        let weights = [[[3.0; WIDTH], [1.0; WIDTH]], [[0.5; WIDTH], [-2.0; WIDTH]]];
        let mut lanes = LaneMatrices::new(1);
        lanes.combine(Arch::new(), &terms[..2], &weights);
        assert_eq!((lanes.re[3], lanes.im[7]), (4.0, -3.0));
        lanes.combine(Arch::new(), &terms[2..], &weights);
        assert_eq!((lanes.re[0], lanes.im[0]), (0.5, -8.5));
    }

    /// A singular matrix has no direction.
    #[test]
    fn singular_matrices_are_told() {
        let mut lanes = LaneMatrices::new(2);
        for lane in 1..WIDTH {
            lanes.set(0, 0, lane, c64::new(1.0, 0.0));
            lanes.set(1, 1, lane, c64::new(0.0, 2.0));
        }
        let found = lanes.determinants(Arch::new());
        assert!(found[0].re.is_nan());
        assert!((found[1] - c64::new(0.0, 1.0)).norm() < 1e-15);
    }
}
