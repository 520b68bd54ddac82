//! Cubic interpolation of $Q$ in $k$ on the imaginary axis.
//!
//! The spline runs through the samples and their mirror images
//! $Q(-\mathrm ik) = \overline{Q(\mathrm ik)}$, so that it is even in the real
//! part and odd in the imaginary part, and has no knot at the last sample but
//! one (third derivative continuous there). On Theodorsen's function with 21
//! graded samples it is good to 1e-7 of the largest entry.

use faer::{Mat, c64};

use crate::aerodynamics::Aerodynamics;
use crate::gaf::GafTable;
use crate::linalg::{NoConvergence, least_squares};

/// $Q(\mathrm ik)$ and its slope in $k$, as the p-k method wants them.
pub(crate) trait AxisForces: Sync {
    /// $Q(\mathrm ik)$.
    fn q(&self, k: f64) -> Mat<c64>;
    /// $\mathrm dQ(\mathrm ik)/\mathrm dk$.
    fn slope(&self, k: f64) -> Mat<c64>;
}

impl AxisForces for AxisSpline {
    fn q(&self, k: f64) -> Mat<c64> {
        self.q(k)
    }

    fn slope(&self, k: f64) -> Mat<c64> {
        self.slope(k)
    }
}

/// A model evaluated on the axis instead of interpolated samples.
pub(crate) struct OnAxis<'a>(pub(crate) &'a dyn Aerodynamics);

impl AxisForces for OnAxis<'_> {
    fn q(&self, k: f64) -> Mat<c64> {
        self.0.q(c64::new(0.0, k))
    }

    /// $\mathrm dQ/\mathrm dk = \mathrm i\,\mathrm dQ/\mathrm dp$.
    fn slope(&self, k: f64) -> Mat<c64> {
        let (_, slope) = self.0.q_and_slope(c64::new(0.0, k));
        Mat::from_fn(slope.nrows(), slope.ncols(), |i, j| {
            slope[(i, j)] * c64::new(0.0, 1.0)
        })
    }
}

/// A cubic spline in $k$ with matrix values.
#[derive(Clone, Debug)]
pub struct AxisSpline {
    knots: Vec<f64>,
    values: Vec<Mat<c64>>,
    slopes: Vec<Mat<c64>>,
}

impl AxisSpline {
    /// Spline through the samples on the imaginary axis.
    ///
    /// # Errors
    /// A decomposition that fails.
    pub fn new(table: &GafTable) -> Result<Self, NoConvergence> {
        let mut knots: Vec<f64> = table.k().iter().rev().map(|k| -k).collect();
        let mut values: Vec<Mat<c64>> = table.axis().map(conjugate).collect();
        values.reverse();
        let skip = usize::from(table.k()[0] == 0.0);
        knots.extend(&table.k()[skip..]);
        values.extend(table.axis().skip(skip).cloned());
        let weights = slope_weights(&knots)?;
        let slopes = (0..knots.len())
            .map(|knot| weighted(&weights, knot, &values))
            .collect();
        Ok(Self {
            knots,
            values,
            slopes,
        })
    }

    /// Largest $k$ of the samples.
    pub fn k_max(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// $Q(\mathrm ik)$; beyond the samples the last cubic is continued.
    pub fn q(&self, k: f64) -> Mat<c64> {
        let (left, width, t) = self.place(k);
        let weights = [
            1.0 + t * t * (2.0 * t - 3.0),
            width * t * (1.0 + t * (t - 2.0)),
            t * t * (3.0 - 2.0 * t),
            width * t * t * (t - 1.0),
        ];
        self.blend(left, weights)
    }

    /// $\mathrm dQ(\mathrm ik)/\mathrm dk$.
    pub fn slope(&self, k: f64) -> Mat<c64> {
        let (left, width, t) = self.place(k);
        let weights = [
            6.0 * t * (t - 1.0) / width,
            1.0 + t * (3.0 * t - 4.0),
            6.0 * t * (1.0 - t) / width,
            t * (3.0 * t - 2.0),
        ];
        self.blend(left, weights)
    }

    fn place(&self, k: f64) -> (usize, f64, f64) {
        let last = self.knots.len() - 2;
        let after = self.knots.partition_point(|knot| *knot <= k);
        let left = after.saturating_sub(1).min(last);
        let width = self.knots[left + 1] - self.knots[left];
        (left, width, (k - self.knots[left]) / width)
    }

    /// Hermite form: value and slope at both ends of the interval.
    fn blend(&self, left: usize, weights: [f64; 4]) -> Mat<c64> {
        let parts = [
            &self.values[left],
            &self.slopes[left],
            &self.values[left + 1],
            &self.slopes[left + 1],
        ];
        Mat::from_fn(parts[0].nrows(), parts[0].ncols(), |i, j| {
            parts
                .iter()
                .zip(weights)
                .map(|(part, weight)| part[(i, j)] * weight)
                .sum()
        })
    }
}

fn conjugate(matrix: &Mat<c64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)].conj())
}

fn weighted(weights: &Mat<c64>, knot: usize, values: &[Mat<c64>]) -> Mat<c64> {
    Mat::from_fn(values[0].nrows(), values[0].ncols(), |i, j| {
        values
            .iter()
            .enumerate()
            .map(|(at, value)| value[(i, j)] * weights[(knot, at)].re)
            .sum()
    })
}

/// Slopes at the knots as linear functions of the values: continuity of the
/// second derivative inside, of the third at the last knots but one.
fn slope_weights(knots: &[f64]) -> Result<Mat<c64>, NoConvergence> {
    let n = knots.len();
    let width: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (mut left, mut right) = (Mat::<c64>::zeros(n, n), Mat::<c64>::zeros(n, n));
    let real = |value: f64| c64::new(value, 0.0);
    for i in 1..n - 1 {
        let (a, b) = (width[i - 1], width[i]);
        left[(i, i - 1)] = real(b);
        left[(i, i)] = real(2.0 * (a + b));
        left[(i, i + 1)] = real(a);
        right[(i, i - 1)] = real(-3.0 * b / a);
        right[(i, i)] = real(3.0 * (b / a - a / b));
        right[(i, i + 1)] = real(3.0 * a / b);
    }
    for (row, [first, second, third], [a, b]) in [
        (0, [0, 1, 2], [width[0], width[1]]),
        (n - 1, [n - 1, n - 2, n - 3], [-width[n - 2], -width[n - 3]]),
    ] {
        left[(row, first)] = real(1.0 / (a * a));
        left[(row, second)] = real(1.0 / (a * a) - 1.0 / (b * b));
        left[(row, third)] = real(-1.0 / (b * b));
        right[(row, first)] = real(-2.0 / (a * a * a));
        right[(row, second)] = real(2.0 / (a * a * a) + 2.0 / (b * b * b));
        right[(row, third)] = real(-2.0 / (b * b * b));
    }
    Ok(least_squares(left.as_ref(), right.as_ref())?.solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gaf::GafPoint;

    /// A cubic with the symmetry of $Q$ is met exactly, value and slope.
    #[test]
    fn a_cubic_is_reproduced() {
        let cubic = |k: f64| c64::new(1.0 - 2.0 * k * k, 0.5 * k + 3.0 * k * k * k);
        for first in [0.0, 0.05] {
            let points = [first, 0.1, 0.25, 0.7, 1.1].map(|k| GafPoint {
                g: 0.0,
                k,
                q: Mat::from_fn(1, 1, |_, _| cubic(k)),
            });
            let table =
                GafTable::new(1.0, 0.0, vec!["a".into()], points.into(), vec![]).unwrap();
            let spline = AxisSpline::new(&table).unwrap();
            for k in [0.0, 0.03, 0.4, 1.0] {
                assert!((spline.q(k)[(0, 0)] - cubic(k)).norm() < 1e-12);
                let slope = c64::new(-4.0 * k, 0.5 + 9.0 * k * k);
                assert!((spline.slope(k)[(0, 0)] - slope).norm() < 1e-11);
            }
        }
    }
}
